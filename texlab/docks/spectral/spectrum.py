"""Spectrum: the power of exemplar and result by frequency, its peaks, and the centres to which MSG moves them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QEvent, QRectF
from PySide6.QtWidgets import QBoxLayout, QHBoxLayout, QSizePolicy, QWidget

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Recent, Same
from texlab.docks.spectral.peaks_table import PeaksTable, peak_rows
from texlab.docks.spectral.spectra import Analysed, SpectraAnswer, spectra, table_of
from texlab.style.numbers import number
from texlab.style.text_size import text_scale
from texlab.widgets.headed import headed
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.plane_pane import Arrow, Drawn, PlaneLink, PlanePane, Ring, Spot, Tint
from texlab.widgets.plots import SERIES, ColourBar, Plot
from texlab_core.stats.spectrum import QUANTIZATION
from texlab_core.transforms.gabor import circles
from texlab_core.transforms.gabor_bank import CENTRES_U, CENTRES_V

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from PySide6.QtCore import QObject
    from PySide6.QtGui import QResizeEvent

    from texlab.docks.spectral.spectra import PlanePicture, View
    from texlab.state.scene import Scene
    from texlab_core.stats.peaks import Peak
    from texlab_core.stats.spectrum import Floats

WIDE = 1050
FIRST_DEGREE = -30.0
VIEWS = (
    ("Log power", "power"),
    ("Difference", "difference"),
    ("Autocorrelation", "autocorrelation"),
)
BESIDE = (("Profiles", "profiles"), ("Peaks", "peaks"))
UNITS = {"power": "dB", "difference": "dB", "autocorrelation": ""}
MEANINGS = {
    "power": "dB above the rounding to 256 levels",
    "difference": "Result above exemplar in dB, in cells of 1/64 cycle per pixel",
    "autocorrelation": "Correlation of the image with itself, by shift in pixels",
}


class SpectrumDock(FramedDock):
    """Compares the power spectra of exemplar and result."""

    name = "spectrum"
    title = "Spectrum"
    help = "Power by frequency of exemplar and result, their peaks, and the centres to which MSG moves them."
    order = 30
    heavy = True
    empty = "Spectra appear as soon as there is an exemplar."

    def build(self) -> Iterator[None]:
        """Make the controls, the pictures, the profiles and the table."""
        self._recent = Recent(6)
        self._result_title = "result"
        tip = "Log power by frequency, how the result's differs, or the autocorrelation by shift"
        self.view = self.add_choice("view", "What is shown", tip, VIEWS, self.ask)
        tip = "The half-height circles of MSG's 16 filters: a peak moves to the centre that answers most to it"
        self.centres = self.add_switch("centres", "MSG centres", tip, lambda _: self._draw_marks())
        self.centres.setChecked(True)
        tip = "The strongest repetitions, and arrows from the exemplar's to where they are in the result"
        self.peaks = self.add_switch("peaks", "Peaks", tip, lambda _: self._draw_marks())
        self.peaks.setChecked(True)
        tip = "What stands beside the pictures while there is no room for both"
        self.beside = self.add_choice("beside", "Beside the pictures", tip, BESIDE, self._make_room)
        self.fit_button = self.add_button("fit", "Fit", "Show the whole plane again", lambda: self._link.fit())
        self.numbers = Label("")
        tip = (
            "Log-spectral distance: root mean square difference of the spectra in dB. "
            "Total variation: which share of the power would have to move to make them alike."
        )
        self.add_control(self.numbers, "numbers", "Distances between the spectra", tip)
        self.readout = self.add_readout()
        self._link = PlaneLink()
        self.table = PeaksTable("spectrum-table")
        self.table.currentCellChanged.connect(lambda *_: self._draw_marks())
        self.body.installEventFilter(self)
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        yield
        layout.addWidget(self._make_pictures(), 3)
        yield
        for title in self.titles:
            title.installEventFilter(self)
        layout.addWidget(self._make_plots(), 2)
        layout.addWidget(self.table)
        self._make_room()

    def _make_pictures(self) -> QWidget:
        self._pictures = QWidget()
        row = QHBoxLayout(self._pictures)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        self.panes: list[PlanePane] = []
        self.titles: list[Label] = []
        self._side = 90
        self._parts: list[QWidget] = []
        for index, (name, label) in enumerate((("exemplar", "Exemplar"), ("result", "Result"))):
            pane = PlanePane(f"spectrum-{name}", f"{label}'s spectrum", self._link)
            set_tip(pane, "Drag to move, turn the wheel to enlarge, double-click for the whole plane")
            pane.hovered.connect(lambda x, y, index=index: self._hover(index, x, y))
            pane.left.connect(lambda: self._tell(""))
            title = Label(label)
            part = headed(title, pane)
            row.addWidget(part, 1)
            self.panes.append(pane)
            self.titles.append(title)
            self._parts.append(part)
        self.bar = ColourBar("spectrum-bar")
        row.addWidget(self.bar)
        return self._pictures

    def _make_plots(self) -> QWidget:
        self.radial = Plot("spectrum-radial", "Power by frequency")
        self.radial.set_labels("cycles per pixel", "power")
        self.angular = Plot("spectrum-angular", "Power by orientation")
        self.angular.set_labels("orientation in degrees", "power")
        self.plots = QWidget()
        self.plots.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self._plot_box = QBoxLayout(QBoxLayout.Direction.LeftToRight, self.plots)
        self._plot_box.setContentsMargins(0, 0, 0, 0)
        self._plot_box.setSpacing(2)
        for plot in (self.radial, self.angular):
            set_tip(plot, "Exemplar: solid. Result: dashed. Dotted lines: the exemplar's peaks.")
            plot.set_log(True)
            plot.hovered.connect(lambda x, _, plot=plot: self._hover_plot(plot, x))
            plot.left.connect(lambda: self._tell(""))
            self._plot_box.addWidget(plot)
        return self.plots

    # Asking.

    def question(self, scene: Scene) -> Question | None:
        """Ask for the spectra of the exemplar and of the chosen column."""
        if scene.exemplar is None:
            return None
        exemplar, column = scene.exemplar.pixels, scene.selected
        result = self.looked_at(scene)
        self._result_title = "result" if column is None else column.title
        view: View = self.view.currentData()
        recent = self._recent

        def compute(should_stop: Callable[[], bool]) -> SpectraAnswer:
            return spectra(exemplar, result.values(), view, recent, should_stop)

        return Question((self.name, Same(exemplar), result.key, view), compute)

    # Showing.

    def show_answer(self, answer: SpectraAnswer) -> None:
        """Show pictures, profiles, peaks and distances."""
        difference = answer.view == "difference"
        self.titles[0].setText(f"{self._result_title} above exemplar" if difference else "exemplar")
        self.titles[1].setText(self._result_title)
        self._limit_planes(self._side)
        for pane, part, shown in zip(self.panes, self._parts, (answer.first, answer.second), strict=True):
            pane.show_picture(
                None if shown is None else shown.picture, QRectF() if shown is None else QRectF(*shown.area)
            )
            part.setVisible(shown is not None)
        scale = answer.first.scale
        unit = UNITS[answer.view]
        digits = 2 if answer.view == "autocorrelation" else 0
        ticks = [(place, f"{value:.{digits}f} {unit}".strip()) for place, value in scale.ticks()]
        self.bar.show_scale(table_of(answer.view), ticks)
        set_tip(self.bar, MEANINGS[answer.view])
        self.table.show_rows(peak_rows(answer))
        self._draw_profiles(answer)
        self._draw_marks()
        if answer.distance is None or answer.variation is None:
            self.numbers.setText("")
        else:
            self.numbers.setText(
                f"log-spectral distance {answer.distance:.2f} dB · total variation {answer.variation:.1%}"
            )

    def _draw_profiles(self, answer: SpectraAnswer) -> None:
        for plot, profiles in ((self.radial, _radial), (self.angular, _angular)):
            plot.clear()
            found = [profiles(each) for each in (answer.exemplar, answer.result) if each is not None]
            logs = [np.log10(np.maximum(power, QUANTIZATION)) for _, power in found]
            low, high = min(float(log.min()) for log in logs), max(float(log.max()) for log in logs)
            room = 0.06 * max(high - low, 0.1)
            for peak in answer.exemplar.peaks:
                x = peak.frequency if plot is self.radial else _turned(peak.orientation)
                plot.curve([x, x], [low - room, high + room], "muted", line="dot", width=1)
            for (x, _), log, (role, line) in zip(found, logs, SERIES, strict=False):
                plot.curve(x, log, role, line=line)
            across = (0.0, 0.5) if plot is self.radial else (FIRST_DEGREE, FIRST_DEGREE + 180)
            plot.fit(x=across, y=(low - room, high + room))

    def _draw_marks(self) -> None:
        answer: SpectraAnswer | None = self.answer
        if answer is None:
            return
        chosen = self.table.chosen
        place = -1 if chosen is None else chosen.number
        drawn: list[list[Drawn]] = [[], []]
        if answer.view == "autocorrelation":
            if self.peaks.isChecked():
                drawn[0] += _periods(answer.exemplar, "exemplar")
                drawn[1] += [] if answer.result is None else _periods(answer.result, "result")
        else:
            if self.centres.isChecked():
                for marks in drawn:
                    marks += _centres(self._snapped(answer, place))
            if self.peaks.isChecked():
                first, second = peak_marks(answer, place)
                drawn = [drawn[0] + first, drawn[1] + second]
                if answer.view == "difference":
                    drawn[0] += second
            if chosen is not None and place < 0:
                drawn[1 if answer.second is not None else 0] += _both(chosen.peak, "chosen", "circle")
        for pane, marks in zip(self.panes, drawn, strict=True):
            pane.show_marks(marks)

    def _snapped(self, answer: SpectraAnswer, place: int) -> int:
        """Return the channel to whose centre the chosen peak moves, -1 for none."""
        snap = answer.snaps[place] if 0 <= place < len(answer.snaps) else None
        return -1 if snap is None else snap.channel

    def _make_room(self, *_: object) -> None:
        """Where the dock is narrow, either the profiles or the peaks stand beside the pictures."""
        wide = self.width() >= WIDE * text_scale(self)
        self.beside.setVisible(not wide)
        beside = self.beside.currentData()
        self.plots.setVisible(wide or beside == "profiles")
        self.table.setVisible(wide or beside == "peaks")

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Arrange the parts for the room there is."""
        super().resizeEvent(event)
        self._make_room()

    def _limit_planes(self, side: int) -> None:
        """Let no plane be wider than high, unless its title needs that."""
        self._side = side
        wide = [max(side, title.fontMetrics().horizontalAdvance(title.text()) + 4) for title in self.titles]
        for part, width in zip(self._parts, wide, strict=True):
            part.setMaximumWidth(width)
        self._pictures.setMaximumWidth(sum(wide) + self.bar.sizeHint().width() + 12)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Give the planes, which are squares, their width."""
        if watched is self.body and event.type() == QEvent.Type.Resize:
            side = max(self.body.height() - self.titles[0].fontMetrics().lineSpacing() - 8, 90)
            self._limit_planes(side)
            tall = self.body.height() > 0.45 * self.body.width()
            ways = QBoxLayout.Direction
            self._plot_box.setDirection(ways.TopToBottom if tall else ways.LeftToRight)
        elif event.type() == QEvent.Type.FontChange and watched in self.titles:
            self._limit_planes(self._side)
        return super().eventFilter(watched, event)

    # The value under the cursor.

    def _hover(self, index: int, x: float, y: float) -> None:
        answer: SpectraAnswer | None = self.answer
        if answer is None:
            return
        shown = (answer.first, answer.second)
        here = shown[index]
        value = None if here is None else here.value(x, y)
        if here is None or value is None:
            self._tell("")
            return
        self.bar.set_mark(float(here.scale.place(value)))
        self._tell(f"{_place_text(here, answer.view, x, y)}: {_values_text(answer, shown, x, y)}", keep=True)

    def _tell(self, text: str, *, keep: bool = False) -> None:
        self.readout.setText(text)
        if not keep:
            self.bar.set_mark(None)

    def _hover_plot(self, plot: Plot, x: float) -> None:
        answer: SpectraAnswer | None = self.answer
        if answer is None:
            return
        radial = plot is self.radial
        where = f"{x:.4f} c/px, period {1 / x:.1f} px" if radial and x > 0 else f"{x % 180:.1f}°"
        words = []
        for name, each in (("exemplar", answer.exemplar), ("result", answer.result)):
            if each is not None:
                places, power = _radial(each) if radial else _angular(each)
                words.append(f"{name} {number(float(np.interp(x, places, power)))}")
        self._tell(f"{where}: {', '.join(words)}")


def peak_marks(answer: SpectraAnswer, chosen: int) -> tuple[list[Drawn], list[Drawn]]:
    """Return what marks the peaks in the exemplar's and in the result's picture.

    Dashed arrows go to the centre to which MSG moves a peak, solid ones to where the result has it.
    """
    first: list[Drawn] = []
    second: list[Drawn] = []
    for place, (peak, snap) in enumerate(zip(answer.exemplar.peaks, answer.snaps, strict=True)):
        tint: Tint = "chosen" if place == chosen else "exemplar"
        first += _both(peak, tint, "circle")
        second += _both(peak, tint, "circle")
        if snap is not None:
            first += [
                Arrow(s * peak.u, s * peak.v, s * snap.u, s * snap.v, "centre", dashed=True) for s in (1, -1)
            ]
        match = answer.matches[place] if answer.matches else None
        if match is not None:
            other = match[0]
            # The mirror image of a peak near the edge may be the one that is near.
            side = 1 if peak.u * other.u + peak.v * other.v >= 0 else -1
            second += [
                Arrow(s * peak.u, s * peak.v, s * side * other.u, s * side * other.v, tint) for s in (1, -1)
            ]
    if answer.result is not None:
        for peak in answer.result.peaks:
            second += _both(peak, "result", "square")
    return first, second


def _both(peak: Peak, tint: Tint, shape: str) -> list[Drawn]:
    return [Spot(sign * peak.u, sign * peak.v, tint, shape) for sign in (1, -1)]  # type: ignore[arg-type]


def _centres(snapped: int) -> Iterator[Drawn]:
    for circle in circles():
        tint: Tint = "chosen" if circle.channel == snapped and snapped >= 0 else "centre"
        yield Ring(circle.u, circle.v, circle.radius, tint, dashed=circle.channel < 0)
    for u, v in zip(CENTRES_U, CENTRES_V, strict=True):
        for sign in (1, -1):
            yield Spot(sign * float(u), sign * float(v), "centre", "dot")


def _periods(shown: Analysed, tint: Tint) -> list[Drawn]:
    """Return the shifts by one period of each peak, across its stripes."""
    found: list[Drawn] = []
    for peak in shown.peaks:
        square = peak.frequency**2
        found += [Spot(s * peak.u / square, s * peak.v / square, tint) for s in (1, -1)]
    return found


def _radial(shown: Analysed) -> tuple[Floats, Floats]:
    """Return frequencies and powers, without the bins that hold no sample of the spectrum."""
    profile = shown.radial
    known = profile.power > 0
    return (profile.x[known], profile.power[known]) if known.any() else (profile.x, profile.power)


def _angular(shown: Analysed) -> tuple[Floats, Floats]:
    """Return orientations and powers, turned so that vertical and horizontal stripes lie inside the axis."""
    order = np.argsort(turned := _turned(shown.angular.x))
    return turned[order], shown.angular.power[order]


def _turned(degrees: Any) -> Any:
    return (degrees - FIRST_DEGREE) % 180 + FIRST_DEGREE


def _place_text(shown: PlanePicture, view: View, x: float, y: float) -> str:
    rows, columns = shown.values.shape
    if view == "autocorrelation":
        return f"shift {round(x)}, {round(y)} px"
    # What is told is the frequency of the sample under the cursor.
    u, v = round(x * columns) / columns, round(y * rows) / rows
    frequency = math.hypot(u, v)
    if frequency == 0:
        return "0 c/px (the mean, which is left out)"
    orientation = math.degrees(math.atan2(v, u)) % 180
    return f"{frequency:.4f} c/px, period {1 / frequency:.1f} px, {orientation:.1f}°"


def _values_text(
    answer: SpectraAnswer, shown: tuple[PlanePicture, PlanePicture | None], x: float, y: float
) -> str:
    if answer.view == "difference":
        value = answer.first.value(x, y) or 0.0
        return f"result {value:+.1f} dB"
    words = []
    for name, each in zip(("exemplar", "result"), shown, strict=True):
        value_here = None if each is None else each.value(x, y)
        if value_here is not None:
            text = f"{value_here:.1f} dB" if answer.view == "power" else f"{value_here:+.3f}"
            words.append(f"{name} {text}")
    return ", ".join(words)
