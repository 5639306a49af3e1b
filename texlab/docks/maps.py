"""Maps: where every pixel came from, how many candidates it had, which regions were copied."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QIcon, QPixmap
from PySide6.QtWidgets import (
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, replace_items
from texlab.docks.recent import Same
from texlab.style import colouring
from texlab.style.numbers import number
from texlab.style.text_size import grow_with_text
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.plots import ColourBar, pg
from texlab.widgets.slider import Slider
from texlab.widgets.tables import add_copying, list_text
from texlab_core.engine.late_maps import map_titles

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.state.scene import Scene
    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme
    from texlab_core.engine.steps import Map

REGIONS_LISTED = 12


@dataclass(frozen=True, eq=False)
class MapsAnswer:
    """A coloured map with what its legend needs; ``sizes`` are the pixels of every label."""

    shown: Map
    picture: Picture
    below: Picture | None
    extent: tuple[int, int] | None
    key: Picture | None = None
    scale: colouring.Scale | None = None
    regions: tuple[tuple[int, int], ...] = ()
    region: int = 0
    sizes: NDArray[np.int64] | None = None


def colour(shown: Map, below: Picture | None, extent: tuple[int, int] | None, region: int = 0) -> MapsAnswer:
    """Colour a map; ``region`` > 0 leaves only that label in colour."""
    picture = colouring.colour_map(shown, extent)
    if shown.kind == "source":
        height, width = extent or colouring.source_extent(shown.data)
        key = colouring.source_key(min(height, colouring.KEY_SIDE), min(width, colouring.KEY_SIDE))
        return MapsAnswer(shown, picture, below, (height, width), key=key)
    if shown.kind == "label":
        regions = tuple(colouring.label_sizes(shown.data, REGIONS_LISTED))
        picture = colouring.mark_edges(picture, shown.data)
        if region and any(label == region for label, _ in regions):
            picture[shown.data != region] //= 5
        sizes = np.bincount(np.maximum(shown.data, 0).ravel())
        return MapsAnswer(shown, picture, below, extent, regions=regions, region=region, sizes=sizes)
    return MapsAnswer(shown, picture, below, extent, scale=colouring.map_scale(shown))


class MapsDock(FramedDock):
    """Shows one map of the chosen column's result, over the result."""

    name = "maps"
    title = "Maps"
    help = "Where every pixel came from, how many candidates it had, what was copied."
    order = 40
    heavy = True
    empty = "Maps appear when a method that records them has finished."

    def build(self) -> None:
        """Make the chooser, the picture and the legends."""
        self.chooser = self.add_choice("map", "Map", "Which map of the result to show", [], self.ask)
        self.opacity = Slider("Opacity of the map", lambda share: f"{share} %")
        self.opacity.setRange(0, 100)
        self.opacity.setValue(100)
        grow_with_text(self.opacity, 110, self.opacity.setFixedWidth)
        self.opacity.valueChanged.connect(self._show_overlay)
        tip = "How strongly the map covers the result: all the way left shows the result alone"
        self.add_slider(self.opacity, "opacity", tip)
        self.readout = self.add_readout()

        self.pane = PicturePane("maps-pane", "Map over the result")
        self.pane.hovered.connect(self._hover)
        self.bar = ColourBar("maps-bar")
        self.key = PicturePane("maps-key", "Colour of every place of the exemplar")
        self.key.hovered.connect(self._hover_key)
        self.mark = pg.ScatterPlotItem(size=13, symbol="o", brush=None, pxMode=True)
        self.key.view.addItem(self.mark, ignoreBounds=True)
        self.regions = QListWidget()
        self.regions.setObjectName("maps-regions")
        self.regions.setAccessibleName("Largest regions")
        set_tip(self.regions, "The largest regions; choose one to see it alone, choose it again to see all")
        add_copying(self.regions, lambda: list_text(self.regions))
        self.regions.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.regions.itemActivated.connect(self._choose_region)
        self.regions.itemClicked.connect(self._choose_region)
        self._region = 0

        self.legend = QStackedWidget()
        key_page = QWidget()
        key_layout = QVBoxLayout(key_page)
        key_layout.setContentsMargins(0, 0, 0, 0)
        key_layout.addWidget(self.key, 1)
        key_label = Label("Place in the exemplar", muted=True)
        key_layout.addWidget(key_label)
        bar_page = QWidget()
        bar_layout = QVBoxLayout(bar_page)
        bar_layout.setContentsMargins(0, 0, 0, 0)
        bar_layout.addWidget(self.bar, 1)
        self.unit = Label(name="maps-unit", muted=True)
        bar_layout.addWidget(self.unit)
        for page in (key_page, bar_page, self.regions):
            self.legend.addWidget(page)
        self._key_page, self._bar_page = key_page, bar_page
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.pane, 3)
        layout.addWidget(self.legend, 1)
        grow_with_text(self.legend, 280, self.legend.setMaximumWidth)

    def paint_theme(self, theme: Theme) -> None:
        """Give panes and bar their colours."""
        super().paint_theme(theme)
        self.mark.setPen(pg.mkPen("#000000", width=2))

    def question(self, scene: Scene) -> Question | None:
        """Ask for the chosen map of the chosen column."""
        column = scene.selected
        result = column.result if column is not None else None
        if column is None or result is None or not result.maps:
            finished = column is not None and result is not None
            self.why = f"{column.title} records no maps." if column is not None and finished else ""
            self.controls.hide()
            return None
        self.controls.show()
        maps = result.maps
        replace_items(self.chooser, [(title, name) for name, title in map_titles(maps)])
        name = self.chooser.currentData()
        below = column.picture
        extent = scene.exemplar.size if scene.exemplar is not None else None
        region = self._region

        def compute(should_stop: Callable[[], bool]) -> MapsAnswer:
            return colour(maps[name].plane, below, extent, region)

        return Question((self.name, Same(result), name, region), compute)

    def show_answer(self, answer: MapsAnswer) -> None:
        """Show the map with its legend."""
        self.readout.setText("")
        same_size = answer.below is not None and answer.below.shape == answer.picture.shape
        self.pane.set_picture(answer.below if same_size else np.zeros_like(answer.picture))
        self._show_overlay()
        if answer.key is not None:
            self.key.set_picture(answer.key)
            self.legend.setCurrentWidget(self._key_page)
        elif answer.scale is not None:
            ticks = [(place, number(value)) for place, value in answer.scale.ticks()]
            self.bar.show_scale(colouring.map_table(answer.shown), ticks)
            self.unit.setText(answer.shown.unit)
            self.legend.setCurrentWidget(self._bar_page)
        else:
            self._list_regions(answer)
            self.legend.setCurrentWidget(self.regions)

    def _list_regions(self, answer: MapsAnswer) -> None:
        self.regions.clear()
        total = answer.shown.data.size
        highest = max((label for label, _ in answer.regions), default=0)
        table = colouring.label_table(highest + 1)
        for label, pixels in answer.regions:
            swatch = QPixmap(12, 12)
            swatch.fill(QColor(*(int(part) for part in table[label])))
            item = QListWidgetItem(QIcon(swatch), f"{pixels} px, {pixels / total:.1%}")
            item.setData(Qt.ItemDataRole.UserRole, label)
            self.regions.addItem(item)
            if label == answer.region:
                self.regions.setCurrentItem(item)
        if not answer.regions:
            self.regions.addItem("No regions")

    def _choose_region(self, item: QListWidgetItem) -> None:
        label = item.data(Qt.ItemDataRole.UserRole) or 0
        self._region = 0 if label == self._region else label
        self.ask()

    def _show_overlay(self, *_: object) -> None:
        if self.answer is not None:
            self.pane.set_overlay(self.answer.picture, self.opacity.value() / 100)

    def _hover(self, row: int, column: int) -> None:
        answer: MapsAnswer | None = self.answer
        self.mark.clear()
        if answer is None or row < 0:
            self.readout.setText("")
            self.bar.set_mark(None)
            return
        value = answer.shown.data[row, column]
        self.readout.setText(f"{column}, {row}: {describe(answer, value)}")
        if answer.scale is not None:
            self.bar.set_mark(float(answer.scale.place(value)))
        elif answer.key is not None and answer.extent is not None and min(value) >= 0:
            # Where the pixel came from is marked on the key.
            (height, width), (rows, columns) = answer.extent, answer.key.shape[:2]
            self.mark.setData([(value[1] + 0.5) * columns / width], [(value[0] + 0.5) * rows / height])

    def _hover_key(self, row: int, column: int) -> None:
        answer: MapsAnswer | None = self.answer
        if answer is None or answer.key is None or answer.extent is None or row < 0:
            self.readout.setText("")
            return
        height, width = answer.extent
        place = (column * width // answer.key.shape[1], row * height // answer.key.shape[0])
        self.readout.setText(f"exemplar {place[0]}, {place[1]}")


def describe(answer: MapsAnswer, value: Any) -> str:
    """Return the value of a pixel in words."""
    shown = answer.shown
    if shown.kind == "source":
        row, column = (int(part) for part in value)
        return "no source" if min(row, column) < 0 else f"from exemplar {column}, {row}"
    if shown.kind == "label":
        if value <= 0 or answer.sizes is None:
            return "no region"
        return f"region {int(value)}, {answer.sizes[value]} pixels"
    unit = f" {shown.unit}" if shown.unit else ""
    return f"{number(float(value))}{unit}"
