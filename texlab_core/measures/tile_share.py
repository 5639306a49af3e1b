"""How much of a result is one shift of the exemplar, block by block."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.registry import Measure, register

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.measures.subject import Subject

_ROWS_AT_ONCE = 128


def tile_share(
    source: NDArray[np.int32], period: tuple[int, int], look: Callable[[], None] = lambda: None
) -> float:
    """Return the share of pixels whose source lies at their block's most frequent offset.

    Parameters
    ----------
    source
        (H, W, 2) int32, row and column in the exemplar of every pixel; a negative row means that it has none,
        and such a pixel counts among all, but never as laid down.
    period
        Height and width of the exemplar: offsets are taken modulo these, and blocks are as large, the last ones
        in a row or column cut by the border.
    look
        Called between the blocks; may raise to stop.

    Returns
    -------
    float
        0 .. 1; 1 where every block is one cyclic shift of the exemplar, as in a tiling.
    """
    height, width = (int(side) for side in source.shape[:2])
    laid = 0
    for top in range(0, height, period[0]):
        for left in range(0, width, period[1]):
            look()
            block = source[top : top + period[0], left : left + period[1]]
            counts = np.zeros(period[0] * period[1], np.int64)
            for first in range(0, block.shape[0], _ROWS_AT_ONCE):
                look()
                part = block[first : first + _ROWS_AT_ONCE]
                rows = (part[:, :, 0] - np.arange(top + first, top + first + len(part))[:, None]) % period[0]
                columns = (part[:, :, 1] - np.arange(left, left + part.shape[1])) % period[1]
                offsets = (rows * period[1] + columns)[part[:, :, 0] >= 0]
                counts += np.bincount(offsets, minlength=counts.size)
            laid += int(counts.max())
    return laid / (height * width)


def _of(subject: Subject) -> float | None:
    source = subject.source
    if source is None or subject.exemplar is None or source.size == 0:
        return None
    return tile_share(source, subject.exemplar.size, subject.look)


register(
    Measure(
        id="tile-share",
        title="tiled",
        summary="Share of pixels that were copied with the most frequent shift of their block, which is as large "
        "as the exemplar: 100% for a tiling, whatever the shifts; small where many shifts were put together.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar", "source"),
        function=_of,
        form=".0%",
        live=True,
        order=31,
    )
)
