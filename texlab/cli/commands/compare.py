"""``texlab compare``: several methods on one exemplar, side by side on one sheet."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._figures import SHEET, add_figure_options, parse_figure
from texlab.cli.commands._options import (
    add_json_option,
    output_file,
    parse_number,
    parse_settings,
    parse_size,
    refuse_overwriting,
)
from texlab.cli.commands._progress import share_bar
from texlab.cli.commands._sources import (
    add_input_options,
    add_scale_options,
    load_others,
    parse_inputs,
    parse_reading,
)
from texlab.cli.terminal import interrupted

if TYPE_CHECKING:
    import argparse
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from texlab.cli.commands._sources import Source
    from texlab.cli.parser import Parser
    from texlab_core.engine.inputs import Input
    from texlab_core.engine.params import Params
    from texlab_core.sheets.comparison import Compared

HELP = "Run several methods on one exemplar and save them side by side."
ORDER = 16
READS = ("image",)
WRITES = ".png"
NOTES = """
without --methods:               heeger-bergen,de-bonet,msg,efros-leung
--same-phase without --methods:  uncoded,msg,car,ac-h, with one random phase for all (the MSG paper's Fig. 8)
a parameter of one method:       --set car.synthesis=recursion --set msg.bandwidths=paper
a further input:                 --input second=wall.jpg, for every method that takes one of this name
"""


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = NOTES
    parser.add_argument("image", metavar="IMAGE|gallery:NAME", help="the exemplar")
    parser.add_argument("--methods", metavar="A,B,C", help="ids from texlab methods, separated by commas")
    parser.add_argument(
        "--out", required=True, metavar=SHEET, help="file to write; .pdf and .svg are figures for print"
    )
    parser.add_argument("--same-phase", action="store_true", help="one seed, and so one random phase, for all")
    parser.add_argument(
        "--size", metavar="WxH", help="size of each result; one number for a square (default: the exemplar's)"
    )
    parser.add_argument("--seed", default="0", metavar="N", help="of the first method; the others count on")
    parser.add_argument("--columns", metavar="N", help="pictures in a row (default: one row up to six)")
    parser.add_argument(
        "--set", action="append", default=[], metavar="METHOD.NAME=VALUE", help="set one parameter of one method"
    )
    add_scale_options(parser)
    add_input_options(parser)
    add_figure_options(parser)
    add_json_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Check everything, run the methods, save the sheet, report."""
    from texlab_core.errors import ParamError

    size = None if args.size is None else parse_size(args.size)
    seed = parse_number("seed", args.seed, int)
    columns = None if args.columns is None else parse_number("columns", args.columns, int)
    if columns is not None and columns < 1:
        raise ParamError("columns", "a whole number from 1", columns)
    reading, others = parse_reading(args), parse_inputs(args)
    out = output_file(args.out)
    look = parse_figure(args, columns)
    for source in (args.image, *(each.place for each in others.values())):
        refuse_overwriting(out, source)

    from texlab_core.files.whole import write_whole
    from texlab_core.images.formats.writing import encode_png
    from texlab_core.sheets.comparison import (
        FIG_8,
        FIRST_SIGHT,
        compare,
        comparison_sheet,
        comparison_tiles,
        plan,
    )
    from texlab_core.sheets.contact_sheet import check_sheet, series_columns
    from texlab_core.sheets.figure import encode_figure, figure_page

    if args.methods is None:
        names: Sequence[str] = FIG_8 if args.same_phase else FIRST_SIGHT
    else:
        names = [name.strip() for name in args.methods.split(",")]
    params = parse_params(args.set, names)
    exemplar = reading.read(args.image)
    inputs = _inputs(others, names)
    jobs = plan(exemplar, names, size=size, seed=seed, same_phase=args.same_phase, params=params, inputs=inputs)
    cells = len(jobs) + 1
    if look is None:
        largest = max((job.picture_size for job in jobs), key=math.prod)
        check_sheet(cells, columns or series_columns(cells), largest)
    with share_bar(f"{len(jobs)} methods") as show:
        compared = compare(jobs, on_progress=show, should_stop=interrupted)
    if look is None:
        write_whole(out, encode_png(comparison_sheet(exemplar, compared, columns=columns)))
    else:
        write_whole(out, encode_figure(out, figure_page(comparison_tiles(exemplar, compared), look)))
    report(compared, out, as_json=args.json)
    return 0


def parse_params(texts: Sequence[str], names: Sequence[str]) -> dict[str, Params]:
    """Return the parameters of the methods that ``--set METHOD.name=value`` names.

    Parameters
    ----------
    texts
        What was given.
    names
        Ids of the methods that are compared.

    Raises
    ------
    InputError
        When one is malformed, set twice, or of a method that is not compared.
    """
    from texlab_core.engine.registry import find_method
    from texlab_core.errors import ParamError

    settings: dict[str, list[str]] = {}
    for text in texts:
        left, equals, value = text.partition("=")
        method, dot, name = left.strip().rpartition(".")
        if not (method and dot and name and equals):
            raise ParamError("set", "a method, a name and a value as in car.synthesis=recursion", text)
        if method not in names:
            raise ParamError("set", f"a parameter of one of the compared methods ({', '.join(names)})", text)
        settings.setdefault(method, []).append(f"{name}={value}")
    return {method: find_method(method).params.parse(parse_settings(each)) for method, each in settings.items()}


def _inputs(others: Mapping[str, Source], names: Sequence[str]) -> dict[str, Input]:
    """Return the further inputs, each read as the first method that takes it wants it; raises ``InputError``."""
    from texlab_core.engine.registry import find_method
    from texlab_core.errors import ParamError

    found: dict[str, Input] = {}
    for role, source in others.items():
        taking = [method for method in map(find_method, names) if role in {spec.name for spec in method.inputs}]
        if role == "exemplar" or not taking:
            raise ParamError("input", f"a further input of one of the compared methods ({', '.join(names)})", role)
        found |= load_others({role: source}, taking[0])
    return found


def report(compared: Sequence[Compared], out: Path, *, as_json: bool) -> None:
    """Print what was made: one JSON object, or a line for each method."""
    if not as_json:
        for each in compared:
            print(f"{each.job.method}, seed {each.job.seed}: {each.error or '; '.join(each.caption()[1:])}")
        print(f"{out}: {len(compared)} methods")
        return
    answer: dict[str, Any] = {"out": str(out), "methods": [_as_json(each) for each in compared]}
    print(json.dumps(answer, allow_nan=False))


def _as_json(each: Compared) -> dict[str, Any]:
    return {
        "method": each.job.method,
        "seed": each.job.seed,
        "numbers": each.parameters,
        "log_spectral_distance_db": each.measures.get("spectral-distance"),
        "total_variation": each.measures.get("spectral-variation"),
        "measures": dict(each.measures),
        "elapsed_s": each.result.elapsed_s if each.result is not None else None,
        "error": each.error or None,
    }
