"""Every finished run of the session as a point: its job, its numbers and a small picture."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING, Any

from texlab.state.sweeps import ShownCell
from texlab.style.pictures import thinned, to_picture
from texlab_core.engine.inputs import ImageInput
from texlab_core.sheets.sweep import Cell

if TYPE_CHECKING:
    from collections.abc import Hashable

    from numpy.typing import NDArray

    from texlab.state.scene import ColumnScene
    from texlab.style.pictures import Picture
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage

# The newest ones; each takes at most 48 kB, besides the exemplar of its job.
MOST = 400
# What exemplars that are no longer in use may take together: their points are seen when one comes back.
MAX_BYTES = 32 * 2**20
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
        self._forget_exemplars({id(pixels) for pixels in _pixels_of(result)})
        self.points = tuple(self._kept.values())

    def _forget_exemplars(self, used: set[int]) -> None:
        """Forget the oldest points while the exemplars that only points hold take too much."""
        seen, held = set(used), 0
        for key, point in reversed(tuple(self._kept.items())):
            new = {id(each): each.nbytes for each in _pixels_of(point.cell) if id(each) not in seen}
            seen |= set(new)
            held += sum(new.values())
            if new and held > MAX_BYTES:
                del self._kept[key]


def _pixels_of(made: Result | Cell) -> list[NDArray[Any]]:
    """Return the pixels that the images of a job hold, those of their sources included."""
    images = [each for each in made.job.inputs.values() if isinstance(each, ImageInput)]
    origins = [each.origin.pixels for each in images if each.origin is not None]
    return [*(each.pixels for each in images), *origins]
