"""Options of figure sheets, for the commands that write them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import parse_number
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from texlab.cli.parser import Parser
    from texlab_core.sheets.figure import Figure

SHEET = "SHEET.png|.pdf|.svg"
_OPTIONS = {"width": "--width-cm", "dpi": "--dpi", "points": "--font-points", "bar": "--scale-bar"}


def add_figure_options(parser: Parser) -> None:
    """Add what a sheet that ends in .pdf or .svg looks like."""
    parser.add_argument("--width-cm", metavar="CM", help="of a .pdf or .svg: its column's, 2 to 100 (default 17)")
    parser.add_argument(
        "--dpi", metavar="N", help="of a .pdf or .svg: finer pictures are reduced to it, 36 to 2400 (default 300)"
    )
    parser.add_argument("--font-points", metavar="N", help="of a .pdf or .svg: captions, 4 to 24 (default 8)")
    parser.add_argument(
        "--scale-bar", metavar="N", help="of a .pdf or .svg: so many pixels, 0 for none (default: about a quarter)"
    )
    parser.add_argument(
        "--no-letters", action="store_true", help="of a .pdf or .svg: panels without (a), (b), ..."
    )
    parser.add_argument("--no-captions", action="store_true", help="of a .pdf or .svg: panels without words")


def parse_figure(args: argparse.Namespace, columns: int | None = None) -> Figure | None:
    """Return how the figure looks; None where ``--out`` is none.

    Raises
    ------
    ParamError
        When an option is out of range, or given for a sheet that is no figure, or ``--out`` ends otherwise.
    """
    from texlab_core.sheets.figure import Figure, is_figure

    given = {name: option[2:].replace("-", "_") for name, option in _OPTIONS.items()}
    if not is_figure(args.out):
        if Path(args.out).suffix.lower() != ".png":
            raise ParamError("out", "a file name that ends in .png, .pdf or .svg", args.out)
        refuse_figure_options(args)
        return None
    numbers = {
        name: parse_number(_OPTIONS[name].lstrip("-"), getattr(args, key), int if name == "bar" else float)
        for name, key in given.items()
        if getattr(args, key) is not None
    }
    look: dict[str, Any] = dict(numbers)
    return Figure(columns=columns, letters=not args.no_letters, captions=not args.no_captions, **look)


def refuse_figure_options(args: argparse.Namespace, more: Sequence[str] = ()) -> None:
    """Raise ``ParamError`` when an option of figures (or one of ``more``) is given for what is none."""
    names = [*(option[2:].replace("-", "_") for option in _OPTIONS.values()), *more]
    wrong = [name for name in names if getattr(args, name) is not None]
    wrong += [name for name in ("no_letters", "no_captions") if getattr(args, name)]
    if wrong:
        raise ParamError(wrong[0].replace("_", "-"), "left out unless --out ends in .pdf or .svg", args.out)
