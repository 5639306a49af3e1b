"""Which frequencies of a solid each of its bands holds, over classes of about one direction and radius.

A band that is matched in the slices across an axis sees two of the three frequencies, a band of the solid's own
pyramid all three. Power is additive: what a band holds is the sum over the classes of its response times their
power, and a filter that is one over the other in every class moves all bands in a way that can be foretold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.methods.solid.slices import CUTS
from texlab_core.transforms import solid_spectrum
from texlab_core.transforms.filters import level_size
from texlab_core.transforms.steerable import Transform, crop_blocks
from texlab_core.work.tasks import row_blocks
from texlab_core.work.threads import sums_in_one_thread

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.methods.solid.slices import SlicePlan
    from texlab_core.work.tasks import Task

# Classes grow by this factor with the frequency.
_GROWTH = 1.7
# A filter changes amplitudes by at most e^1.5.
_STRONGEST = 3.0

Factors = tuple["NDArray[np.float64]", "NDArray[np.float64]", "NDArray[np.float64]"]


@dataclass(frozen=True, slots=True, eq=False)
class Classes:
    """The frequencies of a volume in classes, and the bands' responses to them.

    Parameters
    ----------
    size
        Depth, height and width.
    starts
        Of the runs of frequencies along each axis that make the classes.
    own
        For every band of the solid's own pyramid a sum of products: sign and one factor along each axis.
    maps
        For every cut the responses of its bands, (bands, h, w) float64, to the powers of the slices' frequencies.
    responses
        (bands, classes) float64: the means of all bands over the classes.
    """

    size: tuple[int, int, int]
    starts: tuple[NDArray[np.intp], ...]
    own: tuple[tuple[tuple[float, Factors], ...], ...]
    maps: dict[str, NDArray[np.float64]]
    responses: NDArray[np.float64]

    def power(self, spectrum: NDArray[Any]) -> Task[NDArray[np.float64]]:
        """Return the power in every class, (classes,) float64, without that of the mean."""
        depth, _, width = self.size
        weights = np.full(width // 2 + 1, 2.0)
        weights[0] = 1.0
        if width % 2 == 0:
            weights[-1] = 1.0
        slabs = np.empty((depth, len(self.starts[1]), len(self.starts[2])))
        for block in row_blocks(spectrum.shape, solid_spectrum.BATCH):
            part = spectrum[block]
            power = (part.real.astype(np.float64) ** 2 + part.imag.astype(np.float64) ** 2) * weights
            if block.start == 0:
                power[0, 0, 0] = 0.0
            slabs[block] = np.add.reduceat(np.add.reduceat(power, self.starts[2], axis=2), self.starts[1], axis=1)
            yield part.size
        return np.add.reduceat(slabs, self.starts[0], axis=0).reshape(-1)

    def apply(self, spectrum: NDArray[Any], gains: NDArray[np.float64]) -> Task[None]:
        """Filter a spectrum in place: every band's response times its gain is added to the power's logarithm."""
        half = self.size[2] // 2 + 1
        flat = np.zeros((self.size[1], half))
        rows, columns = np.zeros((self.size[0], half)), np.zeros((self.size[0], self.size[1]))
        place = len(self.own)
        for cut, sums, part in (("xy", flat, half), ("xz", rows, half), ("yz", columns, self.size[1])):
            if cut in self.maps:
                responses = self.maps[cut]
                some = gains[place : place + len(responses)]
                for gain, response in zip(some, responses, strict=True):
                    sums += gain * response[:, :part]
                    yield sums.size
                place += len(responses)
        terms = [(gain * sign, each) for gain, sums in zip(gains, self.own, strict=False) for sign, each in sums]
        deep = np.array([factor * each[0] for factor, each in terms]).T
        high = np.array([each[1] for _, each in terms]).T
        wide = np.array([each[2][:half] for _, each in terms])
        for block in row_blocks(spectrum.shape, solid_spectrum.BATCH):
            with sums_in_one_thread():
                logarithm = (deep[block, None] * high) @ wide
            logarithm += flat
            logarithm += rows[block, None, :]
            logarithm += columns[block, :, None]
            np.clip(logarithm, -_STRONGEST, _STRONGEST, out=logarithm)
            if block.start == 0:
                logarithm[0, 0, 0] = 0.0
            spectrum[block] *= np.exp((0.5 * logarithm).astype(np.float32))
            yield spectrum[block].size


def classes_of(size: tuple[int, int, int], levels: int, slices: SlicePlan | None) -> Task[Classes]:
    """Make the classes of a solid's frequencies.

    Parameters
    ----------
    size
        Depth, height and width.
    levels
        Of the solid's own pyramid.
    slices
        How slices are matched; None for solids of the kind ``laplacian``.
    """
    starts = tuple(_starts(side, half=axis == 2) for axis, side in enumerate(size))
    own = tuple(_laplacian_terms(size, levels, level) for level in range(levels + 1))
    rows = []
    for terms in own:
        total = np.zeros([len(each) for each in starts])
        for sign, factors in terms:
            deep, high, wide = (
                _means(factor[: size[2] // 2 + 1] if axis == 2 else factor, starts[axis])
                for axis, factor in enumerate(factors)
            )
            total += sign * deep[:, None, None] * high[:, None] * wide
        rows.append(total.reshape(-1))
        yield total.size
    maps: dict[str, NDArray[np.float64]] = {}
    if slices is not None:
        for cut, axes in CUTS.items():
            shape = (size[axes[1]], size[axes[2]])
            maps[cut] = yield from _squared_responses(shape, slices)
            for response in maps[cut]:
                seen = response[:, : size[2] // 2 + 1] if axes[2] == 2 else response
                means = _means(_means(seen, starts[axes[2]]).T, starts[axes[1]]).T
                spread = np.broadcast_to(np.expand_dims(means, axes[0]), [len(each) for each in starts])
                rows.append(spread.reshape(-1))
                yield spread.size
    return Classes(size, starts, own, maps, np.array(rows))


def _starts(side: int, *, half: bool) -> NDArray[np.intp]:
    """Return where runs of like frequencies begin along an axis, in the order of its spectrum."""
    edges = [0, 1, 2, 3, 4]
    while edges[-1] <= side // 2:
        edges.append(max(edges[-1] + 1, round(_GROWTH * edges[-1])))
    signed = np.rint(np.fft.fftfreq(side) * side)
    if half:
        signed = np.abs(signed[: side // 2 + 1])
    kinds = np.searchsorted(edges, np.abs(signed), side="right") * np.where(signed < 0, -1, 1)
    return np.flatnonzero(np.concatenate([[True], np.diff(kinds) != 0]))


def _means(values: NDArray[np.float64], starts: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the means over the runs along the last axis."""
    lengths = np.diff(np.append(starts, values.shape[-1]))
    means: NDArray[np.float64] = np.add.reduceat(values, starts, axis=-1) / lengths
    return means


def _laplacian_terms(size: tuple[int, int, int], levels: int, level: int) -> tuple[tuple[float, Factors], ...]:
    """Return the power's response of a band of the Laplacian pyramid, with random phases, as a sum of products.

    What a level's reduction halves comes back as an alias at seven other frequencies.
    """
    factors: list[list[NDArray[np.float64]]] = [[], [], []]
    for side in size:
        angle = 2 * np.pi * np.fft.fftfreq(side)
        before = np.ones(side)
        for finer in range(level):
            before = before * _kept(2**finer * angle) ** 2
        low = _kept(2**level * angle) ** 2
        alias = low + _kept(2**level * angle + np.pi) ** 2
        for place, factor in enumerate((before, before * low, before * low * alias)):
            factors[place].append(factor)
    signs = (1.0,) if level == levels else (1.0, -2.0, 1.0)
    return tuple((sign, (each[0], each[1], each[2])) for sign, each in zip(signs, factors, strict=False))


def _kept(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the response of 1/16 (1, 4, 6, 4, 1)."""
    return np.cos(angle / 2) ** 4


def _squared_responses(size: tuple[int, int], plan: SlicePlan) -> Task[NDArray[np.float64]]:
    """Return the squared responses of the bands of a slice, (bands, h, w) float64, both halves of the spectrum."""
    keys = plan.keys(size)
    transform = Transform.of(np.empty(size, np.float32), plan.levels_of(size), plan.orientations)
    height, width = size
    squares = np.zeros((len(keys), height, width))
    for square, key in zip(squares, keys, strict=True):
        response = yield from transform.response(key)
        for here, there in crop_blocks(size, level_size(size, key.level)):
            square[there] += np.asarray(response[here], np.float64) ** 2
        mirrored = np.roll(square[::-1, 1 : (width + 1) // 2], 1, axis=0)
        square[:, width - mirrored.shape[1] :] = mirrored[:, ::-1]
        yield square.size
    return squares
