"""``texlab lessons``: the lessons that come with the program, by chapter."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "List the lessons that come with the program, by chapter and paper."
ORDER = 32


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("--json", action="store_true", help="print one JSON document")


def execute(args: argparse.Namespace) -> int:
    """Print the list."""
    from texlab_core.documents.lessons import PAPERS
    from texlab_core.lessons.shelf import bundled

    lessons = bundled()
    if args.json:
        import json

        found = [
            {
                "name": name,
                "title": each.title,
                "chapter": each.chapter,
                "papers": list(each.papers),
                "summary": each.summary,
                "steps": [step.sentence for step in each.steps],
            }
            for name, each in lessons.items()
        ]
        print(json.dumps(found, indent=2))
        return 0
    width = max(map(len, lessons), default=0)
    wide = max((len(each.chapter) for each in lessons.values()), default=0)
    for name, each in lessons.items():
        about = "; ".join(PAPERS[paper] for paper in each.papers)
        print(f"{name:{width}}  {each.chapter or '-':{wide}}  {each.title}, {len(each.steps)} steps ({about})")
    return 0
