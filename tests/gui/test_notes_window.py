"""The presenter's window: notes, what comes next, controls, clock."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import QRect, Qt
from PySide6.QtWidgets import QApplication, QToolButton, QWidget

from texlab.state.lesson_scene import NO_LESSON, LessonScene
from texlab.style.numbers import clock_text
from texlab.style.theme import LIGHT, set_text_size
from texlab.window.commands import make_actions
from texlab.window.notes_window import CONTROLS, NotesWindow
from texlab_core.lessons.shelf import bundled

if TYPE_CHECKING:
    from PySide6.QtGui import QAction


@pytest.fixture
def audience(qtbot: Any) -> QWidget:
    widget = QWidget()
    qtbot.addWidget(widget)
    widget.show()
    return widget


@pytest.fixture
def actions(audience: QWidget) -> dict[str, QAction]:
    return make_actions(audience)


@pytest.fixture
def notes(qtbot: Any, audience: QWidget, actions: dict[str, QAction]) -> NotesWindow:
    window = NotesWindow(actions, audience, 11.0)
    qtbot.addWidget(window)
    window.show_lesson(NO_LESSON)
    return window


def given(place: int, *ready: int) -> LessonScene:
    lesson = bundled()["heeger-bergen"]
    return LessonScene(
        None, 0, "heeger-bergen", lesson, False, place, tuple(k in ready for k in range(len(lesson.steps)))
    )


def test_it_shows_the_step_and_the_next_one(notes: NotesWindow) -> None:
    notes.set_open(True)
    assert notes.place.text() == "No lesson is given"
    steps = bundled()["heeger-bergen"].steps
    notes.show_lesson(given(1, 0, 1))
    assert notes.place.text().endswith(f": 2 of {len(steps)}")
    assert notes.readiness.text() == f"2 of {len(steps)} ready"
    assert notes.sentence.text() == steps[1].sentence
    assert notes.next.text() == f"Next (being computed): {steps[2].sentence}"
    for name, label in notes.words.items():
        words = getattr(steps[1], name)
        assert label.isVisible() == bool(words)
        assert label.text().endswith(words)
    notes.show_lesson(given(len(steps) - 1, *range(len(steps))))
    assert notes.readiness.text() == "all ready"
    assert notes.next.text() == "This is the last step."
    notes.show_lesson(given(1, *range(len(steps))))
    assert notes.next.text() == f"Next: {steps[2].sentence}"
    notes.show_lesson(NO_LESSON)
    assert not any(label.isVisible() for label in (notes.next, notes.readiness, *notes.words.values()))


def test_its_controls_and_keys_are_those_of_the_window(
    qtbot: Any, notes: NotesWindow, actions: dict[str, QAction]
) -> None:
    notes.set_open(True)
    assert [each.defaultAction() for each in notes.findChildren(QToolButton) if each.defaultAction()] == [
        actions[name] for name in CONTROLS
    ]
    with qtbot.waitActive(notes):
        notes.activateWindow()
    with qtbot.waitSignal(actions["lesson-next"].triggered):
        qtbot.keyClick(notes, Qt.Key.Key_PageDown)
    assert actions["notes"].isChecked()
    notes.close()
    assert not actions["notes"].isChecked()
    assert not notes._tick.isActive()


def test_text_keeps_its_size_when_the_audience_s_grows(qapp: Any, notes: NotesWindow) -> None:
    before = qapp.font().pointSizeF()
    try:
        # It may be opened while the audience reads large text, and words come later, with their step.
        set_text_size(qapp, 30.0, LIGHT)
        notes.set_open(True)
        for points, seen in ((40.0, ("note",)), (60.0, ("note", "question")), (before, tuple(notes.words))):
            set_text_size(qapp, points, LIGHT)
            for name in seen:
                notes.words[name].setText("Said by the teacher.")
                notes.words[name].show()
            QApplication.processEvents()
            assert {label.font().pointSizeF() for label in notes.words.values()} == {11.0}
            assert notes.next.font().pointSizeF() == 11.0
            assert notes.sentence.font().pointSizeF() == pytest.approx(11.0 * 1.4)
    finally:
        set_text_size(qapp, before, LIGHT)


class _Screen:
    def __init__(self, *place: int) -> None:
        self._place = QRect(*place)

    def geometry(self) -> QRect:
        return self._place

    availableGeometry = geometry  # Qt's name


def test_it_goes_to_the_screen_that_the_audience_does_not_see(
    monkeypatch: pytest.MonkeyPatch, notes: NotesWindow, audience: QWidget
) -> None:
    first, mirror, second = _Screen(0, 0, 1280, 720), _Screen(0, 0, 1920, 1080), _Screen(1920, 0, 1600, 900)
    monkeypatch.setattr(audience, "screen", lambda: first, raising=False)
    for screens, wanted in (([first], None), ([first, mirror], None), ([first, mirror, second], second)):
        monkeypatch.setattr(QApplication, "screens", staticmethod(lambda screens=screens: screens))
        assert notes.other_screen() is wanted
    notes.set_open(True)
    assert second.geometry().contains(notes.geometry())


@pytest.mark.parametrize(("seconds", "text"), [(0, "0:00"), (69, "1:09"), (3600, "1:00:00"), (3909, "1:05:09")])
def test_the_clock(seconds: int, text: str) -> None:
    assert clock_text(seconds) == text
