"""Steerable pyramid: real, in the Fourier domain, for any size and 1 to 18 orientations.

The image is split into a high-pass residual, ``levels`` x ``orientations`` oriented bands (level 0 is the finest;
a level has ceil(N / 2^level) samples a side) and a low-pass residual. Orientation j answers most to waves that run
along the angle pi j / K, counted from the columns' axis towards the rows' (0: vertical stripes). The transform is
self-inverting: the collapse filters each band with its own filter again and adds them up.

The image is taken as periodic. :func:`build_reflected` analyzes it as mirrored at its borders instead.

Reference: Heeger and Bergen 1995, section 2.1; Simoncelli and Freeman 1995; Forsyth and Ponce, section 11.2.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from texlab_core.transforms import filters, fourier
from texlab_core.transforms.filters import Size, level_size, spectrum_size
from texlab_core.work.tasks import finish, go_on, row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from texlab_core.work.tasks import Task

Plane = NDArray[Any]
Spectrum = NDArray[Any]

MAX_ORIENTATIONS = 18


@dataclass(frozen=True, slots=True, eq=False)
class SteerablePyramid:
    """The subbands of one plane.

    Parameters
    ----------
    highpass
        (H, W), what lies beyond the first low-pass (the corners of the spectrum).
    bands
        ``bands[level][orientation]``, (ceil(H / 2^level), ceil(W / 2^level)).
    lowpass
        (ceil(H / 2^levels), ceil(W / 2^levels)); its mean is the image's.
    """

    highpass: Plane
    bands: tuple[tuple[Plane, ...], ...]
    lowpass: Plane

    @property
    def levels(self) -> int:
        """Number of levels of oriented bands."""
        return len(self.bands)

    @property
    def orientations(self) -> int:
        """Number of orientations, 1 when there are no levels."""
        return len(self.bands[0]) if self.bands else 1

    def items(self) -> Iterator[tuple[BandKey, Plane]]:
        """Yield every subband with its place, from fine to coarse."""
        yield BandKey("highpass"), self.highpass
        for level, row in enumerate(self.bands):
            for orientation, band in enumerate(row):
                yield BandKey("oriented", level, orientation), band
        yield BandKey("lowpass", self.levels), self.lowpass


@dataclass(frozen=True, slots=True)
class BandKey:
    """Place of a subband in the pyramid."""

    kind: Literal["highpass", "oriented", "bandpass", "lowpass"]
    level: int = 0
    orientation: int = 0

    @property
    def label(self) -> str:
        """Short name: ``high``, ``l0-o1``, ``l0`` (of a Laplacian pyramid) or ``low``."""
        if self.kind == "oriented":
            return f"l{self.level}-o{self.orientation}"
        return f"l{self.level}" if self.kind == "bandpass" else self.kind.removesuffix("pass")


def band_keys(levels: int, orientations: int) -> tuple[BandKey, ...]:
    """Return the places of all subbands, from fine to coarse."""
    oriented = (BandKey("oriented", level, index) for level in range(levels) for index in range(orientations))
    return (BandKey("highpass"), *oriented, BandKey("lowpass", levels))


def max_levels(size: Sequence[int]) -> int:
    """Return the largest number of levels that leaves a low-pass residual of at least 2 samples a side."""
    return max(0, min(size[0], size[1]).bit_length() - 2)


def build(image: Plane, levels: int, orientations: int) -> SteerablePyramid:
    """Split a plane into its subbands.

    Parameters
    ----------
    image
        (H, W) float32 or float64, taken as periodic.
    levels
        0 .. :func:`max_levels`.
    orientations
        K, 1 .. 18.

    Returns
    -------
    SteerablePyramid
        Bands of the image's type.

    Raises
    ------
    ValueError
        When the plane, ``levels`` or ``orientations`` cannot be used.
    """
    transform = Transform.of(image, levels, orientations)
    spectrum = transform.forward(image)
    planes = [transform.band(spectrum, key) for key in transform.keys]
    return _assemble(planes, levels, orientations)


def collapse(pyramid: SteerablePyramid) -> Plane:
    """Return the plane that a pyramid was built from, within 5e-6 (float32) or 1e-13 (float64) on [0, 1]."""
    transform = Transform.of(pyramid.highpass, pyramid.levels, pyramid.orientations)
    total = transform.empty_sum()
    for key, plane in pyramid.items():
        transform.add(total, key, plane)
    return transform.inverse(total)


def build_reflected(image: Plane, levels: int, orientations: int) -> SteerablePyramid:
    """Split a plane that is mirrored at its borders (each outermost pixel is repeated).

    The bands have the same sizes as those of :func:`build`: of the pyramid of the mirrored plane of (2H, 2W), each
    band's first quadrant is kept. They cannot be collapsed.

    Reference: Heeger and Bergen 1995, section 2.4.
    """
    mirrored = mirror(image)
    transform = Transform.of(mirrored, levels, orientations)
    spectrum = transform.forward(mirrored)
    planes = [quadrant(transform.band(spectrum, key), image.shape, key.level) for key in transform.keys]
    return _assemble(planes, levels, orientations)


def mirror(image: Plane) -> Plane:
    """Return the plane with its mirror images, (2H, 2W)."""
    return np.pad(image, ((0, image.shape[0]), (0, image.shape[1])), mode="symmetric")


def quadrant(band: Plane, size: Sequence[int], level: int) -> Plane:
    """Return the part of a mirrored plane's band that lies on the plane itself."""
    height, width = level_size((size[0], size[1]), level)
    return np.ascontiguousarray(band[:height, :width])


def _assemble(planes: Sequence[Plane], levels: int, orientations: int) -> SteerablePyramid:
    rows = [tuple(planes[1 + level * orientations :][:orientations]) for level in range(levels)]
    return SteerablePyramid(planes[0], tuple(rows), planes[-1])


@dataclass(frozen=True, slots=True)
class Transform:
    """The pyramid of one size, band by band, for callers that never need all bands at once."""

    size: Size
    levels: int
    orientations: int
    dtype: np.dtype[Any]

    @classmethod
    def of(cls, image: Plane, levels: int, orientations: int) -> Transform:
        """Return the transform that fits a plane; raises ``ValueError`` when there is none."""
        if image.ndim != 2 or image.size == 0 or image.dtype not in (np.float32, np.float64):
            raise ValueError(f"A plane must be (H, W), float32 or float64, got {image.shape} {image.dtype}.")
        size = (int(image.shape[0]), int(image.shape[1]))
        if not 0 <= levels <= max_levels(image.shape):
            raise ValueError(f"levels: must be from 0 to {max_levels(size)} for {size}, got {levels}.")
        if not 1 <= orientations <= MAX_ORIENTATIONS:
            raise ValueError(f"orientations: must be from 1 to {MAX_ORIENTATIONS}, got {orientations}.")
        return cls(size, levels, orientations, image.dtype)

    @property
    def keys(self) -> tuple[BandKey, ...]:
        """The places of all subbands, from fine to coarse."""
        return band_keys(self.levels, self.orientations)

    def response(self, key: BandKey) -> Task[Plane]:
        """Return the real response of a band on its cropped half spectrum.

        The residual below another number of levels may be asked for as well.
        """
        if key.kind == "highpass":
            return (yield from filters.highpass(self.size, self.dtype))
        if key.kind == "lowpass":
            return (yield from filters.lowpass(self.size, key.level, self.dtype))
        responses = yield from filters.oriented(self.size, key.level, self.orientations, self.dtype)
        response: Plane = responses[key.orientation]
        return response

    def forward(self, image: Plane, look: Callable[[], None] = go_on) -> Spectrum:
        """Return the half spectrum of a plane, scaled so that its first entry is the mean.

        Here and below, ``look`` is called between pieces and may raise to stop.
        """
        return finish(fourier.rfft2(image), look)

    def inverse(self, total: Spectrum, look: Callable[[], None] = go_on) -> Plane:
        """Return the plane of a half spectrum, which is overwritten."""
        return finish(fourier.irfft2(total, self.size), look)

    def band(self, spectrum: Spectrum, key: BandKey, look: Callable[[], None] = go_on) -> Plane:
        """Return one subband from the plane's spectrum."""
        return finish(self.band_task(spectrum, key), look)

    def band_task(self, spectrum: Spectrum, key: BandKey) -> Task[Plane]:
        """Do :meth:`band` in pieces."""
        response = yield from self.response(key)
        size = level_size(self.size, key.level)
        part = np.empty(spectrum_size(size), spectrum.dtype)
        for here, there in crop_blocks(self.size, size):
            np.multiply(spectrum[there], response[here], out=part[here])
            yield part[here].size // 8
        if key.kind == "oriented":
            quarter_turns(part, -(self.orientations - 1))
        return (yield from fourier.irfft2(part, size))

    def empty_sum(self) -> Spectrum:
        """Return a spectrum to which :meth:`add` adds bands."""
        return np.zeros(spectrum_size(self.size), np.result_type(self.dtype, np.complex64))

    def add(self, total: Spectrum, key: BandKey, plane: Plane, look: Callable[[], None] = go_on) -> None:
        """Filter one subband again and add it to the spectrum of the collapsed plane."""
        part = finish(self.filtered_task(key, plane), look)
        finish(self.add_task(total, key, part), look)

    def filtered_task(self, key: BandKey, plane: Plane) -> Task[Spectrum]:
        """Return the spectrum of one subband, filtered again, in pieces."""
        response = yield from self.response(key)
        part = yield from fourier.rfft2(plane)
        for rows in row_blocks(part.shape):
            np.multiply(part[rows], response[rows], out=part[rows])
            yield part[rows].size // 8
        if key.kind == "oriented":
            quarter_turns(part, self.orientations - 1)
        return part

    def add_task(self, total: Spectrum, key: BandKey, part: Spectrum) -> Task[None]:
        """Add what :meth:`filtered_task` returned to the spectrum of the collapsed plane."""
        for here, there in crop_blocks(self.size, level_size(self.size, key.level)):
            total[there] += part[here]
            yield part[here].size // 8


def crop_blocks(size: Size, crop: Size) -> list[tuple[Any, Any]]:
    """Return pairs of blocks: the crop's rows of either sign, and where the whole spectrum has them."""
    above, columns = (crop[0] + 1) // 2, slice(0, crop[1] // 2 + 1)
    pairs = []
    for start, stop, shift in ((0, above, 0), (above, crop[0], size[0] - crop[0])):
        for rows in row_blocks((stop - start, columns.stop)):
            here = slice(start + rows.start, start + rows.stop)
            pairs.append(((here, columns), (slice(here.start + shift, here.stop + shift), columns)))
    return pairs


def quarter_turns(part: Spectrum, quarters: int) -> None:
    """Multiply by i^quarters, in place."""
    quarters %= 4
    if quarters == 2:
        np.negative(part, out=part)
    elif quarters:
        np.multiply(part, 1j if quarters == 1 else -1j, out=part)
