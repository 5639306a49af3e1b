"""The presets of the chosen method: take one, save, rename, delete, import, export."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QMenu, QSizePolicy, QToolButton, QWidget

from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.plain import set_tip, tip_text

if TYPE_CHECKING:
    from texlab_core.documents.presets import Preset

_TITLE = "Presets"


class PresetBar(QWidget):
    """Lists presets; ``chosen(preset)`` takes one, ``command(name, preset or None)`` manages them."""

    chosen = Signal(object)
    command = Signal(str, object)

    COMMANDS = (
        ("save", "Save as preset ...", False),
        ("rename", "Rename this preset ...", True),
        ("delete", "Delete this preset", True),
        ("restore", "Bring back the deleted preset", False),
        ("export", "Export this preset ...", False),
        ("import", "Import a preset ...", False),
    )

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("preset-bar")
        self.setAccessibleName("Presets")
        self._presets: list[Preset] = []
        self._own: set[tuple[str, str]] = set()
        self.box = ChoiceBox()
        self.box.setObjectName("preset-box")
        self.box.setAccessibleName("Presets of this method")
        set_tip(self.box, "Take the parameters of a preset")
        self.box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.button = QToolButton()
        self.button.setObjectName("preset-menu")
        self.button.setText("⋯")
        set_tip(self.button, "Save, rename, delete, import and export presets")
        self.button.setAccessibleName("Manage presets")
        self.button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.button.setStyleSheet("QToolButton::menu-indicator { image: none; }")
        self.menu = QMenu(self)
        self.menu.setToolTipsVisible(True)
        self.actions_by_name = {}
        for name, text, _ in self.COMMANDS:
            action = self.menu.addAction(text)
            action.setObjectName(f"preset-{name}")
            action.triggered.connect(lambda _=False, name=name: self.command.emit(name, self.current))
            self.actions_by_name[name] = action
        self.button.setMenu(self.menu)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.box, 1)
        layout.addWidget(self.button)
        self.box.activated.connect(self._activated)
        self.show_presets([], set())
        self.offer_restore(None)

    @property
    def current(self) -> Preset | None:
        """The preset that is shown as chosen."""
        place = self.box.currentIndex() - 1
        return self._presets[place] if 0 <= place < len(self._presets) else None

    def show_presets(
        self, presets: list[Preset], own: set[tuple[str, str]], current: tuple[str, str] | None = None
    ) -> None:
        """List presets; ``own`` holds the keys of those that can be renamed and deleted."""
        self._presets, self._own = presets, own
        with QSignalBlocker(self.box):
            self.box.clear()
            self.box.addItem(_TITLE)
            for place, preset in enumerate(presets):
                self.box.addItem(preset.name if preset.key not in own else f"{preset.name} (own)")
                self.box.setItemData(place + 1, tip_text(preset.note), Qt.ItemDataRole.ToolTipRole)
                if preset.key == current:
                    self.box.setCurrentIndex(place + 1)
        self._update_menu()

    @property
    def presets(self) -> tuple[Preset, ...]:
        """What is listed."""
        return tuple(self._presets)

    def forget_current(self) -> None:
        """Show that the parameters are no preset's any more."""
        with QSignalBlocker(self.box):
            self.box.setCurrentIndex(0)
        self._update_menu()

    def offer_restore(self, name: str | None) -> None:
        """Offer to bring back the preset that was deleted last, or nothing."""
        action = self.actions_by_name["restore"]
        action.setVisible(name is not None)
        action.setText(f"Bring back {name}".replace("&", "&&"))

    def _activated(self) -> None:
        self._update_menu()
        if self.current is not None:
            self.chosen.emit(self.current)

    def _update_menu(self) -> None:
        current = self.current
        own = current is not None and current.key in self._own
        self.actions_by_name["rename"].setEnabled(own)
        self.actions_by_name["delete"].setEnabled(own)
        self.actions_by_name["export"].setEnabled(current is not None)
