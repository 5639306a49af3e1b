"""What the experiments of the laboratory share: pictures side by side, and a plane on which a place is dragged."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QVBoxLayout, QWidget

from texlab.docks.frame import FramedDock
from texlab.style.numbers import number
from texlab.style.pictures import to_picture
from texlab.style.text_size import is_teaching
from texlab.widgets.headed import SLACK, headed
from texlab.widgets.number_box import NumberBox
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import FittedLabel, Label, set_tip
from texlab.widgets.plane_pane import PlanePane
from texlab.widgets.plots import Plot
from texlab.widgets.view_link import ViewLink
from texlab_core.errors import Cancelled
from texlab_core.transforms.luma import luma

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray
    from PySide6.QtCore import QEvent, QPointF
    from PySide6.QtGui import QResizeEvent

    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme
    from texlab.widgets.number_box import WholeBox
    from texlab_core.engine.steps import FloatImage


# Figures show no more of an exemplar than this many pixels a side: they follow the pointer.
LARGEST = 640
MARGINS = (6, 0, 6, 6)


class LabPage(FramedDock):
    """One experiment: a dock inside the laboratory's tab."""

    within: ClassVar[str] = "lab"
    # The figures follow the pointer.
    rest_ms: ClassVar[int] = 0
    heavy: ClassVar[bool] = True

    def clear_shown(self) -> None:
        """Empty the pictures, and what the pointer reads in them."""
        super().clear_shown()
        for pictures in self.body.findChildren(Pictures):
            pictures.show_pictures(())
        for plot in self.body.findChildren(Plot):
            plot.clear()

    def drop_kept(self) -> None:
        """Keep the rest: what was made of an exemplar goes with it, and all else is of no exemplar."""

    def add_real(
        self,
        name: str,
        label: str,
        tip: str,
        limits: tuple[float, float, float],
        changed: Callable[[], Any],
        suffix: str = "",
    ) -> NumberBox:
        """Add a number with its label inside the box; ``limits`` are the lowest, the highest and the step."""
        box = NumberBox()
        low, high, step = limits
        box.setDecimals(2 if step < 0.1 else 1 if step < 1 else 0)
        box.setRange(low, high)
        box.setSingleStep(step)
        box.setPrefix(f"{label} ")
        box.setSuffix(suffix)
        box.valueChanged.connect(lambda _: changed())
        self.add_control(box, name, label, tip)
        return box

    def add_angle(
        self, name: str, label: str, tip: str, limits: tuple[int, int], value: int, changed: Callable[[], Any]
    ) -> WholeBox:
        """Add an angle in degrees; one that goes all the way around goes on at the other end."""
        box = self.add_number(name, label, tip, limits, changed)
        box.setSuffix("°")
        box.setWrapping(limits in ((0, 179), (0, 359)))
        box.setValue(value)
        return box

    def add_again(self, label: str, tip: str) -> None:
        """Add a button that draws once more; ``seed`` says with what."""
        self.seed = 0
        self.again = self.add_button("again", label, tip, self._again)

    def _again(self) -> None:
        self.seed += 1
        self.ask()

    def lay_out(self, count: int, *, linked: bool = True, words: bool = False, readout: bool = True) -> None:
        """Fill the body with pictures side by side, whose values the pointer reads, and words below them."""
        self.pictures = Pictures(f"{self.name}-pictures", count, linked=linked)
        if readout:
            self.readout = self.add_readout()
            self.pictures.hovered.connect(lambda *at: self.readout.setText(self.pictures.told(*at)))
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(*MARGINS)
        layout.addWidget(self.pictures, 1)
        if words:
            layout.addWidget(self.make_words())

    def make_words(self) -> FittedLabel:
        """Return the place for words about the pictures."""
        self.words = FittedLabel()
        return self.words


def plane_of(pixels: FloatImage) -> NDArray[Any]:
    """Return the luma of an exemplar, (H, W) float32: of its middle where a figure would not show it whole."""
    height, width = pixels.shape[:2]
    top, left = max(0, (height - LARGEST) // 2), max(0, (width - LARGEST) // 2)
    return luma(pixels[top : top + LARGEST, left : left + LARGEST])


def looker(should_stop: Callable[[], bool]) -> Callable[[], None]:
    """Return what long computations call between their pieces: it raises when they are to stop."""

    def look() -> None:
        if should_stop():
            raise Cancelled

    return look


@dataclass(frozen=True, eq=False)
class Shown:
    """One picture with its heading.

    Parameters
    ----------
    title
        Heading.
    picture
        (H, W, 3) uint8.
    values
        (H, W) numbers that the pointer reads; None reads nothing.
    unit
        Behind the number.
    tip
        What the picture is, in more words than the heading has room for.
    """

    title: str
    picture: Picture
    values: NDArray[Any] | None = None
    unit: str = ""
    tip: str = ""

    @classmethod
    def of(cls, title: str, image: FloatImage, values: NDArray[Any] | None = None, unit: str = "") -> Shown:
        """Return a picture of an image (H, W, C) in [0, 1]."""
        return cls(title, to_picture(image), values, unit)


@dataclass(frozen=True, eq=False)
class Told:
    """Pictures, and what they say."""

    shown: tuple[Shown, ...]
    words: str


# Ten of them stand side by side, also in a small window.
SMALLEST = 24, 40
SPACING = 4
# Another arrangement is worth it when pictures become so many times as large.
WORTH = 1.15


def best_columns(
    count: int, width: int, height: int, heading: int, words: Sequence[int] = (), titles: Sequence[int] = ()
) -> int:
    """Return how many of ``count`` square pictures with headings stand side by side where they are largest.

    All of them do unless more rows make them clearly larger, or the widest words of the headings, ``words`` pixels
    each, have no room side by side. In narrow columns headings of ``titles`` pixels take more lines, ``heading``
    pixels high. All sizes are in pixels.
    """

    def side(across: int) -> float:
        rows = -(-count // across)
        across_each, down_each = (width + SPACING) / across - SPACING, (height + SPACING) / rows - SPACING
        lines = max((math.ceil(each / max(across_each, 1)) for each in titles), default=1)
        return min(across_each, down_each - lines * heading)

    def has_room(across: int) -> bool:
        return sum(max(words[place::across], default=0) + SPACING for place in range(across)) <= width + SPACING

    fitting = [across for across in range(1, count + 1) if not words or has_room(across)] or [1]
    most = max(fitting)
    best = max(fitting, key=lambda across: (side(across), across))
    return best if side(best) > WORTH * max(side(most), 1.0) else most


class Pictures(QWidget):
    """Pictures with headings, side by side; ``hovered(index, row, column)``, -1 beside any."""

    hovered = Signal(int, int, int)
    clicked = Signal(int, int, int)

    def __init__(self, name: str, count: int, *, linked: bool = True) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAccessibleName("Pictures of the experiment")
        self.shown: tuple[Shown, ...] = ()
        self.panes: list[PicturePane] = []
        self.titles: list[Label] = []
        self._parts: list[QWidget] = []
        link = ViewLink() if linked else None
        self._grid = grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(SPACING)
        self._across = count
        for index in range(count):
            pane = PicturePane(f"{name}-{index}", f"Picture {index + 1}", link)
            pane.setMinimumSize(*SMALLEST)
            pane.hovered.connect(lambda row, column, index=index: self.hovered.emit(index, row, column))
            pane.clicked.connect(lambda row, column, index=index: self.clicked.emit(index, row, column))
            title = Label("")
            part = headed(title, pane)
            grid.addWidget(part, 0, index)
            grid.setColumnStretch(index, 1)
            self.panes.append(pane)
            self.titles.append(title)
            self._parts.append(part)

    def show_pictures(self, shown: Sequence[Shown]) -> None:
        """Show these, and hide the panes beyond."""
        self.shown = tuple(shown[: len(self.panes)])
        for index, (pane, title, part) in enumerate(zip(self.panes, self.titles, self._parts, strict=True)):
            each = self.shown[index] if index < len(self.shown) else None
            part.setVisible(each is not None)
            pane.set_picture(None if each is None else each.picture)
            title.setText("" if each is None else each.title)
            set_tip(title, "" if each is None else each.tip or each.title)
        self._arrange()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Stand in the rows in which the pictures are largest."""
        super().resizeEvent(event)
        self._arrange()

    def _arrange(self) -> None:
        count = len(self.shown) or len(self.panes)
        metrics = self.fontMetrics()
        words: list[int] = []
        titles: list[int] = []
        if is_teaching():
            longest = ([metrics.horizontalAdvance(word) for word in each.title.split()] for each in self.shown)
            words = [max(each, default=0) + SLACK for each in longest]
            titles = [metrics.horizontalAdvance(each.title) + SLACK for each in self.shown]
        across = best_columns(count, self.width(), self.height(), metrics.lineSpacing(), words, titles)
        if across == self._across:
            return
        grid, last = self._grid, max(across, self._across)
        self._across = across
        for index, part in enumerate(self._parts):
            grid.addWidget(part, index // across, index % across)
        for place in range(last):
            grid.setColumnStretch(place, int(place < across))
        for place in range(len(self._parts)):
            grid.setRowStretch(place, int(place * across < count))

    def told(self, index: int, row: int, column: int) -> str:
        """Return the value under the pointer in words."""
        if row < 0 or index >= len(self.shown):
            return ""
        each = self.shown[index]
        if each.values is None or row >= each.values.shape[0] or column >= each.values.shape[1]:
            return ""
        return f"{each.title}, {column}, {row}: {number(float(each.values[row, column]))}{each.unit}"

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        for pane in self.panes:
            pane.set_theme(theme)


class DragPlane(PlanePane):
    """A plane on which the left button drags a place: ``dragged(x, y, final)``; the wheel zooms as elsewhere."""

    dragged = Signal(float, float, bool)

    def __init__(self, name: str, label: str) -> None:
        super().__init__(name, label)
        self._dragging = False

    def mousePressEvent(self, event: Any) -> None:
        """Begin to drag."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._dragging = True
            self._tell(event, final=False)
            event.accept()
        else:
            super().mousePressEvent(event)

    def mouseMoveEvent(self, event: Any) -> None:
        """Drag on."""
        if self._dragging:
            self._tell(event, final=False)
            event.accept()
        else:
            super().mouseMoveEvent(event)

    def mouseReleaseEvent(self, event: Any) -> None:
        """End the drag."""
        if self._dragging and event.button() == Qt.MouseButton.LeftButton:
            self._dragging = False
            self._tell(event, final=True)
            event.accept()
        else:
            super().mouseReleaseEvent(event)

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the pointer has left."""
        if not self._dragging:
            super().leaveEvent(event)

    def _tell(self, event: Any, *, final: bool) -> None:
        place: QPointF = self.view_place(event.position().toPoint())
        self.dragged.emit(place.x(), place.y(), final)
