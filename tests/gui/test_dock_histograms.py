"""The histograms dock: planes, subbands, views, numbers."""

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, noise, scene_of, shown
from PySide6.QtCore import QPoint, Qt

from texlab.docks.bands.comparison import compare, density
from texlab.docks.bands.histograms import HistogramsDock
from texlab.style.numbers import log_ticks, number
from texlab.style.theme import DARK, LIGHT
from texlab_core.stats.bands import LUMA
from texlab_core.transforms import steerable


@pytest.fixture
def dock(qtbot):
    return shown(qtbot, HistogramsDock())


@pytest.fixture
def images():
    return noise(48, 64), noise(64, 64, seed=2) * np.float32(0.5)


@pytest.fixture
def scene(images):
    return scene_of(column_of(images[1]), exemplar=images[0])


def choose(box, value, dock):
    box.setCurrentIndex([box.itemData(place) for place in range(box.count())].index(value))
    box.activated.emit(box.currentIndex())
    return dock


def test_controls(dock):
    check_controls(dock)


def test_luma_of_both_with_numbers(dock, scene, images):
    (answer,) = feed(dock, scene)
    luma = images[0] @ np.array(LUMA, np.float32)
    expected, _ = np.histogram(luma, bins=128, range=(0, 1), density=True)
    assert answer.exemplar == pytest.approx(expected, abs=128 / luma.size * 1.01 * 3)
    assert answer.exemplar.sum() / 128 == pytest.approx(1)
    assert float(dock.table.cell("mean", 0)) == pytest.approx(luma.mean(), rel=1e-3)
    assert float(dock.table.cell("sd", 1)) == pytest.approx((images[1] @ np.array(LUMA)).std(), rel=1e-3)
    assert dock.table.cell("W1", 0) == ""
    assert float(dock.table.cell("W1", 1)) == pytest.approx(answer.distance, rel=1e-3)
    assert [dock.table.horizontalHeaderItem(k).text() for k in range(2)] == ["exemplar", "result"]
    assert [plot.isVisible() for plot in dock.plots] == [True, False, False]


def test_the_same_image_has_distance_zero(dock, images):
    (answer,) = feed(dock, scene_of(column_of(images[0].copy()), exemplar=images[0]))
    assert answer.distance == 0
    assert np.array_equal(answer.exemplar, answer.result)


def test_red_green_blue_get_a_plot_each(dock, scene, images):
    feed(dock, scene)
    choose(dock.channel, "rgb", dock)
    answers = feed(dock, scene)
    assert [each.title for each in answers] == ["red", "green", "blue"]
    assert all(plot.isVisible() for plot in dock.plots)
    assert dock.table.columnCount() == 6
    assert answers[2].exemplar_moments.mean == pytest.approx(images[0][..., 2].mean(), rel=1e-5)


def test_a_subband(dock, scene, images, qtbot):
    feed(dock, scene)
    assert not dock.band.isVisible()
    with qtbot.waitSignal(dock.asks):
        choose(dock.source, "band", dock)
    feed(dock, scene)
    assert dock.band.isVisible()
    labels = [dock.band.itemText(k) for k in range(dock.band.count())]
    assert labels[:3] == ["high", "0·0°", "0·45°"]
    assert labels[-1] == "low"
    assert len(labels) == 3 * 4 + 2
    key = steerable.BandKey("oriented", 1, 2)
    choose(dock.band, key, dock)
    (answer,) = feed(dock, scene)
    luma = sum(images[0][..., c] * np.float32(w) for c, w in enumerate(LUMA))
    band = steerable.build_reflected(luma, 3, 4).bands[1][2]
    assert answer.exemplar_moments.sd == pytest.approx(band.std(), rel=1e-4)
    assert answer.edges[0] == -answer.edges[-1]


def test_scales_follow_the_column_until_changed_here(dock, images):
    scene = scene_of(column_of(images[1]), exemplar=images[0])
    feed(dock, scene)
    assert (dock.pyramid.scales.value(), dock.pyramid.orientations.value()) == (3, 4)
    dock.pyramid.scales.setValue(2)
    feed(dock, scene)
    assert dock.pyramid.scales.value() == 2
    other = column_of(images[1], column_id=2, params=type(scene.columns[0].params)(scales=1, orientations=6))
    feed(dock, scene_of(*scene.columns, other, exemplar=images[0], selected=2))
    assert (dock.pyramid.scales.value(), dock.pyramid.orientations.value()) == (1, 6)


def test_a_residual_stands_for_levels_that_a_small_image_lacks(dock):
    small = noise(8, 8)
    feed(dock, scene_of(exemplar=small))
    choose(dock.source, "band", dock)
    feed(dock, scene_of(exemplar=small))
    choose(dock.band, steerable.BandKey("oriented", 2, 3), dock)
    (answer,) = feed(dock, scene_of(exemplar=small))
    assert answer.title == "luma, low-pass residual"


def test_log_and_cumulative_views(dock, scene, qtbot):
    feed(dock, scene)
    linear = dock.plots[0]._series[0].item.getData()[1]
    qtbot.mouseClick(dock.log, Qt.MouseButton.LeftButton, pos=QPoint(8, dock.log.height() // 2))
    assert dock.log.isChecked()
    logs = dock.plots[0]._series[0].item.getData()[1]
    positive = linear > 0
    assert logs[positive] == pytest.approx(np.log10(linear[positive]))
    assert np.all(np.isfinite(logs))
    dock.log.setChecked(False)
    dock.cumulated.setFocus()
    qtbot.keyClick(dock.cumulated, Qt.Key.Key_Space)
    shares = dock.plots[0]._series[0].item.getData()[1]
    assert shares[0] == 0
    assert shares[-1] == pytest.approx(1)
    assert np.all(np.diff(shares) >= 0)


def test_series_differ_in_colour_and_style_in_both_themes(dock, scene):
    feed(dock, scene)
    for theme in (LIGHT, DARK):
        dock.set_theme(theme)
        first, second = (series.item.opts["pen"] for series in dock.plots[0]._series)
        assert first.color().name() == theme.exemplar
        assert second.color().name() == theme.result
        assert first.style() != second.style()


def test_gray_and_no_result(dock):
    (answer,) = feed(dock, scene_of(exemplar=noise(channels=1)))
    assert [dock.channel.itemText(k) for k in range(dock.channel.count())] == ["gray"]
    assert answer.result is None
    assert dock.table.columnCount() == 1


def test_a_gray_result_of_a_colour_exemplar_is_left_out(dock):
    (answer,) = feed(dock, scene_of(column_of(noise(channels=1)), exemplar=noise()))
    assert answer.result is None


def test_previews_of_a_running_column_are_shown(dock, images):
    column = column_of(status="running", image=images[1])
    (answer,) = feed(dock, scene_of(column, exemplar=images[0]))
    assert answer.result is not None


def test_without_exemplar_there_is_nothing(dock):
    assert feed(dock, scene_of()) is None
    assert dock.message


def test_value_under_the_cursor(dock, scene, qtbot):
    feed(dock, scene)
    plot = dock.plots[0]
    # The plot gets its place from the layout a moment later.
    qtbot.wait(30)
    where = plot.view.mapViewToScene(plot.view.viewRect().center())
    qtbot.mouseMove(plot.graph.viewport(), plot.graph.mapFromScene(where))
    assert dock.readout.isVisible()
    value, width = float(dock.readout.text().partition(":")[0]), plot.view.viewRect().width()
    # The pointer stands on whole pixels.
    assert value == pytest.approx(plot.view.viewRect().center().x(), abs=width / plot.graph.width())
    assert "exemplar" in dock.readout.text()
    assert "result" in dock.readout.text()


@pytest.mark.parametrize("size", [(500, 180), (760, 220), (1900, 400)])
def test_fits_many_sizes(dock, scene, size, qtbot):
    dock.resize(*size)
    feed(dock, scene)
    qtbot.wait(1)
    assert dock.plots[0].width() > 150
    assert dock.plots[0].height() > 60
    assert dock.table.geometry().right() <= dock.body.width()


def test_constant_images():
    flat = np.full((4, 4), 0.25, np.float32)
    shown = compare("flat", flat, flat)
    assert shown.distance == 0
    assert shown.relative_distance is None
    assert np.isfinite(shown.edges).all()
    assert shown.edges[0] < 0.25 < shown.edges[-1]


def test_density_counts_outliers_in_the_total():
    edges = np.linspace(0, 1, 5)
    assert density(np.array([0.1, 0.1, 0.9, 7.0]), edges).tolist() == [2, 0, 0, 1]


def test_whole_numbers_keep_all_digits():
    assert [number(value) for value in (16384.0, 262144.0, 12345.6, 1e7)] == [
        "16384",
        "262144",
        "12346",
        "1.00e+07",
    ]


def test_numbers_and_ticks():
    assert [number(value) for value in (0.0, -0.0, 0.12345, 123456.7, 1e-7, np.nan)] == [
        "0", "0", "0.1235", "1.23e+05", "1.00e-07", "none",
    ]  # fmt: skip
    assert [text for _, text in log_ticks(-2, 0, 0.9)] == ["0.01", "0.1", "1"]
    assert [text for _, text in log_ticks(-1, 0, 0.2)] == ["0.1", "0.2", "0.5", "1"]
    assert [text for _, text in log_ticks(0.31, 0.46, 0.03)] == ["2.2", "2.4", "2.6", "2.8"]
    for place, text in log_ticks(-0.03, 0.01, 0.005):
        assert place == pytest.approx(np.log10(float(text)))
