"""One method's column: what it is, its picture, how far it is, and its buttons."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QPoint, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QMenu, QProgressBar, QToolButton

from texlab.columns.cell import Cell
from texlab.columns.commands import COLUMN_COMMANDS
from texlab.columns.foot import Foot
from texlab.columns.grip import Grip
from texlab.columns.history_popup import numbers_before
from texlab.columns.numbers_popup import NumbersPopup
from texlab.style.text_size import is_teaching
from texlab.widgets.number_box import NumberBox
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.short_box import ShortBox

if TYPE_CHECKING:
    from collections.abc import Iterable

    from PySide6.QtGui import QAction, QContextMenuEvent, QFocusEvent, QMouseEvent, QResizeEvent
    from PySide6.QtWidgets import QWidget

    from texlab.state.scene import ColumnScene
    from texlab.widgets.view_link import ViewLink


class ColumnView(Cell):
    """Shows a :class:`ColumnScene`; every wish of the user leaves as a signal with the column's id."""

    chosen = Signal(int)
    method_chosen = Signal(int, str)
    command = Signal(int, str)
    hovered = Signal(int, int, int)
    pixel_clicked = Signal(int, int, int)
    map_chosen = Signal(int, str)
    dragged = Signal(int, object, bool)
    enlarged = Signal(int)

    def __init__(
        self, column_id: int, methods: Iterable[tuple[str, str]], link: ViewLink, parent: QWidget | None = None
    ) -> None:
        super().__init__(Foot(f"line-{column_id}"), link, 1, parent)
        self.column_id = column_id
        self.scene: ColumnScene | None = None
        self._title: str | None = None
        # What else stands above the picture, but for the menu, makes room for the title.
        self._gives_way = False
        self.setProperty("chosen", False)
        self.setProperty("failed", False)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.method_box = ShortBox()
        self.method_box.setObjectName(f"method-{column_id}")
        self.method_box.setAccessibleName("Method of this column")
        for identifier, title in methods:
            self.method_box.addItem(title, identifier)
        self.run_button = self._button("▶", "Run this column again", "run")
        self.stop_button = self._button("■", "Stop this column", "stop")
        self.menu_button = self._button("⋯", "More for this column", "menu")
        self.menu = QMenu(self)
        self.actions_by_name: dict[str, QAction] = {}
        for name, command in COLUMN_COMMANDS.items():
            if not command.own:
                continue
            if command.apart:
                self.menu.addSeparator()
            action = self.menu.addAction(command.own)
            action.setObjectName(f"column-{name}-{column_id}")
            action.setCheckable(command.checkable)
            action.triggered.connect(lambda _=False, name=name: self.command.emit(self.column_id, name))
            self.actions_by_name[name] = action
        self.menu.addSeparator()
        self.map_menu = self.menu.addMenu("Lay a map over the picture")
        self.map_menu.setObjectName(f"maps-{column_id}")
        self.map_group = QActionGroup(self)
        self._maps: tuple[object, ...] = ()
        self.menu_button.setMenu(self.menu)
        self.menu_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.menu_button.setStyleSheet("QToolButton::menu-indicator { image: none; }")
        self.pane.setObjectName(f"pane-{column_id}")
        self.progress = QProgressBar()
        self.progress.setObjectName(f"progress-{column_id}")
        self.progress.setRange(0, 1000)
        self.progress.setTextVisible(False)
        self.progress.hide()
        self.progress.setAccessibleName("Progress of this column")
        self.stop_button.hide()
        self.grip = Grip(f"grip-{column_id}")
        self.badge = Label(name=f"badge-{column_id}")
        self.badge.setProperty("role", "heading")
        self.badge.hide()
        self.head.addWidget(self.grip)
        self.head.addWidget(self.badge)
        self.head.addWidget(self.method_box, 1)
        for button in (self.run_button, self.stop_button, self.menu_button):
            self.head.addWidget(button)
        # The row is as high as that of the exemplar.
        crop = QToolButton()
        crop.setText("Crop")
        self.lay_out(NumberBox(), crop)
        self.progress.setParent(self.pane)
        self.method_box.activated.connect(
            lambda place: self.method_chosen.emit(self.column_id, self.method_box.itemData(place))
        )
        self.run_button.clicked.connect(lambda: self.command.emit(self.column_id, "run"))
        self.stop_button.clicked.connect(lambda: self.command.emit(self.column_id, "stop"))
        self.pane.clicked.connect(self._pane_clicked)
        self.pane.hovered.connect(lambda row, column: self.hovered.emit(self.column_id, row, column))
        for part in (
            self.grip,
            self.line,
            self.progress,
            self.method_box,
            self.run_button,
            self.stop_button,
            self.menu_button,
        ):
            part.installEventFilter(self)
        self.pane.double_clicked.connect(lambda: self.enlarged.emit(self.column_id))
        self.grip.dragged.connect(lambda at, final: self.dragged.emit(self.column_id, at, final))
        self.grip.double_clicked.connect(lambda: self.command.emit(self.column_id, "rename"))
        self.foot.clicked.connect(lambda: self.chosen.emit(self.column_id))
        self.foot.details_wanted.connect(self.show_numbers)
        self.show_title("")

    def show_title(self, title: str) -> None:
        """Say what the column is."""
        if title == self._title:
            return
        self._title = title
        self.method_box.set_label(title)
        set_tip(self.method_box, f"{title}\nClick: another method for this column" if title else "The method")
        self._give_way()

    def set_badge(self, letter: str) -> None:
        """Say which of two compared columns it is; "" for none of them."""
        self.badge.setText(letter)
        self.badge.setVisible(bool(letter))

    def show_numbers(self) -> None:
        """Show every number about the picture."""
        if self.scene is not None:
            popup = NumbersPopup(self.method_box.label, self.scene, self.foot.before, self)
            popup.move(self.foot.mapToGlobal(self.foot.rect().topLeft()) - QPoint(0, popup.height()))
            popup.show()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the bar of progress at the lower edge of the picture."""
        super().resizeEvent(event)
        self._place_progress()
        self._give_way()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._give_way()

    def _give_way(self) -> None:
        """Leave the room above the picture to the title where one teaches and it is longer than what is left."""
        extras = self.grip.sizeHint().width() + self.run_button.sizeHint().width()
        needed = self.method_box.whole_width + self.menu_button.sizeHint().width() + extras
        room = self.contentsRect().width() - self.head.count() * self.head.spacing()
        self._gives_way = is_teaching() and needed > room
        self.grip.setVisible(not self._gives_way)
        self._show_buttons()

    def _show_buttons(self) -> None:
        busy = self.scene is not None and self.scene.status in ("running", "waiting")
        self.stop_button.setVisible(busy)
        self.run_button.setVisible(not busy and not self._gives_way)

    def _place_progress(self) -> None:
        height = self.progress.sizeHint().height()
        self.progress.setGeometry(0, self.pane.height() - height, self.pane.width(), height)

    def _button(self, text: str, tip: str, name: str) -> QToolButton:
        button = QToolButton()
        button.setText(text)
        set_tip(button, tip)
        button.setAccessibleName(tip)
        button.setAutoRaise(True)
        button.setObjectName(f"{name}-{self.column_id}")
        return button

    def _pane_clicked(self, row: int, column: int) -> None:
        self.chosen.emit(self.column_id)
        if row >= 0:
            self.pixel_clicked.emit(self.column_id, row, column)

    def leave(self) -> None:
        """Let go of everything that was shown: whoever may still hold the view holds no more than that."""
        self.pane.detach()
        self.pane.show_nothing()
        self.scene = None
        self._maps = ()

    def show_scene(self, scene: ColumnScene) -> None:
        """Show the state of the column; only what differs is touched."""
        if scene is self.scene:
            return
        before, self.scene = self.scene, scene
        if before is None or before.method != scene.method:
            with QSignalBlocker(self.method_box):
                self.method_box.setCurrentIndex(self.method_box.findData(scene.method))
            self.setAccessibleName(f"Column {scene.title}")
            self.pane.setAccessibleName(f"Result of {scene.title}")
            self.progress.setAccessibleName(f"Progress of {scene.title}")
        if before is None or before.picture is not scene.picture:
            self.pane.set_picture(scene.picture)
        running = scene.status == "running"
        self.progress.setVisible(running)
        if running:
            self._place_progress()
        self.progress.setValue(round(1000 * scene.fraction) if running else 0)
        self.foot.before = numbers_before(scene)
        self.foot.show_scene(scene)
        failed = scene.status == "failed"
        self.pane.set_note(scene.message if failed and scene.picture is None else "")
        role = "error" if failed else "muted"
        if self.line.property("role") != role:
            self.line.setProperty("role", role)
            _polish(self.line)
        busy = scene.status in ("running", "waiting")
        self._show_buttons()
        self.actions_by_name["go-on"].setEnabled(scene.resumable and not busy)
        for name in ("export", "use"):
            self.actions_by_name[name].setEnabled(scene.result is not None)
        self.actions_by_name["copy"].setEnabled(scene.picture is not None)
        self.actions_by_name["pin"].setChecked(scene.pinned)
        self.actions_by_name["own-seed"].setChecked(scene.seed is not None)
        self._set_flag("failed", failed)

    def show_maps(self, maps: tuple[tuple[str, str], ...], chosen: str) -> None:
        """Offer the maps (name, title) as overlays."""
        if (maps, chosen) == self._maps:
            return
        self._maps = (maps, chosen)
        self.map_menu.clear()
        self.map_menu.setEnabled(bool(maps))
        for name, title in (("", "None"), *maps):
            action = self.map_menu.addAction(title)
            action.setObjectName(f"map-{name or 'none'}-{self.column_id}")
            action.setCheckable(True)
            action.setChecked(name == chosen)
            action.setActionGroup(self.map_group)
            action.triggered.connect(lambda _=False, name=name: self.map_chosen.emit(self.column_id, name))

    def set_chosen(self, chosen: bool) -> None:
        """Frame the chosen column."""
        self._set_flag("chosen", chosen)

    def _set_flag(self, name: str, value: bool) -> None:
        if self.property(name) != value:
            self.setProperty(name, value)
            _polish(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Choose the column with whatever of its card is pressed: texts and buttons keep presses to themselves."""
        if event.type() == QEvent.Type.MouseButtonPress:
            self.chosen.emit(self.column_id)
        return super().eventFilter(watched, event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the column."""
        super().mousePressEvent(event)
        self.chosen.emit(self.column_id)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Choose the column."""
        super().focusInEvent(event)
        self.chosen.emit(self.column_id)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Show the column's menu."""
        self.chosen.emit(self.column_id)
        self.menu.popup(event.globalPos())


def _polish(widget: QWidget) -> None:
    widget.style().unpolish(widget)
    widget.style().polish(widget)
