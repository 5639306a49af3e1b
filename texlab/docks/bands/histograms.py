"""Histograms of the pixels and of any subband, exemplar and result over each other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QWidget

from texlab.docks.bands.comparison import Comparison, compare
from texlab.docks.bands.comparison_view import HistogramPlot, NumbersTable
from texlab.docks.bands.controls import KINDS, BandCache, PyramidControls, PyramidSettings, channel_items
from texlab.docks.bands.middle import middle_words
from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, replace_items
from texlab.docks.recent import Same
from texlab.widgets.plain import set_tip
from texlab_core.stats.bands import CHANNELS, Channel, band_keys, names, projection

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab.state.scene import Scene
    from texlab_core.engine.steps import FloatImage
    from texlab_core.stats.bands import Band
    from texlab_core.transforms.steerable import BandKey

COLOURS: tuple[Channel, ...] = CHANNELS[1:4]


@dataclass(frozen=True)
class HistogramSettings:
    """What the controls ask for; without a band, the pixels."""

    channels: tuple[Channel, ...]
    pyramid: PyramidSettings | None = None
    band: BandKey | None = None


def comparisons(
    exemplar: FloatImage,
    result: FloatImage | None,
    settings: HistogramSettings,
    cache: BandCache,
    should_stop: Callable[[], bool],
) -> tuple[Comparison, ...]:
    """Compare the pixels, or one subband, of every plane that is asked for."""
    return tuple(
        _compare_bands(exemplar, result, channel, settings.pyramid, settings.band, cache, should_stop)
        if settings.pyramid is not None and settings.band is not None
        else _compare_pixels(exemplar, result, channel)
        for channel in settings.channels
    )


def _compare_pixels(exemplar: FloatImage, result: FloatImage | None, channel: Channel) -> Comparison:
    view = projection(exemplar, channel)
    other = None if result is None else view.plane(result)
    limits = None if channel.startswith("axis") else (0.0, 1.0)
    return compare(_plane_title(exemplar, channel), view.plane(exemplar), other, limits=limits)


def _compare_bands(
    exemplar: FloatImage,
    result: FloatImage | None,
    channel: Channel,
    pyramid: PyramidSettings,
    key: BandKey,
    cache: BandCache,
    should_stop: Callable[[], bool],
) -> Comparison:
    def bands(image: FloatImage) -> dict[BandKey, Band]:
        return {band.key: band for band in cache.bands(image, exemplar, channel, pyramid, should_stop)}

    first = bands(exemplar)
    second = {} if result is None else bands(result)
    # A small image has fewer levels than were asked for: its residual stands for those that it lacks.
    found = first.get(key, next(reversed(first.values())))
    other = second[found.key].plane if found.key in second else None
    part = middle_words(exemplar)
    title = ", ".join(filter(None, (_plane_title(exemplar, channel), found.title, part)))
    return compare(title, found.plane, other)


def _plane_title(exemplar: FloatImage, channel: Channel) -> str:
    return "gray" if exemplar.shape[2] == 1 else channel


class HistogramsDock(FramedDock):
    """Shows how the values of exemplar and result are distributed."""

    name = "histograms"
    title = "Histograms"
    help = "How pixels and subbands of exemplar and result are distributed."
    order = 20
    heavy = True
    empty = "Histograms appear as soon as there is an exemplar."

    def build(self) -> Iterator[None]:
        """Make the controls, the plots and the table."""
        self._cache = BandCache()
        items = [("Pixels", "pixels"), ("Subband", "band")]
        self.source = self.add_choice("source", "Values", "Pixels, or one subband", items, self._source_changed)
        self.channel = self.add_choice(
            "channel", "Plane", "Which plane of the image: luma, a colour, or a principal axis", [], self.ask
        )
        self.pyramid = PyramidControls(self, tuple(kind for kind in KINDS if kind != "gaussian"))
        self.band = self.add_choice("band", "Subband", "Which subband (level 0 is the finest)", [], self.ask)
        self.log = self.add_switch(
            "log", "Log", "Logarithmic shares: the tails can be seen", lambda _: self._redraw()
        )
        self.cumulated = self.add_switch(
            "cumulative", "Cumulative", "The share of values below each value", lambda _: self._redraw()
        )
        self.readout = self.add_readout()
        self.plots: list[HistogramPlot] = []
        for k in range(3):
            yield
            self.plots.append(HistogramPlot(f"histograms-plot-{k}", f"Histogram {k + 1}"))
        set_tip(self.plots[0], "Exemplar: solid and filled. Result: dashed.")
        self.table = NumbersTable("histograms-numbers")
        plots = QWidget()
        side_by_side = QHBoxLayout(plots)
        side_by_side.setContentsMargins(0, 0, 0, 0)
        for plot in self.plots:
            plot.hovered.connect(self._hover)
            plot.left.connect(lambda: self.readout.setText(""))
            side_by_side.addWidget(plot)
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(plots, 1)
        layout.addWidget(self.table, 0, Qt.AlignmentFlag.AlignTop)
        self._source_changed(quietly=True)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the distributions of the chosen values in the exemplar and the chosen column."""
        self.why = ""
        if scene.exemplar is None:
            return None
        exemplar = scene.exemplar.pixels
        result = self.looked_at(scene).with_channels(exemplar.shape[2])
        self.pyramid.follow(scene)
        self._fill_lists(exemplar.shape[2])
        settings = self._settings()
        cache = self._cache

        def compute(should_stop: Callable[[], bool]) -> tuple[Comparison, ...]:
            return comparisons(exemplar, result.values(), settings, cache, should_stop)

        return Question((self.name, Same(exemplar), result.key, settings), compute)

    def drop_kept(self) -> None:
        """Empty the cache of subbands."""
        super().drop_kept()
        self._cache.clear()

    def show_answer(self, answer: tuple[Comparison, ...]) -> None:
        """Draw the distributions and fill in the numbers."""
        for plot, shown in zip(self.plots, (*answer, None, None, None), strict=False):
            plot.setVisible(shown is not None)
        self._redraw()
        self.table.show_comparisons(answer)

    def _settings(self) -> HistogramSettings:
        chosen = self.channel.currentData()
        channels = COLOURS if chosen == "rgb" else (chosen,)
        if self.source.currentData() == "pixels":
            return HistogramSettings(channels)
        return HistogramSettings(channels, self.pyramid.settings, self.band.currentData())

    def _fill_lists(self, channels: int) -> None:
        items = channel_items(channels)
        if channels == 3:
            items.insert(1, ("red, green, blue", "rgb"))
        replace_items(self.channel, items)
        settings = self.pyramid.settings
        keys = band_keys(settings.kind, settings.levels, settings.orientations)
        entries: list[tuple[str, Any]] = [
            (names(key, settings.kind, settings.orientations)[1], key) for key in keys
        ]
        replace_items(self.band, entries)

    def _source_changed(self, *, quietly: bool = False) -> None:
        bands = self.source.currentData() == "band"
        self.pyramid.kind.setVisible(bands)
        self.pyramid.show(bands)
        self.band.setVisible(bands)
        if not quietly:
            self.ask()

    def _redraw(self) -> None:
        for plot, shown in zip(self.plots, self.answer or (), strict=False):
            first = plot is self.plots[0]
            plot.show_comparison(
                shown, log=self.log.isChecked(), cumulated=self.cumulated.isChecked(), named=first
            )
        self.tell_again()

    def _hover(self, x: float, y: float) -> None:
        plot = self.sender()
        if self.answer and isinstance(plot, HistogramPlot):
            place = self.plots.index(plot)
            if place < len(self.answer):
                self.readout.tell(partial(self._value_words, place, x))

    def _value_words(self, place: int, x: float) -> str:
        if self.answer is None or place >= len(self.answer):
            return ""
        return HistogramPlot.describe(self.answer[place], x, cumulated=self.cumulated.isChecked())
