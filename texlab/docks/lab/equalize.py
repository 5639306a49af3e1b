"""Equalization of two images: both cumulative histograms, and the way of the value under the pointer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QVBoxLayout

from texlab.docks.base import Question
from texlab.docks.frame import replace_items, shown_image
from texlab.docks.lab.page import MARGINS, LabPage, Pictures, Shown
from texlab.docks.recent import Recent, Same
from texlab.style.numbers import number
from texlab.style.pictures import to_picture
from texlab.widgets.plots import Plot
from texlab_core.errors import Cancelled
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.gallery import gallery
from texlab_core.sheets.laboratory import gray
from texlab_core.stats import equalization
from texlab_core.stats.bands import band_keys, names, split
from texlab_core.transforms.luma import luma

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.state.scene import Scene
    from texlab_core.stats.equalization import Equalization, Ties

LEVELS, ORIENTATIONS = 3, 4
FILES = "Images (*.png *.jpg *.jpeg *.tif *.tiff *.webp *.bmp *.pgm *.ppm);;All files (*)"
BOOK = (("book: linear ramp", "ramp"), ("book: cube-root ramp", "cube-root"))
TIES = (("ties at random", "random"), ("ties together", "together"))


@dataclass(frozen=True, eq=False)
class EqualizeAnswer:
    """Both images, the equalization, and its result."""

    found: Equalization
    shown: tuple[Shown, Shown, Shown]
    distances: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Source:
    """One of the two images: pixels that are there already, or the name of what is to be read."""

    name: str
    pixels: NDArray[Any] | None
    band: int

    @property
    def key(self) -> tuple[Any, ...]:
        """What it depends on."""
        return self.name, Same(self.pixels), self.band

    def plane(self, recent: Recent) -> NDArray[np.float32]:
        """Return its values; reads and splits it, so not in the GUI thread."""
        if self.name == "ramp":
            plane = equalization.ramp()
        elif self.name == "cube-root":
            plane = equalization.cube_root_ramp()
        elif self.pixels is not None:
            levels = np.float32(255 if self.pixels.dtype == np.uint8 else 1)
            plane = luma(self.pixels.astype(np.float32) / levels)
        else:
            plane = luma(recent.get(self.name, lambda: as_exemplar(self.name)).pixels)
        if self.band < 0:
            return plane
        bands = split(plane, "steerable", LEVELS, ORIENTATIONS)
        return bands[min(self.band, len(bands) - 1)].plane


class EqualizePage(LabPage):
    """Gives one image the histogram of another."""

    name = "lab-equalize"
    title = "Equalization"
    help = "One image with another's histogram: follow a value v to its share p and to v' (Fig. 11.15)."
    empty = "Choose two images."

    def build(self) -> None:
        """Make the controls, the plots and the pictures."""
        self._recent = Recent(8)
        self._files: list[str] = []
        self.two = self.add_choice("two", "Image two", "The image whose values are changed", [], self.ask)
        self.one = self.add_choice("one", "Image one", "The image whose histogram is wanted", [], self.ask)
        bands: list[tuple[str, Any]] = [("pixels", -1)]
        for place, key in enumerate(band_keys("steerable", LEVELS, ORIENTATIONS)):
            bands.append((f"subband {names(key, 'steerable', ORIENTATIONS)[1]}", place))
        tip = "The values themselves, or one subband of each image (steerable pyramid of 3 levels)"
        self.band = self.add_choice("band", "Values", tip, bands, self.ask)
        tip = (
            "What equal values become: dealt out at random, or all the same as the algorithm has it word for word"
        )
        self.ties = self.add_choice("ties", "Ties", tip, TIES, self.ask)
        tip = "Take an image of this computer into both lists"
        self.file = self.add_button("file", "File ...", tip, self._open)
        self.readout = self.add_readout()
        self.plots = [Plot("lab-equalize-two", "Cumulative histogram of image two")]
        self.plots.append(Plot("lab-equalize-one", "Cumulative histogram of image one"))
        self.pictures = Pictures("lab-equalize-pictures", 3, linked=False)
        row = QHBoxLayout()
        for plot, name in zip(self.plots, ("v", "v'"), strict=True):
            plot.set_labels(name, "share p")
            row.addWidget(plot, 2)
        self.plots[0].hovered.connect(lambda x, _: self._follow(x))
        self.plots[0].left.connect(self._let_go)
        self.pictures.hovered.connect(self._hover)
        row.addWidget(self.pictures, 5)
        column = QVBoxLayout(self.body)
        column.setContentsMargins(*MARGINS)
        column.addLayout(row, 1)
        column.addWidget(self.make_words())
        self._offer([])
        # The figure of the book, ready made.
        self.two.setCurrentIndex(self.two.findData("ramp"))
        self.one.setCurrentIndex(self.one.findData("cube-root"))

    def show_scene(self, scene: Scene) -> None:
        """List what there is to choose from."""
        super().show_scene(scene)
        items: list[tuple[str, Any]] = []
        if scene.exemplar is not None:
            items.append(("exemplar", "exemplar"))
        column = scene.selected
        if shown_image(column) is not None:
            items.append(("result", "result"))
        if column is not None:
            items += [(f"stage: {frame.name}", f"frame:{place}") for place, frame in enumerate(column.frames)]
        self._offer(items)

    def _offer(self, first: list[tuple[str, Any]]) -> None:
        items = [*first, *BOOK]
        items += [(name.rsplit("/", 1)[-1], name) for name in self._files]
        items += [(f"gallery: {entry.title}", entry.uri) for entry in gallery()]
        for box in (self.two, self.one):
            replace_items(box, items)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the equalization of the chosen images."""
        two, one = (self._source(scene, box.currentData()) for box in (self.two, self.one))
        ties: Ties = self.ties.currentData()
        recent = self._recent

        def compute(should_stop: Callable[[], bool]) -> EqualizeAnswer:
            planes = two.plane(recent), one.plane(recent)
            if should_stop():
                raise Cancelled
            return equalize(planes[0], planes[1], ties)

        return Question((two.key, one.key, ties), compute)

    def _source(self, scene: Scene, name: str) -> Source:
        pixels: NDArray[Any] | None = None
        column = scene.selected
        if name == "exemplar" and scene.exemplar is not None:
            pixels = scene.exemplar.pixels
        elif name == "result":
            pixels = shown_image(column) if scene.stage is None else scene.stage.picture
        elif name.startswith("frame:") and column is not None:
            pixels = column.frames[int(name[6:])].picture
        return Source(name, pixels, self.band.currentData())

    def _open(self) -> None:
        name, _ = QFileDialog.getOpenFileName(self, "Image for the histogram", "", FILES)
        if name:
            self.add_file(name)

    def add_file(self, name: str) -> None:
        """Take a file into both lists, and as image two."""
        if name not in self._files:
            self._files.append(name)
            for box in (self.two, self.one):
                box.addItem(name.rsplit("/", 1)[-1], name)
        self.two.setCurrentIndex(self.two.findData(name))
        self.ask()

    # Showing.

    def show_answer(self, answer: EqualizeAnswer) -> None:
        """Show curves and pictures."""
        self.readout.setText("")
        self.pictures.show_pictures(answer.shown)
        before, after = (number(each) for each in answer.distances)
        self.words.setText(f"Mean distance of the sorted values from image one's: {before} before, {after} after.")
        self._draw(None)

    def _draw(self, value: float | None) -> None:
        answer: EqualizeAnswer | None = self.answer
        if answer is None:
            return
        one, two = answer.found.curves()
        arrow = None if value is None else answer.found.arrow(value)
        for plot, (x, y), role in zip(self.plots, (two, one), ("result", "exemplar"), strict=True):
            plot.clear()
            plot.curve(x, y, role)  # type: ignore[arg-type]
            if arrow is not None:
                low, high = float(x[0]), float(x[-1])
                if plot is self.plots[0]:
                    way = [(arrow.value, 0.0), (arrow.value, arrow.share), (high, arrow.share)]
                else:
                    way = [(low, arrow.share), (arrow.new_value, arrow.share), (arrow.new_value, 0.0)]
                plot.curve([each[0] for each in way], [each[1] for each in way], "accent", line="dash")
            plot.fit(y=(0.0, 1.0))

    def _follow(self, value: float) -> None:
        answer: EqualizeAnswer | None = self.answer
        if answer is None:
            return
        self._draw(value)
        arrow = answer.found.arrow(value)
        self.readout.setText(
            f"v {number(arrow.value)} → p {100 * arrow.share:.1f} % → v' {number(arrow.new_value)}"
        )

    def _let_go(self) -> None:
        self._draw(None)
        self.readout.setText("")

    def _hover(self, index: int, row: int, column: int) -> None:
        if row >= 0 and index == 0 and self.answer is not None:
            values = self.pictures.shown[0].values
            if values is not None and row < values.shape[0] and column < values.shape[1]:
                self._follow(float(values[row, column]))
                return
        self._draw(None)
        self.readout.setText(self.pictures.told(index, row, column))


def equalize(two: NDArray[np.float32], one: NDArray[np.float32], ties: Ties) -> EqualizeAnswer:
    """Return image two with image one's histogram, and how it is shown."""
    found = equalization.equalization(two, one)
    result = found.remapped(ties)
    low, high = min(found.one[0], found.two[0]), max(found.one[-1], found.two[-1])
    before, after = found.distance(two), found.distance(result)
    titles = ("image two", "image one", "the result")
    shown = [
        Shown(title, to_picture(gray(plane, float(high), float(low))), plane)
        for title, plane in zip(titles, (two, one, result), strict=True)
    ]
    return EqualizeAnswer(found, (shown[0], shown[1], shown[2]), (before, after))
