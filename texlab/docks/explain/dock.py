"""Why the pixel under the pointer is there; of A and B while two columns are compared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QHBoxLayout

from texlab.columns.titles import titles
from texlab.docks.base import Question
from texlab.docks.explain import explainer_for
from texlab.docks.explain.side import Side
from texlab.docks.explain.unexplained import without_words
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.state.intentions import Pin, ShowMarks
from texlab.state.scene import asked_columns
from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.docks.explain.base import Explainer
    from texlab.state.scene import ColumnScene, Probe, Scene
    from texlab.style.pictures import Mark

INVITATION = "Point at a pixel of a result to see why it is there; click it to keep it."
LETTERS = "AB"


@dataclass(frozen=True, eq=False)
class Part:
    """What is asked about one column: why it cannot be explained, or how it is."""

    reason: str = ""
    key: tuple[Any, ...] = ()
    explainer: Explainer | None = None
    explain: Callable[[Callable[[], bool]], Any] | None = None

    def answer(self, heading: str, should_stop: Callable[[], bool]) -> Answer:
        """Return what is to be shown below a heading (in a background thread)."""
        explained = None if self.explain is None else self.explain(should_stop)
        return Answer(heading, self.reason, self.explainer, explained)


@dataclass(frozen=True, eq=False)
class Answer:
    """What one side shows: what ``explainer`` returned, or the reason why there is nothing."""

    heading: str
    reason: str
    explainer: Explainer | None
    explained: Any


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
        "Heeger-Bergen: what every subband adds to the pixel. While A and B are compared (layout Tune), the same "
        "pixel is explained in both, side by side; B's places of the exemplar are dotted."
    )
    order = 22
    follows_pointer = True
    rest_ms = 0
    empty = INVITATION
    # The pixel is a result's.
    no_settings = frozenset({"column", "row"})

    heavy = True

    def build(self) -> None:
        """Make the controls; the views come when they are needed."""
        self._probe: Probe | None = None
        self._size = (1, 1)
        self._last: dict[int, Part] = {}
        self._marks: tuple[Mark, ...] = ()
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
        self.sides = tuple(Side(letter) for letter in LETTERS)
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        for side, other in zip(self.sides, reversed(self.sides), strict=True):
            layout.addWidget(side, 1)
            side.marks_changed.connect(lambda _: self._show_marks())
            side.intention.connect(self.intention)
            side.aspect_changed.connect(other.take_aspect)
        self.sides[1].hide()
        self.setFocusProxy(self.sides[0])
        self._show_probe(None, None)

    def question(self, scene: Scene) -> Question | None:
        """Ask about the pixel under the pointer."""
        probe = scene.probe
        every = zip(scene.columns, titles(scene.columns), strict=True)
        named = {column.id: (column, title) for column, title in every}
        asked = [named[each] for each in asked_columns(scene) if each in named]
        both = len(asked) > 1
        pointed = None if probe is None else named.get(probe.column_id, (None, ""))[0]
        self._show_probe(probe, pointed, both=both)
        lettered = zip(LETTERS, asked, strict=False)
        headings = [f"{letter}: {title}" if both else "" for letter, (_, title) in lettered]
        parts = [self._part(column, probe) for column, _ in asked if probe is not None]
        # Without a pixel nothing is kept: a result that nobody asks about may go.
        self._last = {column.id: part for (column, _), part in zip(asked, parts, strict=False) if part.key}
        self.why = "" if both or not parts else parts[0].reason
        if not parts or self.why:
            return None

        def compute(should_stop: Callable[[], bool]) -> list[Answer]:
            return [part.answer(heading, should_stop) for heading, part in zip(headings, parts, strict=True)]

        return Question((self.name, *headings, *(part.key or part.reason for part in parts)), compute)

    def _part(self, column: ColumnScene, probe: Probe) -> Part:
        """Return how the pixel is explained in a column."""
        result = column.result
        if result is None:
            # While the column runs, the explanation of its last result stays.
            if column.id in self._last and column.status in ("waiting", "running"):
                return self._last[column.id]
            return Part(f"{column.title} has no finished result to explain.")
        explainer = explainer_for(result.details)
        if explainer is None and column.stored:
            return Part(
                f"The result of {column.title} is kept from before; F5 makes it anew, with what explains it."
            )
        if explainer is None:
            return Part(without_words(column))
        height, width = result.image.shape[:2]
        if column.id != probe.column_id and not (probe.row < height and probe.column < width):
            return Part(f"The pixel lies beyond this result, which has {width} x {height} pixels.")
        row, place = min(probe.row, height - 1), min(probe.column, width - 1)
        explain = explainer.explain
        return Part(
            key=(Same(result), row, place),
            explainer=explainer,
            explain=lambda should_stop: explain(result, row, place, should_stop),
        )

    def show_answer(self, answer: list[Answer]) -> None:
        """Show the explanations, each in the view of its kind."""
        for side, each in zip(self.sides, answer, strict=False):
            side.set_heading(each.heading)
            if each.explainer is None:
                side.show_reason(each.reason)
            else:
                side.show_explanation(each.explainer, each.explained, self.theme)
        if len(answer) == 1:
            self.sides[1].show_reason("")
        self.sides[1].setVisible(len(answer) > 1)

    def forget(self) -> None:
        """Let go of what is explained."""
        super().forget()
        self._last = {}

    def clear_shown(self) -> None:
        """Empty both sides, and outline nothing."""
        super().clear_shown()
        for side in self.sides:
            side.show_reason("")

    def present_nothing(self, reason: str) -> None:
        """Show why there is nothing to show, and take the marks away."""
        super().present_nothing(self.why or INVITATION)

    def set_seen(self, seen: bool) -> None:
        """Outline places in the exemplar only while what they belong to is seen."""
        self._seen = seen
        self._show_marks()

    def _show_marks(self) -> None:
        # B's lie below, and what A and B share is A's.
        shown = tuple(mark for side in reversed(self.sides) for mark in side.marks) if self._seen else ()
        if shown != self._marks:
            self._marks = shown
            self.intention.emit(ShowMarks(shown))

    def _show_probe(self, probe: Probe | None, column: ColumnScene | None, *, both: bool = False) -> None:
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
        whose = "A and B" if both else "" if column is None else column.title
        words = "" if column is None else f"{whose}, {'kept' if kept else 'under the pointer'}"
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
