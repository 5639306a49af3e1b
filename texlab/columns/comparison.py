"""Two results in one pane: the difference is computed in a thread of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.runs.worker import Worker
from texlab.widgets.pair_layer import PairLayer

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtCore import QObject


def other_of(a: int, order: tuple[int, ...], before: int) -> int | None:
    """Return the column that one is compared with: the one chosen before it, else its neighbour.

    Parameters
    ----------
    a
        Id of the chosen column.
    order
        Ids of all columns, from left to right.
    before
        Id of the column that was chosen before; it need not be there any more.
    """
    if before in order and before != a:
        return before
    if a not in order or len(order) < 2:
        return None
    place = order.index(a)
    return order[place + 1] if place + 1 < len(order) else order[place - 1]


class Comparison(PairLayer):
    """Lays the picture of column B over the pane of column A."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(self._submit, parent)
        self._worker = Worker("comparison", parent=self)
        self._worker.finished.connect(self._came)

    def close(self) -> None:
        """Stop and join the thread."""
        self._worker.close()

    def _submit(self, work: Callable[[], Any], done: Callable[[Any], None]) -> None:
        self._worker.submit(lambda task: work())
