"""Which textures a preset is held against: of the gallery, the open files, a folder, or chosen files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog, QSizePolicy, QVBoxLayout, QWidget

from texlab.docks.frame import replace_items
from texlab.state.sweeps import Textures
from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.plain import ShortLabel, set_tip
from texlab_core.errors import ParamError
from texlab_core.images.formats.kinds import READABLE_SUFFIXES
from texlab_core.images.gallery import CLASSES, PREFIX

if TYPE_CHECKING:
    from collections.abc import Sequence

FOLDER, FILES, OPENED = "folder", "files", "opened"
_GALLERY = [(f"gallery: {title.lower()}", PREFIX + name) for name, title in CLASSES.items()]
ITEMS: list[tuple[str, str]] = [
    *_GALLERY,
    ("gallery: all", f"{PREFIX}*"),
    ("the open files", OPENED),
    ("a folder ...", FOLDER),
    ("files ...", FILES),
]


class TextureChoice(QWidget):
    """Chooses textures; ``changed()`` when others are chosen."""

    changed = Signal()

    def __init__(self, name: str, title: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(f"{title}: textures")
        self._opened: tuple[str, ...] = ()
        self._chosen: dict[str, tuple[str, ...]] = {FOLDER: (), FILES: ()}
        self.box = ChoiceBox()
        self.box.setObjectName(f"{name}-textures")
        self.box.setAccessibleName(f"{title}: textures")
        self.box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        set_tip(self.box, "Which textures: a class of the gallery, the open files, a folder, or chosen files")
        replace_items(self.box, list(ITEMS))
        self.words = ShortLabel(name=f"{name}-textures-words", muted=True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addWidget(self.box)
        layout.addWidget(self.words)
        self.box.activated.connect(lambda _: self._activated())
        self._say()

    def show_opened(self, paths: Sequence[str]) -> None:
        """Offer the files that are open."""
        self._opened = tuple(paths)
        self._say()

    def choose(self, value: str, texts: Sequence[str] = ()) -> None:
        """Choose by what :data:`ITEMS` holds; a folder or files with their paths."""
        self.box.setCurrentIndex(self.box.findData(value))
        if value in self._chosen and texts:
            self._chosen[value] = tuple(texts)
        self._say()
        self.changed.emit()

    @property
    def choice(self) -> tuple[str, tuple[str, ...]]:
        """What is chosen, for :meth:`choose`."""
        return self.box.currentData(), self._texts()

    def textures(self) -> Textures:
        """Return what is chosen; raises ``ParamError`` when that is nothing."""
        texts = self._texts()
        if not texts:
            raise ParamError("textures", "a class of the gallery, or files that are there", "none")
        return Textures(texts)

    def _texts(self) -> tuple[str, ...]:
        value = self.box.currentData()
        if value == OPENED:
            return self._opened
        return self._chosen.get(value, (value,))

    def _activated(self) -> None:
        value = self.box.currentData()
        if value in self._chosen:
            self._ask(value)
        self._say()
        self.changed.emit()

    def _ask(self, value: str) -> None:
        dialog = QFileDialog(self, "Textures")
        dialog.setObjectName("sweeps-textures-dialog")
        if value == FOLDER:
            dialog.setFileMode(QFileDialog.FileMode.Directory)
        else:
            dialog.setFileMode(QFileDialog.FileMode.ExistingFiles)
            dialog.setNameFilter(f"Images ({' '.join(f'*{each}' for each in sorted(READABLE_SUFFIXES))})")
        dialog.accepted.connect(lambda: self.choose(value, dialog.selectedFiles()))
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def _say(self) -> None:
        texts, value = self._texts(), self.box.currentData()
        if value == FOLDER:
            said = f"the images in {Path(texts[0]).name or texts[0]}" if texts else "no folder yet"
        elif value in (FILES, OPENED):
            said = f"{len(texts)} files" if len(texts) != 1 else Path(texts[0]).name
        else:
            said = ""
        self.words.setText(said)
        set_tip(self.words, "\n".join(texts[:20]))
        self.words.setVisible(bool(said))
