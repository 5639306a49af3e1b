"""Experiments of ``texlab lab`` with shape from texture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.cli.commands._lab import Experiment, add_image, add_out, load_plane, number, out_file, report, whole
from texlab.cli.commands._options import parse_size
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from texlab.cli.parser import Parser
    from texlab_core.shape.orientation import Orientation

TEXTURES = ("noise", "discs")
EXPERIMENT_KINDS = ("orthographic", "border", "marks", "perspective", "counts")
MOST_TRIALS = 1000
# Of the search among hypotheses: one tilt in so many is right by chance.
_TILTS = 12


def _shape_options(parser: Parser) -> None:
    add_image(parser, words="the view of a plane; noise, discs: an isotropic texture of the program's own")
    parser.add_argument("--slant", metavar="DEG", help="view the image as a texture so slanted, 0 to 80")
    parser.add_argument("--tilt", default="0", metavar="DEG", help="direction of that slant (default 0)")
    parser.add_argument("--size", default="256x256", metavar="WxH", help="of a view that is rendered")
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
    experiment = {
        "orthographic": _orthographic,
        "border": _orthographic,
        "marks": _marks,
        "perspective": _perspective,
        "counts": _counts,
    }[args.kind]
    answer, lines, tiles = experiment(args.kind, truth, points, trials, rng)

    def sheet() -> Any:
        from texlab_core.sheets.contact_sheet import contact_sheet

        return contact_sheet(tiles, len(tiles))

    return report(args, {"experiment": args.kind, **answer}, lines, out, sheet)


Outcome = tuple[dict[str, Any], list[str], list[Any]]


def _orthographic(kind: str, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    from texlab_core.shape import homogeneity, points
    from texlab_core.shape.orientation import Orientation
    from texlab_core.shape.sheets import TRUTH, landscape_picture, points_picture
    from texlab_core.sheets.contact_sheet import Tile

    at_border = kind == "border"
    tilts = [Orientation(truth.slant, (truth.tilt + 180 * k / _TILTS) % 180) for k in range(_TILTS)]
    hypotheses = [*tilts, Orientation(0)] if at_border else tilts
    patterns = [points.poisson(count, truth, rng) for _ in range(trials)]
    chosen = [homogeneity.most_uniform(each, hypotheses, at_border=at_border) for each in patterns]
    along, across = (
        sum(each) for each in zip(*(homogeneity.count_ratio(p, truth.tilt) for p in patterns), strict=True)
    )
    answer: dict[str, Any] = {"chosen_true": chosen.count(0) / trials, "by_chance": 1 / len(hypotheses)}
    lines = [f"the true orientation is chosen in {100 * answer['chosen_true']:.0f} % of {trials} patterns"]
    if at_border:
        answer["chosen_frontal"] = chosen.count(_TILTS) / trials
        lines.append(f"slant 0 is chosen in {100 * answer['chosen_frontal']:.0f} %: an artefact of the border")
    else:
        lines[0] += f", and {100 / len(hypotheses):.0f} % are chance"
        answer["count_ratio"] = along / max(across, 1)
        lines.append(f"points in a rectangle along the tilt over one across it: {answer['count_ratio']:.3f}")
    tiles = []
    for name, orientation in (("slanted", truth), ("frontal control", Orientation(0))):
        pattern = patterns[0] if orientation is truth else points.poisson(count, orientation, rng)
        values, axis = homogeneity.uniformity_landscape(pattern, at_border=at_border)
        tiles.append(Tile(points_picture(pattern), (name,)))
        tiles.append(
            Tile(landscape_picture(values, axis, [(orientation, TRUTH)], (0, 1)), ("unevenness of hypotheses",))
        )
    return answer, lines, tiles


def _marks(kind: str, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    from texlab_core.shape.homogeneity import orientation_of_marks, random_marks
    from texlab_core.shape.sheets import points_picture
    from texlab_core.sheets.contact_sheet import Tile

    drawn = [random_marks(count, truth, rng) for _ in range(trials)]
    errors = [orientation_of_marks(tensors).error(truth) for _, tensors in drawn]
    found = orientation_of_marks(drawn[0][1])
    answer = {"mean_error": sum(errors) / trials, "found": _told(found), "truth": _told(truth)}
    lines = [f"mean shape of {count} marks: the normal is {answer['mean_error']:.1f}° off on average"]
    return answer, lines, [Tile(points_picture(*drawn[0]), (_line("marks", found, truth),))]


def _perspective(kind: str, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    from texlab_core.shape.homogeneity import orientation_of_density, perspective_points
    from texlab_core.shape.sheets import points_picture
    from texlab_core.sheets.contact_sheet import Tile

    drawn = [perspective_points(count, truth, rng) for _ in range(trials)]
    fits = [orientation_of_density(each) for each in drawn]
    errors = [fit.orientation.error(truth) for fit in fits]
    answer = {
        "mean_error": sum(errors) / trials,
        "at_guard": sum(fit.at_guard for fit in fits) / trials,
        "found": _told(fits[0].orientation),
        "truth": _told(truth),
    }
    lines = [f"density of {count} points: the normal is {answer['mean_error']:.1f}° off on average"]
    told = f"slant {fits[0].orientation.slant:.0f}°, tilt {fits[0].orientation.tilt:.0f}°"
    return answer, lines, [Tile(points_picture(drawn[0]), (told,))]


def _counts(kind: str, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    from texlab_core.shape import points
    from texlab_core.shape.exercises import back_projected_areas
    from texlab_core.shape.sheets import points_picture
    from texlab_core.sheets.contact_sheet import Tile

    sets = 6
    makers: tuple[tuple[str, Callable[[], NDArray[np.float64]]], ...] = (
        ("Poisson, slanted", lambda: points.poisson(count, truth, rng)),
        ("regular", lambda: points.regular(count, rng)),
    )
    answer: dict[str, Any] = {"sets": sets * sets}
    lines, tiles = [], []
    for name, make in makers:
        drawn = [make() for _ in range(trials)]
        values = [points.count_in_sets(each, sets).p_value for each in drawn]
        uneven, even = (sum(each) / trials for each in ([p < 0.05 for p in values], [p > 0.95 for p in values]))
        answer[name.partition(",")[0].lower()] = {"uneven": uneven, "even": even}
        lines.append(
            f"{name}: p < .05 in {100 * uneven:.1f} %, p > .95 in {100 * even:.1f} % of {trials} patterns"
        )
        told = points.count_in_sets(drawn[0], sets)
        tiles.append(Tile(points_picture(drawn[0], sets=sets), (f"{name}: p {told.p_value:.2f}", told.verdict)))
    areas = back_projected_areas(sets, sets, truth, "orthographic")
    answer["area_on_plane"] = {"smallest": float(areas.min()), "largest": float(areas.max())}
    lines.append(f"each set is {areas.min():.4f} to {areas.max():.4f} of the plane: counts tell no tilt")
    return answer, lines, tiles


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

    from texlab_core.engine.job import check_seed

    return np.random.default_rng(check_seed(whole(args, "seed")))


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
