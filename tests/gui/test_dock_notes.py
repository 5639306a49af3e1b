"""The notes of a project: written, taken back, kept by the session and by project files."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest
from dock_scenes import feed, shown
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QFocusEvent
from PySide6.QtWidgets import QApplication

from texlab.docks.notes import IN_A_LESSON, NotesDock, clean
from texlab.state.intentions import EditNotes, Tell
from texlab.state.lesson_scene import LessonScene
from texlab.state.scene import Scene
from texlab.state.session import State
from texlab.storage.projects import project_of
from texlab.storage.settings import notes_of, session_to_json
from texlab.widgets.settling import settle_all
from texlab_core.documents.project import MAX_NOTE


@pytest.fixture
def dock(qtbot: Any) -> Any:
    made = shown(qtbot, NotesDock(), 400, 200)
    feed(made, Scene(notes="Before."))
    return made


def sent(dock: NotesDock) -> list[Any]:
    found: list[Any] = []
    dock.intention.connect(found.append)
    return found


def leave(dock: NotesDock) -> None:
    QApplication.sendEvent(dock.field, QFocusEvent(QEvent.Type.FocusOut, Qt.FocusReason.OtherFocusReason))


def test_what_is_typed_is_told_once_nothing_follows(qtbot: Any, dock: NotesDock) -> None:
    found = sent(dock)
    assert dock.field.toPlainText() == "Before."
    qtbot.keyClicks(dock.field, "More. ")
    assert found == []
    settle_all(dock)
    assert found == [EditNotes("More. Before.", final=False)]
    qtbot.keyClicks(dock.field, "B")
    leave(dock)
    assert found[1:] == [EditNotes("More. BBefore.", final=True)]
    leave(dock)
    assert len(found) == 2


def test_words_are_not_written_over_while_they_are_typed(qtbot: Any, dock: NotesDock) -> None:
    qtbot.keyClicks(dock.field, "1")
    settle_all(dock)
    qtbot.keyClicks(dock.field, "2")
    # The scene of what was told before comes only now.
    dock.show_scene(Scene(notes="1Before."))
    assert dock.field.toPlainText() == "12Before."
    # Undo, or a project that was opened, is shown.
    dock.show_scene(Scene(notes="Other"))
    assert dock.field.toPlainText() == "Other"


def test_a_lesson_does_not_touch_them(dock: NotesDock) -> None:
    found = sent(dock)
    lesson: Any = object()
    given = Scene(notes="", lesson=dataclasses.replace(LessonScene(), lesson=lesson))
    dock.show_scene(given)
    assert dock.question(given) is None
    dock.present_nothing("")
    assert dock.message == IN_A_LESSON
    leave(dock)
    assert found == []
    feed(dock, Scene(notes="Before."))
    assert dock.message is None
    assert dock.field.toPlainText() == "Before."


def test_what_no_file_holds_is_left_out(dock: NotesDock, monkeypatch: pytest.MonkeyPatch) -> None:
    assert clean("a\0b\ud800c\n\u00e4") == "ab?c\n\u00e4"
    monkeypatch.setattr("texlab.docks.notes.MAX_NOTE", 100)
    found = sent(dock)
    dock.field.setPlainText("x" * 101)
    leave(dock)
    first, second = found
    assert first == EditNotes("x" * 100)
    assert isinstance(second, Tell)
    assert second.problem


def test_they_go_with_session_and_project(qtbot: Any) -> None:
    state = State(notes="Why the wall fails:\nα too large.")
    assert notes_of(session_to_json(state, 0)) == state.notes
    assert project_of(state, 0, {}, "").notes == state.notes
    assert project_of(state, 0, {}, "", for_student=True).notes == state.notes
    for odd in (None, [], {"notes": 3}, {"notes": "x" * (MAX_NOTE + 1)}, {}):
        assert notes_of(odd) == ""
