"""``texlab lesson``: show, check or export one lesson."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import add_json_option, output_folder
from texlab.cli.terminal import interrupted, shows_progress

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.documents.lessons import Lesson

HELP = "Show a lesson, check that every step can be run, or export it as a page for any browser."
ORDER = 33


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = (
        "texlab lessons lists the names and your own files; a lesson file is JSON, see texlab lesson NAME --json"
    )
    parser.add_argument("lesson", metavar="FILE.json|NAME", help="a file, or a lesson that comes with the program")
    parser.add_argument("--check", action="store_true", help="run every step")
    parser.add_argument("--export", metavar="DIR", help="write index.html and its pictures into a folder")
    parser.add_argument("--reduced", action="store_true", help="with at most 64 pixels a side, for a quick check")
    add_json_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Show, check or export."""
    from texlab_core.lessons.running import check_lesson
    from texlab_core.lessons.shelf import find

    folder = None if args.export is None else output_folder(args.export)
    lesson = find(args.lesson)
    check_lesson(lesson)
    answer: dict[str, Any] = {"title": lesson.title, "steps": len(lesson.steps)}
    lines = [f"{lesson.title}, {len(lesson.steps)} step{'s' if len(lesson.steps) > 1 else ''}"]
    if folder is not None:
        from texlab_core.lessons.page import export

        page = export(lesson, folder, reduced=args.reduced, on_step=_tell, should_stop=interrupted)
        answer |= {"page": str(page), "checked": True}
        lines += ["every step can be run", str(page)] if args.check else [str(page)]
    elif args.check:
        answer |= {"checked": True, "results": _check(lesson, reduced=args.reduced)}
        lines.append("every step can be run")
    elif args.json:
        answer = lesson.to_json()
    else:
        lines += _listing(lesson)
    print(json.dumps(answer, allow_nan=False) if args.json else "\n".join(lines))
    return 0


def _check(lesson: Lesson, *, reduced: bool) -> list[dict[str, Any]]:
    from texlab_core.lessons.running import run_lesson

    made = run_lesson(lesson, reduced=reduced, on_step=_tell, should_stop=interrupted)
    return [
        {
            "seconds": sum(each.elapsed_s for each in (*step.results, *step.series)),
            "drawing": [] if step.drawn is None else list(step.drawn.lines),
        }
        for step in made
    ]


def _listing(lesson: Lesson) -> list[str]:
    lines = [lesson.summary] if lesson.summary else []
    for number, step in enumerate(lesson.steps, 1):
        figures = f"  [{', '.join(step.figures)}]" if step.figures else ""
        lines.append(f"{number:3}. {step.sentence}{figures}")
    return lines


def _tell(number: int, count: int) -> None:
    if shows_progress():
        import sys

        print(f"step {number} of {count}", end="\r", file=sys.stderr, flush=True)
