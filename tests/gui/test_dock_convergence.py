"""The convergence dock: curves of all columns, the heat map, live curves."""

from types import SimpleNamespace

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, noise, scene_of, shown
from PySide6.QtCore import Qt

from texlab.docks.convergence import ConvergenceDock, heat_of
from texlab.style.theme import DARK, LIGHT
from texlab_core.engine.steps import Curve
from texlab_core.transforms.steerable import BandKey, band_keys

KEYS = band_keys(2, 3)


def details():
    values = np.arange(4 * 2 * len(KEYS), dtype=float).reshape(4, 2, len(KEYS)) + 1
    return SimpleNamespace(keys=KEYS, distances=values[::-1])


def curves(details):
    mean = details.distances.mean(axis=1)
    found = {"mean-distance": Curve.of(mean.mean(axis=1), "Mean", y_label="W1")}
    for index, key in enumerate(KEYS):
        found[f"band-{key.label}"] = Curve.of(mean[:, index], f"Band {key.label}", y_label="W1")
    return found


@pytest.fixture
def dock(qtbot):
    return shown(qtbot, ConvergenceDock(), 1000, 260)


@pytest.fixture
def scene():
    found = details()
    first = column_of(noise(), title="A", curves=curves(found), details=found)
    other = {"mean-distance": Curve.of([4, 2, 1], "Mean", y_label="W1")}
    second = column_of(noise(), title="B", column_id=2, curves=other)
    return scene_of(first, second, column_of(noise(), title="C", column_id=3), exemplar=noise())


def points(plot):
    return [series.item.getData() for series in plot._series]


def test_controls(dock):
    check_controls(dock)


def test_all_columns_with_the_curve_are_overlaid(dock, scene):
    feed(dock, scene)
    assert dock.curve.currentData() == "mean-distance"
    drawn = points(dock.plot)
    assert len(drawn) == 2
    assert drawn[1][1] == pytest.approx(np.log10([4, 2, 1]))
    assert "<b>A</b>" in dock.legend.text()
    assert ">C<" not in dock.legend.text()
    styles = {(series.role, series.line) for series in dock.plot._series}
    assert len(styles) == 2
    dock.log.setChecked(False)
    assert points(dock.plot)[1][1].tolist() == [4, 2, 1]


def test_every_curve_of_the_column_is_in_the_small_plot(dock, scene):
    feed(dock, scene)
    assert len(points(dock.all)) == 1 + len(KEYS)


def test_another_curve_is_drawn_when_chosen(dock, scene, qtbot):
    feed(dock, scene)
    dock.curve.setFocus()
    with qtbot.waitSignal(dock.asks):
        qtbot.keyClick(dock.curve, Qt.Key.Key_Down)
    feed(dock, scene)
    assert dock.curve.currentData() == "band-high"
    assert len(points(dock.plot)) == 1


def test_heat_map_layout():
    heat = heat_of(details())
    assert heat.rows == ("high", "level 0", "level 1", "low")
    assert heat.columns == ("0°", "60°", "120°")
    assert heat.values.shape == (4, 4, 3)
    known = np.isfinite(heat.values[0])
    assert known.tolist() == [[True, False, False], [True] * 3, [True] * 3, [True, False, False]]
    mean = details().distances.mean(axis=1)
    assert heat.values[2, 1, 2] == mean[2, KEYS.index(BandKey("oriented", 0, 2))]
    assert heat.values[0, 3, 0] == mean[0, -1]
    assert heat.curves[2][1] == "band-l1-o1"


@pytest.mark.parametrize("other", [None, {}, {"keys": 1}, SimpleNamespace(keys=(), distances=np.zeros((1, 1, 0)))])
def test_other_details_have_no_heat_map(other):
    assert heat_of(other) is None


def test_laplacian_levels_have_one_column():
    keys = (BandKey("bandpass", 0), BandKey("bandpass", 1), BandKey("lowpass", 2))
    heat = heat_of(SimpleNamespace(keys=keys, distances=np.ones((2, 1, 3))))
    assert heat.values.shape == (2, 3, 1)
    assert heat.columns == ("",)


def test_the_slider_goes_through_the_iterations(dock, scene, qtbot):
    feed(dock, scene)
    assert dock.iteration_label.text() == "iteration 3 of 3"
    last = float(dock.heat.text(0, 0))
    dock.iteration.setFocus()
    qtbot.keyClick(dock.iteration, Qt.Key.Key_Home)
    assert dock.iteration_label.text() == "iteration 0 of 3"
    assert float(dock.heat.text(0, 0)) > last


def test_a_click_on_a_cell_chooses_its_curve(dock, scene, qtbot):
    feed(dock, scene)
    cell = dock.heat.cell_rect(1, 2).center().toPoint()
    with qtbot.waitSignal(dock.asks):
        qtbot.mouseClick(dock.heat, Qt.MouseButton.LeftButton, pos=cell)
    assert dock.curve.currentData() == "band-l0-o2"
    feed(dock, scene)
    assert dock.heat.selected == (1, 2)
    qtbot.mouseMove(dock.heat, cell)
    qtbot.waitUntil(lambda: dock.readout.text().startswith("level 0 120°:"))


def test_arrow_keys_walk_over_the_cells(dock, scene, qtbot):
    feed(dock, scene)
    dock.heat.setFocus()
    seen = []
    dock.heat.chosen.connect(lambda row, column: seen.append((row, column)))
    keys = (Qt.Key.Key_Right, Qt.Key.Key_Down, Qt.Key.Key_Right, Qt.Key.Key_Right, Qt.Key.Key_Up, Qt.Key.Key_Left)
    for key in keys:
        qtbot.keyClick(dock.heat, key)
    # The residual's row has one cell; nothing goes beyond the border.
    assert seen == [(0, 0), (1, 0), (1, 1), (1, 2), (0, 0), (0, 0)]


def test_live_curves_grow_while_a_column_runs(dock):
    for value in (1.0, 0.5, 0.5, 0.25):
        scene = scene_of(column_of(status="running", metrics={"mean-distance": value}), exemplar=noise())
        feed(dock, scene)
    assert points(dock.plot)[0][1] == pytest.approx(np.log10([1, 0.5, 0.25]))
    assert not dock.heat.isVisible()
    assert feed(dock, scene_of(column_of(status="running"), exemplar=noise())) is None
    feed(dock, scene_of(column_of(status="running", metrics={"mean-distance": 9.0}), exemplar=noise()))
    assert dock.answer.own["mean-distance"].y.tolist() == [9.0]


def test_zeros_lie_below_all_else_in_a_logarithmic_plot(dock):
    found = {"error": Curve.of([1.0, 0.0, np.nan, 0.1], "Error")}
    feed(dock, scene_of(column_of(noise(), curves=found), exemplar=noise()))
    x, y = points(dock.plot)[0]
    assert x.tolist() == [0, 1, 3]
    assert y == pytest.approx([0, np.log10(0.05), -1])


def test_nothing_but_zeros_is_drawn_linearly(dock):
    feed(dock, scene_of(column_of(noise(), curves={"error": Curve.of([0.0, 0.0], "Error")}), exemplar=noise()))
    assert points(dock.plot)[0][1].tolist() == [0, 0]


def growth(unit="gray levels²", last=100):
    axes = {"x_label": "pixels filled", "y_label": unit}
    return {
        "distance": Curve.of([4, 0, 9], "Smallest distance", x=[10, 50, last], **axes),
        "leave-one-out": Curve.of([25, 25], "Own windows", x=[0, last], reference=True, **axes),
    }


def test_a_reference_is_drawn_beside_the_curve_and_is_no_choice(dock, qtbot):
    first = column_of(noise(), title="A", curves=growth())
    other = column_of(noise(), column_id=2, title="B", curves=growth("", 120))
    feed(dock, scene_of(first, other, exemplar=noise()))
    assert [dock.curve.itemText(place) for place in range(dock.curve.count())] == ["Smallest distance"]
    curve, reference = points(dock.plot)
    assert curve[1] == pytest.approx(np.log10([4, 2, 9]))
    assert reference[0].tolist() == [0, 100]
    assert reference[1] == pytest.approx(np.log10([25, 25]))
    # The other column's distances have another unit; the small plot would show nothing else.
    assert ">B<" not in dock.legend.text()
    assert "Own windows 25" in dock.legend.text()
    assert not dock.all.isVisible()
    assert dock.plot._texts[0][0].toPlainText() == "Own windows"
    same = column_of(noise(), column_id=2, title="B", curves=growth())
    feed(dock, scene_of(first, same, exemplar=noise()))
    assert len(points(dock.plot)) == 3


def test_a_result_without_curves_says_so(dock):
    assert feed(dock, scene_of(column_of(noise(), title="Efros-Leung"), exemplar=noise())) is None
    assert dock.message == "Efros-Leung records no curves."


def test_value_under_the_cursor(dock, scene, qtbot):
    feed(dock, scene)
    where = dock.plot.graph.mapFromScene(dock.plot.view.mapViewToScene(dock.plot.view.viewRect().center()))
    qtbot.mouseMove(dock.plot.graph.viewport(), where)
    assert "A " in dock.readout.text()
    assert "B " in dock.readout.text()


def test_themes_and_narrow(dock, scene):
    feed(dock, scene)
    assert dock.all.isVisible()
    dock.resize(500, 180)
    assert not dock.all.isVisible()
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        assert dock.plot._series[0].item.opts["pen"].color().name() == theme.exemplar
        assert theme.exemplar in dock.legend.text()


@pytest.mark.parametrize(("x", "shown"), [(0.2, "0: A 8, B 4"), (1.2, "1: A 4, B 2"), (9.0, "2: A 2, B 1")])
def test_the_values_nearest_to_the_pointer_are_told(dock, x, shown):
    curves = {"mean-distance": Curve.of([8, 4, 2], "Mean", y_label="W1")}
    others = {"mean-distance": Curve.of([4, 2, 1], "Mean", y_label="W1")}
    upper = column_of(noise(), title="A", curves=curves)
    lower = column_of(noise(), title="B", column_id=2, curves=others)
    feed(dock, scene_of(upper, lower, exemplar=noise()))
    dock.plot.hovered.emit(x, 0.0)
    assert dock.readout.text() == f"iteration {shown}"
