"""Manners of the window: nothing is lost, nothing waits, nothing is cut off."""

from __future__ import annotations

import json
import os
import signal
import threading
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QGuiApplication, QHelpEvent, QImage
from PySide6.QtWidgets import QApplication, QFileDialog, QTabBar, QToolTip

from tests.gui.conftest import drag, hb, ids, result_image, wait_idle
from texlab.app.start import closed_by_signals
from texlab.runs.worker import Worker
from texlab.state import session as session_module
from texlab.state.chosen import Sample
from texlab.state.session import Session
from texlab.storage.kept_exemplar import Kept, keep, load
from texlab.storage.settings import Settings
from texlab.widgets.status_line import StatusLine
from texlab.window.palette import CommandPalette
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer

NO_KEYS = Qt.KeyboardModifier.NoModifier
CONTROL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
LEFT = Qt.MouseButton.LeftButton


def settings_file(home: Path) -> Path:
    return home / "config" / "settings.json"


# The crop.


def test_a_quickly_dragged_crop_ends_at_full_size(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_window(str(texture), [hb(iterations=8), hb(iterations=9)], size=200)
    qtbot.mouseClick(explorer.workspace.exemplar.crop_button, LEFT)
    wait_idle(qtbot, explorer)
    pane = explorer.workspace.exemplar.pane
    crop = explorer.session.state.sample.crop
    centre = pane.to_widget(crop.top + 10, crop.left + 12).toPoint()
    away = pane.to_widget(crop.top + 4, crop.left + 6).toPoint()
    # Faster than anything can be prepared or drawn.
    drag(qtbot, pane.viewport(), [centre + (away - centre) * k / 9 for k in range(10)])
    wait_idle(qtbot, explorer)
    assert explorer.session.state.sample.crop != crop
    for column_id in ids(explorer):
        assert explorer.controller.column_scene(column_id).draft is False
        assert result_image(explorer, column_id).shape == (200, 200, 3)


def test_drafts_are_seen_while_the_crop_is_dragged(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_window(str(texture), [hb(iterations=8)], size=200)
    qtbot.mouseClick(explorer.workspace.exemplar.crop_button, LEFT)
    wait_idle(qtbot, explorer)
    (column,) = ids(explorer)
    crop = explorer.session.state.sample.crop
    moved = type(crop)(crop.top + 1, crop.left, crop.height, crop.width)
    explorer.controller.editing.crop(moved, False)
    qtbot.waitUntil(lambda: explorer.controller.column_scene(column).draft, timeout=20_000)
    explorer.controller.editing.crop(moved, True)
    wait_idle(qtbot, explorer)
    assert explorer.controller.column_scene(column).draft is False
    assert explorer.session.undo_text == "crop or scale"


def test_arrow_keys_move_and_resize_the_crop_in_one_step(qtbot: Any, explorer: Explorer) -> None:
    qtbot.mouseClick(explorer.workspace.exemplar.crop_button, LEFT)
    wait_idle(qtbot, explorer)
    before = explorer.session.state.sample.crop
    pane = explorer.workspace.exemplar.pane
    pane.setFocus()
    for key, held in ((Qt.Key.Key_Down, NO_KEYS), (Qt.Key.Key_Right, CONTROL), (Qt.Key.Key_Up, SHIFT)):
        qtbot.keyClick(pane, key, held)
    crop = explorer.session.state.sample.crop
    assert (crop.top, crop.left) == (before.top + 1, before.left + 8)
    assert (crop.height, crop.width) == (before.height - 1, before.width)
    for _ in range(20):
        qtbot.keyClick(pane, Qt.Key.Key_Right, CONTROL)
    crop = explorer.session.state.sample.crop
    assert crop.left + crop.width == 48
    wait_idle(qtbot, explorer)
    qtbot.waitUntil(lambda: not explorer.workspace.exemplar._rest.isActive(), timeout=5_000)
    wait_idle(qtbot, explorer)
    assert explorer.controller.column_scene(ids(explorer)[0]).draft is False
    explorer.session.undo()
    assert explorer.session.state.sample.crop == before
    wait_idle(qtbot, explorer)


def test_a_scale_too_small_says_so_and_runs_nothing_on_the_exemplar_before(qtbot: Any, explorer: Explorer) -> None:
    explorer.controller.editing.scale(0.01)
    qtbot.waitUntil(lambda: not explorer.controller.busy, timeout=10_000)
    assert "at least 2 x 2 pixels" in explorer.window.message_bar.label.text()
    assert explorer.controller.exemplar is None
    explorer.controller.run_all()
    assert not explorer.controller.busy
    explorer.session.undo()
    wait_idle(qtbot, explorer)
    assert result_image(explorer, ids(explorer)[0]).shape == (48, 48, 3)


# What is seen.


def test_lines_under_pictures_are_never_cut(qtbot: Any) -> None:
    line = StatusLine()
    qtbot.addWidget(line)
    parts = ["256 x 256", "1.25 s", "W1 bands 0.123", "spectrum 12.3 dB", "power moved 45%", "largest pole 0.999"]
    line.show_parts(parts)
    line.show()
    shown = []
    for width in (90, 130, 200, 300, 900):
        line.resize(width, line.sizeHint().height())
        room = line.fontMetrics().boundingRect(0, 0, width, 9999, Qt.TextFlag.TextWordWrap.value, line.text())
        assert room.height() <= line.height()
        assert line.text().startswith("256 x 256")
        shown.append(sum(part in line.text() for part in parts))
    assert shown == sorted(shown)
    assert shown[-1] == len(parts)
    assert line.toolTip().replace("\n", " ") == " · ".join(parts)
    line.resize(140, line.height())
    line.show_parts(
        ["window: must be at most 7 inside an exemplar of 9 x 7 pixels, got 15 in this very long sentence."]
    )
    assert line.text().startswith("window: must be")
    assert line.text().endswith("…")


def test_the_help_of_a_dock_does_not_cover_its_plots(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    frame = window.docks["histograms"]
    frame.raise_()
    wait_idle(qtbot, explorer)
    body = explorer.hosts["histograms"].dock.body
    try:
        for widget, shown in ((frame, True), (body, False)):
            centre = widget.rect().center() if widget is body else QPoint(20, 8)
            QApplication.sendEvent(widget, QHelpEvent(QEvent.Type.ToolTip, centre, widget.mapToGlobal(centre)))
            wanted = frame.toolTip() if shown else ""
            qtbot.waitUntil(lambda wanted=wanted: QToolTip.text() == wanted)
    finally:
        QToolTip.hideText()
    assert frame.toggleViewAction().toolTip() == frame.toolTip()


def test_a_layout_brings_docks_home(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    docks = window.docks
    docks["histograms"].setFloating(True)
    docks["gallery"].setFloating(True)
    window.addDockWidget(Qt.DockWidgetArea.TopDockWidgetArea, docks["maps"])
    window.splitDockWidget(docks["pyramid"], docks["steps"], Qt.Orientation.Horizontal)
    window.actions_by_name["layout-explore"].trigger()
    tabs = [dock for name, dock in docks.items() if name not in ("gallery", "parameters")]
    assert set(window.tabifiedDockWidgets(docks["pyramid"])) == set(tabs) - {docks["pyramid"]}
    assert window.dockWidgetArea(docks["gallery"]) == Qt.DockWidgetArea.LeftDockWidgetArea
    assert not any(dock.isFloating() for dock in docks.values())
    wait_idle(qtbot, explorer)


def test_all_pictures_stand_at_the_same_level(explorer: Explorer) -> None:
    panes = [explorer.workspace.exemplar.pane] + [view.pane for view in explorer.workspace.columns.values()]
    places = {(pane.mapTo(explorer.window, QPoint(0, 0)).y(), pane.height()) for pane in panes}
    assert len(places) == 1


def test_a_failure_is_said_where_the_picture_would_be(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, stub: Any
) -> None:
    explorer = open_window(str(texture), [("stub", stub.params(level=3.0))])
    (column,) = ids(explorer)
    note = explorer.workspace.columns[column].pane._note
    assert note.isVisible()
    assert note.text() == "level: 3 is what this stub fails at."
    explorer.session.set_params(column, stub.params(level=0.2), "level")
    wait_idle(qtbot, explorer)
    assert not note.isVisible()


def test_names_of_docks_are_whole(explorer: Explorer) -> None:
    tabs = [bar for bar in explorer.window.findChildren(QTabBar) if bar.parent() is explorer.window]
    assert tabs
    assert all(bar.elideMode() == Qt.TextElideMode.ElideNone for bar in tabs)


def test_a_new_column_shows_the_place_and_scale_of_the_others(qtbot: Any, explorer: Explorer) -> None:
    qtbot.keyClick(explorer.window, Qt.Key.Key_Plus)
    qtbot.keyClick(explorer.window, Qt.Key.Key_Plus)
    qtbot.keyClick(explorer.window, Qt.Key.Key_D, CONTROL)
    wait_idle(qtbot, explorer)
    one, new = (explorer.workspace.columns[each].pane for each in ids(explorer)[:2])
    scale = one.shown_scale
    before = one.width()
    explorer.window.resize(1500, 900)
    qtbot.waitUntil(lambda: one.width() != before)
    qtbot.waitUntil(lambda: new.view_rect().center() == one.view_rect().center())
    for pane in (one, new):
        assert pane.shown_scale == pytest.approx(scale)
    qtbot.keyClick(explorer.window, Qt.Key.Key_1)
    assert one.shown_scale == pytest.approx(1 / one.devicePixelRatioF())
    qtbot.keyClick(explorer.window, Qt.Key.Key_F)
    assert new.view_rect().contains(QPointF(1, 1))


def test_a_new_column_comes_into_sight(qtbot: Any, explorer: Explorer) -> None:
    explorer.window.resize(900, 600)
    for _ in range(4):
        qtbot.keyClick(explorer.window, Qt.Key.Key_D, CONTROL)
    wait_idle(qtbot, explorer)
    explorer.window.actions_by_name["previous"].trigger()
    explorer.handlers.select(explorer.session.add_column(*hb()))
    new = ids(explorer)[-1]

    def whole() -> bool:
        view = explorer.workspace.columns.get(new)
        port = explorer.workspace.viewport()
        return view is not None and port.rect().contains(view.mapTo(port, view.rect().center()))

    qtbot.waitUntil(whole, timeout=5_000)
    view, port = explorer.workspace.columns[new], explorer.workspace.viewport()
    seen = view.visibleRegion().boundingRect().height()
    assert seen >= 0.9 * min(view.height(), port.height())
    assert explorer.workspace.verticalScrollBar().maximum() > 0
    wait_idle(qtbot, explorer)


def test_keys_are_commands_from_the_start(qtbot: Any, explorer: Explorer) -> None:
    explorer.window.activateWindow()
    focus = explorer.window.focusWidget()
    assert focus is not explorer.window.gallery.search
    qtbot.keyClick(focus or explorer.window, Qt.Key.Key_T)
    assert explorer.window.actions_by_name["tile"].isChecked()


def test_what_was_said_about_another_exemplar_goes(qtbot: Any, explorer: Explorer, tmp_path: Path) -> None:
    bad = tmp_path / "bad.png"
    bad.write_text("hello")
    bar = explorer.window.message_bar
    explorer.opener.open(str(bad))
    qtbot.waitUntil(bar.isVisible, timeout=10_000)
    explorer.themes.choose("dark")
    assert bar.isVisible()
    explorer.opener.open("gallery:oriented-zebra")
    qtbot.waitUntil(lambda: not bar.isVisible(), timeout=10_000)
    wait_idle(qtbot, explorer)


# The history.


def test_turns_of_a_box_without_a_pause_are_one_step(qtbot: Any, explorer: Explorer) -> None:
    box = explorer.window.toolbar.seed_box
    box.setFocus()
    for _ in range(5):
        qtbot.keyClick(box, Qt.Key.Key_Up)
    assert explorer.session.state.seed == 10
    for _ in range(2):
        explorer.window.actions_by_name["dice"].trigger()
    explorer.window.toolbar.width_box.stepUp()
    explorer.window.toolbar.height_box.stepUp()
    assert explorer.session.state.size == (80, 80)
    explorer.session.undo()
    assert explorer.session.state.size == (48, 48)
    explorer.session.undo()
    explorer.session.undo()
    assert explorer.session.state.seed == 10
    explorer.session.undo()
    assert explorer.session.state.seed == 5
    assert explorer.session.undo_text is None
    explorer.controller.stop_all()
    wait_idle(qtbot, explorer)


def test_the_history_forgets_before_it_fills_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    sources = [as_exemplar(np.full((10, 10, 3), k / 10, np.float32), name=str(k)) for k in range(6)]
    monkeypatch.setattr(session_module, "MAX_HISTORY_BYTES", 3 * sources[0].pixels.nbytes)
    session = Session()
    for source in sources:
        session.set_sample(Sample(source))
        session.set_sample(Sample(source, 0.5))
    steps = 0
    while session.undo_text is not None:
        session.undo()
        steps += 1
    assert steps == 5
    assert session.state.sample is not None
    assert session.state.sample.source is sources[3]


# What is kept.


def test_changes_are_on_disk_before_the_window_closes(
    qtbot: Any, explorer: Explorer, texture: Path, texlab_home: Path
) -> None:
    explorer.session.set_seed(123)

    path = texlab_home / "config" / "sessions" / "1.json"
    qtbot.waitUntil(lambda: path.exists() and json.loads(path.read_text())["seed"] == 123, timeout=10_000)
    assert json.loads(path.read_text())["sample"]["path"] == str(texture)
    wait_idle(qtbot, explorer)


def test_a_pasted_exemplar_comes_back(
    qtbot: Any, explorer: Explorer, open_window: Callable[..., Explorer]
) -> None:
    picture = QImage(20, 24, QImage.Format.Format_RGB888)
    picture.fill(Qt.GlobalColor.darkGreen)
    picture.setPixelColor(3, 4, Qt.GlobalColor.red)
    QGuiApplication.clipboard().setImage(picture)
    qtbot.keyClick(explorer.window, Qt.Key.Key_V, CONTROL)
    qtbot.waitUntil(lambda: explorer.session.state.sample.source.size == (24, 20), timeout=10_000)
    wait_idle(qtbot, explorer)
    pixels = explorer.session.state.sample.source.pixels
    explorer.window.close()
    again = open_window(None)
    assert np.array_equal(again.session.state.sample.source.pixels, pixels)
    assert again.session.undo_text is None


def test_kept_pixels_are_the_same(tmp_path: Path) -> None:
    fine = np.random.default_rng(2).random((9, 7, 3)).astype(np.float32)
    coarse = np.arange(60, dtype=np.uint8).reshape(6, 10)
    for source in (as_exemplar(fine, name="fine"), as_exemplar(coarse, name="coarse")):
        back = load(Kept(keep(source, tmp_path / "deeper"), "x"))
        assert back.name == "x"
        assert np.array_equal(back.pixels, source.pixels)


def test_an_exemplar_that_is_gone_is_said_and_replaced(
    qtbot: Any, explorer: Explorer, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer.window.close()
    texture.unlink()
    again = open_window(None)
    assert "waves.png: there is no such file" in again.window.message_bar.label.text()
    assert again.session.state.sample.source.name == "gallery:structured-pebbles"


@pytest.mark.parametrize("crop", [[0, 0, 40, 48], [-4, 0, 8, 8], [30, 30, 30, 30], [0, 0, 1, 1], [1.5, 0, 8, 8]])
def test_a_crop_that_no_longer_fits_is_left_out(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, texlab_home: Path, crop: list[Any]
) -> None:
    settings_file(texlab_home).parent.mkdir(parents=True)
    sample = {"name": "waves.png", "path": str(texture), "scale": 1.0, "crop": crop}
    columns = [{"method": name, "params": params.to_json()} for name, params in [hb()]]
    saved = {"session": {"sample": sample, "columns": columns, "seed": 3, "size": [32, 32], "selected": 0}}
    settings_file(texlab_home).write_text(json.dumps(saved))
    explorer = open_window(None)
    kept = explorer.session.state.sample.crop
    assert (kept is not None) == (crop == [0, 0, 40, 48])
    assert result_image(explorer, ids(explorer)[0]).shape == (32, 32, 3)


def test_damaged_settings_are_put_aside_and_said(
    open_window: Callable[..., Explorer], texture: Path, texlab_home: Path
) -> None:
    settings_file(texlab_home).parent.mkdir(parents=True)
    settings_file(texlab_home).write_text('{"recent": [')
    explorer = open_window(str(texture), [hb()])
    assert "settings are damaged" in explorer.window.message_bar.label.text()
    assert (texlab_home / "config" / "settings.broken.json").read_text() == '{"recent": ['


def test_settings_that_cannot_be_written_do_not_keep_the_window_open(
    explorer: Explorer, texlab_home: Path, caplog: pytest.LogCaptureFixture
) -> None:
    explorer.settings._path = texlab_home / "log" / "texlab.log" / "settings.json"
    (texlab_home / "log").mkdir(parents=True, exist_ok=True)
    (texlab_home / "log" / "texlab.log").write_text("a file, not a folder")
    explorer.window.close()
    assert not explorer.window.isVisible()
    assert "could not be saved" in caplog.text


def test_settings_survive_writing_and_reading(texlab_home: Path) -> None:
    settings = Settings()
    settings.add_recent("/a/b.png")
    settings.save()
    assert Settings().recent == ["/a/b.png"]
    assert Settings().problem == ""


def test_a_saved_file_gets_its_suffix(
    qtbot: Any, explorer: Explorer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answer = (str(tmp_path / "out"), "TIFF, 8 bits (*.tif)")
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: answer)
    explorer.exchange.export(ids(explorer)[0])
    qtbot.waitUntil((tmp_path / "out.tif").exists, timeout=10_000)
    wait_idle(qtbot, explorer)
    assert explorer.settings.text("save-folder") == str(tmp_path)
    explorer.exchange.export(ids(explorer)[0])
    assert "already there" in explorer.window.message_bar.label.text()


# What must not wait.


def test_a_worker_can_be_left_without_waiting(qtbot: Any) -> None:
    started, let_go = threading.Event(), threading.Event()

    def work(task: Any) -> None:
        started.set()
        assert let_go.wait(60)

    worker = Worker("stubborn")
    worker.submit(work)
    assert started.wait(60)
    worker.leave()
    assert not worker.ended
    let_go.set()
    worker.close()
    assert worker.ended


def test_a_running_column_goes_at_once_and_its_thread_later(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_window(str(texture), [hb(iterations=50), hb()], wait=False, size=400)
    first, second = ids(explorer)
    scene = explorer.controller.column_scene
    qtbot.waitUntil(lambda: scene(first) is not None and scene(first).status == "running", timeout=30_000)
    explorer.session.remove_column(first)
    assert scene(first) is None
    qtbot.waitUntil(lambda: all(each.ended for each in explorer.controller._leaving), timeout=10_000)
    wait_idle(qtbot, explorer)
    assert scene(second).status == "finished"


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_close_the_window_properly(qtbot: Any, explorer: Explorer, number: signal.Signals) -> None:
    with closed_by_signals(explorer.window):
        os.kill(os.getpid(), number)
        qtbot.waitUntil(lambda: not explorer.window.isVisible(), timeout=10_000)
    assert explorer._closed


def test_closing_while_columns_run_ends_their_threads(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_window(str(texture), [hb(iterations=50), hb(iterations=49)], wait=False, size=400)
    first, _ = ids(explorer)
    scene = explorer.controller.column_scene
    qtbot.waitUntil(lambda: scene(first) is not None and scene(first).status == "running", timeout=30_000)
    explorer.window.close()
    QApplication.processEvents()
    assert not [each for each in threading.enumerate() if each.name.startswith("texlab-")]


def test_the_palette_goes_to_panels_and_says_when_there_is_no_such_command(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    host = explorer.hosts["histograms"]
    assert not host.seen
    for typed in ("zzz", "panel histogr"):
        qtbot.keyClick(window, Qt.Key.Key_K, CONTROL)
        palette = next(each for each in window.findChildren(CommandPalette) if each.isVisible())
        qtbot.keyClicks(palette.field, typed)
        if typed == "zzz":
            assert "zzz" in palette.list.item(0).text()
            qtbot.keyClick(palette.field, Qt.Key.Key_Return)
            assert palette.isVisible()
            qtbot.keyClick(palette.field, Qt.Key.Key_Escape)
        else:
            assert palette.list.item(0).text() == "Panel Histograms"
            qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: host.seen)
    wait_idle(qtbot, explorer)
