"""The zoom of linked panes in percent: shown, and typed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QAbstractSpinBox

from texlab.widgets.number_box import NumberBox
from texlab.widgets.once import Once
from texlab.widgets.plain import set_tip

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

    from texlab.widgets.view_link import ViewLink

UNKNOWN = "\u2013"
LOWEST, HIGHEST = 1.0, 6400.0


class ZoomBox(NumberBox):
    """Shows and sets how many pixels of the screen a hundred pixels of the pictures of a link take."""

    def __init__(self, name: str, label: str, tip: str, link: ViewLink, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        set_tip(self, tip)
        self.setRange(LOWEST, HIGHEST)
        self.setDecimals(0)
        self.setSuffix(" %")
        self.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.NoButtons)
        self.setStepType(QAbstractSpinBox.StepType.AdaptiveDecimalStepType)
        # Nothing is said as long as there is no picture.
        self.setSpecialValueText(UNKNOWN)
        self.setEnabled(False)
        self._link = link
        # Panes tell of every step of a drag; one look a turn is enough.
        self._look = Once(self, 0, self._show)
        link.rescaled = self._look.start
        self.valueChanged.connect(link.set_percent)

    def _show(self) -> None:
        percent = self._link.percent
        if percent is not None and not self.isEnabled():
            self.setSpecialValueText("")
            self.setEnabled(True)
        if percent is not None and not self.lineEdit().isModified():
            with QSignalBlocker(self):
                self.setValue(percent)
