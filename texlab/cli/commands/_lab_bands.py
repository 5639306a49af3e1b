"""The experiment of ``texlab lab`` with how bands depend on each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.cli.commands._lab import Experiment, add_image, add_out, load, out_file, report, whole
from texlab.cli.commands._options import parse_number
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.stats.dependence import Pair

STEP = 45


def _options(parser: Parser) -> None:
    add_image(parser, words="the exemplar")
    parser.add_argument("--result", metavar="FILE", help="a result of any program, beside it")
    parser.add_argument(
        "--relation",
        choices=("parent", "orientation", "neighbour"),
        default="parent",
        help="what is given: the next coarser level (default), another orientation, or a neighbour",
    )
    parser.add_argument("--level", default="0", metavar="N", help="of the band, 0 (the finest, default) to 3")
    parser.add_argument("--orientation", metavar="DEG", help="0, 45, 90 or 135; 0: vertical stripes (default all)")
    parser.add_argument("--turn", default="90", metavar="DEG", help="of the other orientation: 45, 90 or 135")
    parser.add_argument("--offset", default="1,0", metavar="X,Y", help="of the neighbour, in samples of the band")
    parser.add_argument(
        "--values",
        choices=("coefficients", "magnitudes", "ranks"),
        default="coefficients",
        help="on the axes of the picture (default: coefficients)",
    )
    add_out(parser)


def _steps(name: str, text: str) -> int:
    """Return an angle in steps of 45 degrees."""
    angle = parse_number(name, text, float)
    if angle % STEP or not 0 <= angle < 4 * STEP:
        raise ParamError(name, "0, 45, 90 or 135 degrees", text)
    return int(angle) // STEP


def _pair(args: argparse.Namespace) -> Pair:
    from texlab_core.stats.dependence import Pair

    parts = args.offset.split(",")
    if len(parts) != 2:
        raise ParamError("offset", "columns and rows as in 1,0", args.offset)
    right, down = (parse_number("offset", part, int) for part in parts)
    turn = _steps("turn", args.turn)
    if turn == 0:
        raise ParamError("turn", "45, 90 or 135 degrees", args.turn)
    return Pair(
        relation=args.relation,
        level=whole(args, "level"),
        orientation=None if args.orientation is None else _steps("orientation", args.orientation),
        turn=turn,
        offset=(down, right),
    )


def _dependence(args: argparse.Namespace) -> int:
    sources = [args.image] if args.result is None else [args.image, args.result]
    out, pair = out_file(args, *sources), _pair(args)

    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.stats.dependence import dependence, difference
    from texlab_core.transforms.luma import luma

    exemplar = load(args, args.image).pixels
    first = dependence(exemplar, pair, args.values)
    shown = [("exemplar", luma(exemplar), first)]
    if args.result is not None:
        # A crop is the exemplar's: the result is taken whole.
        result = as_exemplar(args.result).pixels
        shown.append(("result", luma(result), dependence(result, pair, args.values, first)))
    answer: dict[str, Any] = {"pair": pair.title()}
    lines = [f"{pair.title()}:"]
    for name, _, found in shown:
        answer[name] = {"information": found.information, "joint": found.joint.tolist()}
        lines.append(f"{name}: mutual information {found.information:.3f} bits")
    if len(shown) == 2:
        value = difference(first.ranks, shown[1][2].ranks)
        answer["dependence"] = value
        lines.append(f"dependence differs by {value:.3f}" + (" (the measure)" if pair.is_measure else ""))

    def sheet() -> Any:
        from texlab_core.sheets.laboratory import dependence_sheet

        return dependence_sheet(shown)

    return report(args, answer, lines, out, sheet)


EXPERIMENTS = {
    "dependence": Experiment(
        "How bands depend on each other: joint and conditional histograms (section 11.3.2).",
        _options,
        _dependence,
        note="with the defaults the last number is that of the measure dependence",
    )
}
