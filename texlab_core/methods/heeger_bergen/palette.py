"""Colours that the exemplar does not have, taken back by sliced optimal transport."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from texlab_core.stats import histogram
from texlab_core.transforms.colour import combine, interleave

if TYPE_CHECKING:
    from texlab_core.engine.steps import FloatImage
    from texlab_core.work.tasks import Task


class RandomStreams(Protocol):
    """Random numbers by name and index, as ``texlab_core.engine.streams.Streams`` gives them."""

    def __call__(self, name: str, *index: int) -> np.random.Generator:
        """Return a generator at the start of the stream."""
        ...

    def key(self, name: str, *index: int) -> int:
        """Return a 64-bit key."""
        ...


def transport_palette(
    pixels: FloatImage, exemplar: FloatImage, rounds: int, streams: RandomStreams
) -> Task[FloatImage]:
    """Move an image's colours onto an exemplar's palette by sliced optimal transport.

    In every round the colours are projected onto three random orthogonal directions, and along each of them
    matched by rank to the exemplar's. A last round along the channels themselves leaves their histograms exact.

    Parameters
    ----------
    pixels
        (H, W, 3) float32.
    exemplar
        (h, w, 3) float32.
    rounds
        Number of random rotations.
    streams
        Randomness of the directions and of ties, under the name ``palette``.

    Yields
    ------
    int
        Samples worked through since the last time.

    Returns
    -------
    ndarray
        (H, W, 3) float32 within the range of the exemplar.
    """
    planes, wanted = np.moveaxis(pixels, -1, 0), np.moveaxis(exemplar, -1, 0)
    channels = len(planes)
    for number in range(rounds + 1):
        turn = np.eye(channels)
        if number < rounds:
            turn, _ = np.linalg.qr(streams("palette", number).standard_normal((channels, channels)))
        moved = []
        for index, direction in enumerate(turn):
            target = histogram.sorted_sample((yield from combine(wanted, direction[None])))
            yield target.size
            (plane,) = yield from combine(planes, direction[None])
            yield from histogram.match_ranks_in_place(plane, target, streams.key("palette", number, index))
            moved.append(plane)
        planes = np.stack(moved) if number == rounds else (yield from combine(moved, turn.T))
    return (yield from interleave(planes))
