"""``texlab gui``: the window."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from texlab_core.errors import InputError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.main import Parser

HELP = "Open the window (what texlab, or texlab IMAGE, alone does)."
ORDER = 0


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "image", nargs="?", metavar="IMAGE", help="image file, saved result, MSG code or gallery:NAME to open"
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


def has_display() -> bool:
    """Return whether there is somewhere to show a window."""
    names = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    return sys.platform != "linux" or any(os.environ.get(name) for name in names)


def require_qt() -> None:
    """Raise ``InputError`` with one sentence when Qt or a system library that it needs is missing."""
    try:
        import PySide6.QtWidgets  # noqa: F401
    except ImportError as error:
        raise InputError(f"The window needs Qt, which cannot be loaded ({error}).") from error
