"""The middle of the window: the exemplar and the columns side by side, with linked views."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QScrollArea, QSplitter, QWidget

from texlab.columns.column import ColumnView
from texlab.columns.exemplar import ExemplarView
from texlab.style.pictures import Mark
from texlab.widgets.view_link import ViewLink

if TYPE_CHECKING:
    from collections.abc import Iterable

    from texlab.state.scene import Scene
    from texlab.style.theme import Theme


class Workspace(QScrollArea):
    """Shows a :class:`Scene`: one view per column, added and removed as the scene says.

    ``column_made(view)`` lets the window connect what the user does in it.
    """

    column_made = Signal(object)

    def __init__(self, methods: Iterable[tuple[str, str]], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("workspace")
        self.setAccessibleName("Exemplar and columns")
        self.setWidgetResizable(True)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._methods = tuple(methods)
        self.link = ViewLink()
        self.columns: dict[int, ColumnView] = {}
        self.splitter = QSplitter(Qt.Orientation.Horizontal)
        self.splitter.setObjectName("columns")
        self.splitter.setChildrenCollapsible(False)
        self.splitter.setHandleWidth(5)
        self.exemplar = ExemplarView(self.link)
        self.splitter.addWidget(self.exemplar)
        inner = QWidget()
        layout = QHBoxLayout(inner)
        layout.setContentsMargins(4, 4, 4, 4)
        layout.addWidget(self.splitter)
        self.setWidget(inner)
        self._inner = inner
        self._tiled = False
        self._theme: Theme | None = None
        self._order: tuple[int, ...] = ()
        self._revealed = 0
        self._chosen = 0
        # Columns have come or gone, or the window is narrower.
        self.horizontalScrollBar().rangeChanged.connect(lambda *_: self._scroll())

    def show_scene(self, scene: Scene) -> None:
        """Show every column as it is."""
        wanted = [column.id for column in scene.columns]
        for column_id in [known for known in self.columns if known not in wanted]:
            view = self.columns.pop(column_id)
            view.pane.detach()
            view.setParent(None)
            view.deleteLater()
        added = [column_id for column_id in wanted if column_id not in self.columns]
        for column_id in added:
            self._add(column_id)
        order = tuple(wanted)
        if order != self._order:
            self._order = order
            for place, column_id in enumerate(wanted):
                self.splitter.insertWidget(place + 1, self.columns[column_id])
            self.splitter.setSizes([1000] * (len(wanted) + 1))
            self.link.resized()
        for column in scene.columns:
            view = self.columns[column.id]
            view.show_scene(column)
            view.set_chosen(column.id == scene.selected_id)
            view.pane.set_marks(pinned_pixel(scene, column.id))
        if scene.selected_id != self._chosen:
            self._chosen = scene.selected_id
            chosen = self.columns.get(self._chosen)
            # What is clicked stays under the pointer; a new column may have come there by chance.
            if chosen is not None and (self._chosen in added or not chosen.underMouse()):
                self.reveal(self._chosen)

    def _add(self, column_id: int) -> None:
        view = ColumnView(column_id, self._methods, self.link)
        view.pane.set_tiled(self._tiled)
        if self._theme is not None:
            view.set_theme(self._theme)
        self.columns[column_id] = view
        self.column_made.emit(view)

    def set_tiled(self, tiled: bool) -> None:
        """Show results 2 x 2."""
        self._tiled = tiled
        for view in self.columns.values():
            view.pane.set_tiled(tiled)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.exemplar.set_theme(theme)
        for view in self.columns.values():
            view.set_theme(theme)

    def reveal(self, column_id: int) -> None:
        """Scroll a column into sight, also one that has no place yet."""
        self._revealed = column_id
        self._scroll()

    def _scroll(self) -> None:
        view = self.columns.get(self._revealed)
        if view is not None:
            at = view.mapTo(self._inner, QPoint(view.width() // 2, 0))
            self.ensureVisible(at.x(), at.y(), view.width() // 2 + 8, 0)


def pinned_pixel(scene: Scene, column_id: int) -> tuple[Mark, ...]:
    """Return the mark of the pixel that is kept in a column, if there is one."""
    probe = scene.probe
    if probe is None or not probe.pinned or probe.column_id != column_id:
        return ()
    return (Mark(probe.row, probe.column, 1, 1, "chosen"),)
