"""What a panel shows follows from the present state, whatever came before."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt

from tests.gui.conftest import ids, wait_idle
from texlab_core.engine.registry import methods

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from PySide6.QtWidgets import QWidget

    from texlab.app.explorer import Explorer


def type_number(qtbot: Any, box: QWidget, value: int) -> None:
    box.setFocus()
    box.selectAll()  # type: ignore[attr-defined]
    qtbot.keyClicks(box, str(value))
    qtbot.keyClick(box, Qt.Key.Key_Return)


def test_thresholds_and_sweeps_after_a_stopped_run(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_window(str(texture), [("de-bonet", methods()["de-bonet"].params())], wait=False)
    qtbot.waitUntil(lambda: explorer.session.state.sample is not None)
    (column_id,) = ids(explorer)
    bar, actions = explorer.window.toolbar, explorer.window.actions_by_name
    # So large that it is stopped before there is a result.
    type_number(qtbot, bar.height_box, 2048)
    type_number(qtbot, bar.width_box, 2048)

    def status() -> str:
        return explorer.controller.column_scene(column_id).status

    qtbot.waitUntil(lambda: status() == "running")
    qtbot.keyClick(explorer.window, Qt.Key.Key_Escape, Qt.KeyboardModifier.ShiftModifier)
    qtbot.waitUntil(lambda: status() not in ("running", "waiting"))
    assert explorer.controller.column_scene(column_id).result is None
    type_number(qtbot, bar.height_box, 48)
    type_number(qtbot, bar.width_box, 48)
    actions["layout-tune"].trigger()
    docks = {dock.name: dock for dock in explorer.docks}
    explorer.window.raise_dock("thresholds")
    wait_idle(qtbot, explorer)
    assert explorer.session.state.size == (48, 48)
    assert docks["thresholds"].message is None
    assert docks["thresholds"].editor.view.axes.depth > 0
    explorer.window.raise_dock("sweeps")
    wait_idle(qtbot, explorer)
    assert "Choose a column" not in (docks["sweeps"].message or "")
    assert docks["sweeps"].panel.isVisible()
