"""Large pictures: no more is prepared than can be seen, and what is shown is theirs, pixel by pixel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import column_of, noise, scene_of
from PySide6.QtCore import QPointF, QRectF
from PySide6.QtWidgets import QApplication, QWidget

from texlab.docks.bands.controls import BandCache, PyramidSettings
from texlab.docks.bands.middle import MOST_SIDE, middle_of, middle_words
from texlab.docks.bands.pyramid import PyramidDock
from texlab.docks.frame import STALE
from texlab.docks.host import DockHost
from texlab.runs.slots import Slots
from texlab.widgets import picture_item
from texlab.widgets.image_pane import ImagePane
from texlab.widgets.picture_item import PictureItem
from texlab.widgets.view_link import ViewLink
from texlab.widgets.zoom_box import ZoomBox
from texlab_core.stats.bands import split

if TYPE_CHECKING:
    from collections.abc import Iterator

SIDE = 96


@pytest.fixture
def picture(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A picture that counts as large."""
    monkeypatch.setattr(picture_item, "SMALL", SIDE * SIDE - 1)
    return np.random.default_rng(0).integers(0, 256, (SIDE, SIDE, 3), np.uint8)


def test_a_part_at_full_size_is_its_own_pixels(qapp: Any, picture: Any) -> None:
    item = PictureItem()
    item.show_picture(picture, QRectF(20, 30, 16, 8), 0.25)
    assert item.part == (26, 12, 42, 44, 1)
    np.testing.assert_array_equal(item.image, picture[26:42, 12:44])
    assert item.mapRectToParent(item.boundingRect()) == QRectF(12, 26, 32, 16)
    # What is prepared already is not prepared again, what is not is.
    prepared = item.image
    item.look(QRectF(14, 28, 16, 8), 0.25)
    assert item.image is prepared
    item.look(QRectF(60, 60, 16, 8), 0.25)
    assert item.image is not prepared
    top, left, bottom, right, step = item.part or (0, 0, 0, 0, 0)
    assert step == 1
    assert QRectF(left, top, right - left, bottom - top).contains(QRectF(60, 60, 16, 8))


@pytest.mark.parametrize(("pixel", "step"), [(0.1, 1), (1.0, 1), (2.0, 1), (4.0, 2), (9.0, 4), (16.0, 8)])
def test_a_whole_is_reduced_to_two_samples_a_pixel(qapp: Any, picture: Any, pixel: float, step: int) -> None:
    item = PictureItem()
    item.show_picture(picture, QRectF(-5, -5, 2 * SIDE, 2 * SIDE), pixel)
    np.testing.assert_array_equal(item.image, picture[::step, ::step])
    assert item.part == (0, 0, SIDE, SIDE, step)
    assert item.mapRectToParent(item.boundingRect()) == QRectF(0, 0, SIDE, SIDE)


def test_a_side_that_is_no_multiple_keeps_the_scale(qapp: Any, picture: Any) -> None:
    item = PictureItem()
    item.show_picture(np.ascontiguousarray(np.tile(picture, (2, 2, 1))[:131, :97]), QRectF(0, 0, 97, 131), 8.0)
    assert item.image.shape[:2] == (33, 25)
    assert item.mapRectToParent(item.boundingRect()) == QRectF(0, 0, 100, 132)


def test_a_small_picture_is_prepared_whole(qapp: Any) -> None:
    item = PictureItem()
    small = np.zeros((40, 50, 3), np.uint8)
    item.show_picture(small, QRectF(0, 0, 1, 1), 16.0)
    assert np.shares_memory(item.image, small)
    assert item.image.shape == small.shape
    assert item.part is None
    item.show_picture(None, QRectF(), 1.0)
    assert item.image is None


def test_a_pane_prepares_what_it_shows(qtbot: Any, picture: Any) -> None:
    link, window = ViewLink(), QWidget()
    qtbot.addWidget(window)
    pane = ImagePane(link, window)
    pane.resize(64, 64)
    window.show()
    link.set_extent(SIDE, SIDE)
    pane.set_picture(picture)
    pane.set_tiled(True)
    pane.set_overlay(picture)
    link.fit()
    items = [pane.item, *pane._copies, pane._overlay]
    assert all(item is not None and item.part is not None for item in items)
    pane.show_around(QPointF(SIDE, SIDE), 0.1)
    assert all(item is not None and item.part == (0, 0, SIDE, SIDE, 4) for item in items)
    # Every one holds what can be seen of its own place.
    pane.show_around(QPointF(SIDE + 20, 30), 8.0)
    seen = pane.view_rect()
    beside = pane._copies[0]
    top, left, bottom, right, step = beside.part or (0, 0, 0, 0, 0)
    assert step == 1
    wanted = seen.translated(-SIDE, 0).intersected(QRectF(0, 0, SIDE, SIDE))
    assert QRectF(left, top, right - left, bottom - top).contains(wanted)
    assert (bottom - top) * (right - left) < SIDE * SIDE
    np.testing.assert_array_equal(beside.image, picture[top:bottom, left:right])


def test_levels_are_painted_through_the_table_part_by_part(qapp: Any, picture: Any) -> None:
    item, table = PictureItem(), np.arange(255, -1, -1).astype(np.uint8)
    item.show_picture(picture, QRectF(20, 30, 16, 8), 0.25, table)
    np.testing.assert_array_equal(item.image, 255 - picture[26:42, 12:44])
    item.look(QRectF(60, 60, 16, 8), 0.25)
    np.testing.assert_array_equal(item.image, 255 - picture[56:72, 52:84])


# Subbands.


def test_the_middle_is_split_at_full_size() -> None:
    large = np.zeros((1400, 2600, 1), np.float32)
    assert middle_of(large).shape == (MOST_SIDE, MOST_SIDE, 1)
    assert middle_of(large).base is large
    assert middle_words(large) == "the middle 1024 x 1024 of 2600 x 1400 pixels"
    small = large[:64, :80]
    assert middle_of(small) is not None
    assert middle_of(small).shape == small.shape
    assert middle_words(small) == ""
    large[500:520, 1100:1130] = 1.0
    settings = PyramidSettings("laplacian", 3, 4)
    found = BandCache().bands(large, large, "luma", settings, lambda: False)
    # From row (1400 - 1024) // 2 and column (2600 - 1024) // 2, on the grid of 256.
    expected = split(large[0:1024, 768:1792, 0], "laplacian", 3, 4)
    for band, wanted in zip(found, expected, strict=True):
        np.testing.assert_array_equal(band.plane, wanted.plane)


# What is out of date.


@pytest.fixture
def pyramid(qtbot: Any) -> Iterator[Any]:
    dock = PyramidDock()
    qtbot.addWidget(dock)
    dock.resize(900, 300)
    host = DockHost(dock, Slots(1))
    yield dock, host
    host.close()


def shown_scene(seed: int) -> Any:
    exemplar = noise(32, 32, 3, seed=seed)
    return scene_of(column_of(noise(32, 32, 3, seed=seed + 50)), exemplar=exemplar)


def test_a_tab_out_of_sight_lets_go_of_what_is_out_of_date(qtbot: Any, pyramid: Any) -> None:
    dock, host = pyramid
    dock.show()
    first, second = shown_scene(1), shown_scene(2)
    host.show_scene(first)
    qtbot.waitUntil(lambda: dock.answer is not None and not host.busy)
    # Out of sight it keeps what is still true, to be there at once.
    dock.hide()
    qtbot.waitUntil(lambda: not host.seen)
    host.show_scene(first)
    assert dock.answer is not None
    host.show_scene(second)
    assert dock.answer is None
    assert dock.exemplar.shown is None
    assert dock.exemplar.pane.picture is None
    assert len(dock._pictures._recent) == 0
    assert host._asked is None
    dock.show()
    qtbot.waitUntil(lambda: dock.answer is not None and not host.busy)
    assert dock.message is None
    assert dock.exemplar.pane.picture is not None


def test_what_is_from_before_says_so(qtbot: Any) -> None:
    dock = PyramidDock()
    qtbot.addWidget(dock)
    dock.resize(900, 300)
    dock.show()
    mark = dock._stale
    dock.present_waiting()
    # With nothing to see, the whole body says so.
    assert not dock._stale_soon.isActive()
    question = dock.question(shown_scene(1))
    assert question is not None
    answer = question.compute(lambda: False)
    dock.present(answer)
    assert mark.isHidden()
    dock.present_waiting()
    assert dock._stale_soon.isActive()
    dock._stale_soon.timeout.emit()
    assert mark.isVisible()
    assert mark.text() == STALE
    dock.present(answer)
    assert mark.isHidden()
    assert not dock._stale_soon.isActive()
    dock.present_waiting()
    dock.present_nothing("")
    assert mark.isHidden()
    assert not dock._stale_soon.isActive()


def test_no_zoom_is_said_before_a_picture_is_known(qtbot):
    link, window = ViewLink(), QWidget()
    qtbot.addWidget(window)
    box = ZoomBox("zoom", "Zoom", "Zoom of the pictures", link, window)
    pane = ImagePane(link, window)
    pane.resize(300, 300)
    window.show()
    link.fit()
    QApplication.processEvents()
    assert (box.isEnabled(), box.text(), link.percent) == (False, "\u2013", None)
    link.set_extent(150, 150)
    QApplication.processEvents()
    assert box.isEnabled()
    assert box.value() == round(link.percent)
    assert box.text() == f"{box.value():.0f} %"
