"""Fine details by place: single pixels that stand out, places without details, contrast of neighbourhoods."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.registry import Measure, register
from texlab_core.transforms.luma import luma
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

SIDE = 16
SMALLEST = 2 * SIDE
# A place counts as empty below this share of what all but a hundredth of the exemplar's places have.
EMPTY = 0.7
# Two gray levels: what stands out by less is not seen.
VISIBLE = 2 / 255
_FLOOR = 1e-6


def stands_out(image: FloatImage, look: Callable[[], None]) -> NDArray[np.float32]:
    """Return |luminance - median of 3 x 3| of every pixel, (H, W) float32; borders are repeated."""
    import cv2

    gray = luma(image)
    padded = np.pad(gray, 1, mode="edge")
    found = np.empty_like(gray)
    for rows in row_blocks(gray.shape, 2**17):
        look()
        part = np.ascontiguousarray(padded[rows.start : rows.stop + 2])
        found[rows] = np.abs(part - cv2.medianBlur(part, 3))[1:-1, 1:-1]
    return found


def speck_map(subject: Subject) -> NDArray[np.bool_]:
    """Return which pixels (H, W) stand out more than all but a hundredth of the exemplar's pixels do."""
    limit = subject.prepared(
        "stands out", lambda pixels, look: float(np.percentile(stands_out(pixels, look), 99)) + VISIBLE
    )
    return subject.once("specks", lambda: stands_out(subject.image, subject.look) > limit)


def specks(subject: Subject) -> float | None:
    """Return the share of :func:`speck_map`."""
    if min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < 3:
        return None
    return float(np.mean(speck_map(subject)))


def detail_map(image: FloatImage, look: Callable[[], None]) -> NDArray[np.float64]:
    """Return the mean squared gradient of the luminance in every whole place of 16 x 16 pixels."""
    import cv2

    gray = luma(image)
    rows, columns = (side // SIDE for side in gray.shape)
    found = np.empty((rows, columns))
    padded = np.pad(gray, 1, mode="reflect")
    for row in range(rows):
        look()
        part = np.ascontiguousarray(padded[row * SIDE : (row + 1) * SIDE + 2])
        down, across = (cv2.Sobel(part, cv2.CV_32F, dx, 1 - dx, ksize=3)[1:-1, 1:-1] for dx in (0, 1))
        energy = (np.square(down) + np.square(across))[:, : columns * SIDE]
        found[row] = energy.reshape(SIDE, columns, SIDE).mean(axis=(0, 2), dtype=np.float64)
    return found


def empty_map(subject: Subject) -> NDArray[np.bool_]:
    """Return which places of 16 x 16 pixels have fewer details than any place of the exemplar."""
    limit = subject.prepared(
        "details", lambda pixels, look: EMPTY * float(np.percentile(detail_map(pixels, look), 1))
    )
    return subject.once("empty places", lambda: detail_map(subject.image, subject.look) < limit)


def empty_share(subject: Subject) -> float | None:
    """Return the share of :func:`empty_map`; None where picture or exemplar are under 32 pixels."""
    if min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < SMALLEST:
        return None
    return float(np.mean(empty_map(subject)))


def place_deviation(image: FloatImage, look: Callable[[], None]) -> float:
    """Return the median standard deviation of the luminance in places of 16 x 16 pixels."""
    gray = luma(image)
    rows, columns = (side // SIDE for side in gray.shape)
    found = np.empty((rows, columns))
    for row in range(rows):
        look()
        part = gray[row * SIDE : (row + 1) * SIDE, : columns * SIDE].astype(np.float64)
        found[row] = part.reshape(SIDE, columns, SIDE).std(axis=(0, 2))
    return float(np.median(found))


def local_contrast(subject: Subject) -> float | None:
    """Return the ratio of :func:`place_deviation`, picture over exemplar; None for a flat or small exemplar."""
    if min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < SMALLEST:
        return None
    own = subject.prepared("place deviation", place_deviation)
    if own < _FLOOR:
        return None
    return place_deviation(subject.image, subject.look) / own


register(
    Measure(
        id="specks",
        title="specks",
        summary="Share of pixels that stand out from their eight neighbours more than all but a hundredth of the "
        "exemplar's do: 1% is usual, above 2% the result is noisy.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=specks,
        form=".1%",
        order=67,
    )
)
register(
    Measure(
        id="empty-share",
        title="empty",
        summary="Share of places of 16 x 16 pixels with fewer details than any place of the exemplar: smears.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=empty_share,
        form=".1%",
        order=68,
    )
)
register(
    Measure(
        id="local-contrast",
        title="local contrast",
        summary="Contrast within places of 16 x 16 pixels (median of the standard deviations of luminance), as a "
        "multiple of the exemplar's: 1 is right.",
        low=0.0,
        high=1e4,
        better="neither",
        needs=("exemplar",),
        function=local_contrast,
        form=".2f",
        order=69,
    )
)
