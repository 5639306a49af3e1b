"""The threshold editor above and beside the cells: the law, what binds, rows on the clipboard, legible numbers."""

from __future__ import annotations

import dataclasses
import itertools
from typing import Any

import numpy as np
import pytest
from de_bonet_scenes import finished, scene
from dock_scenes import feed
from mouse import drag, handle_point
from PySide6.QtCore import QEvent, QPoint, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QGuiApplication, QHelpEvent
from PySide6.QtWidgets import QApplication, QToolTip
from threshold_hand import Hand

from texlab.docks.thresholds import binds
from texlab.docks.thresholds.law_line import law_words
from texlab.docks.thresholds.numbers import NumberWriter
from texlab.docks.thresholds.rows import pasted, rows_text
from texlab.docks.thresholds.selection import Selection
from texlab.docks.thresholds.table import Axes, cell_texts, make_view, runs
from texlab.state.intentions import EditField, Tell
from texlab.style.colouring import QUIET_TABLES
from texlab.style.theme import DARK, LIGHT
from texlab_core.errors import Cancelled, InputError
from texlab_core.methods.de_bonet.binding import binding
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def hand(qtbot: Any) -> Hand:
    return Hand(qtbot)


def view_of(
    cells: Any = (), *, channels: int = 3, law: tuple[float, float] = (0.15, 0.0), how: Any = "each"
) -> Any:
    return make_view(Axes.of(finished(channels).result.model), how, ThresholdTable(tuple(cells)), law)


def choose(box: Any, value: Any) -> None:
    index = box.findData(value)
    assert index >= 0
    box.setCurrentIndex(index)
    box.activated.emit(index)


# Numbers.


def test_numbers_lose_digits_before_they_lose_their_meaning() -> None:
    assert cell_texts(0.342) == ("0.342", ".342", "0.34", ".34", "0.3", ".3")
    assert cell_texts(0.15) == ("0.15", ".15", "0.1", ".1")
    assert cell_texts(0.0) == ("0",)
    assert cell_texts(12.345) == ("12.3", "12")


def test_neighbours_that_hold_the_same_are_one_field() -> None:
    cells = [((1, "red/first-45"), 0.5), ((1, "red/first-90"), 0.5), ((2, "blue/laplacian"), 0.15)]
    view = view_of(cells)
    locked = frozenset({(3, view.heads[4].first.name)})
    for row, parts in enumerate(runs(view, locked)):
        assert [each for first, last in parts for each in range(first, last + 1)] == list(range(len(view.heads)))
        joined = {each for first, last in parts for each in range(first, last)}
        for column, (one, other) in enumerate(itertools.pairwise(view.heads)):
            alone = any(
                view.changed[row, each] or set(view.cells(row, each)) <= locked for each in (column, column + 1)
            )
            same = view.values[row, column] == view.values[row, column + 1] and one.group == other.group
            assert (column in joined) == (same and not alone)
    assert [len(parts) for parts in runs(view_of(), frozenset())] == [3] * view.axes.depth


@pytest.mark.parametrize("width", [606.0, 840.0])
def test_every_number_can_be_read_upright_in_a_small_window(qapp: Any, width: float) -> None:
    """27 columns beside each other in a window of 1280 pixels: the law's numbers, and some set by hand."""
    font = QFont(QApplication.font())
    writer = NumberWriter(font)
    cell = (width - 90 - 10) / 27
    for value, columns in ((0.15, 9), (0.0342, 9), (0.106, 4), (0.342, 1), (2.5, 1), (0.0, 1)):
        area = QRectF(0, 0, cell * columns - 1, 30)
        fitted = writer._fit(cell_texts(value), area, writer._fonts[columns == 1])
        assert fitted is not None, value
        if columns > 1:
            assert fitted.words == cell_texts(value)[0]
        assert fitted.font.pointSizeF() >= 0.8 * font.pointSizeF()


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_text_can_be_read_on_every_colour_of_the_table(theme: Any) -> None:
    def luminance(colour: Any) -> float:
        linear = [c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in np.asarray(colour) / 255]
        return float(np.dot((0.2126, 0.7152, 0.0722), linear))

    ink = luminance(QColor(theme.text).getRgb()[:3])
    for colour in QUIET_TABLES[theme.name]:
        light, dark = sorted((ink, luminance(colour)), reverse=True)
        assert (light + 0.05) / (dark + 0.05) >= 4.5
    # Lightness alone orders the colours.
    steps = np.diff([luminance(colour) for colour in QUIET_TABLES[theme.name][::16]])
    assert (steps > 0).all() or (steps < 0).all()


# The law.


def test_the_law_is_written_out() -> None:
    assert law_words(0.15, 0.0, 4) == "T = α / k^β = 0.15 / k^0 at every k"
    assert law_words(0.3, 1.0, 3) == "T = α / k^β = 0.3 / k^1: 0.3, 0.15, 0.1"


def test_alpha_and_beta_stand_above_the_table(hand: Hand, qtbot: Any) -> None:
    told: list[Any] = []
    hand.dock.intention.connect(told.append)
    law = hand.dock.law
    assert law.mapTo(hand.dock, QPoint(0, law.height())).y() <= hand.editor.mapTo(hand.dock, QPoint(0, 0)).y()
    slider = law.knobs["alpha"].slider
    start = handle_point(slider)
    drag(qtbot, slider, [start, start + QPoint(9, 0), start + QPoint(24, 0)])
    assert all(isinstance(each, EditField) and each.field == "alpha" for each in told)
    assert [each.final for each in told][-1:] == [True]
    assert not told[0].final
    assert told[-1].value > 0.15
    box = law.knobs["beta"].box
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "1")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: told[-1].field == "beta" and told[-1].final)
    assert told[-1].value == 1
    # What the column has by now is what is shown.
    hand.column = dataclasses.replace(hand.column, params=hand.column.params.replace(alpha=0.3, beta=0.5))
    hand.feed()
    assert law.knobs["alpha"].box.value() == 0.3
    assert law_words(0.3, 0.5, hand.editor.view.axes.depth) in law.words.toolTip().replace("\n", " ")
    # As much of it is written as there is room for, and nothing is cut.
    for width in (1000, 260, 150, 20):
        law.words.resize(width, law.words.height())
        law._fit()
        assert law.words.fontMetrics().horizontalAdvance(law.words.text()) <= width
        assert law_words(0.3, 0.5, hand.editor.view.axes.depth).startswith(law.words.text())


# What binds.


def test_counts_stand_behind_the_rows(hand: Hand) -> None:
    curve = hand.column.result.curves["median-candidates"]
    expected = [f"{value:.4g}" for level, value in zip(curve.x, curve.y, strict=True) if level != max(curve.x)]
    depth = hand.editor.view.axes.depth
    assert binds.counts(hand.column, depth) == tuple(expected)
    assert len(expected) == depth
    at = QPoint(hand.editor.width() - 4, hand.at(0, 0).y())
    QApplication.sendEvent(hand.editor, QHelpEvent(QEvent.Type.ToolTip, at, hand.editor.mapToGlobal(at)))
    assert "how many candidates a typical pixel's ancestor has left" in QToolTip.text().replace("\n", " ")
    last = hand.editor.cell_rect(0, hand.editor.view.values.shape[1] - 1)
    assert last.right() < hand.editor.width() - hand.editor.fontMetrics().horizontalAdvance(expected[0])
    assert binds.counts(dataclasses.replace(hand.column, result=None), depth) == ()


@pytest.mark.parametrize("how", ["each", "together"])
def test_cells_are_coloured_by_what_they_exclude(hand: Hand, how: str) -> None:
    hand.column = finished(alpha=1.0)
    hand.feed()
    choose(hand.dock.arrangement, how)
    plain = hand.editor.grab().toImage()
    choose(hand.dock.colouring, "alone")
    answer = hand.feed()
    sampling = hand.column.result.details.sampling
    expected = binding(sampling)
    np.testing.assert_array_equal(answer.found.alone, expected.alone)
    view = hand.editor.view
    names = [feature.name for feature in sampling.analysis.features]
    shares = expected.alone / np.maximum(expected.excluded, 1)[:, None]
    summed = np.array(
        [
            [sum(shares[row, names.index(feature.name)] for feature in head.features) for head in view.heads]
            for row in range(view.axes.depth)
        ]
    )
    np.testing.assert_allclose(binds.of_cells(view, expected, "alone"), summed)
    shown = binds.shading(summed)
    assert shown.max() == 1
    row, column = np.unravel_index(int(shown.argmax()), shown.shape)
    place = (hand.editor.cell_rect(row, column).topLeft() + QPoint(2, 3)).toPoint()
    strongest = hand.editor.grab().toImage().pixelColor(place)
    assert strongest.getRgb()[:3] == tuple(QUIET_TABLES["light"][-1])
    released = binds.of_cells(view, expected, "released")
    assert released.max() > 0
    assert f"{released.max():.2g} more candidates without it" in hand.dock.binding_words.text()
    # The cell says both numbers.
    position = hand.editor.cell_rect(row, column).center().toPoint()
    help_event = QHelpEvent(QEvent.Type.ToolTip, position, hand.editor.mapToGlobal(position))
    QApplication.sendEvent(hand.editor, help_event)
    assert f"alone causes {summed[row, column]:.1%} of the exclusions" in QToolTip.text().replace("\n", " ")
    choose(hand.dock.colouring, "values")
    hand.feed()
    assert not hand.dock.binding_words.isVisible()
    assert hand.editor.grab().toImage() == plain


def test_what_binds_is_that_of_the_newest_result_alone(hand: Hand) -> None:
    # What was looked into before is known; nobody has asked about this one.
    hand.column = finished(alpha=0.152)
    hand.feed()
    choose(hand.dock.colouring, "released")
    question = hand.dock.question(scene(hand.column))
    assert question is not None
    # A newer result comes while it is computed.
    sampling = hand.column.result.details.sampling
    model, looked = sampling.analysis, []

    def newest() -> Any:
        looked.append(1)
        return sampling if len(looked) < 3 else None

    fresh = dataclasses.replace(sampling)
    assert binds.answer(model, 1, 0, fresh, lambda: None, lambda: False).found is None
    assert binds.answer(model, 1, 0, dataclasses.replace(sampling), newest, lambda: False).found is None
    with pytest.raises(Cancelled):
        binds.answer(model, 1, 0, dataclasses.replace(sampling), lambda: sampling, lambda: True)
    hand.dock.show_scene(scene(dataclasses.replace(hand.column, result=None)))
    assert question.compute(lambda: False).found is None
    # Without a result it is said that there is nothing to know.
    stopped = dataclasses.replace(hand.column, result=None, status="cancelled")
    feed(hand.dock, scene(stopped))
    # Of a table of another depth nothing is shown.
    other = view_of(channels=1)
    assert binds.of_cells(other, binding(sampling, 4), "alone") is None
    assert binds.words(other, binding(sampling, 4), 0, 0) == ""
    assert binds.strictest(other, binding(sampling, 4)) == ""


def test_a_table_that_lets_everything_through_costs_nothing() -> None:
    sampling = finished(alpha=0.152).result.details.sampling
    found = binding(dataclasses.replace(sampling, thresholds=np.full_like(sampling.thresholds, np.inf)), 16)
    view = view_of()
    assert binds.strictest(view, found).startswith("No cell alone costs candidates (")
    assert not binds.shading(binds.of_cells(view, found, "alone")).any()


# Rows on the clipboard.


def test_copied_rows_come_back_as_they_were() -> None:
    cells = [((1, "red/first-45"), 1e6), ((2, "blue/laplacian"), 1.25e-5), ((2, "green/first-0"), 0.0)]
    view = view_of(cells, law=(0.3, 0.7))
    depth = view.axes.depth
    text = rows_text(view, range(depth))
    again, note = pasted(text, view_of(law=(0.9, 0.0)), [0])
    assert note == ""
    names = [feature.name for feature in view.axes.features]
    expected = view.table.matrix(0.3, 0.7, depth, names)
    found = np.array([[again[k, name] for name in names] for k in range(1, depth + 1)], np.float32)
    np.testing.assert_array_equal(found, expected)
    # A single row goes where it is wanted.
    single, _ = pasted(rows_text(view, [1]), view, [0, 3])
    assert {k for k, _ in single} == {1, 4}
    assert single[4, "blue/laplacian"] == pytest.approx(1.25e-5)


def test_rows_of_another_exemplar_give_what_fits() -> None:
    view, gray = view_of(), view_of(channels=1)
    with pytest.raises(InputError, match="has none of the copied levels and features"):
        pasted(rows_text(gray, [0]), view, [0])
    text = "k\tred/laplacian\tred/first-1\n1\t0,5\t1\n2\t0.25\t1\n99\t1\t1\n"
    cells, note = pasted(text, view, [0])
    assert cells == {(1, "red/laplacian"): 0.5, (2, "red/laplacian"): 0.25}
    assert note == "This exemplar does not have 1 feature and 1 level of the copied rows."


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "There are no rows of a threshold table on the clipboard"),
        ("some\ttext\n1\t2\n", "There are no rows of a threshold table on the clipboard"),
        ("k\tred/laplacian\n", "There are no rows"),
        ("k\tred/laplacian\n1\t2\t3\n", "more or fewer numbers than names"),
        ("k\tred/laplacian\n1.5\t2\n", "begins with k, a whole number from 1, got '1.5'"),
        ("k\tred/laplacian\n0\t2\n", "begins with k, a whole number from 1, got '0'"),
        ("k\tred/laplacian\n1\t-2\n", "A threshold is a number from 0 to 1000000, got '-2'"),
        ("k\tred/laplacian\n1\tnan\n", "A threshold is a number from 0 to 1000000, got 'nan'"),
    ],
)
def test_other_text_is_refused_in_one_sentence(text: str, sentence: str) -> None:
    with pytest.raises(InputError) as raised:
        pasted(text, view_of(), [0])
    assert sentence in str(raised.value)


def test_rows_go_from_column_to_column_by_keys(hand: Hand, qtbot: Any) -> None:
    told: list[Any] = []
    hand.dock.intention.connect(told.append)
    hand.editor.select(Selection.cell(1, 3))
    hand.editor.set_value(0.77)
    wanted = hand.editor.view.values.copy()
    hand.click(0, 0)
    hand.click(1, 0, CONTROL)
    hand.key(Qt.Key.Key_C, CONTROL)
    assert told[-1] == Tell("2 rows copied.")
    other = finished(column_id=2, alpha=0.3)
    feed(hand.dock, scene(other))
    told.clear()
    locked = hand.editor.view.cells(0, 2)
    hand.editor.set_locked(frozenset(locked))
    hand.key(Qt.Key.Key_V, CONTROL)
    assert len(told) == 1
    edit = told[0]
    assert (edit.column_id, edit.field, edit.final) == (2, "thresholds", True)
    values = hand.editor.view.values
    np.testing.assert_allclose(np.delete(values[0], 2), np.delete(wanted[0], 2))
    np.testing.assert_allclose(values[1], wanted[1])
    assert values[0, 2] == pytest.approx(0.3)
    assert not hand.editor.view.changed[2:].any()
    # By the buttons, and what is no row is said.
    qtbot.mouseClick(hand.dock.findChild(object, "thresholds-copy"), Qt.MouseButton.LeftButton)
    assert told[-1] == Tell("2 rows copied.")
    QGuiApplication.clipboard().setText("nothing")
    qtbot.mouseClick(hand.dock.findChild(object, "thresholds-paste"), Qt.MouseButton.LeftButton)
    assert told[-1].problem
    assert "on the clipboard" in told[-1].sentence


def test_a_threshold_is_no_setting_of_the_tab(hand: Hand) -> None:
    kept = hand.dock.settings()
    assert "channels" in kept
    assert not {"value", "box-alpha", "slider-alpha"} & set(kept)
    assert hand.dock.take_settings({"value": 0.9, "colouring": "alone"}) == ()
    assert hand.table == ThresholdTable()
    assert hand.dock.colouring.currentData() == "alone"
