"""Figures below the columns: marked, whole in any width, copied as text; what was before is one click away."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from dock_scenes import column_of, noise
from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QApplication,
    QTableWidget,
    QTableWidgetItem,
    QTableWidgetSelectionRange,
    QWidget,
)

import texlab
from tests.gui.conftest import ids, wait_idle
from texlab.columns.foot import MARGIN, Foot
from texlab.columns.history_popup import HistoryPopup
from texlab.columns.numbers_popup import NumbersPopup
from texlab.columns.status import figures
from texlab.runs.past import SIDE, measured, remembered
from texlab.state.scene import Past
from texlab.state.session import Session
from texlab.style.pictures import thinned
from texlab.widgets.tables import make_quiet, table_text
from texlab_core.engine.registry import methods
from texlab_core.measures.registry import measures

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

LEFT = Qt.MouseButton.LeftButton


def test_figures_are_marked_where_they_became_better_or_worse() -> None:
    before = {"discriminability": -2.0, "visual-difference": 0.9, "copied-share": 0.31}
    now = {"discriminability": -3.5, "visual-difference": 0.5, "copied-share": 0.312}
    found = figures(now, before)
    # D is better when lower, V when higher; 31% is written as it was.
    assert [each.text for each in found] == ["D -3.50 \u25b2", "V 0.50 \u25bc", "copied 31%"]
    assert "Good." in found[0].tip
    assert "Worse than the result before: 0.90." in found[1].tip
    assert [each.text for each in figures(now)] == ["D -3.50", "V 0.50", "copied 31%"]
    assert figures({}) == []


def test_whole_figures_are_shown_in_any_width(qtbot: Any) -> None:
    around = QWidget()
    qtbot.addWidget(around)
    foot = Foot("line", around)
    numbers = {"discriminability": -3.5, "visual-difference": 0.5, "laid-down-share": 0.12}
    foot.show_scene(column_of(noise(8, 8), status="finished", measures=numbers))
    around.show()
    counts, room = [], foot.width_of("D -3.50") + 2 * MARGIN
    # Where the name of the first has no room, its value stays.
    for width, first in ((room - 1, "-3.50"), (room, "D -3.50"), (3 * room, "D -3.50"), (12 * room, "D -3.50")):
        foot.resize(width, foot.height())
        seen = [label for label in foot.figures if label.isVisible()]
        assert seen[0].text() == first
        counts.append(len(seen))
        qtbot.waitUntil(lambda: _inside(foot))
    assert counts[0] == 1
    assert counts == sorted(counts)
    assert counts[-1] == 3
    foot.set_words("beside")
    # Under each other they are shown as far as they are whole in the height of the picture.
    foot.resize(foot.frame("beside").width, foot.heights[0])
    assert [label.isVisible() for label in foot.figures] == [True, False, False]
    foot.resize(foot.frame("beside").width, 300)
    assert all(label.isVisible() for label in foot.figures)
    assert foot.minimumWidth() == foot.maximumWidth() == foot.frame("beside").width
    foot.set_words("below")
    assert foot.minimumHeight() == foot.frame("below").height


def _inside(foot: Foot) -> bool:
    """Whether every figure that is seen is seen whole; the first one is always shown."""
    seen = [label for label in foot.figures if label.isVisible()]
    return len(seen) == 1 or all(label.geometry().right() < foot.width() for label in seen)


def test_every_number_is_one_click_away_and_copied_as_text(qtbot: Any, explorer: Explorer) -> None:
    view = explorer.workspace.columns[ids(explorer)[0]]
    qtbot.waitUntil(lambda: view.foot.figures[0].isVisible())
    qtbot.mouseClick(view.foot, LEFT, pos=view.foot.figures[0].geometry().center())
    (popup,) = view.findChildren(NumbersPopup)
    known = [each for each in measures().values() if each.id in view.scene.measures]
    assert popup.table.rowCount() >= len(known) > 3
    qtbot.keyClick(popup.table, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    lines = QApplication.clipboard().text().splitlines()
    assert lines[0] == "Measure\tNow\tBefore"
    for each in known:
        assert f"{each.title}\t{each.text(view.scene.measures[each.id])}\t" in lines
    popup.close()


def test_every_table_of_numbers_can_be_copied() -> None:
    """Whoever makes a table makes it quiet, which makes it copyable."""
    root = Path(texlab.__file__).parent
    makers = [path for path in root.rglob("*.py") if re.search(r"QTableWidget\(|\(QTableWidget", path.read_text())]
    assert len(makers) >= 4
    assert [path.name for path in makers if "make_quiet(" not in path.read_text()] == []


def test_a_table_is_copied_as_it_is_seen(qtbot: Any) -> None:
    table = QTableWidget(3, 3)
    qtbot.addWidget(table)
    table.setHorizontalHeaderLabels(["a", "b", "c"])
    table.setVerticalHeaderLabels(["x", "y", "z"])
    for place in range(9):
        table.setItem(place // 3, place % 3, QTableWidgetItem(f"{place}\n!"))
    make_quiet(table)
    table.setColumnHidden(1, True)
    table.setRowHidden(1, True)
    assert table_text(table) == "\ta\tc\nx\t0 !\t2 !\nz\t6 !\t8 !\n"
    table.setRowHidden(1, False)
    table.setRangeSelected(QTableWidgetSelectionRange(1, 0, 2, 0), True)
    assert table_text(table) == "\ta\tc\ny\t3 !\t5 !\nz\t6 !\t8 !\n"


# What was before.


def test_a_click_goes_back_to_an_earlier_result_without_running(qtbot: Any, explorer: Explorer) -> None:
    first, _ = ids(explorer)
    session, view = explorer.session, explorer.workspace.columns[first]
    before = explorer.controller.column_scene(first)
    session.set_params(first, replace(before.params, iterations=1), "iterations")
    wait_idle(qtbot, explorer)
    after = explorer.controller.column_scene(first)
    assert [each.params.iterations for each in after.history] == [2, 1]
    assert all(each.thumbnail.shape == (48, 48, 3) for each in after.history)
    # Better and worse are about the result before.
    assert dict(view.foot.before) == dict(after.history[0].measures) != {}
    explorer.session.select(first)
    qtbot.keyClick(explorer.window, Qt.Key.Key_H)
    (popup,) = view.findChildren(HistoryPopup)
    assert [popup.list.item(k).text() for k in range(2)] == ["iterations 1", "iterations 2"]
    assert popup.list.currentRow() == 0
    older = popup.list.visualItemRect(popup.list.item(1)).center()
    qtbot.mouseClick(popup.list.viewport(), LEFT, pos=older)
    wait_idle(qtbot, explorer)
    back = explorer.controller.column_scene(first)
    assert back.result is before.result
    assert [each.params.iterations for each in back.history] == [1, 2]
    # Beside, in a new column.
    copy = session.compare_past(first, back.history[0])
    wait_idle(qtbot, explorer)
    assert ids(explorer)[1] == copy
    assert session.state.column(copy).params.iterations == 1
    assert session.state.column(first).params.iterations == 2
    # Those of another exemplar are not offered.
    assert HistoryPopup(back, "another").list.count() == 0


def test_an_earlier_result_brings_size_and_seed_of_its_own() -> None:
    session = Session()
    params = methods()["msg"].params()
    column_id = session.add_column("msg", params)
    thumbnail = np.zeros((4, 4, 3), np.uint8)
    past = Past("key", "hash", "uncoded", methods()["uncoded"].params(), (), (32, 48), 9, thumbnail)
    session.take_past(column_id, past)
    made = session.state.column(column_id)
    assert (made.method, made.size, made.seed) == ("uncoded", (32, 48), 9)
    session.set_seed(9)
    session.set_size((32, 48))
    session.take_past(column_id, past)
    made = session.state.column(column_id)
    assert (made.size, made.seed) == (None, None)


def test_the_history_of_a_column_is_short_and_holds_every_job_once() -> None:
    params = methods()["msg"].params()

    def past(key: int) -> Past:
        picture = np.full((300, 200, 3), key, np.uint8)
        return Past(key, "hash", "msg", params, (), (8, 8), key, thinned(picture, SIDE))

    assert past(0).thumbnail.shape == (60, 40, 3)
    history: tuple[Past, ...] = ()
    for key in (*range(30), 10):
        history = measured(remembered(history, past(key)), key, {"garbage": float(key)})
    assert [each.key for each in history] == [*range(6, 10), *range(11, 30), 10]
    assert history[-1].measures == {"garbage": 10.0}
