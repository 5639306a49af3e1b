"""Asks how large a tab's picture is to be."""

from __future__ import annotations

from PySide6.QtWidgets import QDialog, QDialogButtonBox, QFormLayout, QVBoxLayout, QWidget

from texlab.widgets.number_box import WholeBox
from texlab.widgets.plain import Label, set_tip

SMALLEST, LARGEST = 64, 7680
USUAL = 1920


class SizeDialog(QDialog):
    """Width in pixels; the height follows what is shown."""

    def __init__(self, title: str, width: int, height: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("tab-picture-dialog")
        self.setWindowTitle(f"Save the picture of {title}")
        self._aspect = height / max(width, 1)
        self.box = WholeBox()
        self.box.setObjectName("tab-picture-width")
        self.box.setAccessibleName("Width")
        set_tip(self.box, "Width of the picture; letters and lines are drawn at this size")
        self.box.setRange(SMALLEST, LARGEST)
        self.box.setSuffix(" px")
        self.high = Label("")
        form = QFormLayout()
        form.addRow("Width", self.box)
        form.addRow("Height", self.high)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Save | QDialogButtonBox.StandardButton.Cancel)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        layout.addWidget(buttons)
        self.box.valueChanged.connect(self._follow)
        self.box.setValue(USUAL)

    @property
    def width_chosen(self) -> int:
        """In pixels."""
        return self.box.value()

    def _follow(self, width: int) -> None:
        self.high.setText(f"{max(round(width * self._aspect), 1)} px")
