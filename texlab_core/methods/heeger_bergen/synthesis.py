"""What the syntheses of textures and of solids share: stages with their steps, and curves of distances."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from texlab_core.engine.steps import Curve, Step
from texlab_core.work.tasks import Pace

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.work.tasks import Task

ReturnT = TypeVar("ReturnT")


class Stages:
    """Counts the samples of a synthesis, stage by stage, and makes steps of them.

    Parameters
    ----------
    rounds, after
        How many stages there are between the start, which is the first one, and what follows, and how many belong
        to what follows, at least 1.
    expected
        About how many samples each stage works through, at least 1.
    units
        Of progress in each stage.
    stride
        Samples worked through between two steps.
    preview
        Returns what makes a picture of the state, or None while there is nothing to see.
    """

    def __init__(
        self,
        rounds: int,
        after: int,
        expected: int,
        *,
        units: int,
        stride: int,
        preview: Callable[[], Callable[[], FloatImage] | None],
    ) -> None:
        self._rounds, self._stages, self._expected = rounds, 1 + rounds + after, expected
        self._units, self._preview = units, preview
        self._pace = Pace(stride)
        self._stage = self._samples = 0

    def next(self) -> None:
        """Go on to the next stage."""
        self._stage, self._samples = self._stage + 1, 0

    def end(self) -> None:
        """Leave all stages behind."""
        self._stage, self._samples = self._stages, 0

    def steps(self, work: Task[ReturnT], name: str) -> Generator[Step, None, ReturnT]:
        """Run a task that tells how many samples it has worked through."""

        def make(samples: int) -> Step:
            self._samples += samples
            return self.step(name)

        return self._pace.steps(work, make)

    def step(self, name: str, metrics: Mapping[str, float] | None = None, frame: str | None = None) -> Step:
        """Return the step of this moment."""
        # What follows the rounds counts its samples through all its stages.
        most = 1 if self._stage <= self._rounds else self._stages - self._stage
        done = round(self._units * (self._stage + min(self._samples / self._expected, most)))
        return Step(done, self._units * self._stages, name, metrics or {}, self._preview(), frame)


def mean(distances: NDArray[np.float64]) -> float:
    """Return the mean; 0 when there is nothing, as for a constant exemplar."""
    return float(distances.mean()) if distances.size else 0.0


def distance_curve(distances: Sequence[float], title: str) -> Curve:
    """Return the curve of a distance, round by round."""
    return Curve.of(distances, title, y_label="W1 / standard deviation")
