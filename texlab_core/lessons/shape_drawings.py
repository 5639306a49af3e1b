"""Drawings of shape from texture: Forsyth and Ponce, section 11.4, Figs. 11.23 to 11.25."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

from texlab_core.engine.params import Knob, Params
from texlab_core.lessons.drawing import Drawn, Kind
from texlab_core.sheets.contact_sheet import Tile, contact_sheet

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.lessons.drawing import Scene

_SIDE = 256


@dataclass(frozen=True, kw_only=True)
class PlaneView(Params):
    """A texture on a slanted plane, and the plane found again by isotropy."""

    texture: Annotated[Literal["noise", "discs", "exemplar"], Knob(help="What lies on the plane.")] = "discs"
    slant: Annotated[float, Knob(help="Of the plane.", low=0, high=80, unit="°")] = 50.0
    tilt: Annotated[float, Knob(help="Of the plane.", low=0, high=360, unit="°")] = 30.0


def _plane(settings: PlaneView, scene: Scene) -> Drawn:
    from texlab_core.shape.isotropy import DOUBTFUL, isotropy_spectrum, landscape
    from texlab_core.shape.orientation import Orientation
    from texlab_core.shape.rendering import slanted_plane
    from texlab_core.shape.sheets import plane_sheet
    from texlab_core.shape.textures import disc_texture, noise_texture

    truth = Orientation(settings.slant, settings.tilt)
    own = settings.texture != "exemplar" or scene.exemplar is None
    if own:
        texture = (noise_texture if settings.texture == "noise" else disc_texture)(2 * _SIDE, scene.rng())
        size = (_SIDE, _SIDE)
    else:
        texture = scene.plane()
        size = (min(texture.shape[0], _SIDE), min(texture.shape[1], _SIDE))
    view = slanted_plane(texture, truth, size, beyond="repeated" if own else "mirrored")
    spectrum = isotropy_spectrum(view)
    found = {"search": spectrum.by_search(), "moments": spectrum.by_moments()}
    lines = [
        f"{name}: slant {each.slant:.0f}°, tilt {each.tilt:.0f}° or {(each.tilt + 180) % 360:.0f}°;"
        f" the normal is {each.error(truth):.1f}° off"
        for name, each in found.items()
    ]
    apparent = isotropy_spectrum(texture[: size[0], : size[1]]).by_moments().slant
    doubt = ": not isotropic, neither estimate can be trusted" if apparent > DOUBTFUL else ""
    lines.append(f"seen from the front the texture itself reads {apparent:.0f}°{doubt}")
    return Drawn(plane_sheet(view, landscape(spectrum), list(found.items()), truth), tuple(lines))


@dataclass(frozen=True, kw_only=True)
class Circles(Params):
    """Circles on planes of growing slant (Fig. 11.24)."""

    tilt: Annotated[float, Knob(help="Of the planes.", low=0, high=360, unit="°")] = 30.0


def _circles(settings: Circles, scene: Scene) -> Drawn:
    import numpy as np

    from texlab_core.shape.exercises import ellipse_of_circle, outline
    from texlab_core.shape.orientation import Orientation

    tiles, lines = [], []
    for slant in (0.0, 30.0, 50.0, 70.0):
        orientation = Orientation(slant, settings.tilt)
        ellipse = ellipse_of_circle(orientation)
        tiles.append(Tile(_outline_picture(outline(orientation), settings.tilt), (f"slant {slant:.0f}°",)))
        lines.append(f"slant {slant:.0f}°: aspect {ellipse.aspect:.3f}, cosine {np.cos(np.radians(slant)):.3f}")
    return Drawn(contact_sheet(tiles, 4, largest=_SIDE), tuple(lines))


def _outline_picture(points: NDArray[Any], tilt: float) -> FloatImage:
    import numpy as np
    from PIL import Image, ImageDraw

    many, side = 3, 220
    image = Image.new("RGB", (side * many, side * many), (255, 255, 255))
    pen = ImageDraw.Draw(image)

    def place(x: float, y: float) -> tuple[float, float]:
        # y points up, as angles of tilt are counted.
        return (side / 2 + 90 * x) * many, (side / 2 - 90 * y) * many

    pen.polygon([place(x, y) for x, y in points], fill=(222, 235, 247), outline=(0, 114, 178), width=2 * many)
    x, y = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    pen.line([place(0, 0), place(1.1 * x, 1.1 * y)], (213, 94, 0), 2 * many)
    small = image.resize((side, side), Image.Resampling.LANCZOS)
    return (np.asarray(small) / 255).astype(np.float32)


@dataclass(frozen=True, kw_only=True)
class Homogeneity(Params):
    """What patterns on a plane tell of its orientation."""

    kind: Annotated[
        Literal["orthographic", "border", "marks", "perspective", "counts"], Knob(help="Which evidence.")
    ] = "orthographic"
    slant: Annotated[float, Knob(help="Of the plane.", low=0, high=80, unit="°")] = 50.0
    tilt: Annotated[float, Knob(help="Of the plane.", low=0, high=360, unit="°")] = 60.0
    points: Annotated[int, Knob(help="In the picture.", low=20, high=20_000)] = 400
    trials: Annotated[int, Knob(help="Patterns that are tried.", low=1, high=200)] = 20


def _homogeneity(settings: Homogeneity, scene: Scene) -> Drawn:
    from texlab_core.shape.experiments import experiment
    from texlab_core.shape.orientation import Orientation

    truth = Orientation(settings.slant, settings.tilt)
    _, lines, tiles = experiment(settings.kind, truth, settings.points, settings.trials, scene.rng())
    return Drawn(contact_sheet(tiles, len(tiles)), tuple(lines))


@dataclass(frozen=True, kw_only=True)
class Sphere(Params):
    """Local shape of a textured sphere."""

    texture: Annotated[Literal["discs", "noise"], Knob(help="What lies on it.")] = "discs"
    side: Annotated[int, Knob(help="Of the picture.", low=96, high=1024, unit="px")] = 384
    window: Annotated[float, Knob(help="Of the local estimates.", low=8, high=64, unit="px")] = 24.0


def _sphere(settings: Sphere, scene: Scene) -> Drawn:
    from texlab_core.shape.sheets import sphere_sheet
    from texlab_core.shape.sphere import SLANT_BINS, errors_by_slant, local_shape, render_sphere

    sphere = render_sphere(settings.side, scene.rng(), settings.texture)
    found = local_shape(sphere.image, settings.window)
    errors = errors_by_slant(sphere, found)
    lines = tuple(
        f"slant {low} to {high}°: the normal is {error:.0f}° off on average"
        for (low, high), error in zip(SLANT_BINS, errors, strict=True)
    )
    return Drawn(sphere_sheet(sphere, found, settings.window), lines)


KINDS = {
    "plane": Kind(PlaneView, _plane, needs=()),
    "circles": Kind(Circles, _circles, needs=()),
    "homogeneity": Kind(Homogeneity, _homogeneity, needs=()),
    "sphere": Kind(Sphere, _sphere, needs=()),
}
