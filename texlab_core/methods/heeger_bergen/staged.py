"""What the syntheses of textures and of solids share: stages with their steps, and curves of distances."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, TypeVar

from texlab_core.engine.steps import Curve, Step
from texlab_core.work.tasks import Pace

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.work.tasks import Task

ReturnT = TypeVar("ReturnT")


class Staged(ABC):
    """A synthesis on several colour axes that counts its samples stage by stage and makes steps of them.

    Parameters
    ----------
    axes
        How many planes there are once the noise is made.
    rounds, after
        How many stages follow the first one, the start: the rounds, and at least one for all that comes then.
    expected
        About how many samples each stage works through, at least 1.
    units
        Of progress in each stage.
    stride
        Samples worked through between two steps.
    """

    def __init__(self, axes: int, rounds: int, after: int, expected: int, *, units: int, stride: int) -> None:
        self.planes: list[NDArray[np.float32]] = []
        self._axes, self._rounds, self._stages = axes, rounds, 1 + rounds + after
        self._expected, self._units, self._pace = expected, units, Pace(stride)
        self._stage = self._samples = 0

    @abstractmethod
    def _preview(self) -> FloatImage:
        """Return a picture of the planes, (H, W, C) float32 in [0, 1]."""

    def _steps(self, work: Task[ReturnT], stage: str) -> Generator[Step, None, ReturnT]:
        """Run a task that tells how many samples it has worked through."""

        def make(samples: int) -> Step:
            self._samples += samples
            return self._step(stage)

        return self._pace.steps(work, make)

    def _next_stage(self) -> None:
        self._stage, self._samples = self._stage + 1, 0

    def _end_stages(self) -> None:
        self._stage, self._samples = self._stages, 0

    def _step(self, stage: str, metrics: Mapping[str, float] | None = None, frame: str | None = None) -> Step:
        # The first planes of the noise make no picture yet.
        preview = self._preview if len(self.planes) == self._axes else None
        # What comes after the rounds counts its samples through all its stages.
        most = 1 if self._stage <= self._rounds else self._stages - self._stage
        done = round(self._units * (self._stage + min(self._samples / self._expected, most)))
        return Step(done, self._units * self._stages, stage, metrics or {}, preview, frame)


def mean(distances: NDArray[np.float64]) -> float:
    """Return the mean; 0 when there is nothing, as for a constant exemplar."""
    return float(distances.mean()) if distances.size else 0.0


def distance_curve(distances: Sequence[float], title: str) -> Curve:
    """Return the curve of a distance, round by round."""
    return Curve.of(distances, title, y_label="W1 / standard deviation")
