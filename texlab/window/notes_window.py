"""The presenter's own window: notes of the step, what comes next, controls, clock."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QElapsedTimer, QSize, Qt, QTime, QTimer
from PySide6.QtWidgets import (
    QApplication,
    QHBoxLayout,
    QScrollArea,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from texlab.style.numbers import clock_text
from texlab.style.text_size import follow_text
from texlab.widgets.flow_layout import FlowLayout
from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtGui import QAction, QCloseEvent, QHideEvent, QScreen, QShowEvent

    from texlab.state.lesson_scene import LessonScene

TICK_MS = 1000
SIZE = QSize(760, 620)
SENTENCE_FACTOR = 1.4
# The controls, in their order; their keys work in this window too.
CONTROLS = (
    "lesson-back",
    "lesson-next",
    "previous-tab",
    "next-tab",
    "halo",
    "spotlight",
    "ink",
    "ink-undo",
    "ink-clear",
    "full-screen",
    "lesson-leave",
)
HEADS = {"note": "Note", "question": "Question", "answer": "Answer", "try_this": "Try"}


class NotesWindow(QWidget):
    """Shows what the audience does not see; the audience's window goes on under it.

    Parameters
    ----------
    actions
        The commands of the window, by name.
    audience
        The window that the audience looks at.
    points
        Size of its text, whatever the audience's has.
    """

    def __init__(self, actions: Mapping[str, QAction], audience: QWidget, points: float) -> None:
        super().__init__()
        own = self.font()
        own.setPointSizeF(points)
        self.setFont(own)
        self.setObjectName("notes-window")
        self.setWindowTitle("Presenter - TexLab")
        self._audience = audience
        self._action = actions["notes"]
        self._lesson = ""
        self._since = QElapsedTimer()
        self._tick = QTimer(self)
        self._tick.setInterval(TICK_MS)
        self._tick.timeout.connect(self._show_time)
        self.place, self.readiness = _label("notes-place", "heading"), _label("notes-readiness", "muted")
        self.clock = _label("notes-clock", "heading")
        self.sentence = _label("notes-sentence", "")
        self.next = _label("notes-next", "muted")
        self.words = {name: _label(f"notes-{name}", "") for name in HEADS}
        head = QHBoxLayout()
        head.addWidget(self.place, 1)
        head.addWidget(self.readiness)
        head.addWidget(self.clock)
        inner = QWidget()
        column = QVBoxLayout(inner)
        for each in self.words.values():
            column.addWidget(each)
        column.addStretch(1)
        scroll = QScrollArea()
        scroll.setObjectName("notes-words")
        scroll.setAccessibleName("Notes of the step")
        scroll.setWidgetResizable(True)
        scroll.setWidget(inner)
        bar = QWidget()
        line = FlowLayout(bar)
        for name in CONTROLS:
            button = QToolButton()
            button.setDefaultAction(actions[name])
            button.setText(actions[name].text().replace("&", ""))
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
            button.setAccessibleName(actions[name].statusTip())
            button.setObjectName(f"notes-{name}")
            line.addWidget(button)
            self.addAction(actions[name])
        self.addAction(self._action)
        layout = QVBoxLayout(self)
        layout.addLayout(head)
        layout.addWidget(self.sentence)
        layout.addWidget(scroll, 1)
        layout.addWidget(self.next)
        layout.addWidget(bar)
        # A style sheet keeps them from taking the font of the window.
        for part in self.findChildren(QWidget):
            size = points * SENTENCE_FACTOR if part is self.sentence else points
            follow_text(part, partial(_keep_size, part, size))
        self.resize(SIZE)

    def show_lesson(self, lesson: LessonScene) -> None:
        """Show a step with its notes, or say that no lesson is given."""
        step = lesson.step
        if lesson.name != self._lesson:
            self._lesson = lesson.name
            self._since.start()
        if step is None or lesson.lesson is None:
            self.place.setText("No lesson is given")
            self.sentence.setText("Open one from the tab Lessons (Ctrl+L).")
            for label in (self.readiness, self.next, *self.words.values()):
                label.setText("")
                label.hide()
            return
        steps, place = lesson.lesson.steps, lesson.place
        self.place.setText(f"{lesson.lesson.title}: {place + 1} of {len(steps)}")
        ready = sum(lesson.ready)
        self.readiness.setText("all ready" if ready == len(steps) else f"{ready} of {len(steps)} ready")
        self.sentence.setText(step.sentence)
        for name, label in self.words.items():
            text = getattr(step, name)
            label.setText(f"{HEADS[name]}: {text}")
            label.setVisible(bool(text))
        if place + 1 < len(steps):
            state = "" if lesson.ready[place + 1 : place + 2] == (True,) else " (being computed)"
            self.next.setText(f"Next{state}: {steps[place + 1].sentence}")
        else:
            self.next.setText("This is the last step.")
        for label in (self.readiness, self.next):
            label.show()

    def set_open(self, wanted: bool) -> None:
        """Show it, on another screen than the audience's where there is one; or close it."""
        if not wanted:
            self.hide()
        elif not self.isVisible():
            screen = self.other_screen()
            if screen is not None:
                room = screen.availableGeometry()
                self.move(room.center() - self.rect().center())
            self.show()
            # Keys go on to the audience's window until this one is clicked.
            self._audience.activateWindow()

    def other_screen(self) -> QScreen | None:
        """Return a screen that the audience does not see; None when there is one screen, or all show the same."""
        theirs = self._audience.screen()
        return next(
            (each for each in QApplication.screens() if not each.geometry().intersects(theirs.geometry())), None
        )

    def _show_time(self) -> None:
        now = QTime.currentTime().toString("HH:mm")
        given = clock_text(self._since.elapsed() // 1000) if self._lesson else ""
        self.clock.setText(f"{now}   {given}".rstrip())

    def showEvent(self, event: QShowEvent) -> None:
        """Let the clock go."""
        super().showEvent(event)
        self._show_time()
        self._tick.start()
        self._action.setChecked(True)

    def hideEvent(self, event: QHideEvent) -> None:
        """Stop the clock."""
        super().hideEvent(event)
        self._tick.stop()
        self._action.setChecked(False)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Close it: the audience's window stays."""
        super().closeEvent(event)
        self._action.setChecked(False)


def _keep_size(part: QWidget, points: float) -> None:
    font = part.font()
    if font.pointSizeF() != points:
        font.setPointSizeF(points)
        part.setFont(font)


def _label(name: str, role: str) -> Label:
    label = Label(name=name)
    label.setProperty("role", role)
    label.setWordWrap(True)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    label.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Minimum)
    return label
