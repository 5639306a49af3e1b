"""The pop-out test in the window: what is tested, the pictures one after the other, and what came of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QProgressBar,
    QPushButton,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from texlab.widgets.hidden_picture import HiddenPicture
from texlab.widgets.once import Once
from texlab.widgets.plain import Label, set_tip
from texlab.window.popout_review import PopoutReview
from texlab.window.popout_setup import WIDEST, PopoutSetup, action_button
from texlab_core.popout.scoring import Answer

if TYPE_CHECKING:
    from PySide6.QtGui import QKeyEvent

    from texlab.style.theme import Theme
    from texlab_core.popout.making import Made
    from texlab_core.popout.record import Record

# The same for every picture: it tells nothing, and the eye forgets the picture before.
PAUSE_MS = 500
_STEPS = 1000
HOW = (
    "In every picture lies a piece of the original. Click where you see it, as soon as you see it: hits, misses"
    " and times are kept, and nothing is told before the end.\n\nSpace: you cannot tell. Arrow keys move a cross,"
    " Enter answers there. Esc leaves the test; what was answered stays."
)


class PopoutDialog(QDialog):
    """Asks what to test, shows the pictures, and what came of it; it computes and writes nothing.

    ``asked(PopoutRequest)`` to begin, ``edited(PopoutRequest)`` when a field changes, ``stopped()`` while pictures
    are made, ``answered(Answer)`` for every picture, ``over()`` after the last one or when it is left,
    ``table_wanted(all)`` for the table of this test or of all.
    """

    asked = Signal(object)
    edited = Signal(object)
    stopped = Signal()
    answered = Signal(object)
    over = Signal()
    table_wanted = Signal(bool)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("popout-dialog")
        self.setWindowTitle("Pop-out test")
        self._made: Made | None = None
        self._place = 0
        self._pause = Once(self, PAUSE_MS, self._show_picture)
        self.pages = QStackedWidget()
        self.pages.setObjectName("popout-pages")
        self.setup = PopoutSetup()
        self.setup.asked.connect(self.asked)
        self.setup.edited.connect(self.edited)
        self.setup.table_wanted.connect(self.table_wanted)
        self.setup.closed.connect(self.close)
        self.fields = _centred(self.setup)
        self.making, self.ready = self._make_making(), self._make_ready()
        self.trial, self.outcome = self._make_trial(), self._make_result()
        for page in (self.fields, self.making, self.ready, self.trial, self.outcome):
            self.pages.addWidget(page)
        layout = QVBoxLayout(self)
        layout.addWidget(self.pages)

    # Pages.

    def _make_making(self) -> QWidget:
        page = QWidget()
        page.setMaximumWidth(WIDEST)
        layout = QVBoxLayout(page)
        words = Label(
            "All pictures are made before the first is shown: how long one takes would tell its method.",
            name="popout-making",
            wraps=True,
        )
        self.bar = QProgressBar()
        self.bar.setObjectName("popout-bar")
        self.bar.setAccessibleName("Progress")
        self.bar.setRange(0, _STEPS)
        self.stop_button = QPushButton("Stop")
        self.stop_button.setObjectName("popout-stop")
        self.stop_button.setAutoDefault(False)
        self.stop_button.clicked.connect(lambda _=False: self.stopped.emit())
        for widget in (words, self.bar, self.stop_button):
            layout.addWidget(widget)
        return _centred(page)

    def _make_ready(self) -> QWidget:
        page = QWidget()
        page.setMaximumWidth(WIDEST)
        layout = QVBoxLayout(page)
        self.how = Label(name="popout-how", wraps=True)
        self.begin_button = QPushButton("Begin")
        self.begin_button.setObjectName("popout-begin")
        self.begin_button.clicked.connect(lambda _=False: self._begin())
        layout.addWidget(self.how)
        layout.addWidget(self.begin_button)
        return _centred(page)

    def _make_trial(self) -> QWidget:
        page = QWidget()
        layout = QVBoxLayout(page)
        layout.setContentsMargins(0, 0, 0, 0)
        self.stage = HiddenPicture()
        self.stage.pointed.connect(lambda row, column, seconds: self._take(row, column, seconds))
        self.stage.gave_up.connect(lambda seconds: self._take(None, None, seconds))
        self.count = Label(name="popout-count")
        self.untold_button = QPushButton("I cannot tell (Space)")
        self.untold_button.setObjectName("popout-untold")
        self.untold_button.setAutoDefault(False)
        # The keyboard stays with the picture.
        self.untold_button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.untold_button.clicked.connect(lambda _=False: self.stage.give_up())
        self.leave_button = QPushButton("Leave (Esc)")
        self.leave_button.setObjectName("popout-leave")
        self.leave_button.setAutoDefault(False)
        self.leave_button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.leave_button.clicked.connect(lambda _=False: self._leave())
        line = QHBoxLayout()
        line.addWidget(self.count, 1)
        line.addWidget(self.untold_button)
        line.addWidget(self.leave_button)
        layout.addWidget(self.stage, 1)
        layout.addLayout(line)
        return page

    def _make_result(self) -> QWidget:
        page = QWidget()
        layout = QVBoxLayout(page)
        layout.setContentsMargins(0, 0, 0, 0)
        self.review = PopoutReview()
        self.message = Label(name="popout-message", wraps=True)
        buttons = QDialogButtonBox()
        self.table_button = action_button(buttons, "Export CSV ...", "popout-export")
        set_tip(self.table_button, "Write every picture of this test with its answer")
        self.table_button.clicked.connect(lambda _=False: self.table_wanted.emit(False))
        self.again_button = action_button(buttons, "Another test", "popout-again")
        self.again_button.clicked.connect(lambda _=False: self.show_setup())
        close = action_button(buttons, "Close", "popout-result-close")
        close.clicked.connect(lambda _=False: self.close())
        layout.addWidget(self.review, 1)
        layout.addWidget(self.message)
        layout.addWidget(buttons)
        return page

    def set_theme(self, theme: Theme) -> None:
        """Give the pictures of the review their colours."""
        self.review.picture.set_theme(theme)

    # What is shown.

    @property
    def resting(self) -> bool:
        """Whether no test is being made or given."""
        return self.pages.currentWidget() in (self.fields, self.outcome)

    def show_setup(self, sentence: str = "") -> None:
        """Go back to the fields, and let the pictures go; a sentence says why."""
        self._made = None
        self.review.clear()
        self.pages.setCurrentWidget(self.fields)
        self.setup.edit()
        if sentence:
            self.setup.foreseen.setText(sentence)

    def show_making(self) -> None:
        """Show that the pictures are made."""
        self.bar.setValue(0)
        self.pages.setCurrentWidget(self.making)

    def show_progress(self, share: float) -> None:
        """Show how far it is, 0 to 1."""
        self.bar.setValue(int(share * _STEPS))

    def show_test(self, made: Made) -> None:
        """Explain the test; the pictures come when the viewer begins."""
        self._made, self._place = made, 0
        self.message.setText("")
        count = len(made.pictures)
        self.how.setText(f"{count} {'picture' if count == 1 else 'pictures'}. {HOW}")
        self.pages.setCurrentWidget(self.ready)
        self.begin_button.setFocus()

    def show_scores(self, record: Record) -> None:
        """Show what came of the test."""
        self.review.show_record(record, () if self._made is None else self._made.pictures)
        self.pages.setCurrentWidget(self.outcome)
        self.review.list.setFocus()

    def say(self, sentence: str) -> None:
        """Say a sentence below the scores; while pictures are shown it waits there."""
        self.message.setText(sentence)

    # The pictures.

    def _begin(self) -> None:
        self.pages.setCurrentWidget(self.trial)
        self.stage.setFocus()
        self._next()

    def _next(self) -> None:
        assert self._made is not None
        self.stage.show_picture(None)
        self.untold_button.setEnabled(False)
        self.count.setText(f"{self._place + 1} of {len(self._made.pictures)}")
        self._pause.start()

    def _show_picture(self) -> None:
        if self._made is None or self.pages.currentWidget() is not self.trial:
            return
        self.untold_button.setEnabled(True)
        self.stage.show_picture(self._made.pictures[self._place])

    def _take(self, row: int | None, column: int | None, seconds: float) -> None:
        assert self._made is not None
        trial = self._made.record.trials[self._place]
        self.answered.emit(Answer(trial.number, row, column, seconds))
        self._place += 1
        if self._place < len(self._made.pictures):
            self._next()
        else:
            self.over.emit()

    def _leave(self) -> None:
        self._pause.stop()
        self.stage.show_picture(None)
        self.over.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Let Esc leave what is shown: the test first, then the window."""
        if event.key() == Qt.Key.Key_Escape and self.pages.currentWidget() is self.trial:
            self._leave()
        elif event.key() == Qt.Key.Key_Escape and self.pages.currentWidget() is self.making:
            self.stopped.emit()
        else:
            super().keyPressEvent(event)

    def reject(self) -> None:
        """Close, however it is asked for: stop the making, and leave a test that is given."""
        page = self.pages.currentWidget()
        if page is self.making:
            self.stopped.emit()
        elif page is self.trial:
            self._leave()
        elif page is self.ready:
            self.show_setup()
        super().reject()


def _centred(inside: QWidget) -> QWidget:
    page = QWidget()
    layout = QVBoxLayout(page)
    line = QHBoxLayout()
    line.addStretch(1)
    line.addWidget(inside, 100)
    line.addStretch(1)
    layout.addStretch(1)
    layout.addLayout(line)
    layout.addStretch(1)
    return page
