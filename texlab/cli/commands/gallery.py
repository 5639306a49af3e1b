"""``texlab gallery``: the textures that come with the program."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "List the textures that come with the program, by class."
ORDER = 30


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("--json", action="store_true", help="print one JSON document")


def execute(args: argparse.Namespace) -> int:
    """Print the list."""
    from texlab_core.images.gallery import CLASSES, gallery

    entries = gallery()
    if args.json:
        import json

        keys = ("uri", "name", "cls", "title", "keywords", "author", "licence", "source")
        found = [{"class" if key == "cls" else key: getattr(entry, key) for key in keys} for entry in entries]
        print(json.dumps(found, indent=2))
        return 0
    width = max((len(entry.uri) for entry in entries), default=0)
    shown = None
    for entry in entries:
        if entry.cls != shown:
            print(f"{'' if shown is None else chr(10)}{CLASSES.get(entry.cls, entry.cls)}")
            shown = entry.cls
        print(f"  {entry.uri:{width}}  {entry.title} ({entry.author}, {entry.licence})")
    return 0
