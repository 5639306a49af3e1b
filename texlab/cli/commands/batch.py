"""``texlab batch``: many jobs, as a plan says; interrupted at any moment, it goes on where it was."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import add_json_option, output_folder, parse_number
from texlab.cli.commands._places import add_place_options, parse_place, processes
from texlab.cli.commands._progress import batch_bar, spoken
from texlab.cli.terminal import complain, interrupted, logged_quietly

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.batch.plan import Plan
    from texlab_core.batch.running import BatchResult

HELP = "Run a plan of many jobs: inputs x methods x seeds x sizes."
ORDER = 17
EXAMPLES = """
a whole plan, as JSON or TOML; paths are relative to it, and one run gives inputs x methods x seeds x sizes:
  {"inputs": ["in/*.png"], "methods": ["heeger-bergen", "de-bonet"], "seeds": [1, 2], "sizes": ["128x128"]}

inputs   a file, a folder, a glob, gallery:NAME, gallery:* or a class as in gallery:structured; or an object:
         {"from": "in/*.jpg", "scale": 0.5, "crops": {"size": "128x128", "grid": "4x2"}}
methods  ids, or {"method": "de-bonet", "set": {"alpha": 0.2}}; presets: names as in de-bonet/paper, or files
         with further inputs: {"method": "mixture", "inputs": {"second": "wall.jpg"}}
sizes    WxH, one number for a square, or a factor of the exemplar's sides as in 2x

the folder holds pictures with their recipes, report.csv and index.html; run again, the batch goes on
"""


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = EXAMPLES
    parser.add_argument("plan", metavar="PLAN|gallery:NAME", help="a .json or .toml file, or gallery:de-bonet-800")
    parser.add_argument("--out", required=True, metavar="DIR", help="folder for pictures and report")
    add_place_options(parser, "on this machine (default: one for each core)")
    parser.add_argument("--sample", metavar="N", help="run only N jobs, spread evenly over the plan")
    add_json_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Check everything, run what is not done yet, report."""
    from texlab_core.errors import ParamError

    sample = None if args.sample is None else parse_number("sample", args.sample, int)
    if sample is not None and sample < 1:
        raise ParamError("sample", "a whole number from 1", sample)
    place = parse_place(args) or processes(None)

    from texlab.cli.commands._options import own_presets
    from texlab_core.batch.plan import find_plan
    from texlab_core.batch.running import run_batch

    plan = find_plan(args.plan, presets=own_presets())
    out = output_folder(args.out)
    with batch_bar(plan.name) as show, logged_quietly():
        result = run_batch(plan, out, place=place, sample=sample, on_progress=show, should_stop=interrupted)
    if args.json:
        print(json.dumps(as_json(plan, result), allow_nan=False))
    else:
        print(described(result))
    if result.failed:
        complain(f"{result.failed} of {len(result.rows)} jobs failed; {result.page} lists them.")
    return 2 if result.failed else 0


def described(result: BatchResult) -> str:
    """Return what was made in a few lines for people."""
    found = f", {result.found} were done already" if result.found else ""
    repeated = f", {result.repeated} were asked for twice" if result.repeated else ""
    return f"{result.made} textures in {spoken(result.elapsed_s)}{found}{repeated}.\n{result.page}\n{result.table}"


def as_json(plan: Plan, result: BatchResult) -> dict[str, Any]:
    """Return what was made as JSON data."""
    return {
        "plan": plan.name,
        "jobs": plan.count,
        "made": result.made,
        "found": result.found,
        "failed": result.failed,
        "repeated": result.repeated,
        "elapsed_s": result.elapsed_s,
        "page": result.page,
        "table": result.table,
        "failures": [{"job": row.title, "error": row.error} for row in result.rows.failures],
    }
