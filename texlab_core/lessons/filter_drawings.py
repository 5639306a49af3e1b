"""Drawings of filters, pyramids and histograms: Forsyth and Ponce, Figs. 11.3 to 11.15."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from texlab_core.engine.params import Knob, Params
from texlab_core.lessons.drawing import Drawn, Kind
from texlab_core.sheets.contact_sheet import Tile, contact_sheet
from texlab_core.sheets.laboratory import enlarged, gray, signed

if TYPE_CHECKING:
    from texlab_core.lessons.drawing import Scene

_CELL = 256
Pyramid = Literal["steerable", "laplacian", "gaussian", "oriented", "gabor", "filter bank"]


@dataclass(frozen=True, kw_only=True)
class Filters(Params):
    """Spots and bars at one scale, or at two."""

    scale: Annotated[float, Knob(help="Times the printed sigmas.", low=1, high=16)] = 1.0
    second: Annotated[float, Knob(help="One more scale; 0 for none.", low=0, high=16)] = 0.0


def _filters(settings: Filters, scene: Scene) -> Drawn:
    from texlab_core.sheets.laboratory import filters_sheet
    from texlab_core.transforms import spots_bars

    scales = [settings.scale] + ([settings.second] if settings.second >= 1 else [])
    sheet, responses = filters_sheet(scene.plane(), scales)
    lines = []
    for scale, each in zip(scales, responses, strict=True):
        rms = np.sqrt(np.square(each, dtype=np.float64).mean(axis=(1, 2)))
        name = spots_bars.filter_name(int(rms.argmax()))
        lines.append(f"scale {scale:g}: the strongest is the {name}, rms {rms.max():.4f}")
    return Drawn(sheet, tuple(lines))


@dataclass(frozen=True, kw_only=True)
class Representation(Params):
    """Squared derivatives, smoothed and thresholded."""

    smoothing: Annotated[float, Knob(help="Sigma of the local mean.", low=0.5, high=64, unit="px")] = 8.0
    threshold: Annotated[float, Knob(help="As a share of the mean energy.", low=0, high=10)] = 0.5
    classes: Annotated[int, Knob(help="Classes of k-means; 0 for none.", low=0, high=8)] = 0


def _representation(settings: Representation, scene: Scene) -> Drawn:
    from texlab_core.sheets.laboratory import representation_sheet
    from texlab_core.stats.representation import CLASS_NAMES, energy_features, gather, represent

    plane = scene.plane()
    found = represent(plane, settings.smoothing, settings.threshold)
    gathered = None
    if settings.classes >= 2:
        gathered = gather(energy_features(plane), settings.classes, scene.rng())
    named = zip(CLASS_NAMES, found.shares, strict=True)
    lines = ", ".join(f"{name} {100 * share:.0f} %" for name, share in named)
    return Drawn(representation_sheet(plane, found, gathered), (lines,))


@dataclass(frozen=True, kw_only=True)
class GaborKernels(Params):
    """Kernels of one scale at three frequencies, antisymmetric above symmetric."""

    sigma: Annotated[float, Knob(help="Of the Gaussian.", low=1, high=32, unit="px")] = 12.0
    orientation: Annotated[float, Knob(help="Of the wave.", low=0, high=180, unit="°")] = 0.0


def _gabor_kernels(settings: GaborKernels, scene: Scene) -> Drawn:
    from texlab_core.transforms.gabor_pair import GaborPair

    waves = [settings.sigma * factor for factor in (3.0, 1.5, 0.75)]
    kernels = [GaborPair(wave, settings.orientation, settings.sigma).kernel() for wave in waves]
    # All in one frame, that of the textbook's finer and coarser figures.
    frame = 193

    def shown(part: Any) -> Any:
        cut = max(0, (part.shape[0] - frame) // 2)
        inner = part[cut : part.shape[0] - cut, cut : part.shape[1] - cut]
        room = frame - inner.shape[0]
        return signed(np.pad(inner, (room // 2, room - room // 2)))

    tiles = [
        Tile(shown(each.imag), (f"wavelength {wave:g} px",)) for wave, each in zip(waves, kernels, strict=True)
    ]
    tiles += [Tile(shown(each.real)) for each in kernels]
    sheet = contact_sheet(tiles, 3, row_heads=("antisymmetric", "symmetric"), largest=_CELL)
    return Drawn(sheet, (f"Gaussian of {settings.sigma:g} pixels",))


@dataclass(frozen=True, kw_only=True)
class Gabor(Params):
    """One pair of filters and what it answers."""

    wavelength: Annotated[float, Knob(help="From stripe to stripe.", low=2, high=128, unit="px")] = 8.0
    orientation: Annotated[float, Knob(help="Of the wave.", low=0, high=180, unit="°")] = 0.0
    sigma: Annotated[float, Knob(help="Of the Gaussian; 0: half a wavelength.", low=0, high=64, unit="px")] = 0.0
    local: Annotated[bool, Knob(help="Also wavelength and orientation around each pixel.")] = False


def _gabor(settings: Gabor, scene: Scene) -> Drawn:
    from texlab_core.sheets.laboratory import gabor_sheet
    from texlab_core.stats.local_frequency import local_frequency
    from texlab_core.transforms.gabor_pair import GaborPair

    plane = scene.plane()
    pair = GaborPair(settings.wavelength, settings.orientation, settings.sigma or None)
    response = pair.respond(plane)
    local = local_frequency(plane) if settings.local else None
    lines = [f"magnitude {response.magnitude.mean():.4f} on average, {response.magnitude.max():.4f} at most"]
    if local is not None:
        quarters = (np.median(part) for part in np.array_split(local.wavelength, 4, axis=1))
        lines.append("wavelength by quarters of the width: " + ", ".join(f"{each:.1f}" for each in quarters))
    return Drawn(gabor_sheet(plane, pair, response, local), tuple(lines))


@dataclass(frozen=True, kw_only=True)
class Equalize(Params):
    """One picture with another's histogram: the book's two ramps, or exemplar and other."""

    pair: Annotated[Literal["ramps", "pictures"], Knob(help="What is equalized.")] = "ramps"
    ties: Annotated[Literal["random", "together"], Knob(help="Where equal values go.")] = "together"


def _equalize(settings: Equalize, scene: Scene) -> Drawn:
    from texlab_core.sheets.laboratory import equalization_sheet
    from texlab_core.stats import equalization
    from texlab_core.transforms.luma import luma

    if settings.pair == "ramps" or scene.other is None or scene.exemplar is None:
        two, one = equalization.ramp(), equalization.cube_root_ramp()
    else:
        two, one = scene.plane(), luma(scene.other.pixels)
    found = equalization.equalization(two, one)
    result = found.remapped(settings.ties, scene.seed)
    before, after = found.distance(two), found.distance(result)
    line = f"mean distance of the sorted values: {before:.4f} before, {after:.4f} after"
    return Drawn(equalization_sheet(found, one, result), (line,))


@dataclass(frozen=True, kw_only=True)
class Bands(Params):
    """The subbands of a pyramid."""

    kind: Annotated[Pyramid, Knob(help="Which pyramid.")] = "laplacian"
    levels: Annotated[int, Knob(help="Besides the residual.", low=0, high=8)] = 4
    orientations: Annotated[int, Knob(help="Where the kind has any.", low=1, high=18)] = 4


def _bands(settings: Bands, scene: Scene) -> Drawn:
    from texlab_core.stats.bands import split

    plane = scene.plane()
    found = split(plane, settings.kind, settings.levels, settings.orientations)
    tiles = [Tile(gray(plane), ("the picture",))] if settings.kind != "gaussian" else []
    many = settings.orientations if settings.kind == "steerable" else 6
    many = max(2, min(6, many))
    if settings.kind == "steerable":
        # Picture and high-pass residual have a row of their own; each level then has one.
        found_first, found = found[0], found[1:]
        shown = Tile(_about_zero(found_first.plane), (found_first.title,))
        tiles += [shown, *[Tile(None)] * (many - 2)]
    for each in found:
        # Its own range: fine bands would be black beside coarse ones.
        picture = _about_zero(each.plane) if each.signed else gray(each.plane)
        height, width = each.plane.shape
        tiles.append(Tile(enlarged(picture, _CELL), (each.title, f"{width} x {height}")))
    rms = [float(np.sqrt(np.square(each.plane, dtype=np.float64).mean())) for each in found if each.signed]
    lines = ("rms of the bands, fine to coarse: " + ", ".join(f"{each:.3f}" for each in rms),) if rms else ()
    return Drawn(contact_sheet(tiles, many, largest=_CELL if many <= 4 else _CELL // 2 + 32), lines)


@dataclass(frozen=True, kw_only=True)
class Supports(Params):
    """Which part of the frequency plane each band keeps."""

    kind: Annotated[Pyramid, Knob(help="Which pyramid.")] = "steerable"
    levels: Annotated[int, Knob(help="Besides the residual.", low=0, high=6)] = 3
    orientations: Annotated[int, Knob(help="Where the kind has any.", low=1, high=18)] = 4


def _supports(settings: Supports, scene: Scene) -> Drawn:
    from texlab_core.sheets.laboratory import supports_sheet
    from texlab_core.stats.frequency_support import supports

    height, width = scene.plane().shape
    found = supports(settings.kind, (height, width), settings.levels, settings.orientations)
    many = settings.orientations if settings.kind in ("steerable", "oriented") else 6
    return Drawn(supports_sheet(found, max(2, min(6, many))))


@dataclass(frozen=True, kw_only=True)
class PyramidSteps(Params):
    """Reduce, expand, subtract, level by level; and back."""

    levels: Annotated[int, Knob(help="Besides the residual.", low=1, high=6)] = 3
    expand: Annotated[Literal["interpolate", "replicate"], Knob(help="How levels are expanded.")] = "interpolate"


def _pyramid_steps(settings: PyramidSteps, scene: Scene) -> Drawn:
    from texlab_core.sheets.laboratory import steps_sheet
    from texlab_core.transforms.pyramid_steps import analysis_steps, synthesis_steps

    plane = scene.plane()
    down = analysis_steps(plane, settings.levels, settings.expand)
    up = synthesis_steps(down, settings.expand)
    error = float(np.abs(up[-1].image - plane).max())
    return Drawn(steps_sheet(down, up), (f"back again: off by at most {error:.1g}",))


@dataclass(frozen=True, kw_only=True)
class Oriented(Params):
    """The steerable pyramid taken apart and put together."""

    levels: Annotated[int, Knob(help="Besides the residuals.", low=1, high=5)] = 2
    orientations: Annotated[int, Knob(help="Bands at each level.", low=1, high=8)] = 4


def _oriented(settings: Oriented, scene: Scene) -> Drawn:
    from texlab_core.transforms import steerable

    plane = scene.plane()
    levels = min(settings.levels, steerable.max_levels(plane.shape))
    mirrored = steerable.mirror(plane)
    transform = steerable.Transform.of(mirrored, levels, settings.orientations)
    spectrum = transform.forward(mirrored)
    total = transform.empty_sum()
    tiles: list[Tile] = []
    # From coarse to fine, so that the sum is a picture from the beginning.
    for key in reversed(transform.keys):
        band = transform.band(spectrum, key)
        alone = transform.empty_sum()
        transform.add(alone, key, band)
        transform.add(total, key, band)
        back, so_far = (_inside(transform.inverse(each), plane) for each in (alone, total))
        shown = steerable.quadrant(band, plane.shape, key.level)
        drawn = gray if key.kind == "lowpass" else _about_zero
        tiles += [
            Tile(enlarged(drawn(shown), _CELL), (key.label,)),
            Tile(enlarged(drawn(back), _CELL), ("filtered again",)),
            Tile(enlarged(gray(so_far), _CELL), ("sum so far",)),
        ]
    error = float(np.abs(_inside(transform.inverse(total), plane) - plane).max())
    sheet = contact_sheet(tiles, 6, largest=_CELL // 2 + 32)
    return Drawn(sheet, (f"all bands filtered again and added: off by at most {error:.1g}",))


def _inside(plane: Any, like: Any) -> Any:
    return plane[: like.shape[0], : like.shape[1]]


def _about_zero(plane: Any) -> Any:
    """Draw values over their own range, zero in mid-gray."""
    return signed(plane, float(np.percentile(np.abs(plane), 99.8)) or 1.0)


KINDS = {
    "filters": Kind(Filters, _filters),
    "representation": Kind(Representation, _representation),
    "gabor-kernels": Kind(GaborKernels, _gabor_kernels, needs=()),
    "gabor": Kind(Gabor, _gabor),
    "equalize": Kind(Equalize, _equalize, needs=()),
    "bands": Kind(Bands, _bands),
    "supports": Kind(Supports, _supports),
    "pyramid-steps": Kind(PyramidSteps, _pyramid_steps),
    "oriented-pyramid": Kind(Oriented, _oriented),
}
