"""Drawings of a result: where its pixels come from, why a pixel is there, its histograms and spectrum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from texlab_core.engine.params import Knob, Params
from texlab_core.lessons.drawing import Drawn, Kind
from texlab_core.sheets.contact_sheet import Tile, contact_sheet
from texlab_core.sheets.laboratory import enlarged, gray, signed

if TYPE_CHECKING:
    from texlab_core.engine.steps import FloatImage
    from texlab_core.lessons.drawing import Scene

# Captions as a part of a picture's side: beside a step's words they are read from the back row.
CAPTIONS = 0.15
_CELL = 256
_FOUND, _CHOSEN = (213, 94, 0), (0, 158, 115)
Box = tuple[int, int, int]


@dataclass(frozen=True, kw_only=True)
class Candidates(Params):
    """The places of the exemplar that match a pixel's ancestors, level by level."""

    most: Annotated[int, Knob(help="Places that are drawn at a level.", low=1, high=2000)] = 400


def _candidates(settings: Candidates, scene: Scene) -> Drawn:
    from texlab_core.methods.de_bonet.explain import explain

    result: Any = scene.made()
    row, column = _pixel(scene)
    explained = explain(result.details.sampling, row, column)
    exemplar = _rgb(scene.given().pixels)
    tiles = [
        Tile(with_boxes(_rgb(result.image), [(row - 2, column - 2, 5)], _CHOSEN), ("the pixel in the result",))
    ]
    counts = []
    for each in explained.levels:
        # What a place is drawn from; above level 0, what it has left for the levels below.
        places = each.matches if each.level else each.candidates
        found = places[: settings.most].tolist()
        boxes = [explained.exemplar_box(each.level, *place) for place in found]
        own = explained.exemplar_box(each.level, *each.source)
        picture = with_boxes(with_boxes(exemplar, boxes, _FOUND), [own], _CHOSEN)
        tiles.append(
            Tile(enlarged(picture, max(result.image.shape[:2])), (f"level {each.level}: {counted(len(places))}",))
        )
        counts.append(f"{len(places)}")
    many = min(3, len(tiles))
    line = "places left, coarse to fine: " + ", ".join(counts)
    return Drawn(contact_sheet(tiles, many, largest=_CELL), (line,))


def counted(places: int) -> str:
    """Return a number of places in words."""
    return "1 place is left" if places == 1 else f"{places} places are left"


@dataclass(frozen=True, kw_only=True)
class ParentStructure(Params):
    """The ancestors of a pixel in the exemplar's pyramid, and the features there."""


def _parent_structure(settings: ParentStructure, scene: Scene) -> Drawn:
    from texlab_core.methods.de_bonet.explain import explain
    from texlab_core.transforms import gaussian

    result: Any = scene.made()
    row, column = _pixel(scene)
    explained = explain(result.details.sampling, row, column)
    structure = explained.parent_structure(0)
    levels = [each for each in explained.levels if each.level]
    planes = gaussian.build(scene.plane(), len(levels))
    names = [str(getattr(each, "label", each)) for each in explained.features]
    tiles = []
    for each, values in zip(reversed(levels), structure[::-1], strict=True):
        plane = planes[min(each.level, len(planes) - 1)]
        side = max(1, _CELL // max(plane.shape))
        place = (each.source[0] * side, each.source[1] * side, side)
        shown = with_boxes(_rgb(enlarged(gray(plane), _CELL)), [place], _CHOSEN)
        tiles.append(Tile(shown, (f"level {each.level}: ancestor at {each.source[1]}, {each.source[0]}",)))
        tiles.append(Tile(_bars(values), (f"{len(values)} features there",)))
    line = f"{structure.shape[0]} levels x {structure.shape[1]} features ({names[0]} ... {names[-1]})"
    return Drawn(contact_sheet(tiles, 4 if len(tiles) > 4 else 2, largest=_CELL), (line,))


def _bars(values: Any) -> FloatImage:
    """Draw numbers as bars about a middle line."""
    height, width = 160, _CELL
    picture = np.ones((height, width, 3), np.float32)
    largest = max(float(np.abs(values).max()), 1e-9)
    step = width / len(values)
    for place, value in enumerate(values):
        end = round(height / 2 * (1 - 0.95 * float(value) / largest))
        low, high = sorted((height // 2, end))
        left, right = round(place * step), max(round((place + 1) * step) - 1, round(place * step) + 1)
        picture[low : high + 1, left:right] = np.array((0, 114, 178), np.float32) / 255
    picture[height // 2] = 0.4
    return picture


@dataclass(frozen=True, kw_only=True)
class Sources(Params):
    """A result over the map of where its pixels come from."""


def _sources(settings: Sources, scene: Scene) -> Drawn:
    from texlab_core.measures.registry import find_measure
    from texlab_core.measures.subject import Subject

    result = scene.made()
    exemplar = scene.given()
    height, width = exemplar.size
    rows, columns = np.mgrid[:height, :width].astype(np.float32)
    colours = np.stack([rows / max(height - 1, 1), np.full_like(rows, 0.45), columns / max(width - 1, 1)], axis=2)
    tiles = [Tile(exemplar.pixels, ("exemplar",)), Tile(result.image, ("result",))]
    places = result.maps["source"].plane.data
    known: Any = (places >= 0).all(axis=2)
    inside = np.clip(places, 0, (height - 1, width - 1))
    shown = np.where(known[..., None], colours[inside[..., 0], inside[..., 1]], 1).astype(np.float32)
    tiles += [Tile(colours, ("colours of its places",)), Tile(shown, ("where pixels come from",))]
    measure = find_measure("copied-share")
    copied = measure.of(Subject.of_result(result))
    lines = () if copied is None else (f"{measure.title}: {measure.text(copied)}",)
    return Drawn(contact_sheet(tiles, 4, largest=_CELL, share=CAPTIONS), lines)


@dataclass(frozen=True, kw_only=True)
class Histograms(Params):
    """Histograms of exemplar (black) and result (vermilion), pixels and steerable bands."""

    levels: Annotated[int, Knob(help="Of the pyramid.", low=1, high=5)] = 2
    orientations: Annotated[int, Knob(help="Of the pyramid.", low=1, high=6)] = 2


def _histograms(settings: Histograms, scene: Scene) -> Drawn:
    from texlab_core.lessons.plots import curves
    from texlab_core.stats.bands import split
    from texlab_core.transforms.luma import luma

    planes = scene.plane(), luma(scene.made().image)
    both = [split(each, "steerable", settings.levels, settings.orientations) for each in planes]
    pairs = [("pixels", *planes), *((a.title, a.plane, b.plane) for a, b in zip(*both, strict=True))]
    tiles, worst = [], ("", 0.0)
    for title, one, two in pairs:
        low, high = (float(np.percentile(one, q)) for q in (0.2, 99.8))
        edges = np.linspace(low, max(high, low + 1e-6), 49)
        middles = (edges[1:] + edges[:-1]) / 2
        shares = [np.histogram(np.clip(each, edges[0], edges[-1]), edges)[0] / each.size for each in (one, two)]
        grid = (np.arange(512) + 0.5) / 512
        distance = float(np.abs(np.quantile(one, grid) - np.quantile(two, grid)).mean() / max(one.std(), 1e-9))
        worst = max(worst, (title, distance), key=lambda each: each[1])
        tiles.append(
            Tile(curves([(middles, each) for each in shares], bottom=0), (title, f"distance {distance:.3f} sd"))
        )
    line = f"black: exemplar, vermilion: result; farthest apart: {worst[0]}, {worst[1]:.3f} standard deviations"
    return Drawn(contact_sheet(tiles, 4, largest=_CELL), (line,))


@dataclass(frozen=True, kw_only=True)
class Spectra(Params):
    """Power spectra of exemplar and result, and the autocorrelation of each."""


def _spectra(settings: Spectra, scene: Scene) -> Drawn:
    from texlab_core.stats.spectrum import power_spectrum

    tiles = []
    for title, image in (("exemplar", scene.given().pixels), ("result", scene.made().image)):
        power = np.maximum(power_spectrum(image).full(), 1e-12)
        levels = np.log10(power)
        low, high = (float(np.percentile(levels, q)) for q in (5, 99.9))
        tiles.append(Tile(image, (title,)))
        tiles.append(Tile(gray(levels, high, low), ("power spectrum, logarithmic",)))
        lags = np.fft.fftshift(np.fft.ifft2(np.fft.ifftshift(power)).real)
        limit = float(np.percentile(np.abs(lags), 99.5))
        tiles.append(Tile(signed(lags, limit), ("autocorrelation",)))
    return Drawn(contact_sheet(tiles, 3, largest=_CELL))


def _pixel(scene: Scene) -> tuple[int, int]:
    height, width = scene.made().image.shape[:2]
    row, column = scene.pixel or (height // 2, width // 2)
    return min(row, height - 1), min(column, width - 1)


def _rgb(image: Any) -> FloatImage:
    return np.repeat(image, 3, axis=2) if image.shape[2] == 1 else np.array(image, np.float32)


def with_boxes(image: FloatImage, boxes: list[Box], colour: tuple[int, int, int]) -> FloatImage:
    """Outline squares (top, left, side) in a picture."""
    from PIL import Image, ImageDraw

    picture = Image.fromarray((np.clip(image, 0, 1) * 255).round().astype(np.uint8))
    pen = ImageDraw.Draw(picture)
    for top, left, side in boxes:
        pen.rectangle([left, top, left + max(side, 2) - 1, top + max(side, 2) - 1], outline=colour)
    return (np.asarray(picture) / 255).astype(np.float32)


KINDS = {
    "candidates": Kind(Candidates, _candidates, ("exemplar", "result", "pixel"), ("de-bonet",)),
    "parent-structure": Kind(ParentStructure, _parent_structure, ("exemplar", "result", "pixel"), ("de-bonet",)),
    "sources": Kind(Sources, _sources, ("exemplar", "result"), ("efros-leung", "de-bonet", "tiling")),
    "histograms": Kind(Histograms, _histograms, ("exemplar", "result")),
    "spectra": Kind(Spectra, _spectra, ("exemplar", "result")),
}
