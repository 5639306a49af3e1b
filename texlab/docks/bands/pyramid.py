"""Pyramid: the subbands of exemplar and result, one of them large, and the exemplar with other gains."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtWidgets import QBoxLayout, QButtonGroup, QHBoxLayout, QSplitter, QVBoxLayout, QWidget

from texlab.docks.bands import mosaic
from texlab.docks.bands.controls import KINDS, BandCache, PyramidControls, channel_items
from texlab.docks.bands.detail import BandDetail
from texlab.docks.bands.middle import middle_of
from texlab.docks.bands.mosaic_view import MosaicView
from texlab.docks.bands.pictures import PyramidAnswer, PyramidPictures, PyramidRequest
from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, LookedAt, replace_items
from texlab.docks.recent import Recent, Same
from texlab.style.numbers import number
from texlab.style.text_size import grow_with_text, text_scale
from texlab.widgets.own_keys import is_plain
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.view_link import ViewLink
from texlab_core.stats.bands import COLLAPSIBLE, band_keys
from texlab_core.transforms.filters import level_size

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from PySide6.QtCore import QObject
    from PySide6.QtGui import QKeyEvent, QResizeEvent

    from texlab.docks.bands.pictures import MosaicPicture
    from texlab.state.scene import Scene
    from texlab.style.theme import Theme
    from texlab_core.transforms.steerable import BandKey

NARROW = 760
GAINS = ((0.0, "Mute", "0"), (1.0, "×1", "1"), (2.0, "×2", "2"), (4.0, "×4", "4"))
SCALES = (("Own scales", False), ("One scale", True))
EDIT_TIP = "Mute or boost bands and see the exemplar put together again (E)"
VIEW_ONLY_TIP = "These bands are for looking at: they do not add up to the image exactly, so none can be muted"
LAYOUTS = (("Equal tiles", "equal"), ("Pyramid", "pyramid"))


class PyramidDock(FramedDock):
    """Shows mosaics of the subbands; a click shows a band large, edit mode mutes and boosts bands."""

    name = "pyramid"
    title = "Pyramid"
    help = "The subbands of exemplar and result; mute or boost them and see what they carry."
    order = 10
    heavy = True
    empty = "The pyramid appears as soon as there is an exemplar."

    def build(self) -> Iterator[None]:
        """Make the controls, the mosaics, the large band and the reconstruction."""
        self._pictures = PyramidPictures(BandCache(), Recent(2))
        self._selected: BandKey | None = None
        self._gains: dict[BandKey, float] = {}
        self._asked_columns = 0
        self._shapes = [(1, 1)]
        self._two = False
        self._make_controls()
        yield
        self.exemplar = MosaicView("pyramid-exemplar", "exemplar")
        self.result = MosaicView("pyramid-result", "result")
        for view in (self.exemplar, self.result):
            view.chosen.connect(lambda index, view=view: self._choose(view, index))
            view.hovered.connect(lambda index, row, column, view=view: self._hover(view, index, row, column))
            view.pane.view.sigRangeChangedManually.connect(lambda *_, view=view: self._follow_view(view))
        mosaics = QWidget()
        self._pair = QBoxLayout(QBoxLayout.Direction.TopToBottom, mosaics)
        self._pair.setContentsMargins(0, 0, 0, 0)
        self._pair.setSpacing(4)
        self._pair.addWidget(self.exemplar, 1)
        self._pair.addWidget(self.result, 1)
        yield
        self.detail = BandDetail()
        self.detail.closed.connect(self._close_detail)
        self.detail.told.connect(self.readout.setText)
        yield
        self.edited = QWidget()
        self._make_edited(self.edited)
        self.splitter = QSplitter(Qt.Orientation.Horizontal)
        self.splitter.setObjectName("pyramid-splitter")
        self.splitter.setChildrenCollapsible(False)
        for part, stretch in ((mosaics, 1), (self.detail, 1), (self.edited, 1)):
            self.splitter.addWidget(part)
            self.splitter.setStretchFactor(self.splitter.count() - 1, stretch)
        self._mosaics = mosaics
        mosaics.installEventFilter(self)
        self.detail.hide()
        self.edited.hide()
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.splitter)

    def _make_controls(self) -> None:
        self.pyramid = PyramidControls(self, tuple(KINDS))
        self.channel = self.add_choice(
            "channel", "Plane", "Which plane of the image: luma, a colour, or a principal axis", [], self.ask
        )
        tip = "Colours of each band by its own spread, or all by one: then weak bands look weak"
        self.scaling = self.add_choice("scaling", "Colour scale", tip, SCALES, self.ask)
        tip = "All bands equally large, or in the proportion of their sizes"
        self.layout_choice = self.add_choice("layout", "Arrangement", tip, LAYOUTS, self.ask)
        self.edit = self.add_switch("edit", "Edit", EDIT_TIP, self._edit_toggled)
        self._gain_group = QButtonGroup(self)
        for gain, label, key in GAINS:
            words = "Leave out the chosen band" if gain == 0 else f"Multiply the chosen band by {gain:g}"
            button = self.add_button(f"gain-{key}", label, f"{words} ({key})", partial(self._set_gain, gain))
            button.setCheckable(True)
            grow_with_text(button, 56, button.setMaximumWidth)
            self._gain_group.addButton(button, int(gain))
        self.reset = self.add_button("reset", "Reset", "All bands as they are", self._reset)
        self.readout = self.add_readout()
        self._show_gain_buttons(False)

    def _make_edited(self, parent: QWidget) -> None:
        link = ViewLink()
        self.original = PicturePane("pyramid-original", "Exemplar", link)
        self.reconstruction = PicturePane("pyramid-reconstruction", "Exemplar put together with these gains", link)
        row = QHBoxLayout(parent)
        row.setContentsMargins(0, 0, 0, 0)
        self._original_part = QWidget()
        parts = (
            (self._original_part, self.original, "exemplar"),
            (QWidget(), self.reconstruction, "put together again"),
        )
        for part, pane, title in parts:
            column = QVBoxLayout(part)
            column.setContentsMargins(0, 0, 0, 0)
            column.setSpacing(1)
            column.addWidget(Label(title))
            column.addWidget(pane, 1)
            row.addWidget(part)

    def paint_theme(self, theme: Theme) -> None:
        """Give every part its colours; the mosaics are drawn again for theirs."""
        super().paint_theme(theme)
        if self.answer is not None:
            self.ask()

    # Asking.

    def question(self, scene: Scene) -> Question | None:
        """Ask for mosaics of the exemplar and of the chosen column."""
        if scene.exemplar is None:
            return None
        exemplar = scene.exemplar.pixels
        result = self.looked_at(scene).with_channels(exemplar.shape[2])
        self.pyramid.follow(scene)
        replace_items(self.channel, channel_items(exemplar.shape[2]))
        shape = middle_of(exemplar).shape[:2]
        request = self._request(shape, has_result=result.channels > 0)
        if request.editing:
            result = LookedAt(None)
        pictures = self._pictures

        def compute(should_stop: Callable[[], bool]) -> PyramidAnswer:
            return pictures.answer(exemplar, result.values(), request, should_stop)

        return Question((self.name, Same(exemplar), result.key, request), compute)

    def _request(self, shape: tuple[int, int], *, has_result: bool) -> PyramidRequest:
        settings = self.pyramid.settings
        editable = settings.kind in COLLAPSIBLE
        self.edit.setEnabled(editable)
        set_tip(self.edit, EDIT_TIP if editable else VIEW_ONLY_TIP)
        editing = editable and self.edit.isChecked()
        keys = band_keys(settings.kind, settings.levels, settings.orientations)
        if self._selected not in keys:
            self._selected = None
        self._gains = {key: gain for key, gain in self._gains.items() if key in keys}
        self._shapes = [level_size(shape, key.level) for key in keys]
        self._two = has_result and not editing
        self._asked_columns = columns = self._columns()
        return PyramidRequest(
            settings,
            self.channel.currentData(),
            bool(self.scaling.currentData()),
            self.layout_choice.currentData(),
            columns,
            # Bands are nearly white where they are zero, as the light theme's canvas is.
            self.theme.canvas if self.theme.name == "dark" else self.theme.muted,
            None if editing else self._selected,
            editing,
            tuple(sorted(self._gains.items(), key=str)) if editing else (),
        )

    def _columns(self) -> int:
        """Turn the pair of mosaics so that the tiles become largest; return how many stand side by side."""
        height, width = self._area()
        if not self._two:
            return self._best_columns((height, width))[0]
        stacked, beside = (self._best_columns(area) for area in ((height // 2, width), (height, width // 2)))
        wide = beside[1] > stacked[1]
        ways = QBoxLayout.Direction
        self._pair.setDirection(ways.LeftToRight if wide else ways.TopToBottom)
        return (beside if wide else stacked)[0]

    def _best_columns(self, area: tuple[int, int]) -> tuple[int, float]:
        """Return the best number of columns for one mosaic in an area, and its scale."""
        equal = self.layout_choice.currentData() == "equal"
        find, arrange = (
            (mosaic.equal_columns, mosaic.equal_tiles) if equal else (mosaic.pyramid_columns, mosaic.pyramid_tiles)
        )
        columns = find(self._shapes, area)
        height, width = arrange(self._shapes, columns).size
        return columns, min(area[0] / height, area[1] / width)

    def _area(self) -> tuple[int, int]:
        """Return height and width of the room for both mosaics."""
        room = self._mosaics.size()
        if not self._mosaics.isVisible():
            # Not laid out yet: all of the dock but its controls.
            room = self.size() - QSize(12, self.controls.height() + 6)
        return max(room.height() - 20, 40), max(room.width(), 80)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Arrange the tiles anew when that makes them larger."""
        if (
            watched is self._mosaics
            and event.type() == QEvent.Type.Resize
            and self.answer is not None
            and self._columns() != self._asked_columns
        ):
            self.ask()
        return super().eventFilter(watched, event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave out what has no room."""
        super().resizeEvent(event)
        self._make_room()

    # Showing.

    def show_answer(self, answer: PyramidAnswer) -> None:
        """Show the mosaics, the large band or the reconstruction."""
        self.readout.setText("")
        gains = dict(answer.request.gains)
        self.exemplar.show_mosaic(answer.exemplar, gains)
        self.result.setVisible(answer.result is not None)
        if answer.result is not None:
            self.result.show_mosaic(answer.result, {})
        for view in (self.exemplar, self.result):
            view.select(self._index(view.shown))
        if answer.edited is not None:
            self.original.set_picture(answer.edited[0])
            self.reconstruction.set_picture(answer.edited[1])
        if answer.large is not None:
            self.detail.show_band(answer.large)
        self.detail.setVisible(answer.large is not None)
        self.edited.setVisible(answer.edited is not None)
        self._make_room()

    def _make_room(self) -> None:
        """Where the dock is narrow, the large band takes the place of the mosaics and the exemplar steps back."""
        narrow = self.width() < NARROW * text_scale(self)
        self._mosaics.setVisible(not (narrow and self.detail.isVisibleTo(self)))
        self._original_part.setVisible(not narrow)

    def _index(self, shown: MosaicPicture | None) -> int:
        if shown is None or self._selected is None:
            return -1
        return next((k for k, band in enumerate(shown.bands) if band.key == self._selected), -1)

    def _follow_view(self, source: MosaicView) -> None:
        """Pan and zoom the other mosaic alike when it is arranged alike."""
        other = self.result if source is self.exemplar else self.exemplar
        shown, beside = source.shown, other.shown
        if shown is not None and beside is not None and shown.layout.size == beside.layout.size:
            other.pane.show_rect(source.pane.view_rect())

    def _hover(self, view: MosaicView, index: int, row: int, column: int) -> None:
        if view.shown is None or index < 0:
            self.readout.setText("")
            return
        band = view.shown.bands[index]
        value = number(float(band.plane[row, column]))
        self.readout.setText(f"{view.name}, {band.title}, {column}, {row}: {value}")

    def clear_shown(self) -> None:
        """Empty the mosaics."""
        super().clear_shown()
        for view in (self.exemplar, self.result):
            view.forget()

    def drop_kept(self) -> None:
        """Empty the caches."""
        super().drop_kept()
        self._pictures.clear()

    # What the user does.

    def _choose(self, view: MosaicView, index: int) -> None:
        if view.shown is None:
            return
        self._selected = view.shown.bands[index].key
        for each in (self.exemplar, self.result):
            each.select(self._index(each.shown))
        self._check_gain()
        self.ask()

    def _close_detail(self) -> None:
        self._selected = None
        self.ask()
        self.exemplar.setFocus()

    def _edit_toggled(self, on: bool) -> None:
        self._show_gain_buttons(on)
        if on and self._selected is None and self.answer is not None:
            self._selected = self.answer.exemplar.bands[0].key
        self._check_gain()
        self.ask()

    def _show_gain_buttons(self, visible: bool) -> None:
        for button in (*self._gain_group.buttons(), self.reset):
            button.setVisible(visible)

    def _check_gain(self) -> None:
        gain = self._gains.get(self._selected, 1.0) if self._selected is not None else 1.0
        self._gain_group.button(int(gain)).setChecked(True)

    def _set_gain(self, gain: float) -> None:
        if self._selected is not None:
            self._gains.pop(self._selected, None)
            if gain != 1:
                self._gains[self._selected] = gain
            self._check_gain()
            self.ask()

    def _reset(self) -> None:
        self._gains.clear()
        self._check_gain()
        self.ask()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it closes the large band, edits, or sets the gain of the chosen band."""
        if not is_plain(event):
            return False
        if event.key() == Qt.Key.Key_Escape:
            return self.detail.isVisible()
        if event.key() == Qt.Key.Key_E:
            return self.edit.isEnabled()
        return self.edit.isChecked() and event.text() in {text for _, _, text in GAINS}

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc closes the large band; E edits; 0, 1, 2, 4 set the gain of the chosen band in edit mode."""
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif event.key() == Qt.Key.Key_Escape:
            self._close_detail()
        elif event.key() == Qt.Key.Key_E:
            self.edit.toggle()
        else:
            self._set_gain(float(event.text()))
