"""The line above the pictures while a lesson is given: where it is, the large sentence, readiness."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QToolButton, QWidget

from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtGui import QAction, QResizeEvent

    from texlab.state.lesson_scene import LessonScene


class LessonBar(QWidget):
    """Back, N of M, next; the sentence; which steps are ready; leave."""

    def __init__(self, actions: Mapping[str, QAction]) -> None:
        super().__init__()
        self.setObjectName("lesson-bar")
        self.setAccessibleName("Lesson that is given")
        self.count = Label(name="lesson-count")
        self.sentence = _Sentence(name="lesson-sentence")
        # A font of its own would be taken back by the style sheet, which gives it its size.
        self.sentence.setProperty("role", "sentence")
        self.sentence.setWordWrap(True)
        self.sentence.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.sentence.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.readiness = Label(name="lesson-readiness", muted=True)
        for name, sign in (("lesson-back", "◀"), ("lesson-next", "▶"), ("lesson-leave", "✕")):
            # A tool button shows the icon's text; menus and the palette keep the whole name.
            actions[name].setIconText(sign)
        line = QHBoxLayout(self)
        line.setContentsMargins(8, 4, 8, 4)
        line.addWidget(_button(actions["lesson-back"]))
        line.addWidget(self.count)
        line.addWidget(_button(actions["lesson-next"]))
        line.addWidget(self.sentence, 1)
        line.addWidget(self.readiness)
        line.addWidget(_button(actions["lesson-leave"]))
        self.hide()

    def show_lesson(self, lesson: LessonScene) -> None:
        """Show a step, or nothing when no lesson is given."""
        step = lesson.step
        self.setVisible(step is not None)
        if step is None or lesson.lesson is None:
            return
        count = len(lesson.lesson.steps)
        self.count.setText(f"{lesson.place + 1} of {count}")
        self.sentence.setText(step.sentence)
        ready = sum(lesson.ready)
        self.readiness.setText("ready" if ready == count else f"{ready} of {count} ready")


class _Sentence(Label):
    """Has the lines that it needs, also where a tab takes all the room that can be spared."""

    def minimumSizeHint(self) -> QSize:
        """Return the height of all lines in the width that there is."""
        least = super().minimumSizeHint()
        return QSize(least.width(), max(least.height(), self.heightForWidth(self.width())))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Ask for other room where there are other lines."""
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self.updateGeometry()


def _button(action: QAction) -> QToolButton:
    button = QToolButton()
    button.setDefaultAction(action)
    button.setAutoRaise(True)
    button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    button.setAccessibleName(action.toolTip())
    return button
