"""The pyramid dock: mosaics, one band large, edit mode, keys."""

import numpy as np
import pytest
from dock_scenes import check_controls, click, column_of, feed, hover, noise, scene_of, shown
from PySide6.QtCore import Qt

from texlab.docks.bands.controls import BandCache, PyramidSettings
from texlab.docks.bands.pictures import PyramidPictures, PyramidRequest
from texlab.docks.bands.pyramid import PyramidDock
from texlab.docks.recent import Recent
from texlab.style import colouring
from texlab.style.colouring import DIVERGING
from texlab.style.pictures import to_picture
from texlab.style.theme import DARK, LIGHT
from texlab_core.errors import Cancelled
from texlab_core.stats.bands import amplify, projection, split
from texlab_core.transforms.steerable import BandKey


@pytest.fixture
def dock(qtbot):
    return shown(qtbot, PyramidDock(), 1200, 300)


@pytest.fixture
def images():
    return noise(64, 64), noise(64, 64, seed=2)


@pytest.fixture
def scene(images):
    return scene_of(column_of(images[1]), exemplar=images[0])


def set_choice(box, value):
    box.setCurrentIndex([box.itemData(place) for place in range(box.count())].index(value))
    box.activated.emit(box.currentIndex())


def open_band(dock, scene, qtbot, index):
    cell = dock.exemplar.shown.layout.cells[index]
    click(qtbot, dock.exemplar.pane, *cell.centre)
    return feed(dock, scene)


def test_controls(dock):
    check_controls(dock)


def test_mosaics_of_exemplar_and_result(dock, scene, images):
    answer = feed(dock, scene)
    view = projection(images[0], "luma")
    expected = split(view.plane(images[0]), "steerable", 3, 4)
    assert [band.key for band in answer.exemplar.bands] == [band.key for band in expected]
    for band, other in zip(answer.exemplar.bands, expected, strict=True):
        assert np.array_equal(band.plane, other.plane)
    index = 2
    cell = answer.exemplar.layout.cells[index]
    band = expected[index].plane
    limit = 3 * band.std(dtype=np.float64)
    tile = answer.exemplar.picture[cell.top : cell.top + cell.height, cell.left : cell.left + cell.width]
    assert np.array_equal(tile, colouring.diverging(band, limit))
    assert dock.result.isVisible()
    other = split(view.plane(images[1]), "steerable", 3, 4)[index].plane
    tile = answer.result.picture[cell.top : cell.top + cell.height, cell.left : cell.left + cell.width]
    # Both are coloured by the exemplar's spread, or they could not be compared.
    assert np.array_equal(tile, colouring.diverging(other, limit))


def test_one_scale_for_all(dock, scene):
    feed(dock, scene)
    set_choice(dock.scaling, True)
    answer = feed(dock, scene)
    largest = max(band.plane.std(dtype=np.float64) for band in answer.exemplar.bands if band.signed)
    cell = answer.exemplar.layout.cells[1]
    tile = answer.exemplar.picture[cell.top : cell.top + cell.height, cell.left : cell.left + cell.width]
    assert np.array_equal(tile, colouring.diverging(answer.exemplar.bands[1].plane, 3 * largest))


def test_gaussian_levels_are_gray_and_cannot_be_edited(dock, scene):
    feed(dock, scene)
    set_choice(dock.pyramid.kind, "gaussian")
    answer = feed(dock, scene)
    assert [band.label for band in answer.exemplar.bands] == ["0", "1", "2", "3"]
    inside = answer.exemplar.layout.cells[0]
    tile = answer.exemplar.picture[inside.top : inside.top + 64, inside.left : inside.left + 64]
    assert np.all(np.ptp(tile.astype(int), axis=2) == 0)
    assert not dock.edit.isEnabled()
    assert not dock.pyramid.orientations.isVisible()


def test_click_shows_the_band_large(dock, scene, images, qtbot):
    feed(dock, scene)
    assert not dock.detail.isVisible()
    with qtbot.waitSignal(dock.asks):
        answer = open_band(dock, scene, qtbot, 3)
    assert answer.large.band.key == BandKey("oriented", 0, 2)
    assert dock.detail.isVisible()
    assert dock.detail.title.text() == "Level 0, waves along 90°"
    assert np.array_equal(dock.detail.panes[0].picture, answer.large.pictures[0])
    assert dock.detail.panes[0].picture.shape[:2] == (64, 64)
    band = answer.exemplar.bands[3].plane
    assert float(dock.detail.table.cell("sd", 0)) == pytest.approx(band.std(), rel=1e-3)
    assert dock.exemplar.selected == dock.result.selected == 3


def test_arrow_keys_move_between_bands_and_escape_closes(dock, scene, qtbot):
    feed(dock, scene)
    dock.exemplar.setFocus()
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_Right)
    assert feed(dock, scene).large.band.key == BandKey("highpass")
    dock.exemplar.setFocus()
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_Right)
    assert feed(dock, scene).large.band.key == BandKey("oriented", 0, 0)
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_End)
    assert feed(dock, scene).large.band.key == BandKey("lowpass", 3)
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_Escape)
    assert feed(dock, scene).large is None
    assert not dock.detail.isVisible()


def test_value_under_the_cursor(dock, scene, qtbot):
    answer = feed(dock, scene)
    layout = answer.exemplar.layout
    # Level 1 is enlarged twice: the sample, not the mosaic pixel, is told.
    cell = layout.cells[5]
    row, column = cell.top + 21, cell.left + 40
    hover(qtbot, dock.exemplar.pane, row, column)
    band = answer.exemplar.bands[5]
    value = band.plane[10, 20]
    assert dock.readout.text() == f"exemplar, level 1, waves along 0°, 20, 10: {value:.4g}"
    dock.exemplar.pane.hovered.emit(-1, -1)
    assert not dock.readout.isVisible()


def test_value_in_the_large_band(dock, scene, qtbot):
    feed(dock, scene)
    answer = open_band(dock, scene, qtbot, 1)
    dock.grab()
    hover(qtbot, dock.detail.panes[1], 30, 12)
    value = answer.large.other.plane[30, 12]
    assert dock.readout.text() == f"result, level 0, waves along 0°, 12, 30: {value:.4g}"
    assert dock.detail.bar.mark == pytest.approx(float(answer.large.scale.place(value)))


def test_labels_tell_level_and_orientation(dock, scene):
    dock.resize(1900, 400)
    feed(dock, scene)
    dock.grab()
    assert dock.exemplar.label_texts()[:3] == ["high", "0·0°", "0·45°"]


def test_small_tiles_have_no_labels(dock, scene):
    dock.pyramid.orientations.setValue(18)
    feed(dock, scene)
    dock.pyramid.orientations.setValue(18)
    dock.resize(500, 180)
    feed(dock, scene)
    dock.grab()
    assert set(dock.exemplar.label_texts()) <= {"", "0", "high", "low"}


def test_edit_mode_puts_the_exemplar_together_again(dock, scene, images, qtbot):
    feed(dock, scene)
    dock.edit.setFocus()
    qtbot.keyClick(dock.edit, Qt.Key.Key_Space)
    answer = feed(dock, scene)
    assert np.array_equal(answer.edited[0], answer.edited[1])
    assert not dock.result.isVisible()
    click(qtbot, dock.exemplar.pane, *dock.exemplar.shown.layout.cells[2].centre)
    qtbot.mouseClick(dock._gain_group.button(0), Qt.MouseButton.LeftButton)
    answer = feed(dock, scene)
    muted = BandKey("oriented", 0, 1)
    expected = amplify(images[0], "steerable", 3, 4, {muted: 0.0})
    assert np.array_equal(answer.edited[1], to_picture(np.clip(expected, 0, 1)))
    assert np.array_equal(dock.reconstruction.picture, answer.edited[1])
    assert dock._gain_group.checkedId() == 0


def test_gains_by_keys_labels_and_reset(dock, scene, images, qtbot):
    dock.resize(1900, 400)
    feed(dock, scene)
    dock.setFocus()
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_E)
    feed(dock, scene)
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_End)
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_4)
    answer = feed(dock, scene)
    assert answer.request.gains == ((BandKey("lowpass", 3), 4.0),)
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_Home)
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_0)
    feed(dock, scene)
    dock.grab()
    texts = dock.exemplar.label_texts()
    assert texts[0] == "high off"
    assert texts[-1] == "low ×4"
    qtbot.mouseClick(dock.reset, Qt.MouseButton.LeftButton)
    assert feed(dock, scene).request.gains == ()


def test_gains_are_forgotten_with_their_bands(dock, scene, qtbot):
    feed(dock, scene)
    dock.edit.setChecked(True)
    feed(dock, scene)
    qtbot.keyClick(dock.exemplar, Qt.Key.Key_2)
    assert feed(dock, scene).request.gains == ((BandKey("highpass"), 2.0),)
    set_choice(dock.pyramid.kind, "laplacian")
    assert feed(dock, scene).request.gains == ()


def test_nothing_is_computed_twice(dock, scene, qtbot):
    first = feed(dock, scene)
    second = open_band(dock, scene, qtbot, 1)
    assert second.exemplar.bands is first.exemplar.bands
    dock.setFixedSize(dock.size())
    third = open_band(dock, scene, qtbot, 2)
    assert third.exemplar.picture is second.exemplar.picture


def test_stops_when_told(dock, scene):
    with pytest.raises(Cancelled):
        dock.question(scene).compute(lambda: True)


def test_stops_between_the_bands_of_both_mosaics(images):
    request = PyramidRequest(PyramidSettings("laplacian", 3, 1))
    asked = []

    def answer(stop_at):
        asked.clear()

        def should_stop():
            asked.append(1)
            return len(asked) == stop_at

        return PyramidPictures(BandCache(), Recent(4)).answer(*images, request, should_stop)

    bands = len(answer(0).exemplar.bands)
    many = len(asked)
    # Taking apart and painting of both, and the scales of the exemplar.
    assert many >= 5 * bands
    for count in range(1, many + 1):
        with pytest.raises(Cancelled):
            answer(count)
        assert len(asked) == count


def test_smaller_result_lacks_coarse_levels(dock, images):
    answer = feed(dock, scene_of(column_of(noise(8, 8)), exemplar=images[0]))
    assert len(answer.result.bands) < len(answer.exemplar.bands)
    assert dock.result.isVisible()


def test_gray_exemplar_and_no_result(dock):
    answer = feed(dock, scene_of(exemplar=noise(channels=1)))
    assert answer.result is None
    assert not dock.result.isVisible()
    assert [dock.channel.itemText(k) for k in range(dock.channel.count())] == ["gray"]


def test_principal_axes(dock, scene, images):
    feed(dock, scene)
    set_choice(dock.channel, "axis 2")
    answer = feed(dock, scene)
    plane = projection(images[0], "axis 2").plane(images[0])
    assert np.array_equal(answer.exemplar.bands[4].plane, split(plane, "steerable", 3, 4)[4].plane)


def test_without_exemplar_there_is_nothing(dock):
    assert feed(dock, scene_of()) is None
    assert dock.message


def test_both_mosaics_pan_and_zoom_together(dock, scene):
    feed(dock, scene)
    dock.grab()
    dock.exemplar.pane.view.scaleBy((0.5, 0.5))
    dock.exemplar.pane.view.sigRangeChangedManually.emit(dock.exemplar.pane.view.state["mouseEnabled"])
    first, second = dock.exemplar.pane.view_rect(), dock.result.pane.view_rect()
    assert first.width() == pytest.approx(second.width(), rel=0.02)
    assert first.center().x() == pytest.approx(second.center().x(), abs=1)
    height, width = dock.exemplar.shown.layout.size
    assert first.width() < 0.7 * width or first.height() < 0.7 * height


def test_tiles_are_arranged_for_the_room(dock, images, qtbot):
    scene = scene_of(exemplar=images[0])
    feed(dock, scene)
    dock.resize(1900, 200)
    qtbot.wait(1)
    wide = feed(dock, scene)
    with qtbot.waitSignal(dock.asks):
        dock.resize(500, 400)
    narrow = feed(dock, scene)
    assert wide.request.columns == 18
    assert narrow.request.columns < 7


def test_narrow_docks_show_the_large_band_instead_of_the_mosaics(dock, scene, qtbot):
    dock.resize(500, 200)
    feed(dock, scene)
    open_band(dock, scene, qtbot, 1)
    assert dock.detail.isVisible()
    assert not dock.exemplar.isVisible()
    qtbot.wait(1)
    qtbot.mouseClick(dock.detail.close_button, Qt.MouseButton.LeftButton)
    feed(dock, scene)
    assert dock.exemplar.isVisible()


def test_a_theme_asks_for_mosaics_in_its_colours(dock, scene, qtbot):
    feed(dock, scene)
    for theme in (DARK, LIGHT):
        with qtbot.waitSignal(dock.asks):
            dock.set_theme(theme)
        answer = feed(dock, scene)
        between = answer.exemplar.picture[0, 0].astype(int)
        assert "#{:02x}{:02x}{:02x}".format(*between) == (theme.canvas if theme is DARK else theme.muted)
        # A band that is zero everywhere is told from the lines around it.
        assert np.all(np.abs(DIVERGING[2] - between) > 100)


def test_no_scales_leave_the_residuals(dock, scene):
    feed(dock, scene)
    dock.pyramid.scales.setValue(0)
    answer = feed(dock, scene)
    assert [band.label for band in answer.exemplar.bands] == ["high", "low"]


@pytest.mark.parametrize("kind", ["oriented", "gabor", "gabor magnitude", "filter bank"])
def test_kinds_for_looking_at_cannot_be_edited_and_say_why(dock, scene, images, qtbot, kind):
    feed(dock, scene)
    dock.edit.setChecked(True)
    set_choice(dock.pyramid.kind, kind)
    answer = feed(dock, scene)
    assert not answer.request.editing
    assert not dock.edit.isEnabled()
    assert "do not add up" in dock.edit.toolTip()
    assert dock.pyramid.kind.itemData(dock.pyramid.kind.currentIndex(), Qt.ItemDataRole.ToolTipRole)
    assert dock.pyramid.scales.isVisible() == (not kind.startswith("gabor"))
    assert dock.pyramid.orientations.isVisible() == (kind == "oriented")
    expected = split(projection(images[0], "luma").plane(images[0]), kind, 3, 4)
    for band, other in zip(answer.exemplar.bands, expected, strict=True):
        assert np.array_equal(band.plane, other.plane)
    answer = open_band(dock, scene, qtbot, 1)
    assert dock.detail.title.text().lower() == answer.exemplar.bands[1].title.lower()
    set_choice(dock.pyramid.kind, "steerable")
    assert feed(dock, scene).request.editing
    assert "(E)" in dock.edit.toolTip()


def test_magnitudes_are_gray_from_zero(dock, scene):
    feed(dock, scene)
    set_choice(dock.pyramid.kind, "gabor magnitude")
    answer = feed(dock, scene)
    band, cell = answer.exemplar.bands[0], answer.exemplar.layout.cells[0]
    tile = answer.exemplar.picture[cell.top : cell.top + cell.height, cell.left : cell.left + cell.width]
    limit = 3 * np.sqrt(np.square(band.plane.astype(np.float64)).mean() / 2)
    assert np.array_equal(tile, colouring.gray(band.plane, 0, limit))


@pytest.mark.parametrize("kind", ["steerable", "laplacian", "oriented", "gabor", "gabor magnitude", "filter bank"])
def test_rounding_is_not_coloured(dock, kind):
    constant = np.full((64, 64, 3), 0.37, np.float32)
    scene = scene_of(column_of(constant), exemplar=constant)
    feed(dock, scene)
    set_choice(dock.pyramid.kind, kind)
    answer = feed(dock, scene)
    for band, cell in zip(answer.exemplar.bands, answer.exemplar.layout.cells, strict=True):
        tile = answer.exemplar.picture[cell.top : cell.top + cell.height, cell.left : cell.left + cell.width]
        if band.span != "gray":
            nothing = (
                colouring.gray(np.zeros(1), 0, 1)
                if band.span == "positive"
                else colouring.diverging(np.zeros(1), 1)
            )
            assert np.abs(tile.astype(int) - nothing[0]).max() <= 3, band.title


def test_labels_follow_the_size_of_the_text(dock, scene):
    feed(dock, scene)
    label = dock.exemplar._labels[0]
    before = label.textItem.font().pointSizeF()
    # On the mosaic itself: under a style sheet of the application, fonts of parents are not passed on.
    font = dock.exemplar.font()
    font.setPointSizeF(1.5 * font.pointSizeF())
    dock.exemplar.setFont(font)
    assert label.textItem.font().pointSizeF() == pytest.approx(1.5 * before)


def test_gabor_is_not_computed_again_for_other_scales(dock, images):
    feed(dock, scene_of(column_of(images[1]), exemplar=images[0]))
    set_choice(dock.pyramid.kind, "gabor")
    one = feed(dock, scene_of(column_of(images[1]), exemplar=images[0]))
    dock.pyramid.scales.setValue(2)
    other = feed(dock, scene_of(column_of(images[1]), exemplar=images[0]))
    assert other.request.settings == one.request.settings
