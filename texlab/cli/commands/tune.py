"""``texlab tune``: suggest parameters that make the most that is new while the texture still looks the same."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from texlab.cli.commands._options import (
    add_parameter_options,
    output_file,
    parse_number,
    parse_parameters,
    parse_result_size,
    refuse_overwriting,
)
from texlab.cli.commands._places import add_place_options, elsewhere, parse_place
from texlab.cli.commands._progress import share_bar
from texlab.cli.commands._sources import (
    add_input_options,
    add_scale_options,
    load_inputs,
    parse_inputs,
    parse_reading,
)
from texlab.cli.terminal import interrupted, logged_quietly

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.sheets.tuning import Limit

HELP = "Suggest thresholds, or other numbers of a method, for one image."
ORDER = 17
READS = ("image",)
WRITES = ".json"
EXAMPLES = """
thresholds for an image:     texlab tune wall.jpg --out wall.json --size 256x256
no worse than at first:      texlab tune wall.jpg --out wall.json --limit start
numbers of another method:   texlab tune wall.jpg --method efros-leung --knobs eps,window --out el.json
use what was found:          texlab synth wall.jpg --method de-bonet --preset wall.json --out a.png
"""


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = EXAMPLES
    parser.add_argument("image", metavar="IMAGE|gallery:NAME", help="the exemplar")
    parser.add_argument(
        "--method", default="de-bonet", metavar="ID", help="one of texlab methods (default de-bonet)"
    )
    parser.add_argument(
        "--knobs",
        metavar="A,B",
        help="numbers to tune; without them alpha, coarsest side and thresholds",
    )
    parser.add_argument("--out", required=True, metavar="PRESET.json", help="the preset to write")
    parser.add_argument("--name", default="tuned", help="the preset's name (default tuned)")
    parser.add_argument(
        "--limit",
        default="-3.1",
        metavar="D",
        help="largest D (default -3.1); start: that of the first run; own: that of another piece of the image",
    )
    parser.add_argument("--budget", default="1500", metavar="N", help="most runs, 24 to 5000 (default 1500)")
    parser.add_argument(
        "--size", metavar="WxH|WxHxD", help="of the results; one number for all sides (default: the exemplar's)"
    )
    parser.add_argument("--seed", default="0", metavar="N", help="the same seed gives the same preset (default 0)")
    add_parameter_options(parser, "begin with these parameters")
    add_scale_options(parser)
    add_input_options(parser)
    add_place_options(parser, "run the trials in so many processes (default: in threads of this one)")
    parser.add_argument("--json", action="store_true", help="print one JSON object: all that was tried")


def execute(args: argparse.Namespace) -> int:
    """Check everything, search, write the preset, report."""
    from texlab_core.documents.presets import check_name, write_preset
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.job import Job
    from texlab_core.engine.registry import find_method
    from texlab_core.errors import InputError, ParamError
    from texlab_core.sheets.own_line import own_measures
    from texlab_core.sheets.tuning import DEFAULT_LIMIT, tune
    from texlab_core.sheets.tuning_report import KEPT

    method = find_method(args.method)
    params = parse_parameters(args, method)
    knobs = [] if args.knobs is None else [each.strip().replace("-", "_") for each in args.knobs.split(",")]
    limit: Limit = "start" if args.limit == "start" else DEFAULT_LIMIT
    if args.limit not in ("start", "own"):
        limit = parse_number("limit", args.limit, float)
    budget, seed = parse_number("budget", args.budget, int), parse_number("seed", args.seed, int)
    size = None if args.size is None else parse_result_size(args.size, method.dimensions)
    out, name = output_file(args.out), check_name(args.name)
    if out.suffix.lower() != ".json":
        raise ParamError("out", "a file that ends in .json", args.out)
    place, reading, others = parse_place(args), parse_reading(args), parse_inputs(args)
    for source in (args.image, *(each.place for each in others.values())):
        refuse_overwriting(out, source)
    job = Job(
        method=method.id,
        inputs=load_inputs(args.image, method, reading, others),
        params=params,
        size=size,  # type: ignore[arg-type]  # None takes the exemplar's
        seed=seed,
    )
    if args.limit == "own":
        exemplar = job.inputs.get("exemplar")
        own = own_measures(exemplar, (KEPT,), interrupted) if isinstance(exemplar, ImageInput) else {}
        if KEPT not in own:
            raise InputError("The exemplar's own D is not known: that takes a --crop of a picture twice as large.")
        limit = own[KEPT]
    with share_bar(f"tuning {method.id}") as show, logged_quietly(), elsewhere(place) as there:
        found = tune(
            job,
            knobs,
            limit=limit,
            budget=budget,
            on_progress=show,
            should_stop=interrupted,
            elsewhere=there,
        )
    write_preset(found.preset(name), out)
    if args.json:
        print(json.dumps(found.to_json() | {"out": str(out)}, allow_nan=False))
        return 0
    changed = [
        f"  {name} = {value if not isinstance(value, list) else f'{len(value)} cells'}"
        for name, value in found.changes.items()
    ]
    print("\n".join([found.sentence, *changed, f"{out}: the preset {name} of {method.id}"]))
    return 0
