"""Pictures that were opened together: a strip under the gallery, of which one is the exemplar."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QIcon, QImage, QPixmap
from PySide6.QtWidgets import QHBoxLayout, QListWidget, QListWidgetItem, QToolButton, QVBoxLayout, QWidget

from texlab.widgets.pasted import Pasted
from texlab.widgets.plain import Label, set_tip

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab.storage.reading import Source
    from texlab.style.pictures import Picture

ICON = 48
_PLACE = Qt.ItemDataRole.UserRole


class ExemplarStrip(QWidget):
    """Shows small pictures of what was opened together; ``chosen(source)`` when one of them is wanted.

    It hides itself while there is nothing to choose from.
    """

    chosen = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("strip")
        self.setAccessibleName("Exemplars that were opened together")
        self._sources: tuple[Source, ...] = ()
        self.heading = Label(name="strip-heading")
        self.heading.setProperty("role", "heading")
        self.close_button = QToolButton()
        self.close_button.setObjectName("strip-close")
        self.close_button.setText("✕")
        self.close_button.setAutoRaise(True)
        self.close_button.setAccessibleName("Close the strip of pictures opened together")
        set_tip(self.close_button, "Close the strip; the exemplar stays")
        self.close_button.clicked.connect(lambda: self.show_sources(()))
        self.list = QListWidget()
        self.list.setObjectName("strip-list")
        self.list.setAccessibleName("Pictures opened together")
        self.list.setViewMode(QListWidget.ViewMode.IconMode)
        self.list.setFlow(QListWidget.Flow.LeftToRight)
        self.list.setWrapping(False)
        self.list.setMovement(QListWidget.Movement.Static)
        self.list.setIconSize(QSize(ICON, ICON))
        self.list.setUniformItemSizes(True)
        self.list.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self.list.setAcceptDrops(False)
        lines = self.list.fontMetrics().lineSpacing()
        self.list.setGridSize(QSize(ICON + 24, ICON + lines + 10))
        self.list.setFixedHeight(ICON + lines + 12 + self.list.horizontalScrollBar().sizeHint().height())
        head = QHBoxLayout()
        head.addWidget(self.heading, 1)
        head.addWidget(self.close_button)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addLayout(head)
        layout.addWidget(self.list)
        self.list.itemClicked.connect(self._picked)
        self.list.itemActivated.connect(self._picked)
        self.hide()

    @property
    def sources(self) -> tuple[Source, ...]:
        """What there is to choose from."""
        return self._sources

    def show_sources(self, sources: Sequence[Source]) -> None:
        """List these, the first one chosen."""
        self._sources = tuple(sources)
        self.list.clear()
        for place, source in enumerate(self._sources):
            name = title_of(source, place)
            item = QListWidgetItem(_blank(), name)
            item.setData(_PLACE, place)
            set_tip(item, source if isinstance(source, str) else name)
            self.list.addItem(item)
        if self._sources:
            self.list.setCurrentRow(0)
        self.heading.setText(f"Opened together: {len(self._sources)}")
        self.setVisible(bool(self._sources))

    def set_thumbnail(self, place: int, picture: Picture) -> None:
        """Show the small picture, (h, w, 3) uint8, of what stands at a place."""
        item = self.list.item(place)
        if item is not None:
            height, width = picture.shape[:2]
            image = QImage(picture.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888)
            item.setIcon(QIcon(QPixmap.fromImage(image)))

    def refuse(self, place: int, sentence: str) -> None:
        """Say that what stands at a place cannot be chosen, and why."""
        item = self.list.item(place)
        if item is not None:
            item.setFlags(Qt.ItemFlag.NoItemFlags)
            set_tip(item, sentence)

    def mark(self, path: str | None) -> None:
        """Mark the file that is the exemplar; nothing changes for one that is not here."""
        if path in self._sources:
            self.list.setCurrentRow(self._sources.index(path))

    def _picked(self, item: QListWidgetItem) -> None:
        self.chosen.emit(self._sources[item.data(_PLACE)])


def title_of(source: Source, place: int) -> str:
    """Return the name under a small picture."""
    if isinstance(source, str):
        return Path(source).name
    return source.name if isinstance(source, Pasted) else f"picture {place + 1}"


def _blank() -> QIcon:
    pixmap = QPixmap(ICON, ICON)
    pixmap.fill(Qt.GlobalColor.transparent)
    return QIcon(pixmap)
