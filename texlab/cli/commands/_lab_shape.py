"""Experiments of ``texlab lab`` with shape from texture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.cli.commands._lab import (
    Experiment,
    add_image,
    add_out,
    checked_seed,
    load_plane,
    number,
    out_file,
    report,
    whole,
)
from texlab.cli.commands._options import parse_size
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse

    import numpy as np
    from numpy.typing import NDArray

    from texlab.cli.parser import Parser
    from texlab_core.shape.orientation import Orientation

TEXTURES = ("noise", "discs")
EXPERIMENT_KINDS = ("orthographic", "border", "marks", "perspective", "counts")
MOST_TRIALS = 1000


def _shape_options(parser: Parser) -> None:
    add_image(parser, words="the view of a plane; noise, discs: an isotropic texture of the program's own")
    parser.add_argument("--slant", metavar="DEG", help="view the image as a texture so slanted, 0 to 80")
    parser.add_argument("--tilt", default="0", metavar="DEG", help="direction of that slant (default 0)")
    parser.add_argument(
        "--size", default="256x256", metavar="WxH", help="of a view that is rendered; one number for a square"
    )
    parser.add_argument("--seed", default="0", metavar="N", help="of the program's own textures")
    add_out(parser)


def _shape(args: argparse.Namespace) -> int:
    from texlab_core.shape.orientation import Orientation

    own = args.image in TEXTURES
    truth = None
    if args.slant is not None or own:
        truth = Orientation(0 if args.slant is None else number(args, "slant"), number(args, "tilt"))
    height, width = parse_size(args.size)
    if max(height, width) > 1024:
        raise ParamError("size", "at most 1024x1024", args.size)
    rng = _rng(args)
    out = out_file(args, args.image)

    from texlab_core.shape.isotropy import DOUBTFUL, isotropy_spectrum, landscape
    from texlab_core.shape.rendering import slanted_plane
    from texlab_core.shape.textures import disc_texture, noise_texture

    texture: NDArray[np.float32]
    if own:
        texture = (noise_texture if args.image == "noise" else disc_texture)(
            min(1024, 2 * max(height, width)), rng
        )
    else:
        texture = load_plane(args, args.image)
    view = texture
    if truth is not None:
        view = slanted_plane(texture, truth, (height, width), beyond="repeated" if own else "mirrored")
    spectrum = isotropy_spectrum(view)
    found = {"search": spectrum.by_search(), "moments": spectrum.by_moments()}
    answer: dict[str, Any] = {name: _told(each, truth) for name, each in found.items()}
    lines = [_line(name, each, truth) for name, each in found.items()]
    if truth is not None:
        answer["truth"] = _told(truth)
        apparent = isotropy_spectrum(texture[:height, :width]).by_moments().slant
        answer["frontal"] = {"apparent_slant": apparent, "isotropic": apparent <= DOUBTFUL}
        lines.append(f"seen frontally the texture reads {apparent:.0f}°")
        if apparent > DOUBTFUL:
            lines.append("It is not isotropic: neither estimate can be trusted.")

    def sheet() -> Any:
        from texlab_core.shape.sheets import plane_sheet

        return plane_sheet(view, landscape(spectrum), list(found.items()), truth)

    return report(args, answer, lines, out, sheet)


def _told(found: Orientation, truth: Orientation | None = None) -> dict[str, float]:
    told = {"slant": found.slant, "tilt": found.tilt}
    return told if truth is None else {**told, "error": found.error(truth)}


def _line(name: str, found: Orientation, truth: Orientation | None) -> str:
    other = (found.tilt + 180) % 360
    line = f"{name}: slant {found.slant:.1f}°, tilt {found.tilt:.1f}° or {other:.1f}°"
    return line if truth is None else f"{line}, the normal {found.error(truth):.1f}° off"


def _homogeneity_options(parser: Parser) -> None:
    parser.add_argument("kind", choices=EXPERIMENT_KINDS, metavar="EXPERIMENT", help=", ".join(EXPERIMENT_KINDS))
    parser.add_argument("--slant", default="50", metavar="DEG", help="of the plane (default 50)")
    parser.add_argument("--tilt", default="60", metavar="DEG", help="of the plane (default 60)")
    parser.add_argument("--points", default="400", metavar="N", help="in the picture (default 400)")
    parser.add_argument("--trials", default="40", metavar="N", help="patterns that are tried (default 40)")
    parser.add_argument("--seed", default="0", metavar="N", help="of the patterns")
    add_out(parser)


def _homogeneity(args: argparse.Namespace) -> int:
    from texlab_core.shape.orientation import Orientation

    truth = Orientation(number(args, "slant"), number(args, "tilt"))
    points, trials = whole(args, "points"), whole(args, "trials")
    if not 1 <= trials <= MOST_TRIALS:
        raise ParamError("trials", f"a whole number from 1 to {MOST_TRIALS}", trials)
    if not 20 <= points <= 20_000:
        raise ParamError("points", "a whole number from 20 to 20000", points)
    rng = _rng(args)
    out = out_file(args)
    from texlab_core.shape.experiments import experiment

    answer, lines, tiles = experiment(args.kind, truth, points, trials, rng)

    def sheet() -> Any:
        from texlab_core.sheets.contact_sheet import contact_sheet

        return contact_sheet(tiles, len(tiles))

    return report(args, {"experiment": args.kind, **answer}, lines, out, sheet)


def _sphere_options(parser: Parser) -> None:
    parser.add_argument("--texture", choices=("discs", "noise"), default="discs", help="default discs")
    parser.add_argument("--side", default="512", metavar="PX", help="of the picture, 96 to 1024 (default 512)")
    parser.add_argument("--window", default="24", metavar="PX", help="of the local estimates (default 24)")
    parser.add_argument("--seed", default="0", metavar="N", help="of the texture")
    add_out(parser)


def _sphere(args: argparse.Namespace) -> int:
    side, window, rng = whole(args, "side"), number(args, "window"), _rng(args)
    out = out_file(args)

    from texlab_core.shape.sphere import SLANT_BINS, errors_by_slant, local_shape, render_sphere

    sphere = render_sphere(side, rng, args.texture)
    found = local_shape(sphere.image, window)
    errors = errors_by_slant(sphere, found)
    lines = [
        f"slant {low} to {high}°: the normal is {error:.1f}° off on average"
        for (low, high), error in zip(SLANT_BINS, errors, strict=True)
    ]
    answer = {"slants": [list(each) for each in SLANT_BINS], "errors": list(errors)}

    def sheet() -> Any:
        from texlab_core.shape.sheets import sphere_sheet

        return sphere_sheet(sphere, found, window)

    return report(args, answer, lines, out, sheet)


def _rng(args: argparse.Namespace) -> np.random.Generator:
    import numpy as np

    return np.random.default_rng(checked_seed(args))


EXPERIMENTS = {
    "shape": Experiment(
        "Slant and tilt of a plane whose texture is isotropic (section 11.4.1).", _shape_options, _shape
    ),
    "homogeneity": Experiment(
        "What homogeneity tells about a plane: nothing orthographically, marks and perspective do (11.4.1).",
        _homogeneity_options,
        _homogeneity,
    ),
    "sphere": Experiment("Local shape of a textured sphere (section 11.4.2).", _sphere_options, _sphere),
}
