"""The notes of the project: plain text that goes with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QPlainTextEdit, QVBoxLayout

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.state.intentions import EditNotes, Tell
from texlab.widgets.plain import set_tip
from texlab.widgets.settling import Settling
from texlab_core.documents.project import MAX_NOTE

if TYPE_CHECKING:
    from PySide6.QtCore import QEvent, QObject

    from texlab.state.scene import Scene

REST_MS = 400
TOO_LONG = f"Notes hold at most {MAX_NOTE:,} characters; what comes after them is not kept."
IN_A_LESSON = "A lesson is given; the notes of your own session come back after it."


class NotesDock(FramedDock):
    """A field for plain text; what is written is a step of the history once nothing more is typed for a moment."""

    name = "notes"
    title = "Notes"
    help = (
        "What you want to remember of this project, as plain text. It is kept with the session, undo brings "
        "earlier words back, and a project file (File, Save project) holds it, a copy for a student too."
    )
    order = 97
    rest_ms = 0

    def build(self) -> None:
        """Make the field."""
        self._shown = ""
        self._open = False
        self.settling = Settling(self, REST_MS, lambda: self._tell(final=False))
        self.field = QPlainTextEdit()
        self.field.setObjectName("notes-text")
        self.field.setAccessibleName("Notes of the project")
        self.field.setPlaceholderText("Notes of this project, kept in its file")
        self.field.setTabChangesFocus(True)
        set_tip(self.field, "Plain text; saved with the session and in project files")
        self.field.textChanged.connect(self.settling.start)
        self.field.installEventFilter(self)
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.field)

    def show_scene(self, scene: Scene) -> None:
        """Write the notes into the field, but for the words that are being typed."""
        super().show_scene(scene)
        if scene.notes != self._shown and scene.lesson.lesson is None:
            self._shown = scene.notes
            self.settling.stop()
            with QSignalBlocker(self.field):
                self.field.setPlainText(scene.notes)

    def question(self, scene: Scene) -> Question | None:
        """Ask nothing: there is only the question whether there is a field."""
        self.why = "" if scene.lesson.lesson is None else IN_A_LESSON
        return None if self.why else Question((self.name,), lambda _: True)

    def show_answer(self, answer: bool) -> None:
        """Leave the field as it is."""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """End an edit when the keyboard goes elsewhere."""
        if watched is self.field and event.type() == event.Type.FocusOut:
            self._tell(final=True)
        return super().eventFilter(watched, event)

    def _tell(self, *, final: bool) -> None:
        self.settling.stop()
        typed = self.field.toPlainText()
        text = clean(typed)
        if text != self._shown or (final and self._open):
            self._shown, self._open = text, not final
            self.intention.emit(EditNotes(text, final))
            if len(typed) > MAX_NOTE:
                self.intention.emit(Tell(TOO_LONG, problem=True))


def clean(text: str) -> str:
    """Return a text as files can hold it: no half characters, no zeros, at most ``MAX_NOTE`` characters."""
    return text.encode("utf-8", "replace").decode().replace("\0", "")[:MAX_NOTE]
