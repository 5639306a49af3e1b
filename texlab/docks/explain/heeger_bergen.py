"""Heeger and Bergen: which subbands built a pixel."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from texlab.docks.explain.band_bars import BandBars, Bar
from texlab.docks.explain.base import Explainer, ExplanationView, never
from texlab.docks.recent import Recent, Same
from texlab.state.intentions import OpenTab
from texlab.style.colouring import diverging
from texlab.style.numbers import number
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.plots import pg
from texlab_core.errors import Cancelled
from texlab_core.methods.heeger_bergen.contributions import contributions
from texlab_core.methods.heeger_bergen.method import Convergence, HeegerBergenParams
from texlab_core.stats.bands import names
from texlab_core.stats.dependence import MOST_LEVEL
from texlab_core.transforms.luma import luma
from texlab_core.transforms.octave_bands import ORIENTATIONS

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme
    from texlab_core.engine.result import Result
    from texlab_core.methods.heeger_bergen.contributions import Contributions
    from texlab_core.stats.pyramid_kinds import PyramidKind
    from texlab_core.transforms.steerable import BandKey

CACHE_BYTES = 64 * 2**20
SPREADS = 3.0
# Larger pictures than this are sampled: they are shown small.
MOST_PIXELS = 2**18


@dataclass(frozen=True, eq=False)
class Built:
    """What built a whole picture.

    Parameters
    ----------
    found
        What every subband adds to every pixel.
    mean
        Of the picture's luma.
    pictures
        What every subband adds, in colours that part at zero; every ``step``-th pixel along both axes.
    """

    found: Contributions
    mean: float
    pictures: tuple[Picture, ...]
    step: int

    @property
    def nbytes(self) -> int:
        """Memory held."""
        return self.found.nbytes + sum(picture.nbytes for picture in self.pictures)


@dataclass(frozen=True, eq=False)
class ExplainedPixel:
    """What built a pixel.

    Parameters
    ----------
    pixel
        Row and column.
    bars
        What every subband adds; the residual's is taken from the mean of the picture.
    value
        Luma of the pixel.
    built
        What built the whole picture.
    keys
        The place of every subband in the pyramid.
    orientations
        Oriented subbands per level.
    """

    pixel: tuple[int, int]
    bars: tuple[Bar, ...]
    value: float
    built: Built
    keys: tuple[BandKey, ...]
    orientations: int


_built = Recent(CACHE_BYTES, lambda built: built.nbytes)


def take_apart(result: Result, should_stop: Callable[[], bool] = never) -> Built:
    """Find what built a picture; raises ``Cancelled`` when ``should_stop`` says so."""

    def look() -> None:
        if should_stop():
            raise Cancelled

    params = result.job.params
    assert isinstance(params, HeegerBergenParams)
    plane = luma(result.image)
    mean = float(plane.mean(dtype=np.float64))
    found = contributions(plane, params.pyramid, params.scales, params.orientations, look)
    step = math.ceil(math.sqrt(plane.size / MOST_PIXELS))
    pictures = []
    for index, key in enumerate(found.keys):
        look()
        shown = found.plane(index, look)[::step, ::step]
        shown = shown - np.float32(mean) if key.kind == "lowpass" else shown
        pictures.append(diverging(shown, SPREADS * float(found.spreads[index]) or 1.0))
    return Built(found, mean, tuple(pictures), step)


def explain_pixel(
    result: Result, row: int, column: int, should_stop: Callable[[], bool] = never
) -> ExplainedPixel:
    """Explain a pixel of a Heeger-Bergen result (in a background thread).

    The first pixel of a result takes the picture apart, which ``should_stop`` can end.
    """
    params = result.job.params
    assert isinstance(params, HeegerBergenParams)
    built = _built.get(Same(result), lambda: take_apart(result, should_stop))
    keys = built.found.keys
    values = built.found.at(row, column)
    value = float(values.sum())
    # The residual carries the mean, beside which nothing else could be seen.
    values = np.where([key.kind == "lowpass" for key in keys], values - built.mean, values)
    bars = tuple(
        make_bar(key, float(each), float(spread), params.orientations)
        for key, each, spread in zip(keys, values, built.found.spreads, strict=True)
    )
    return ExplainedPixel((row, column), bars, value, built, keys, params.orientations)


def make_bar(key: BandKey, value: float, spread: float, orientations: int) -> Bar:
    """Return the bar of a subband, grouped by level."""
    kind: PyramidKind = "laplacian" if key.kind == "bandpass" else "steerable"
    title, _ = names(key, kind, orientations)
    group = {"highpass": "high", "lowpass": "low"}.get(key.kind, f"level {key.level}")
    angle = f"{180 * key.orientation / orientations:.3g}°" if key.kind == "oriented" else ""
    return Bar(group, angle, value, spread, title)


def summary(explained: ExplainedPixel) -> str:
    """Return what built the pixel, in words."""
    parts = sorted(explained.bars, key=lambda bar: -abs(bar.value))
    mean = explained.built.mean
    strongest = ", ".join(f"{bar.title} {bar.value:+.3f}" for bar in parts[:3])
    return (
        f"Luma {explained.value:.3f} = {mean:.3f}, the mean of the picture, {explained.value - mean:+.3f} from "
        f"the subbands. Most of it: {strongest}. Each of them was made without asking the others."
    )


def dependence_settings(explained: ExplainedPixel, index: int) -> tuple[tuple[str, str | int], ...]:
    """Return how the tab Dependence is to be set for a subband: its parent, level, and nearest orientation."""
    key = explained.keys[index]
    turn = round(key.orientation * ORIENTATIONS / explained.orientations) % ORIENTATIONS
    level = 0 if key.kind == "highpass" else min(key.level, MOST_LEVEL)
    return (
        ("relation", "parent"),
        ("level", level),
        ("orientation", turn if key.kind == "oriented" else -1),
    )


class HeegerBergenView(ExplanationView):
    """Bars by level and orientation, and the picture that the chosen one adds."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("explain-heeger-bergen")
        self._explained: ExplainedPixel | None = None
        # The subband that is looked at again when there is something to look at.
        self._kept = -1
        self.bars = BandBars("explain-bars", "What every subband adds to the pixel")
        set_tip(
            self.bars,
            "What every subband adds to the pixel, or takes from it. Light areas: twice the standard deviation of "
            "what it adds anywhere. Click a bar to see its picture.",
        )
        self.bars.chosen.connect(lambda _: self._show_band())
        self.bars.hovered.connect(self._point)
        self.title = Label(name="explain-band-title", muted=True)
        self.pane = PicturePane("explain-band", "What the chosen subband adds to every pixel")
        self.spot = pg.ScatterPlotItem(
            size=13, symbol="o", brush=None, pxMode=True, pen=pg.mkPen("#000000", width=2)
        )
        self.pane.view.addItem(self.spot, ignoreBounds=True)
        self.words = Label(name="explain-band-words", wraps=True)
        self.words.setAccessibleName("Why the pixel is there")
        self._beside = QWidget()
        beside = QVBoxLayout(self._beside)
        beside.setContentsMargins(0, 0, 0, 0)
        beside.setSpacing(1)
        beside.addWidget(self.title)
        beside.addWidget(self.pane, 1)
        panes = QHBoxLayout()
        panes.addWidget(self.bars, 3)
        panes.addWidget(self._beside, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 0, 6, 4)
        layout.setSpacing(2)
        layout.addLayout(panes, 1)
        self.dependence = QPushButton("Show the dependence")
        self.dependence.setObjectName("explain-dependence")
        self.dependence.setAccessibleName("Open the tab Dependence for the chosen subband")
        set_tip(
            self.dependence,
            "The subbands were made without asking each other: the tab Dependence shows what the chosen one has "
            "to do with its parent in the exemplar, and what is left of it here",
        )
        self.dependence.clicked.connect(lambda _: self._open_dependence())
        below = QHBoxLayout()
        below.addWidget(self.words, 1)
        below.addWidget(self.dependence)
        layout.addLayout(below)
        self.setFocusProxy(self.bars)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.bars.set_theme(theme)
        self.pane.set_theme(theme)

    def show_explanation(self, explained: ExplainedPixel) -> None:
        """Show what built a pixel; the subband that was looked at stays."""
        self._explained = explained
        self.bars.show_bars(explained.bars)
        if self.bars.selected < 0:
            self.bars.select(self._kept)
        if self.bars.selected < 0:
            strongest = max(range(len(explained.bars)), key=lambda index: abs(explained.bars[index].value))
            self.bars.select(strongest)
        self._show_band()
        self._point(-1)
        self.marks_changed.emit(())

    def empty_parts(self) -> None:
        """Empty bars, picture and words; the subband that was looked at is remembered."""
        self._kept = self.bars.selected
        self.bars.show_bars(())
        self.title.setText("")
        self.pane.show_nothing()
        self.spot.setData([], [])
        self.words.setText("")

    def _open_dependence(self) -> None:
        explained, index = self._explained, max(self.bars.selected, 0)
        if explained is not None:
            self.intention.emit(OpenTab("dependence", dependence_settings(explained, index)))

    def _show_band(self) -> None:
        explained, index = self._explained, self.bars.selected
        if explained is None or index < 0:
            return
        self.title.setText(explained.bars[index].title.capitalize())
        self.pane.set_picture(explained.built.pictures[index])
        row, column = explained.pixel
        step = explained.built.step
        self.spot.setData([(column + 0.5) / step], [(row + 0.5) / step])

    def _point(self, index: int) -> None:
        if self._explained is None:
            return
        if index < 0:
            self.words.setText(summary(self._explained))
            return
        bar = self._explained.bars[index]
        self.words.setText(f"{bar.title.capitalize()}: {number(bar.value)}, typically ± {number(bar.spread)}.")


EXPLAINER = Explainer(
    Convergence,
    explain_pixel,
    HeegerBergenView,
    "For Heeger-Bergen: what every subband adds to the pixel, by level and orientation, and the picture of the "
    "chosen one.",
)
