"""The list of the session's steps: what it shows, and a click that goes there; with real events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import Qt

from tests.gui.conftest import hb, ids, wait_idle
from texlab.docks.history import START, HistoryDock
from texlab.docks.host import NOTHING_YET
from texlab.state.history import History
from texlab.state.intentions import GoToState
from texlab.state.scene import Scene
from texlab.state.session import Session

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

LEFT = Qt.MouseButton.LeftButton


# The session.


@pytest.fixture
def session(qapp: Any) -> Session:
    made = Session()
    for seed in (2, 3, 4):
        made.set_seed(seed)
    return made


def test_the_history_is_told_and_the_same_object_until_it_changes(session: Session) -> None:
    history = session.history
    assert (history.texts, history.at) == (("", "seed 2", "seed 3", "seed 4"), 3)
    session.set_seed(4)
    assert session.history is history
    session.undo()
    assert (session.history.texts, session.history.at) == (history.texts, 2)
    session.set_seed(9)
    assert (session.history.texts, session.history.at) == (("", "seed 2", "seed 3", "seed 9"), 3)


@pytest.mark.parametrize(("index", "seed"), [(0, 1), (1, 2), (2, 3), (3, 4), (-1, 4), (4, 4)])
def test_any_state_can_be_gone_to_and_nothing_beyond(session: Session, index: int, seed: int) -> None:
    session.go_to(index)
    assert session.state.seed == seed
    session.go_to(3)
    assert session.state.seed == 4
    assert session.redo_text is None


# The tab.


@pytest.fixture
def dock(qtbot: Any) -> HistoryDock:
    made = HistoryDock()
    qtbot.addWidget(made)
    made.resize(400, 300)
    made.show()
    return made


def show(dock: HistoryDock, *texts: str, at: int) -> None:
    scene = Scene(history=History(("", *texts), at))
    dock.show_scene(scene)
    question = dock.question(scene)
    if question is None:
        dock.present_nothing(NOTHING_YET)
    else:
        dock.present(question.compute(lambda: False))


def test_without_a_change_it_says_so(dock: HistoryDock) -> None:
    show(dock, at=0)
    assert dock.message == "Nothing was changed yet."


def test_a_click_and_the_arrow_keys_ask_for_a_state(dock: HistoryDock, qtbot: Any) -> None:
    show(dock, "exemplar <b>zebra", "seed 3", "alpha", at=2)
    rows = [dock.list.item(row) for row in range(dock.list.count())]
    assert [row.text() for row in rows] == [START, "Exemplar <b>zebra", "Seed 3", "Alpha"]
    assert dock.list.currentRow() == 2
    pale = [row.data(Qt.ItemDataRole.ForegroundRole) is not None for row in rows]
    assert pale == [False, False, False, True]
    sent: list[Any] = []
    dock.intention.connect(sent.append)
    qtbot.mouseClick(dock.list.viewport(), LEFT, pos=dock.list.visualItemRect(rows[0]).center())
    assert sent == [GoToState(0)]
    # What was asked for has been carried out.
    show(dock, "exemplar <b>zebra", "seed 3", "alpha", at=0)
    assert len(sent) == 1
    qtbot.keyClick(dock.list, Qt.Key.Key_Down)
    assert sent == [GoToState(0), GoToState(1)]


def test_in_the_window_a_removed_column_comes_back(explorer: Explorer, qtbot: Any) -> None:
    session, before = explorer.session, ids(explorer)
    session.reset_history()
    session.set_seed(77)
    explorer.window.actions_by_name["remove"].trigger()
    session.set_params(ids(explorer)[0], hb(iterations=3)[1], "iterations")
    wait_idle(qtbot, explorer)
    dock: Any = explorer.hosts["history"].dock
    explorer.window.docks["history"].show()
    explorer.window.docks["history"].raise_()
    qtbot.waitUntil(lambda: dock.list.count() == 4)
    row = dock.list.item(1)
    qtbot.mouseClick(dock.list.viewport(), LEFT, pos=dock.list.visualItemRect(row).center())
    assert ids(explorer) == before
    assert session.state.seed == 77
    wait_idle(qtbot, explorer)
    assert dock.list.currentRow() == 1
    assert dock.list.count() == 4
