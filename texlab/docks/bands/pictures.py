"""What the pyramid dock shows, computed: mosaics, one band large, the reconstruction. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from texlab.docks.bands import mosaic
from texlab.docks.bands.comparison import Comparison, compare
from texlab.docks.bands.middle import middle_of, middle_words
from texlab.docks.recent import Same
from texlab.style.colouring import DIVERGING_TABLE, GRAY_TABLE, Scale, paint
from texlab.style.pictures import to_picture
from texlab_core.errors import Cancelled
from texlab_core.stats.bands import amplify

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.docks.bands.controls import BandCache, PyramidSettings
    from texlab.docks.recent import Recent
    from texlab.style.pictures import Picture
    from texlab_core.engine.steps import FloatImage
    from texlab_core.stats.bands import Band, Channel
    from texlab_core.transforms.steerable import BandKey

SPREADS = 3.0
# Images lie in [0, 1]: below a fortieth of a step of 8 bits there is rounding and nothing to see.
SMALLEST_LIMIT = 1e-4


@dataclass(frozen=True)
class PyramidRequest:
    """What the controls of the pyramid dock ask for.

    Parameters
    ----------
    settings, channel
        Pyramid and plane.
    common
        One colour scale for all bands instead of one for each.
    layout, columns
        Tiles of equal size or in proportion, and how many side by side.
    canvas
        Colour between the tiles, ``#rrggbb``.
    selected
        Band to show large, or None.
    editing
        Show the exemplar put together with ``gains`` instead of the result.
    gains
        Gain of every band that does not have 1.
    """

    settings: PyramidSettings
    channel: Channel = "luma"
    common: bool = False
    layout: mosaic.Layout = "equal"
    columns: int = 6
    canvas: str = "#000000"
    selected: BandKey | None = None
    editing: bool = False
    gains: tuple[tuple[BandKey, float], ...] = ()


@dataclass(frozen=True, eq=False)
class MosaicPicture:
    """All bands of one image in one picture; ``part`` says of which part of it, empty for all."""

    bands: tuple[Band, ...]
    layout: mosaic.Mosaic
    picture: Picture
    part: str = ""


@dataclass(frozen=True, eq=False)
class BandLarge:
    """One band of exemplar and result with its colours and its distribution."""

    band: Band
    other: Band | None
    scale: Scale
    pictures: tuple[Picture, Picture | None]
    comparison: Comparison


@dataclass(frozen=True, eq=False)
class PyramidAnswer:
    """What the dock shows."""

    request: PyramidRequest
    exemplar: MosaicPicture
    result: MosaicPicture | None = None
    large: BandLarge | None = None
    edited: tuple[Picture, Picture] | None = None


class PyramidPictures:
    """Computes answers and keeps what the next one can use again."""

    def __init__(self, bands: BandCache, recent: Recent) -> None:
        self._bands = bands
        self._recent = recent

    def clear(self) -> None:
        """Forget everything."""
        self._bands.clear()
        self._recent.clear()

    def answer(
        self,
        exemplar: FloatImage,
        result: FloatImage | None,
        request: PyramidRequest,
        should_stop: Callable[[], bool],
    ) -> PyramidAnswer:
        """Return the answer to a request.

        Parameters
        ----------
        exemplar, result
            (H, W, C) float32; no result while there is none.
        request
            What to show.
        should_stop
            Asked between the parts; raises ``Cancelled`` when it says so.
        """
        look = partial(_check, should_stop)
        bands = self._bands.bands(exemplar, exemplar, request.channel, request.settings, should_stop)
        scales = band_scales(bands, request, look)
        gains = dict(request.gains) if request.editing else {}
        first = self._mosaic(exemplar, bands, scales, request, gains, look)
        if request.editing:
            return PyramidAnswer(request, first, edited=self._edited(exemplar, request, look))
        others: tuple[Band, ...] = ()
        second = None
        if result is not None:
            others = self._bands.bands(result, exemplar, request.channel, request.settings, should_stop)
            second = self._mosaic(result, others, scales, request, {}, look)
        return PyramidAnswer(request, first, second, _large(bands, others, scales, request))

    def _mosaic(
        self,
        image: FloatImage,
        bands: tuple[Band, ...],
        scales: dict[BandKey, Scale],
        request: PyramidRequest,
        gains: dict[BandKey, float],
        look: Callable[[], None],
    ) -> MosaicPicture:
        muted = frozenset(key for key, gain in gains.items() if gain == 0)
        looks = (request.common, request.layout, request.columns, request.canvas, muted)

        def make() -> MosaicPicture:
            gap = mosaic.parse_colour(request.canvas)
            shapes = [(band.plane.shape[0], band.plane.shape[1]) for band in bands]
            arrange = mosaic.equal_tiles if request.layout == "equal" else mosaic.pyramid_tiles
            layout = arrange(shapes, request.columns)
            # A smaller image has fewer levels: its residual is coloured like the exemplar's.
            pictures = []
            for band in bands:
                look()
                picture = colour_band(band, scales.get(band.key, scales[_last(scales)]))
                pictures.append(mosaic.dim(picture, gap) if band.key in muted else picture)
            look()
            return MosaicPicture(bands, layout, layout.draw(pictures, gap), middle_words(image))

        # The bands are kept by the cache above, so their identity stands for image, plane and pyramid.
        return self._recent.get((Same(bands), tuple(scales.items()), looks), make)

    def _edited(
        self, exemplar: FloatImage, request: PyramidRequest, look: Callable[[], None]
    ) -> tuple[Picture, Picture]:
        settings = request.settings
        exemplar = middle_of(exemplar)
        changed = amplify(
            exemplar,
            settings.kind,
            settings.levels,
            settings.orientations,
            dict(request.gains),
            request.channel,
            look,
        )
        return to_picture(exemplar), to_picture(np.clip(changed, 0, 1))


def band_scales(
    bands: tuple[Band, ...], request: PyramidRequest, look: Callable[[], None]
) -> dict[BandKey, Scale]:
    """Return the colour scale of every band, from the exemplar's.

    Signed bands are symmetric around zero up to three standard deviations: their own, or the largest of all; a
    band that holds nothing but rounding gets no colours.
    Magnitudes begin at zero. Low-pass bands are gray from 0 to 1; those of a principal axis as far as three
    standard deviations go. ``look`` is called between the bands and may raise to stop.
    """
    spreads = {}
    for band in bands:
        look()
        spreads[band.key] = _spread(band)
    largest = max((spreads[band.key] for band in bands if band.span != "gray"), default=0.0)
    scales = {}
    for band in bands:
        spread = largest if request.common and band.span != "gray" else spreads[band.key]
        limit = max(SPREADS * spread, SMALLEST_LIMIT)
        if band.span == "positive":
            scales[band.key] = Scale(0.0, limit)
        elif band.signed or request.channel.startswith("axis"):
            scales[band.key] = Scale(-limit, limit)
        else:
            scales[band.key] = Scale(0.0, 1.0)
    return scales


def _spread(band: Band) -> float:
    """Return a band's standard deviation; for a magnitude, that of the values whose amplitude it is."""
    if band.span == "positive":
        return float(np.sqrt(np.square(band.plane, dtype=np.float64).mean() / 2))
    return float(band.plane.std(dtype=np.float64))


def band_table(band: Band) -> NDArray[np.uint8]:
    """Return the colours of a band: diverging around zero; gray for a low-pass and for magnitudes."""
    return DIVERGING_TABLE if band.signed else GRAY_TABLE


def colour_band(band: Band, scale: Scale) -> Picture:
    """Return a band as a picture of its own size."""
    return paint(scale.place(band.plane), band_table(band))


def _large(
    bands: tuple[Band, ...], others: tuple[Band, ...], scales: dict[BandKey, Scale], request: PyramidRequest
) -> BandLarge | None:
    band = next((each for each in bands if each.key == request.selected), None)
    if band is None:
        return None
    other = next((each for each in others if each.key == request.selected), None)
    scale = scales[band.key]
    pictures = (colour_band(band, scale), None if other is None else colour_band(other, scale))
    comparison = compare(band.title, band.plane, None if other is None else other.plane)
    return BandLarge(band, other, scale, pictures, comparison)


def _last(scales: dict[BandKey, Scale]) -> BandKey:
    return next(reversed(scales))


def _check(should_stop: Callable[[], bool]) -> None:
    if should_stop():
        raise Cancelled
