"""What a screen reader says: the name of everything in the window and its dialogs, and what sliders set."""

from __future__ import annotations

import re
import weakref
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAccessible
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractScrollArea,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QDialog,
    QLabel,
    QLineEdit,
    QMenu,
    QProgressBar,
    QScrollBar,
    QSlider,
    QWidget,
)

import texlab
from tests.gui.conftest import ids, make_everything, wait_idle
from texlab.columns.history_popup import HistoryPopup
from texlab.columns.numbers_popup import NumbersPopup
from texlab.presets.dialog import PresetDialog
from texlab.widgets.calm_wheel import CalmWheel
from texlab.widgets.slider import Slider
from texlab.window.batch_dialog import BatchDialog
from texlab.window.export_dialog import ExportDialog
from texlab.window.help_window import HelpWindow
from texlab.window.own_layouts import LayoutsDialog
from texlab.window.palette import CommandPalette
from texlab.window.popout_dialog import PopoutDialog
from texlab.window.run_dialog import RunDialog
from texlab.window.tab_picture_dialog import SizeDialog

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab.app.explorer import Explorer

WORD = re.compile(r"[^\W\d_]{2}")
# What Qt makes for itself inside of other widgets.
INNER = re.compile(r"qt_.*|Scroll(Left|Right)Button|")


def said(widget: QWidget) -> str:
    """Return what a screen reader is told as the name; Linux's lists give their text, and have it beside."""
    if isinstance(widget, QComboBox):
        return widget.accessibleName()
    if widget.isWindow() and widget.windowTitle():
        return widget.windowTitle()
    interface = QAccessible.queryAccessibleInterface(widget)
    return "" if interface is None else str(interface.text(QAccessible.Text.Name))


def named(root: QWidget) -> Iterator[QWidget]:
    """Yield what has to have a name: what is operated, what shows something, and the program's own parts."""
    for widget in [root, *root.findChildren(QWidget)]:
        ours = type(widget).__module__.startswith("texlab")
        inner = not ours and INNER.fullmatch(widget.objectName())
        if isinstance(widget, QAbstractButton) and not widget.objectName():
            # The cross that clears a field.
            inner = isinstance(widget.parent(), QLineEdit)
        unseen = widget.testAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        strut = widget.objectName() == "strut"
        # A list within a box, its corner and the like; the value of a knob is in its slider and its number box.
        if inner or strut or unseen or isinstance(widget, QLabel | QMenu | QScrollBar) or widget.focusProxy():
            continue
        shows = QAbstractButton | QAbstractItemView | QAbstractScrollArea | QComboBox | QProgressBar | QSlider
        if ours or isinstance(widget, shows):
            yield widget


def nameless(root: QWidget) -> list[str]:
    found = [each for each in named(root) if not WORD.search(said(each))]
    return sorted({f"{type(each).__name__} {each.objectName()!r}" for each in found})


def test_every_part_of_the_window_has_a_name(explorer: Explorer) -> None:
    make_everything(explorer)
    explorer.presenter.show_scene(explorer.controller.scene())
    found = [*named(explorer.window)]
    assert len(found) > 200
    assert not nameless(explorer.window), "\n".join(nameless(explorer.window))
    # The wheel gives nothing the keyboard, and changes nothing on its way.
    boxes = [
        each for kind in (QComboBox, QAbstractSpinBox, QSlider) for each in explorer.window.findChildren(kind)
    ]
    assert len(boxes) > 80
    assert [each.objectName() for each in boxes if not isinstance(each, CalmWheel)] == []
    calm = Qt.FocusPolicy.StrongFocus
    assert [each.objectName() for each in boxes if each.focusPolicy() & ~calm] == []


def all_kinds(kind: type[QDialog] = QDialog) -> set[type[QDialog]]:
    below = {each for each in kind.__subclasses__() if each.__module__.startswith("texlab")}
    return below.union(*(all_kinds(each) for each in below))


def test_every_part_of_every_dialog_has_a_name(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    view = explorer.workspace.columns[ids(explorer)[0]]
    dialogs = [
        BatchDialog(),
        ExportDialog(),
        PopoutDialog(),
        HelpWindow(),
        LayoutsDialog(explorer.own_layouts, window),
        CommandPalette([], window),
        PresetDialog("one", "heeger-bergen", [], note="", is_new=True, parent=window),
        SizeDialog("Maps", 300, 200, window),
        NumbersPopup("Heeger-Bergen", view.scene, {}, window),
        HistoryPopup(view.scene, "", window),
    ]
    for dialog in dialogs:
        qtbot.addWidget(dialog)
        assert WORD.search(dialog.windowTitle() or dialog.accessibleName()), type(dialog).__name__
        assert nameless(dialog) == [], type(dialog).__name__
    assert {type(each) for each in dialogs} == all_kinds() - {RunDialog}
    window.actions_by_name["notes"].trigger()
    window.actions_by_name["about"].trigger()
    others = [each for each in QApplication.topLevelWidgets() if each.objectName() in ("notes-window", "about")]
    assert len(others) == 2
    assert [nameless(each) for each in others] == [[], []]


def test_sliders_are_made_by_one_module() -> None:
    folder = Path(texlab.__file__).parent
    made = re.compile(r"QSlider\(\w|class .*\bQSlider\):")
    makers = [path.name for path in folder.rglob("*.py") if made.search(path.read_text())]
    assert makers == ["slider.py"]


def test_every_slider_says_what_it_sets_wherever_it_stands(qtbot: Any, explorer: Explorer) -> None:
    make_everything(explorer)
    sliders = explorer.window.findChildren(QSlider)
    assert len(sliders) >= 9
    for slider in sliders:
        assert isinstance(slider, Slider)
        slider.blockSignals(True)
        names = set()
        for place in {slider.minimum(), slider.maximum()}:
            slider.setValue(place)
            names.add(said(slider))
        slider.blockSignals(False)
        assert all(name.startswith(f"{slider.title}: ") for name in names)


def test_a_slider_says_values_in_their_unit(qtbot: Any, explorer: Explorer) -> None:
    docks = explorer.window.docks
    for name in ("maps", "steps", "convergence", "sweeps"):
        explorer.window.raise_dock(name)
        wait_idle(qtbot, explorer)
    content = {name: dock.widget() for name, dock in docks.items()}
    maps, steps, heat, zoom = (
        explorer.window.findChild(QSlider, name)
        for name in ("maps-opacity", "steps-slider", "convergence-iteration", "sweeps-zoom")
    )
    assert content.keys() >= {"maps", "steps"}
    maps.setValue(40)
    assert said(maps) == "Opacity of the map: 40 %"
    zoom.setValue(200)
    assert said(zoom) == "Size of the pictures: 200 px"
    heat.setValue(1)
    assert said(heat) == f"Heat map: iteration 1 of {heat.maximum()}"
    steps.setValue(0)
    frames = explorer.controller.scene().selected.frames
    assert said(steps) == f"Stage: {frames[0].name}, 1 of {len(frames)}"
    knob = explorer.window.parameters.form.knobs["iterations"]
    for value in (1, 7):
        knob.box.setValue(value)
        assert said(knob.slider) == f"iterations: {value}"


@pytest.mark.parametrize("range_", [(0, 0), (3, 9)])
def test_a_slider_tells_what_changes_while_it_stands(qtbot: Any, range_: tuple[int, int]) -> None:
    unit = ["px"]
    slider = Slider("size", lambda place: f"{place} {unit[0]}")
    qtbot.addWidget(slider)
    slider.setRange(*range_)
    assert said(slider) == f"size: {range_[0]} px"
    unit[0] = "%"
    slider.tell()
    assert said(slider) == f"size: {range_[0]} %"


def test_a_slider_keeps_nobody_alive(qtbot: Any) -> None:
    class Owner:
        def __init__(self) -> None:
            self.slider = Slider("size", self.said)

        def said(self, place: int) -> str:
            return f"{place} px"

    owner = Owner()
    qtbot.addWidget(owner.slider)
    slider, gone = owner.slider, weakref.ref(owner)
    slider.setValue(3)
    assert said(slider) == "size: 3 px"
    del owner
    assert gone() is None
    slider.setValue(4)
    assert said(slider) == "size: "
