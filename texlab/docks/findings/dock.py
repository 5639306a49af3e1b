"""The dock of findings: a list, the places over the result, what to try with its numbers before and after."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QListWidget, QListWidgetItem, QScrollArea, QVBoxLayout, QWidget

from texlab.docks.base import Question
from texlab.docks.findings.words import (
    Tried,
    attempt,
    before_and_after,
    explanation,
    heading,
    marks,
    nothing_to_list,
    try_it,
)
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.style.pictures import to_picture
from texlab.style.text_size import follow_text
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.tables import add_copying, list_text

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.scene import ColumnScene, Scene
    from texlab.style.pictures import Picture
    from texlab_core.findings.finding import Finding


@dataclass(frozen=True, eq=False)
class Found:
    """What is shown: the findings of a column, its picture and the exemplar's."""

    column: ColumnScene
    findings: tuple[Finding, ...]
    result: Picture
    exemplar: Picture | None


# Between a word and the sides of the list.
SLACK = 10


class FindingsDock(FramedDock):
    """Lists what is wrong with the chosen column's result."""

    name = "findings"
    title = "Findings"
    help = (
        "What is wrong with the chosen column's result: where, why in this method, and what to try. ! is "
        "certain in "
        "nine of ten cases, ? is to be looked at. Choose one to outline its place; Try this applies the "
        "change, and "
        "the numbers before and after are shown."
    )
    order = 12
    heavy = True
    empty = "Findings appear when a result has been measured."

    def build(self) -> None:
        """Make list, explanation and picture."""
        self._tried: Tried | None = None
        self.apply = self.add_button("try", "Try this", "Apply what is to be tried to the column", self._try)
        self.outcome = Label(name="findings-outcome", muted=True, wraps=True)
        self.list = QListWidget()
        self.list.setObjectName("findings-list")
        self.list.setAccessibleName("Findings")
        set_tip(self.list, "What is wrong, certain things first; choose one to see where it is")
        add_copying(self.list, lambda: list_text(self.list))
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setWordWrap(True)
        self.list.setTextElideMode(Qt.TextElideMode.ElideNone)
        self.list.currentRowChanged.connect(self._choose)
        follow_text(self.list, self._give_width)
        self.text = Label(name="findings-text", wraps=True)
        self.text.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        words = QScrollArea()
        words.setObjectName("findings-words")
        words.setAccessibleName("What the finding says")
        words.setWidgetResizable(True)
        words.setWidget(self.text)
        middle = QWidget()
        column = QVBoxLayout(middle)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(words, 1)
        column.addWidget(self.outcome)
        self.pane = PicturePane("findings-pane", "Where it is")
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.list, 1)
        layout.addWidget(middle, 2)
        layout.addWidget(self.pane, 1)
        self._show_chosen()

    def show_scene(self, scene: Scene) -> None:
        """Show numbers before and after as far as they are there."""
        super().show_scene(scene)
        said = [before_and_after(self._tried, scene.columns)]
        column = scene.selected
        if column is not None and column.findings:
            said.append(column.unexamined)
        self.outcome.setText("\n".join(filter(None, said)))
        self.outcome.setVisible(bool(self.outcome.text()))

    def question(self, scene: Scene) -> Question | None:
        """Ask for the pictures of what was found."""
        column, exemplar = scene.selected, scene.exemplar
        tried = before_and_after(self._tried, scene.columns)
        if column is None or column.result is None or column.status != "finished":
            self.why = tried
            return None
        found = column.findings
        if not found:
            # What was tried against the last finding is told although the list has gone.
            self.why = " ".join(filter(None, (tried, nothing_to_list(column))))
            return None
        image = column.result.image

        def compute(should_stop: Callable[[], bool]) -> Found:
            shown = None if exemplar is None else to_picture(exemplar.pixels)
            return Found(column, found, to_picture(image), shown)

        return Question((self.name, Same(found), Same(image), Same(exemplar)), compute)

    def present_nothing(self, reason: str) -> None:
        """Say why there is no list, and offer nothing to be tried."""
        super().present_nothing(reason)
        self.apply.setEnabled(False)

    def show_answer(self, answer: Found) -> None:
        """List the findings; the one that was chosen stays chosen where it is still there."""
        before = self.list.currentItem()
        kept = before.data(Qt.ItemDataRole.UserRole) if before is not None else None
        blocked = self.list.blockSignals(True)
        self.list.clear()
        for each in answer.findings:
            item = QListWidgetItem(heading(each))
            item.setData(Qt.ItemDataRole.UserRole, each.id)
            set_tip(item, each.what)
            self.list.addItem(item)
        ids = [each.id for each in answer.findings]
        self.list.setCurrentRow(ids.index(kept) if kept in ids else 0)
        self.list.blockSignals(blocked)
        self._give_width()
        self._show_chosen()

    def _give_width(self) -> None:
        """Let no word of the list be broken."""
        metrics = self.list.fontMetrics()
        headings = (self.list.item(row).text() for row in range(self.list.count()))
        widest = max((metrics.horizontalAdvance(word) for text in headings for word in text.split()), default=0)
        bar = self.list.verticalScrollBar().sizeHint().width()
        self.list.setMinimumWidth(widest + bar + 2 * self.list.frameWidth() + SLACK)

    @property
    def chosen(self) -> Finding | None:
        """The finding that is chosen in the list."""
        row = self.list.currentRow()
        answer: Found | None = self.answer
        return answer.findings[row] if answer is not None and 0 <= row < len(answer.findings) else None

    def _choose(self, _: int) -> None:
        self._show_chosen()

    def _show_chosen(self) -> None:
        found, answer = self.chosen, self.answer
        if found is None or answer is None:
            self.apply.setEnabled(False)
            return
        self.text.setText(explanation(found))
        in_exemplar = found.where.place == "exemplar" and answer.exemplar is not None
        self.pane.set_picture(answer.exemplar if in_exemplar else answer.result)
        self.pane.set_marks(marks(found))
        self.apply.setEnabled(attempt(answer.column, found) is not None)

    def _try(self) -> None:
        found, column = self.chosen, self.scene.selected
        answer: Found | None = self.answer
        if found is None or column is None or answer is None or column.id != answer.column.id:
            return
        wanted = attempt(column, found)
        if wanted is not None:
            self._tried = try_it(column, found)
            self.intention.emit(wanted)
