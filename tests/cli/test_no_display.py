"""Where no window can be opened: one sentence and exit code 2, and Qt does not abort."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from PySide6.QtCore import QtMsgType

from texlab.cli.commands._display import no_window

GIVES_UP = (
    "This application failed to start because no Qt platform plugin could be initialized. Reinstalling the "
    "application may fix this problem.\n\nAvailable platform plugins are: offscreen, xcb.\n"
)


@pytest.mark.skipif(sys.platform != "linux", reason="displays and platforms of Linux")
@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"DISPLAY": ":7654"}, "No window can be opened: could not connect to display :7654."),
        ({"QT_QPA_PLATFORM": "foo"}, "No window can be opened (QT_QPA_PLATFORM is foo): could not find the Qt"),
        ({"QT_QPA_PLATFORM": "xcb", "DISPLAY": ""}, "No window can be opened (QT_QPA_PLATFORM is xcb): could not"),
    ],
    ids=["display", "platform", "none"],
)
def test_one_sentence_and_no_abort(texlab_home: object, changes: dict[str, str], says: str) -> None:
    without = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM", "QT_LOGGING_RULES")
    kept = {name: value for name, value in os.environ.items() if name not in without}
    done = subprocess.run(
        [sys.executable, "-m", "texlab"], env=kept | changes, capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert done.stderr.startswith(f"texlab: {says}")
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


@pytest.mark.parametrize(
    ("said", "platform", "sentence"),
    [
        (
            [(QtMsgType.QtWarningMsg, 'Could not find the Qt platform plugin "foo" in ""')],
            "foo",
            'No window can be opened (QT_QPA_PLATFORM is foo): could not find the Qt platform plugin "foo"; there '
            "are offscreen, xcb.",
        ),
        (
            [
                (QtMsgType.QtInfoMsg, "Could not load the Qt platform plugin."),
                (QtMsgType.QtWarningMsg, "No display"),
            ],
            "",
            "No window can be opened: no display.",
        ),
        ([(QtMsgType.QtInfoMsg, "Could not load it.")], "", "No window can be opened: could not load it."),
        (
            [],
            "",
            "No window can be opened: this application failed to start because no Qt platform plugin could be "
            "initialized. Reinstalling the application may fix this problem.",
        ),
    ],
)
def test_what_qt_says_becomes_a_sentence(said: list[tuple[QtMsgType, str]], platform: str, sentence: str) -> None:
    assert no_window([*said, (QtMsgType.QtFatalMsg, GIVES_UP)], platform) == sentence
