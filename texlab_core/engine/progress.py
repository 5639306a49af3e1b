"""Progress through named stages of known weight."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from texlab_core.engine.steps import FloatImage, Step
from texlab_core.work.tasks import relay

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Mapping

    from texlab_core.work.tasks import Task

ValueT = TypeVar("ValueT")
_UNITS = 1000


class Progress:
    """Turns "this stage, this fraction" into Steps.

    Parameters
    ----------
    stages
        Weight of every stage by name, in their order.
    """

    def __init__(self, stages: Mapping[str, float]) -> None:
        total = sum(stages.values())
        self._span: dict[str, tuple[float, float]] = {}
        start = 0.0
        for name, weight in stages.items():
            self._span[name] = (start, start + weight / total)
            start += weight / total

    def at(self, stage: str, fraction: float = 1.0, preview: Callable[[], FloatImage] | None = None) -> Step:
        """Return the Step for a fraction of a stage."""
        low, high = self._span[stage]
        done = round(_UNITS * (low + (high - low) * fraction))
        return Step(min(done, _UNITS), _UNITS, stage, preview=preview)

    def ended(self) -> Progress:
        """Return one whose Steps all tell the end of their stage: for work whose length was not foreseen."""
        other = Progress.__new__(Progress)
        other._span = {name: (high, high) for name, (_, high) in self._span.items()}
        return other

    def follow(
        self, fractions: Generator[float, None, ValueT], stage: str, low: float = 0.0, high: float = 1.0
    ) -> Generator[Step, None, ValueT]:
        """Turn a generator of fractions into Steps between two fractions of a stage."""
        return relay(fractions, lambda fraction: self.at(stage, low + (high - low) * fraction))

    def count(self, task: Task[ValueT], stage: str, total: int) -> Generator[Step, None, ValueT]:
        """Turn a task that tells how much it has worked, ``total`` in all, into Steps of a stage."""
        done = 0

        def tell(work: int) -> Step:
            nonlocal done
            done = min(total, done + work)
            return self.at(stage, done / total)

        return relay(task, tell)
