"""The stage: how large the pictures are and where they stand; with real events."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import QPoint, QRect, QRectF, Qt
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QSlider,
    QTabBar,
    QWidget,
)

from tests.gui.conftest import drag, hb, ids, wait_idle
from texlab.columns.arrangement import LEAST_PICTURE, SPACING, Arrangement, Frame, arrange
from texlab.state.difference import difference
from texlab.window.panel_strip import FLOATING
from texlab.window.stage_settings import SURROUNDS

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

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
