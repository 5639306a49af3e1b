"""A method without a help page has one that is made from its declarations."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest

from texlab.window.generated_help import method_page
from texlab.window.help_window import HelpWindow
from texlab_core.engine.params import describe
from texlab_core.engine.registry import methods
from texlab_core.files.resources import resource


@pytest.mark.parametrize("name", list(methods()))
def test_every_knob_and_every_failure_is_on_the_page(qtbot: Any, name: str) -> None:
    from PySide6.QtGui import QTextDocument

    method = methods()[name]
    document = QTextDocument()
    document.setMarkdown(method_page(method))
    text = " ".join(document.toPlainText().split())
    assert method.title in text
    assert " ".join(method.summary.split()) in text
    for field in describe(method.params):
        assert field.knob.help in text
    for phrase in method.fails_on:
        assert phrase in text


def test_what_another_package_writes_is_no_markup(qtbot: Any) -> None:
    from PySide6.QtGui import QTextDocument

    evil = '<img src="/dev/zero"> ![x](/etc/passwd) **bold**'
    document = QTextDocument()
    document.setMarkdown(method_page(dataclasses.replace(methods()["tiling"], summary=evil)))
    assert evil in document.toPlainText()
    assert "<img" not in document.toHtml()


def test_the_help_window_shows_it(qtbot: Any, stub: Any) -> None:
    window = HelpWindow()
    qtbot.addWidget(window, before_close_func=HelpWindow.leave)
    window.open_page("stub")
    assert window.browser.page == "stub"
    assert "made from what the method declares" in window.browser.toPlainText()
    window.close()
    with pytest.raises(FileNotFoundError):
        resource("help/stub.md").read_text(encoding="utf-8")
