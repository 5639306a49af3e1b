"""D against V: runs, sweeps and trials as points; thresholds suggested, and taken by a click."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QProgressBar, QVBoxLayout

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, replace_items
from texlab.docks.tuning.points import (
    SEARCH,
    SWEEP,
    D,
    V,
    axes_of,
    describe_cell,
    groups_of,
    knob_choices,
    limit_choices,
    nearest,
    placed,
    zone_lines,
)
from texlab.state.intentions import RunTuning, StopTuning, TakeCell
from texlab.state.scene import Scene, are_same
from texlab.state.tuning import TuningPlan
from texlab.style.text_size import grow_with_text
from texlab.widgets.once import Once
from texlab.widgets.picture_area import PictureArea
from texlab.widgets.plain import Label, ShortLabel
from texlab.widgets.plots import SERIES, Plot
from texlab_core.measures.registry import find_measure
from texlab_core.sheets.own_line import own_measures
from texlab_core.sheets.sweep import Cell
from texlab_core.sheets.tuning_search import DEFAULT_BUDGET

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from texlab.docks.tuning.points import Group, Placed
    from texlab.widgets.plots import Line, Role
    from texlab_core.engine.inputs import ImageInput

BUDGET = DEFAULT_BUDGET
# A search makes dozens of points a second; drawing them all anew takes as long as making two.
REDRAW_MS = 300
# Width of the picture and what is told of it.
TOLD = 220


class TuningDock(FramedDock):
    """Plots two measures of every run against each other, and searches for better parameters."""

    name = "tuning"
    title = "D against V"
    help = "Every run as a point: how different the texture looks against how new it is; click one to take it."
    order = 62
    empty = "Open a texture first."

    def build(self) -> Iterator[None]:
        """Make the controls, the plot, and the place of the picture."""
        self._drawn: tuple[Any, ...] = ()
        self._redraw = Once(self, REDRAW_MS, self._show_all)
        self.points: list[Placed] = []
        self.over: Placed | None = None
        self._build_line()
        yield
        self.plot = Plot("tuning-plot", "Two measures of every run against each other")
        self.plot.hovered.connect(self._hovered)
        self.plot.left.connect(lambda: self._point(None))
        self.plot.clicked.connect(self._clicked)
        self.picture = PictureArea("tuning-picture", "", "The result of the point under the pointer")
        grow_with_text(self.picture, TOLD, self.picture.setFixedWidth)
        self.told = Label(name="tuning-told", wraps=True)
        self.told.setAlignment(Qt.AlignmentFlag.AlignTop)
        grow_with_text(self.told, TOLD, self.told.setFixedWidth)
        self.progress = QProgressBar()
        self.progress.setObjectName("tuning-progress")
        self.progress.setAccessibleName("Progress of the search")
        self.progress.setRange(0, 1000)
        self.progress.setTextVisible(False)
        policy = self.progress.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.progress.setSizePolicy(policy)
        self.status = ShortLabel(name="tuning-status", muted=True)
        left = QVBoxLayout()
        left.setSpacing(2)
        for widget in (self.status, self.progress):
            left.addWidget(widget)
        left.addWidget(self.plot, 1)
        right = QVBoxLayout()
        right.addWidget(self.picture, 2)
        right.addWidget(self.told, 1)
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addLayout(left, 1)
        layout.addLayout(right)

    def _build_line(self) -> None:
        self.across = self.add_choice("across", "Across", "The measure across", axes_of(()), self._draw)
        self.up = self.add_choice("up", "Up", "The measure up", axes_of(()), self._draw)
        self.across.setCurrentIndex(self.across.findData(D))
        self.up.setCurrentIndex(self.up.findData(V))
        self.knobs = self.add_choice("knobs", "What is tuned", "What is tuned", [], self._show_state)
        self.limit = self.add_choice(
            "limit", "Limit", "The texture may look no more different than this", limit_choices(None), lambda: None
        )
        self.suggest_button = self.add_button(
            "suggest",
            "Suggest thresholds",
            "Search for what makes the most that is new within the limit; every trial becomes a point",
            self.suggest,
        )
        self.stop_button = self.add_button("stop", "Stop", "Stop the search; its points stay", self.stop)
        self.take_button = self.add_button(
            "take", "Take", "Give the column the parameters that the search found", self.take
        )

    # What there is to show.

    def show_scene(self, scene: Scene) -> None:
        """Plot what there is, and show how far the search is."""
        before = self.scene
        super().show_scene(scene)
        if scene.exemplar is None:
            return
        self.show_body()
        self._show_state()
        # Only trials have come: they are drawn together.
        if scene.tuning.running and before.tuning.running and _same_but_tuning(scene, before):
            if not self._redraw.isActive():
                self._redraw.start()
        else:
            self._show_all()

    def _show_all(self) -> None:
        scene = self.scene
        self._redraw.stop()
        column = scene.selected
        replace_items(self.knobs, [] if column is None else knob_choices(column.method))
        groups = groups_of(scene)
        for box in (self.across, self.up):
            replace_items(box, axes_of(groups))
        own = self._own.get(D)
        replace_items(self.limit, limit_choices(own))
        self._draw()
        # What can be tuned may be another list now.
        self._show_state()

    def question(self, scene: Scene) -> Question | None:
        """Ask for the exemplar's own line."""
        self.why = self.empty
        exemplar = scene.exemplar
        if exemplar is None:
            return None
        given: ImageInput = exemplar

        def compute(should_stop: Callable[[], bool]) -> tuple[str, dict[str, float]]:
            return given.sha256, own_measures(given, should_stop=should_stop)

        return Question((self.name, exemplar.sha256), compute)

    def show_answer(self, answer: tuple[str, dict[str, float]]) -> None:
        """Draw the exemplar's own line."""
        self.show_scene(self.scene)

    @property
    def _own(self) -> dict[str, float]:
        """The numbers of another piece of the exemplar's source, as far as they are known."""
        exemplar = self.scene.exemplar
        known = self.answer is not None and exemplar is not None and self.answer[0] == exemplar.sha256
        return self.answer[1] if known else {}

    def _draw(self) -> None:
        scene = self.scene
        x, y = self.across.currentData(), self.up.currentData()
        what = (scene.points, scene.sweep.cells, scene.tuning.cells, scene.exemplar, x, y, tuple(self._own))
        if len(what) == len(self._drawn) and all(a is b or a == b for a, b in zip(what, self._drawn, strict=True)):
            return
        self._drawn = what
        self._point(None)
        self.plot.clear()
        self.points = []
        names: list[tuple[float, float, str, Role]] = []
        groups = groups_of(scene)
        for group, (role, line) in zip(groups, looks(groups), strict=True):
            there = placed(group.cells, x, y)
            found = [each for each in there if each is not None]
            self.points += found
            for curve in group.curves:
                joined = [each for each in (there[index] for index in curve) if each is not None]
                if len(joined) > 1:
                    self.plot.curve([each.x for each in joined], [each.y for each in joined], role, line=line)
            if found:
                trials = group.title == SEARCH
                across, up = [each.x for each in found], [each.y for each in found]
                self.plot.points(across, up, role, size=5 if trials else 8, faint=trials)
                names.append((found[-1].x, found[-1].y, group.title, role))
        # Where there is no room for all of them, those of the runs on top are seen.
        for each in reversed(names):
            self.plot.text(*each)
        self.plot.set_labels(find_measure(x).title, find_measure(y).title)
        self.plot.fit()
        self._draw_lines(x, y)

    def _draw_lines(self, x: str, y: str) -> None:
        """Draw where good ends and bad begins, and the exemplar's own line, as far as they are in view."""
        (left, right), (low, high) = self.plot.view.viewRange()
        own = self._own
        for name, first, last, is_across in ((x, left, right, True), (y, low, high, False)):
            lines: list[tuple[float, str, Role]] = [
                (value, words, "good" if words == "good" else "error") for value, words in zone_lines(name)
            ]
            if name in own:
                lines.append((own[name], "the exemplar's own", "exemplar"))
            for value, words, role in lines:
                if not first <= value <= last:
                    continue
                across, up = ([value, value], [low, high]) if is_across else ([left, right], [value, value])
                self.plot.curve(across, up, role, line="dash", width=1)
                self.plot.text(across[0], up[0], words, role)

    def _show_state(self) -> None:
        shown = self.scene.tuning
        self.suggest_button.setEnabled(self.scene.selected is not None and self.knobs.count() > 0)
        thresholds = self.knobs.currentData() in ((), None)
        self.suggest_button.setText("Suggest thresholds" if thresholds else "Suggest values")
        self.stop_button.setEnabled(shown.running)
        self.take_button.setEnabled(shown.found is not None and bool(shown.found.changes))
        self.progress.setVisible(shown.running)
        self.progress.setValue(round(1000 * shown.fraction))
        words = shown.problem or ("" if shown.found is None else shown.found.sentence)
        if shown.running:
            words = f"{_runs(len(shown.cells))} so far"
        elif shown.status == "stopped":
            words = f"Stopped after {_runs(len(shown.cells))}; click a point to take it"
        self.status.setText(words)

    # What the user does.

    def suggest(self) -> None:
        """Search instead of a search that runs."""
        column = self.scene.selected
        if column is not None:
            plan = TuningPlan(self.limit.currentData(), self.knobs.currentData() or (), BUDGET)
            self.intention.emit(RunTuning(column.id, plan))

    def stop(self) -> None:
        """Stop the search."""
        self.intention.emit(StopTuning())

    def take(self) -> None:
        """Take what the search found."""
        shown = self.scene.tuning
        if shown.found is not None:
            job = dataclasses.replace(shown.found.base, params=shown.found.found)
            self.intention.emit(TakeCell(Cell(index=0, job=job, values={}), (shown.column_id,)))

    def _hovered(self, x: float, y: float) -> None:
        width, height = self.plot.view.viewPixelSize()
        self._point(nearest(self.points, x, y, (width, height)))

    def _point(self, found: Placed | None) -> None:
        if found is self.over:
            return
        self.over = found
        self.picture.set_picture(None if found is None else found.shown.picture)
        x, y = self.across.currentData(), self.up.currentData()
        self.told.setText("" if found is None else describe_cell(found.shown.cell, x, y))
        self.plot.graph.viewport().setCursor(
            Qt.CursorShape.ArrowCursor if found is None else Qt.CursorShape.PointingHandCursor
        )

    def _clicked(self) -> None:
        if self.over is not None:
            chosen = self.scene.selected_id
            self.intention.emit(TakeCell(self.over.shown.cell, (chosen, self.over.shown.cell.index)))


def looks(groups: Sequence[Group]) -> list[tuple[Role, Line]]:
    """Return colour and line of each group: a method keeps its own when a search or a sweep comes."""
    apart: dict[str, tuple[Role, Line]] = {SEARCH: ("muted", "dot"), SWEEP: ("text", "solid")}
    left = [each for each in SERIES if each not in apart.values() and each[0] != "muted"]
    methods = [each.title for each in groups if each.title not in apart]
    return [apart.get(each.title) or left[methods.index(each.title) % len(left)] for each in groups]


def _same_but_tuning(scene: Scene, other: Scene) -> bool:
    """Whether nothing has come to be seen here but points of a search."""
    return (
        are_same(scene.columns, other.columns)
        and scene.selected_id == other.selected_id
        and all(getattr(scene, name) is getattr(other, name) for name in ("points", "sweep", "exemplar"))
    )


def _runs(count: int) -> str:
    return f"{count} run{'' if count == 1 else 's'}"
