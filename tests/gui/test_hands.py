"""What is everywhere: a context menu, tables that are copied as text, short tooltips, a palette that finds all."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtGui import QAction, QContextMenuEvent
from PySide6.QtWidgets import QApplication, QListWidget, QMenu, QTableWidget, QWidget

from tests.gui.conftest import ids, make_everything, wait_idle
from texlab.widgets.heat_map import HeatMap
from texlab.widgets.plain import TIP_WIDTH
from texlab.widgets.tables import add_copying, list_text
from texlab.window.palette import CommandPalette, best_first
from texlab_core.engine.registry import methods
from texlab_core.lessons.shelf import bundled
from texlab_core.sheets.sweep_sources import bundled_sweeps

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer


@pytest.fixture
def explorer(open_window: Callable[..., Explorer], texture: Path) -> Explorer:
    return open_window(str(texture), [("pixels", methods()["pixels"].params())])


def right_click(widget: QWidget) -> None:
    place = widget.rect().center()
    event = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, place, widget.mapToGlobal(place))
    QApplication.sendEvent(widget, event)


def test_everything_in_the_window(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    make_everything(explorer)
    # Every panel has a menu, wherever in it the button is pressed.
    for dock in explorer.docks:
        window.raise_dock(dock.name)
        for place in (dock, getattr(dock, "body", dock)):
            right_click(place)
            menus = dock.findChildren(QMenu, "panel-menu")
            assert menus, f"{dock.name} has no menu"
            assert [action.text() for action in menus[-1].actions()][:1] == ["Copy picture of this panel"]
            menus[-1].close()
            menus[-1].setObjectName("seen")
    # So has every column, and the exemplar.
    for view, name in ((explorer.workspace.exemplar, "exemplar-menu"),):
        right_click(view.pane.viewport())
        assert view.findChildren(QMenu, name)
        view.findChildren(QMenu, name)[-1].close()
    column = next(iter(explorer.workspace.columns.values()))
    right_click(column)
    assert column.menu.isVisible()
    column.menu.close()
    # Every table is copied as text.
    for kind in (QTableWidget, HeatMap):
        for table in window.findChildren(kind):
            assert table.findChild(QAction, "copy-table") is not None, table.objectName()
    # No line of a tooltip is longer than what is read at a glance.
    tips = {each.objectName(): each.toolTip() for each in window.findChildren(QWidget) if each.toolTip()}
    tips |= {each.objectName(): each.toolTip() for each in window.findChildren(QAction) if each.objectName()}
    assert len(tips) > 200
    for name, tip in tips.items():
        plain = tip.replace("<br>", "\n").replace("&nbsp;", " ")
        lines = re.sub(r"</?qt>", "", plain).split("\n")
        longest = max(lines, key=len)
        assert len(longest) <= TIP_WIDTH or " " not in longest.strip(), (name, longest)
    # The palette finds it all; what is read first comes a moment later.
    explorer.settings.add_recent("/somewhere/photo of bark.png")
    window.show_recent(explorer.settings.recent, lambda *_: None)
    explorer.desk.show_palette()
    palette = window.findChild(CommandPalette, "command-palette")
    explorer.desk._found(explorer.desk._read())
    kinds = {each.kind for each in palette._entries}
    assert kinds >= {"", "setting", "texture", "preset", "lesson", "sweep", "recent file", "parameter"} - {
        each for each in ("preset", "parameter") if not methods()["pixels"].params().to_json()
    }
    assert {each.name for each in palette._entries if each.kind == "lesson"} == {
        each.title for each in bundled().values()
    }
    assert len([each for each in palette._entries if each.kind == "sweep"]) == len(tuple(bundled_sweeps()))
    for typed, wanted in (
        ("save", "Save result"),
        ("photo of bark", "photo of bark.png"),
        ("fill hardness", "Fill: Hardness"),
        ("panel over", "Panel over the stage"),
    ):
        assert best_first(palette._entries, typed)[0].name == wanted, typed
    # A setting leads to its control.
    best_first(palette._entries, "fill radius")[0].run()
    assert window.front_dock() == "fill"
    # A ready-made sweep is chosen in its panel, with a column of its method.
    before, wanted = ids(explorer), best_first(palette._entries, "de bonet fig 11")[0]
    palette.close()
    wanted.run()
    panel = explorer.hosts["sweeps"].dock.panel
    qtbot.waitUntil(lambda: panel.chosen_sweep is not None)
    assert panel.chosen_sweep.name == "de-bonet-fig-11"
    assert explorer.session.selected_column.method == "de-bonet"
    assert len(ids(explorer)) == len(before) + 1
    explorer.session.undo()
    assert ids(explorer) == before
    wait_idle(qtbot, explorer)


def test_lists_are_copied_as_text(qtbot: Any) -> None:
    listed = QListWidget()
    qtbot.addWidget(listed)
    listed.setSelectionMode(QListWidget.SelectionMode.ExtendedSelection)
    listed.addItems(["first\nline", "second", "third"])
    add_copying(listed, lambda: list_text(listed))
    assert list_text(listed) == "first line\nsecond\nthird\n"
    listed.item(0).setSelected(True)
    listed.item(2).setSelected(True)
    listed.findChild(QAction, "copy-table").trigger()
    assert QApplication.clipboard().text() == "first line\nthird\n"
    heat = HeatMap("heat", "Heat")
    qtbot.addWidget(heat)
    import numpy as np

    heat.show_cells(np.zeros((1, 2)), [["1", "2"]], ["row"], ["a", "b"], np.zeros((4, 3), np.uint8))
    assert heat.as_text() == "\ta\tb\nrow\t1\t2\n"
