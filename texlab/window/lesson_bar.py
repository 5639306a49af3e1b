"""The line above the pictures while a lesson is given: where it is, the large sentence, readiness."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPoint, QRect, QSize, Qt
from PySide6.QtGui import QFont, QFontMetrics
from PySide6.QtWidgets import QSizePolicy, QToolButton, QWidget

from texlab.style.text_size import sentence_points
from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from PySide6.QtGui import QAction, QResizeEvent

    from texlab.state.lesson_scene import LessonScene

# A sentence that would take more of the window's height is no larger than other text.
MOST_SHARE = 0.2
SIDE, ABOVE, GAP = 8, 4, 6
FAR_DOWN = 2**16


class LessonBar(QWidget):
    """Back, N of M, next; the sentence; which steps are ready; leave.

    The sentence stands between the others, or has lines of its own below them where that is lower: large words
    need all the width.
    """

    def __init__(self, actions: Mapping[str, QAction]) -> None:
        super().__init__()
        self.setObjectName("lesson-bar")
        self.setAccessibleName("Lesson that is given")
        self.count = Label(name="lesson-count")
        self.sentence = Label(name="lesson-sentence", wraps=True)
        # A font of its own would be taken back by the style sheet, which gives it its size.
        self.sentence.setProperty("role", "sentence")
        self.sentence.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.readiness = Label(name="lesson-readiness", muted=True)
        for name, sign in (("lesson-back", "◀"), ("lesson-next", "▶"), ("lesson-leave", "✕")):
            # A tool button shows the icon's text; menus and the palette keep the whole name.
            actions[name].setIconText(sign)
        self._before = (_button(actions["lesson-back"]), self.count, _button(actions["lesson-next"]))
        self._after = (self.readiness, _button(actions["lesson-leave"]))
        for widget in (*self._before, self.sentence, *self._after):
            widget.setParent(self)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.hide()

    def show_lesson(self, lesson: LessonScene) -> None:
        """Show a step, or nothing when no lesson is given."""
        step = lesson.step
        self.setVisible(step is not None)
        if step is None or lesson.lesson is None:
            return
        count = len(lesson.lesson.steps)
        self.count.setText(f"{lesson.place + 1} of {count}")
        if step.sentence != self.sentence.text():
            self.sentence.setText(step.sentence)
            self._size_sentence()
        ready = sum(lesson.ready)
        self.readiness.setText("ready" if ready == count else f"{ready} of {count} ready")

    def sizeHint(self) -> QSize:
        """Return the room of all lines in the width that there is."""
        return self.minimumSizeHint()

    def minimumSizeHint(self) -> QSize:
        """Return the room of all lines in the width that there is, also where a tab takes what can be spared."""
        least = max(_width((*self._before, *self._after)), self.sentence.minimumSizeHint().width()) + 2 * SIDE
        return QSize(least, self.heightForWidth(max(least, self.width())))

    def hasHeightForWidth(self) -> bool:
        """Return True: narrow means more lines."""
        return True

    def heightForWidth(self, width: int) -> int:
        """Return the height of the lines at a width."""
        return min(self._heights(width - 2 * SIDE)) + 2 * ABOVE

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Ask for other room where there are other lines."""
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self._size_sentence()
            self.updateGeometry()
        self._place()

    def event(self, event: QEvent) -> bool:
        """Follow what is said, and the size of all text."""
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.LayoutRequest, QEvent.Type.Show):
            self._size_sentence()
            self.updateGeometry()
            self._place()
        return super().event(event)

    def _size_sentence(self) -> None:
        """Let the sentence be larger than other text where that leaves the pictures their room."""
        font = QFont(self.font())
        font.setPointSizeF(sentence_points(font.pointSizeF()))
        metrics = QFontMetrics(font)
        room = QRect(0, 0, self.width() - 2 * SIDE, FAR_DOWN)
        height = metrics.boundingRect(room, Qt.TextFlag.TextWordWrap, self.sentence.text()).height()
        # One line may be large anywhere.
        most = max(1.5 * metrics.lineSpacing(), MOST_SHARE * self.window().height())
        role = "sentence" if height <= most else "long-sentence"
        if role != self.sentence.property("role"):
            self.sentence.setProperty("role", role)
            self.sentence.style().unpolish(self.sentence)
            self.sentence.style().polish(self.sentence)

    def _place(self) -> None:
        """Place the parts: the sentence between the others, or below them where that takes less height."""
        area = self.rect().adjusted(SIDE, ABOVE, -SIDE, -ABOVE)
        beside, below = self._heights(area.width())
        height = self._line if below < beside else area.height()
        for widgets, left in ((self._before, area.left()), (self._after, area.right() + 1 - _width(self._after))):
            at = left
            for widget in widgets:
                size = widget.sizeHint()
                widget.setGeometry(QRect(QPoint(at, area.top() + (height - size.height()) // 2), size))
                at += size.width() + GAP
        if below < beside:
            self.sentence.setGeometry(area.adjusted(0, height, 0, 0))
        else:
            self.sentence.setGeometry(area.adjusted(_width(self._before) + GAP, 0, -_width(self._after) - GAP, 0))

    @property
    def _line(self) -> int:
        return max(widget.sizeHint().height() for widget in (*self._before, *self._after))

    def _heights(self, width: int) -> tuple[int, int]:
        """Return the height in this width with the sentence between the other parts, and below them."""
        between = width - _width(self._before) - _width(self._after) - 2 * GAP
        below = self._line + self.sentence.heightForWidth(max(width, 1))
        if between < self.sentence.minimumSizeHint().width():
            return below + 1, below
        return max(self._line, self.sentence.heightForWidth(between)), below


def _width(widgets: Sequence[QWidget]) -> int:
    return sum(widget.sizeHint().width() for widget in widgets) + GAP * (len(widgets) - 1)


def _button(action: QAction) -> QToolButton:
    button = QToolButton()
    button.setDefaultAction(action)
    button.setAutoRaise(True)
    button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    button.setAccessibleName(action.toolTip())
    return button
