"""``texlab figures``: every figure and table of the four papers, and the step of a lesson that redraws it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "List every figure and table of the papers with the lesson that redraws it, or why none does."
ORDER = 34


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("--json", action="store_true", help="print one JSON document")


def execute(args: argparse.Namespace) -> int:
    """Print the index."""
    from texlab_core.documents.lessons import PAPERS
    from texlab_core.lessons.figure_index import figure_index
    from texlab_core.lessons.shelf import bundled

    index = figure_index(bundled())
    if args.json:
        import json

        found = [
            {
                "paper": each.paper,
                "number": each.number,
                "shows": each.shows,
                "steps": [{"lesson": lesson, "step": step} for lesson, step in each.steps],
                "reason": each.reason,
            }
            for each in index
        ]
        print(json.dumps(found, indent=2))
        return 0
    paper = None
    for each in index:
        if each.paper != paper:
            print(f"{'' if paper is None else chr(10)}{PAPERS[each.paper]}")
            paper = each.paper
        where = ", ".join(f"{lesson} {step}" for lesson, step in each.steps)
        print(f"  {each.number:8} {each.shows}: {where or each.reason or 'no lesson yet'}")
    return 0
