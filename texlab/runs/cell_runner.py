"""Many cells at work, of a sweep or of a search: their thread, and what there is to see of them."""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab.runs.scene_runner import SceneRunner
from texlab_core.errors import InputError
from texlab_core.warming import Need

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtCore import QObject

    from texlab.runs.column_run import TaskLike
    from texlab.runs.slots import Slots
    from texlab.runs.worker import Request
    from texlab.state.chosen import Column, State
    from texlab.state.sweeps import CellsScene, ShownCell
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.warming import Warmth


def workers() -> int:
    """Return how many cells are made side by side: one core is left to the columns."""
    return max(1, (os.cpu_count() or 1) - 1)


@dataclass(frozen=True, eq=False)
class CellsMade:
    """The cells that have finished so far, in the order of finishing, the share done, and what else came of it."""

    cells: tuple[ShownCell, ...]
    fraction: float
    more: dict[str, Any] = dataclasses.field(default_factory=dict)


class Teller:
    """Keeps what has finished, and reports it (in the worker's thread)."""

    def __init__(self, task: TaskLike) -> None:
        self._task = task
        self._made: list[ShownCell] = []
        self._fraction = 0.0
        self._more: dict[str, Any] = {}

    def tell(self, **more: Any) -> None:
        """Report what else there is to see of it, with this and every later report."""
        self._more |= more
        self._report()

    def _report(self) -> None:
        self._task.progress(CellsMade(tuple(self._made), self._fraction, self._more))

    def add(self, cell: ShownCell) -> None:
        """Report another cell."""
        self._made.append(cell)
        self._report()

    def advance(self, share: float) -> None:
        """Report the share done, when that is due."""
        self._fraction = share
        if self._task.due():
            self._report()

    def end(self, **more: Any) -> CellsMade:
        """Return everything at the end."""
        return CellsMade(tuple(self._made), 1.0, self._more | more)


class CellRunner(SceneRunner):
    """Runs the cells that were asked for last; see :class:`SceneRunner`.

    Parameters
    ----------
    name, scene
        As there.
    slots, warmth
        Places on the cores, of which every cell takes one of its own, and what is loaded.
    """

    def __init__(
        self, name: str, scene: CellsScene, slots: Slots, warmth: Warmth, parent: QObject | None = None
    ) -> None:
        super().__init__(name, scene, None, parent)
        self._slots = slots
        self._warmth = warmth
        self._worker.progressed.connect(self._progressed)
        self._worker.finished.connect(lambda made: self._progressed(made, status="finished"))
        self._worker.failed.connect(lambda sentence: self._show(status="failed", problem=sentence))
        self._worker.cancelled.connect(lambda: self._show(status="stopped"))

    def _begin(
        self,
        state: State,
        column_id: int,
        exemplar: ImageInput | None,
        make: Callable[[Column, ImageInput], tuple[CellsScene, Request]],
        **asked: Any,
    ) -> None:
        """Run what ``make`` returns; what cannot be run is said in ``scene.problem``, and what runs goes on."""
        column = state.column(column_id)
        if column is None or exemplar is None:
            self._show(problem="There is no exemplar yet.", **asked)
            return
        try:
            scene, request = make(column, exemplar)
        except InputError as error:
            self._show(problem=str(error), **asked)
            return
        self.scene = dataclasses.replace(
            scene, number=self.scene.number + 1, column_id=column_id, status="running"
        )
        need, warmth = Need(column.method, exemplar.channels), self._warmth
        self._worker.submit(request, first=lambda task: warmth.wait(need, task.should_stop))
        self.changed.emit()

    def _progressed(self, made: CellsMade, **more: Any) -> None:
        self._show(cells=made.cells, fraction=made.fraction, **made.more, **more)
