"""The user's own lesson, edited in place: its words, and the order of its steps."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFormLayout,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QPlainTextEdit,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from texlab.state.lesson_edits import doubled, moved, removed, with_steps, with_words
from texlab.widgets.flow_layout import FlowLayout
from texlab.widgets.own_keys import OwnKeys
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.settling import Settling
from texlab_core.documents.lessons import MAX_STEPS, NOTE, SENTENCE, TITLE

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.lesson_scene import LessonScene
    from texlab_core.documents.lessons import Lesson, LessonStep

REST_MS = 800
LINES = 3
# Of the lesson, then of its step: name, what stands before the field, tip, whether it has several lines.
OF_LESSON = (
    ("title", "Title", "What the lesson is called in the list"),
    ("summary", "Summary", "One or two sentences about the lesson, for the list"),
)
OF_STEP = (
    ("sentence", "Sentence", "The one large sentence above the pictures", False),
    ("note", "Note", "What the teacher says about the step", True),
    ("question", "Question", "For the students", True),
    ("answer", "Answer", "Behind a button until it is asked for; goes with a question", True),
    ("try_this", "Try", "What the students should try", True),
)
ORDER_KEYS = {
    QKeySequence("Alt+Up"): "up",
    QKeySequence("Alt+Down"): "down",
    QKeySequence("Ctrl+D"): "double",
    QKeySequence("Delete"): "remove",
    QKeySequence("Ctrl+Z"): "undo",
    QKeySequence("Ctrl+Shift+Z"): "redo",
}


class StepList(OwnKeys, QListWidget):
    """The sentences of the steps, in their order; ``did(what)`` for a key of ``ORDER_KEYS``."""

    did = Signal(str)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Take the keys that change the order."""
        return QKeySequence(event.keyCombination()) in ORDER_KEYS

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Change the order, or choose a step."""
        if self.wants_key(event):
            self.did.emit(ORDER_KEYS[QKeySequence(event.keyCombination())])
        else:
            super().keyPressEvent(event)


class LessonEditor(QWidget):
    """The list of steps with what changes it.

    ``changed(lesson, place)``: the lesson as it is to be, and which step to show; ``chosen(place)``: a step is to
    be shown; ``undone(redo)``.
    """

    changed = Signal(object, int)
    chosen = Signal(int)
    undone = Signal(bool)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("lessons-editor")
        self.setAccessibleName("Lesson that is edited")
        self._lesson: Lesson | None = None
        self._place = 0
        self.steps = StepList()
        self.steps.setObjectName("lessons-steps")
        self.steps.setAccessibleName("Steps of the lesson")
        self.steps.setWordWrap(True)
        self.steps.setTextElideMode(Qt.TextElideMode.ElideNone)
        self.steps.setDragDropMode(QAbstractItemView.DragDropMode.InternalMove)
        self.steps.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        set_tip(self.steps, "Drag a step, or press Alt+Up and Alt+Down, to move it; Delete removes it")
        self.steps.did.connect(self.do)
        self.steps.currentRowChanged.connect(self._chose)
        self.steps.model().rowsMoved.connect(lambda *_: self._dropped())
        bar = QWidget()
        line = FlowLayout(bar)
        self.buttons: dict[str, QPushButton] = {}
        for name, text, tip in (
            ("up", "↑", "Move the step towards the beginning (Alt+Up in the list)"),
            ("down", "↓", "Move the step towards the end (Alt+Down in the list)"),
            ("double", "Double", "Put a copy of the step behind it (Ctrl+D in the list)"),
            ("remove", "Remove", "Take the step out of the lesson (Delete in the list)"),
            ("undo", "Undo", "Take the last change of the lesson back (Ctrl+Z in the list)"),
            ("redo", "Redo", "Make the change that was taken back again (Ctrl+Shift+Z in the list)"),
        ):
            button = self.buttons[name] = QPushButton(text)
            button.setObjectName(f"lessons-{name}")
            button.setAccessibleName(text if text.isalpha() else tip.split(" (")[0])
            set_tip(button, tip)
            button.clicked.connect(lambda _=False, name=name: self.do(name))
            line.addWidget(button)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.steps, 1)
        layout.addWidget(bar)
        self.words = WordFields(self._said)

    def show_lesson(self, scene: LessonScene) -> None:
        """Show the lesson that is given, when it is one that can be changed."""
        lesson = scene.lesson if scene.own else None
        if lesson is not self._lesson or scene.place != self._place:
            # What is still being typed belongs to the step before.
            self.words.settling.end_now()
        self._lesson, self._place = lesson, scene.place
        count = 0 if lesson is None else len(lesson.steps)
        blocked = self.steps.blockSignals(True)
        sentences = [] if lesson is None else [each.sentence for each in lesson.steps]
        if [self.steps.item(row).text() for row in range(self.steps.count())] != sentences:
            self.steps.clear()
            self.steps.addItems(sentences)
        self._number()
        self.steps.setCurrentRow(scene.place if count else -1)
        self.steps.blockSignals(blocked)
        enabled = {
            "up": scene.place > 0,
            "down": scene.place + 1 < count,
            "double": count > 0,
            "remove": count > 1,
            "undo": scene.can_undo,
            "redo": scene.can_redo,
        }
        for name, button in self.buttons.items():
            button.setEnabled(lesson is not None and enabled[name])
        self.words.show_step(lesson, None if lesson is None else lesson.steps[scene.place])

    def do(self, what: str) -> None:
        """Do what a button or a key says, where it can be done."""
        self.words.settling.end_now()
        lesson, place = self._lesson, self._place
        if lesson is None:
            return
        count = len(lesson.steps)
        match what:
            case "undo" | "redo":
                self.undone.emit(what == "redo")
            case "up" | "down":
                self._order(*moved(count, place, -1 if what == "up" else 1))
            case "double":
                self._order(*doubled(count, place))
            case _:
                self._order(*removed(count, place))

    def _order(self, order: tuple[int, ...], place: int) -> None:
        lesson = self._lesson
        if lesson is None or order == tuple(range(len(lesson.steps))) or len(order) > MAX_STEPS:
            return
        # What comes next is about this one, also before the window has shown it.
        self._lesson, self._place = with_steps(lesson, order), place
        self.changed.emit(self._lesson, place)

    def _number(self) -> None:
        """Let every entry know which step it is: where it was before it is dragged."""
        for row in range(self.steps.count()):
            item: QListWidgetItem = self.steps.item(row)
            item.setData(Qt.ItemDataRole.UserRole, row)

    def _chose(self, row: int) -> None:
        if row >= 0 and row != self._place:
            self.chosen.emit(row)

    def _dropped(self) -> None:
        order = tuple(self.steps.item(row).data(Qt.ItemDataRole.UserRole) for row in range(self.steps.count()))
        if self._place in order:
            self._order(order, order.index(self._place))
            self._number()

    def _said(self, of_lesson: dict[str, str], of_step: dict[str, str]) -> None:
        """Take the words that were typed."""
        lesson = self._lesson
        if lesson is None:
            return
        steps = list(lesson.steps)
        steps[self._place] = with_words(steps[self._place], of_step)
        wanted = dataclasses.replace(lesson, steps=tuple(steps), **of_lesson)  # type: ignore[arg-type]
        if wanted != lesson:
            self._lesson = wanted
            self.changed.emit(wanted, self._place)


class WordFields(QScrollArea):
    """The words of a lesson and of a step, in fields.

    Parameters
    ----------
    said
        Called with the words of the lesson and of the step, by name, once nothing more is typed for a moment.
    """

    def __init__(self, said: Callable[[dict[str, str], dict[str, str]], None]) -> None:
        super().__init__()
        self.setObjectName("lessons-fields")
        self.setAccessibleName("Words of the lesson and of the step")
        self.setWidgetResizable(True)
        self._said = said
        self._shown: tuple[Any, ...] = ()
        self.settling = Settling(self, REST_MS, self._end)
        self.fields: dict[str, QLineEdit | QPlainTextEdit] = {}
        inner = QWidget()
        form = QFormLayout(inner)
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        for name, head, tip in OF_LESSON:
            self._add(form, name, head, tip, QLineEdit())
        for name, head, tip, is_long in OF_STEP:
            self._add(form, name, head, tip, QPlainTextEdit() if is_long else QLineEdit())
        self.fields["title"].setMaxLength(TITLE)  # type: ignore[union-attr]
        self.fields["summary"].setMaxLength(NOTE)  # type: ignore[union-attr]
        self.fields["sentence"].setMaxLength(SENTENCE)  # type: ignore[union-attr]
        self.setWidget(inner)

    def _add(self, form: QFormLayout, name: str, head: str, tip: str, field: QLineEdit | QPlainTextEdit) -> None:
        field.setObjectName(f"lessons-field-{name.replace('_', '-')}")
        field.setAccessibleName(head)
        set_tip(field, tip)
        if isinstance(field, QPlainTextEdit):
            field.setTabChangesFocus(True)
            field.setMinimumHeight(LINES * field.fontMetrics().lineSpacing() + 12)
        field.textChanged.connect(lambda *_: self.settling.start())
        label = Label(head)
        label.setBuddy(field)
        form.addRow(label, field)
        self.fields[name] = field

    def text(self, name: str) -> str:
        """Return what a field has."""
        field = self.fields[name]
        text = field.text() if isinstance(field, QLineEdit) else field.toPlainText()[:NOTE]
        # What comes from a clipboard may hold signs that no lesson holds.
        return "".join(sign if sign == "\n" or sign.isprintable() else " " for sign in text)

    def show_step(self, lesson: Lesson | None, step: LessonStep | None) -> None:
        """Fill the fields, but for those that have the words already."""
        wanted = dict.fromkeys(self.fields, "")
        if lesson is not None and step is not None:
            wanted = {name: getattr(lesson, name) for name, *_ in OF_LESSON}
            wanted |= {name: getattr(step, name) for name, *_ in OF_STEP}
        known = tuple(wanted.items())
        if known == self._shown:
            return
        self._shown = known
        for name, field in self.fields.items():
            if self.text(name) == wanted[name]:
                continue
            blocked = field.blockSignals(True)
            if isinstance(field, QLineEdit):
                field.setText(wanted[name])
            else:
                field.setPlainText(wanted[name])
            field.blockSignals(blocked)

    def _end(self) -> None:
        of_lesson = {name: self.text(name).strip() for name, *_ in OF_LESSON}
        of_step = {name: self.text(name).strip() for name, *_ in OF_STEP}
        # A lesson and a step are never without a name.
        before = dict(self._shown)
        of_lesson["title"] = of_lesson["title"] or before["title"]
        of_step["sentence"] = of_step["sentence"] or before["sentence"]
        answer = of_step["answer"] if of_step["question"] else ""
        # What the fields have is known: it is not written into them again while it is being typed.
        self._shown = tuple((of_lesson | of_step | {"answer": answer}).items())
        self._said(of_lesson, of_step)
