"""A texture as the smoothed energy of filters, and pixels sorted by it.

*The textbook's two filters*: derivatives along both axes, squared, smoothed, and thresholded; a pixel is vertical,
horizontal, both or neither. "Vertical" are stripes that run down the rows: (dI/dx)² is large there.

*Beyond it*: root mean squares of the responses of 24 filters (spots and bars at three scales), each brought to
mean 0 and variance 1, and gathered into classes by k-means.

Reference: Forsyth and Ponce, section 11.1.1, Fig. 11.6.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.transforms import oriented, spots_bars
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Plane = NDArray[np.float32]

NEITHER, HORIZONTAL, VERTICAL, BOTH = range(4)
CLASS_NAMES = ("neither", "horizontal", "vertical", "both")
SMOOTHING = (1.0, 64.0)
# The derivative of a Gaussian of standard deviation 1, and how much of it is kept.
_SIGMA, _SIDE = 1.0, 9
SCALES = (1.0, 2.0, 4.0)
MOST_CLASSES = 8
# Responses that vary by less are constant up to rounding.
_CONSTANT = 1e-5
_SAMPLES, _ROUNDS, _STARTS = 4096, 40, 4


@dataclass(frozen=True, eq=False, slots=True)
class Representation:
    """The stages of the figure.

    Parameters
    ----------
    vertical, horizontal
        (H, W) float32: squared derivatives along the rows' and along the columns' axis.
    smooth_vertical, smooth_horizontal
        Their local means.
    threshold
        Above it a local mean counts: one for both maps.
    classes
        (H, W) uint8: 0 neither, 1 horizontal, 2 vertical, 3 both.
    """

    vertical: Plane
    horizontal: Plane
    smooth_vertical: Plane
    smooth_horizontal: Plane
    threshold: float
    classes: NDArray[np.uint8]

    @property
    def shares(self) -> tuple[float, ...]:
        """Share of the pixels in each class."""
        return tuple(
            float(each) for each in np.bincount(self.classes.reshape(-1), minlength=4) / self.classes.size
        )


def represent(plane: Plane, smoothing: float = 8.0, threshold: float = 0.5) -> Representation:
    """Sort the pixels of a plane by two filters.

    Parameters
    ----------
    plane
        (H, W) float32, at least 9 pixels a side.
    smoothing
        Standard deviation of the window in pixels, 1 to 64.
    threshold
        As a share of the mean of both smoothed maps, above 0 and at most 4.

    Raises
    ------
    ParamError
        When smoothing or threshold is out of range.
    ValueError
        When the plane is smaller than the filters.
    """
    _check_smoothing(smoothing)
    if not 0 < threshold <= 4:
        raise ParamError("threshold", "a number above 0 and at most 4", threshold)
    along_x, along_y = oriented.derivatives(plane, 1, 2, size=_SIDE, sigma=_SIGMA)
    vertical, horizontal = along_x * along_x, along_y * along_y
    smooth_vertical, smooth_horizontal = _smooth(vertical, smoothing), _smooth(horizontal, smoothing)
    # An image of one gray level has rounding for energy.
    level = max(threshold * (float(smooth_vertical.mean()) + float(smooth_horizontal.mean())) / 2, _CONSTANT**2)
    is_vertical, is_horizontal = smooth_vertical > level, smooth_horizontal > level
    classes = (is_horizontal * np.uint8(HORIZONTAL) + is_vertical * np.uint8(VERTICAL)).astype(np.uint8)
    return Representation(vertical, horizontal, smooth_vertical, smooth_horizontal, level, classes)


def energy_features(plane: Plane, smoothing: float = 12.0, look: Callable[[], None] = go_on) -> Plane:
    """Return root mean squares of 24 filters around each pixel, each of mean 0 and variance 1, (24, H, W) float32.

    Parameters
    ----------
    plane
        (H, W) float32.
    smoothing
        Standard deviation of the window in pixels, 1 to 64.
    look
        Called between the filters; may raise to stop.
    """
    _check_smoothing(smoothing)
    found = np.empty((len(SCALES) * spots_bars.FILTERS, *plane.shape), np.float32)
    for index, scale in enumerate(SCALES):
        part = found[index * spots_bars.FILTERS :][: spots_bars.FILTERS]
        part[:] = spots_bars.scaled_responses(plane, scale, look)
        for each in part:
            look()
            each[:] = np.sqrt(np.maximum(_smooth(each * each, smoothing), 0))
    flat = found.reshape(len(found), -1)
    flat -= flat.mean(axis=1, keepdims=True, dtype=np.float64).astype(np.float32)
    spread = flat.std(axis=1, keepdims=True, dtype=np.float64)
    flat *= np.where(spread > _CONSTANT, 1 / np.maximum(spread, _CONSTANT), 0).astype(np.float32)
    return found


def gather(features: Plane, classes: int, rng: np.random.Generator) -> NDArray[np.uint8]:
    """Gather pixels into classes by k-means (Lloyd's rounds from four k-means++ starts, on 4096 of the pixels).

    Parameters
    ----------
    features
        (n, H, W) float32.
    classes
        2 to 8.
    rng
        Chooses the pixels and the starts.

    Returns
    -------
    ndarray
        (H, W) uint8 labels, 0 the largest class.

    Raises
    ------
    ParamError
        When the number of classes is out of range.
    """
    if not 2 <= classes <= MOST_CLASSES:
        raise ParamError("classes", f"a whole number from 2 to {MOST_CLASSES}", classes)
    points = features.reshape(len(features), -1).T.astype(np.float32)
    sample = points[rng.permutation(len(points))[:_SAMPLES]]
    centres = min((_lloyd(sample, classes, rng) for _ in range(_STARTS)), key=lambda found: found[1])[0]
    labels = _distances(points, centres).argmin(axis=1)
    order = np.argsort(-np.bincount(labels, minlength=classes), kind="stable")
    rank = np.empty(classes, np.uint8)
    rank[order] = np.arange(classes, dtype=np.uint8)
    found: NDArray[np.uint8] = rank[labels].reshape(features.shape[1:])
    return found


def _lloyd(sample: Plane, classes: int, rng: np.random.Generator) -> tuple[Plane, float]:
    """Return centres and the sum of squared distances from them."""
    centres = sample[rng.integers(len(sample))][None]
    while len(centres) < classes:
        nearest = np.maximum(_distances(sample, centres).min(axis=1), 0).astype(np.float64)
        total = nearest.sum()
        chance = nearest / total if total > 0 else None
        centres = np.concatenate([centres, sample[rng.choice(len(sample), p=chance)][None]])
    labels = np.full(len(sample), -1)
    for _ in range(_ROUNDS):
        distances = _distances(sample, centres)
        before, labels = labels, distances.argmin(axis=1)
        if (before == labels).all():
            break
        for label in range(classes):
            if (members := labels == label).any():
                centres[label] = sample[members].mean(axis=0)
    return centres, float(_distances(sample, centres).min(axis=1).sum())


def _distances(points: Plane, centres: Plane) -> Plane:
    squares: Plane = np.square(centres).sum(axis=1) - 2 * points @ centres.T
    squares += np.square(points).sum(axis=1)[:, None]
    return squares


def _smooth(plane: Plane, sigma: float) -> Plane:
    import cv2

    return np.asarray(cv2.GaussianBlur(plane, (0, 0), sigma, borderType=cv2.BORDER_REFLECT_101), np.float32)


def _check_smoothing(smoothing: float) -> None:
    low, high = SMOOTHING
    if not low <= smoothing <= high:
        raise ParamError("smoothing", f"a number of pixels from {low:g} to {high:g}", smoothing)
