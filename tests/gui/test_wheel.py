"""The wheel scrolls; it changes what a box says only while that has the keyboard."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from mouse import on_screen
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget

import texlab
from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.number_box import NumberBox, WholeBox
from texlab.widgets.short_box import ShortBox
from texlab.widgets.slider import Slider

RAW = re.compile(r"\b(?:QComboBox|QSlider|QDial|QSpinBox|QDoubleSpinBox|QDateEdit)\(\)")
KINDS: dict[str, Any] = {
    "choice": ChoiceBox,
    "short": ShortBox,
    "number": NumberBox,
    "whole": WholeBox,
    "slider": lambda: Slider("Size", str),
}


class Panel(QWidget):
    """Counts what reaches it."""

    def __init__(self, control: QWidget) -> None:
        super().__init__()
        self.reached = 0
        self.other = WholeBox()
        layout = QVBoxLayout(self)
        layout.addWidget(control)
        layout.addWidget(self.other)

    def wheelEvent(self, event: QWheelEvent) -> None:
        self.reached += 1


def turn(widget: QWidget) -> None:
    """Turn the wheel over a widget; what it leaves goes to those around it, as Qt does with real events."""
    at = QPointF(widget.rect().center())
    none = Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False
    reached: QWidget | None = widget
    while reached is not None:
        button = Qt.MouseButton.NoButton
        event = QWheelEvent(at, widget.mapToGlobal(at), QPoint(), QPoint(0, -120), button, *none)
        QApplication.sendEvent(reached, event)
        if event.isAccepted():
            return
        reached = reached.parentWidget()


@pytest.mark.parametrize("kind", KINDS)
def test_without_the_keyboard_the_panel_scrolls(qtbot: Any, kind: str) -> None:
    control = KINDS[kind]()
    if isinstance(control, ChoiceBox):
        control.addItems(["a", "b", "c"])
        control.setCurrentIndex(1)
    else:
        control.setValue(50)
    panel = Panel(control)
    qtbot.addWidget(panel)
    panel.show()
    on_screen(qtbot, panel)
    panel.activateWindow()
    panel.other.setFocus()

    def value() -> float:
        return control.currentIndex() if isinstance(control, ChoiceBox) else control.value()

    before = value()
    turn(control)
    assert (value(), panel.reached) == (before, 1)
    assert not control.focusPolicy() & ~Qt.FocusPolicy.StrongFocus
    control.setFocus()
    qtbot.waitUntil(control.hasFocus)
    turn(control)
    assert value() != before


def test_no_box_of_the_program_is_another_one() -> None:
    root = Path(texlab.__file__).parent
    found = [
        f"{path.relative_to(root)}: {line.strip()}"
        for path in sorted(root.rglob("*.py"))
        for line in path.read_text("utf-8").splitlines()
        if RAW.search(line)
    ]
    assert found == []
