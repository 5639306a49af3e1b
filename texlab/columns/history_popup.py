"""The finished results of a column as small pictures: a click goes back to one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QSize, Qt, Signal
from PySide6.QtGui import QIcon, QImage, QPixmap
from PySide6.QtWidgets import QApplication, QDialog, QListWidget, QListWidgetItem, QVBoxLayout

from texlab.columns.status import figures
from texlab.columns.titles import described
from texlab.state.scene import ColumnScene
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.registry import find_method

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtWidgets import QWidget

    from texlab.state.scene import Past

ICON = 64
_PLACE = Qt.ItemDataRole.UserRole


def numbers_before(scene: ColumnScene) -> Mapping[str, float]:
    """Return the numbers of the result before the one that is shown; none when there was no other."""
    present = scene.result.job.key if scene.result is not None else None
    exemplar = scene.history[-1].exemplar if scene.history else ""
    others = [each for each in scene.history if each.key != present and each.exemplar == exemplar]
    return others[-1].measures if others else {}


def words_of(history: tuple[Past, ...]) -> list[str]:
    """Return what is written under every small picture: what differs between them."""
    scenes = [
        ColumnScene(place, past.method, find_method(past.method).title, past.params, seed=past.seed)
        for place, past in enumerate(history)
    ]
    return [described(each, scenes) for each in scenes]


class HistoryPopup(QDialog):
    """Goes with a click anywhere else.

    ``chosen(past)`` goes back to a result; ``compared(past)``, with Ctrl held, puts it into a column beside.
    """

    chosen = Signal(object)
    compared = Signal(object)

    def __init__(self, scene: ColumnScene, exemplar: str, parent: QWidget | None = None) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("history-popup")
        self.setAccessibleName("Earlier results")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        # The newest first; those of another exemplar would be other textures.
        self._past = tuple(reversed([each for each in scene.history if each.exemplar == exemplar]))
        present = scene.result.job.key if scene.result is not None else None
        self.list = QListWidget()
        self.list.setObjectName("history-list")
        self.list.setAccessibleName("Earlier results of this column")
        self.list.setViewMode(QListWidget.ViewMode.IconMode)
        self.list.setMovement(QListWidget.Movement.Static)
        self.list.setResizeMode(QListWidget.ResizeMode.Adjust)
        self.list.setIconSize(QSize(ICON, ICON))
        self.list.setGridSize(QSize(ICON + 56, ICON + 3 * self.fontMetrics().lineSpacing() + 8))
        self.list.setWordWrap(True)
        for place, (past, words) in enumerate(zip(self._past, words_of(self._past), strict=True)):
            item = QListWidgetItem(_icon(past), words.partition(", ")[2] or words)
            numbers = ", ".join(each.text for each in figures(past.measures))
            here = "\nIt is the one that is shown." if past.key == present else ""
            set_tip(item, f"{words}\n{numbers}{here}".strip())
            item.setData(_PLACE, place)
            self.list.addItem(item)
            if past.key == present:
                self.list.setCurrentItem(item)
        hint = Label(
            "Click: go back to it. Ctrl+click: beside, in a new column."
            if self._past
            else "The results of this column appear here when they are finished."
        )
        hint.setProperty("role", "muted")
        hint.setWordWrap(True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 6, 6, 6)
        layout.addWidget(self.list)
        layout.addWidget(hint)
        self.resize(400, 300)
        self.list.itemClicked.connect(self._take)
        self.list.itemActivated.connect(self._take)
        self.list.setFocus()

    def show_at(self, over: QWidget) -> None:
        """Show it over the lower edge of a widget."""
        self.move(over.mapToGlobal(QPoint(0, max(0, over.height() - self.height()))))
        self.show()

    def _take(self, item: QListWidgetItem) -> None:
        past = self._past[item.data(_PLACE)]
        beside = QApplication.keyboardModifiers() & Qt.KeyboardModifier.ControlModifier
        self.close()
        (self.compared if beside else self.chosen).emit(past)


def _icon(past: Past) -> QIcon:
    height, width = past.thumbnail.shape[:2]
    image = QImage(past.thumbnail.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888)
    return QIcon(QPixmap.fromImage(image))
