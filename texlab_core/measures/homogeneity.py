"""Is the exemplar one texture everywhere? Its local energy and colours against its own Heeger-Bergen synthesis."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.measures._bands import oriented_bands
from texlab_core.measures.registry import Measure, register
from texlab_core.stats.spectrum import gray_plane

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

BLOCKS = 4
OCTAVES = 2
SMALLEST = 48
_FLOOR = 1e-10


def local_spread(image: FloatImage, look: Callable[[], None]) -> tuple[float, float]:
    """Return how much 4 x 4 blocks of an image differ.

    Returns
    -------
    energy
        Standard deviation over the blocks of the log10 mean energy, of the two finest octaves (all orientations
        together), as root mean square.
    colour
        Root mean square over the channels of the standard deviation of the blocks' means.
    """
    energies: dict[int, NDArray[np.float32]] = {}
    for octave, _, band in oriented_bands(gray_plane(image), OCTAVES, look):
        look()
        energy = np.square(band.real) + np.square(band.imag)
        energies[octave] = energies[octave] + energy if octave in energies else energy
    spreads = [float(np.std(np.log10(_means(each) + _FLOOR))) for each in energies.values()]
    colours = [float(np.std(_means(image[:, :, channel]))) for channel in range(image.shape[2])]
    return math.sqrt(float(np.mean(np.square(spreads)))), math.sqrt(float(np.mean(np.square(colours))))


def _means(plane: NDArray[np.float32]) -> NDArray[np.float64]:
    rows, columns = (np.arange(BLOCKS) * side // BLOCKS for side in plane.shape)
    sums = np.add.reduceat(np.add.reduceat(plane.astype(np.float64), rows, axis=0), columns, axis=1)
    counts = np.outer(np.diff([*rows, plane.shape[0]]), np.diff([*columns, plane.shape[1]]))
    return np.asarray(sums / counts)


def _ratios(subject: Subject) -> tuple[float, float] | None:
    exemplar = subject.exemplar
    if exemplar is None or min(exemplar.size) < SMALLEST:
        return None

    def prepare(pixels: FloatImage, look: Callable[[], None]) -> tuple[float, float] | None:
        own = local_spread(pixels, look)
        job = Job(method="heeger-bergen", inputs={"exemplar": exemplar})
        model = local_spread(run(job, lambda step: look(), threads=1).image, look)
        return None if min(model) <= 1e-6 else (own[0] / model[0], own[1] / model[1])

    return subject.prepared("homogeneity", prepare)


def _energy(subject: Subject) -> float | None:
    found = _ratios(subject)
    return None if found is None else found[0]


def _colour(subject: Subject) -> float | None:
    found = _ratios(subject)
    return None if found is None else found[1]


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
        function=_energy,
        form=".1f",
        slow=True,
        order=80,
    )
)
register(
    Measure(
        id="exemplar-drift",
        title="exemplar drifts",
        summary="How much the exemplar's colour varies over 4 x 4 blocks, as a multiple of the same for its "
        "Heeger-Bergen synthesis: brightness or colour that changes from one side to the other.",
        low=0.0,
        high=1e4,
        better="lower",
        needs=("exemplar",),
        function=_colour,
        form=".1f",
        slow=True,
        order=81,
    )
)
