"""``texlab lab``: the textbook's laboratory, one experiment at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab.cli.commands import _lab_bands, _lab_filters, _lab_shape
from texlab.cli.commands._options import add_json_option

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "The textbook's laboratory: filters, pyramids, histograms, search keys, shape from texture."
ORDER = 18
READS = ("image", "two", "one")
WRITES = ".png"
EXPERIMENTS = {**_lab_filters.EXPERIMENTS, **_lab_bands.EXPERIMENTS, **_lab_shape.EXPERIMENTS}


def configure(parser: Parser) -> None:
    """Add one sub-command for each experiment."""
    experiments = parser.add_subparsers(title="experiments", metavar="EXPERIMENT", required=True)
    for name, experiment in EXPERIMENTS.items():
        each = experiments.add_parser(
            name, help=experiment.help, description=experiment.help, allow_abbrev=False, epilog=experiment.note
        )
        each.set_defaults(experiment=experiment)
        experiment.configure(each)
        add_json_option(each)
        each.add_argument("--quiet", action="store_true", help="no output but errors and --json")


def execute(args: argparse.Namespace) -> int:
    """Run the experiment; print its numbers, save its picture."""
    code: int = args.experiment.execute(args)
    return code
