"""Is the exemplar one texture everywhere? Its local energy against its own synthesis, and gradients of colour."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.measures.registry import Measure, register
from texlab_core.transforms.luma import luma
from texlab_core.transforms.octave_bands import oriented_bands

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

BLOCKS = 4
OCTAVES = 2
SMALLEST = 48
_FLOOR = 1e-10


def local_spread(image: FloatImage, look: Callable[[], None]) -> float:
    """Return how much the contrast of fine details differs over 4 x 4 blocks of an image.

    Returns
    -------
    float
        Standard deviation over the blocks of the log10 mean energy, of each of the two finest octaves (all
        orientations together), as root mean square.
    """
    energies: dict[int, NDArray[np.float32]] = {}
    for octave, _, band in oriented_bands(luma(image), OCTAVES, look):
        look()
        energy = np.square(band.real) + np.square(band.imag)
        energies[octave] = energies[octave] + energy if octave in energies else energy
    spreads = [float(np.std(np.log10(_means(each) + _FLOOR))) for each in energies.values()]
    return math.sqrt(float(np.mean(np.square(spreads))))


def gradient_share(image: FloatImage, look: Callable[[], None]) -> float | None:
    """Return the share of the colours' standard deviation that one straight gradient explains.

    Returns
    -------
    float or None
        0 .. 1: the root of the variance of the best linear function of row and column in each channel over the
        variance of the channels; None for a flat image.
    """
    height, width, channels = image.shape
    places = [np.arange(side) - (side - 1) / 2 for side in (height, width)]
    explained = total = 0.0
    for channel in range(channels):
        look()
        plane = image[:, :, channel].astype(np.float64)
        total += float(plane.var())
        # Rows and columns are orthogonal: each coefficient is a regression of its own.
        for place, mean in zip(places, (plane.mean(axis=1), plane.mean(axis=0)), strict=True):
            variance = float(np.mean(np.square(place)))
            explained += float(np.mean(place * mean)) ** 2 / variance if variance > 0 else 0.0
    return math.sqrt(min(explained / total, 1.0)) if total > 1e-9 else None


def _means(plane: NDArray[np.float32]) -> NDArray[np.float64]:
    rows, columns = (np.arange(BLOCKS) * side // BLOCKS for side in plane.shape)
    sums = np.add.reduceat(np.add.reduceat(plane.astype(np.float64), rows, axis=0), columns, axis=1)
    counts = np.outer(np.diff([*rows, plane.shape[0]]), np.diff([*columns, plane.shape[1]]))
    return np.asarray(sums / counts)


def unevenness(subject: Subject) -> float | None:
    """Return the spread of the exemplar's local energies over that of its own Heeger-Bergen synthesis."""
    exemplar = subject.exemplar
    if exemplar is None or min(exemplar.size) < SMALLEST:
        return None

    def prepare(pixels: FloatImage, look: Callable[[], None]) -> float | None:
        own = local_spread(pixels, look)
        job = Job(method="heeger-bergen", inputs={"exemplar": exemplar})
        even = local_spread(run(job, lambda step: look(), threads=1).image, look)
        return own / even if even > 1e-6 else None

    return subject.prepared("unevenness", prepare)


def drift(subject: Subject) -> float | None:
    """Return the exemplar's :func:`gradient_share`."""
    return subject.prepared("gradient", gradient_share)


register(
    Measure(
        id="exemplar-unevenness",
        title="exemplar uneven",
        summary="How much the exemplar's contrast of fine details varies from place to place (log energy of 4 x 4 "
        "blocks), as a multiple of the same for its Heeger-Bergen synthesis, which is even. Above 2.5 the "
        "exemplar is not one texture everywhere, and D means little.",
        low=0.0,
        high=1e4,
        better="lower",
        needs=("exemplar",),
        function=unevenness,
        form=".1f",
        slow=True,
        order=80,
    )
)
register(
    Measure(
        id="exemplar-drift",
        title="exemplar drifts",
        summary="Share of the exemplar's contrast that one straight gradient of brightness or colour explains: "
        "6% is usual, above 30% it changes from one side to the other.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=drift,
        form=".0%",
        order=81,
    )
)
