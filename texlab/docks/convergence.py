"""Convergence: how far a run is from the exemplar as it goes on, by iteration or by pixels filled."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from texlab.columns.titles import titles
from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, replace_items
from texlab.docks.recent import Same
from texlab.style.colouring import SEQUENTIAL_TABLE
from texlab.style.numbers import number
from texlab.style.text_size import grow_with_text, text_scale
from texlab.widgets.heat_map import HeatMap
from texlab.widgets.plain import Label, MarkupLabel, escaped, set_tip
from texlab.widgets.plots import SERIES, Plot
from texlab.widgets.slider import Slider
from texlab_core.engine.steps import Curve

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray
    from PySide6.QtGui import QResizeEvent

    from texlab.state.scene import ColumnScene, Scene
    from texlab.style.theme import Theme
    from texlab_core.transforms.steerable import BandKey

MEAN = "mean-distance"
WIDE_ENOUGH = 860


@dataclass(frozen=True, eq=False)
class Heat:
    """Distances of the subbands by iteration on a grid of levels and orientations.

    Parameters
    ----------
    values
        (iterations, R, C) float64; NaN where there is no subband.
    rows, columns
        Names of the levels and of the orientations.
    curves
        Name of the curve of each cell, "" where there is none.
    """

    values: NDArray[np.float64]
    rows: tuple[str, ...]
    columns: tuple[str, ...]
    curves: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, eq=False)
class ConvergenceAnswer:
    """Curves of all columns (title, whether it is the chosen column), its own by name, and its heat map."""

    overlaid: tuple[tuple[str, bool, Curve], ...]
    own: dict[str, Curve] = field(default_factory=dict)
    chosen: str = MEAN
    heat: Heat | None = None

    @property
    def shown(self) -> Curve:
        """The chosen curve of the chosen column."""
        return self.own[self.chosen]

    @property
    def alike(self) -> dict[str, Curve]:
        """The chosen column's curves that have the axes of the chosen one."""
        return {name: each for name, each in self.own.items() if _axes(each) == _axes(self.shown)}

    @property
    def references(self) -> list[Curve]:
        """What the chosen curve is to be held against."""
        return [each for each in self.alike.values() if each.reference]


def heat_of(details: Any) -> Heat | None:
    """Return the heat map of a result's details, when they carry distances by iteration, axis and subband."""
    keys: Sequence[BandKey] | None = getattr(details, "keys", None)
    distances = getattr(details, "distances", None)
    if callable(keys) or not keys or distances is None or np.ndim(distances) != 3 or not np.size(distances):
        return None
    mean = np.asarray(distances, np.float64).mean(axis=1)
    oriented = max((key.orientation for key in keys if key.kind == "oriented"), default=0) + 1
    rows = list(dict.fromkeys(_row(key) for key in keys))
    values = np.full((len(mean), len(rows), oriented), np.nan)
    curves = [[""] * oriented for _ in rows]
    for index, key in enumerate(keys):
        row = rows.index(_row(key))
        values[:, row, key.orientation] = mean[:, index]
        curves[row][key.orientation] = f"band-{key.label}"
    angles = tuple(f"{180 * k / oriented:.3g}°" for k in range(oriented)) if oriented > 1 else ("",)
    return Heat(values, tuple(rows), angles, tuple(tuple(row) for row in curves))


def _row(key: BandKey) -> str:
    return {"highpass": "high", "lowpass": "low"}.get(key.kind, f"level {key.level}")


class LiveCurves:
    """Curves that grow with the numbers a running column reports."""

    def __init__(self) -> None:
        self._values: dict[int, dict[str, list[float]]] = {}

    def watch(self, column: ColumnScene) -> None:
        """Take the newest numbers of a column; a column that does not run, or has none yet, starts afresh."""
        if column.status != "running" or not column.metrics:
            self._values.pop(column.id, None)
            return
        known = self._values.setdefault(column.id, {})
        for name, value in column.metrics.items():
            series = known.setdefault(name, [])
            if not series or series[-1] != value:
                series.append(float(value))

    def curves(self, column: ColumnScene) -> dict[str, Curve]:
        """Return what was reported so far."""
        known = self._values.get(column.id, {})
        return {name: Curve.of(values, name.replace("-", " ")) for name, values in known.items()}


class ConvergenceDock(FramedDock):
    """Shows the curves of the chosen column, those of the others over them, and distances by subband."""

    name = "convergence"
    title = "Convergence"
    help = "How far a run is from the exemplar as it goes on: statistics by iteration, windows while growing."
    order = 50
    # Each run has its own iterations.
    no_settings = frozenset({"iteration"})
    empty = "Curves appear while a method that iterates runs, and when a growth has finished."

    def build(self) -> Iterator[None]:
        """Make the controls, the plots and the heat map."""
        self._live = LiveCurves()
        self._heat: Heat | None = None
        self.curve = self.add_choice("curve", "Curve", "Which curve to show for all columns", [], self.ask)
        self.log = self.add_switch("log", "Log", "Logarithmic distance", lambda _: self._redraw())
        self.log.setChecked(True)
        self.iteration = Slider("Heat map", self._said)
        grow_with_text(self.iteration, 120, self.iteration.setFixedWidth)
        self.iteration.setPageStep(1)
        self.iteration.valueChanged.connect(self._show_heat)
        tip = "Iteration that the heat map shows"
        self.add_slider(self.iteration, "iteration", tip)
        self.iteration_label = Label("")
        self.add_control(self.iteration_label, "iteration-label", "Iteration of the heat map", tip)
        self.readout = self.add_readout()
        yield
        self.plot = Plot("convergence-plot", "Curve of all columns")
        self.plot.hovered.connect(self._hover_curve)
        self.plot.left.connect(lambda: self.readout.setText(""))
        self.all = Plot("convergence-all", "All curves of the chosen column")
        set_tip(self.all, "All curves of the chosen column; the chosen one is thick")
        self.heat = HeatMap("convergence-heat", "Distance by level and orientation")
        set_tip(
            self.heat,
            "Distance of every subband, levels down and orientations across; click or arrow keys show its curve",
        )
        self.heat.chosen.connect(self._choose_cell)
        self.heat.hovered.connect(self._hover_cell)
        self.legend = MarkupLabel()
        self.legend.setObjectName("convergence-legend")
        self.legend.setWordWrap(True)
        first = QWidget()
        column = QVBoxLayout(first)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        column.addWidget(self.legend)
        column.addWidget(self.plot, 1)
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(first, 5)
        layout.addWidget(self.all, 3)
        layout.addWidget(self.heat, 3)

    def paint_theme(self, theme: Theme) -> None:
        """Give plots, legend and heat map their colours."""
        super().paint_theme(theme)
        self._write_legend()

    def question(self, scene: Scene) -> Question | None:
        """Ask for the curves; there is nothing to compute but the heat map."""
        self.why = ""
        by_column = []
        for column in scene.columns:
            self._live.watch(column)
            by_column.append((column, dict(column.result.curves) if column.result else self._live.curves(column)))
        selected = scene.selected
        own = next((curves for column, curves in by_column if column.id == scene.selected_id), {})
        if selected is None or not own:
            if selected is not None and selected.result is not None:
                self.why = f"{selected.title} records no curves."
            self.controls.hide()
            return None
        self.controls.show()
        replace_items(self.curve, [(each.title, name) for name, each in own.items() if not each.reference])
        chosen = self.curve.currentData()
        # Another criterion has another unit: such curves do not belong into one pair of axes.
        # Two columns of one method are told apart by what differs between them.
        overlaid = tuple(
            (title, column.id == scene.selected_id, curves[chosen])
            for (column, curves), title in zip(by_column, titles(scene.columns), strict=True)
            if chosen in curves and _axes(curves[chosen]) == _axes(own[chosen])
        )
        details = selected.result.details if selected.result is not None else None

        def compute(should_stop: Callable[[], bool]) -> ConvergenceAnswer:
            return ConvergenceAnswer(overlaid, own, chosen, heat_of(details))

        lengths = tuple((title, here, curve.y.tobytes()) for title, here, curve in overlaid)
        return Question((self.name, Same(details), chosen, tuple(own), lengths), compute)

    def show_answer(self, answer: ConvergenceAnswer) -> None:
        """Draw the curves and the heat map."""
        same_run = self._heat is not None and answer.heat is not None
        self._heat = answer.heat
        for widget in (self.heat, self.iteration, self.iteration_label):
            widget.setVisible(answer.heat is not None)
        if answer.heat is not None:
            last = len(answer.heat.values) - 1
            at_end = not same_run or self.iteration.value() == self.iteration.maximum()
            blocked = self.iteration.blockSignals(True)
            self.iteration.setRange(0, last)
            self.iteration.setValue(last if at_end else min(self.iteration.value(), last))
            self.iteration.blockSignals(blocked)
            self._show_heat()
        self._write_legend()
        self._redraw()
        self._make_room()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave the small curves out where there is no room for them."""
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        many = self.answer is not None and len(self.answer.alike) - len(self.answer.references) > 1
        self.all.setVisible(many and (self.width() >= WIDE_ENOUGH * text_scale(self) or self._heat is None))

    def _redraw(self) -> None:
        answer: ConvergenceAnswer | None = self.answer
        if answer is None:
            return
        drawn = [curve for _, _, curve in answer.overlaid] + answer.references
        floor = _floor(drawn) if self.log.isChecked() else None
        self.plot.clear()
        for (_, here, curve), (role, line) in zip(answer.overlaid, _styles(len(answer.overlaid)), strict=True):
            self.plot.curve(*_points(curve, floor), role, line=line, width=3 if here else 1.5)
        for curve in answer.references:
            x, y = _points(curve, floor)
            self.plot.curve(x, y, "text", line="dash", width=1)
            if x.size:
                self.plot.text(x[-1], y[-1], curve.title, "muted", anchor=(1, 0))
        shown = answer.shown
        self.plot.set_log(floor is not None)
        self.plot.set_labels(shown.x_label, shown.y_label)
        self.plot.fit()
        self.all.clear()
        floor = _floor(list(answer.alike.values())) if self.log.isChecked() else None
        for name, curve in answer.alike.items():
            thick = name == answer.chosen
            self.all.curve(*_points(curve, floor), "exemplar" if thick else "muted", width=3 if thick else 1)
        self.all.set_log(floor is not None)
        self.all.set_labels(shown.x_label, shown.y_label)
        self.all.fit()

    def _write_legend(self) -> None:
        answer: ConvergenceAnswer | None = self.answer
        if answer is None:
            return
        words = []
        strokes = {"solid": "━━", "dash": "╍╍", "dot": "┅┅"}
        for (title, here, curve), (role, line) in zip(answer.overlaid, _styles(len(answer.overlaid)), strict=True):
            name = f"<b>{escaped(title)}</b>" if here else escaped(title)
            last = number(float(curve.y[-1])) if curve.y.size else ""
            words.append(f"<span style='color:{getattr(self.theme, role)}'>{strokes[line]}</span> {name} {last}")
        words += [
            f"{strokes['dash']} {escaped(each.title)} {number(float(each.y[-1]))}" for each in answer.references
        ]
        self.legend.setText("&nbsp;&nbsp; ".join(words))

    def _said(self, place: int) -> str:
        return "" if self._heat is None else f"iteration {place} of {len(self._heat.values) - 1}"

    def _show_heat(self, *_: object) -> None:
        heat = self._heat
        if heat is None:
            return
        place = self.iteration.value()
        self.iteration_label.setText(self._said(place))
        self.iteration.tell()
        values = heat.values[place]
        # Colours from the best to the worst subband of this iteration; the curves tell how far all have come.
        logs = np.log(np.maximum(values, 1e-12))
        low, high = (np.nanmin(logs), np.nanmax(logs)) if np.isfinite(logs).any() else (0.0, 1.0)
        places = (logs - low) / max(high - low, 1e-9)
        texts = [[f"{value:.3f}" if np.isfinite(value) else "" for value in row] for row in values]
        self.heat.show_cells(places, texts, heat.rows, heat.columns, SEQUENTIAL_TABLE)
        chosen = self.curve.currentData()
        cells = [(r, c) for r, row in enumerate(heat.curves) for c, name in enumerate(row) if name == chosen]
        self.heat.select(cells[0] if cells else None)
        self.tell_again()

    def _choose_cell(self, row: int, column: int) -> None:
        if self._heat is not None:
            place = self.curve.findData(self._heat.curves[row][column])
            if place >= 0:
                self.curve.setCurrentIndex(place)
                self.ask()

    def _hover_cell(self, row: int, column: int) -> None:
        self.readout.tell(partial(self._cell_words, row, column))

    def _cell_words(self, row: int, column: int) -> str:
        if self._heat is None or not (0 <= row < len(self._heat.rows) and column < len(self._heat.columns)):
            return ""
        name = " ".join(part for part in (self._heat.rows[row], self._heat.columns[column]) if part)
        value = self._heat.values[self.iteration.value(), row, column]
        return f"{name}: {number(float(value))}"

    def _hover_curve(self, x: float, _: float) -> None:
        self.readout.tell(partial(self._curve_words, x))

    def _curve_words(self, x: float) -> str:
        answer: ConvergenceAnswer | None = self.answer
        if answer is None:
            return ""
        words = []
        places = answer.shown.x
        if places.size:
            x = float(places[np.argmin(np.abs(places - x))])
        for title, _, curve in answer.overlaid:
            if curve.x.size:
                nearest = int(np.argmin(np.abs(curve.x - x)))
                words.append(f"{title} {number(float(curve.y[nearest]))}")
        return f"{answer.shown.x_label} {x:.0f}: " + ", ".join(words)


def _styles(count: int) -> list[tuple[Any, Any]]:
    return [SERIES[index % len(SERIES)] for index in range(count)]


def _axes(curve: Curve) -> tuple[str, str]:
    return curve.x_label, curve.y_label


def _floor(curves: list[Curve]) -> float | None:
    """Return where zeros lie in a logarithmic plot: below all else; None when there is nothing above zero."""
    positive = [curve.y[np.isfinite(curve.y) & (curve.y > 0)] for curve in curves]
    return min((float(each.min()) for each in positive if each.size), default=0.0) / 2 or None


def _points(curve: Curve, floor: float | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the points that can be drawn; with a floor, the logarithms of their values, none below the floor."""
    usable = np.isfinite(curve.y)
    y = curve.y[usable]
    return curve.x[usable], y if floor is None else np.log10(np.maximum(y, floor))
