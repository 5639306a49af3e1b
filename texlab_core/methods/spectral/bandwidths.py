"""The equivalent bandwidth of a marginal spectrum.

Reference: Navarro & Portilla 1996, section 3.1.2, eq. 4.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.transforms.gabor_bank import WHITE_BANDWIDTHS

if TYPE_CHECKING:
    from texlab_core.methods.spectral.choices import BandwidthMeasure
    from texlab_core.methods.spectral.fourier import Floats


def equivalent_bandwidths(
    marginals: Floats, measure: BandwidthMeasure, step: float | None = None, white: Floats = WHITE_BANDWIDTHS
) -> Floats:
    """Return the equivalent bandwidth of each marginal spectrum (16, n), in cycles per pixel.

    ``paper`` is the sum over the maximum (eq. 4); ``participation`` is (sum P)^2 / (sqrt(2) sum P^2), equal for a
    Gaussian but not biased by a noisy maximum. Channels without power get the bandwidths of white noise,
    ``white``. Samples are ``step`` apart, 1 / n where nothing is said.
    """
    total = marginals.sum(axis=1)
    empty = total <= 0
    safe = np.where(empty[:, None], 1, marginals)
    if measure == "paper":
        widths = safe.sum(axis=1) / safe.max(axis=1)
    else:
        # Scaled first, so that squares of very small powers do not vanish.
        safe = safe / safe.max(axis=1, keepdims=True)
        widths = safe.sum(axis=1) ** 2 / (math.sqrt(2) * np.square(safe).sum(axis=1))
    return np.asarray(np.where(empty, white, widths / marginals.shape[1] if step is None else widths * step))
