"""Teach is read from the back row: sizes of letters, what is in sight, overlays, and lines drawn by hand."""

from __future__ import annotations

from typing import Any

import pytest
from painted_text import cut, painted, too_small
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QColor, QFont, QFontMetricsF
from PySide6.QtWidgets import QApplication, QMainWindow, QWidget

from tests.gui.conftest import ids, wait_idle
from texlab.style.text_size import ZOOMS, capitals_of, next_zoom, set_least, smaller, teach_points
from texlab.style.theme import LIGHT, set_text_size
from texlab.widgets.plots import Plot
from texlab.window.chalk import INK, Chalk
from texlab.window.layouts import SIDES
from texlab.window.lesson_bar import LessonBar

SCREENS = [(1280, 720), (1920, 1080), (3840, 2160)]
LARGER = (1.0, 1.25, 1.5, 2.0)


@pytest.mark.parametrize("height", [300, 720, 1080, 2160])
@pytest.mark.parametrize("zoom", ZOOMS)
@pytest.mark.parametrize("capitals", [lambda points: 0.95 * points, lambda points: float(int(0.9 * points))])
def test_capitals_are_a_fortieth_and_hardly_more(height: int, zoom: float, capitals: Any) -> None:
    points = teach_points(height, zoom, capitals)
    assert capitals(points) >= height * zoom / 40
    assert points == 0.5 or capitals(points - 1.5) < height * zoom / 40


def test_the_program_s_own_font(qapp: Any) -> None:
    font = QFont(qapp.font())
    font.setPointSizeF(teach_points(720, 1.0, capitals_of(font)))
    assert 18 <= QFontMetricsF(font).capHeight() < 20


@pytest.mark.parametrize(("height", "zoom"), [(0, 1.0), (720, 0.0)])
def test_nothing_has_no_size(height: int, zoom: float) -> None:
    with pytest.raises(ValueError, match="must be positive"):
        teach_points(height, zoom, lambda points: points)


def test_zooms_are_walked_and_end() -> None:
    walked = [ZOOMS[0]]
    while next_zoom(walked[-1], 1) != walked[-1]:
        walked.append(next_zoom(walked[-1], 1))
    assert tuple(walked) == ZOOMS
    assert next_zoom(ZOOMS[0], -1) == ZOOMS[0]
    assert next_zoom(1.02, -1) == 0.9


def test_small_text_is_not_small_in_teach() -> None:
    assert smaller(20.0, 0.8) == 16.0
    set_least(18.0)
    try:
        assert smaller(20.0, 0.8) == 18.0
    finally:
        set_least(0.0)


def test_the_sentence_of_a_lesson_is_the_largest_text_at_every_size(qtbot: Any, qapp: Any) -> None:
    window, before = QMainWindow(), qapp.font().pointSizeF()
    qtbot.addWidget(window)
    names = ("lesson-back", "lesson-next", "lesson-leave")
    bar = LessonBar({name: QAction(name, window) for name in names})
    window.setCentralWidget(bar)
    window.show()
    try:
        # There and back: a size that was given once must not stay.
        for points, teaches in ((9.0, False), (30.0, True), (60.0, True), (9.0, False)):
            set_least(points if teaches else 0.0)
            set_text_size(qapp, points, LIGHT)
            bar.show()
            assert bar.count.font().pointSizeF() == points
            assert bar.sentence.font().pointSizeF() == pytest.approx(points * (1.2 if teaches else 1.6), abs=0.06)
    finally:
        set_least(0.0)
        set_text_size(qapp, before, LIGHT)


def seen(widget: QWidget) -> bool:
    return widget.isVisible() and not widget.visibleRegion().isEmpty()


def capitals(font: QFont) -> float:
    return float(QFontMetricsF(font).capHeight())


@pytest.fixture
def teaching(explorer: Any) -> Any:
    explorer.window.actions_by_name["layout-teach"].trigger()
    yield explorer
    explorer.window.layouts.set_zoom(1.0)
    explorer.window.actions_by_name["layout-explore"].trigger()


@pytest.mark.slow
def test_letters_of_every_tab_at_every_size(teaching: Any, qtbot: Any) -> None:
    window = teaching.window
    tabs = [name for name in window.docks if name not in SIDES]
    seen_at: set[tuple[str, tuple[int, int]]] = set()
    for row, size in enumerate(SCREENS):
        for turn, zoom in enumerate(LARGER):
            window.layouts.set_zoom(zoom)
            window.resize(*size)
            qtbot.waitUntil(lambda zoom=zoom: capitals(window.font()) >= zoom * window.height() / 40)
            # Every tab is seen at every size with the largest letters; the other zooms take turns.
            others = len(LARGER) - 1
            for name in tabs if turn == others else tabs[(turn + row) % others :: others]:
                window.raise_dock(name)
                wait_idle(qtbot, teaching)
                # Parts within parts ask for their room one after the other.
                for _ in range(4):
                    QApplication.processEvents()
                assert [other for other, dock in window.docks.items() if dock.isVisible()] == [name]
                assert (window.width(), window.height()) == size, (name, zoom)
                found = painted(window)
                assert len(found) > 5
                assert too_small(window, found) == [], (name, size, zoom)
                assert cut(window, found) == [], (name, size, zoom)
                seen_at.add((name, size))
    assert len(seen_at) == len(tabs) * len(SCREENS)


def check_zoom_reaches_plots_and_mosaics(teaching: Any, qtbot: Any) -> None:
    window = teaching.window
    window.raise_dock("histograms")
    wait_idle(qtbot, teaching)
    plot = teaching.hosts["histograms"].dock.findChild(Plot)
    before = capitals(plot.axes["bottom"].style["tickFont"])
    window.actions_by_name["text-larger"].trigger()
    assert capitals(plot.axes["bottom"].style["tickFont"]) > before
    window.actions_by_name["text-usual"].trigger()
    window.actions_by_name["text-smaller"].trigger()
    assert capitals(plot.axes["bottom"].style["tickFont"]) < before
    window.actions_by_name["text-usual"].trigger()


def check_only_what_is_chosen_is_in_sight(teaching: Any, qtbot: Any) -> None:
    window, actions = teaching.window, teaching.window.actions_by_name
    first, second = ids(teaching)
    columns = teaching.workspace.columns

    def shown() -> list[int]:
        return [column_id for column_id in (first, second) if not columns[column_id].isHidden()]

    teaching.session.select(first)
    qtbot.waitUntil(lambda: shown() == [first])
    assert not teaching.workspace.exemplar.isHidden()
    assert window.toolbar.isHidden()
    teaching.session.select(second)
    assert shown() == [second]
    actions["beside"].trigger()
    teaching.session.select(first)
    assert shown() == [first, second]
    teaching.session.select(second)
    actions["beside"].trigger()
    teaching.session.select(first)
    assert shown() == [first]
    actions["layout-explore"].trigger()
    qtbot.waitUntil(lambda: shown() == [first, second])
    assert not window.toolbar.isHidden()


def check_columns_are_hidden_one_by_one(teaching: Any, qtbot: Any) -> None:
    actions, workspace = teaching.window.actions_by_name, teaching.workspace
    first, second = ids(teaching)
    teaching.session.select(first)

    def shown() -> list[Any]:
        views = {0: workspace.exemplar, **workspace.columns}
        return [each for each in (0, first, second) if not views[each].isHidden()]

    actions["sight-2"].trigger()
    assert shown() == [0, first, second]
    actions["sight-1"].trigger()
    assert shown() == [0, second]
    actions["sight-0"].trigger()
    assert shown() == [second]
    actions["sight-2"].trigger()
    # Something is always seen.
    assert shown() == [0]
    actions["sight-9"].trigger()
    actions["sight-0"].trigger()
    actions["sight-1"].trigger()
    assert shown() == [0, first]
    teaching.session.select(second)
    assert shown() == [0, first, second]


def check_other_tabs_and_panels_are_one_key_away(teaching: Any, qtbot: Any) -> None:
    window, actions = teaching.window, teaching.window.actions_by_name
    tabs = [name for name in window.docks if name not in SIDES]
    walked = []
    for _ in tabs:
        walked += [name for name in tabs if window.docks[name].isVisible()]
        actions["next-tab"].trigger()
    assert sorted(walked) == sorted(tabs)
    actions["previous-tab"].trigger()
    assert [name for name in tabs if window.docks[name].isVisible()] == [walked[-1]]
    for name, content in (("gallery", window.gallery), ("parameters", window.parameters)):
        overlay = teaching.teach_mode.overlays[name]
        width = teaching.workspace.width()
        actions[f"overlay-{name}"].trigger()
        assert overlay.isVisible()
        assert content.isVisible()
        assert overlay.isAncestorOf(content)
        assert window.rect().contains(overlay.geometry())
        assert teaching.workspace.width() == width
        found = painted(overlay)
        assert [each.name for each in found if each.capitals < window.height() / 40] == []
        qtbot.keyClick(content, Qt.Key.Key_Escape)
        assert not overlay.isVisible()
        assert window.docks[name].widget() is content
        assert not window.docks[name].isVisible()
    pyramid = teaching.hosts["pyramid"].dock
    window.raise_dock("pyramid")
    qtbot.waitUntil(lambda: seen(pyramid.body))
    assert not pyramid.controls.isVisible()
    actions["tab-controls"].trigger()
    assert pyramid.controls.isVisible()
    actions["tab-controls"].trigger()
    assert not pyramid.controls.isVisible()
    window.raise_dock("steps")
    assert teaching.hosts["steps"].dock.slider.isVisible()


def check_the_tab_alone_has_the_room_of_the_pictures(teaching: Any, qtbot: Any) -> None:
    window, alone = teaching.window, teaching.window.actions_by_name["tab-alone"]
    window.raise_dock("pyramid")
    dock = window.docks["pyramid"]
    qtbot.waitUntil(lambda: window.front_dock() == "pyramid")
    before = dock.height()
    alone.trigger()
    qtbot.waitUntil(lambda: dock.height() > 0.8 * window.height())
    assert not teaching.workspace.isVisible()
    alone.trigger()
    assert teaching.workspace.isVisible()
    qtbot.waitUntil(lambda: abs(dock.height() - before) < 3)


def test_leaving_teach_puts_everything_back(qtbot: Any, explorer: Any) -> None:
    window, actions = explorer.window, explorer.window.actions_by_name
    actions["layout-explore"].trigger()
    window.docks["maps"].setFloating(True)
    window.docks["spectrum"].hide()
    window.raise_dock("histograms")
    window.strip.set_open(True)
    wait_idle(qtbot, explorer)

    def state() -> dict[str, Any]:
        docks = {name: (dock.isVisible(), dock.isFloating()) for name, dock in window.docks.items()}
        cells = [view.isVisible() for view in (explorer.workspace.exemplar, *explorer.workspace.columns.values())]
        bars = window.toolbar.isVisible(), window.statusBar().isVisible(), window.menuBar().isVisible()
        fonts = window.font().pointSizeF(), explorer.workspace.columns[ids(explorer)[0]].line.font().pointSizeF()
        return {
            "docks": docks,
            "cells": cells,
            "bars": bars,
            "fonts": fonts,
            "front": window.front_dock(),
            "open": window.strip.is_open,
            "controls": explorer.hosts["histograms"].dock.controls.isVisible(),
        }

    before = state()
    actions["layout-teach"].trigger()
    window.raise_dock("pyramid")
    for name in ("overlay-gallery", "tab-alone", "halo", "ink", "sight-0", "next-tab", "layout-teach"):
        actions[name].trigger()
    assert state() != before
    actions["layout-explore"].trigger()
    wait_idle(qtbot, explorer)
    assert state() == before
    assert not explorer.teach_mode.chalk.isVisible()
    assert not any(actions[name].isChecked() for name in ("tab-alone", "halo", "ink", "spotlight"))


def test_lines_are_drawn_taken_back_and_wiped(qtbot: Any) -> None:
    below = QWidget()
    qtbot.addWidget(below)
    below.resize(400, 320)
    below.show()
    chalk = Chalk(below)
    assert chalk.isHidden()
    chalk.set_drawing(True)
    assert chalk.geometry() == below.rect()

    def line(row: int) -> None:
        left = Qt.MouseButton.LeftButton
        qtbot.mousePress(chalk, left, pos=QPoint(40, row))
        for x in (120, 200, 300):
            qtbot.mouseMove(chalk, QPoint(x, row))
        qtbot.mouseRelease(chalk, left, pos=QPoint(300, row))

    def inked(row: int) -> bool:
        return below.grab().toImage().pixelColor(150, row) == QColor(INK)

    line(60)
    line(200)
    assert inked(60)
    assert inked(200)
    chalk.undo()
    assert inked(60)
    assert not inked(200)
    chalk.set_drawing(False)
    # What is drawn stays, and lets the mouse through.
    assert chalk.isVisible()
    assert chalk.testAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
    chalk.clear()
    assert chalk.isHidden()
    below.resize(500, 300)
    chalk.set_spotlight(True)
    assert chalk.geometry() == below.rect()
    white = below.grab().toImage().pixelColor(499, 299).lightness()
    qtbot.mouseMove(below, QPoint(480, 290))
    qtbot.waitUntil(lambda: below.grab().toImage().pixelColor(499, 299).lightness() > white)
    chalk.put_away()
    assert chalk.isHidden()


def check_full_screen_and_back(teaching: Any, qtbot: Any) -> None:
    window = teaching.window
    window.actions_by_name["full-screen"].trigger()
    qtbot.waitUntil(window.isFullScreen)
    assert window.menuBar().isHidden()
    window.actions_by_name["full-screen"].trigger()
    qtbot.waitUntil(lambda: not window.isFullScreen())
    assert not window.menuBar().isHidden()


@pytest.mark.slow
def test_what_the_keys_of_teach_do(teaching: Any, qtbot: Any) -> None:
    # A window takes longer to open than all of these take.
    check_zoom_reaches_plots_and_mosaics(teaching, qtbot)
    check_only_what_is_chosen_is_in_sight(teaching, qtbot)
    teaching.window.actions_by_name["layout-teach"].trigger()
    check_columns_are_hidden_one_by_one(teaching, qtbot)
    check_other_tabs_and_panels_are_one_key_away(teaching, qtbot)
    check_the_tab_alone_has_the_room_of_the_pictures(teaching, qtbot)
    check_full_screen_and_back(teaching, qtbot)
