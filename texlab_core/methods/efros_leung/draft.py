"""A quick look while a knob is dragged: only candidates that continue a neighbour, and a few random ones."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.streams import Streams
from texlab_core.methods.efros_leung.candidates import make_pool, to_bytes
from texlab_core.methods.efros_leung.checks import check_inputs
from texlab_core.methods.efros_leung.fill import allowed_centres, begin, make_growth
from texlab_core.methods.efros_leung.windows import offsets
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.efros_leung.fill import Place
    from texlab_core.methods.efros_leung.windows import Matching

GUESSES = 6
# Comparisons of one pixel with one pixel that take some 70 ms.
_COMPARISONS = 80_000_000


def draft(
    inputs: Inputs,
    matching: Matching,
    size: tuple[int, int],
    seed: int,
    *,
    seed_patch: int = 3,
    anchor: Place = "center",
    seconds: float = 0.08,
) -> FloatImage:
    """Return a picture that shows roughly what the settings do: no exact result, and none to keep.

    Parameters
    ----------
    inputs, matching, size, seed, seed_patch, anchor
        As for the exact run.
    seconds
        Stop after this time; what is not reached stays mid-gray.

    Returns
    -------
    (h, w, C) float32 in [0, 1]; smaller than ``size`` when that would take too long (never in fill mode).

    Raises
    ------
    InputError
        As for the exact run.
    """
    deadline = time.perf_counter() + seconds
    check_inputs(inputs, matching, size, anchor)
    exemplar = exemplar_of(inputs)
    if not {"start", "mask", "blend", "state"} & inputs.keys():
        size = _smaller(size, matching, exemplar.channels)
    pool = make_pool(to_bytes(exemplar.pixels), allowed_centres(inputs, matching), matching)
    streams = Streams(seed)
    beginning = finish(begin(inputs, matching, size, streams, seed_patch=seed_patch, anchor=anchor))
    growth = make_growth(beginning, pool, matching, streams, b"draft", guesses=GUESSES)
    for _ in growth.run():
        if time.perf_counter() > deadline:
            break
    return growth.picture()


def _smaller(size: tuple[int, int], matching: Matching, channels: int) -> tuple[int, int]:
    """Return a size, of about the same proportions, that can be filled in time."""
    each = len(offsets(matching.shape, matching.window)) * channels * (GUESSES + 4)
    pixels = max(_COMPARISONS // each, 16 * 16)
    scale = min(1.0, float(np.sqrt(pixels / (size[0] * size[1]))))
    return max(1, int(size[0] * scale)), max(1, int(size[1] * scale))
