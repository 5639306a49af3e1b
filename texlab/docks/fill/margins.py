"""A button with four margins by which a picture grows."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFormLayout, QMenu, QPushButton, QToolButton, QWidget, QWidgetAction

from texlab.widgets.number_box import WholeBox

SIDES = ("Left", "Top", "Right", "Bottom")
MOST = 4096


class MarginsButton(QToolButton):
    """Opens the four numbers; ``grow_wanted((left, top, right, bottom))`` when any is above 0."""

    grow_wanted = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.setText("Grow by margins ...")
        self.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        panel = QWidget()
        form = QFormLayout(panel)
        self.boxes: list[WholeBox] = []
        for side in SIDES:
            box = WholeBox()
            box.setObjectName(f"fill-margin-{side.lower()}")
            box.setAccessibleName(f"{side} margin")
            box.setRange(0, MOST)
            box.setSuffix(" px")
            box.setSingleStep(16)
            box.valueChanged.connect(self._changed)
            form.addRow(side, box)
            self.boxes.append(box)
        self.button = QPushButton("Grow")
        self.button.setObjectName("fill-margins-grow")
        self.button.setEnabled(False)
        self.button.clicked.connect(self._grow)
        form.addRow(self.button)
        menu = QMenu(self)
        menu.setObjectName("fill-margins-menu")
        action = QWidgetAction(menu)
        action.setDefaultWidget(panel)
        menu.addAction(action)
        self.setMenu(menu)

    def _changed(self, *_: object) -> None:
        self.button.setEnabled(any(box.value() for box in self.boxes))

    def _grow(self) -> None:
        self.menu().close()
        self.grow_wanted.emit(tuple(box.value() for box in self.boxes))
