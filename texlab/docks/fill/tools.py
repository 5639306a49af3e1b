"""The tools of the Fill panel: what is painted with, what is copied from, and what is done."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QMenu, QProgressBar, QPushButton

from texlab.docks.fill.margins import MarginsButton
from texlab.docks.fill.mask_canvas import DEFAULT_RADIUS, MaskCanvas
from texlab.docks.fill.masks import read_mask
from texlab.docks.frame import FramedDock
from texlab.state.intentions import AskOnce, StopFill, TakeStage, Tell
from texlab.widgets.number_box import WholeBox

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray
    from PySide6.QtCore import QPoint


_TOOLS = [("Brush", "brush"), ("Rubber", "rubber"), ("Box", "rectangle"), ("Lasso", "lasso")]
_TARGETS = [("Hole to fill", "mask"), ("Region to copy from", "region")]
_WHERE = [
    ("Whole picture, at its own size", "photo"),
    ("Exemplar, into a column", "exemplar"),
    ("Chosen column, into a column", "column"),
]
_FROM = [("Copy from around the hole", "near"), ("Copy from the chosen column's result", "column")]
_MASKS = "Images (*.png *.tif *.tiff *.webp *.bmp *.pgm)"


class FillTools(FramedDock):
    """The controls and the two canvases; what the buttons do is up to :class:`FillDock`."""

    def build(self) -> Iterator[None]:
        """Make the tools and the two canvases."""
        self.canvases = {
            "mask": MaskCanvas("fill-mask", "Paint the hole", self.body),
            "region": MaskCanvas("fill-region", "Paint the region to copy from", self.body),
        }
        yield
        self.where = self.add_choice(
            "where",
            "Picture",
            "What is filled: the whole picture at its own resolution, here; or the exemplar as it is used, or the "
            "chosen column's result, in a column",
            _WHERE,
            self._where_changed,
        )
        self.target = self.add_choice(
            "target",
            "What is painted",
            "The hole that is filled, or the part that may be copied (all of it when unpainted)",
            _TARGETS,
            self._target_changed,
        )
        self.tool = self.add_choice("tool", "Tool", "What the left button paints with", _TOOLS, self._tool_changed)
        self.radius = WholeBox()
        self.radius.setRange(1, 512)
        self.radius.setValue(DEFAULT_RADIUS)
        self.radius.setPrefix("radius ")
        self.add_control(self.radius, "radius", "Radius", "Radius of the brush, in pixels of the picture")
        self.hardness = WholeBox()
        self.hardness.setRange(0, 100)
        self.hardness.setValue(100)
        self.hardness.setPrefix("hard ")
        self.hardness.setSuffix(" %")
        tip = "How much of the brush marks in full; towards its edge the fill mixes with what was there"
        self.add_control(self.hardness, "hardness", "Hardness", tip)
        for box in (self.radius, self.hardness):
            box.valueChanged.connect(self._tool_changed)
        tip = "What is copied: the picture around the hole, or another image"
        self.source = self.add_choice("from", "Copy from", tip, _FROM, self._update)
        self.other_button = self.add_button(
            "other", "Another image ...", "Copy from an image that is opened for it", self._open_other
        )
        self.reach = WholeBox()
        self.reach.setRange(16, 1024)
        self.reach.setValue(64)
        self.reach.setPrefix("reach ")
        self.reach.setSuffix(" px")
        self.add_control(self.reach, "reach", "Reach", "How far around a hole is copied from, in pixels")
        self.undo_button = self.add_button(
            "undo", "Undo", "Take the last stroke back (Ctrl+Z on the picture), then the last fill", self._undo
        )
        self.add_button("clear", "Clear", "Unmark everything", lambda: self._replace(lambda mask: mask & False))
        self.add_button("invert", "Invert", "Mark what is not marked", lambda: self._replace(np.logical_not))
        self.add_button(
            "load", "Load mask ...", "Mark what is transparent in a picture, or bright in one without", self._load
        )
        self.fill_button = self.add_button("run", "Fill", "Fill the hole", self._fill)
        self.stop_button = self.add_button("stop", "Stop", "Stop filling", lambda: self.intention.emit(StopFill()))
        self.again_button = self.add_button(
            "again", "Another try", "Take the last fill back and make another one with the next seed", self._again
        )
        self.grow_button = self.add_button(
            "grow", "Grow outward", "Grow the picture to the size in the tool bar, and fill its hole", self._grow
        )
        self.margins = MarginsButton()
        tip = "Grow the picture outward by so many pixels on each side, and fill its hole"
        self.add_control(self.margins, "margins", "Grow by margins ...", tip)
        self.margins.grow_wanted.connect(self._grow_by)
        self.save_button = self.add_button(
            "save", "Save picture ...", "Save the filled picture with its recipe, as deep as it was", self._save
        )
        self.use_button = self.add_button(
            "use", "Use as exemplar", "Make the filled picture the exemplar", self._use
        )
        self.stage_switch = self.add_button(
            "stage-over", "On the stage", "Over the whole stage, or back (Shift+F4)", self._take_stage
        )
        self.progress = QProgressBar()
        self.progress.setRange(0, 1000)
        self.progress.setFixedWidth(120)
        self.add_control(self.progress, "progress", "Progress of the fill", "How far the fill is")
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        for key, canvas in self.canvases.items():
            canvas.setVisible(key == "mask")
            layout.addWidget(canvas)
            canvas.changed.connect(self._update)
            canvas.menu_wanted.connect(self._show_menu)

    # For the panel.

    @abstractmethod
    def _where_changed(self) -> None:
        """Show what is filled: this picture by itself, or holes of the column's result."""

    @abstractmethod
    def _open_other(self) -> None:
        """Open the picture that is copied from."""

    @abstractmethod
    def _undo(self) -> None:
        """Take the last stroke or fill back."""

    @abstractmethod
    def _fill(self) -> None:
        """Fill the hole."""

    @abstractmethod
    def _again(self) -> None:
        """Fill it once more with the next seed."""

    @abstractmethod
    def _grow(self) -> None:
        """Grow the picture to the size in the tool bar."""

    @abstractmethod
    def _grow_by(self, margins: Any) -> None:
        """Grow the picture by margins: top, bottom, left, right."""

    @abstractmethod
    def _save(self) -> None:
        """Save the filled picture."""

    @abstractmethod
    def _use(self) -> None:
        """Make the filled picture the exemplar."""

    @abstractmethod
    def _update(self, *_: object) -> None:
        """Show what can be done now."""

    # What is the same for every picture.

    @property
    def canvas(self) -> MaskCanvas:
        """The canvas that is painted on."""
        return self.canvases[self.target.currentData()]

    @property
    def by_itself(self) -> bool:
        """Whether the picture is filled here, and not in a column."""
        return bool(self.where.currentData() == "photo")

    def _target_changed(self) -> None:
        for key, canvas in self.canvases.items():
            canvas.setVisible(key == self.target.currentData())
        self._tool_changed()
        self._update()

    def _tool_changed(self, *_: object) -> None:
        for canvas in self.canvases.values():
            canvas.tool = self.tool.currentData()
            canvas.radius = self.radius.value()
            # A column takes a mask, which is marked or not.
            canvas.hardness = self.hardness.value() / 100 if self.by_itself else 1.0

    def _replace(self, change: Callable[[NDArray[np.bool_]], NDArray[np.bool_]]) -> None:
        self.canvas.set_mask(change(self.canvas.mask))

    def _show_menu(self, place: QPoint) -> None:
        menu = QMenu(self)
        menu.setObjectName("fill-menu")
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for button in (
            self.fill_button, self.again_button, self.undo_button,
            *(self._button(name) for name in ("clear", "invert", "load")), self.save_button, self.use_button,
        ):  # fmt: skip
            if button.isVisibleTo(self):
                action = menu.addAction(button.text())
                action.setEnabled(button.isEnabled())
                action.triggered.connect(button.click)
        menu.addAction("Fit the picture").triggered.connect(lambda: self.canvas.fit())
        menu.popup(place)

    def _button(self, name: str) -> QPushButton:
        found = self.findChild(QPushButton, f"{self.name}-{name}")
        assert isinstance(found, QPushButton)
        return found

    def _take_stage(self) -> None:
        self.intention.emit(TakeStage(self.name))

    def _load(self) -> None:
        path, _ = QFileDialog.getOpenFileName(self, "Load mask", "", _MASKS)
        if path:
            canvas, size = self.canvas, self.canvas.shares.shape

            def done(mask: NDArray[np.bool_]) -> None:
                if mask.shape == canvas.shares.shape:
                    canvas.set_mask(mask)
                else:
                    sentence = "The mask was read for another picture; load it again."
                    self.intention.emit(Tell(sentence, problem=True))

            self.intention.emit(AskOnce("mask", lambda should_stop: read_mask(path, size), done))
