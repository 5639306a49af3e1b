"""The laboratory: a row of experiments, of which the chosen one asks and shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from PySide6.QtCore import QSize
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
from texlab.state.scene import are_same
from texlab.widgets.plain import tip_text

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from PySide6.QtGui import QResizeEvent

    from texlab.docks.lab.page import LabPage
    from texlab.state.scene import Scene
    from texlab.style.theme import Theme
    from texlab.widgets.control_settings import Setting

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


# The setting that says which experiment is chosen.
CHOSEN = "experiments"


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

    def __init__(self, parent: QWidget | None = None, *, whole: bool = True) -> None:
        super().__init__(parent, whole=whole)
        self.bar = QTabBar()
        self.bar.setObjectName("lab-experiments")
        self.bar.setAccessibleName("Experiments")
        self.bar.setExpanding(False)
        self.bar.setUsesScrollButtons(True)
        self.bar.setDrawBase(False)
        self.pages = QStackedWidget()
        # Each is made when it is first chosen.
        self._pages: dict[str, LabPage] = {}
        self._theme: Theme | None = None
        self._folded = False
        for each in PAGES:
            index = self.bar.addTab(each.title)
            self.bar.setTabData(index, each.name)
            self.bar.setTabToolTip(index, tip_text(each.help))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.bar)
        layout.addWidget(self.pages, 1)
        self.bar.currentChanged.connect(self._changed)
        if whole:
            self._show_page()

    def pieces(self) -> Iterator[None]:
        """Make the experiment that is shown first, piece by piece."""
        kind = PAGES[self.bar.currentIndex()]
        if kind.name not in self._pages:
            page = kind(whole=False)
            yield
            yield from page.pieces()
            self._take(page)
        self._show_page()

    @property
    def page(self) -> LabPage:
        """The chosen experiment."""
        return self._made(PAGES[self.bar.currentIndex()])

    def _made(self, kind: type[LabPage]) -> LabPage:
        page = self._pages.get(kind.name)
        if page is None:
            page = kind()
            self._take(page)
        return page

    def _take(self, page: LabPage) -> None:
        """Take an experiment in, as all of them are."""
        self._pages[page.name] = page
        if self._theme is not None:
            page.set_theme(self._theme)
        page.fold_controls(self._folded)
        page.asks.connect(self.asks)
        page.intention.connect(self.intention)
        page.needs_room.connect(self._ask_for_room)
        self.pages.addWidget(page)

    def choose(self, name: str) -> None:
        """Choose an experiment by its name."""
        self.bar.setCurrentIndex([each.name for each in PAGES].index(name))

    def _show_page(self) -> None:
        self.pages.setCurrentWidget(self.page)

    def _changed(self, _: int) -> None:
        self._show_page()
        self._ask_for_room()
        self.asks.emit()

    # The contract of docks: what the chosen experiment says.

    @property
    def message(self) -> str | None:
        """The sentence that is shown instead of the chosen experiment, or None."""
        return self.page.message

    def note_scene(self, scene: Scene) -> None:
        """Let every experiment take note of it; those that lie behind let go of answers about another scene."""
        same = scene.exemplar is self.scene.exemplar and are_same(scene.columns, self.scene.columns)
        super().note_scene(scene)
        for page in self._pages.values():
            page.note_scene(scene)
            if not same and page is not self.page and page.answer is not None:
                page.forget()

    def show_scene(self, scene: Scene) -> None:
        """Show what needs no computing."""
        super().show_scene(scene)
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

    def forget(self) -> None:
        """Let every experiment go of its answer."""
        for page in self._pages.values():
            page.forget()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        for page in self._pages.values():
            page.set_theme(theme)

    def settings(self) -> dict[str, Setting]:
        """Return which experiment is chosen, and how its controls stand."""
        page = self.page
        within = page.name.removeprefix(f"{self.name}-")
        return super().settings() | {f"{within}-{name}": value for name, value in page.settings().items()}

    def least_height(self, width: int) -> int:
        """Return the height below which the chosen experiment has to be scrolled."""
        return self.page.least_height(width) + (0 if self._folded else self.bar.sizeHint().height())

    def minimumSizeHint(self) -> QSize:
        """Return the least size, without the names of the experiments where they are a control among others."""
        needed = super().minimumSizeHint()
        spare = self.bar.sizeHint().height() if self._folded and not self.bar.isHidden() else 0
        return needed - QSize(0, spare)

    def _make_bar(self) -> None:
        """Show the names of the experiments; with the controls folded away, where there is room for them."""
        room = self.height() - self.bar.sizeHint().height()
        self.bar.setVisible(not self._folded or room >= self.page.least_height(self.width()))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave the room to the chosen experiment."""
        super().resizeEvent(event)
        self._make_bar()

    def _ask_for_room(self) -> None:
        self._make_bar()
        self.needs_room.emit()

    def fold_controls(self, folded: bool) -> None:
        """Leave the whole room to what the experiments show, or show their controls again."""
        self._folded = folded
        self._make_bar()
        for page in self._pages.values():
            page.fold_controls(folded)

    def is_prepared(self, wanted: Mapping[str, Any]) -> bool:
        """Return whether the experiment that is wanted is made."""
        return not any(kind.name == wanted.get(CHOSEN) and kind.name not in self._pages for kind in PAGES)

    def prepare(self, wanted: Mapping[str, Any]) -> None:
        """Make the experiment that is wanted; the one that is chosen stays in front."""
        for kind in PAGES:
            if kind.name == wanted.get(CHOSEN):
                self._made(kind).set_seen(False)

    def set_seen(self, seen: bool) -> None:
        """Take note of whether it can be seen."""
        self.page.set_seen(seen)
