"""``texlab lessons``: the lessons that come with the program, by chapter, and your own."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "List the lessons that come with the program, by chapter and paper, and your own."
ORDER = 32


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("--json", action="store_true", help="print one JSON document")


def execute(args: argparse.Namespace) -> int:
    """Print the list; what stands among your own and cannot be used is told on standard error."""
    import sys

    from texlab.storage.paths import lessons_dir
    from texlab_core.documents.lessons import PAPERS
    from texlab_core.lessons.shelf import bundled, own

    folder = lessons_dir()
    yours, problems = own(folder)
    lessons = [(name, name, each) for name, each in bundled().items()]
    # By its file: one of the program's may have the same name.
    lessons += [(name, str(folder / f"{name}.json"), each) for name, each in yours.items()]
    if args.json:
        import json

        found = [
            {
                "name": name,
                "lesson": called,
                "own": called != name,
                "title": each.title,
                "chapter": each.chapter,
                "papers": list(each.papers),
                "summary": each.summary,
                "steps": [step.sentence for step in each.steps],
            }
            for name, called, each in lessons
        ]
        print(json.dumps(found, indent=2))
    else:
        listed = bundled()
        width = max(map(len, listed), default=0)
        wide = max((len(each.chapter) for each in listed.values()), default=0)
        for _, called, each in lessons:
            about = "; ".join(PAPERS[paper] for paper in each.papers) or "no paper"
            steps = f"{len(each.steps)} step{'s' if len(each.steps) > 1 else ''}"
            print(f"{called:{width}}  {each.chapter or '-':{wide}}  {each.title}, {steps} ({about})")
    for problem in problems:
        print(problem, file=sys.stderr)
    return 0
