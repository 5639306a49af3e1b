"""``texlab synth``: make more of a texture and save it with its recipe."""

from __future__ import annotations

import itertools
import json
from typing import TYPE_CHECKING

from texlab.cli.commands._options import (
    add_parameter_options,
    parse_number,
    parse_parameters,
    parse_result_size,
    refuse_overwriting,
)
from texlab.cli.commands._outputs import (
    add_output_options,
    check_outputs,
    chosen_bits,
    described,
    make,
    summary_of,
)
from texlab.cli.commands._sources import (
    add_input_options,
    add_scale_options,
    load_inputs,
    parse_inputs,
    parse_reading,
)
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from texlab.cli.parser import Parser

HELP = "Make more of a texture and save it with its recipe."
ORDER = 10
READS = ("image",)
WRITES = ".png"


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("image", metavar="IMAGE|gallery:NAME", help="the exemplar, or a code X.msg.json")
    parser.add_argument(
        "--method", default="de-bonet", metavar="ID", help="one of texlab methods (default de-bonet)"
    )
    add_output_options(parser)
    parser.add_argument(
        "--size", metavar="WxH|WxHxD", help="of the result; one number for all sides (default: the exemplar's)"
    )
    parser.add_argument("--seed", default="0", metavar="N", help="the same seed gives the same bits (default 0)")
    add_parameter_options(parser)
    add_scale_options(parser, keeps=True)
    add_input_options(parser)
    parser.more_help = _knobs_of_the_method


def execute(args: argparse.Namespace) -> int:
    """Check everything, synthesize, save, report."""
    from texlab_core.engine.registry import find_method

    method = find_method(args.method)
    params = parse_parameters(args, method)
    size = None if args.size is None else parse_result_size(args.size, method.dimensions)
    seed = parse_number("seed", args.seed, int)
    reading = parse_reading(args)
    others = parse_inputs(args)
    outputs = check_outputs(args, chosen_bits(args), method.dimensions)
    sources = (args.image, *(other.place for other in others.values()))
    for source in sources:
        refuse_overwriting(outputs.image, source)

    from texlab_core.engine.job import Job

    job = Job(
        method=args.method,
        inputs=load_inputs(args.image, method, reading, others),
        params=params,
        size=size,  # type: ignore[arg-type]  # None takes the exemplar's
        seed=seed,
    )
    made = make(job, outputs, keep=sources, measured=args.json)
    print(json.dumps(summary_of(made, outputs)) if args.json else described(made, outputs))
    return 0


def _knobs_of_the_method(given: Sequence[str]) -> str:
    """Return the parameters of the method that the command line names, for its help."""
    named = [after for before, after in itertools.pairwise(given) if before == "--method"]
    named += [each.removeprefix("--method=") for each in given if each.startswith("--method=")]
    if not named:
        # To list the methods would mean to import all of them.
        return "texlab methods lists the methods; add --method ID to see the parameters of one.\n"
    from texlab.cli.commands._knobs import knobs
    from texlab_core.engine.registry import find_method

    try:
        return knobs(find_method(named[-1])) + "\n"
    except ParamError as error:
        return f"{error}\n"
