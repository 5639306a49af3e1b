"""``texlab screenshot``: a picture of the real window, drawn off screen."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from texlab.cli.commands._display import require_qt
from texlab.cli.commands._options import output_file, parse_size
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "Save a picture of the window, drawn off screen after its columns have finished."
ORDER = 60
WRITES = ".png"
LARGEST_SIDE = 8192
MOST_COLUMNS = 12


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("--out", required=True, metavar="WINDOW.png", help="PNG file to write")
    parser.add_argument(
        "--size",
        default="1280x800",
        metavar="WxH",
        help="of the window; one number for a square (default 1280x800)",
    )
    parser.add_argument("--theme", choices=("dark", "light"), default="dark", help="default dark")
    parser.add_argument("--gallery", metavar="NAME", help="texture of the gallery to show")
    parser.add_argument("--columns", metavar="A,B,C", help="the methods of the columns (default: the first four)")


def execute(args: argparse.Namespace) -> int:
    """Draw and save the window."""
    if not args.out.lower().endswith(".png"):
        raise ParamError("out", "a file name that ends in .png", args.out)
    out = output_file(args.out)
    height, width = parse_size(args.size)
    if max(height, width) > LARGEST_SIDE:
        raise ParamError("size", f"at most {LARGEST_SIDE} pixels a side", args.size)
    if args.gallery is not None:
        from texlab_core.images.gallery import find_entry

        args.gallery = find_entry(args.gallery).name
    columns = None if args.columns is None else _methods(args.columns)
    # An empty value is no choice of a platform either.
    os.environ["QT_QPA_PLATFORM"] = os.environ.get("QT_QPA_PLATFORM") or "offscreen"
    # This platform warns of window hints that it has no use for.
    os.environ.setdefault("QT_LOGGING_RULES", "default.warning=false")
    require_qt()
    from texlab.app.screenshot import screenshot

    return screenshot(out, size=(width, height), theme=args.theme, gallery=args.gallery, columns=columns)


def _methods(text: str) -> list[str]:
    """Return the ids of the methods; raises ``ParamError`` when there are none or too many, or one is unknown."""
    from texlab_core.engine.registry import find_method

    names = [name.strip() for name in text.split(",")]
    if len(names) > MOST_COLUMNS:
        raise ParamError("columns", f"at most {MOST_COLUMNS} methods", len(names))
    return [find_method(name).id for name in names]
