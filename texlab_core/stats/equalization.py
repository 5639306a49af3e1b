"""Histogram equalization of any two planes: both cumulative histograms, and the way of one value through them.

A value v of image two has the share p of the image at or below it; the new value v' is the smallest one of image
one with at least that share. Equal values of image two stay equal so, and the histogram of a picture with few
values cannot become that of another; the text then deals equal values out at random.

Reference: Forsyth and Ponce, section 11.3.2, algorithm 11.3, Fig. 11.15.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from texlab_core.errors import InputError, ParamError
from texlab_core.stats.histogram import Sample, match_ranks, sorted_sample

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Plane = NDArray[np.float32]
    Floats = NDArray[np.float64]

Ties = Literal["random", "together"]
_CURVE_POINTS = 512


@dataclass(frozen=True, slots=True)
class Arrow:
    """The way v -> p -> v' of one value."""

    value: float
    share: float
    new_value: float


@dataclass(frozen=True, eq=False, slots=True)
class Equalization:
    """Two planes and their cumulative histograms.

    Parameters
    ----------
    one
        (m,) float32, sorted: the values whose distribution is wanted.
    two
        (n,) float32, sorted: the values that are changed.
    plane
        (H, W) float32: image two.
    """

    one: Sample
    two: Sample
    plane: Plane

    def arrow(self, value: float) -> Arrow:
        """Return where a value of image two goes."""
        share = self.share_below(value)
        return Arrow(value, share, self.inverse(share))

    def share_below(self, value: float) -> float:
        """Return c2(v): the share of image two at or below a value."""
        return float(np.searchsorted(self.two, np.float32(value), side="right")) / self.two.size

    def inverse(self, share: float) -> float:
        """Return ic1(p): the smallest value of image one that at least this share lies at or below."""
        place = int(np.ceil(share * self.one.size - 1e-9)) - 1
        return float(self.one[min(max(place, 0), self.one.size - 1)])

    def remapped(self, ties: Ties = "random", key: int = 0) -> Plane:
        """Return image two with image one's histogram.

        Parameters
        ----------
        ties
            ``random`` deals equal values out at random, so that the histogram is met exactly; ``together`` keeps
            them equal, as algorithm 11.3 does word for word.
        key
            64-bit key of the random order.

        Raises
        ------
        ParamError
            When ``ties`` is neither.
        """
        if ties not in get_args(Ties):
            raise ParamError("ties", f"one of {', '.join(get_args(Ties))}", ties)
        if ties == "random":
            return match_ranks(self.plane, self.one, key)
        counts = np.searchsorted(self.two, self.plane, side="right").astype(np.int64)
        # The place of the smallest value with at least that share, in whole numbers.
        places = -(-counts * self.one.size // self.two.size) - 1
        found: Plane = self.one[np.clip(places, 0, self.one.size - 1)]
        return found

    def curves(self) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats]]:
        """Return (values, shares) of the cumulative histograms of image one and of image two."""
        return cumulative(self.one), cumulative(self.two)

    def distance(self, other: Plane) -> float:
        """Return the mean distance between the sorted values of a plane and image one's (Wasserstein-1)."""
        from texlab_core.stats.histogram import resample

        values = sorted_sample(other)
        return float(np.abs(values.astype(np.float64) - resample(self.one, values.size)).mean())


def equalization(two: NDArray[Any], one: NDArray[Any]) -> Equalization:
    """Prepare the equalization of image two to the histogram of image one.

    Parameters
    ----------
    two, one
        Planes of any size: gray images, subbands, or any stage of a result.

    Raises
    ------
    InputError
        When one is empty or holds values that are not finite.
    """
    for name, plane in (("two", two), ("one", one)):
        if plane.size == 0 or not np.isfinite(plane).all():
            raise InputError(f"Image {name} must have values, all of them finite.")
    plane = np.ascontiguousarray(two, np.float32)
    return Equalization(sorted_sample(one), sorted_sample(plane), plane)


def cumulative(sample: Sample) -> tuple[Floats, Floats]:
    """Return values and shares of a sorted sample's cumulative histogram: a staircase of up to 1024 points."""
    values, last = np.unique(sample, return_index=True)
    shares = np.append(last[1:], sample.size) / sample.size
    if values.size > _CURVE_POINTS:
        kept = np.unique(np.linspace(0, values.size - 1, _CURVE_POINTS).astype(np.intp))
        values, shares = values[kept], shares[kept]
    steps = np.concatenate([[0.0], np.repeat(shares, 2)[:-1]])
    return np.repeat(values.astype(np.float64), 2), np.asarray(steps, np.float64)


def ramp(side: int = 256) -> Plane:
    """Return the figure's linear ramp, (side / 4, side) float32: gray levels 0 to 1 from left to right."""
    return np.ascontiguousarray(
        np.broadcast_to(np.linspace(0, 1, side, dtype=np.float32), (max(1, side // 4), side))
    )


def cube_root_ramp(side: int = 256) -> Plane:
    """Return the figure's other ramp: the cube roots of the linear one."""
    return np.cbrt(ramp(side))
