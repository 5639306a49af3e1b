"""``texlab gui``: the window."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab.cli.commands._display import has_display, require_qt
from texlab_core.errors import InputError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "Open the window (what texlab, or texlab IMAGE, alone does)."
ORDER = 0


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "image",
        nargs="?",
        metavar="IMAGE",
        help="image file, saved result, project, preset, MSG code or gallery:NAME to open",
    )


def execute(args: argparse.Namespace) -> int:
    """Run the window until it is closed."""
    if not has_display():
        raise InputError(
            "There is no display to open a window on; "
            "texlab screenshot draws the window off screen, and texlab synth needs none."
        )
    require_qt()
    from texlab.app.start import run_gui

    return run_gui(args.image)
