"""Subbands of filters that only look: oriented derivatives, spots and bars, and Gabor filters.

They show structure and do not put the image together again: derivatives and the filter bank are not made for it,
and the Gabor channels add up to the image only nearly.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.transforms import gaussian, oriented, spots_bars, steerable
from texlab_core.transforms.filters import level_size
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.stats.pyramid_kinds import PyramidKind
    from texlab_core.transforms.steerable import BandKey

# Side of the derivative filters, as De Bonet has them.
FILTER_SIDE = 5
GABOR_OCTAVES, GABOR_ORIENTATIONS = 4, 4
EDGE, LINE = "edge", "line"


def layout(kind: PyramidKind, levels: int, orientations: int) -> tuple[int, int, int]:
    """Return the number of levels, of filters at each of them, and the level of the low-pass residual."""
    if kind == "oriented":
        return levels, 2 * orientations, levels
    if kind == "filter bank":
        return levels, spots_bars.FILTERS, levels
    # The residual needs as many samples as the lowest octave.
    return GABOR_OCTAVES, GABOR_ORIENTATIONS, GABOR_OCTAVES - 1


def names(key: BandKey, kind: PyramidKind, orientations: int) -> tuple[str, str]:
    """Return title and label of a subband that is no residual."""
    level, number = key.level, key.orientation
    if kind == "oriented":
        order, number = divmod(number, orientations)
        angle = f"{180 * number / orientations:.3g}°"
        words = ("edges (first derivative)", "lines (second derivative)")[order]
        return f"level {level}, {words}, waves along {angle}", f"{(EDGE, LINE)[order]} {level}·{angle}"
    if kind == "filter bank":
        spots = len(spots_bars.SPOTS)
        if number < spots:
            count = len(spots_bars.SPOTS[number])
            return f"level {level}, spots, {count} Gaussians", f"{level}·spot {number + 1}"
        angle = f"{180 * (number - spots) // spots_bars.BARS}°"
        return f"level {level}, bars, waves along {angle}", f"{level}·{angle}"
    angle = f"{180 * number // GABOR_ORIENTATIONS}°"
    return f"1/{4 << level} cycles per pixel, waves along {angle}", f"1/{4 << level}·{angle}"


def most_derived(size: Sequence[int]) -> int:
    """Return how many levels of a Gaussian pyramid the derivative filters fit."""
    shape = (int(size[0]), int(size[1]))
    return sum(min(level_size(shape, level)) >= FILTER_SIDE for level in range(gaussian.max_levels(shape)))


def derived(
    plane: NDArray[np.float32], levels: int, orientations: int, look: Callable[[], None] = go_on
) -> Iterator[NDArray[np.float32]]:
    """Yield, for every level, the first derivatives and then the second ones, and at last the residual.

    Here and below, ``look`` is called between the steps and may raise to stop.
    """
    *filtered, residual = gaussian.build(plane, levels, look=look)
    for each in filtered:
        look()
        yield from _clockwise(oriented.derivatives(each, 1, orientations, size=FILTER_SIDE), -1)
        yield from _clockwise(oriented.derivatives(each, 2, orientations, size=FILTER_SIDE), 1)
    yield residual


def _clockwise(found: NDArray[np.float32], opposite: int) -> Iterator[NDArray[np.float32]]:
    """Yield derivatives in the order of angles towards the rows; the filters count theirs counter-clockwise.

    Clockwise by k is counter-clockwise by K - k the other way round: ``opposite`` is -1 where that turns the sign.
    """
    yield found[0]
    for each in found[:0:-1]:
        yield each if opposite > 0 else -each


def spots_and_bars(
    plane: NDArray[np.float32], levels: int, look: Callable[[], None] = go_on
) -> Iterator[NDArray[np.float32]]:
    """Yield, for every level, two spots and six bars, and at last the residual."""
    *filtered, residual = gaussian.build(plane, levels, look=look)
    for each in filtered:
        look()
        yield from spots_bars.responses(each)
    yield residual


def gabor(
    plane: NDArray[np.float32], *, magnitude: bool, look: Callable[[], None] = go_on
) -> Iterator[NDArray[np.float32]]:
    """Yield the channels from the finest octave to the lowest, and at last the residual.

    Octave l keeps every 2^l-th sample: at its Nyquist frequency its filters are down to 1 / 512.
    """
    from texlab_core.transforms.gabor import GaborTransform, Response

    height, width = plane.shape
    mirrored = steerable.mirror(plane)
    look()
    transform = GaborTransform(mirrored, look)
    for level in range(GABOR_OCTAVES):
        step = slice(None, None, 1 << level)
        for number in range(GABOR_ORIENTATIONS):
            response = transform.channel(GABOR_ORIENTATIONS * (GABOR_OCTAVES - 1 - level) + number, look)
            kept = Response(response.values[:height, :width][step, step])
            yield (kept.magnitude if magnitude else kept.even).copy()
    step = slice(None, None, 1 << (GABOR_OCTAVES - 1))
    yield transform.residual(look)[:height, :width][step, step].copy()
