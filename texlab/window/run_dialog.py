"""What dialogs that ask for long work share: fields, how far it is, buttons; and the thread that does the work."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHBoxLayout,
    QProgressBar,
    QPushButton,
)

from texlab.runs.worker import Worker
from texlab.widgets.plain import Label, set_tip

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtWidgets import QLineEdit, QWidget

    from texlab.runs.worker import Request
    from texlab.window.main_window import MainWindow

# Processes end at their next step; one that loads or compiles takes longer.
PATIENCE_S = 30.0
_STEPS = 1000


class RunDialog(QDialog):
    """Asks what to do, and shows how far it is: ``asked(request)`` to begin, ``stopped()`` to stop.

    Parameters
    ----------
    name
        With which the names of its widgets begin.
    title
        Of the dialog.
    begun
        What is said when the work has begun.
    width
        Of the line that says how far it is, in pixels.
    """

    asked = Signal(object)
    stopped = Signal()

    def __init__(self, name: str, title: str, begun: str, width: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(f"{name}-dialog")
        self.setWindowTitle(title)
        self._name = name
        self._begun = begun
        self._running = False
        self.form = QFormLayout(self)
        self.bar = QProgressBar()
        self.bar.setObjectName(f"{name}-bar")
        self.bar.setAccessibleName("Progress")
        self.bar.setRange(0, _STEPS)
        self.message = Label(name=f"{name}-message", wraps=True)
        self.message.setMinimumSize(width, 2 * self.fontMetrics().lineSpacing())

    def add_row(
        self, label: str, widget: QWidget, name: str, tip: str, ask: Callable[[], None] | None = None
    ) -> None:
        """Add a field, with a button beside it that asks for what goes into it."""
        widget.setObjectName(f"{self._name}-{name}")
        widget.setAccessibleName(label)
        set_tip(widget, tip)
        if ask is None:
            self.form.addRow(label, widget)
            return
        button = QPushButton("Choose ...")
        button.setObjectName(f"{self._name}-{name}-choose")
        button.setAutoDefault(False)
        button.clicked.connect(lambda: ask())
        line = QHBoxLayout()
        line.addWidget(widget, 1)
        line.addWidget(button)
        self.form.addRow(label, line)

    def add_end(self, run: str, *more: tuple[str, str, Callable[[], object]]) -> list[QPushButton]:
        """Add how far it is and the buttons; those of ``more`` (text, name, what it does) are returned."""
        self.form.addRow(self.bar)
        self.form.addRow(self.message)
        box = QDialogButtonBox()
        self.run_button = self._button(box, run, "run", lambda: self.asked.emit(self.request()))
        self.stop_button = self._button(box, "Stop", "stop", self.stopped.emit)
        buttons = [self._button(box, *each) for each in more]
        self.close_button = self._button(box, "Close", "close", self.close)
        self.form.addRow(box)
        return buttons

    def _button(self, box: QDialogButtonBox, text: str, name: str, call: Callable[[], object]) -> QPushButton:
        button = box.addButton(text, QDialogButtonBox.ButtonRole.ActionRole)
        button.setObjectName(f"{self._name}-{name}")
        button.setAutoDefault(False)
        button.clicked.connect(lambda: call())
        return button

    def request(self) -> object:
        """Return what the fields say."""
        raise NotImplementedError

    def show_idle(self, sentence: str) -> None:
        """Show that nothing runs, and why not, or what came of it."""
        self._running = False
        self.message.setText(sentence)
        self._check()

    def show_running(self) -> None:
        """Show that it has begun."""
        self._running = True
        self.bar.setValue(0)
        self.message.setText(self._begun)
        self._check()

    def show_share(self, share: float) -> None:
        """Show how far it is, 0 to 1."""
        self.bar.setValue(int(share * _STEPS))

    def _check(self) -> None:
        """Enable what can be pressed now."""
        self.stop_button.setEnabled(self._running)


def with_text(line: QLineEdit, text: str) -> None:
    """Put what was chosen into a field; nothing where nothing was."""
    if text:
        line.setText(text)


class RunDesk:
    """Shows a dialog (made when it is first wanted), and does what it asks for in a thread, one at a time.

    Parameters
    ----------
    name
        Of the thread.
    stopped
        What is said when it was stopped.
    """

    dialog: RunDialog | None = None

    def __init__(self, window: MainWindow, name: str, stopped: str) -> None:
        self._window = window
        self._stopped = stopped
        self._worker = Worker(name, parent=window)

    @property
    def busy(self) -> bool:
        """Whether anything runs."""
        return self._worker.busy

    def close(self) -> None:
        """Stop what runs, and wait for its end."""
        self._worker.close(PATIENCE_S)
        if self.dialog is not None:
            self.dialog.close()

    def _show(self, dialog: RunDialog) -> None:
        dialog.show()
        dialog.raise_()

    def _connect(self, dialog: RunDialog, progressed: Callable[..., None], finished: Callable[..., None]) -> None:
        """Let a new dialog show what runs, and stop it."""
        self._worker.progressed.connect(progressed)
        self._worker.finished.connect(finished)
        self._worker.failed.connect(dialog.show_idle)
        self._worker.cancelled.connect(partial(dialog.show_idle, self._stopped))
        dialog.stopped.connect(self._worker.cancel)

    def _submit(self, dialog: RunDialog, request: Request) -> None:
        dialog.show_running()
        self._worker.submit(request)
