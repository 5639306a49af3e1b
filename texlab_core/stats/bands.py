"""Subbands for looking at: one plane of an image split by any of the pyramids, and put together with other gains.

Nothing here is used for synthesis. Borders are reflected, so that an image that does not tile shows no edges that
it does not have. Angles are those of the waves that a band answers to, counted from the columns' axis towards the
rows' (0: vertical stripes), whatever the convention of the method that uses the filters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from texlab_core.stats import filter_bands
from texlab_core.transforms import gaussian, laplacian, steerable
from texlab_core.transforms.luma import LUMA
from texlab_core.transforms.steerable import BandKey
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.stats.pyramid_kinds import PyramidKind

Span = Literal["signed", "positive", "gray"]
COLLAPSIBLE: tuple[PyramidKind, ...] = ("steerable", "laplacian")
# Kinds whose number of scales, or of orientations, is the user's.
WITH_SCALES: tuple[PyramidKind, ...] = ("steerable", "laplacian", "gaussian", "oriented", "filter bank")
WITH_ORIENTATIONS: tuple[PyramidKind, ...] = ("steerable", "oriented")
Channel = Literal["luma", "red", "green", "blue", "axis 1", "axis 2", "axis 3"]
CHANNELS: tuple[Channel, ...] = get_args(Channel)

# ITU-R BT.601, for values as stored.


@dataclass(frozen=True, slots=True, eq=False)
class Band:
    """One subband.

    Parameters
    ----------
    key
        Its place; ``kind`` is highpass, oriented, bandpass or lowpass. Where a level has filters of several kinds,
        ``orientation`` numbers all of them.
    plane
        (h, w) float32.
    title
        Name in words, with the angle of an oriented band.
    label
        Name for a small place.
    span
        Whether the values scatter around zero, begin at zero, or are gray levels.
    """

    key: BandKey
    plane: NDArray[np.float32]
    title: str
    label: str
    span: Span = "signed"

    @property
    def signed(self) -> bool:
        """Whether the values scatter around zero."""
        return self.span == "signed"


@dataclass(frozen=True, slots=True, eq=False)
class Projection:
    """How one plane is taken from an image: the sum of ``weights`` times the channels less ``offset``.

    Parameters
    ----------
    weights
        (C,) float64.
    offset
        Subtracted from the sum.
    back
        (C,) float64: what a change by 1 in the plane changes in the channels.
    """

    weights: NDArray[np.float64]
    offset: float
    back: NDArray[np.float64]

    def plane(self, image: FloatImage) -> NDArray[np.float32]:
        """Return the plane (H, W) of an image (H, W, C)."""
        if image.shape[2] == 1:
            return np.ascontiguousarray(image[..., 0])
        total = np.full(image.shape[:2], -np.float32(self.offset), np.float32)
        for channel, weight in enumerate(self.weights.astype(np.float32)):
            if weight:
                total += image[..., channel] * weight
        return total


def channel_names(channels: int) -> tuple[Channel, ...]:
    """Return the planes that an image with so many channels has; gray has one, called luma."""
    return CHANNELS if channels == 3 else CHANNELS[:1]


def projection(exemplar: FloatImage, channel: Channel) -> Projection:
    """Return how a plane is taken; the principal axes are those of the exemplar's colours.

    An axis that the colours do not have (a gray image in RGB has one) gives a plane of zeros.
    """
    channels = exemplar.shape[2]
    if channels == 1 or channel == "luma":
        weights = np.ones(1) if channels == 1 else np.array(LUMA)
        return Projection(weights, 0.0, np.ones(channels))
    if channel in CHANNELS[1:4]:
        weights = np.eye(3)[CHANNELS.index(channel) - 1]
        return Projection(weights, 0.0, weights)
    from texlab_core.transforms.colour import principal_axes

    axes = principal_axes(exemplar)
    number = CHANNELS.index(channel) - 4
    direction = axes.directions[number] if number < len(axes.directions) else np.zeros(3)
    return Projection(direction, float(direction @ axes.mean), direction)


def most_levels(size: Sequence[int], kind: PyramidKind) -> int:
    """Return the largest number of levels for a plane of this height and width."""
    if kind == "steerable":
        return steerable.max_levels(size)
    return filter_bands.most_derived(size) if kind == "oriented" else gaussian.max_levels(size)


def split(
    plane: NDArray[np.float32],
    kind: PyramidKind,
    levels: int,
    orientations: int,
    look: Callable[[], None] = go_on,
) -> tuple[Band, ...]:
    """Split a plane into its subbands, from fine to coarse; fewer levels when the plane is too small.

    Parameters
    ----------
    plane
        (H, W) float32.
    kind
        ``gaussian`` gives the plane itself and ``levels`` reductions of it; ``oriented`` the first and second
        derivatives of each of them, ``filter bank`` spots and bars. ``gabor`` gives the answers of the symmetric
        filters, ``gabor magnitude`` the local amplitudes; an octave below the finest keeps every second sample.
    levels, orientations
        Levels besides the residuals, where the kind is one of ``WITH_SCALES``, and orientations, of
        ``WITH_ORIENTATIONS``.
    look
        Called between the bands, and between pieces of large ones; may raise to stop.
    """
    look()
    levels = min(levels, most_levels(plane.shape, kind))
    planes: Iterable[NDArray[np.float32]]
    match kind:
        case "steerable":
            planes = _reflected_bands(plane, levels, orientations, look)
        case "oriented":
            planes = filter_bands.derived(plane, levels, orientations, look)
        case "filter bank":
            planes = filter_bands.spots_and_bars(plane, levels, look)
        case "gabor" | "gabor magnitude":
            planes = filter_bands.gabor(plane, magnitude=kind == "gabor magnitude", look=look)
        case _:
            planes = (laplacian if kind == "laplacian" else gaussian).build(plane, levels, look=look)
    bands = []
    for key, each in zip(band_keys(kind, levels, orientations), planes, strict=True):
        look()
        bands.append(Band(key, each, *names(key, kind, orientations), span(key, kind)))
    return tuple(bands)


def _reflected_bands(
    plane: NDArray[np.float32], levels: int, orientations: int, look: Callable[[], None]
) -> Iterator[NDArray[np.float32]]:
    """Yield the bands of ``steerable.build_reflected``."""
    mirrored = steerable.mirror(plane)
    transform = steerable.Transform.of(mirrored, levels, orientations)
    spectrum = transform.forward(mirrored, look)
    for key in transform.keys:
        yield steerable.quadrant(transform.band(spectrum, key, look), plane.shape, key.level)


def band_keys(kind: PyramidKind, levels: int, orientations: int) -> tuple[BandKey, ...]:
    """Return the places of all subbands, from fine to coarse."""
    if kind == "steerable":
        return steerable.band_keys(levels, orientations)
    if kind == "gaussian":
        return tuple(BandKey("lowpass", level) for level in range(levels + 1))
    if kind == "laplacian":
        return (*(BandKey("bandpass", level) for level in range(levels)), BandKey("lowpass", levels))
    levels, filters, residual = filter_bands.layout(kind, levels, orientations)
    each = (BandKey("oriented", level, number) for level in range(levels) for number in range(filters))
    return (*each, BandKey("lowpass", residual))


def span(key: BandKey, kind: PyramidKind) -> Span:
    """Return which values a subband has."""
    if key.kind == "lowpass":
        return "gray"
    return "positive" if kind == "gabor magnitude" else "signed"


def names(key: BandKey, kind: PyramidKind, orientations: int) -> tuple[str, str]:
    """Return a subband's title and label."""
    if key.kind == "oriented" and kind != "steerable":
        return filter_bands.names(key, kind, orientations)
    if key.kind == "highpass":
        return "high-pass residual", "high"
    if key.kind == "oriented":
        angle = f"{180 * key.orientation / orientations:.3g}°"
        return f"level {key.level}, waves along {angle}", f"{key.level}·{angle}"
    if key.kind == "bandpass":
        return f"level {key.level}", str(key.level)
    return (f"level {key.level}", str(key.level)) if kind == "gaussian" else ("low-pass residual", "low")


def amplify(
    image: FloatImage,
    kind: PyramidKind,
    levels: int,
    orientations: int,
    gains: Mapping[BandKey, float],
    channel: Channel = "luma",
    look: Callable[[], None] = go_on,
) -> FloatImage:
    """Return the image with its subbands multiplied by gains.

    Parameters
    ----------
    image
        (H, W, C) float32.
    kind
        ``steerable`` or ``laplacian``.
    levels, orientations
        As for :func:`split`.
    gains
        By place; 1 where nothing is said. All 1 returns the image.
    channel
        ``luma`` treats all channels alike; else only the part of the colours along that channel or axis.
    look
        Called between the bands, and between pieces of large ones; may raise to stop.

    Returns
    -------
    ndarray
        (H, W, C) float32, not clipped.

    Raises
    ------
    ValueError
        For any other kind: its bands do not add up to the image.
    """
    if kind not in COLLAPSIBLE:
        raise ValueError(f"A pyramid of the kind {kind} cannot be collapsed.")
    if all(gain == 1 for gain in gains.values()):
        return image
    levels = min(levels, most_levels(image.shape, kind))
    if channel == "luma":
        planes = [np.ascontiguousarray(image[..., each]) for each in range(image.shape[2])]
        changed = [_collapse_amplified(plane, kind, levels, orientations, gains, look) for plane in planes]
        return np.stack(changed, axis=-1)
    view = projection(image, channel)
    plane = view.plane(image)
    change = _collapse_amplified(plane, kind, levels, orientations, gains, look) - plane
    return image + change[..., None] * view.back.astype(np.float32)


def _collapse_amplified(
    plane: NDArray[np.float32],
    kind: PyramidKind,
    levels: int,
    orientations: int,
    gains: Mapping[BandKey, float],
    look: Callable[[], None],
) -> NDArray[np.float32]:
    if kind == "laplacian":
        planes = laplacian.build(plane, levels, look=look)
        keys = band_keys(kind, levels, orientations)
        bands = [each * np.float32(gains.get(key, 1)) for key, each in zip(keys, planes, strict=True)]
        return laplacian.collapse(bands, look=look)
    # The mirrored plane is periodic without a jump; its first quadrant is the plane.
    transform = steerable.Transform.of(mirrored := steerable.mirror(plane), levels, orientations)
    spectrum = transform.forward(mirrored, look)
    total = transform.empty_sum()
    for key in transform.keys:
        look()
        if gain := gains.get(key, 1.0):
            transform.add(total, key, transform.band(spectrum, key, look) * np.float32(gain), look)
    height, width = plane.shape
    quadrant: NDArray[np.float32] = transform.inverse(total, look)[:height, :width]
    return quadrant
