"""Experiments of ``texlab lab`` with filters, histograms, pyramids and search keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.cli.commands._lab import (
    Experiment,
    add_image,
    add_out,
    checked_seed,
    load,
    load_plane,
    number,
    numbers,
    out_file,
    report,
    whole,
)
from texlab.cli.commands._options import parse_number
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.methods.de_bonet.search import Tally

MOST_SCALES = 6
PYRAMIDS = ("steerable", "laplacian", "gaussian", "oriented", "gabor", "filter-bank")


def _filters_options(parser: Parser) -> None:
    add_image(parser)
    parser.add_argument("--scales", default="1,2,4", metavar="A,B", help="times the printed sigmas, 1 to 16")
    add_out(parser)


def _filters(args: argparse.Namespace) -> int:
    scales = numbers("scales", args.scales)
    if len(scales) > MOST_SCALES:
        raise ParamError("scales", f"at most {MOST_SCALES} numbers", args.scales)
    out = out_file(args, args.image)
    plane = load_plane(args, args.image)

    import numpy as np

    from texlab_core.sheets.laboratory import filters_sheet
    from texlab_core.transforms import spots_bars

    sheet, responses = filters_sheet(plane, scales)
    found, lines = [], []
    for scale, each in zip(scales, responses, strict=True):
        rms = np.sqrt(np.square(each, dtype=np.float64).mean(axis=(1, 2)))
        names = [spots_bars.filter_name(index) for index in range(len(each))]
        _, white = spots_bars.strength(each)
        found.append({"scale": scale, "white": white, "rms": dict(zip(names, rms.tolist(), strict=True))})
        lines.append(f"scale {scale:g}: strongest is the {names[int(rms.argmax())]}, rms {rms.max():.4f}")
    return report(args, {"scales": found}, lines, out, lambda: sheet)


def _representation_options(parser: Parser) -> None:
    add_image(parser)
    parser.add_argument("--smoothing", default="8", metavar="PX", help="sigma of the local mean (default 8)")
    parser.add_argument("--threshold", default="0.5", metavar="T", help="as a share of the mean energy (0.5)")
    parser.add_argument("--classes", default="0", metavar="K", help="also gather 24 filters into 2 to 8 classes")
    parser.add_argument("--seed", default="0", metavar="N", help="of the k-means starts")
    add_out(parser)


def _representation(args: argparse.Namespace) -> int:
    smoothing, threshold, classes = number(args, "smoothing"), number(args, "threshold"), whole(args, "classes")
    seed = checked_seed(args)
    out = out_file(args, args.image)
    plane = load_plane(args, args.image)

    import numpy as np

    from texlab_core.sheets.laboratory import representation_sheet
    from texlab_core.stats.representation import CLASS_NAMES, energy_features, gather, represent

    found = represent(plane, smoothing, threshold)
    gathered = gather(energy_features(plane), classes, np.random.default_rng(seed)) if classes else None
    shares = dict(zip(CLASS_NAMES, found.shares, strict=True))
    answer: dict[str, Any] = {"threshold": found.threshold, "shares": shares}
    lines = [f"{name}: {100 * share:.1f} %" for name, share in shares.items()]
    if gathered is not None:
        answer["classes"] = (np.bincount(gathered.reshape(-1), minlength=classes) / gathered.size).tolist()
        lines.append("k-means: " + ", ".join(f"{100 * share:.1f} %" for share in answer["classes"]))
    return report(args, answer, lines, out, lambda: representation_sheet(plane, found, gathered))


def _gabor_options(parser: Parser) -> None:
    add_image(parser)
    parser.add_argument("--wavelength", default="8", metavar="PX", help="from stripe to stripe (default 8)")
    parser.add_argument("--orientation", default="0", metavar="DEG", help="of the wave; 0: vertical stripes")
    parser.add_argument("--sigma", metavar="PX", help="of the Gaussian (default half the wavelength)")
    parser.add_argument("--phase", default="0", metavar="DEG", help="of the symmetric kernel's cosine")
    parser.add_argument("--local", action="store_true", help="also wavelength and orientation around each pixel")
    add_out(parser)


def _gabor(args: argparse.Namespace) -> int:
    from texlab_core.transforms.gabor_pair import GaborPair

    sigma = None if args.sigma is None else number(args, "sigma")
    pair = GaborPair(number(args, "wavelength"), number(args, "orientation"), sigma, number(args, "phase"))
    out = out_file(args, args.image)
    plane = load_plane(args, args.image)

    import numpy as np

    from texlab_core.sheets.laboratory import gabor_sheet
    from texlab_core.stats.local_frequency import local_frequency

    response = pair.respond(plane)
    local = local_frequency(plane) if args.local else None
    magnitude = response.magnitude
    row, column = (int(each) for each in np.unravel_index(int(magnitude.argmax()), magnitude.shape))
    answer: dict[str, Any] = {
        "wavelength": pair.wavelength,
        "orientation": pair.orientation,
        "sigma": pair.width,
        "phase": pair.phase,
        "mean_magnitude": float(magnitude.mean()),
        "largest_magnitude": float(magnitude.max()),
        "largest_at": [column, row],
    }
    lines = [f"magnitude {magnitude.mean():.4f} on average, {magnitude.max():.4f} at {column}, {row}"]
    if local is not None:
        quarters = [float(np.median(part)) for part in np.array_split(local.wavelength, 4, axis=1)]
        answer |= {"local_wavelength": quarters, "coherence": float(local.coherence.mean())}
        lines.append("wavelength by quarters of the columns: " + ", ".join(f"{each:.1f}" for each in quarters))
    return report(args, answer, lines, out, lambda: gabor_sheet(plane, pair, response, local))


def _equalize_options(parser: Parser) -> None:
    add_image(parser, "two", "image two, which is changed; ramp: the book's linear ramp")
    parser.add_argument("one", metavar="IMAGE", help="image one, whose histogram is wanted; cube-root: the book's")
    parser.add_argument("--ties", choices=("random", "together"), default="random", help="of equal values")
    parser.add_argument("--value", metavar="V", help="follow this value of image two (default: its median)")
    parser.add_argument("--seed", default="0", metavar="N", help="of the order of equal values")
    add_out(parser)


def _equalize(args: argparse.Namespace) -> int:
    value = None if args.value is None else number(args, "value")
    seed = checked_seed(args)
    out = out_file(args, args.two, args.one)

    import numpy as np

    from texlab_core.sheets.laboratory import equalization_sheet
    from texlab_core.stats import equalization

    two = equalization.ramp() if args.two == "ramp" else load_plane(args, args.two)
    one = equalization.cube_root_ramp() if args.one == "cube-root" else load_plane(args, args.one)
    found = equalization.equalization(two, one)
    result = found.remapped(args.ties, seed)
    arrow = found.arrow(float(np.median(found.two)) if value is None else value)
    before, after = found.distance(two), found.distance(result)
    answer = {
        "value": arrow.value,
        "share": arrow.share,
        "new_value": arrow.new_value,
        "distance_before": before,
        "distance_after": after,
        "ties": args.ties,
    }
    lines = [
        f"{arrow.value:.4g} -> {100 * arrow.share:.4g} % -> {arrow.new_value:.4g}",
        f"mean distance of the sorted values: {before:.4g} before, {after:.4g} after",
    ]
    return report(args, answer, lines, out, lambda: equalization_sheet(found, one, result, value))


def _pyramid_options(parser: Parser) -> None:
    add_image(parser)
    parser.add_argument("--kind", choices=PYRAMIDS, default="steerable", help="default steerable")
    parser.add_argument("--levels", default="3", metavar="N", help="besides the residual (default 3)")
    parser.add_argument("--orientations", default="4", metavar="K", help="where the kind has any (default 4)")
    parser.add_argument("--steps", action="store_true", help="draw a Laplacian pyramid step by step instead")
    parser.add_argument(
        "--expand", choices=("interpolate", "replicate"), default="interpolate", help="how levels are expanded"
    )
    add_out(parser)


def _pyramid(args: argparse.Namespace) -> int:
    levels, orientations = whole(args, "levels"), whole(args, "orientations")
    if levels < 0:
        raise ParamError("levels", "a whole number from 0", levels)
    if not 1 <= orientations <= 18:
        raise ParamError("orientations", "a whole number from 1 to 18", orientations)
    out = out_file(args, args.image)
    exemplar = load(args, args.image)

    from texlab_core.transforms.luma import luma

    plane = luma(exemplar.pixels)
    if args.steps:
        return _steps(args, plane, levels, out)

    from texlab_core.sheets.laboratory import supports_sheet
    from texlab_core.stats.frequency_support import supports
    from texlab_core.stats.spectrum import power_spectrum

    kind: Any = args.kind.replace("-", " ")
    found = supports(kind, (plane.shape[0], plane.shape[1]), levels, orientations)
    power = power_spectrum(exemplar.pixels).full()
    total = max(float(power.sum(dtype="f8")), 1e-12)
    bands: list[dict[str, Any]] = [
        {
            "band": each.title,
            "largest_gain": float(each.gain.max()),
            "share_of_plane": float(each.outline().mean()),
            "share_of_power": float((power * each.gain**2).sum(dtype="f8")) / total,
        }
        for each in found
    ]
    lines = [
        f"{each['band']}: gain to {each['largest_gain']:.2f}, {100 * each['share_of_plane']:.1f} % of the plane,"
        f" {100 * each['share_of_power']:.1f} % of the picture's power"
        for each in bands
    ]
    return report(args, {"kind": args.kind, "bands": bands}, lines, out, lambda: supports_sheet(found, 6))


def _steps(args: argparse.Namespace, plane: Any, levels: int, out: Any) -> int:
    import numpy as np

    from texlab_core.sheets.laboratory import steps_sheet
    from texlab_core.transforms.pyramid_steps import analysis_steps, synthesis_steps

    down = analysis_steps(plane, levels, args.expand)
    up = synthesis_steps(down, args.expand)
    rms = [float(np.sqrt(np.square(each.band, dtype=np.float64).mean())) for each in down]
    error = float(np.abs(up[-1].image - plane).max())
    lines = [f"level {level}: rms of the band {value:.4f}" for level, value in enumerate(rms)]
    lines.append(f"back again: off by at most {error:.1g}")
    return report(args, {"rms": rms, "error": error}, lines, out, lambda: steps_sheet(down, up))


def _search_options(parser: Parser) -> None:
    add_image(parser, words="the exemplar")
    parser.add_argument("--threshold", default="0.15", metavar="T", help="of the coarsest level, De Bonet's alpha")
    parser.add_argument("--stricter", default="0", metavar="B", help="how much fine levels are stricter, his beta")
    parser.add_argument("--level", default="1", metavar="L", help="level that is searched (default 1)")
    parser.add_argument("--pixel", metavar="X,Y", help="search for this location of the level (default: for all)")
    parser.add_argument("--components", default="4", metavar="D", help="numbers of a key, 1 to 6 (default 4)")
    parser.add_argument("--seed", default="0", metavar="N", help="of the synthesis")


def _search(args: argparse.Namespace) -> int:
    values: dict[str, Any] = {"alpha": number(args, "threshold"), "beta": number(args, "stricter")}
    level, components, seed = whole(args, "level"), whole(args, "components"), checked_seed(args)
    place = None
    if args.pixel is not None:
        parts = args.pixel.split(",")
        if len(parts) != 2:
            raise ParamError("pixel", "column and row as in 10,20", args.pixel)
        place = tuple(parse_number("pixel", part, int) for part in parts)
    exemplar = load(args, args.image)

    from texlab_core.api import synthesize
    from texlab_core.methods.de_bonet.search import search, survey

    sampling = synthesize(exemplar, "de-bonet", seed=seed, **values).details.sampling
    if place is not None:
        found = search(sampling, place[1], place[0], level, components)
        locations = 1
        answer: dict[str, Any] = {"level": level, "pixel": list(place), "key": list(found.key)}
        ways = (found.blank, found.keys, found.hierarchy)
    else:
        counted = survey(sampling, level, components)
        locations = counted.locations
        answer = {"level": level, "locations": locations}
        answer |= {"structures": counted.structures, "keys": counted.distinct}
        ways = (counted.blank, counted.keys, counted.hierarchy)
    names = ("blank search", "hash keys", "hierarchy")
    answer |= {name.replace(" ", "_"): _tally(way, locations) for name, way in zip(names, ways, strict=True)}
    lines = [
        f"{name}: {way.keys / locations:.1f} keys looked at, {way.verified / locations:.1f} structures compared, "
        f"{way.found / locations:.2f} found per location"
        for name, way in zip(names, ways, strict=True)
    ]
    return report(args, answer, lines, None)


def _tally(way: Tally, locations: int) -> dict[str, float]:
    return {name: getattr(way, name) / locations for name in ("keys", "verified", "found")}


EXPERIMENTS = {
    "filters": Experiment("Spots and bars at several scales (Figs. 11.3 to 11.5).", _filters_options, _filters),
    "representation": Experiment(
        "Texture as smoothed energies of filters (Fig. 11.6), and k-means classes.",
        _representation_options,
        _representation,
    ),
    "gabor": Experiment("A Gabor pair and local frequency (Figs. 11.9 to 11.11).", _gabor_options, _gabor),
    "equalize": Experiment(
        "One image with another's histogram (Algorithm 11.3, Fig. 11.15).",
        _equalize_options,
        _equalize,
        note="the book's example: texlab lab equalize ramp cube-root --ties together",
    ),
    "pyramid": Experiment(
        "What each band of a pyramid keeps of the frequency plane (Fig. 11.8), or a pyramid step by step.",
        _pyramid_options,
        _pyramid,
    ),
    "search": Experiment(
        "Matching parent structures by blank search, by hash keys and by the hierarchy (exercise 1).",
        _search_options,
        _search,
    ),
}
