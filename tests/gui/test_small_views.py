"""Bars of subbands and grids of patches: what is painted where, mouse and keyboard; labels and timers."""

import numpy as np
import pytest
from mouse import on_screen
from PySide6.QtCore import QObject, Qt

from texlab.docks.explain.band_bars import BandBars, Bar
from texlab.docks.explain.patch_grid import Patch, PatchGrid
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.once import Once
from texlab.widgets.plain import Label

BARS = (
    Bar("high", "", 0.02, 0.01, "high-pass residual"),
    Bar("level 0", "0°", -0.1, 0.05, "level 0, waves along 0°"),
    Bar("level 0", "90°", 0.2, 0.02, "level 0, waves along 90°"),
    Bar("low", "", 0.0, 0.05, "low-pass residual"),
)


def placed(qtbot, widget, width=400, height=160):
    qtbot.addWidget(widget)
    widget.set_theme(LIGHT)
    widget.resize(width, height)
    widget.show()
    on_screen(qtbot, widget)
    return widget


@pytest.fixture
def bars(qtbot):
    made = placed(qtbot, BandBars("bars", "Bars"))
    made.show_bars(BARS)
    return made


def colour_at(widget, x, y):
    return widget.grab().toImage().pixelColor(round(x), round(y)).name()


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda theme: theme.name)
def test_bars_stand_above_and_below_zero(bars, theme):
    bars.set_theme(theme)
    up, down = bars.bar_rect(2).center().x(), bars.bar_rect(1).center().x()
    assert colour_at(bars, up, bars.value_y(0.15)) == theme.result
    assert colour_at(bars, up, bars.value_y(-0.15)) == theme.base
    assert colour_at(bars, down, bars.value_y(-0.05)) == theme.exemplar
    # The light area goes twice the spread in both directions.
    assert colour_at(bars, down, bars.value_y(0.09)) == theme.raised
    assert colour_at(bars, down, bars.value_y(0.12)) == theme.base


def test_bars_of_a_group_stand_together(bars):
    rects = [bars.bar_rect(index) for index in range(4)]
    assert rects[2].left() == pytest.approx(rects[1].right())
    assert rects[1].left() > rects[0].right() + 5
    assert rects[3].right() <= bars.width()


def test_bars_by_mouse_and_keys(bars, qtbot):
    seen = []
    bars.chosen.connect(seen.append)
    qtbot.mouseClick(bars, Qt.MouseButton.LeftButton, pos=bars.bar_rect(1).center().toPoint())
    assert bars.accessibleDescription() == "level 0, waves along 0°: -0.1"
    for key in (Qt.Key.Key_Right, Qt.Key.Key_End, Qt.Key.Key_Right, Qt.Key.Key_Home, Qt.Key.Key_Left):
        qtbot.keyClick(bars, key)
    assert seen == [1, 2, 3, 3, 0, 0]
    with qtbot.waitSignal(bars.hovered) as told:
        qtbot.mouseMove(bars, bars.bar_rect(2).center().toPoint())
    assert told.args == [2]
    bars.show_bars(BARS[:1])
    bars.select(3)
    assert bars.selected == -1


def test_nothing_but_zeros(bars):
    bars.show_bars([Bar("low", "", 0.0, 0.0, "low")])
    bars.grab()
    assert bars.value_y(0.0) > 0


@pytest.fixture
def grid(qtbot):
    made = placed(qtbot, PatchGrid("grid", "Grid"), 420, 150)
    tints = [(k + 1) * 20 for k in range(7)]
    frames = ["window", "chosen", "match", "match", "other", "other", "other"]
    made.show_patches(
        [
            Patch(np.full((9, 9, 3), tint, np.uint8), str(tint), frame, f"patch {tint}")
            for tint, frame in zip(tints, frames, strict=True)
        ]
    )
    return made


def test_patches_are_painted_and_lie_apart(grid):
    image = grid.grab().toImage()
    areas = [grid.part_rect(index) for index in range(7)]
    for tint, area in zip(range(20, 160, 20), areas, strict=True):
        assert (
            image.pixelColor(area.topLeft().toPoint() * 1 + (area.center() - area.topLeft()).toPoint() / 2).red()
            == tint
        )
        assert grid.rect().contains(area.toAlignedRect())
    for first in range(7):
        for second in range(first):
            assert not areas[first].intersects(areas[second])


def test_patches_use_the_room_and_the_first_is_as_high_as_all_rows(grid):
    small = grid.part_rect(1).width()
    grid.resize(900, 300)
    assert grid.part_rect(1).width() > 1.5 * small
    first, others = grid.part_rect(0), [grid.part_rect(index) for index in range(1, 7)]
    assert first.bottom() == pytest.approx(max(area.bottom() for area in others))
    assert first.width() >= others[0].width()


def test_arrow_keys_go_through_the_rows(grid, qtbot):
    grid.resize(560, 300)
    across = sum(grid.part_rect(index).top() == grid.part_rect(1).top() for index in range(1, 7))
    assert 1 < across < 6
    grid.select(1)
    seen = []
    grid.chosen.connect(seen.append)
    for key in (Qt.Key.Key_Down, Qt.Key.Key_Up, Qt.Key.Key_Up, Qt.Key.Key_Left, Qt.Key.Key_Down):
        qtbot.keyClick(grid, key)
    assert seen == [1 + across, 1, 1, 0, 0]


def test_patches_by_mouse_and_keys(grid, qtbot):
    seen = []
    grid.chosen.connect(seen.append)
    qtbot.mouseClick(grid, Qt.MouseButton.LeftButton, pos=grid.part_rect(2).center().toPoint())
    for key in (Qt.Key.Key_Right, Qt.Key.Key_End, Qt.Key.Key_Right, Qt.Key.Key_Home, Qt.Key.Key_Left):
        qtbot.keyClick(grid, key)
    assert seen == [2, 3, 6, 6, 0, 0]
    assert grid.accessibleDescription() == "patch 20"
    with qtbot.waitSignal(grid.hovered) as told:
        qtbot.mouseMove(grid, grid.part_rect(4).center().toPoint())
    assert told.args == [4]


@pytest.mark.parametrize("make", [BandBars, PatchGrid])
def test_without_anything_to_show(qtbot, make):
    view = placed(qtbot, make("view", "View"))
    view.grab()
    qtbot.keyClick(view, Qt.Key.Key_Right)
    assert view.selected == -1


def test_a_label_is_made_as_it_is_to_be(qtbot):
    plain, made = Label("a < b"), Label("What was found", name="found", muted=True, wraps=True)
    for each in (plain, made):
        qtbot.addWidget(each)
    assert (plain.text(), plain.objectName(), plain.wordWrap(), plain.property("role")) == (
        "a < b",
        "",
        False,
        None,
    )
    assert (made.objectName(), made.wordWrap(), made.property("role")) == ("found", True, "muted")


def test_a_timer_that_fires_once_begins_anew_with_each_start(qtbot):
    fired = []
    parent = QObject()
    once = Once(parent, 20, lambda: fired.append(len(fired)))
    assert not once.isActive()
    once.start()
    once.start()
    qtbot.waitUntil(lambda: bool(fired))
    assert (fired, once.isActive(), once.isSingleShot(), once.interval()) == ([0], False, True, 20)
    once.start()
    qtbot.waitUntil(lambda: len(fired) == 2)
