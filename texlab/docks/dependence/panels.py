"""What the tab shows of one picture, computed in the background: histogram, places of the brushed cells, words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab.docks.recent import Recent, Same
from texlab.style.pictures import Lit, to_picture
from texlab_core.errors import Cancelled
from texlab_core.stats.dependence import dependence, difference

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.docks.frame import LookedAt
    from texlab.style.pictures import Picture
    from texlab_core.stats.dependence import Dependence, Pair, Rectangle, Values

CACHE_BYTES = 96 * 2**20
MARKED = (255, 179, 71)
DIMMED = 0.45

_known = Recent(CACHE_BYTES, lambda found: found.nbytes)


@dataclass(frozen=True, eq=False)
class Panel:
    """One picture and its histograms.

    Parameters
    ----------
    title
        Exemplar, or the title of the column.
    column_id
        Of the column; 0 for the exemplar.
    found
        Its histograms.
    picture
        What is shown: the pixels of the brushed cells bright on a dimmed picture, or the picture.
    lit
        The same as a veil over the picture in its column; None without a brush, and of a stage of a run.
    share
        Share of the samples that lie in the brushed cells; None without a brush.
    difference
        From the exemplar's; None for the exemplar.
    """

    title: str
    column_id: int
    found: Dependence
    picture: Picture
    share: float | None = None
    difference: float | None = None
    lit: Lit | None = None

    def words(self) -> str:
        """Return its numbers."""
        said = f"{self.title}: {self.found.information:.3f} bits"
        if self.difference is not None:
            name = "dependence" if self.found.pair.is_measure else "dependence of this pair"
            said += f", {name} {self.difference:.3f}"
        return said


def panels(
    exemplar: LookedAt,
    results: tuple[tuple[str, int, LookedAt], ...],
    pair: Pair,
    values: Values,
    brush: Rectangle | None,
    should_stop: Callable[[], bool],
) -> tuple[Panel, ...]:
    """Return the exemplar's panel and those of the results, on the exemplar's axes.

    Raises ``Cancelled`` when ``should_stop`` says so.
    """

    def look() -> None:
        if should_stop():
            raise Cancelled

    pixels = exemplar.values()
    assert pixels is not None
    first = _known.get((exemplar.key, pair, values), lambda: dependence(pixels, pair, values, None, look))
    made = [_panel("Exemplar", 0, first, exemplar, brush, None)]
    for title, column_id, shown in results:
        look()
        image = shown.values()
        assert image is not None

        def compute(image: NDArray[np.float32] = image) -> Dependence:
            return dependence(image, pair, values, first, look)

        found = _known.get((shown.key, Same(first), pair, values), compute)
        made.append(_panel(title, column_id, found, shown, brush, difference(first.ranks, found.ranks)))
    return tuple(made)


def _panel(
    title: str,
    column_id: int,
    found: Dependence,
    shown: LookedAt,
    brush: Rectangle | None,
    apart: float | None,
) -> Panel:
    image = shown.values()
    assert image is not None
    picture = to_picture(image)
    if brush is None:
        return Panel(title, column_id, found, picture, None, apart)
    top, bottom, left, right = brush
    share = float(found.joint[top : bottom + 1, left : right + 1].sum())
    pixels = found.pixels(brush)
    lit = Lit(column_id, image, veil(pixels)) if shown.stage is None else None
    return Panel(title, column_id, found, marked(picture, pixels), share, apart, lit)


def veil(pixels: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Return what lights up pixels (H, W) in a picture below, and dims the others: (H, W, 4) uint8."""
    made = np.zeros((*pixels.shape, 4), np.uint8)
    made[:, :, 3] = round(255 * (1 - DIMMED))
    made[pixels] = (*MARKED, 255)
    return made


def marked(picture: Picture, pixels: NDArray[np.bool_]) -> Picture:
    """Return a picture in dimmed gray in which some pixels (H, W) are bright."""
    gray = picture.mean(axis=2, keepdims=True) * DIMMED
    shown = np.repeat(gray.astype(np.uint8), 3, axis=2)
    shown[pixels] = MARKED
    return shown
