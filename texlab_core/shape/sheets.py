"""Sheets of shape from texture: a plane with its landscape, patterns of points, a sphere with needles.

Reference: Forsyth and Ponce, section 11.4.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.shape import exercises
from texlab_core.shape.rendering import rectified
from texlab_core.shape.sphere import LIMB
from texlab_core.sheets.contact_sheet import Tile, contact_sheet
from texlab_core.sheets.laboratory import gray

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.shape.isotropy import Landscape
    from texlab_core.shape.orientation import Orientation
    from texlab_core.shape.sphere import LocalShape, Sphere

    Plane = NDArray[np.float32]
    Floats = NDArray[np.float64]
    Sheet = NDArray[np.uint8]
    Colour = tuple[int, int, int]
    Mark = tuple[Orientation, Colour]

TRUTH, FOUND, OTHER = (0, 158, 115), (213, 94, 0), (0, 114, 178)
_CELL = 256
_MANY = 2


def plane_sheet(
    image: Plane, costs: Landscape, found: Sequence[tuple[str, Orientation]], truth: Orientation | None = None
) -> Sheet:
    """Draw the view, the landscape of hypotheses with the estimates in it, and the view turned back by each.

    Parameters
    ----------
    image
        (H, W) float32.
    costs
        Over all hypotheses.
    found
        Names and estimates.
    truth
        What it is, where that is known: green.
    """
    marks = [(each, FOUND) for _, each in found] + ([(truth, TRUTH)] if truth is not None else [])
    tiles = [
        Tile(with_discs(image, marks), ("view, with discs that lie on the plane",)),
        Tile(landscape_picture(costs.cost, costs.axis, marks), ("cost of slant · (cos 2 tilt, sin 2 tilt)",)),
    ]
    for name, each in found:
        told = f"{name}: slant {each.slant:.0f}°, tilt {each.tilt:.0f}° or {(each.tilt + 180) % 360:.0f}°"
        tiles.append(Tile(gray(rectified(image, each)), (told,)))
    if truth is not None:
        told = f"truth: slant {truth.slant:.0f}°, tilt {truth.tilt:.0f}°"
        tiles.append(Tile(gray(rectified(image, truth)), (told,)))
    return contact_sheet(tiles, len(tiles), largest=_CELL)


def landscape_picture(
    values: Floats, axis: Floats, marks: Sequence[Mark] = (), limits: tuple[float, float] | None = None
) -> FloatImage:
    """Return values over the disc of hypotheses as a picture, dark for small ones, with rings at some of them.

    Parameters
    ----------
    values, axis
        (n, n), NaN outside the disc, and (n,) degrees.
    marks
        Orientations and their colours.
    limits
        Values that are black and white; None takes the smallest and the largest.
    """
    from PIL import Image, ImageDraw

    low, high = (float(np.nanmin(values)), float(np.nanmax(values))) if limits is None else limits
    shown = np.where(np.isfinite(values), (values - low) / max(high - low, 1e-12), 1) * 255
    side = _CELL * _MANY
    image = Image.fromarray(shown.astype(np.uint8)).resize((side, side), Image.Resampling.NEAREST).convert("RGB")
    draw = ImageDraw.Draw(image)
    step, reach = (axis[-1] - axis[0]) / (axis.size - 1), axis[-1]
    for orientation, colour in marks:
        x, y = ((each + reach + step / 2) / (2 * reach + step) * side for each in orientation.disc)
        draw.ellipse((x - 10, y - 10, x + 10, y + 10), outline=colour, width=4)
    return _float(image.resize((_CELL, _CELL), Image.Resampling.LANCZOS))


def with_discs(image: Plane, marks: Sequence[Mark]) -> FloatImage:
    """Return a picture with the outline of a circle on the plane, as each orientation shows it, and its normal."""
    from PIL import ImageDraw

    picture = _rgb(image)
    draw = ImageDraw.Draw(picture)
    height, width = image.shape
    middle = np.array([width, height]) * _MANY / 2
    radius = min(height, width) * _MANY / 4
    for orientation, colour in marks:
        outline = exercises.outline(orientation, radius) + middle
        draw.line([(float(x), float(y)) for x, y in outline], colour, 2 * _MANY)
        x, y = middle + orientation.normal[:2] * radius
        draw.line((float(middle[0]), float(middle[1]), float(x), float(y)), colour, 2 * _MANY)
    return _float(picture.resize((width, height)))


def points_picture(points: Floats, tensors: Floats | None = None, sets: int = 0) -> FloatImage:
    """Return a pattern of points in the unit square as a picture; marks as ellipses, sets as lines."""
    from PIL import Image, ImageDraw

    side = _CELL * _MANY
    image = Image.new("RGB", (side, side), (255, 255, 255))
    draw = ImageDraw.Draw(image)
    for k in range(1, sets):
        for line in ((0, k * side / sets, side, k * side / sets), (k * side / sets, 0, k * side / sets, side)):
            draw.line(line, (190, 190, 190), _MANY)
    angle = np.linspace(0, 2 * np.pi, 25)
    circle = np.stack([np.cos(angle), np.sin(angle)])
    for index, (x, y) in enumerate(points * side):
        if tensors is None:
            draw.ellipse((x - 3, y - 3, x + 3, y + 3), fill=(24, 24, 24))
        else:
            values, vectors = np.linalg.eigh(tensors[index])
            ring = vectors @ (np.sqrt(values)[:, None] * (vectors.T @ circle)) * side / 50
            draw.polygon([(x + float(a), y + float(b)) for a, b in ring.T], fill=(70, 70, 70))
    return _float(image.resize((_CELL, _CELL), Image.Resampling.LANCZOS))


def sphere_sheet(sphere: Sphere, found: LocalShape, window: float) -> Sheet:
    """Draw the view, needles of the local estimates, and those of the truth; the limb is left out."""
    step = max(8, round(window / 2))
    known = np.nan_to_num(sphere.slant, nan=90.0) < LIMB
    tiles = [
        Tile(gray(sphere.image), ("view",)),
        Tile(
            needles(sphere.image, found.slant, found.tilt, known, step, FOUND), (f"estimates, window {window:g}",)
        ),
        Tile(needles(sphere.image, sphere.slant, sphere.tilt, known, step, TRUTH), ("truth",)),
    ]
    return contact_sheet(tiles, 3, largest=2 * _CELL)


def needles(image: Plane, slant: Any, tilt: Any, known: Any, step: int, colour: Colour) -> FloatImage:
    """Return a faint picture with projected normals every ``step`` pixels, as long as the sine of the slant."""
    from PIL import ImageDraw

    picture = _rgb(0.5 + image / 2)
    draw = ImageDraw.Draw(picture)
    length = 0.48 * step
    for row in range(step // 2, image.shape[0], step):
        for column in range(step // 2, image.shape[1], step):
            if not known[row, column]:
                continue
            long = length * math.sin(math.radians(slant[row, column]))
            turn = math.radians(tilt[row, column])
            dx, dy = long * math.cos(turn), long * math.sin(turn)
            ends = ((column + 0.5 - dx, row + 0.5 - dy), (column + 0.5 + dx, row + 0.5 + dy))
            draw.line([(x * _MANY, y * _MANY) for x, y in ends], colour, 2 * _MANY)
    return _float(picture.resize((image.shape[1], image.shape[0])))


def _rgb(plane: NDArray[Any]) -> Any:
    from PIL import Image

    levels = (np.clip(plane, 0, 1) * 255 + 0.5).astype(np.uint8)
    size = (plane.shape[1] * _MANY, plane.shape[0] * _MANY)
    return Image.fromarray(levels).resize(size, Image.Resampling.BILINEAR).convert("RGB")


def _float(image: Any) -> FloatImage:
    return (np.asarray(image) / 255).astype(np.float32)
