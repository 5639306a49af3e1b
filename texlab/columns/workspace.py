"""The stage: the exemplar and the columns, as large as there is room, with linked views."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Signal
from PySide6.QtWidgets import QApplication, QFrame, QRubberBand, QScrollArea

from texlab.columns.apart import Apart
from texlab.columns.column import ColumnView
from texlab.columns.exemplar import ExemplarView
from texlab.columns.grid import Grid
from texlab.columns.titles import titles
from texlab.state.scene import are_same, asked_columns
from texlab.style.pictures import Mark
from texlab.widgets.once import Once
from texlab.widgets.view_link import ViewLink

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from PySide6.QtGui import QResizeEvent
    from PySide6.QtWidgets import QWidget

    from texlab.columns.arrangement import Rows
    from texlab.state.scene import ColumnScene, Scene
    from texlab.style.theme import Theme
    from texlab_core.engine.levels import Levels

# The id that stands for the exemplar where a column could stand.
EXEMPLAR = 0
# Around the part of the exemplar that fills its pane, as a share of its longer side.
MARGIN = 0.02


class Workspace(QScrollArea):
    """Shows a :class:`Scene`: one view per column, added and removed as the scene says.

    ``column_made(view)`` lets the window connect what the user does in it, ``column_gone(view)`` comes before it
    is deleted; ``column_moved(id, by)`` when one is dragged to another place; ``arranged()`` when cells have come,
    gone, or changed their places.
    """

    column_made = Signal(object)
    column_moved = Signal(int, int)
    column_gone = Signal(object)
    arranged = Signal()

    def __init__(self, methods: Iterable[tuple[str, str]], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("workspace")
        self.setAccessibleName("Exemplar and columns")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidgetResizable(True)
        self.setMinimumSize(160, 120)
        self._methods = tuple(methods)
        self.link = ViewLink()
        self.exemplar_link = ViewLink()
        self.columns: dict[int, ColumnView] = {}
        self.grid = Grid()
        self.exemplar = ExemplarView(self.exemplar_link, self.grid)
        self.setWidget(self.grid)
        self.apart = Apart(self)
        self.apart.changed.connect(self._show_cells)
        self._landing = QRubberBand(QRubberBand.Shape.Rectangle, self.grid)
        self._linked = False
        self._close = False
        self._tiled = False
        self._surround = ""
        self._look: Levels | None = None
        self._theme: Theme | None = None
        self._order: tuple[int, ...] = ()
        self._titled: tuple[ColumnScene, ...] = ()
        self._only: tuple[int, ...] | None = None
        self._has_exemplar = True
        self._enlarged: int | None = None
        self._extents = (1, 1), (1, 1)
        self._revealed = 0
        self._chosen = 0
        # Cells change their needs one by one (a font, a name): they are placed once.
        self._placing = Once(self, 0, self.place)
        self.exemplar.enlarged.connect(lambda: self.enlarge(EXEMPLAR))
        self.exemplar.part_shown.connect(self._aim)
        for bar in (self.horizontalScrollBar(), self.verticalScrollBar()):
            # Columns have come or gone, or the window is smaller.
            bar.rangeChanged.connect(lambda *_: self._scroll())

    # What there is.

    def show_scene(self, scene: Scene) -> None:
        """Show every column as it is."""
        wanted = [column.id for column in scene.columns]
        for column_id in [known for known in self.columns if known not in wanted]:
            view = self.columns.pop(column_id)
            self.column_gone.emit(view)
            self.apart.drop(column_id)
            view.leave()
            view.setParent(None)
            view.deleteLater()
        added = [column_id for column_id in wanted if column_id not in self.columns]
        for column_id in added:
            self._add(column_id)
        order = tuple(wanted)
        if order != self._order:
            self._order = order
            if self._enlarged not in (None, EXEMPLAR, *order):
                self._enlarged = None
            self._show_cells()
        if not are_same(scene.columns, self._titled):
            # The pointer moves far more often than anything that is written changes.
            self._titled = scene.columns
            for column, title in zip(scene.columns, titles(scene.columns), strict=True):
                self.columns[column.id].show_title(title)
                self.apart.show_title(column.id, title)
        for column in scene.columns:
            view = self.columns[column.id]
            view.show_scene(column)
            view.set_chosen(column.id == scene.selected_id)
            view.pane.set_marks(pinned_pixel(scene, column.id))
        if scene.selected_id != self._chosen:
            self._chosen = scene.selected_id
            chosen = self.columns.get(self._chosen)
            stands_here = chosen is not None and self._chosen not in self.apart
            if self._enlarged not in (None, EXEMPLAR, self._chosen) and stands_here:
                self.enlarge(self._chosen)
            # What is clicked stays under the pointer; a new column may have come there by chance.
            if chosen is not None and (self._chosen in added or not chosen.underMouse()):
                self.reveal(self._chosen)

    def _add(self, column_id: int) -> None:
        view = ColumnView(column_id, self._methods, self.link, self.grid)
        view.pane.set_tiled(self._tiled)
        view.pane.set_surround(self._surround)
        view.pane.set_look(None if self._look is None else self._look.table())
        if self._theme is not None:
            self._paint(view)
        view.dragged.connect(self._drag)
        view.enlarged.connect(self.enlarge)
        self.columns[column_id] = view
        self.column_made.emit(view)
        if self.apart.is_wanted(column_id):
            self.apart.detach(view)

    # Where it stands.

    @property
    def enlarged(self) -> int | None:
        """Id of the column that is shown alone (0: the exemplar), or None."""
        return self._enlarged

    def enlarge(self, column_id: int) -> None:
        """Show one alone; all of them again when it is alone already. Its own window takes the whole screen."""
        if column_id in self.apart:
            self.apart.windows[column_id].toggle_size()
            return
        self._enlarged = None if self._enlarged == column_id else column_id
        self._show_cells()

    def turn_apart(self, column_id: int) -> None:
        """Give a column a window of its own, or put it back on the stage."""
        if column_id in self.apart:
            self.apart.put_back(column_id)
        elif column_id in self.columns:
            if self._enlarged == column_id:
                self._enlarged = None
            self.apart.detach(self.columns[column_id])

    def take_apart(self, places: Mapping[int, bytes]) -> None:
        """Give these columns windows of their own, as soon as they are there, and put all others back."""
        self.apart.put_all_back()
        self.apart.want(places)
        for column_id in places:
            if column_id in self.columns:
                self.turn_apart(column_id)

    @property
    def order(self) -> tuple[int, ...]:
        """Ids of all columns, from left to right."""
        return self._order

    def show_only(self, column_ids: tuple[int, ...] | None, *, exemplar: bool = True) -> None:
        """Fold away all columns but these, and the exemplar when it is not wanted; None unfolds all.

        Something always stays in sight: the exemplar, when nothing else would.
        """
        if (column_ids, exemplar) != (self._only, self._has_exemplar):
            self._only, self._has_exemplar = column_ids, exemplar
            self._enlarged = None
            self._show_cells()

    @property
    def shown_ids(self) -> tuple[int, ...]:
        """Ids of the columns that stand on the stage: neither folded away nor in windows of their own."""
        here = tuple(each for each in self._order if each not in self.apart)
        if self._only is None:
            return here
        return tuple(each for each in here if each in self._only)

    def set_rows(self, rows: Rows) -> None:
        """Arrange the pictures in one row, in two, or in as many as make them largest."""
        self.grid.rows = rows
        self.place()

    def _show_cells(self) -> None:
        cells: list[ExemplarView | ColumnView] = [self.columns[each] for each in self.shown_ids]
        if self._has_exemplar or not cells:
            cells.insert(0, self.exemplar)
        if self._enlarged is not None:
            cells = [self.exemplar if self._enlarged == EXEMPLAR else self.columns[self._enlarged]]
        staying = [view for each, view in self.columns.items() if each not in self.apart]
        gone = [view for view in (self.exemplar, *staying) if view not in cells]
        here = QApplication.focusWidget()
        if here is not None and any(view is here or view.isAncestorOf(here) for view in gone):
            # The keyboard would go on to another column, and choose it.
            self.setFocus()
        for view in gone:
            view.hide()
        self.grid.show_cells(cells)
        self.place()

    def place(self) -> None:
        """Give every picture the room there is."""
        self._placing.stop()
        size = self.maximumViewportSize()
        self.grid.place((size.width(), size.height()), self.verticalScrollBar().sizeHint().width())
        self.link.resized()
        self.exemplar_link.resized()
        self.arranged.emit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Use the room there is."""
        super().resizeEvent(event)
        self.place()

    def minimumSizeHint(self) -> QSize:
        """Let the window be small: the stage scrolls."""
        return self.minimumSize()

    def reveal(self, column_id: int) -> None:
        """Scroll a column into sight, also one that has no place yet."""
        self._revealed = column_id
        self._scroll()

    def _scroll(self) -> None:
        view = self.columns.get(self._revealed)
        if view is not None and not view.isHidden() and self._revealed not in self.apart:
            at = view.geometry().center()
            self.ensureVisible(at.x(), at.y(), view.width() // 2 + 2, view.height() // 2 + 2)

    def _drag(self, column_id: int, at: QPoint, final: bool) -> None:
        """Show where a column would stand, and move it there at the end."""
        cells = self.grid.cells
        view = self.columns[column_id]
        if view not in cells or self.grid.arrangement is None:
            return
        place = max(self.grid.place_at(self.grid.mapFromGlobal(at)), cells.index(self.columns[self.shown_ids[0]]))
        self._landing.setGeometry(QRect(*self.grid.arrangement.cell(place)))
        self._landing.setVisible(not final)
        self._landing.raise_()
        if final:
            # Columns that are folded away keep their places.
            there = self.shown_ids[place - (cells.index(view) - self.shown_ids.index(column_id))]
            by = self._order.index(there) - self._order.index(column_id)
            if by:
                self.column_moved.emit(column_id, by)

    # What is seen of it.

    def set_extents(self, results: tuple[int, int], source: tuple[int, int]) -> None:
        """Say how large (height, width) the results and the source of the exemplar are or will be."""
        self._extents = results, source
        self.grid.aspect = results[1] / results[0]
        both = [max(sides) for sides in zip(results, source, strict=True)]
        if self._linked:
            self.link.set_extent(both[0], both[1], min(*results, *source))
        else:
            self.link.set_extent(*results, min(results))
            self.exemplar_link.set_extent(*source, min(source))

    @property
    def linked(self) -> bool:
        """Whether the exemplar is panned and zoomed with the results."""
        return self._linked

    def set_linked(self, linked: bool) -> None:
        """Pan and zoom the exemplar with the results, or by its own size."""
        if linked != self._linked:
            self._linked = linked
            self.exemplar.pane.follow(self.link if linked else self.exemplar_link)
            self.set_extents(*self._extents)
            self.fit()

    def fit(self) -> None:
        """Show the pictures whole."""
        self.link.fit()
        self.exemplar_link.fit()

    def set_close(self, close: bool) -> None:
        """Let the part of the exemplar that is used fill its pane, or show it all."""
        self._close = close
        self._aim()

    def _aim(self) -> None:
        crop = self.exemplar.crop if self._close else None
        if crop is None:
            self.exemplar_link.set_focus(None)
            return
        # The frame of the part is seen, too.
        more = MARGIN * max(crop.width, crop.height)
        part = QRectF(crop.left, crop.top, crop.width, crop.height)
        self.exemplar_link.set_focus(part.adjusted(-more, -more, more, more))

    def actual_size(self) -> None:
        """Show one image pixel per screen pixel."""
        self.link.actual_size()
        self.exemplar_link.actual_size()

    def zoom(self, factor: float) -> None:
        """Enlarge around the centres."""
        self.link.zoom(factor)
        self.exemplar_link.zoom(factor)

    def set_tiled(self, tiled: bool) -> None:
        """Show results 2 x 2."""
        self._tiled = tiled
        for view in self.columns.values():
            view.pane.set_tiled(tiled)

    def set_look(self, levels: Levels | None) -> None:
        """Show results with these levels, which no method sees; the exemplar's picture has them already."""
        if levels != self._look:
            self._look = levels
            for view in self.columns.values():
                view.pane.set_look(None if levels is None else levels.table())

    def set_surround(self, colour: str) -> None:
        """Paint this around all pictures, as ``#rrggbb``; "" leaves it to the theme."""
        self._surround = colour
        if self._theme is not None:
            self.set_theme(self._theme)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self._paint(self.exemplar)
        for view in self.columns.values():
            self._paint(view)
        self._placing.start()

    def _paint(self, view: ExemplarView | ColumnView) -> None:
        assert self._theme is not None
        view.set_theme(self._theme)
        view.pane.set_surround(self._surround)


def pinned_pixel(scene: Scene, column_id: int) -> tuple[Mark, ...]:
    """Return the mark of the pixel that is kept in a column, or in the one that it is compared with."""
    probe = scene.probe
    if probe is None or not probe.pinned or column_id not in asked_columns(scene):
        return ()
    return (Mark(probe.row, probe.column, 1, 1, "chosen"),)
