"""The planes of an exemplar that have features: its channels, its luminance, or its principal colour axes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.methods.de_bonet.features import channel_names
from texlab_core.transforms.luma import LUMA, luma

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.methods.de_bonet.choices import Channels

# Colour axes with less than this share of the variance constrain nothing.
_LEAST_SHARE = 0.05


@dataclass(frozen=True, eq=False, slots=True)
class Planes:
    """What features are measured of.

    Parameters
    ----------
    names
        Of the planes, as in the names of features.
    axes
        (C, K) float64: what the planes are made of; None for the channels themselves.
    stretch
        By what Z is multiplied.
    """

    names: tuple[str, ...]
    axes: NDArray[np.float64] | None
    stretch: float

    def see(self, image: NDArray[Any]) -> NDArray[Any]:
        """Return the planes of an image, (H, W, C) -> (H, W, K) of the same type."""
        if self.axes is None:
            return image
        if self.names == channel_names(1):
            return luma(image)[..., None]
        return np.ascontiguousarray(image @ self.axes.astype(image.dtype))


def planes_of(pixels: NDArray[np.float32], channels: Channels) -> Planes:
    """Return the planes that constrain.

    Parameters
    ----------
    pixels
        (H, W, C) float32.
    channels
        ``all``: every channel has features, and every one of them must match (the paper); ``scaled``: the same
        with thresholds that are multiplied by the number of channels; ``principal``: the axes of the exemplar's
        colours that have at least 5 % of their variance, the strongest first; ``luminance``: that alone.
    """
    count = pixels.shape[2]
    if count == 1 or channels == "all":
        return Planes(channel_names(count), None, 1.0)
    if channels == "scaled":
        return Planes(channel_names(count), None, float(count))
    if channels == "luminance":
        return Planes(channel_names(1), np.array(LUMA)[:, None], 1.0)
    samples = pixels.reshape(-1, count).astype(np.float64)
    values, vectors = np.linalg.eigh(np.cov(samples, rowvar=False, bias=True))
    kept = (
        np.flatnonzero(values >= _LEAST_SHARE * values.sum())[::-1] if values.sum() > 0 else np.array([count - 1])
    )
    axes = vectors[:, kept]
    # An axis and its opposite are the same: the strongest channel counts upwards.
    axes = axes * np.sign(axes[np.abs(axes).argmax(0), np.arange(kept.size)])
    return Planes(tuple(f"axis-{place}" for place in range(1, kept.size + 1)), axes, 1.0)
