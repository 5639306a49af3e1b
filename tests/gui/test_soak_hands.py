"""The hands of the soak send what a person's do, and nothing to a window that has gone."""

from __future__ import annotations

import random
from typing import Any

import pytest
import shiboken6
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QWidget

from tests.soak.hands import Hands

KEYS = Qt.Key
HELD = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.ControlModifier
LISTENED = {
    QEvent.Type.KeyPress: "key",
    QEvent.Type.MouseButtonPress: "press",
    QEvent.Type.MouseButtonRelease: "release",
    QEvent.Type.MouseButtonDblClick: "double",
}


class Told(QWidget):
    """Tells what comes, and closes for good at one of these."""

    def __init__(self, ends_at: str = "") -> None:
        super().__init__()
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.resize(80, 60)
        self.told: list[str] = []
        self._ends_at = ends_at

    def event(self, event: QEvent) -> bool:
        name = LISTENED.get(event.type())
        if name is not None:
            if isinstance(event, QKeyEvent):
                name = f"{event.text()!r} {KEYS(event.key()).name}"
            self.told.append(name)
            if name == self._ends_at:
                self.close()
            event.accept()
            return True
        return super().event(event)


class Steady(Hands):
    """Hands that always mean the same place."""

    def place(self, front: QWidget, widget: QWidget | None = None) -> QPoint:
        return QPoint(30, 20)


@pytest.fixture
def hands() -> Steady:
    nobody: Any = None
    return Steady(random.Random(1), nobody)


@pytest.fixture
def shown(qtbot: Any) -> Any:
    def show(ends_at: str = "") -> Told:
        made = Told(ends_at)
        with qtbot.waitExposed(made):
            made.show()
        made.setFocus()
        return made

    return show


def test_a_stroke_is_what_a_keyboard_sends(shown: Any, hands: Steady) -> None:
    window = shown()
    hands.key(window, KEYS.Key_A, HELD)
    assert set(window.told[:2]) == {"'' Key_Shift", "'' Key_Control"}
    assert window.told[2:] == ["'A' Key_A"]
    hands.key(window, KEYS.Key_A)
    hands.double_click(window)
    assert window.told[3:] == ["'a' Key_A", "press", "release", "double", "release"]
    window.close()


@pytest.mark.parametrize("ends_at", ["'' Key_Shift", "'' Key_Control", "'A' Key_A"])
def test_no_key_goes_to_a_window_that_has_gone(shown: Any, hands: Steady, ends_at: str) -> None:
    window = shown(ends_at)
    told = window.told
    hands.key(window, KEYS.Key_A, HELD)
    assert told[-1] == ends_at
    assert not shiboken6.isValid(window)


@pytest.mark.parametrize("ends_at", ["press", "release", "double"])
def test_no_click_goes_to_a_window_that_has_gone(shown: Any, hands: Steady, ends_at: str) -> None:
    window = shown(ends_at)
    told = window.told
    hands.double_click(window)
    assert told[-1] == ends_at
    assert told == ["press", "release", "double"][: len(told)]
