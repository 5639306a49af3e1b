"""Columns in windows of their own: they live on, have their keys, and go back; with real events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from tests.gui.conftest import hb, ids, on_screen, result_image, wait_idle
from texlab.columns.apart import MAX_GEOMETRY, ColumnWindow, places_from_json, places_to_json
from texlab.style.pictures import to_picture

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer

SHIFT = Qt.KeyboardModifier.ShiftModifier


def test_places_come_back_from_the_settings() -> None:
    places = {7: b"\0geometry", 9: b""}
    data = places_to_json(places, (5, 7, 9))
    assert [place for place, _ in data] == [1, 2]
    assert places_from_json(data, (5, 7, 9)) == places
    # Other ids in another session; places that are not there any more are left out.
    assert places_from_json(data, (1, 2)) == {2: b"\0geometry"}


@pytest.mark.parametrize(
    "damaged",
    [None, 3, {"a": 1}, [3], [[0]], [[0, 3]], [["0", ""]], [[True, ""]], [[-1, ""]], [[0, "no base64 !"]]],
)
def test_damaged_places_are_left_out(damaged: Any) -> None:
    assert places_from_json(damaged, (1, 2)) == {}
    assert len(places_from_json([[0, "A" * 8 * MAX_GEOMETRY]], (1,))[1]) <= MAX_GEOMETRY


def test_a_column_lives_on_in_its_own_window_and_goes_back(qtbot: Any, explorer: Explorer) -> None:
    window, stage = explorer.window, explorer.workspace
    first, second = ids(explorer)
    view = stage.columns[second]
    explorer.session.select(second)
    wait_idle(qtbot, explorer)
    qtbot.keyClick(window, Qt.Key.Key_M, SHIFT)
    own = stage.apart.windows[second]
    on_screen(qtbot, own)
    assert own.isWindow()
    assert view.window() is own
    assert view.isVisible()
    assert [each for each in stage.grid.cells if each is not stage.exemplar] == [stage.columns[first]]
    assert view.method_box.label in own.windowTitle()
    # It goes on living: another seed, another picture; the frame and the title follow.
    before = view.pane.picture
    explorer.session.set_seed(99)
    wait_idle(qtbot, explorer)
    assert not np.array_equal(view.pane.picture, before)
    assert np.array_equal(view.pane.picture, to_picture(result_image(explorer, second)))
    explorer.session.rename_column(second, "apart")
    wait_idle(qtbot, explorer)
    assert own.windowTitle() == "apart - TexLab"
    # Its commands have their keys there: undo, and the way back.
    own.activateWindow()
    view.setFocus()
    qtbot.waitUntil(lambda: QApplication.activeWindow() is own)
    qtbot.keyClick(own, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert explorer.session.state.column(second).name == ""
    # Enlarged, it takes the screen.
    qtbot.mouseDClick(view.pane.viewport(), Qt.MouseButton.LeftButton)
    assert own.windowState() & Qt.WindowState.WindowMaximized
    assert stage.enlarged is None
    own.close()
    assert second not in stage.apart
    assert view.window() is window
    assert view.isVisible()
    assert [each for each in stage.grid.cells if each is not stage.exemplar] == [
        stage.columns[first], stage.columns[second],
    ]  # fmt: skip
    qtbot.waitUntil(lambda: not window.findChildren(ColumnWindow))
    wait_idle(qtbot, explorer)


def test_windows_of_columns_come_and_go_with_them(qtbot: Any, explorer: Explorer) -> None:
    stage, session = explorer.workspace, explorer.session
    first, second = ids(explorer)
    for each in (first, second):
        stage.turn_apart(each)
    # The exemplar stays; what is enlarged is a column of the stage.
    assert stage.grid.cells == (stage.exemplar,)
    session.remove_column(second)
    wait_idle(qtbot, explorer)
    assert set(stage.apart.windows) == {first}
    session.undo()
    wait_idle(qtbot, explorer)
    assert set(stage.apart.windows) == {first, second}
    stage.turn_apart(second)
    assert set(stage.apart.windows) == {first}
    session.remove_column(second)
    wait_idle(qtbot, explorer)
    session.undo()
    wait_idle(qtbot, explorer)
    assert set(stage.apart.windows) == {first}
    # The layout Tune folds what stands on the stage; a layout of one's own has its windows.
    explorer.own_layouts.keep("two screens")
    explorer.window.actions_by_name["layout-tune"].trigger()
    assert stage.columns[first].isVisible()
    stage.apart.put_all_back()
    assert not stage.apart.windows
    explorer.own_layouts.take("two screens")
    assert set(stage.apart.windows) == {first}
    wait_idle(qtbot, explorer)


def test_they_come_back_with_the_session(
    qtbot: Any, explorer: Explorer, open_window: Callable[..., Explorer], texture: Path
) -> None:
    second = ids(explorer)[1]
    explorer.workspace.turn_apart(second)
    explorer.workspace.apart.windows[second].resize(333, 444)
    explorer.window.close()
    assert not [
        each for each in QApplication.topLevelWidgets() if isinstance(each, ColumnWindow) and each.isVisible()
    ]
    again = open_window(None)
    windows = again.workspace.apart.windows
    assert list(windows) == [ids(again)[1]]
    window = next(iter(windows.values()))
    assert (window.width(), window.height()) == (333, 444)
    assert np.array_equal(again.workspace.columns[ids(again)[1]].pane.picture is None, False)


def test_a_column_that_goes_back_while_it_is_folded_away_belongs_to_the_stage(explorer: Explorer) -> None:
    stage, (first, second) = explorer.workspace, ids(explorer)
    stage.turn_apart(second)
    stage.show_only((first,))
    stage.turn_apart(second)
    assert stage.isAncestorOf(stage.columns[second])
    assert not stage.columns[second].isVisible()
    stage.show_only(None)
    assert stage.columns[second] in stage.grid.cells


def test_a_window_that_is_put_back_stays_back(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_window(str(texture), [hb()])
    only = ids(explorer)[0]
    stage = explorer.workspace
    stage.enlarge(only)
    stage.turn_apart(only)
    assert stage.enlarged is None
    assert stage.exemplar.isVisible()
    explorer.session.select(only)
    stage.reveal(only)
    stage.turn_apart(only)
    assert stage.columns[only].window() is explorer.window
    assert not stage.apart.is_wanted(only)
