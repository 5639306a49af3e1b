"""The stage: how large the pictures are, where they stand, and what is said about them; with real events."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import column_of, noise
from PySide6.QtCore import QPoint, QRect, QRectF, Qt
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QSlider,
    QTabBar,
    QTableWidget,
    QTableWidgetItem,
    QTableWidgetSelectionRange,
    QWidget,
)

import texlab
from tests.gui.conftest import drag, hb, ids, wait_idle
from texlab.columns.arrangement import LEAST_PICTURE, SPACING, Arrangement, Frame, arrange
from texlab.columns.foot import MARGIN, Foot
from texlab.columns.history_popup import HistoryPopup
from texlab.columns.numbers_popup import NumbersPopup
from texlab.columns.status import figures
from texlab.columns.titles import titles
from texlab.runs.past import SIDE, measured, remembered
from texlab.state.difference import difference
from texlab.state.scene import ColumnScene, Past
from texlab.state.session import Session
from texlab.style.pictures import thinned
from texlab.widgets.tables import make_quiet, table_text
from texlab.window.panel_strip import FLOATING
from texlab.window.stage_settings import SURROUNDS
from texlab_core.engine.params import describe
from texlab_core.engine.registry import methods
from texlab_core.errors import InputError
from texlab_core.measures.registry import measures
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.app.explorer import Explorer

LEFT = Qt.MouseButton.LeftButton
FRAMES = {"below": Frame(6, 67), "line": Frame(6, 48, 456), "beside": Frame(130, 32)}


# The arrangement, without a window.


def side(made: Arrangement) -> int:
    frame = FRAMES[made.words]
    return min(made.width - frame.width, made.height - frame.height)


@pytest.mark.parametrize("count", [1, 2, 3, 5, 7, 12])
@pytest.mark.parametrize("room", [(848, 694), (1488, 974), (400, 1500), (2600, 500), (1000, 1000)])
def test_no_other_arrangement_has_larger_pictures(count: int, room: tuple[int, int]) -> None:
    made = arrange(count, room, FRAMES)
    best = -1.0
    for rows in range(1, count + 1):
        for columns in range(1, count + 1):
            if rows * columns < count:
                continue
            width, height = (room[0] + SPACING) // columns - SPACING, (room[1] + SPACING) // rows - SPACING
            for frame in FRAMES.values():
                if width >= frame.least:
                    best = max(best, min(width - frame.width, height - frame.height))
    assert side(made) == max(best, LEAST_PICTURE)
    assert made.rows * made.columns >= count > (made.rows - 1) * made.columns


def test_cells_neither_overlap_nor_leave_the_room() -> None:
    made = arrange(5, (848, 694), FRAMES)
    cells = [QRectF(*made.cell(place)) for place in range(5)]
    assert all(not one.intersects(other) for one in cells for other in cells if one is not other)
    assert all(QRectF(0, 0, 848, 694).contains(cell) for cell in cells)
    assert made.total == (848, 694)
    for place, cell in enumerate(cells):
        assert made.place_at(cell.center().x(), cell.center().y(), 5) == place
    assert made.place_at(-40, -40, 5) == 0
    assert made.place_at(9999, 9999, 5) == 4


def test_rows_can_be_chosen_and_a_small_room_is_outgrown() -> None:
    assert arrange(5, (848, 694), FRAMES, rows="one").rows == 1
    assert arrange(5, (2000, 300), FRAMES, rows="two").rows == 2
    assert arrange(1, (2000, 300), FRAMES, rows="two").rows == 1
    small = arrange(5, (200, 100), FRAMES)
    assert side(small) >= LEAST_PICTURE
    assert small.total[1] > 100
    with pytest.raises(ValueError, match="at least one cell, got 0"):
        arrange(0, (10, 10), FRAMES)
    with pytest.raises(ValueError, match="fits any width"):
        arrange(1, (10, 10), {"line": Frame(6, 48, 456)})


def test_wide_pictures_stand_below_each_other() -> None:
    assert arrange(2, (800, 800), FRAMES, aspect=4.0).columns == 1
    assert arrange(2, (800, 800), FRAMES, aspect=0.25).columns == 2


# The window.


def painted_area(explorer: Explorer) -> float:
    """Share of the window that the pictures of the columns cover, as they are painted."""
    window = explorer.window
    total = 0.0
    for view in explorer.workspace.columns.values():
        pane = view.pane
        height, width = pane.extent
        shown = QRectF(pane.to_widget(0, 0), pane.to_widget(height, width))
        shown = shown.intersected(QRectF(pane.viewport().rect()))
        shown.translate(pane.viewport().mapTo(window, QPoint(0, 0)))
        total += shown.intersected(QRectF(window.rect())).width() * shown.height()
    return total / (window.width() * window.height())


@pytest.mark.parametrize(("width", "height", "share"), [(1280, 800, 0.25), (1920, 1080, 0.35)])
def test_four_first_results_cover_much_of_the_window(
    qtbot: Any, open_new: Callable[..., Explorer], texture: Path, width: int, height: int, share: float
) -> None:
    explorer = open_new(str(texture), [hb(iterations=k + 1) for k in range(4)], (width, height))
    assert (explorer.window.width(), explorer.window.height()) == (width, height)
    assert all(explorer.window.docks[name].isVisible() for name in ("gallery", "parameters"))
    assert painted_area(explorer) >= share
    assert not explorer.window.strip.is_open


def test_a_click_on_a_name_opens_the_panels_and_another_closes_them(
    qtbot: Any, open_new: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_new(str(texture), [hb()], (1280, 800))
    window, strip = explorer.window, explorer.window.strip
    (tabs,) = [bar for bar in window.findChildren(QTabBar) if bar.parent() is window and bar.isVisible()]
    names = [tabs.tabText(place) for place in range(tabs.count())]
    before = painted_area(explorer)

    def click(title: str) -> None:
        qtbot.mouseClick(tabs, LEFT, pos=tabs.tabRect(names.index(title)).center())

    click("Histograms")
    assert strip.is_open
    dock = explorer.hosts["histograms"].dock
    qtbot.waitUntil(lambda: dock.height() > 100 and not dock.visibleRegion().isEmpty())
    assert painted_area(explorer) < before
    click("Pyramid")
    assert strip.is_open
    click("Pyramid")
    assert not strip.is_open
    qtbot.waitUntil(lambda: painted_area(explorer) == pytest.approx(before))
    qtbot.keyClick(window, Qt.Key.Key_F4)
    assert strip.is_open
    # Only the tab in front has a button that lets it float.
    window.raise_dock("maps")
    qtbot.waitUntil(lambda: window.docks["maps"].height() > 0)
    window.docks["maps"].setFloating(True)
    qtbot.keyClick(window, Qt.Key.Key_F4)
    assert not strip.is_open
    assert window.docks["maps"].height() > 0
    window.docks["maps"].setFloating(False)
    assert window.docks["maps"].maximumHeight() == 0
    # One that nobody has seen has a size, too.
    unseen = window.docks[next(name for name, host in explorer.hosts.items() if not host.is_made)]
    unseen.setFloating(True)
    assert unseen.height() >= FLOATING.height()
    unseen.setFloating(False)
    window.raise_dock("steps")
    assert strip.is_open
    wait_idle(qtbot, explorer)


def test_messages_lie_over_the_stage_and_move_nothing(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    panes = [view.pane for view in explorer.workspace.columns.values()]
    before = [(pane.mapTo(window, QPoint(0, 0)), pane.size()) for pane in panes]
    window.message_bar.tell("Something that is worth to be known. " * 12, "problem")
    qtbot.waitUntil(window.message_bar.isVisible)
    assert [(pane.mapTo(window, QPoint(0, 0)), pane.size()) for pane in panes] == before
    bar = window.message_bar
    assert bar.height() >= bar.label.heightForWidth(bar.label.width())
    window.resize(1100, 760)
    qtbot.waitUntil(lambda: bar.width() < bar.parentWidget().width())
    # It lies over no control: neither over those of the columns, nor over a panel's while that has the stage.
    lies_over_no_control(window)
    window.raise_dock("fill")
    window.big_panel.toggle("fill")
    for sentence in ("Short.", "Something that is worth to be known. " * 30):
        window.message_bar.tell(sentence.strip(), "problem")
        QApplication.processEvents()
        lies_over_no_control(window)
        tip = re.sub(r"<[^>]*>|\s+", " ", bar.label.toolTip())
        assert bar.label.text() == sentence.strip() or sentence.strip() in tip
    window.big_panel.give_back()
    QApplication.processEvents()
    lies_over_no_control(window)
    bar.hide()
    wait_idle(qtbot, explorer)


def lies_over_no_control(window: Any) -> None:
    bar = window.message_bar
    assert bar.isVisible()
    lies = QRect(bar.mapToGlobal(QPoint()), bar.size())
    assert lies.height() > bar.label.fontMetrics().height()
    for widget in window.findChildren(QWidget):
        is_control = isinstance(widget, QAbstractButton | QComboBox | QAbstractSpinBox | QSlider | QLineEdit)
        if is_control and widget.isVisible() and not bar.isAncestorOf(widget):
            covered = lies.intersected(QRect(widget.mapToGlobal(QPoint()), widget.size()))
            assert covered.isEmpty() or widget.visibleRegion().isEmpty(), widget.objectName()


def test_the_exemplar_is_zoomed_by_its_own_size_until_it_is_linked(qtbot: Any, explorer: Explorer) -> None:
    stage, window = explorer.workspace, explorer.window
    source, result = stage.exemplar.pane, stage.columns[ids(explorer)[0]].pane
    # 40 x 48 and 48 x 48 pixels in cells of one size: each as large as it can be.
    for pane in (source, result):
        shown, extent = pane.view_rect(), pane.extent
        assert min(shown.width() / extent[1], shown.height() / extent[0]) == pytest.approx(1, abs=0.02)
    before = source.shown_scale
    qtbot.keyClick(window, Qt.Key.Key_L)
    assert stage.linked
    assert source.shown_scale == pytest.approx(result.shown_scale, rel=0.02)
    drag(qtbot, source.viewport(), [QPoint(40, 40), QPoint(50, 45), QPoint(70, 50)])
    assert source.view_rect().center().x() == pytest.approx(result.view_rect().center().x())
    qtbot.keyClick(window, Qt.Key.Key_L)
    assert not stage.linked
    assert source.shown_scale == pytest.approx(before)


def test_zoom_is_shown_in_percent_and_typed(qtbot: Any, explorer: Explorer) -> None:
    result = explorer.workspace.columns[ids(explorer)[0]].pane
    box = explorer.stage.zoom
    qtbot.waitUntil(lambda: box.value() == round(100 * result.shown_scale * result.devicePixelRatioF()))
    source = explorer.workspace.exemplar.pane.shown_scale
    box.selectAll()
    qtbot.keyClicks(box, "300")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert result.shown_scale * result.devicePixelRatioF() == pytest.approx(3.0)
    assert explorer.workspace.exemplar.pane.shown_scale == pytest.approx(source)
    qtbot.keyClick(explorer.window, Qt.Key.Key_1)
    qtbot.waitUntil(lambda: box.text() == "100 %")


def test_a_column_is_enlarged_and_put_back(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    stage = explorer.workspace
    width = stage.columns[first].width()
    qtbot.mouseDClick(stage.columns[first].pane.viewport(), LEFT, pos=QPoint(30, 30))
    assert stage.enlarged == first
    assert stage.columns[first].width() > 1.5 * width
    assert not stage.columns[second].isVisible()
    assert not stage.exemplar.isVisible()
    explorer.window.actions_by_name["next"].trigger()
    qtbot.waitUntil(lambda: stage.enlarged == second)
    qtbot.keyClick(explorer.window, Qt.Key.Key_M)
    assert stage.enlarged is None
    assert stage.columns[first].isVisible()
    qtbot.mouseDClick(stage.exemplar.pane.viewport(), LEFT, pos=QPoint(30, 30))
    assert stage.enlarged == 0
    assert stage.exemplar.isVisible()
    qtbot.mouseDClick(stage.exemplar.pane.viewport(), LEFT, pos=QPoint(30, 30))
    qtbot.keyClick(explorer.window, Qt.Key.Key_M)
    explorer.session.remove_column(explorer.session.selected_id)
    qtbot.waitUntil(lambda: stage.enlarged is None)


def test_a_column_is_dragged_to_another_place(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    views = explorer.workspace.columns
    state = explorer.session.state
    grip = views[first].grip
    way = views[second].mapTo(explorer.window, views[second].rect().center()) - grip.mapTo(
        explorer.window, grip.rect().center()
    )
    start = grip.rect().center()
    drag(qtbot, grip, [start, start + QPoint(10, 2), start + way / 2, start + way])
    assert ids(explorer) == [second, first]
    assert difference(state, explorer.session.state).run == ()
    # Pinned, it stays in front.
    explorer.session.pin_column(second, True)
    start = (grip := views[second].grip).rect().center()
    qtbot.waitUntil(lambda: views[second].x() < views[first].x())
    drag(qtbot, grip, [start, start + QPoint(10, 2), start + way, start + 2 * way])
    assert ids(explorer) == [second, first]
    qtbot.mouseClick(grip, LEFT)
    assert explorer.session.selected_id == second


def test_the_surround_is_a_neutral_grey_unless_chosen_otherwise(explorer: Explorer) -> None:
    pane = explorer.workspace.columns[ids(explorer)[0]].pane
    assert pane.backgroundBrush().color().name() == SURROUNDS["grey"]
    explorer.window.actions_by_name["theme-dark"].trigger()
    assert pane.backgroundBrush().color().name() == SURROUNDS["grey"]
    explorer.window.actions_by_name["surround-white"].trigger()
    assert pane.backgroundBrush().color().name() == "#ffffff"
    explorer.window.actions_by_name["surround-theme"].trigger()
    assert pane.backgroundBrush().color().lightness() < 60
    explorer.window.actions_by_name["theme-light"].trigger()
    assert pane.backgroundBrush().color().lightness() > 200
    assert explorer.settings.values["surround"] == "theme"


def test_rows_are_chosen_in_the_menu(explorer: Explorer) -> None:
    grid = explorer.workspace.grid
    for name, rows in (("rows-one", 1), ("rows-two", 2), ("rows-largest", grid.arrangement.rows)):
        explorer.window.actions_by_name[name].trigger()
        assert grid.arrangement.rows == rows
    assert explorer.settings.values["rows"] == "largest"


# What columns are called.


def test_a_name_is_typed_over_the_title(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    views = explorer.workspace.columns
    assert views[first].method_box.label == "Heeger-Bergen, iterations 2"
    assert views[second].method_box.label == "Heeger-Bergen, iterations 1"
    state = explorer.session.state
    qtbot.mouseDClick(views[first].grip, LEFT)
    field = views[first].findChild(object, "name-field")
    qtbot.keyClicks(field, "the coarse one")
    qtbot.keyClick(field, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: views[first].method_box.label == "the coarse one")
    # Alone with its method among those without a name.
    assert views[second].method_box.label == "Heeger-Bergen"
    assert difference(state, explorer.session.state).run == ()
    explorer.session.undo()
    qtbot.waitUntil(lambda: views[first].method_box.label == "Heeger-Bergen, iterations 2")
    explorer.session.select(first)
    qtbot.keyClick(explorer.window, Qt.Key.Key_F2)
    field = views[first].findChild(object, "name-field")
    qtbot.keyClicks(field, "x")
    qtbot.keyClick(field, Qt.Key.Key_Escape)
    assert explorer.session.state.column(first).name == ""


def test_a_locked_seed_is_left_alone_by_the_dice(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    explorer.session.select(first)
    explorer.window.actions_by_name["own-seed"].trigger()
    before = explorer.session.state
    explorer.session.set_seed(77)
    assert difference(before, explorer.session.state).run == (second,)
    wait_idle(qtbot, explorer)
    assert explorer.controller.column_scene(first).result.job.seed == 5
    assert explorer.controller.column_scene(second).result.job.seed == 77
    assert "seed 5" in explorer.workspace.columns[first].method_box.label
    qtbot.keyClick(explorer.window, Qt.Key.Key_D, Qt.KeyboardModifier.ShiftModifier)
    wait_idle(qtbot, explorer)
    own = explorer.session.state.column(first).seed
    assert explorer.controller.column_scene(first).result.job.seed == own != 5
    explorer.window.actions_by_name["own-seed"].trigger()
    assert explorer.session.state.column(first).seed is None
    wait_idle(qtbot, explorer)
    assert explorer.controller.column_scene(first).result.job.seed == 77


def test_names_pins_and_seeds_come_back(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, explorer: Explorer
) -> None:
    first, second = ids(explorer)
    explorer.session.rename_column(first, "  one   name ")
    explorer.session.pin_column(second, True)
    explorer.session.set_column_seed(second, 9)
    wait_idle(qtbot, explorer)
    explorer.window.close()
    again = open_window(str(texture))
    two, one = again.session.state.columns
    assert (one.name, one.pinned, one.seed) == ("one name", False, None)
    assert (two.name, two.pinned, two.seed) == ("", True, 9)


def test_pinned_columns_stay_when_others_take_the_place_of_all() -> None:
    session = Session()
    params = methods()["msg"].params()
    first, second = (session.add_column("msg", params) for _ in range(2))
    session.pin_column(second, True)
    assert [each.id for each in session.state.columns] == [second, first]
    session.set_columns([("msg", params), ("msg", params)], "two")
    assert [each.pinned for each in session.state.columns] == [True, False, False]
    assert session.state.columns[0].id == second
    copy = session.duplicate_column(second)
    assert [each.id for each in session.state.columns].index(copy) == 1
    session.move_column(copy, -1)
    assert session.state.columns[0].id == second
    session.pin_column(second, False)
    session.move_column(copy, -1)
    assert session.state.columns[0].id == copy


# Figures.


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


# Titles.


def column(params: Any, number: int, **more: Any) -> Any:
    return ColumnScene(number, "de-bonet", "De Bonet", params, **more)


def test_titles_say_what_differs() -> None:
    make = methods()["de-bonet"].params
    table = ThresholdTable((((1, "luminance/laplacian"), 0.28),))
    one, other = make(alpha=0.2), make(alpha=0.15, thresholds=table)
    assert titles([column(one, 1)]) == ["De Bonet"]
    found = titles([column(one, 1), column(other, 2)])
    assert found == ["De Bonet, alpha .2 / k1 by law", "De Bonet, alpha .15 / k1 .28"]
    # A name goes first, and takes the column out of the family.
    assert titles([column(one, 1, name="mine"), column(other, 2)]) == ["mine", "De Bonet"]
    assert titles([column(one, 1), column(one, 2)]) == ["De Bonet (1)", "De Bonet (2)"]
    seeds = titles([column(one, 1), column(one, 2, seed=7)])
    assert seeds == ["De Bonet, shared seed", "De Bonet, seed 7"]
    spread = table.changed({(1, "red/first-0"): 0.5})
    assert titles([column(make(alpha=0.2, thresholds=spread), 1), column(one, 2)])[0] == "De Bonet, k1 .28\u2013.5"


@pytest.mark.parametrize("method", sorted(methods()))
def test_every_parameter_that_differs_is_in_the_title(method: str) -> None:
    known = methods()[method]
    plain = known.params()
    for field in describe(known.params):
        other = other_value(field, getattr(plain, field.name))
        try:
            changed = known.params.from_json({**plain.to_json(), field.name: other})
        except InputError:
            continue
        if changed == plain:
            continue
        scenes = [ColumnScene(k, method, known.title, params) for k, params in enumerate((plain, changed))]
        first, second = titles(scenes)
        assert first != second
        assert first.startswith(known.title)
        assert field.name.replace("_", " ") in second or "k1" in second


def other_value(field: Any, value: Any) -> Any:
    if isinstance(value, bool):
        return not value
    if isinstance(value, ThresholdTable):
        return [[1, "luminance/laplacian", 0.5]]
    if isinstance(value, int | float):
        return field.knob.low if value != field.knob.low else field.knob.high
    return next((choice for choice in field.choices or () if choice != value), value)


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
