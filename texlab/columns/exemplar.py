"""The exemplar: the whole scaled source with a crop box, its scale, and its name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyqtgraph as pg
import shiboken6
from PySide6.QtCore import QEvent, QObject, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent
from PySide6.QtWidgets import QMenu, QSizePolicy, QToolButton

from texlab.columns.cell import Cell
from texlab.columns.exemplar_panel import ExemplarPanel
from texlab.columns.foot import Foot
from texlab.state.changes import as_a_whole, at_full_size, reduced_words
from texlab.style.text_size import follow_text, is_teaching, text_scale
from texlab.widgets.number_box import ShareBox
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.settling import Settling
from texlab.widgets.short_box import ShortBox
from texlab_core.engine.inputs import Crop
from texlab_core.images.unit_range import use_of_alpha

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtGui import QContextMenuEvent, QResizeEvent
    from PySide6.QtWidgets import QWidget

    from texlab.state.chosen import Sample
    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme
    from texlab.widgets.view_link import ViewLink

MIN_CROP = 8
SETTLE_MS = 300
# Half the side of a handle of the crop, in pixels beside text of the usual size.
HANDLE = 5
_ARROWS = {
    Qt.Key.Key_Up: (-1, 0),
    Qt.Key.Key_Down: (1, 0),
    Qt.Key.Key_Left: (0, -1),
    Qt.Key.Key_Right: (0, 1),
}
_TRANSPARENCY_WORDS = {
    "white": "Transparent pixels over white",
    "black": "Transparent pixels over black",
    "ignore": "Colours as stored, transparency ignored",
    "keep": "Colours as stored, transparency kept for the result",
}
_STEPS = {
    Qt.KeyboardModifier.NoModifier: 1,
    Qt.KeyboardModifier.ShiftModifier: 1,
    Qt.KeyboardModifier.ControlModifier: 8,
}


class ExemplarView(Cell):
    """Shows the scaled source; the crop box recomputes everything while it is dragged.

    ``crop_changed(crop or None, final)``, ``scale_changed(scale)``, ``hovered(row, column)`` in the scaled source;
    ``part_shown()`` when another part is framed, after a drag at its end;
    ``whole_wanted(whole)`` for all of a large picture reduced, or its middle at full size;
    ``transparency_wanted(use)`` a key of ``TRANSPARENCY``; ``levels_changed(levels or None, look_only)``.
    """

    crop_changed = Signal(object, bool)
    whole_wanted = Signal(bool)
    transparency_wanted = Signal(str)
    scale_changed = Signal(float)
    levels_changed = Signal(object, bool)
    hovered = Signal(int, int)
    clicked = Signal(int, int)
    enlarged = Signal()
    part_shown = Signal()

    def __init__(self, link: ViewLink, parent: QWidget | None = None) -> None:
        super().__init__(Foot("exemplar-line", has_figures=False), link, 2, parent)
        self.title = Label("Exemplar", name="exemplar-title")
        self.title.setProperty("role", "heading")
        self.title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.crop_button = QToolButton()
        self.crop_button.setObjectName("crop-toggle")
        self.crop_button.setText("Crop")
        self.crop_button.setCheckable(True)
        self.crop_button.setAutoRaise(False)
        set_tip(
            self.crop_button,
            "Use a part of the picture (X): drag the box or its edges. Arrow keys move it, by 8 pixels with Ctrl; "
            "with Shift they resize it.",
        )
        self.scale_box = ShareBox()
        self.scale_box.setObjectName("scale-box")
        self.scale_box.setAccessibleName("Scale of the exemplar")
        set_tip(
            self.scale_box,
            "Scale of the picture before it is cropped. Photographs are usually too large for these methods: "
            "a texture element should be 10 to 40 pixels wide.",
        )
        self.scale_box.setRange(0.01, 1.0)
        self.scale_box.setSingleStep(0.05)
        self.more = QToolButton()
        self.more.setObjectName("exemplar-more")
        self.more.setText("⋯")
        self.more.setAutoRaise(True)
        self.more.setAccessibleName("Crop in numbers, and levels")
        set_tip(self.more, "The crop in numbers, work at 100 %, black, white and gamma")
        self.more.clicked.connect(self.open_panel)
        self.panel = ExemplarPanel(self)
        self.pane.setObjectName("pane-exemplar")
        self.pane.setAccessibleName("Exemplar")
        self.setAccessibleName("Exemplar with its crop and scale")
        self._box = self._make_box()
        self._name = ""
        self._crop: Crop | None = None
        self._size: tuple[int, int] | None = None
        follow_text(self, self._resize_box)
        self._rest = Settling(self, SETTLE_MS, self._settle)
        self.pane.installEventFilter(self)
        self.choices = QToolButton()
        self.choices.setObjectName("exemplar-choices")
        self.choices.setAutoRaise(True)
        self.choices.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.choices.setMenu(QMenu(self.choices))
        self.choices.setStyleSheet("QToolButton::menu-indicator { image: none; }")
        self.choices.hide()
        self.head.addWidget(self.title, 1)
        self.head.addWidget(self.crop_button)
        self.head.addWidget(self.scale_box)
        self.head.addWidget(self.choices)
        self.head.addWidget(self.more)
        # The row is as high as those of the columns.
        button = QToolButton()
        button.setText("▶■⋯")
        self.lay_out(ShortBox(), button)
        self.crop_button.clicked.connect(self._toggle)
        self.scale_box.valueChanged.connect(self.scale_changed)
        self.panel.crop_wanted.connect(lambda crop: self.crop_changed.emit(crop, True))
        self.panel.scale_wanted.connect(self.scale_changed)
        self.panel.levels_wanted.connect(self.levels_changed)
        self.pane.hovered.connect(self.hovered)
        self.pane.clicked.connect(self.clicked)
        self.pane.double_clicked.connect(self.enlarged)

    @property
    def crop(self) -> Crop | None:
        """The part that is framed."""
        return self._crop

    def set_quiet(self, quiet: bool) -> None:
        """Leave the room above the picture to its name, or show what is turned there again."""
        for each in (self.crop_button, self.scale_box):
            each.setVisible(not quiet)
        self._elide()

    def show_source(self, picture: Picture | None) -> None:
        """Show the scaled source."""
        if picture is not self.pane.picture:
            self.pane.set_picture(picture)

    def show_choice(self, name: str, parts: Sequence[str], scale: float, crop: Crop | None) -> None:
        """Show name, size and notes, scale and crop without emitting anything."""
        self._name = name
        set_tip(self.title, name)
        self._elide()
        self.line.show_parts(parts)
        with QSignalBlocker(self.scale_box):
            self.scale_box.setValue(scale)
        with QSignalBlocker(self.crop_button):
            self.crop_button.setChecked(crop is not None)
        self._show_crop(crop)

    def offer(self, sample: Sample) -> None:
        """Offer the other choices for a picture that was reduced, cut or has transparency; nothing for others."""
        from texlab_core.images.exemplar import scaled_size

        # A crop is of the sample in use, whose picture may still be on its way.
        self._size = scaled_size(*sample.source.size, sample.scale)
        whole, part = as_a_whole(sample), at_full_size(sample)
        is_large, use = whole.scale < 1, use_of_alpha(sample.source.notes)
        self.choices.setVisible(is_large or use is not None)
        self.choices.setText("▾" if use is None else "α")
        name = f"{reduced_words(sample) or 'The part and the transparency in use'}; change"
        self.choices.setAccessibleName(name)
        set_tip(self.choices, name)
        menu = self.choices.menu()
        menu.clear()
        crop = part.crop
        if is_large and crop is not None:
            for text, wanted, now in (
                (f"The whole picture at {100 * whole.scale:.3g} %", True, whole),
                (f"Its middle at full size, {crop.width} x {crop.height} pixels", False, part),
            ):
                action = menu.addAction(text)
                action.setObjectName("exemplar-whole" if wanted else "exemplar-part")
                action.setCheckable(True)
                action.setChecked(sample == now)
                action.triggered.connect(lambda _=False, wanted=wanted: self.whole_wanted.emit(wanted))
        if use is not None:
            menu.addSeparator()
            for key, text in _TRANSPARENCY_WORDS.items():
                action = menu.addAction(text)
                action.setObjectName(f"exemplar-alpha-{key}")
                action.setCheckable(True)
                action.setChecked(sample.alpha == key)
                action.triggered.connect(lambda _=False, key=key: self.transparency_wanted.emit(key))

    def open_panel(self) -> None:
        """Let crop and levels be typed."""
        self.panel.adjustSize()
        self.panel.move(self.mapToGlobal(self.more.geometry().bottomLeft()))
        self.panel.show()
        self.panel.boxes["x"].setFocus()
        # What is typed first takes the place of what stands there.
        self.panel.boxes["x"].selectAll()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Offer what can be done with the exemplar."""
        menu = QMenu(self)
        menu.setObjectName("exemplar-menu")
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for button in (
            self.crop_button,
            self.panel.powers_button,
            self.panel.whole_button,
            self.panel.full_button,
        ):
            action = menu.addAction(button.text())
            action.setEnabled(button.isEnabled())
            action.triggered.connect(button.click)
        menu.addAction("Crop in numbers, levels ...").triggered.connect(self.open_panel)
        if not self.choices.isHidden():
            menu.addSeparator()
            menu.addActions(self.choices.menu().actions())
        menu.popup(event.globalPos())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Shorten the name to the room there is."""
        super().resizeEvent(event)
        self._elide()

    def _elide(self) -> None:
        metrics = self.title.fontMetrics()
        # Where one teaches, the name comes first; the menu of the picture opens the same panel.
        needed = metrics.horizontalAdvance(self._name) + self.more.sizeHint().width() + self.head.spacing() + 8
        self.more.setVisible(not (is_teaching() and needed > self.width()))
        self.head.activate()
        room = self.title.width()
        # From afar the beginning of a name says more than its end; the tip has all of it.
        side = Qt.TextElideMode.ElideRight if is_teaching() else Qt.TextElideMode.ElideMiddle
        self.title.setText(metrics.elidedText(self._name, side, room))

    def _make_box(self) -> Any:
        """Make the crop box, once: it comes and goes with every crop."""
        box = pg.RectROI([0, 0], [1, 1], sideScalers=True, pen=self._pen(), snapSize=1.0)
        for corner, opposite in (
            ([0, 0], [1, 1]),
            ([1, 0], [0, 1]),
            ([0, 1], [1, 0]),
            ([0, 0.5], [1, 0.5]),
            ([0.5, 0], [0.5, 1]),
        ):
            box.addScaleHandle(corner, opposite)
        for handle in box.getHandles():
            # Nobody sees these menus; without a parent nobody would delete them, and later the window owns them.
            shiboken6.delete(handle.menu)
        box.sigRegionChanged.connect(lambda: self._dragged(final=False))
        box.sigRegionChangeFinished.connect(lambda: self._dragged(final=True))
        box.hide()
        self.pane.view.addItem(box, ignoreBounds=True)
        return box

    def _show_crop(self, crop: Crop | None) -> None:
        if crop == self._crop and (crop is not None) == self._box.isVisible():
            return
        self._crop = crop
        self._box.setVisible(crop is not None)
        if crop is not None:
            with QSignalBlocker(self._box):
                self._box.setPos([crop.left, crop.top], update=False)
                self._box.setSize([crop.width, crop.height])
                self._box.stateChanged(finish=False)
        self.part_shown.emit()

    def _pen(self) -> Any:
        return pg.mkPen(QColor("#ffd54a"), width=2 * text_scale(self))

    def _resize_box(self) -> None:
        """Make frame and handles as thick and large as the text asks for."""
        scale = text_scale(self)
        self._box.setPen(self._pen())
        for handle in self._box.getHandles():
            handle.radius = HANDLE * scale
            for name in ("pen", "hoverPen"):
                getattr(handle, name).setWidthF(scale)
            handle.currentPen = handle.pen
            handle.buildPath()
            handle.viewTransformChanged()
            handle.update()

    def _toggle(self, on: bool) -> None:
        if self._size is None:
            self.crop_button.setChecked(False)
            return
        if not on:
            self.crop_changed.emit(None, True)
            return
        height, width = self._size
        rows, columns = max(height // 2, min(height, MIN_CROP)), max(width // 2, min(width, MIN_CROP))
        self.crop_changed.emit(Crop((height - rows) // 2, (width - columns) // 2, rows, columns), True)

    def _dragged(self, *, final: bool) -> None:
        if self._size is None or not self._box.isVisible():
            return
        height, width = self._size
        position, size = self._box.pos(), self._box.size()
        columns = min(max(round(abs(size.x())), MIN_CROP), width)
        rows = min(max(round(abs(size.y())), MIN_CROP), height)
        left = min(max(round(position.x()), 0), width - columns)
        top = min(max(round(position.y()), 0), height - rows)
        crop = Crop(top, left, rows, columns)
        if final:
            # The box itself snaps to what is used once the button is up.
            self._crop = None
            self._show_crop(crop)
        self._crop = crop
        self.crop_changed.emit(crop, final)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Move and resize the box with the arrow keys."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress and self._crop is not None:
            down, right = _ARROWS.get(Qt.Key(event.key()), (0, 0))
            held = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
            if (down or right) and held in _STEPS:
                self._nudge(down * _STEPS[held], right * _STEPS[held], held == Qt.KeyboardModifier.ShiftModifier)
                return True
        return super().eventFilter(watched, event)

    def _nudge(self, down: int, right: int, resize: bool) -> None:
        crop = self._crop
        if self._size is None or crop is None:
            return
        height, width = self._size
        rows, columns, top, left = crop.height, crop.width, crop.top, crop.left
        if resize:
            rows = min(max(rows + down, min(MIN_CROP, height)), height - top)
            columns = min(max(columns + right, min(MIN_CROP, width)), width - left)
        else:
            top = min(max(top + down, 0), height - rows)
            left = min(max(left + right, 0), width - columns)
        moved = Crop(top, left, rows, columns)
        if moved != crop:
            self._show_crop(moved)
            # Keys have no release worth waiting for: they settle after a moment.
            self._rest.start()
            self.crop_changed.emit(moved, False)

    def _settle(self) -> None:
        if self._crop is not None:
            self.crop_changed.emit(self._crop, True)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        super().set_theme(theme)
        self.panel.set_theme(theme)
