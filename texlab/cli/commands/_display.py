"""Whether a window can be shown here."""

from __future__ import annotations

import os
import sys

from texlab_core.errors import InputError


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
