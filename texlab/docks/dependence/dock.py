"""How bands depend on each other: histograms of exemplar and results, linked to their pixels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtWidgets import QComboBox, QHBoxLayout, QVBoxLayout

from texlab.columns.titles import titles
from texlab.docks.base import Question
from texlab.docks.dependence.panel_view import PanelView
from texlab.docks.dependence.panels import panels
from texlab.docks.dependence.ready import ASKING, choices, opening
from texlab.docks.frame import FramedDock, LookedAt, replace_items, shown_image
from texlab.state.intentions import LightUp, Pin
from texlab.widgets.plain import ShortLabel
from texlab.widgets.view_link import ViewLink
from texlab_core.stats.dependence import FARTHEST, MOST_LEVEL, Pair

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab.docks.dependence.panels import Panel
    from texlab.state.scene import ColumnScene, Probe, Scene
    from texlab_core.stats.dependence import Rectangle

SHOWN = ("exemplar", "result", "result beside it")
RELATIONS = [
    ("parent and child", "parent"),
    ("two orientations", "orientation"),
    ("neighbours", "neighbour"),
]
LEVELS = [("level 0 (finest)", 0), *((f"level {level}", level) for level in range(1, MOST_LEVEL + 1))]
ORIENTATIONS = [("all orientations", -1), *((f"{45 * turn}°", turn) for turn in range(4))]
TURNS = [(f"turned by {45 * turn}°", turn) for turn in (1, 2, 3)]
VALUES = [("coefficients", "coefficients"), ("magnitudes", "magnitudes"), ("ranks", "ranks")]
# Places of columns are counted from 1.
BESIDE: list[tuple[str, Any]] = [("beside: another method", -1), ("no other column", 0)]
SHAPES = [("conditional", "conditional"), ("joint", "joint")]


class DependenceDock(FramedDock):
    """Shows joint and conditional histograms of two bands."""

    name = "dependence"
    title = "Dependence"
    help = (
        "What a coefficient has to do with its parent, another orientation or a neighbour: exemplar beside the "
        "result. Choose cells of a histogram: their pixels light up here and in the columns."
    )
    order = 21
    rest_ms = 20
    empty = "Histograms appear as soon as there is an exemplar."
    # An example opens a picture.
    no_settings = frozenset({"ready"})

    heavy = True

    def build(self) -> Iterator[None]:
        """Make the controls and the panels."""
        self._brush: Rectangle | None = None
        self._probe: Probe | None = None
        self._seen, self._lights = True, False
        self.relation = self.add_choice(
            "relation", "Relation", "Which two coefficients are looked at together", RELATIONS, self._pair_changed
        )
        self.level = self.add_choice(
            "level", "Level", "Of the coefficient that is looked at: an octave each", LEVELS, self.ask
        )
        self.orientation = self.add_choice(
            "orientation",
            "Orientation",
            "Of the waves: 0° are vertical stripes; clockwise",
            ORIENTATIONS,
            self.ask,
        )
        self.turn = self.add_choice(
            "turn", "Other orientation", "By how much the given orientation is turned on", TURNS, self.ask
        )
        self.turn.setCurrentIndex(1)
        limits = (-FARTHEST, FARTHEST)
        tip = (
            "Neighbour: how many samples of the band to the right; they lie 2, 4, 8 pixels apart at levels 1, 2, 3"
        )
        self.right = self.add_number("right", "x", tip, limits, self.ask)
        self.down = self.add_number("down", "y", "Neighbour: how many samples of the band down", limits, self.ask)
        self.right.setValue(1)
        self.values = self.add_choice(
            "values",
            "Values",
            "On the axes: coefficients with their sign, magnitudes as powers of two, or their ranks (of which the "
            "numbers are made)",
            VALUES,
            self._forget_brush,
        )
        self.shape = self.add_choice(
            "shape",
            "Histogram",
            "Conditional: every column is normalized, which shows a bow tie where magnitudes go together",
            SHAPES,
            self._redraw,
        )
        self.curves = self.add_switch(
            "curves", "Mean ± sd", "Mean and standard deviation of every column", lambda _: self._redraw()
        )
        tip = "Another column's result beside the chosen one; another method: De Bonet's, or the next column"
        self.beside = self.add_choice("beside", "Beside", tip, BESIDE, self.ask)
        tip = "Open an example of the papers or the textbook, with De Bonet's method beside it"
        self.ready = self.add_choice("ready", "Examples", tip, [("Examples ...", ""), *choices()], self._open)
        # The longest example must not take a line of its own.
        self.ready.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.ready.setMinimumContentsLength(10)
        self.ready.view().setMinimumWidth(self.ready.view().sizeHintForColumn(0) + 24)
        self.pair_name = ShortLabel(name="dependence-pair", muted=True)
        self.readout = self.add_readout()
        link = ViewLink()
        yield
        self.views = [PanelView(f"dependence-{place}", what, link) for place, what in enumerate(SHOWN)]
        line = QHBoxLayout()
        line.setSpacing(10)
        for view in self.views:
            line.addWidget(view, 1)
            view.joint.brushed.connect(self._brushed)
            view.joint.pointed.connect(self._pointed)
            view.pinned.connect(lambda column_id, row, place: self.intention.emit(Pin(column_id, row, place)))
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 4)
        layout.setSpacing(1)
        layout.addLayout(line, 1)
        layout.addWidget(self.pair_name)
        self.setFocusProxy(self.views[0].joint)
        self.curves.setChecked(True)
        self._pair_changed(quietly=True)

    # Asking and showing.

    @property
    def pair(self) -> Pair | None:
        """What the controls say; None for a place and itself."""
        relation = self.relation.currentData()
        offset = self.down.value(), self.right.value()
        if relation == "neighbour" and offset == (0, 0):
            return None
        turn = self.orientation.currentData()
        return Pair(
            relation,
            self.level.currentData(),
            None if turn < 0 else turn,
            self.turn.currentData() if relation == "orientation" else 2,
            offset if relation == "neighbour" else (0, 1),
        )

    def show_scene(self, scene: Scene) -> None:
        """Mark the cells of the pixel that is asked about."""
        super().show_scene(scene)
        self._probe = scene.probe
        self._mark_probe()

    def question(self, scene: Scene) -> Question | None:
        """Ask for the histograms of the exemplar, the chosen column and the one beside it."""
        self.why = ""
        looked_at = self.looked_at(scene)
        self._fill_beside(scene)
        if scene.exemplar is None:
            return None
        pair, values = self.pair, self.values.currentData()
        if pair is None:
            self.why = "A place and itself are always the same: choose a neighbour, x or y other than 0."
            return None
        height, width = scene.exemplar.size
        if min(height, width) < pair.smallest:
            self.why = (
                f"Level {pair.level} needs an exemplar of at least {pair.smallest} pixels a side; this one has "
                f"{width} × {height}."
            )
            return None
        exemplar = LookedAt(scene.exemplar.pixels)
        names = dict(zip((each.id for each in scene.columns), titles(scene.columns), strict=True))
        results = [] if scene.selected is None else [(names[scene.selected_id], scene.selected_id, looked_at)]
        other = self._other(scene)
        if other is not None:
            results.append((names[other.id], other.id, LookedAt(shown_image(other))))
        # What is too small, like a first preview, is left out.
        seen = tuple(each for each in results if min(_size(each[2]), default=0) >= pair.smallest)
        brush = self._brush

        def compute(should_stop: Callable[[], bool]) -> tuple[Panel, ...]:
            return panels(exemplar, seen, pair, values, brush, should_stop)

        keys = tuple((name, column_id, shown.key) for name, column_id, shown in seen)
        return Question((self.name, exemplar.key, keys, pair, values, brush), compute)

    def show_answer(self, answer: tuple[Panel, ...]) -> None:
        """Show every panel."""
        self._redraw()
        for view in self.views:
            view.joint.show_brush(self._brush)
        self._mark_probe()
        self._light_up()
        here, given = answer[0].found.pair.names()
        said = f"Upwards: {here}. To the right: {given}."
        if answer[0].share is not None:
            parts = ", ".join(f"{each.title} {each.share:.2%}" for each in answer if each.share is not None)
            said = f"The chosen cells hold: {parts}. {said}"
        self.pair_name.setText(said)

    def clear_shown(self) -> None:
        """Let go of the panels."""
        super().clear_shown()
        self._redraw()

    def present_nothing(self, reason: str) -> None:
        """Show why there is nothing; nothing lights up then."""
        super().present_nothing(reason)
        self._light_up()

    def set_seen(self, seen: bool) -> None:
        """Light pixels up in the columns only while the tab is seen."""
        super().set_seen(seen)
        self._seen = seen
        self._light_up()

    def _light_up(self) -> None:
        """Let the pixels of the chosen cells light up in their columns, too."""
        shown: tuple[Panel, ...] = (self.answer or ()) if self._seen and self._brush is not None else ()
        places = tuple(each.lit for each in shown if each.lit is not None)
        if places or self._lights:
            self._lights = bool(places)
            self.intention.emit(LightUp(places))

    def _redraw(self) -> None:
        shown: tuple[Panel, ...] = self.answer or ()
        conditional, curves = self.shape.currentData() == "conditional", self.curves.isChecked()
        self.curves.setEnabled(conditional)
        for place, view in enumerate(self.views):
            panel = shown[place] if place < len(shown) else None
            view.show_panel(panel, conditional=conditional, curves=curves)

    def _mark_probe(self) -> None:
        probe = self._probe
        for view in self.views:
            here = probe is not None and view.panel is not None and view.panel.column_id == probe.column_id
            view.keep_marked((probe.row, probe.column) if here and probe is not None else None)

    def _fill_beside(self, scene: Scene) -> None:
        chosen = next((k for k, each in enumerate(scene.columns, 1) if each.id == scene.selected_id), 0)
        names = enumerate(titles(scene.columns), 1)
        replace_items(self.beside, [*BESIDE, *((f"beside: {title}", k) for k, title in names if k != chosen)])

    def _other(self, scene: Scene) -> ColumnScene | None:
        """Return the column that is shown beside the chosen one."""
        place = self.beside.currentData()
        if place > 0:
            return scene.columns[place - 1] if place <= len(scene.columns) else None
        others = [each for each in scene.columns if each.id != scene.selected_id] if place < 0 else []
        return next((each for each in others if each.method == ASKING), next(iter(others), None))

    # What the user does.

    def _pair_changed(self, *, quietly: bool = False) -> None:
        relation = self.relation.currentData()
        self.turn.setVisible(relation == "orientation")
        for box in (self.right, self.down):
            box.setVisible(relation == "neighbour")
        if not quietly:
            self.ask()

    def _forget_brush(self) -> None:
        """Ask anew: the cells of other axes are other cells."""
        self._brush = None
        self._light_up()
        self.ask()

    def _brushed(self, brush: Rectangle | None) -> None:
        self._brush = brush
        if brush is None:
            self._light_up()
        for view in self.views:
            view.joint.show_brush(brush)
        self.ask()

    def _pointed(self, row: int, column: int) -> None:
        joint = self.sender()
        view = next((each for each in self.views if each.joint is joint), None)
        self.readout.tell(lambda: "" if view is None else view.joint.describe(row, column))

    def _open(self) -> None:
        name = self.ready.currentData()
        self.ready.setCurrentIndex(0)
        if name:
            self.intention.emit(opening(name))


def _size(shown: LookedAt) -> tuple[int, ...]:
    """Return height and width of what is shown, or nothing."""
    if shown.stage is not None:
        return shown.stage.picture.shape[:2]
    return () if shown.image is None else shown.image.shape[:2]
