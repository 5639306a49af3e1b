"""The tool bar: the commands that are used most, seed and size."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QMenu, QSizePolicy, QToolBar, QToolButton, QWidget

from texlab.widgets.number_box import WholeBox
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.job import MAX_SEED

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtGui import QAction

MAX_SIDE = 4096
LAYOUTS = ("explore", "teach", "tune")
SHORT = {
    "open": "Open", "dice": "⚄", "tile": "Tile 2×2", "run-all": "Run all", "stop-all": "Stop",
    "export": "Save", "add": "+ Column", "undo": "↶", "redo": "↷", "help": "?",
}  # fmt: skip


class ToolBar(QToolBar):
    """Shows commands by their short names.

    ``seed_turned(seed)`` and ``size_turned((height, width))`` when the user changes what is in the boxes.
    """

    seed_turned = Signal(int)
    size_turned = Signal(object)

    def __init__(self, actions: Mapping[str, QAction]) -> None:
        super().__init__("Tools")
        self.setObjectName("toolbar")
        self.setMovable(False)
        self.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
        for name, text in SHORT.items():
            actions[name].setIconText(text)
        tip = "Seed of all columns: the same seed and parameters make the same bits"
        self.seed_box = _box("Seed", 0, MAX_SEED, 1, tip)
        self.width_box, self.height_box = (
            _box(name, 8, MAX_SIDE, 256, f"{name} of the results, in pixels") for name in ("Width", "Height")
        )
        for box in (self.width_box, self.height_box):
            box.setSingleStep(32)
            box.valueChanged.connect(lambda _: self.size_turned.emit(self.size_shown))
        self.seed_box.valueChanged.connect(self.seed_turned)
        self.addActions([actions["open"], actions["export"]])
        self.addSeparator()
        self.addActions([actions["undo"], actions["redo"]])
        self.addSeparator()
        self.addWidget(Label("Seed "))
        self.addWidget(self.seed_box)
        self.addAction(actions["dice"])
        self.addSeparator()
        self.addWidget(Label("Size "))
        self.addWidget(self.width_box)
        self.addWidget(Label(" × "))
        self.addWidget(self.height_box)
        self.addSeparator()
        self.addActions([actions[name] for name in ("tile", "add", "run-all", "stop-all")])
        spring = QWidget()
        spring.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.addWidget(spring)
        self.layout_menu = QMenu(self)
        self.layout_menu.addActions([actions[f"layout-{name}"] for name in LAYOUTS])
        self.layout_menu.addSeparator()
        self.layout_menu.addAction(actions["own-layouts"])
        self.addWidget(_layout_button(self.layout_menu))
        self.addAction(actions["help"])
        for action in self.actions():
            button = self.widgetForAction(action)
            if isinstance(button, QToolButton):
                button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
                # What is written on it may be a sign.
                button.setAccessibleName(action.text().replace("&", "").removesuffix(" ...") or button.text())

    @property
    def size_shown(self) -> tuple[int, int]:
        """Height and width in the boxes."""
        return self.height_box.value(), self.width_box.value()

    def show_values(self, seed: int, size: tuple[int, int]) -> None:
        """Show seed and size (height, width) without telling anyone."""
        for box, value in ((self.seed_box, seed), (self.height_box, size[0]), (self.width_box, size[1])):
            with QSignalBlocker(box):
                box.setValue(value)


def _box(name: str, low: int, high: int, value: int, tip: str) -> WholeBox:
    box = WholeBox()
    box.setObjectName(f"{name.lower()}-box")
    box.setAccessibleName(name)
    box.setRange(low, high)
    set_tip(box, tip)
    box.setValue(value)
    return box


def _layout_button(menu: QMenu) -> QToolButton:
    button = QToolButton()
    button.setObjectName("layout-button")
    button.setText("Layout")
    set_tip(button, "Arrange the panels for exploring, teaching or tuning")
    button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
    button.setMenu(menu)
    return button
