"""Steerable pyramids of all slices of a solid across one axis, matched band by band.

A band is the same subband of all slices: its histogram is pooled over them, and the low-pass residual is left as
it is. Matching slice by slice instead, the residual too, is the literal reading of the paper: what is coarse in a
slice then changes from slice to slice at full strength, and the other two cuts show it as streaks.

Reference: Heeger and Bergen 1995, section 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from texlab_core.methods.heeger_bergen.rounds import match
from texlab_core.transforms.filters import level_size, spectrum_size
from texlab_core.transforms.steerable import Transform, band_keys, crop_blocks, max_levels
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab_core.methods.heeger_bergen.analysis import PlaneModel
    from texlab_core.transforms.steerable import BandKey
    from texlab_core.work.tasks import Task

Volume = NDArray[np.float32]

# Which axes of a solid (depth, height, width) become slices, rows and columns, by the plane of the slices.
CUTS = {"xy": (0, 1, 2), "xz": (1, 0, 2), "yz": (2, 0, 1)}
# Samples of one batch of transforms: about 5 ms.
BATCH = 2**17


@dataclass(frozen=True, slots=True)
class SlicePlan:
    """How the slices of a solid are matched.

    Parameters
    ----------
    levels, orientations
        Of the pyramids; fewer levels are used where a slice is too small.
    pooled
        Whether a band is matched over all slices at once, without the low-pass residual.
    """

    levels: int
    orientations: int
    pooled: bool

    def keys(self, size: tuple[int, int]) -> tuple[BandKey, ...]:
        """Return the places of the bands that are matched in slices of this size, from fine to coarse."""
        keys = band_keys(self.levels_of(size), self.orientations)
        return keys[:-1] if self.pooled else keys

    def levels_of(self, size: tuple[int, int]) -> int:
        """Return how many levels slices of this size have."""
        return min(self.levels, max_levels(size))


def match_slices(
    slices: Volume, model: PlaneModel, plan: SlicePlan, tie_key: Callable[[int, int], int]
) -> Task[tuple[Volume, NDArray[np.float64]]]:
    """Match every band of the slices of a solid.

    Parameters
    ----------
    slices
        (N, h, w) float32, C-contiguous; stays as it is.
    model
        Targets of the exemplar's plane.
    plan
        How.
    tie_key
        ``tie_key(band, slice)`` gives a key for each place in the order of ``plan.keys``; slice 0 for all when
        they are pooled.

    Yields
    ------
    int
        Samples worked through since the last time.

    Returns
    -------
    slices
        (N, h, w) float32.
    distances
        (bands,) float64: W1 / sd of every band before it was matched; the mean over the slices when they are
        matched one by one.
    """
    whole = Slices.of(slices, plan)
    spectrum = yield from whole.forward(slices)
    total = np.zeros_like(spectrum)
    distances = []
    for index, key in enumerate(plan.keys(whole.size)):
        band = yield from whole.band(spectrum, key)
        if plan.pooled:
            distances.append((yield from match(band, model.bands[key], "exact", tie_key(index, 0))))
        else:
            shares = []
            for number, each in enumerate(band):
                shares.append((yield from match(each, model.bands[key], "exact", tie_key(index, number))))
            distances.append(float(np.mean(shares)))
        yield from whole.add(total, key, band)
    if plan.pooled:
        yield from whole.keep_lowpass(total, spectrum)
    return (yield from whole.inverse(total)), np.array(distances)


@dataclass(frozen=True, slots=True)
class Slices:
    """The pyramid of one slice, applied to batches of them."""

    transform: Transform
    many: int

    @classmethod
    def of(cls, slices: Volume, plan: SlicePlan) -> Slices:
        """Return the pyramid that fits slices (N, h, w)."""
        size = (int(slices.shape[1]), int(slices.shape[2]))
        return cls(Transform.of(slices[0], plan.levels_of(size), plan.orientations), len(slices))

    @property
    def size(self) -> tuple[int, int]:
        """Height and width of a slice."""
        return self.transform.size

    def batches(self, size: tuple[int, int]) -> Iterator[slice]:
        """Return the slices in batches, for transforms of this size."""
        return iter(row_blocks((self.many, *size), BATCH))

    def forward(self, slices: Volume) -> Task[NDArray[Any]]:
        """Return the half spectra of all slices."""
        from scipy import fft

        spectrum = np.empty((self.many, *spectrum_size(self.size)), np.complex64)
        for batch in self.batches(self.size):
            spectrum[batch] = fft.rfft2(slices[batch], norm="forward")
            yield slices[batch].size
        return spectrum

    def inverse(self, total: NDArray[Any]) -> Task[Volume]:
        """Return the slices of half spectra, which are overwritten."""
        from scipy import fft

        slices = np.empty((self.many, *self.size), np.float32)
        for batch in self.batches(self.size):
            slices[batch] = fft.irfft2(total[batch], s=self.size, norm="forward", overwrite_x=True)
            yield slices[batch].size
        return slices

    def band(self, spectrum: NDArray[Any], key: BandKey) -> Task[Volume]:
        """Return one subband of all slices."""
        from scipy import fft

        from texlab_core.kernels import spectra

        response = yield from self.transform.response(key)
        size = level_size(self.size, key.level)
        band = np.empty((self.many, *size), np.float32)
        for batch in self.batches(size):
            part = np.empty((batch.stop - batch.start, *spectrum_size(size)), spectrum.dtype)
            spectra.crop(spectrum[batch], response, -self._quarters(key) % 4, part)
            band[batch] = fft.irfft2(part, s=size, norm="forward", overwrite_x=True)
            yield band[batch].size
        return band

    def add(self, total: NDArray[Any], key: BandKey, band: Volume) -> Task[None]:
        """Filter a subband of all slices again and add it to their half spectra."""
        from scipy import fft

        from texlab_core.kernels import spectra

        response = yield from self.transform.response(key)
        size = level_size(self.size, key.level)
        for batch in self.batches(size):
            part = fft.rfft2(band[batch], norm="forward")
            spectra.add(part, response, self._quarters(key), total[batch])
            yield band[batch].size

    def _quarters(self, key: BandKey) -> int:
        """Return how often a band is multiplied by i when it is filtered again."""
        return (self.transform.orientations - 1) % 4 if key.kind == "oriented" else 0

    def keep_lowpass(self, total: NDArray[Any], spectrum: NDArray[Any]) -> Task[None]:
        """Add the low-pass residual as it was: filtered twice, without a transform."""
        key = self.transform.keys[-1]
        response = yield from self.transform.response(key)
        for batch in self.batches(self.size):
            for here, there in crop_blocks(self.size, level_size(self.size, key.level)):
                total[batch][:, *there] += spectrum[batch][:, *there] * response[here] ** 2
            yield total[batch].size // 8
