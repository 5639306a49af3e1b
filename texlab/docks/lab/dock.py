"""The laboratory: a row of experiments, of which the chosen one asks and shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from PySide6.QtWidgets import QStackedWidget, QTabBar, QVBoxLayout, QWidget

from texlab.docks.base import Dock, Question
from texlab.docks.lab.equalize import EqualizePage
from texlab.docks.lab.filters import FiltersPage
from texlab.docks.lab.gabor_pair import GaborPairPage
from texlab.docks.lab.homogeneity import HomogeneityPage
from texlab.docks.lab.keys import KeysPage
from texlab.docks.lab.plane import PlanePage
from texlab.docks.lab.representation import RepresentationPage
from texlab.docks.lab.sphere import SpherePage
from texlab.docks.lab.steps import StepsPage
from texlab.docks.lab.support import SupportPage
from texlab.widgets.plain import tip_text

if TYPE_CHECKING:
    from texlab.docks.lab.page import LabPage
    from texlab.state.scene import Scene
    from texlab.style.theme import Theme

PAGES: tuple[type[LabPage], ...] = (
    FiltersPage,
    RepresentationPage,
    GaborPairPage,
    EqualizePage,
    SupportPage,
    StepsPage,
    KeysPage,
    PlanePage,
    HomogeneityPage,
    SpherePage,
)


class Answered(NamedTuple):
    """An answer and the experiment that asked for it."""

    page: str
    answer: Any


class LabDock(Dock):
    """Shows one experiment of the laboratory at a time."""

    name = "lab"
    title = "Laboratory"
    help = "The textbook's experiments: filters, equalization, pyramids, search keys, shape from texture."
    order = 95
    rest_ms = 0

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.bar = QTabBar()
        self.bar.setObjectName("lab-experiments")
        self.bar.setAccessibleName("Experiments")
        self.bar.setExpanding(False)
        self.bar.setUsesScrollButtons(True)
        self.bar.setDrawBase(False)
        self.pages = QStackedWidget()
        self._pages: dict[str, LabPage] = {}
        for make in PAGES:
            page = make()
            self._pages[page.name] = page
            index = self.bar.addTab(page.title)
            self.bar.setTabData(index, page.name)
            self.bar.setTabToolTip(index, tip_text(page.help))
            self.pages.addWidget(page)
            page.asks.connect(self.asks)
            page.intention.connect(self.intention)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.bar)
        layout.addWidget(self.pages, 1)
        self.bar.currentChanged.connect(self._changed)

    @property
    def page(self) -> LabPage:
        """The chosen experiment."""
        return self._pages[self.bar.tabData(self.bar.currentIndex())]

    def choose(self, name: str) -> None:
        """Choose an experiment by its name."""
        self.bar.setCurrentIndex(list(self._pages).index(name))

    def _changed(self, index: int) -> None:
        self.pages.setCurrentIndex(index)
        self.asks.emit()

    # The contract of docks: what the chosen experiment says.

    @property
    def message(self) -> str | None:
        """The sentence that is shown instead of the chosen experiment, or None."""
        return self.page.message

    def show_scene(self, scene: Scene) -> None:
        """Show what needs no computing."""
        self.page.show_scene(scene)

    def question(self, scene: Scene) -> Question | None:
        """Ask what the chosen experiment asks."""
        page = self.page
        page.show_scene(scene)
        question = page.question(scene)
        if question is None:
            return None
        compute = question.compute
        return Question((page.name, *question.key), lambda stop: Answered(page.name, compute(stop)))

    def present(self, answer: Answered) -> None:
        """Give an answer to the experiment that asked for it, also where another one is chosen by now."""
        self._pages[answer.page].present(answer.answer)

    def present_nothing(self, reason: str) -> None:
        """Say why there is nothing to show."""
        self.page.present_nothing(reason)

    def present_waiting(self) -> None:
        """Say that the answer is under way."""
        self.page.present_waiting()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        for page in self._pages.values():
            page.set_theme(theme)

    def set_seen(self, seen: bool) -> None:
        """Take note of whether it can be seen."""
        self.page.set_seen(seen)
