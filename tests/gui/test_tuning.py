"""A and B: flicker, swipe, difference, magnifier, and the layout Tune; with real events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from tests.gui.conftest import drag, hb, ids, result_image, wait_idle
from texlab.columns.comparison import other_of
from texlab.columns.magnifier import ACROSS, piece_around
from texlab.style.pictures import to_picture
from texlab.widgets.pair_layer import difference_picture
from texlab.window.fuzzy import fit
from texlab.window.palette import CommandPalette, Entry, best_first, of_actions

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

CONTROL = Qt.KeyboardModifier.ControlModifier


def test_the_difference_is_that_of_the_common_part() -> None:
    one = np.zeros((4, 6, 3), np.uint8)
    other = np.full((5, 3, 3), 10, np.uint8)
    other[0, 0] = (200, 0, 1)
    found = difference_picture(one, other, 4)
    assert found.shape == (4, 3, 3)
    assert found[0, 0].tolist() == [255, 0, 4]
    assert np.all(found[1:] == 40)
    assert np.array_equal(found, difference_picture(other, one, 4))
    assert not difference_picture(other, other, 32).any()


def test_what_a_column_is_compared_with() -> None:
    assert other_of(2, (1, 2, 3), 1) == 1
    assert other_of(2, (1, 2, 3), 9) == 3
    assert other_of(3, (1, 2, 3), 3) == 2
    assert other_of(1, (1,), 1) is None


@pytest.mark.parametrize("place", [(0, 0), (20, 30), (39, 47), (5, 47)])
def test_the_magnifier_shows_what_is_around(place: tuple[int, int]) -> None:
    picture = np.random.default_rng(1).integers(0, 255, (40, 48, 3), np.uint8)
    piece, row, column = piece_around(picture, *place)
    assert max(piece.shape[:2]) <= ACROSS
    assert np.array_equal(piece[row, column], picture[place])
    if place == (20, 30):
        assert piece.shape[:2] == (ACROSS, ACROSS)
        assert (row, column) == (ACROSS // 2, ACROSS // 2)


def test_flicker_swipe_and_difference(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    a, b = (to_picture(result_image(explorer, each)) for each in (first, second))
    comparison, window = explorer.tuning.comparison, explorer.window
    explorer.session.select(first)
    wait_idle(qtbot, explorer)
    assert (explorer.tuning.a, explorer.tuning.b) == (first, second)
    assert comparison.layer is None
    qtbot.keyClick(window, Qt.Key.Key_B)
    assert np.array_equal(comparison.layer, b)
    qtbot.keyClick(window, Qt.Key.Key_B)
    assert comparison.layer is None
    qtbot.keyClick(window, Qt.Key.Key_G)
    qtbot.waitUntil(lambda: comparison.layer is not None)
    assert np.array_equal(comparison.layer, difference_picture(a, b, 4))
    qtbot.keyClick(window, Qt.Key.Key_W)
    assert comparison.mode == "swipe"
    assert np.array_equal(comparison.layer, b[:, 24:])
    pane = explorer.workspace.columns[first].pane
    start, end = (pane.to_widget(20, column).toPoint() for column in (24, 36))
    drag(qtbot, pane.viewport(), [start, start + QPoint(6, 0), end, end])
    assert comparison.share * 48 == pytest.approx(36, abs=1)
    assert np.array_equal(comparison.layer, b[:, round(comparison.share * 48) :])
    assert not window.actions_by_name["flicker"].isChecked()
    assert window.actions_by_name["swipe"].isChecked()
    # The column goes, and what lay over it with it.
    explorer.session.remove_column(first)
    wait_idle(qtbot, explorer)
    assert comparison.layer is None
    assert not window.actions_by_name["flicker"].isEnabled()


def test_tune_shows_two_columns_and_explore_all_again(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    third = explorer.session.add_column(*hb(iterations=3))
    explorer.session.select(first)
    wait_idle(qtbot, explorer)
    views = explorer.workspace.columns
    explorer.session.select(third)
    wait_idle(qtbot, explorer)
    qtbot.keyClick(explorer.window, Qt.Key.Key_3, CONTROL)
    assert [each for each in ids(explorer) if views[each].isVisible()] == [first, third]
    assert explorer.workspace.exemplar.isVisible()
    assert explorer.tuning.bar.isVisible()
    # One pixel is asked about in both.
    assert explorer.controller.scene().compared == (third, first)
    # One of the pair is chosen: nothing moves. Another one: it becomes A.
    explorer.session.select(first)
    wait_idle(qtbot, explorer)
    assert {explorer.tuning.a, explorer.tuning.b} == {first, third}
    explorer.session.select(second)
    wait_idle(qtbot, explorer)
    assert explorer.tuning.a == second
    assert views[second].isVisible()
    assert sum(view.isVisible() for view in views.values()) == 2
    qtbot.keyClick(explorer.window, Qt.Key.Key_1, CONTROL)
    assert all(view.isVisible() for view in views.values())
    assert not explorer.tuning.bar.isVisible()
    assert explorer.controller.scene().compared == ()
    wait_idle(qtbot, explorer)


def test_the_magnifier_follows_the_pointer_in_all_pictures(qtbot: Any, explorer: Explorer) -> None:
    views = [explorer.workspace.columns[each] for each in ids(explorer)]
    qtbot.keyClick(explorer.window, Qt.Key.Key_Z)
    pane = views[0].pane
    qtbot.mouseMove(pane.viewport(), pane.to_widget(20.5, 30.5).toPoint())
    magnifiers = [explorer.tuning._magnifiers[view.pane] for view in views]
    qtbot.waitUntil(lambda: all(each.isVisible() for each in magnifiers))
    for view, magnifier in zip(views, magnifiers, strict=True):
        assert np.array_equal(magnifier.piece, view.pane.picture[12:29, 22:39])
    qtbot.keyClick(explorer.window, Qt.Key.Key_Z)
    assert not any(each.isVisible() for each in magnifiers)


# The palette.


def test_names_fit_by_where_what_was_typed_is_found() -> None:
    assert fit("save", "Save result") > fit("save", "Unsaved") > fit("save", "Sand wave")
    assert fit("save", "Save") > fit("save", "Save result")
    assert fit("res sav", "Save result") is not None
    assert fit("SAVE", "save result") == fit("save", "Save result")
    assert fit("save", "Export", "saves a file") < fit("save", "Unsaved")
    assert fit("xq", "Save result", "writes a file") is None
    assert fit("", "Anything") == 0.0
    assert fit("zzz", "a z b z c d e f g h i j k l m n z") is None


def test_save_offers_save_first(explorer: Explorer) -> None:
    entries = of_actions(explorer.window.actions_by_name.values())
    assert best_first(entries, "save")[0].name == "Save result"
    # Every command is found first, or as well as any other, by its own name.
    for entry in entries:
        best = best_first(entries, entry.name)[0]
        assert fit(entry.name, best.name) >= fit(entry.name, entry.name)
    assert best_first([Entry("texture", "Sand", "", int), Entry("", "Sand", "", int)], "sand")[0].kind == ""


def test_the_palette_finds_textures_parameters_and_panels(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    qtbot.waitUntil(lambda: bool(window.gallery.textures()))
    qtbot.keyClick(window, Qt.Key.Key_K, CONTROL)
    palette = window.findChild(CommandPalette)
    qtbot.keyClicks(palette.field, "iterat")
    assert palette.list.item(0).text() == "iterations  (parameter)"
    palette.field.clear()
    qtbot.keyClicks(palette.field, "zebr")
    assert palette.list.item(0).text() == "Zebra  (texture)"
    with qtbot.waitSignal(window.gallery.chosen) as told:
        qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert "zebra" in told.args[0]
    wait_idle(qtbot, explorer)
