"""What the Gabor dock shows, computed: channels, their sum, the answer of one quadrature pair. No Qt."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab.docks.recent import Same
from texlab.style.colouring import DIVERGING_TABLE, GRAY_TABLE, SEQUENTIAL_TABLE, Scale, lookup_table, paint
from texlab_core.errors import Cancelled
from texlab_core.stats.peaks import find_peaks
from texlab_core.stats.spectrum import power_spectrum
from texlab_core.transforms.gabor import GaborTransform, Response, local_frequency, psnr
from texlab_core.transforms.gabor_bank import channel_name
from texlab_core.transforms.luma import luma

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.docks.recent import Recent
    from texlab.style.pictures import Picture
    from texlab_core.engine.steps import FloatImage
    from texlab_core.stats.spectrum import Plane

View = Literal["channel", "sum", "local"]
Part = Literal["even", "odd", "magnitude", "phase"]
RESIDUAL = -1
# Gray levels at 0 degrees (the middle of a bright stripe) and at 180; blue and red tell the edges apart.
PHASE_TABLE = lookup_table(((30, 30, 30), (60, 110, 190), (245, 245, 245), (200, 80, 60), (30, 30, 30)))
# Below this share of the scale an amplitude is too small for its phase to mean anything.
_FAINT = 0.15


@dataclass(frozen=True)
class Pair:
    """A quadrature pair: period of its wave in pixels, and orientation of the wave vector in degrees."""

    period: int
    orientation: int


@dataclass(frozen=True)
class GaborRequest:
    """What the controls ask for.

    Parameters
    ----------
    view
        A channel of exemplar and result, the sum of all channels, or one pair on the exemplar.
    channel
        Channel 4 p + q, or -1 for the residual.
    part
        What of the channel.
    pair
        The pair of the view ``local``; None takes the exemplar's strongest peak.
    """

    view: View = "channel"
    channel: int = 8
    part: Part = "even"
    pair: Pair | None = None


@dataclass(frozen=True, eq=False)
class Shown:
    """One picture with its values, its colours and what it is."""

    title: str
    values: Plane
    picture: Picture
    scale: Scale
    table: NDArray[np.uint8]
    unit: str = ""


@dataclass(frozen=True, eq=False)
class GaborAnswer:
    """What the dock shows; the request holds the pair that was used."""

    request: GaborRequest
    shown: tuple[Shown, ...]


def gabor_pictures(
    exemplar: FloatImage,
    result: FloatImage | None,
    request: GaborRequest,
    recent: Recent,
    should_stop: Callable[[], bool],
) -> GaborAnswer:
    """Return the pictures of a request for the luminance of two images, (H, W, C) float32 each.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    """

    def transform(image: FloatImage) -> GaborTransform:
        if should_stop():
            raise Cancelled
        return recent.get(Same(image), lambda: GaborTransform(luma(image)))

    if request.view == "local":
        pair = request.pair or strongest(exemplar)
        return GaborAnswer(replace(request, pair=pair), _local(luma(exemplar), pair))
    images = (("exemplar", exemplar),) if result is None else (("exemplar", exemplar), ("result", result))
    transforms = [(name, transform(image)) for name, image in images]
    if request.view == "sum":
        shown = tuple(each for name, found in transforms for each in _summed(name, found))
        return GaborAnswer(request, shown)
    if request.channel == RESIDUAL:
        scale = Scale(0.0, 1.0)
        return GaborAnswer(
            request,
            tuple(
                _picture(f"{name}, residual", found.residual(), scale, GRAY_TABLE) for name, found in transforms
            ),
        )
    responses = [(name, found.channel(request.channel)) for name, found in transforms]
    largest = _largest(responses[0][1])
    where = channel_name(request.channel)
    return GaborAnswer(
        request,
        tuple(part_picture(f"{name}, {where}", each, request.part, largest) for name, each in responses),
    )


def strongest(image: FloatImage) -> Pair:
    """Return the pair that answers to the strongest peak of an image's spectrum; of 8 pixels without any."""
    peaks = find_peaks(power_spectrum(image), 1)
    if not peaks:
        return Pair(8, 0)
    return Pair(max(2, round(peaks[0].period)), round(peaks[0].orientation) % 180)


def part_picture(name: str, response: Response, part: Part, largest: float) -> Shown:
    """Return a part of a response as a picture; ``largest`` is the amplitude at the end of the scale."""
    title = f"{name}, {part}" if name else part
    if part == "magnitude":
        return _picture(title, response.magnitude, Scale(0.0, largest), SEQUENTIAL_TABLE)
    if part == "phase":
        degrees = np.degrees(response.phase)
        scale = Scale(-180.0, 180.0)
        colours = paint(scale.place(degrees), PHASE_TABLE).astype(np.float32)
        clear = np.clip(response.magnitude / (_FAINT * largest), 0, 1)[:, :, None]
        faded = 128 + (colours - 128) * clear
        return Shown(title, degrees, np.round(faded).astype(np.uint8), scale, PHASE_TABLE, "°")
    values = response.even if part == "even" else response.odd
    return _picture(title, np.ascontiguousarray(values), Scale(-largest, largest), DIVERGING_TABLE)


def _local(plane: Plane, pair: Pair) -> tuple[Shown, ...]:
    response = local_frequency(plane, 1 / pair.period, pair.orientation)
    largest = _largest(response)
    gray = _picture("exemplar", plane, Scale(0.0, 1.0), GRAY_TABLE)
    parts: tuple[Part, ...] = ("even", "odd", "magnitude", "phase")
    return (gray, *(part_picture("", response, part, largest) for part in parts))


def _summed(name: str, transform: GaborTransform) -> tuple[Shown, Shown]:
    scale = Scale(0.0, 1.0)
    total = transform.reconstruction()
    error = psnr(total, transform.plane)
    quality = "exact" if math.isinf(error) else f"{error:.1f} dB"
    return (
        _picture(name, transform.plane, scale, GRAY_TABLE),
        _picture(f"sum, {quality}", total, scale, GRAY_TABLE),
    )


def _picture(title: str, values: Plane, scale: Scale, table: NDArray[np.uint8]) -> Shown:
    return Shown(title, values, paint(scale.place(values), table), scale, table)


def _largest(response: Response) -> float:
    """Return the amplitude that all but the highest half per cent stay below."""
    return max(float(np.quantile(response.magnitude, 0.995)), 1e-4)
