"""Why the pixel under the pointer is there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QStackedLayout

from texlab.docks.base import Question
from texlab.docks.explain import explainer_for
from texlab.docks.explain.unexplained import without_words
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.state.intentions import Pin, ShowMarks
from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.docks.explain.base import Explainer, ExplanationView
    from texlab.state.scene import ColumnScene, Probe, Scene
    from texlab.style.pictures import Mark

INVITATION = "Point at a pixel of a result to see why it is there; click it to keep it."


class ExplainDock(FramedDock):
    """Explains the pixel under the pointer, or the one that is pinned."""

    name = "explain"
    title = "Explain pixel"
    help = (
        "Why a pixel of a result is there: point at it, or click it to keep it (click it again to let it go). "
        "The candidates that it was chosen from are outlined in the exemplar too. For De Bonet: its ancestors "
        "from the coarsest level to the finest with their candidates, and the parent structures that were "
        "compared, with the thresholds as limits; arrows left and right change the level, up and down the "
        "candidate. For Efros-Leung: the window, its best matches, and the one that was copied. For "
        "Heeger-Bergen: what every subband adds to the pixel."
    )
    order = 22
    follows_pointer = True
    rest_ms = 0
    empty = INVITATION

    heavy = True

    def build(self) -> None:
        """Make the controls; the views come when they are needed."""
        self._views: dict[int, ExplanationView] = {}
        self._probe: Probe | None = None
        self._size = (1, 1)
        self._shown: tuple[int, Question, Explainer] | None = None
        self._marks: tuple[Mark, ...] = ()
        self._marked = False
        self._seen = True
        self.pixel_column = self.add_number(
            "column", "x", "Column of the pixel; typing one keeps the pixel", (0, 0), self._typed
        )
        self.pixel_row = self.add_number(
            "row", "y", "Row of the pixel; typing one keeps the pixel", (0, 0), self._typed
        )
        self.release = self.add_button(
            "release", "Let go", "Follow the pointer again instead of the kept pixel", self._let_go
        )
        self.state = Label()
        self.add_control(self.state, "state", "Which pixel", "The column and the pixel that are explained")
        self._pages = QStackedLayout(self.body)
        self._show_probe(None, None)

    def question(self, scene: Scene) -> Question | None:
        """Ask about the pixel under the pointer."""
        probe = scene.probe
        column = next((each for each in scene.columns if probe is not None and each.id == probe.column_id), None)
        self._show_probe(probe, column)
        self.why = ""
        if probe is None or column is None:
            return None
        result = column.result
        if result is None:
            # While the column runs, the explanation of its last result stays.
            if self._shown is not None and self._shown[0] == column.id and column.status in ("waiting", "running"):
                return self._shown[1]
            self._shown = None
            self.why = f"{column.title} has no finished result to explain."
            return None
        explainer = explainer_for(result.details)
        if explainer is None and column.stored:
            self.why = (
                f"The result of {column.title} is kept from before; F5 makes it anew, with what explains it."
            )
            return None
        if explainer is None:
            self.why = without_words(column)
            return None
        height, width = result.image.shape[:2]
        row, place = min(probe.row, height - 1), min(probe.column, width - 1)
        explain = explainer.explain

        def compute(should_stop: Callable[[], bool]) -> tuple[Explainer, Any]:
            return explainer, explain(result, row, place, should_stop)

        question = Question((self.name, Same(result), row, place), compute)
        self._shown = (column.id, question, explainer)
        return question

    def show_answer(self, answer: tuple[Explainer, Any]) -> None:
        """Show the explanation in the view of its kind."""
        explainer, explained = answer
        view = self._views.get(id(explainer))
        if view is None:
            view = self._views[id(explainer)] = explainer.make_view()
            view.set_theme(self.theme)
            view.marks_changed.connect(self._mark)
            view.intention.connect(self.intention)
            self._pages.addWidget(view)
        self._pages.setCurrentWidget(view)
        self.setFocusProxy(view)
        view.show_explanation(explained)

    def forget(self) -> None:
        """Let go of what is explained."""
        super().forget()
        self._shown = None

    def present_nothing(self, reason: str) -> None:
        """Show why there is nothing to show, and take the marks away."""
        super().present_nothing(self.why or INVITATION)
        self._mark(())

    def set_seen(self, seen: bool) -> None:
        """Outline places in the exemplar only while what they belong to is seen."""
        self._seen = seen
        self._mark(self._marks)

    def _mark(self, marks: tuple[Mark, ...]) -> None:
        self._marks = marks
        shown = marks if self._seen else ()
        if shown or self._marked:
            self._marked = bool(shown)
            self.intention.emit(ShowMarks(shown))

    def _show_probe(self, probe: Probe | None, column: ColumnScene | None) -> None:
        self._probe = probe
        known = column is not None and column.image is not None
        if column is not None and column.image is not None:
            self._size = column.image.shape[:2]
        for box, value, side in (
            (self.pixel_row, probe.row if probe else 0, self._size[0]),
            (self.pixel_column, probe.column if probe else 0, self._size[1]),
        ):
            box.setEnabled(known)
            with QSignalBlocker(box):
                if box.maximum() != max(side - 1, 0):
                    box.setMaximum(max(side - 1, 0))
                box.setValue(value)
        self.release.setEnabled(probe is not None and probe.pinned)
        kept = probe is not None and probe.pinned
        words = "" if column is None else f"{column.title}, {'kept' if kept else 'under the pointer'}"
        if words != self.state.text():
            self.state.setText(words)

    def _typed(self) -> None:
        probe = self._probe
        if probe is not None:
            row, column = self.pixel_row.value(), self.pixel_column.value()
            if (row, column) != (probe.row, probe.column):
                self.intention.emit(Pin(probe.column_id, row, column))

    def _let_go(self) -> None:
        if self._probe is not None and self._probe.pinned:
            probe = self._probe
            self.intention.emit(Pin(probe.column_id, probe.row, probe.column))
