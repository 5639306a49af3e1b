"""The pop-out test in the window: real clicks and keys, times by the clock, answers kept, nothing given away."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mouse import on_screen
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QPushButton

from texlab.state.chosen import Sample
from texlab.widgets.hidden_picture import HiddenPicture
from texlab.window.popout_dialog import PAUSE_MS, PopoutDialog
from texlab.window.popout_review import cells_of, line_of
from texlab_core.engine.registry import methods
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.popout.design import Design, settings_of
from texlab_core.popout.making import Made
from texlab_core.popout.record import Record, read_record
from texlab_core.popout.scoring import Answer

if TYPE_CHECKING:
    from pathlib import Path


class Clock:
    """Time that a test sets."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def stage(qtbot: Any, clock: Clock) -> Any:
    widget = HiddenPicture(clock=clock)
    widget.resize(430, 330)
    qtbot.addWidget(widget)
    widget.show()
    on_screen(qtbot, widget)
    widget.setFocus()
    return widget


def picture(height: int = 100, width: int = 120) -> np.ndarray:
    return np.random.default_rng(1).integers(0, 256, (height, width, 3), np.uint8)


def painted(qtbot: Any, stage: HiddenPicture) -> None:
    qtbot.waitUntil(lambda: stage._painted_at is not None)


def place_of(stage: HiddenPicture, row: int, column: int) -> QPoint:
    area, (height, width) = stage.area(), stage._picture.shape[:2]  # type: ignore[union-attr]
    return QPoint(
        int(area.left() + (column + 0.5) * area.width() / width),
        int(area.top() + (row + 0.5) * area.height() / height),
    )


def test_a_click_says_the_pixel_and_the_time_since_it_was_painted(qtbot: Any, stage: Any, clock: Clock) -> None:
    for row, column in ((0, 0), (99, 119), (41, 7)):
        clock.now += 50
        stage.show_picture(picture())
        painted(qtbot, stage)
        # 430 x 330 pixels hold it three times as large, in the middle.
        assert (stage.area().width(), stage.area().height()) == (360, 300)
        clock.now += 1.25
        with qtbot.waitSignal(stage.pointed) as answer:
            qtbot.mouseClick(stage, Qt.MouseButton.LeftButton, pos=place_of(stage, row, column))
        assert answer.args == [row, column, 1.25]
        assert stage._picture is None


def test_what_is_not_seen_yet_and_what_is_beside_it_cannot_be_clicked(qtbot: Any, stage: Any) -> None:
    answers: list[Any] = []
    stage.pointed.connect(lambda *values: answers.append(values))
    stage.gave_up.connect(answers.append)
    stage.show_picture(picture())
    # No event was handled since: it is not painted.
    middle = QPointF(stage.area().center())
    press = QMouseEvent(
        QEvent.Type.MouseButtonPress,
        middle,
        middle,
        Qt.MouseButton.LeftButton,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
    )
    QApplication.sendEvent(stage, press)
    stage.give_up()
    assert answers == []
    painted(qtbot, stage)
    for beside in (QPoint(2, 2), QPoint(34, 100), QPoint(200, 316)):
        qtbot.mouseClick(stage, Qt.MouseButton.LeftButton, pos=beside)
    qtbot.mouseClick(stage, Qt.MouseButton.RightButton, pos=QPoint(200, 150))
    qtbot.keyClick(stage, Qt.Key.Key_Return)
    assert answers == []
    qtbot.mouseClick(stage, Qt.MouseButton.LeftButton, pos=QPoint(200, 150))
    # One answer to a picture.
    qtbot.mouseClick(stage, Qt.MouseButton.LeftButton, pos=QPoint(200, 150))
    assert len(answers) == 1


def test_keys_move_a_cross_from_the_middle_and_answer(qtbot: Any, stage: Any, clock: Clock) -> None:
    stage.show_picture(picture())
    painted(qtbot, stage)
    for key in (Qt.Key.Key_Up, Qt.Key.Key_Left, Qt.Key.Key_Left):
        qtbot.keyClick(stage, key)
    qtbot.keyClick(stage, Qt.Key.Key_Down, Qt.KeyboardModifier.ShiftModifier)
    clock.now += 3
    with qtbot.waitSignal(stage.pointed) as answer:
        qtbot.keyClick(stage, Qt.Key.Key_Return)
    assert answer.args == [50 - 5 + 1, 60 - 10, 3.0]
    stage.show_picture(picture())
    painted(qtbot, stage)
    for _ in range(30):
        qtbot.keyClick(stage, Qt.Key.Key_Down)
        qtbot.keyClick(stage, Qt.Key.Key_Right)
    with qtbot.waitSignal(stage.pointed) as answer:
        qtbot.keyClick(stage, Qt.Key.Key_Enter)
    assert answer.args[:2] == [99, 119]
    stage.show_picture(picture())
    painted(qtbot, stage)
    clock.now += 2
    with qtbot.waitSignal(stage.gave_up) as given:
        qtbot.keyClick(stage, Qt.Key.Key_Space)
    assert given.args == [2.0]


def test_the_picture_is_painted_as_it_is_and_nothing_else(qtbot: Any, stage: Any) -> None:
    pixels = picture()
    stage.show_picture(pixels)
    painted(qtbot, stage)
    shown = stage.grab().toImage()
    area = stage.area().toRect()
    for row, column in ((0, 0), (0, 119), (99, 0), (57, 33)):
        colour = shown.pixelColor(place_of(stage, row, column))
        assert (colour.red(), colour.green(), colour.blue()) == tuple(pixels[row, column])
    around = {
        shown.pixelColor(place).name()
        for place in (QPoint(0, 0), area.topLeft() - QPoint(1, 1), area.bottomRight() + QPoint(1, 1))
    }
    assert around == {"#808080"}
    # The pointer is the same everywhere, and no child can lie over it.
    assert stage.cursor().shape() == Qt.CursorShape.CrossCursor
    assert stage.children() == []
    assert not stage.hasMouseTracking()


@pytest.mark.parametrize(("ratio", "enlarged"), [(1.0, 3.0), (1.5, 4 / 1.5), (2.0, 3.0), (1.25, 4 / 1.25)])
def test_every_pixel_is_equally_wide_on_any_screen(
    stage: Any, monkeypatch: pytest.MonkeyPatch, ratio: float, enlarged: float
) -> None:
    monkeypatch.setattr(type(stage), "devicePixelRatioF", lambda _: ratio)
    stage.show_picture(picture())
    assert stage.area().width() == pytest.approx(120 * enlarged)
    # What is larger than the field is reduced to fit.
    stage.show_picture(picture(1000, 1200))
    assert stage.area().height() == pytest.approx(min(330, 1000 * 430 / 1200))


# The dialog, fed with plain data.


def made_of(count: int = 3) -> Made:
    pixels = np.random.default_rng(2).random((48, 48, 3), np.float32)
    design = Design(
        exemplar=as_exemplar(pixels),
        settings=settings_of(["tiling"]),
        repeats=count,
        size=(100, 120),
        share=0.5,
        seed=3,
    )
    record = Record.of(design)
    return Made(record.with_machine([Answer(1, 4, 5)]), tuple(picture() for _ in range(count)))


@pytest.fixture
def dialog(qtbot: Any) -> Any:
    widget = PopoutDialog()
    widget.resize(700, 560)
    qtbot.addWidget(widget)
    widget.show()
    on_screen(qtbot, widget)
    return widget


def answer_next(qtbot: Any, dialog: PopoutDialog, row: int, column: int) -> None:
    painted(qtbot, dialog.stage)
    qtbot.mouseClick(dialog.stage, Qt.MouseButton.LeftButton, pos=place_of(dialog.stage, row, column))


def test_pictures_come_one_after_the_other_with_the_same_pause(qtbot: Any, dialog: Any) -> None:
    made = made_of()
    answers: list[Answer] = []
    dialog.answered.connect(answers.append)
    dialog.show_test(made)
    assert dialog.how.text().startswith("3 pictures.")
    qtbot.mouseClick(dialog.begin_button, Qt.MouseButton.LeftButton)
    shown = []
    for trial in made.record.trials:
        # Between pictures the field is empty, and nothing can be answered.
        assert dialog.stage._picture is None
        assert not dialog.untold_button.isEnabled()
        assert dialog.count.text() == f"{trial.number} of 3"
        assert dialog._pause.interval() == PAUSE_MS
        painted(qtbot, dialog.stage)
        shown.append(dialog.stage._picture)
        if trial.number < 3:
            answer_next(qtbot, dialog, trial.top, trial.left)
        else:
            with qtbot.waitSignal(dialog.over):
                qtbot.mouseClick(dialog.untold_button, Qt.MouseButton.LeftButton)
    assert all(one is other for one, other in zip(shown, made.pictures, strict=True))
    assert [(each.trial, each.row) for each in answers] == [
        (1, made.record.trials[0].top),
        (2, made.record.trials[1].top),
        (3, None),
    ]
    assert all(each.seconds is not None and each.seconds >= 0 for each in answers)
    record = made.record
    for each in answers:
        record = record.answered(each)
    dialog.show_scores(record)
    row = [dialog.review.table.item(0, column).text() for column in range(dialog.review.table.columnCount())]
    assert row == list(cells_of(record.scores()[0]))
    assert row[1] == "2 of 3"
    listed = [dialog.review.list.item(place).text() for place in range(3)]
    assert listed == ["1. Tiling: found", "2. Tiling: found", "3. Tiling: could not tell"]
    dialog.review.list.setCurrentRow(1)
    trial = record.trials[1]
    piece = dialog.review.picture.piece
    assert (piece.top(), piece.left(), piece.height()) == (trial.top, trial.left, 24)
    assert dialog.review.picture.picture is made.pictures[1]
    assert dialog.review.list.hasFocus()
    # Hundreds of pictures do not stay for the whole session.
    dialog.show_setup()
    assert dialog.review.picture.picture is None
    assert dialog.review.list.count() == 0
    assert dialog._made is None


def test_esc_leaves_and_what_was_answered_stays(qtbot: Any, dialog: Any) -> None:
    made = made_of()
    dialog.show_test(made)
    qtbot.mouseClick(dialog.begin_button, Qt.MouseButton.LeftButton)
    painted(qtbot, dialog.stage)
    with qtbot.waitSignal(dialog.over):
        qtbot.keyClick(dialog.stage, Qt.Key.Key_Escape)
    assert dialog.isVisible()
    assert dialog.stage._picture is None
    assert not dialog._pause.isActive()
    assert line_of(made.record, 2) == "2. Tiling: not answered"


def test_what_is_closed_is_stopped(qtbot: Any, dialog: Any) -> None:
    dialog.show_making()
    with qtbot.waitSignal(dialog.stopped):
        dialog.close()
    dialog.show()
    dialog.show_test(made_of())
    qtbot.mouseClick(dialog.begin_button, Qt.MouseButton.LeftButton)
    painted(qtbot, dialog.stage)
    with qtbot.waitSignal(dialog.over):
        dialog.close()
    assert not dialog.isVisible()


@pytest.mark.parametrize("page", ["fields", "making", "ready", "trial", "outcome"])
def test_it_closes_from_every_page(qtbot: Any, dialog: Any, page: str) -> None:
    made = made_of()

    def turn() -> None:
        dialog.show()
        dialog.show_test(made)
        dialog.pages.setCurrentWidget(getattr(dialog, page))

    turn()
    dialog.close()
    assert not dialog.isVisible()
    closing = {"fields": "popout-close", "outcome": "popout-result-close"}.get(page)
    if closing is not None:
        turn()
        qtbot.mouseClick(dialog.findChild(QPushButton, closing), Qt.MouseButton.LeftButton)
        assert not dialog.isVisible()
        turn()
        qtbot.keyClick(dialog, Qt.Key.Key_Escape)
        assert not dialog.isVisible()


# In the running program.


def test_a_test_of_columns_is_made_given_scored_and_kept(
    explorer: Any, qtbot: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, desk = explorer.session, explorer.handlers.popouts
    session.set_columns([(name, methods()[name].params()) for name in ("tiling", "pixels")], "two")
    explorer.window.actions_by_name["popout"].trigger()
    dialog = desk.dialog
    assert [dialog.setup.columns.item(row).text() for row in range(2)] == ["1. Tiling", "2. Independent pixels"]
    for row in range(2):
        dialog.setup.columns.item(row).setCheckState(Qt.CheckState.Unchecked)
    assert dialog.setup.foreseen.text() == "Choose at least one method."
    assert not dialog.setup.start_button.isEnabled()
    for row in range(2):
        dialog.setup.columns.item(row).setCheckState(Qt.CheckState.Checked)
    dialog.setup.repeats.setValue(1)
    dialog.setup.seed.setValue(11)
    assert dialog.setup.foreseen.text().startswith("2 pictures of 256 x 256 pixels with a piece of 24 x 20")
    qtbot.mouseClick(dialog.setup.start_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.pages.currentWidget() is dialog.ready)
    qtbot.mouseClick(dialog.begin_button, Qt.MouseButton.LeftButton)
    trials = desk.record.trials
    answer_next(qtbot, dialog, trials[0].top, trials[0].left)
    qtbot.waitUntil(lambda: not desk.busy)
    (path,) = desk.store.folder.glob("*.json")
    assert [each.trial for each in read_record(path).answers] == [1]
    # The next answer cannot be kept; nothing is lost, and it is said at the end.
    monkeypatch.setattr(
        type(desk.store), "save", lambda *_: (_ for _ in ()).throw(InputError("The disk is full."))
    )
    painted(qtbot, dialog.stage)
    qtbot.keyClick(dialog.stage, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: not desk.busy)
    assert dialog.pages.currentWidget() is dialog.outcome
    assert "The disk is full." in dialog.message.text()
    scores = {each.name: each for each in desk.record.scores()}
    assert sum(each.hits for each in scores.values()) == 1
    assert sum(each.untold for each in scores.values()) == 1
    out = tmp_path / "table.csv"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(out), ""))
    qtbot.mouseClick(dialog.table_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.message.text().startswith("Written"))
    with out.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["hit"] for row in rows] == ["1", "0"]
    assert {row["method"] for row in rows} == {"Tiling", "Independent pixels"}
    qtbot.mouseClick(dialog.again_button, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(dialog.setup.all_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.setup.foreseen.text().startswith("Written"))
    with out.open(newline="") as stream:
        assert [row["test"] for row in csv.DictReader(stream)] == [path.stem] * 2


def test_an_exemplar_that_comes_while_the_fields_are_shown_is_said(explorer: Any, qtbot: Any) -> None:
    explorer.window.actions_by_name["popout"].trigger()
    setup = explorer.handlers.popouts.dialog.setup
    assert "with a piece of 24 x 20" in setup.foreseen.text()
    other = as_exemplar(np.random.default_rng(5).random((40, 60, 1), np.float32), name="other")
    explorer.session.set_sample(Sample(other))
    qtbot.waitUntil(lambda: "with a piece of 30 x 20" in setup.foreseen.text())
    assert setup.start_button.isEnabled()


def test_making_can_be_stopped_and_methods_that_fail_are_said(
    explorer: Any, qtbot: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk = explorer.handlers.popouts
    desk.open()
    dialog = desk.dialog
    # Two Heeger-Bergen columns get names that can be told apart.
    assert [each.name for each in desk.design(dialog.setup.request()).settings] == [
        "Heeger-Bergen",
        "Heeger-Bergen 2",
    ]
    dialog.setup.repeats.setValue(50)
    qtbot.mouseClick(dialog.setup.start_button, Qt.MouseButton.LeftButton)
    assert dialog.pages.currentWidget() is dialog.making
    qtbot.mouseClick(dialog.stop_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.setup.foreseen.text() == "Stopped.")
    assert desk.record is None
    assert not desk.store.folder.exists()

    def fails(*_: Any, **__: Any) -> None:
        raise InputError("It cannot work.")

    monkeypatch.setattr("texlab_core.popout.making.picture_of", fails)
    qtbot.mouseClick(dialog.setup.start_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.setup.foreseen.text() == "It cannot work.")
    figures = desk.design(dialog.setup.request(figures=True))
    assert [each.name[:6] for each in figures.settings] == ["Fig. 2", "Fig. 3", "Fig. 4", "Fig. 5"]


def test_the_last_answer_is_kept_when_the_window_closes(explorer: Any, qtbot: Any) -> None:
    desk = explorer.handlers.popouts
    desk.open()
    desk._give(made_of())
    desk._keep(Answer(1, 3, 4, 1.0))
    desk._keep(Answer(2, 5, 6, 1.0))
    desk.close()
    (path,) = desk.store.folder.glob("*.json")
    assert [each.trial for each in read_record(path).answers] == [1, 2]
