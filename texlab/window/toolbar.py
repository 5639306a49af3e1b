"""The tool bar: the commands that are used most, seed and size; what runs and stops stands apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, QSize, Qt, Signal
from PySide6.QtWidgets import QMenu, QSizePolicy, QToolBar, QToolButton, QWidget

from texlab.style.icons import tool_icon
from texlab.style.text_size import grow_with_text
from texlab.widgets.number_box import WholeBox
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.job import MAX_SEED

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtGui import QAction

    from texlab.style.theme import Theme

MAX_SIDE = 4096
LAYOUTS = ("explore", "teach", "tune")
# What is written beside the icon; "" leaves the icon alone.
SHORT = {
    "open": "Open", "export": "Save", "undo": "", "redo": "", "dice": "", "tile": "", "add": "Column",
    "run-all": "Run all", "stop-all": "Stop", "help": "",
}  # fmt: skip
ICON_SIDE = 18


class ToolBar(QToolBar):
    """Shows commands by icons, the weightiest with a word beside them.

    ``seed_turned(seed)`` and ``size_turned((height, width))`` when the user changes what is in the boxes.
    """

    seed_turned = Signal(int)
    size_turned = Signal(object)

    def __init__(self, actions: Mapping[str, QAction]) -> None:
        super().__init__("Tools")
        self.setObjectName("toolbar")
        self.setMovable(False)
        self._theme: Theme | None = None
        # In which theme and at which size the icons were painted last.
        self._painted = ("", 0)
        self._tools = {name: actions[name] for name in SHORT}
        for name, text in SHORT.items():
            actions[name].setIconText(text or actions[name].text().replace("&", ""))
            # The menus are lists of words.
            actions[name].setIconVisibleInMenu(False)
        tip = "Seed of all columns: the same seed and parameters make the same bits"
        self.seed_box = _box("Seed", 0, MAX_SEED, 1, tip)
        self.width_box, self.height_box = (
            _box(name, 8, MAX_SIDE, 256, f"{name} of the results, in pixels") for name in ("Width", "Height")
        )
        for box in (self.width_box, self.height_box):
            box.setSingleStep(32)
            box.valueChanged.connect(lambda _: self.size_turned.emit(self.size_shown))
        self.seed_box.valueChanged.connect(self.seed_turned)
        # Room for ten digits.
        grow_with_text(self.seed_box, 106, self.seed_box.setMaximumWidth)
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
        self.addWidget(Label("×"))
        self.addWidget(self.height_box)
        self.addSeparator()
        self.addActions([actions["tile"], actions["add"]])
        self._add_spring()
        self.addActions([actions["run-all"], actions["stop-all"]])
        self._add_spring()
        self.layout_menu = QMenu(self)
        self.layout_menu.addActions([actions[f"layout-{name}"] for name in LAYOUTS])
        self.layout_menu.addSeparator()
        self.layout_menu.addAction(actions["own-layouts"])
        self.layout_button = _layout_button(self.layout_menu)
        self.addWidget(self.layout_button)
        self.addAction(actions["help"])
        for action in self.actions():
            button = self.widgetForAction(action)
            if isinstance(button, QToolButton):
                button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
                # Most have no words.
                button.setAccessibleName(action.text().replace("&", "").removesuffix(" ...") or button.text())
                is_bare = any(action is tool and not SHORT[name] for name, tool in self._tools.items())
                style = Qt.ToolButtonStyle
                button.setToolButtonStyle(style.ToolButtonIconOnly if is_bare else style.ToolButtonTextBesideIcon)
        grow_with_text(self, ICON_SIDE, self._resize_icons)

    def _add_spring(self) -> None:
        spring = QWidget()
        spring.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self.addWidget(spring)

    def set_theme(self, theme: Theme) -> None:
        """Paint the icons in the colours of a theme."""
        self._theme = theme
        self._paint_icons(self.iconSize().width())

    def _resize_icons(self, side: int) -> None:
        self.setIconSize(QSize(side, side))
        self._paint_icons(side)

    def _paint_icons(self, side: int) -> None:
        theme = self._theme
        if theme is None or (theme.name, side) == self._painted:
            return
        self._painted = theme.name, side
        for name, action in self._tools.items():
            action.setIcon(tool_icon(name, theme, side))
        self.layout_button.setIcon(tool_icon("layout", theme, side))

    @property
    def size_shown(self) -> tuple[int, int]:
        """Height and width in the boxes."""
        return self.height_box.value(), self.width_box.value()

    def show_values(self, seed: int, size: tuple[int, int]) -> None:
        """Show seed and size (height, width) without telling anyone."""
        for box, value in ((self.seed_box, seed), (self.height_box, size[0]), (self.width_box, size[1])):
            with QSignalBlocker(box):
                # A file may ask for more than what is typed here.
                box.setRange(min(box.minimum(), value), max(box.maximum(), value))
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
