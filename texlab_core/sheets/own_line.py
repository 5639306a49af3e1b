"""The exemplar's own line: the numbers of a real other piece of the same picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.engine.inputs import Crop
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import Subject

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from texlab_core.engine.inputs import ImageInput

# Of the exemplar's area: pieces that share more with it say little.
MOST_SHARED = 0.25


def other_place(size: tuple[int, int], crop: Crop) -> Crop | None:
    """Return the corner piece of a picture, as large as a crop, that shares least with it, of equals the farthest.

    Parameters
    ----------
    size
        Height and width of the picture.
    crop
        A part of it.

    Returns
    -------
    Crop or None
        None when every corner piece shares more than a quarter of its area with the crop.
    """
    height, width = size
    places = [(top, left) for top in (0, height - crop.height) for left in (0, width - crop.width)]

    def shared(place: tuple[int, int]) -> int:
        rows = max(0, crop.height - abs(place[0] - crop.top))
        return rows * max(0, crop.width - abs(place[1] - crop.left))

    def away(place: tuple[int, int]) -> int:
        return abs(place[0] - crop.top) + abs(place[1] - crop.left)

    best = min(places, key=lambda place: (shared(place), -away(place)))
    if shared(best) > MOST_SHARED * crop.height * crop.width:
        return None
    return Crop(top=best[0], left=best[1], height=crop.height, width=crop.width)


def own_measures(
    exemplar: ImageInput, ids: Iterable[str] | None = None, should_stop: Callable[[], bool] | None = None
) -> dict[str, float]:
    """Measure a real other piece of the exemplar's source as if it were a result.

    Parameters
    ----------
    exemplar
        What results are compared with.
    ids
        Which measures; None takes all but the slow ones.
    should_stop
        Asked every few milliseconds.

    Returns
    -------
    dict
        By id; empty when the source is not known or hardly larger than the exemplar.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    """
    origin = exemplar.origin
    if origin is None or origin.crop is None:
        return {}
    height, width = origin.pixels.shape[:2]
    size = (max(1, round(height * origin.scale)), max(1, round(width * origin.scale)))
    place = other_place(size, origin.crop)
    if place is None:
        return {}
    piece = as_exemplar(origin.pixels, scale=origin.scale, crop=place, should_stop=should_stop)
    return measure_all(Subject.of_images(exemplar, piece, should_stop=should_stop), ids)
