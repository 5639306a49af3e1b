"""A tab's own keys win while it has the focus, and no others do: every tab, every key of the help."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QGuiApplication, QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QPlainTextEdit,
    QTextEdit,
    QWidget,
)

import texlab
from tests.gui.conftest import ids, wait_idle
from texlab.docks.fill.mask_canvas import MaskCanvas
from texlab.docks.inputs.crop_pane import CropPane
from texlab.docks.lessons.editor import LessonEditor
from texlab.docks.solids.panes import ObjectPane, SlicePane
from texlab.state.intentions import RunSweep, StopSweep
from texlab.widgets.own_keys import CopyKey
from texlab.widgets.settling import Settling, settle_all
from texlab.window.stops import stops
from texlab_core.engine.registry import methods
from texlab_core.files.resources import resource

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.app.explorer import Explorer

CONTROL = Qt.KeyboardModifier.ControlModifier
ARROWS = ("Left", "Right", "Up", "Down")
# They take characters, and Ctrl with some, as text: Qt's own way.
TYPING = (QLineEdit, QAbstractSpinBox, QPlainTextEdit, QTextEdit, QComboBox)


def documented() -> tuple[set[str], dict[str, set[str]]]:
    """Return the window's keys, and those of each tab by its title, as the help page lists them."""
    text = resource("help/shortcuts.md").read_text(encoding="utf-8")
    window, _, tabs = text.partition("## In the tabs")
    rows = re.compile(r"^\| (?!Keys|---)(.+?) \| (.+?) \|$", re.M)
    found: dict[str, set[str]] = {}
    for keys, what in rows.findall(tabs):
        names: list[str] = []
        for part in what.split(";"):
            named = re.match(r"\s*([A-Z][\w ]*(?:, [A-Z][\w ]*)*)(?:, while [\w ]+)?: ", part)
            names += named[1].split(", ") if named else []
            for name in named[1].split(", ") if named else names[-1:]:
                found.setdefault(name, set()).update(spelled(keys), "0123456789" if "digits" in what else "")
    return {key for keys, _ in rows.findall(window) for key in spelled(keys)}, found


def spelled(keys: str) -> set[str]:
    """Return single keys: "Ctrl+arrow keys, +" is Ctrl+Left ... and +."""
    found: set[str] = set()
    for each in keys.split(", "):
        head, arrows, _ = each.lower().partition("arrow keys")
        found |= {f"{head.capitalize()}{name}" for name in ARROWS} if arrows else {each}
    return found


def override(widget: QWidget, key: str) -> bool:
    """Ask as Qt does whether a widget, or one around it, keeps a key from the window."""
    pressed = QKeySequence(key)[0]
    text = key if len(key) == 1 else ""
    event = QKeyEvent(QEvent.Type.ShortcutOverride, pressed.key(), pressed.keyboardModifiers(), text)
    event.ignore()
    # It goes on to the widgets around it by itself.
    QApplication.sendEvent(widget, event)
    return event.isAccepted()


@pytest.fixture
def everything(open_window: Callable[..., Explorer], texture: Path) -> Explorer:
    """A window with columns that have tabs of their own."""
    columns = [(name, methods()[name].params()) for name in ("de-bonet", "msg", "efros-leung")]
    return open_window(str(texture), columns, size=24)


COLUMN_OF = {"code": "msg", "fill": "efros-leung"}


def in_front(qtbot: Any, explorer: Explorer, name: str, *, wait: bool = True) -> Any:
    """Choose the column that a tab is about, bring the tab to the front and wait for what it shows."""
    wanted = COLUMN_OF.get(name, "de-bonet")
    column = next(each for each in explorer.session.state.columns if each.method == wanted)
    explorer.session.select(column.id)
    if name == "explain":
        explorer.controller.pointing.pin(column.id, 9, 9)
    explorer.window.raise_dock(name)
    QApplication.processEvents()
    if wait:
        wait_idle(qtbot, explorer)
    return explorer.hosts[name].dock


def test_every_tab_keeps_its_own_keys_and_no_others(qtbot: Any, everything: Explorer) -> None:
    window_keys, of_tabs = documented()
    titles = {dock.title: dock for dock in everything.docks}
    assert of_tabs.keys() <= titles.keys()
    assert {"1", "Esc", "+", "Ctrl+Z", "Ctrl+C", "PgDown", "L"} <= window_keys
    # Only of a state that another test brings about.
    waiting = {
        "Pyramid": {"Esc", "0", "1", "2", "4"},
        "Sweeps": {"Esc", "N", "K", "C", *ARROWS},
        "Dependence": {"Esc"},
    }
    # They have no picture here; the next test looks at them alone.
    waiting |= {name: of_tabs[name] for name in ("Solid", "Inputs", "Fill", "Lessons")}
    for title, dock in titles.items():
        # What a tab without keys of its own shows is not waited for.
        in_front(qtbot, everything, dock.name, wait=title in of_tabs)
        own = of_tabs.get(title, set())
        seen: set[str] = set()
        inside = [
            each
            for each in stops(everything.window, [dock])
            if dock.isAncestorOf(each) and not isinstance(each, TYPING)
        ]
        for widget in inside:
            widget.setFocus()
            kept = {key for key in window_keys | own if override(widget, key)}
            is_copied = widget.findChild(CopyKey) is not None
            extra = kept & window_keys - own - ({"Ctrl+C"} if is_copied else set())
            assert not extra, f"{title}, {widget.objectName()}: {extra}"
            seen |= kept
        assert seen >= own - waiting.get(title, set()), f"{title}: {own - seen}"


def test_solids_inputs_masks_and_lessons_keep_their_keys(qtbot: Any) -> None:
    of_tabs = documented()[1]
    editor = LessonEditor()
    for each in (editor, editor.words):
        qtbot.addWidget(each)
    steps = editor.steps
    assert {key for key in of_tabs["Lessons"] if override(steps, key)} == of_tabs["Lessons"]
    assert not any(override(steps, key) for key in ("PgDown", "Ctrl+L", "Ctrl+PgDown", "1"))
    canvas = MaskCanvas("canvas", "Mask")
    qtbot.addWidget(canvas)
    assert not override(canvas, "Left")
    canvas.set_picture(np.zeros((8, 8, 3), np.uint8))
    assert {key for key in of_tabs["Fill"] if override(canvas, key)} == of_tabs["Fill"]
    for pane, keys in (
        (SlicePane("slice", "Slice"), of_tabs["Solid"] - {"+", "-"}),
        (ObjectPane("object", "Object"), of_tabs["Solid"] - {"PgUp", "PgDown"}),
        (CropPane("crop", "Source"), of_tabs["Inputs"]),
    ):
        qtbot.addWidget(pane)
        assert {key for key in keys if override(pane, key)} == keys
        assert not any(
            override(pane, key) for key in ("Ctrl+Z", "Ctrl+PgDown", "Ctrl+Shift+Left", "Esc", "1", "L")
        )


def test_one_place_answers_who_wants_a_key() -> None:
    folder = Path(texlab.__file__).parent
    asked = {path.name for path in folder.rglob("*.py") if "ShortcutOverride" in path.read_text(encoding="utf-8")}
    assert asked == {"own_keys.py"}
    in_tabs = {path for path in (folder / "docks").rglob("*.py") if "def keyPressEvent" in path.read_text("utf-8")}
    assert in_tabs
    assert [path.name for path in in_tabs if "def wants_key" not in path.read_text("utf-8")] == []


def test_a_number_typed_into_a_code_is_that_number(
    qtbot: Any, everything: Explorer, monkeypatch: pytest.MonkeyPatch
) -> None:
    dock = in_front(qtbot, everything, "code")
    window = everything.window
    asked: list[str] = []
    for name in ("actual", "zoom-in", "zoom-out", "stop"):
        window.actions_by_name[name].triggered.connect(lambda _=False, name=name: asked.append(name))
    grid = dock.grids["energy"]
    qtbot.mouseClick(grid, Qt.MouseButton.LeftButton, pos=grid.cell_rect(1, 1).center().toPoint())
    for key in (Qt.Key.Key_1, Qt.Key.Key_9):
        qtbot.keyClick(window.focusWidget(), key)
    assert window.focusWidget() is dock.box or dock.box.isAncestorOf(window.focusWidget())
    qtbot.keyClick(window.focusWidget(), Qt.Key.Key_Return)
    assert dock.box.value() == 19
    assert asked == []
    grid.setFocus()
    qtbot.keyClick(grid, Qt.Key.Key_Plus)
    assert dock.box.value() > 19
    assert asked == []
    wait_idle(qtbot, everything)


def test_in_the_pyramid_1_is_a_gain_and_escape_closes(qtbot: Any, explorer: Explorer) -> None:
    dock = in_front_of_two(qtbot, explorer, "pyramid")
    asked: list[str] = []
    for name in ("actual", "stop"):
        explorer.window.actions_by_name[name].triggered.connect(lambda _=False, name=name: asked.append(name))
    view = dock.exemplar
    view.setFocus()
    qtbot.keyClick(view, Qt.Key.Key_Home)
    qtbot.waitUntil(dock.detail.isVisible)
    qtbot.keyClick(view, Qt.Key.Key_E)
    assert dock.edit.isChecked()
    for key, gain in ((Qt.Key.Key_4, 4), (Qt.Key.Key_1, 1), (Qt.Key.Key_0, 0)):
        qtbot.keyClick(view, key)
        assert dock._gain_group.checkedId() == gain
    qtbot.keyClick(view, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: not dock.detail.isVisible())
    assert asked == []
    # What has nothing to close is the window's again.
    qtbot.keyClick(view, Qt.Key.Key_Escape)
    assert asked == ["stop"]
    dock._reset()
    wait_idle(qtbot, explorer)


def in_front_of_two(qtbot: Any, explorer: Explorer, name: str) -> Any:
    explorer.window.raise_dock(name)
    QApplication.processEvents()
    wait_idle(qtbot, explorer)
    return explorer.hosts[name].dock


def test_escape_in_sweeps_stops_the_sweep_and_nothing_else(qtbot: Any, explorer: Explorer) -> None:
    dock = in_front_of_two(qtbot, explorer, "sweeps")
    asked: list[str] = []
    explorer.window.actions_by_name["stop"].triggered.connect(lambda _=False: asked.append("stop"))
    intentions: list[Any] = []
    dock.intention.connect(intentions.append)
    for widget in (dock.sheet.canvas, dock.start_button, dock.zoom):
        widget.setFocus()
        qtbot.keyClick(widget, Qt.Key.Key_Return, CONTROL)
        assert isinstance(intentions[-1], RunSweep), widget.objectName()
        qtbot.waitUntil(lambda: dock.running)
        qtbot.keyClick(widget, Qt.Key.Key_Escape)
        assert intentions[-1] == StopSweep(), widget.objectName()
        qtbot.waitUntil(lambda: not dock.running)
    assert asked == []
    qtbot.keyClick(dock.sheet.canvas, Qt.Key.Key_Escape)
    assert asked == ["stop"]
    wait_idle(qtbot, explorer)


def test_a_table_is_copied_with_the_key_of_copy(qtbot: Any, explorer: Explorer) -> None:
    dock = in_front_of_two(qtbot, explorer, "histograms")
    table = dock.table
    table.setFocus()
    QGuiApplication.clipboard().clear()
    qtbot.keyClick(table, Qt.Key.Key_C, CONTROL)
    assert "skew" in QGuiApplication.clipboard().text()


# Undo.


def test_an_undo_right_after_a_key_undoes_that_key(qtbot: Any, everything: Explorer) -> None:
    dock = in_front(qtbot, everything, "thresholds")
    session = everything.session
    editor = dock.editor
    editor.setFocus()
    before = session.selected_column.params
    for widget, key in ((editor, Qt.Key.Key_Plus), (dock.distances, Qt.Key.Key_Right)):
        widget.setFocus()
        qtbot.keyClick(widget, key)
        assert session.selected_column.params != before
        assert any(each.isActive() for each in dock.findChildren(Settling))
        qtbot.keyClick(widget, Qt.Key.Key_Z, CONTROL)
        assert session.selected_column.params == before
        assert not any(each.isActive() for each in everything.window.findChildren(Settling))
        # Whoever waited for the end of the edit brings nothing back.
        wait_idle(qtbot, everything)
        settle_all(everything.window)
        assert session.selected_column.params == before
        assert editor.view.table == before.thresholds


def test_an_undo_right_after_any_debounced_edit_undoes_it(qtbot: Any, explorer: Explorer) -> None:
    session, window = explorer.session, explorer.window
    qtbot.mouseClick(explorer.workspace.exemplar.crop_button, Qt.MouseButton.LeftButton)
    wait_idle(qtbot, explorer)
    slider = window.parameters.form.knobs["iterations"].slider
    for widget, key in ((slider, Qt.Key.Key_Right), (explorer.workspace.exemplar.pane, Qt.Key.Key_Left)):
        before = session.state
        widget.setFocus()
        qtbot.keyClick(widget, key)
        assert session.state != before
        window.actions_by_name["undo"].trigger()
        assert session.state == before, widget.objectName()
        wait_idle(qtbot, explorer)
        settle_all(window)
        assert session.state == before, widget.objectName()
    assert ids(explorer)
