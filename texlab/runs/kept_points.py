"""Every finished run of the session as a point: its job, its numbers and a small picture."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING

from texlab.state.sweeps import ShownCell
from texlab.style.pictures import thinned, to_picture
from texlab_core.sheets.sweep import Cell

if TYPE_CHECKING:
    from collections.abc import Hashable

    from texlab.state.scene import ColumnScene
    from texlab.style.pictures import Picture
    from texlab_core.engine.steps import FloatImage

# The newest ones; each takes at most 48 kB.
MOST = 400
SIDE = 128


def small(image: FloatImage) -> Picture:
    """Return every n-th pixel of an image as a picture of at most 128 x 128."""
    return to_picture(thinned(image, SIDE))


class KeptPoints:
    """Points of the columns' finished and measured runs, the newest last; the same job is one point."""

    def __init__(self) -> None:
        self.points: tuple[ShownCell, ...] = ()
        self._kept: OrderedDict[Hashable, ShownCell] = OrderedDict()

    def note(self, column: ColumnScene) -> None:
        """Keep what a column shows, which has just been measured; drafts are no points."""
        result = column.result
        if column.status != "finished" or column.draft or result is None or column.picture is None:
            return
        key = result.job.key
        kept = self._kept.get(key)
        if not column.measures or (kept is not None and kept.cell.measures is column.measures):
            return
        cell = Cell(index=column.id, job=result.job, values={}, measures=column.measures)
        self._kept[key] = ShownCell(cell, thinned(column.picture, SIDE))
        self._kept.move_to_end(key)
        while len(self._kept) > MOST:
            self._kept.popitem(last=False)
        self.points = tuple(self._kept.values())
