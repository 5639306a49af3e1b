"""Asks for the name of a preset, and says at once what is wrong with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLineEdit,
    QPlainTextEdit,
    QWidget,
)

from texlab.widgets.plain import Label, set_tip
from texlab_core.documents.presets import MAX_NAME, MAX_NOTE, PresetError, check_name

if TYPE_CHECKING:
    from collections.abc import Collection


class PresetDialog(QDialog):
    """Asks for a name; for a new preset also for a note, and how much of the parameters it holds.

    ``chosen(name, note, is_partial)`` when it is accepted.

    Parameters
    ----------
    title
        Of the window.
    name
        To begin with.
    taken
        Names that the user's presets of the method have.
    note
        To begin with.
    is_new
        A new preset may replace one of the same name; a renamed one may not.
    """

    chosen = Signal(str, str, bool)

    def __init__(
        self,
        title: str,
        name: str,
        taken: Collection[str],
        *,
        is_new: bool,
        note: str = "",
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("preset-dialog")
        self.setWindowTitle(title)
        self._taken = {each.casefold() for each in taken}
        self._first = name
        self._is_new = is_new
        self.name = QLineEdit(name)
        self.name.setMaxLength(2 * MAX_NAME)
        self.name.selectAll()
        self.note = QPlainTextEdit(note)
        self.note.setTabChangesFocus(True)
        self.note.setFixedHeight(4 * self.fontMetrics().lineSpacing())
        self.partial = QCheckBox("Only the parameters that differ from the defaults")
        self.message = Label(name="preset-dialog-message", muted=True, wraps=True)
        self.message.setMinimumHeight(2 * self.fontMetrics().lineSpacing())
        standard = QDialogButtonBox.StandardButton
        self.buttons = QDialogButtonBox(standard.Ok | standard.Cancel)
        self.ok = self.buttons.button(standard.Ok)
        for widget, part, label, tip in (
            (self.name, "name", "Name of the preset", f"1 to {MAX_NAME} characters without slashes"),
            (self.note, "note", "Note", "What the preset is good for"),
            (
                self.partial,
                "partial",
                "Only what differs",
                "Taking the preset leaves all other parameters as they are",
            ),
        ):
            widget.setObjectName(f"preset-dialog-{part}")
            widget.setAccessibleName(label)
            set_tip(widget, tip)
        layout = QFormLayout(self)
        layout.addRow("Name", self.name)
        if is_new:
            layout.addRow("Note", self.note)
            layout.addRow(self.partial)
        layout.addRow(self.message)
        layout.addRow(self.buttons)
        self.setMinimumWidth(360)
        self.name.textChanged.connect(self._check)
        self.note.textChanged.connect(self._check)
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        self.accepted.connect(
            lambda: self.chosen.emit(self.name.text(), self.note.toPlainText(), self.partial.isChecked())
        )
        self.finished.connect(self.deleteLater)
        self._check()

    def _check(self) -> None:
        name = self.name.text()
        is_taken = name.casefold() in self._taken and (self._is_new or name.casefold() != self._first.casefold())
        sentence = ""
        try:
            check_name(name)
        except PresetError as error:
            # Nobody has done anything wrong while nothing is written yet.
            sentence = str(error) if name else ""
            is_good = False
        else:
            is_good = self._is_new or not (is_taken or name == self._first)
        if is_taken:
            sentence = f"There is a preset called {name}" + (
                "; it will be replaced." if self._is_new else " already."
            )
        if len(self.note.toPlainText()) > MAX_NOTE:
            is_good, sentence = False, f"The note may have {MAX_NOTE} characters."
        self.ok.setEnabled(is_good)
        self.ok.setText("Replace" if is_taken and self._is_new else "OK")
        self.message.setText(sentence)
