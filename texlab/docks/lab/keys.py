"""Matching parent structures of a De Bonet result: blank search, hash keys and the hierarchy, with counters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QTableWidget, QTableWidgetItem, QVBoxLayout

from texlab.docks.base import Question
from texlab.docks.lab.page import MARGINS, LabPage, looker
from texlab.docks.recent import Recent, Same
from texlab.widgets.plain import set_tip
from texlab.widgets.tables import make_quiet
from texlab_core.methods.de_bonet.report import DeBonetDetails
from texlab_core.methods.de_bonet.search import (
    COMPONENTS,
    MOST_COMPONENTS,
    KeyIndex,
    Searched,
    Survey,
    search,
    survey,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.scene import Scene
    from texlab_core.methods.de_bonet.search import Tally

WAYS = ("blank search", "hash keys", "hierarchy")
HEADS = ("keys, this place", "compared", "found", "keys, a place on average", "compared", "found")


@dataclass(frozen=True, eq=False)
class KeysAnswer:
    """The counters of one place, if one is pointed at, and of the whole level."""

    here: Searched | None
    place: tuple[int, int] | None
    whole: Survey


class KeysPage(LabPage):
    """Counts what each way of searching looks at."""

    name = "lab-keys"
    follows_pointer = True
    title = "Keys"
    help = "How many structures are compared by blank search, by hash keys and by the hierarchy (exercise 1)."
    empty = "Choose a column of De Bonet with a finished result; point at a pixel of it, or pin one by a click."

    def build(self) -> None:
        """Make the controls, the table and the words."""
        self._recent = Recent(6)
        tip = "Level whose parent structures are searched; a pixel takes a child of a match of level 1"
        self.level = self.add_number("level", "level", tip, (1, 12), self.ask)
        tip = "Numbers of a key: more of them leave fewer structures under it, and more keys to look at"
        self.components = self.add_number("components", "numbers of a key", tip, (1, MOST_COMPONENTS), self.ask)
        self.components.setValue(COMPONENTS)
        self.table = QTableWidget(len(WAYS), len(HEADS))
        self.table.setObjectName("lab-keys-counters")
        self.table.setAccessibleName("Counters")
        self.table.setHorizontalHeaderLabels(list(HEADS))
        self.table.setVerticalHeaderLabels(list(WAYS))
        make_quiet(self.table)
        tip = "Keys looked at, structures compared and structures found, for the place pointed at and on average"
        set_tip(self.table, tip)
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(*MARGINS)
        layout.addWidget(self.table)
        layout.addWidget(self.make_words())

    def question(self, scene: Scene) -> Question | None:
        """Ask for the counters of the chosen column's result."""
        self.why = self.empty
        column = scene.selected
        details = None if column is None or column.result is None else column.result.details
        if not isinstance(details, DeBonetDetails) or details.sampling.grid.depth == 0:
            return None
        sampling, recent, probe = details.sampling, self._recent, scene.probe
        level, components = min(self.level.value(), sampling.grid.depth), self.components.value()
        place = None
        if probe is not None and column is not None and probe.column_id == column.id and probe.row >= 0:
            height, width = sampling.grid.shape(level)
            place = (min(probe.row >> level, height - 1), min(probe.column >> level, width - 1))

        def compute(should_stop: Callable[[], bool]) -> KeysAnswer:
            look = looker(should_stop)
            key = (Same(sampling), level, components)
            whole = recent.get(key, lambda: survey(sampling, level, components, look))
            if place is None:
                return KeysAnswer(None, None, whole)
            index = recent.get((*key, "index"), lambda: KeyIndex(sampling, level, components))
            return KeysAnswer(search(sampling, *place, level, components, index), place, whole)

        return Question((Same(sampling), level, components, place), compute)

    def show_answer(self, answer: KeysAnswer) -> None:
        """Fill in the counters."""
        here, whole = answer.here, answer.whole
        for row, way in enumerate(("blank", "keys", "hierarchy")):
            first: Tally | None = None if here is None else getattr(here, way)
            cells = ["", "", ""] if first is None else [f"{first.keys}", f"{first.verified}", f"{first.found}"]
            total: Tally = getattr(whole, way)
            means = (total.keys, total.verified, total.found)
            cells += [f"{value / whole.locations:.1f}" for value in means]
            for column, text in enumerate(cells):
                item = QTableWidgetItem(text)
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                self.table.setItem(row, column, item)
        words = (
            f"Level {whole.level}: {whole.locations} places of the result, {whole.structures} parent structures "
            f"of the exemplar under {whole.distinct} keys."
        )
        if here is not None and answer.place is not None:
            key = ", ".join(str(each) for each in here.key)
            words += (
                f" The structure of place {answer.place[1]}, {answer.place[0]} has the key ({key}); all three "
                f"ways find the same {here.matches.size}."
            )
        self.words.setText(words)
