"""The gallery: thumbnails by class, with a search field."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtGui import QIcon, QImage, QPixmap, QResizeEvent
from PySide6.QtWidgets import QLineEdit, QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget

from texlab.widgets.once import Once
from texlab.widgets.plain import set_tip
from texlab.window.strip import ExemplarStrip

if TYPE_CHECKING:
    from collections.abc import Iterable

    from texlab.style.pictures import Picture

THUMBNAIL = 48
_NAME = Qt.ItemDataRole.UserRole
_WORDS = Qt.ItemDataRole.UserRole + 1


class GalleryView(QWidget):
    """Lists textures by class, and under them what was opened together.

    ``chosen(name)`` is the name of a texture with its ``gallery:`` prefix.
    """

    chosen = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("gallery")
        self.setAccessibleName("Gallery")
        self.search = QLineEdit()
        self.search.setObjectName("gallery-search")
        self.search.setPlaceholderText("Search textures")
        self.search.setClearButtonEnabled(True)
        self.search.setAccessibleName("Search textures")
        # A picture dropped here is meant for the window.
        self.search.setAcceptDrops(False)
        self.tree = QTreeWidget()
        self.tree.setObjectName("gallery-tree")
        self.tree.setAccessibleName("Textures of the gallery")
        self.tree.setHeaderHidden(True)
        self.tree.setIconSize(QSize(THUMBNAIL, THUMBNAIL))
        self.tree.setIndentation(8)
        self.tree.setRootIsDecorated(False)
        self.tree.setVerticalScrollMode(QTreeWidget.ScrollMode.ScrollPerPixel)
        self.tree.setUniformRowHeights(False)
        self.tree.setWordWrap(True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(4, 4, 4, 4)
        layout.addWidget(self.search)
        layout.addWidget(self.tree, 1)
        self.strip = ExemplarStrip()
        layout.addWidget(self.strip)
        self._items: dict[str, QTreeWidgetItem] = {}
        self.thumbnails = 0
        self.search.textChanged.connect(self._filter)
        self.tree.itemClicked.connect(self._picked)
        self.tree.itemActivated.connect(self._picked)
        self._room = self.tree.viewport()
        self._room.installEventFilter(self)
        # The rows have their new places when the resize has been handled.
        self._late = Once(self, 0, self._show_whole)

    def show_entries(self, entries: Iterable[tuple[str, str, str, str, str]]) -> None:
        """List (name, class, title, tooltip, further words to find it by) in the order given."""
        self.tree.clear()
        self._items.clear()
        groups: dict[str, QTreeWidgetItem] = {}
        for name, group, title, tip, words in entries:
            if group not in groups:
                head = QTreeWidgetItem([group.capitalize()])
                font = head.font(0)
                font.setBold(True)
                head.setFont(0, font)
                head.setFlags(Qt.ItemFlag.ItemIsEnabled)
                self.tree.addTopLevelItem(head)
                head.setExpanded(True)
                groups[group] = head
            item = QTreeWidgetItem([title])
            item.setData(0, _NAME, name)
            item.setData(0, _WORDS, words)
            set_tip(item, tip)
            item.setSizeHint(0, QSize(0, THUMBNAIL + 6))
            groups[group].addChild(item)
            self._items[name] = item

    def textures(self) -> list[tuple[str, str, str]]:
        """Return name, title and the words to find it by of every texture."""
        return [(name, item.text(0), str(item.data(0, _WORDS))) for name, item in self._items.items()]

    def set_thumbnail(self, name: str, picture: Picture) -> None:
        """Show the small picture of a texture, (h, w, 3) uint8."""
        self.thumbnails += 1
        item = self._items.get(name)
        if item is not None:
            height, width = picture.shape[:2]
            image = QImage(picture.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888)
            pixmap = QPixmap.fromImage(image)
            icon = QIcon(pixmap)
            # The chosen texture keeps its colours.
            icon.addPixmap(pixmap, QIcon.Mode.Selected)
            item.setIcon(0, icon)

    def mark(self, name: str) -> None:
        """Mark the texture that is the exemplar (none when it is no texture of the gallery)."""
        item = self._items.get(name)
        if item is None:
            self.tree.clearSelection()
        elif self.tree.currentItem() is not item:
            self.tree.setCurrentItem(item)
            self._show_whole()

    def _show_whole(self) -> None:
        """Scroll as little as needed, so that nothing of the chosen texture is cut off."""
        item = self.tree.currentItem()
        if item is not None and item.isSelected() and not item.isHidden():
            self.tree.scrollToItem(item)
            # Qt leaves out the last line of pixels.
            beyond = self.tree.visualItemRect(item).bottom() - self._room.rect().bottom()
            bar = self.tree.verticalScrollBar()
            bar.setValue(bar.value() + max(0, beyond))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep the chosen texture whole where the list changes its height; not where it was scrolled away."""
        if watched is self._room and isinstance(event, QResizeEvent):
            item = self.tree.currentItem()
            before = self._room.rect()
            before.setHeight(event.oldSize().height())
            if item is not None and self.tree.visualItemRect(item).intersects(before):
                self._late.start()
        return super().eventFilter(watched, event)

    def _picked(self, item: QTreeWidgetItem) -> None:
        name = item.data(0, _NAME)
        if name:
            # What was clicked may stand at the edge.
            self._show_whole()
            self.chosen.emit(name)
        else:
            item.setExpanded(not item.isExpanded())

    def _filter(self, text: str) -> None:
        words = text.lower().split()
        for place in range(self.tree.topLevelItemCount()):
            head = self.tree.topLevelItem(place)
            if head is None:
                continue
            shown = 0
            for child_place in range(head.childCount()):
                item = head.child(child_place)
                if item is None:
                    continue
                haystack = f"{head.text(0)} {item.text(0)} {item.data(0, _NAME)} {item.data(0, _WORDS)}".lower()
                match = all(word in haystack for word in words)
                item.setHidden(not match)
                shown += match
            head.setHidden(shown == 0)
        self._show_whole()
