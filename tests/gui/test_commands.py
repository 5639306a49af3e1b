"""Commands of the window: declared once, done to the right column, and what is shown after them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import Qt

from tests.gui.conftest import ids, wait_idle
from texlab.app.memory import memory_text
from texlab.columns.commands import COLUMN_COMMANDS

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

SHIFT = Qt.KeyboardModifier.ShiftModifier


def test_the_column_menu_does_to_its_own_column_what_it_says(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    explorer.session.select(first)
    views = explorer.workspace.columns
    views[second].actions_by_name["left"].trigger()
    assert ids(explorer) == [second, first]
    views[second].actions_by_name["right"].trigger()
    assert ids(explorer) == [first, second]
    # The window's own commands do it to the chosen column, and so do their keys.
    explorer.window.actions_by_name["right"].trigger()
    assert ids(explorer) == [second, first]
    qtbot.keyClick(explorer.window, Qt.Key.Key_Left, Qt.KeyboardModifier.ControlModifier | SHIFT)
    assert ids(explorer) == [first, second]
    views[second].actions_by_name["use"].trigger()
    wait_idle(qtbot, explorer)
    assert explorer.session.state.sample.source.name == "heeger-bergen result"


def test_column_commands_are_declared_once(explorer: Explorer) -> None:
    view = next(iter(explorer.workspace.columns.values()))
    for name, command in COLUMN_COMMANDS.items():
        assert (name in view.actions_by_name) == bool(command.own)
        action = explorer.window.actions_by_name[name]
        assert action.text() == command.text
        assert action.shortcut().toString() == command.keys
        assert action in explorer.window.menus[command.menu].actions()
    assert set(explorer.handlers._to_column) == set(COLUMN_COMMANDS)


def test_the_memory_is_told_again_and_again(explorer: Explorer, monkeypatch: pytest.MonkeyPatch) -> None:
    sizes = iter(["100 MB", "2000 MB"])
    monkeypatch.setattr("texlab.app.explorer.memory_text", lambda used: next(sizes))
    assert explorer._memory.isActive()
    assert not explorer._memory.isSingleShot()
    for expected in ("100 MB", "2000 MB"):
        explorer._memory.timeout.emit()
        assert explorer.window.status.memory.text() == expected


@pytest.mark.parametrize("pages", [0, 256, 512])
def test_memory_is_counted_in_megabytes(pages: int) -> None:
    assert memory_text(pages * 4096) == f"{pages // 256} MB"


def test_one_change_is_shown_once(explorer: Explorer, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[int] = []
    monkeypatch.setattr(explorer.window, "show_session", lambda session: shown.append(session.state.seed))
    explorer.session.set_seed(11)
    assert shown == [11]
    # Also what changes nothing but the history.
    explorer.session.reset_history()
    assert shown == [11, 11]


def test_width_and_height_are_not_taken_for_each_other(qtbot: Any, explorer: Explorer) -> None:
    bar = explorer.window.toolbar
    bar.width_box.setValue(64)
    bar.height_box.setValue(40)
    assert explorer.session.state.size == (40, 64)
    explorer.session.set_size((24, 56))
    assert (bar.height_box.value(), bar.width_box.value()) == (24, 56)
    wait_idle(qtbot, explorer)
