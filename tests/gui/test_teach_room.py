"""In Teach nothing is cut, and what a step of a lesson shows has the room that it needs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import column_of, noise
from painted_text import cut, lines_of, overlapping, painted
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QApplication, QMainWindow, QVBoxLayout, QWidget

from tests.gui.conftest import ids, wait_idle
from tests.gui.test_lessons import SMALL, give, wait_ready
from texlab.columns.column import ColumnView
from texlab.columns.exemplar import ExemplarView
from texlab.columns.foot import Foot
from texlab.docks.lab.dock import LabDock
from texlab.docks.lab.page import best_columns
from texlab.docks.spectral.code import CodeDock
from texlab.docks.spectral.code_views import CodeGrid
from texlab.docks.steps import StepsDock
from texlab.state.intentions import GoToStep, LeaveLesson
from texlab.storage.paths import config_dir
from texlab.style.colouring import SEQUENTIAL_TABLE
from texlab.style.text_size import capitals_of, set_least, teach_points
from texlab.style.theme import LIGHT, set_text_size
from texlab.widgets.headed import headed
from texlab.widgets.heat_map import HeatMap
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label
from texlab.widgets.plots import Plot
from texlab.widgets.scroll_room import ScrollRoom
from texlab.widgets.short_box import ShortBox
from texlab.widgets.status_line import StatusLine
from texlab.widgets.view_link import ViewLink
from texlab.window.lesson_bar import LessonBar
from texlab.window.teach_mode import readable

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer


@pytest.fixture
def taught(qapp: Any) -> Any:
    """Give text the size that it has in Teach."""
    before = qapp.font().pointSizeF()
    set_least(20.0)
    set_text_size(qapp, 20.0, LIGHT)
    yield
    set_least(0.0)
    set_text_size(qapp, before, LIGHT)


@pytest.mark.parametrize("kind", [HeatMap, CodeGrid])
def test_every_name_and_number_of_a_table_has_room(qtbot: Any, taught: None, kind: type[HeatMap]) -> None:
    table = kind("table", "Table")
    room = ScrollRoom(table, "room")
    qtbot.addWidget(room)
    table.set_theme(LIGHT)
    names, rows = ["0°", "45°", "90°", "135°"], ["1/32", "1/16"]
    texts = [["0.59", "12.55", "0.73", "100"], ["1", "2", "3", "4444.4"]]
    table.show_cells(np.full((2, 4), 0.5), texts, rows, names, SEQUENTIAL_TABLE)
    for size in ((60, 40), (900, 400)):
        room.resize(*size)
        room.show()
        QApplication.processEvents()
        words = sorted(each.words for each in painted(table))
        assert words == sorted([*names, *rows, *texts[0], *texts[1]])
        assert not overlapping(painted(table))


def test_a_tab_scrolls_only_when_words_have_no_room(qtbot: Any, taught: None) -> None:
    inner, picture, words = QWidget(), PicturePane("picture", "Picture"), Label("many words " * 12)
    words.setWordWrap(True)
    column = QVBoxLayout(inner)
    column.addWidget(headed(Label("heading"), picture), 1)
    column.addWidget(words)
    room = ScrollRoom(inner, "room")
    qtbot.addWidget(room)
    room.show()
    for height, scrolls in ((500, False), (120, True)):
        room.resize(500, height)
        QApplication.processEvents()
        assert (inner.height() > room.viewport().height()) == scrolls
        assert words.height() >= lines_of(words)
        assert picture.height() >= picture.minimumSizeHint().height()


@pytest.mark.parametrize(
    ("count", "width", "height", "across"),
    [(10, 1200, 500, 5), (10, 1200, 120, 10), (4, 1200, 320, 4), (4, 600, 600, 2), (1, 500, 500, 1), (3, 0, 0, 3)],
)
def test_pictures_stand_in_the_rows_in_which_they_are_largest(
    count: int, width: int, height: int, across: int
) -> None:
    assert best_columns(count, width, height, 20) == across


def test_lines_under_pictures_say_that_there_is_more(qtbot: Any, taught: None) -> None:
    line = StatusLine()
    qtbot.addWidget(line)
    parts = ["256 x 256", "kept from before", "1.25 s"]
    line.show_parts(parts)
    line.show()
    whole = " · ".join(parts)
    for lines in (1, 2):
        line.set_lines(lines)
        for width in range(40, line.fontMetrics().horizontalAdvance(whole) + 60, 15):
            line.resize(width, line.sizeHint().height())
            said = line.text().replace("\n", " · ")
            assert said == whole or said.endswith("…")
            assert lines_of(line) <= line.height()
        assert said == whole


def test_figures_beside_a_picture_have_all_their_lines(qtbot: Any, taught: None) -> None:
    foot = Foot("line")
    qtbot.addWidget(foot)
    numbers = {"discriminability": 0.5, "visual-difference": 0.5, "laid-down-share": 0.12}
    foot.show_scene(column_of(noise(8, 8), status="finished", measures=numbers))
    foot.figures[2].setText("patches that are copied 0%")
    foot.set_words("line")
    foot.set_words("beside")
    foot.resize(foot.width(), 600)
    foot.show()
    QApplication.processEvents()
    for label in foot.figures:
        assert label.isVisible()
        assert label.height() >= lines_of(label)


def test_how_controls_stand_is_told_when_they_are_folded_away(qtbot: Any) -> None:
    steps, code, lab = StepsDock(), CodeDock(), LabDock()
    for dock in (steps, code, lab):
        qtbot.addWidget(dock)
        before = dock.settings()
        dock.fold_controls(True)
        assert dock.settings() == before
    lab.choose("lab-plane")
    assert lab.settings() == {
        "experiments": "lab-plane",
        "plane-source": "discs",
        "plane-slant": 50,
        "plane-tilt": 30,
    }
    # A stage and a number of the code are the run's and the column's.
    assert steps.settings() == {"speed": 2}
    assert steps.take_settings({"slider": 3, "speed": 4}) == ()
    assert code.settings() == {}
    assert code.take_settings({"value": 3.0}) == ()
    assert code.box.value() == 0


TWO: dict[str, Any] = SMALL | {
    "title": "Two ways of room",
    "steps": [
        {**SMALL["steps"][0], "tab": {"name": "histograms", "settings": {"log": True}}},
        {
            "sentence": "A circle becomes an ellipse: the short axis is the tilt, the ratio the slant's cosine.",
            "tab": {"name": "lab", "settings": {"experiments": "lab-plane", "plane-slant": 20}},
        },
        {"sentence": "Three.", "note": "The third step."},
        {"sentence": "Four.", "note": "The fourth step."},
    ],
}


def test_in_teach_a_step_has_the_room_that_it_needs(qtbot: Any, explorer: Explorer) -> None:
    folder = config_dir() / "lessons"
    folder.mkdir(parents=True)
    (folder / "two.json").write_text(json.dumps(TWO))
    window, workspace, lab = explorer.window, explorer.workspace, explorer.hosts["lab"]
    before = lab.dock.settings()
    give(qtbot, explorer, "two")
    wait_ready(qtbot, explorer)
    window.raise_dock("maps")
    window.actions_by_name["layout-teach"].trigger()
    # The columns that a step compares stand side by side, and its tab comes along.
    qtbot.waitUntil(lambda: window.front_dock() == "histograms")
    assert workspace.shown_ids == tuple(ids(explorer))
    assert len(workspace.shown_ids) == 2
    assert not workspace.exemplar.isHidden()
    # The presenter's words keep their size.
    notes = explorer.teach_mode.notes
    notes.set_open(True)
    QApplication.processEvents()
    assert {label.font().pointSizeF() for label in notes.words.values()} == {notes.next.font().pointSizeF()}
    assert notes.words["note"].isVisible()
    assert notes.next.font().pointSizeF() < window.font().pointSizeF()
    # Without exemplar and columns the tab has all the room, and the sentence has its lines.
    qtbot.keyClick(window, Qt.Key.Key_PageDown)
    wait_idle(qtbot, explorer)
    qtbot.waitUntil(lambda: window.front_dock() == "lab")
    qtbot.waitUntil(lambda: window.docks["lab"].height() > 0.7 * window.height())
    assert not workspace.isVisible()
    assert lab.dock.page.slant.value() == 20
    check_teach_again_gives_a_tab_without_pictures_its_room(qtbot, explorer)
    assert cut(window, painted(window)) == []
    # A step without a tab has its words in front, also when nothing else is left of that tab.
    for text in ("The third step.", "The fourth step."):
        qtbot.keyClick(window, Qt.Key.Key_PageDown)
        qtbot.waitUntil(lambda text=text: explorer.hosts["lessons"].dock.words.note.text() == text)
    for _ in range(3):
        qtbot.keyClick(window, Qt.Key.Key_PageUp)
    wait_idle(qtbot, explorer)
    qtbot.waitUntil(workspace.isVisible)
    qtbot.waitUntil(lambda: window.docks["histograms"].height() < 0.6 * window.height())
    # Whatever a step has set is the user's again.
    explorer.carrier.carry_out(LeaveLesson())
    wait_idle(qtbot, explorer)
    assert len(workspace.shown_ids) == 1
    assert lab.dock.settings() == before
    assert explorer.hosts["histograms"].dock.settings()["log"] is False
    assert not window.actions_by_name["tile"].isChecked()
    window.actions_by_name["layout-explore"].trigger()


@pytest.mark.parametrize(
    ("count", "chosen", "most", "shown"),
    [
        (4, 1, 4, [0, 1, 2, 3]),
        (4, 1, 3, [0, 1, 2]),
        (4, 3, 3, [1, 2, 3]),
        (4, 3, 1, [3]),
        (2, 1, 0, [1]),
        (1, 0, 5, [0]),
        (0, 0, 3, []),
    ],
)
def test_as_many_columns_as_have_room_stand_side_by_side(
    count: int, chosen: int, most: int, shown: list[int]
) -> None:
    assert readable(range(count), chosen, most) == shown


def test_frames_arrows_and_lines_are_as_large_as_the_text(qtbot: Any, qapp: Any) -> None:
    exemplar, box, plot = ExemplarView(ViewLink()), ShortBox(), Plot("plot", "Plot")
    for each in (exemplar, box, plot):
        qtbot.addWidget(each)
    box.addItem("Heeger-Bergen")
    box.resize(400, 120)
    plot.set_theme(LIGHT)
    plot.curve([0.0, 1.0], [0.0, 1.0], "result")

    def sizes() -> tuple[float, ...]:
        (curve,) = plot._series
        frame = exemplar._box
        drawn = box.grab().toImage()
        # What is dark beyond the text.
        dark = [
            x
            for x in range(box.text_room, 398)
            if any(drawn.pixelColor(x, y).lightness() < 90 for y in range(8, 112))
        ]
        handles = {
            (handle.radius, handle.pen.widthF(), round(handle.shape().boundingRect().width()))
            for handle in frame.getHandles()
        }
        (handle,) = handles
        return frame.pen.widthF(), *handle, curve.item.opts["pen"].widthF(), float(len(dark))

    before = qapp.font().pointSizeF()
    usual = sizes()
    try:
        set_least(60.0)
        set_text_size(qapp, 60.0, LIGHT)
        QApplication.processEvents()
        large = sizes()
    finally:
        set_least(0.0)
        set_text_size(qapp, before, LIGHT)
    assert all(after > 2.5 * first > 0 for first, after in zip(usual, large, strict=True)), (usual, large)
    assert sizes() == usual


def test_what_stands_over_a_column_makes_room_for_its_title(qtbot: Any, taught: None) -> None:
    room = QWidget()
    qtbot.addWidget(room)
    view = ColumnView(1, [("heeger-bergen", "Heeger-Bergen")], ViewLink(), room)
    view.show_title("Heeger-Bergen")
    room.show()
    for width, whole in ((700, True), (330, False)):
        view.resize(width, 400)
        QApplication.processEvents()
        assert view.run_button.isVisible() == view.grip.isVisible() == whole
        assert view.menu_button.isVisible()
        assert view.method_box.shown_text == "Heeger-Bergen"
    view.show_title("Heeger-Bergen, iterations 5")
    view.resize(400, 400)
    QApplication.processEvents()
    assert not view.run_button.isVisible()
    assert view.method_box.shown_text == "Heeger-Bergen …"
    assert "iterations 5" in view.method_box.toolTip()


def test_a_first_figure_without_room_shows_its_value(qtbot: Any, taught: None) -> None:
    room = QWidget()
    qtbot.addWidget(room)
    foot = Foot("line", room)
    foot.show_scene(column_of(noise(8, 8), status="finished", measures={"laid-down-share": 0.12}))
    room.show()
    for width, text in ((600, "laid down 12%"), (150, "12%"), (600, "laid down 12%")):
        foot.resize(width, foot.height())
        QApplication.processEvents()
        assert foot.figures[0].text() == text
        assert foot.figures[0].toolTip().startswith("laid down 12%")


def check_teach_again_gives_a_tab_without_pictures_its_room(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    window.actions_by_name["layout-teach"].trigger()
    qtbot.waitUntil(lambda: window.docks["lab"].height() > 0.7 * window.height())
    assert not explorer.workspace.isVisible()


WORDS = "Conditional sampling over an oriented pyramid: each orientation is one more condition."
PICTURES: dict[str, Any] = {key: SMALL["steps"][0][key] for key in ("exemplar", "size", "seed", "columns")}
TALL: dict[str, Any] = SMALL | {
    "title": "Large words",
    "steps": [
        {"sentence": WORDS, "note": "Pictures and words.", **PICTURES},
        {"sentence": WORDS, "tab": {"name": "lab", "settings": {"experiments": "lab-plane"}}},
        {"sentence": WORDS, **PICTURES, "tab": "histograms"},
        {"sentence": "Short.", **PICTURES, "tab": "spectrum"},
        {"sentence": "Short.", **PICTURES},
    ],
}


def test_beside_large_words_a_step_has_room_in_the_window_as_it_is(qtbot: Any, explorer: Explorer) -> None:
    folder = config_dir() / "lessons"
    folder.mkdir(parents=True)
    (folder / "tall.json").write_text(json.dumps(TALL))
    window, workspace = explorer.window, explorer.workspace
    give(qtbot, explorer, "tall")
    wait_ready(qtbot, explorer)
    window.resize(1280, 720)
    window.actions_by_name["layout-teach"].trigger()
    pictures_seen = []
    for turns in (0, 7):
        for _ in range(turns):
            # 200 % and back to the usual size at the end.
            window.actions_by_name["text-larger" if window.layouts.zoom < 2 else "text-usual"].trigger()
            if window.layouts.zoom == 2:
                break
        qtbot.waitUntil(lambda: window.fontMetrics().capHeight() >= window.layouts.zoom * 720 / 40 - 1)
        for place in range(len(TALL["steps"])):
            explorer.carrier.carry_out(GoToStep(place))
            wait_idle(qtbot, explorer)
            qtbot.waitUntil(lambda: (window.width(), window.height()) == (1280, 720))
            for _ in range(4):
                QApplication.processEvents()
            assert (window.width(), window.height()) == (1280, 720), (place, window.layouts.zoom)
            assert cut(window.lesson_bar, painted(window.lesson_bar)) == []
            if workspace.isVisible():
                pictures_seen.append((place, window.layouts.zoom))
                bars = workspace.horizontalScrollBar(), workspace.verticalScrollBar()
                assert [bar.maximum() for bar in bars] == [0, 0], (place, window.layouts.zoom)
    assert window.layouts.zoom == 2
    # At the usual size pictures stand beside every tab but the experiment; at the largest where there is room.
    assert {place for place, zoom in pictures_seen if zoom == 1} == {0, 2, 3, 4}
    assert (4, 2.0) in pictures_seen
    window.actions_by_name["text-usual"].trigger()
    window.actions_by_name["layout-explore"].trigger()
    explorer.carrier.carry_out(LeaveLesson())
    wait_idle(qtbot, explorer)


def test_a_long_sentence_has_lines_of_its_own_beside_large_words(qtbot: Any, taught: None, qapp: Any) -> None:
    window = QMainWindow()
    qtbot.addWidget(window)
    bar = LessonBar({name: QAction(name, window) for name in ("lesson-back", "lesson-next", "lesson-leave")})
    window.setCentralWidget(bar)
    window.resize(1280, 720)
    bar.show()
    window.show()
    large = teach_points(720, 2.0, capitals_of(qapp.font()))
    for points, words, alone in ((20.0, "Short.", False), (large, "Short.", False), (large, WORDS, True)):
        set_least(points)
        set_text_size(qapp, points, LIGHT)
        bar.count.setText("3 of 12")
        bar.readiness.setText("7 of 12 ready")
        bar.sentence.setText(words)
        QApplication.processEvents()
        assert (bar.sentence.y() >= bar.count.geometry().bottom()) == alone
        assert bar.sentence.height() >= lines_of(bar.sentence)
        assert bar.minimumSizeHint().height() <= 0.3 * window.height()
