"""Soft edges: where a mask is gray, the fill and what was there before are mixed."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import ArraysInput, exemplar_of
from texlab_core.engine.steps import Step
from texlab_core.methods.efros_leung.fill import image_of, placed
from texlab_core.methods.efros_leung.patches import patches_of
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import Output
    from texlab_core.methods.efros_leung.fill import Place

_PIXELS_AT_ONCE = 2**17


def blended(output: Output, inputs: Inputs, anchor: Place) -> Generator[Step, None, Output]:
    """Mix a fill with what was there: a gray ``b`` of the input ``blend`` gives ``b fill + (1 - b) before``.

    Parameters
    ----------
    output
        Of the fill; its image is changed.
    inputs, anchor
        Of the job. Without a ``blend`` nothing is done.
    """
    blend = image_of(inputs, "blend")
    if blend is None:
        return output
    picture = image_of(inputs, "start") or exemplar_of(inputs)
    height, width = picture.size
    image = output.image[placed(picture.size, output.image.shape[:2], anchor)]
    step = Step(1, 1, "blending", preview=lambda: output.image)
    soft = 0
    before = _Earlier(inputs)
    for rows in row_blocks((height, width), _PIXELS_AT_ONCE):
        # The largest of its channels, as for what is marked.
        share = blend.pixels[rows].max(axis=2)
        there = (share > 0) & (share < 1)
        if there.any():
            soft += int(np.count_nonzero(there))
            was = np.broadcast_to(picture.pixels[rows], image[rows].shape)[there].astype(np.float64)
            was = before(rows, there, was)
            mixed = was + (image[rows][there] - was) * share[there][:, None]
            image[rows][there] = np.clip(mixed, 0, 1)
        yield step
    if soft == 0:
        return output
    return replace(output, notes=(*output.notes, f"{soft:,} pixels of the edge mix the fill with what was there."))


class _Earlier:
    """Puts what was filled before in the place of the picture's own pixels."""

    def __init__(self, inputs: Inputs) -> None:
        given = inputs.get("patches")
        self._patches = list(patches_of(given)) if isinstance(given, ArraysInput) else []

    def __call__(self, rows: slice, there: NDArray[np.bool_], values: NDArray[np.float64]) -> NDArray[np.float64]:
        if not self._patches:
            return values
        whole = np.zeros((*there.shape, values.shape[1]))
        whole[there] = values
        for (down, across), marked, pixels in self._patches:
            first, last = max(down.start, rows.start), min(down.stop, rows.stop)
            if first < last:
                part = whole[first - rows.start : last - rows.start, across]
                own = slice(first - down.start, last - down.start)
                part[marked[own]] = np.broadcast_to(pixels[own], part.shape)[marked[own]]
        found: NDArray[np.float64] = whole[there]
        return found
