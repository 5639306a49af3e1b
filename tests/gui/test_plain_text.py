"""What comes from a file is shown as it is written: never as markup, which could load any file of the machine."""

from __future__ import annotations

import ast
import json
import re
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractItemView, QApplication, QComboBox, QLabel, QMessageBox, QTextEdit, QWidget

import texlab
from tests.gui.conftest import make_everything
from texlab.widgets import plain
from texlab_core.documents.record import save_result
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Iterator

EVIL = '<img src="/evil.png"><b>bold</b>'
CODE = Path(texlab.__file__).parent
# Makers of text that Qt may take for markup, and the one module that may call each.
MAKERS = {
    "QLabel": "widgets/plain.py",
    "QMessageBox": "widgets/plain.py",
    "QErrorMessage": "widgets/plain.py",
    "QToolTip": "widgets/plain.py",
    "setToolTip": "widgets/plain.py",
    "QSpinBox": "widgets/number_box.py",
    "QDoubleSpinBox": "widgets/number_box.py",
    "QDoubleValidator": "widgets/number_box.py",
    "setWhatsThis": "widgets/plain.py",
    "QTextBrowser": "window/help_window.py",
    "QTextEdit": "window/help_window.py",
    "setHtml": "window/help_window.py",
    "setMarkdown": "window/help_window.py",
    "RichText": "widgets/plain.py",
    "AutoText": "widgets/plain.py",
}
# Qt hides a tooltip without showing any text.
HARMLESS = {"docks/base.py": {"QToolTip"}}


@pytest.mark.parametrize("path", sorted(CODE.rglob("*.py")), ids=lambda path: path.relative_to(CODE).as_posix())
def test_nothing_but_one_module_makes_labels_and_tooltips(path: Path) -> None:
    place = path.relative_to(CODE).as_posix()
    used = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Name):
            used.add(node.id)
        elif isinstance(node, ast.Attribute):
            used.add(node.attr)
    wrong = {name for name in used & MAKERS.keys() if MAKERS[name] != place} - HARMLESS.get(place, set())
    assert not wrong, f"{place} uses {', '.join(sorted(wrong))}: take what texlab/{MAKERS[min(wrong)]} offers."


def test_a_label_as_narrow_as_its_room_never_cuts_words() -> None:
    cut = []
    for path in sorted(CODE.rglob("*.py")):
        source = path.read_text(encoding="utf-8")
        for name in set(re.findall(r"(\w[\w.]*) = Label\(", source)):
            # Wraps, fits its own words, or else is to be a ShortLabel.
            kept = f"{name}.setWordWrap(True)" in source or f"{name}.fontMetrics()" in source
            if f"{name}.setSizePolicy(QSizePolicy.Policy.Ignored" in source and not kept:
                cut.append((path.name, name))
    assert cut == []


def test_a_short_label_ends_with_an_ellipsis_and_its_tip_has_all(qtbot: Any) -> None:
    label = plain.ShortLabel("Nine words of a sentence that has no room", muted=True)
    qtbot.addWidget(label)
    assert label.toolTip() == label.text()
    label.resize(label.sizeHint())
    assert label.shown_text() == label.text()
    label.resize(80, label.height())
    assert label.shown_text().endswith("…")
    assert label.fontMetrics().horizontalAdvance(label.shown_text()) <= 80
    shown = label.grab().toImage()
    label.setText(label.shown_text())
    assert label.grab().toImage() == shown


def test_tips_and_labels_show_what_is_written(qtbot: Any) -> None:
    label = plain.Label(EVIL)
    qtbot.addWidget(label)
    plain.set_tip(label, EVIL)
    assert label.textFormat() == Qt.TextFormat.PlainText
    assert label.text() == EVIL
    assert shown(label.toolTip()) == EVIL
    assert plain.tip_text("a & b < c") == "<qt>a&nbsp;&amp;&nbsp;b&nbsp;&lt;&nbsp;c</qt>"
    assert plain.tip_text("plain words") == "plain words"


def test_tips_have_lines_that_can_be_read() -> None:
    words = "word " * 60
    assert max(map(len, plain.tip_text(words).split("\n"))) <= 60
    assert len(plain.tip_text("x" * 10_000)) < 5_000
    for text in (
        "one\n\nthree",
        "tab\tstop",
        "ends in blanks  ",
        "  begins with them",
        f"short\n{words}\nshort",
        "",
    ):
        lines = [
            each for part in text.split("\n") for each in textwrap.wrap(part, 60, break_on_hyphens=False) or [""]
        ]
        assert plain.tip_text(text) == "\n".join(lines)


def shown(tip: str) -> str:
    """Return what a tooltip shows, by Qt's own reading of markup."""
    from PySide6.QtGui import QTextDocument

    document = QTextDocument()
    if tip.startswith("<qt>"):
        document.setHtml(tip)
        return document.toPlainText().replace("\xa0", " ")
    return tip


def marked_up(text: str) -> bool:
    """Return whether Qt could find the evil tag in a text that it may take for markup."""
    return "<img" in text or "<b>bold" in text


def walk(root: QWidget) -> Iterator[tuple[str, str]]:
    """Yield (where, text) for every place below a widget in which markup would be obeyed."""
    for widget in [root, *root.findChildren(QWidget)]:
        where = f"{type(widget).__name__} {widget.objectName()!r}"
        yield f"tooltip of {where}", widget.toolTip()
        yield f"what's this of {where}", widget.whatsThis()
        if isinstance(widget, QLabel) and widget.textFormat() != Qt.TextFormat.PlainText:
            yield where, widget.text()
        if isinstance(widget, QMessageBox) and widget.textFormat() != Qt.TextFormat.PlainText:
            yield where, widget.text() + widget.informativeText()
        if isinstance(widget, QTextEdit):
            yield where, widget.toHtml()
        for action in widget.actions():
            yield f"tooltip of action {action.text()!r}", action.toolTip()
        model = widget.model() if isinstance(widget, QAbstractItemView | QComboBox) else None
        if model is not None:
            for row in range(model.rowCount()):
                for column in range(model.columnCount()):
                    index = model.index(row, column)
                    yield f"item tip in {where}", str(model.data(index, Qt.ItemDataRole.ToolTipRole) or "")


def assert_plain(root: QWidget) -> None:
    for where, text in walk(root):
        assert not marked_up(text), f"{where} would obey markup: {text[:200]}"


@pytest.fixture
def evil_result(tmp_path: Path) -> Path:
    """A result whose exemplar has markup for a name."""
    pixels = np.random.default_rng(0).random((24, 24, 3), np.float32)
    exemplar = as_exemplar(pixels, name=EVIL)
    params = methods()["heeger-bergen"].params.from_json({"scales": 2, "iterations": 1})
    path = tmp_path / "result.png"
    job = Job(method="heeger-bergen", inputs={"exemplar": exemplar}, params=params, size=(24, 24))
    save_result(run(job), path)
    return path


@pytest.fixture
def evil_preset(tmp_path: Path) -> Path:
    path = tmp_path / "preset.json"
    document = {"format": "texlab-preset", "version": 1, "method": "heeger-bergen", "parameters": {}}
    path.write_text(json.dumps(document | {"name": "<b>bold</b> preset", "note": EVIL}))
    return path


def test_the_whole_window_shows_names_notes_and_errors_as_text(
    qtbot: Any, open_window: Any, evil_result: Path, evil_preset: Path, tmp_path: Path
) -> None:
    explorer = open_window(str(evil_result))
    make_everything(explorer)
    window = explorer.window
    assert EVIL in window.windowTitle()
    assert_plain(window)
    explorer.opener.open(str(evil_preset))
    qtbot.waitUntil(lambda: "bold" in window.message_bar.label.text() + "".join(_items(window)))
    assert_plain(window)
    broken = tmp_path / "<b>bold.json"
    broken.write_text('{"format": "<img src=x>"}')
    for each in (tmp_path / "<img src=x>.png", broken):
        window.message_bar.label.setText("")
        explorer.opener.open(str(each))
        qtbot.waitUntil(lambda: window.message_bar.label.text() != "")
        assert_plain(window)


def _items(window: QWidget) -> list[str]:
    return [box.itemText(place) for box in window.findChildren(QComboBox) for place in range(box.count())]


def test_dialogs_show_names_and_notes_as_text(qtbot: Any, explorer: Any) -> None:
    from texlab.presets.dialog import PresetDialog

    dialog = PresetDialog(EVIL, EVIL, [EVIL], note=EVIL, is_new=True, parent=explorer.window)
    qtbot.addWidget(dialog)
    assert_plain(dialog)
    box = plain.message_box(explorer.window, EVIL, EVIL, EVIL)
    qtbot.addWidget(box)
    assert_plain(box)
    explorer.window.actions_by_name["about"].trigger()
    for each in QApplication.topLevelWidgets():
        if each.isVisible():
            assert_plain(each)
    explorer.window.findChild(QMessageBox, "about").close()
