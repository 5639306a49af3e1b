"""Every finished run of the session as a point: its job, its numbers and a small picture."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab.state.sweeps import ShownCell
from texlab.style.pictures import to_picture
from texlab_core.sheets.sweep import Cell

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from texlab.state.scene import ColumnScene
    from texlab.style.pictures import Picture
    from texlab_core.engine.steps import FloatImage

# The newest ones; each takes at most 48 kB.
MOST = 400
SIDE = 128


def small(image: FloatImage) -> Picture:
    """Return every n-th pixel of an image as a picture of at most 128 x 128."""
    return to_picture(thinned(image))


def thinned(pixels: NDArray[Any]) -> NDArray[Any]:
    """Return every n-th pixel, at most 128 x 128, as an array of its own."""
    step = max(1, -(-max(pixels.shape[:2]) // SIDE))
    return np.ascontiguousarray(pixels[::step, ::step])


class KeptPoints:
    """Points of the columns' finished and measured runs, the newest last; the same job is one point."""

    def __init__(self) -> None:
        self.points: tuple[ShownCell, ...] = ()
        self._kept: OrderedDict[tuple[object, ...], tuple[object, ShownCell]] = OrderedDict()

    def note(self, columns: Iterable[ColumnScene]) -> None:
        """Keep what has finished and is measured; looks only at what is new."""
        changed = False
        for column in columns:
            result = column.result
            if column.status != "finished" or column.draft or result is None or not column.measures:
                continue
            key = result.job.key
            kept = self._kept.get(key)
            if kept is not None and kept[0] is column.measures:
                continue
            cell = Cell(index=column.id, job=result.job, values={}, measures=column.measures)
            # The column's picture is there already: nothing is converted in the window's thread.
            shown = small(result.image) if column.picture is None else thinned(column.picture)
            self._kept[key] = (column.measures, ShownCell(cell, shown))
            self._kept.move_to_end(key)
            while len(self._kept) > MOST:
                self._kept.popitem(last=False)
            changed = True
        if changed:
            self.points = tuple(point for _, point in self._kept.values())
