"""Whether a window can be shown here, and the words for where it cannot."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from texlab.cli.terminal import complain
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtCore import QtMsgType

CANNOT_OPEN = 2


def has_display() -> bool:
    """Return whether there is somewhere to show a window."""
    names = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    return sys.platform != "linux" or any(os.environ.get(name) for name in names)


def require_qt() -> None:
    """Make the application; say in one sentence why that is not possible.

    Qt ends the process where it finds no platform or no display. Then it ends with 2, after the sentence.

    Raises
    ------
    InputError
        When Qt or a system library that it needs is missing.
    """
    try:
        import PySide6.QtWidgets  # noqa: F401
    except ImportError as error:
        raise InputError(f"The window needs Qt, which cannot be loaded ({error}).") from error
    import logging

    from PySide6.QtCore import QtMsgType, qInstallMessageHandler

    from texlab.app.start import application

    said: list[tuple[QtMsgType, str]] = []

    def listen(kind: QtMsgType, _: object, text: str) -> None:
        said.append((kind, text))
        if kind == QtMsgType.QtFatalMsg:
            complain(no_window(said, os.environ.get("QT_QPA_PLATFORM", "")))
            # Qt aborts when this returns, and nothing can be raised through it.
            os._exit(CANNOT_OPEN)

    before = qInstallMessageHandler(listen)
    try:
        application()
    finally:
        qInstallMessageHandler(before)
    for _, text in said:
        logging.getLogger("texlab").warning("Qt: %s", text)


def no_window(said: Sequence[tuple[QtMsgType, str]], platform: str) -> str:
    """Return why Qt cannot start, as one sentence.

    Parameters
    ----------
    said
        What it said, in order; the last is why it gives up.
    platform
        The platform that was asked for; empty for none.
    """
    from PySide6.QtCore import QtMsgType

    *before, (_, last) = said
    warnings = [text for kind, text in before if kind == QtMsgType.QtWarningMsg] or [text for _, text in before]
    why = " ".join((warnings or [last.partition("\n")[0]])[0].replace(' in ""', "").split()).rstrip(".")
    asked = f" (QT_QPA_PLATFORM is {platform})" if platform else ""
    available = last.partition("Available platform plugins are: ")[2].strip().rstrip(".")
    known = f"; there are {available}" if available and "find" in why else ""
    return f"No window can be opened{asked}: {why[:1].lower()}{why[1:]}{known}."
