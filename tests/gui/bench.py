"""Session, controller and carrier without a window; and a dock wired to them as the window does it."""

from __future__ import annotations

import inspect
from functools import partial
from typing import TYPE_CHECKING, Any

from mouse import on_screen

from tests.stub_method import StubParams, exemplar
from texlab.docks.host import DockHost
from texlab.runs.controller import Controller
from texlab.runs.slots import Slots
from texlab.state.chosen import Column, Sample, State
from texlab.state.session import Session
from texlab.style.theme import LIGHT
from texlab.window.carrier import Carrier

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.docks.base import Dock

HANDS = tuple(inspect.signature(Carrier).parameters)[1:]


def begin(
    session: Session,
    *columns: Column,
    seed: int = 5,
    size: tuple[int, int] = (24, 32),
    sample: Sample | None = None,
) -> None:
    """Give a session its first state, from which nothing can be undone, and choose its first column."""
    session.apply(State(None, columns, seed, size, len(columns) + 1), "start")
    session.select(columns[0].id)
    if sample is not None:
        session.set_sample(sample)
    session.reset_history()


class Bench:
    """A session, a controller and a carrier; what the carrier wants of the window is noted in ``asked``, by hand.

    Parameters
    ----------
    controller
        Makes the controller of a session, or a stand-in for it.
    **hands
        What the carrier uses instead of a note.
    """

    def __init__(self, controller: Callable[[Session], Any] = Controller, **hands: Callable[..., None]) -> None:
        self.session = Session()
        self.controller = controller(self.session)
        self.asked: dict[str, list[Any]] = {name: [] for name in HANDS}
        notes = {name: partial(self._note, name) for name in HANDS}
        self.carrier = Carrier(self.controller, **notes | hands)

    def _note(self, hand: str, *given: Any) -> None:
        self.asked[hand].append(given if len(given) > 1 else given[0])

    def hear(self) -> tuple[list[str], list[str]]:
        """Return what will be complained of, and what will be said."""
        problems: list[str] = []
        said: list[str] = []
        self.controller.problem.connect(problems.append)
        self.controller.said.connect(said.append)
        return problems, said


class DockBench(Bench):
    """A dock wired as in the window, beside columns of which the first is chosen.

    Parameters
    ----------
    dock, width, height
        The dock, and its size in pixels.
    columns
        One of the stub when there are none.
    """

    def __init__(self, qtbot: Any, dock: Dock, width: int, height: int, columns: tuple[Column, ...] = ()) -> None:
        super().__init__(choose=lambda column_id: self.session.select(column_id))
        self.qtbot = qtbot
        self.dock: Any = dock
        self.host = DockHost(dock, Slots(1))
        self.problems, self.said = self.hear()
        self.intended: list[Any] = []
        dock.intention.connect(self.intended.append)
        dock.intention.connect(self.carrier.carry_out)
        self.controller.scene_changed.connect(self.host.show_scene)
        qtbot.addWidget(dock)
        dock.set_theme(LIGHT)
        dock.resize(width, height)
        dock.show()
        on_screen(qtbot, dock)
        self._columns = columns or (Column(1, "stub", StubParams()),)

    def begin(self, height: int = 24, width: int = 32, given: Any = None) -> None:
        """Begin with results of this size, and wait for them; ``given`` is the exemplar."""
        begin(self.session, *self._columns, size=(height, width), sample=Sample(given or exemplar()))
        self.qtbot.waitUntil(lambda: not self.controller.busy)

    @property
    def params(self) -> Any:
        """Of the chosen column."""
        return self.session.selected_column.params

    def close(self) -> None:
        """End all threads."""
        self.host.close()
        self.controller.close()
        self.controller.deleteLater()
