"""The whole window, driven by real events."""

from __future__ import annotations

import json
import os
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QGuiApplication, QImage
from PySide6.QtWidgets import QApplication, QFileDialog, QSlider, QSpinBox

from tests.gui.conftest import drag, handle_point, hb, ids, result_image, wait_idle
from texlab.window import gallery_thumbnails
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer
    from texlab.state.chosen import Column


def expected(texture: Any, column: Column, size: tuple[int, int] = (48, 48), seed: int = 5) -> Any:
    """What the core alone makes of a column."""
    inputs = {"exemplar": as_exemplar(texture)}
    job = Job(method=column.method, inputs=inputs, params=column.params, size=size, seed=seed)
    return run(job).image


def test_columns_show_what_the_core_makes(explorer: Explorer, texture: Path) -> None:
    for column in explorer.session.state.columns:
        assert np.array_equal(result_image(explorer, column.id), expected(str(texture), column))
        picture = explorer.workspace.columns[column.id].pane.picture
        assert picture is not None
        assert picture.shape == (48, 48, 3)
    first, second = ids(explorer)
    assert not np.array_equal(result_image(explorer, first), result_image(explorer, second))
    assert explorer.workspace.exemplar.pane.picture.shape == (40, 48, 3)
    assert explorer.window.windowTitle() == "waves.png - TexLab"


def test_seed_size_undo_and_redo(qtbot: Any, explorer: Explorer, texture: Path) -> None:
    column = explorer.session.state.columns[0]
    before = result_image(explorer, column.id)
    box = explorer.window.toolbar.seed_box
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "77")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert explorer.session.state.seed == 77
    wait_idle(qtbot, explorer)
    assert np.array_equal(result_image(explorer, column.id), expected(str(texture), column, seed=77))
    explorer.window.toolbar.width_box.setFocus()
    explorer.window.toolbar.width_box.selectAll()
    qtbot.keyClicks(explorer.window.toolbar.width_box, "64")
    qtbot.keyClick(explorer.window.toolbar.width_box, Qt.Key.Key_Return)
    wait_idle(qtbot, explorer)
    assert result_image(explorer, column.id).shape == (48, 64, 3)
    explorer.window.setFocus()
    qtbot.keyClick(explorer.window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    qtbot.keyClick(explorer.window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    wait_idle(qtbot, explorer)
    assert box.value() == 5
    assert np.array_equal(result_image(explorer, column.id), before)
    both = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    qtbot.keyClick(explorer.window, Qt.Key.Key_Z, both)
    assert explorer.session.state.seed == 77
    wait_idle(qtbot, explorer)


def test_a_drag_is_one_step_and_ends_at_full_size(qtbot: Any, explorer: Explorer, texture: Path) -> None:
    form = explorer.window.parameters.form
    slider = form.knobs["iterations"].findChild(QSlider)
    start = handle_point(slider)
    places = [start] + [QPoint(start.x() + 3 * k, start.y()) for k in range(1, 9)]
    drag(qtbot, slider, places)
    wait_idle(qtbot, explorer)
    column = explorer.session.selected_column
    assert column.params.iterations > 2
    assert form.knobs["iterations"].findChild(QSpinBox).value() == column.params.iterations
    assert np.array_equal(result_image(explorer, column.id), expected(str(texture), column))
    assert explorer.controller.column_scene(column.id).draft is False
    explorer.session.undo()
    assert explorer.session.selected_column.params.iterations == 2
    assert explorer.session.undo_text is None
    wait_idle(qtbot, explorer)


def test_stop_frees_the_column_and_the_others_go_on(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_window(str(texture), [hb(iterations=50), hb()], wait=False, size=400)
    first, second = ids(explorer)
    scene = explorer.controller.column_scene
    qtbot.waitUntil(lambda: scene(first) is not None and scene(first).status == "running", timeout=30_000)
    view = explorer.workspace.columns[first]
    qtbot.mouseClick(view.stop_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: scene(first).status == "cancelled", timeout=5_000)
    wait_idle(qtbot, explorer)
    assert scene(second).status == "finished"
    assert "stopped" in view.line.text()


def test_a_failing_column_says_why_and_leaves_the_others(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, stub: Any
) -> None:
    method, params = "stub", stub.params(level=3.0)
    explorer = open_window(str(texture), [(method, params), hb()])
    first, second = ids(explorer)
    assert explorer.controller.column_scene(first).status == "failed"
    assert "level: 3 is what this stub fails at." in explorer.workspace.columns[first].line.text()
    assert explorer.controller.column_scene(second).status == "finished"


def test_columns_are_added_copied_moved_given_methods_and_removed(
    qtbot: Any, explorer: Explorer, stub: Any
) -> None:
    first, second = ids(explorer)
    qtbot.keyClick(explorer.window, Qt.Key.Key_D, Qt.KeyboardModifier.ControlModifier)
    assert len(ids(explorer)) == 3
    third = ids(explorer)[1]
    assert explorer.session.selected_id == third
    both = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    qtbot.keyClick(explorer.window, Qt.Key.Key_Left, both)
    assert ids(explorer) == [third, first, second]
    wait_idle(qtbot, explorer)
    assert np.array_equal(result_image(explorer, third), result_image(explorer, first))
    view = explorer.workspace.columns[second]
    qtbot.mouseClick(view.pane.viewport(), Qt.MouseButton.LeftButton)
    assert explorer.session.selected_id == second
    qtbot.keyClick(explorer.window, Qt.Key.Key_W, Qt.KeyboardModifier.ControlModifier)
    assert ids(explorer) == [third, first]
    explorer.session.undo()
    assert ids(explorer) == [third, first, second]
    wait_idle(qtbot, explorer)
    assert result_image(explorer, second).shape == (48, 48, 3)


def test_crop_box_recomputes(qtbot: Any, explorer: Explorer, texture: Path) -> None:
    qtbot.mouseClick(explorer.workspace.exemplar.crop_button, Qt.MouseButton.LeftButton)
    wait_idle(qtbot, explorer)
    crop = explorer.session.state.sample.crop
    assert (crop.height, crop.width) == (20, 24)
    assert explorer.controller.exemplar.size == (20, 24)
    pane = explorer.workspace.exemplar.pane
    centre = pane.to_widget(crop.top + 10, crop.left + 12).toPoint()
    away = pane.to_widget(crop.top + 15, crop.left + 8).toPoint()
    halves = [centre + (away - centre) * k / 6 for k in range(7)]
    drag(qtbot, pane.viewport(), halves)
    wait_idle(qtbot, explorer)
    moved = explorer.session.state.sample.crop
    assert (moved.height, moved.width) == (20, 24)
    assert (moved.top, moved.left) == (crop.top + 5, crop.left - 4)
    column = explorer.session.state.columns[0]
    pixels = as_exemplar(str(texture), crop=moved).pixels
    assert np.array_equal(explorer.controller.exemplar.pixels, pixels)
    assert np.array_equal(result_image(explorer, column.id), expected(pixels, column))
    explorer.session.undo()
    assert explorer.session.state.sample.crop == crop
    wait_idle(qtbot, explorer)


def test_scale_keeps_the_crop_over_the_same_part(qtbot: Any, explorer: Explorer) -> None:
    qtbot.mouseClick(explorer.workspace.exemplar.crop_button, Qt.MouseButton.LeftButton)
    box = explorer.workspace.exemplar.scale_box
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "0.5")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    wait_idle(qtbot, explorer)
    crop = explorer.session.state.sample.crop
    assert (crop.top, crop.left, crop.height, crop.width) == (5, 6, 10, 12)
    assert explorer.controller.exemplar.size == (10, 12)


def test_gallery_click_and_search(qtbot: Any, explorer: Explorer) -> None:
    gallery = explorer.window.gallery
    qtbot.waitUntil(lambda: gallery.thumbnails == 58, timeout=30_000)
    qtbot.keyClicks(gallery.search, "zebra")
    visible = [item for item in gallery._items.values() if not item.isHidden()]
    assert [item.text(0) for item in visible] == ["Zebra"]
    place = gallery.tree.visualItemRect(visible[0]).center()
    qtbot.mouseClick(gallery.tree.viewport(), Qt.MouseButton.LeftButton, pos=place)
    qtbot.waitUntil(lambda: explorer.session.state.sample.source.name == "gallery:oriented-zebra", timeout=10_000)
    wait_idle(qtbot, explorer)
    assert explorer.controller.exemplar.size == (256, 256)


def test_a_second_window_reads_no_texture_of_the_gallery_again(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[str] = []

    def counted(name: str) -> Any:
        read.append(name)
        return as_exemplar(name)

    monkeypatch.setattr("texlab_core.images.exemplar.as_exemplar", counted)
    gallery_thumbnails._thumbnail.cache_clear()
    names = ["gallery:oriented-zebra", "gallery:structured-pebbles"]
    task = SimpleNamespace(should_stop=lambda: False, due=lambda: False)
    first, second = (gallery_thumbnails.make_thumbnails(names, task) for _ in range(2))
    assert read == names
    assert [picture.shape for _, picture in first] == [(48, 48, 3)] * 2
    assert all(again is picture for (_, picture), (_, again) in zip(first, second, strict=True))


def drop(window: Any, mime: QMimeData) -> None:
    left, keys, copy = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, Qt.DropAction.CopyAction
    entering = QDragEnterEvent(QPoint(200, 200), copy, mime, left, keys)
    QApplication.sendEvent(window, entering)
    assert entering.isAccepted()
    QApplication.sendEvent(window, QDropEvent(QPointF(200, 200), copy, mime, left, keys))


def test_saved_result_is_restored_by_dropping_it(
    qtbot: Any, explorer: Explorer, texture: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "result.png"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *args, **more: (str(target), ""))
    first = explorer.session.state.columns[0]
    image = result_image(explorer, first.id)
    qtbot.keyClick(explorer.window, Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(target.exists, timeout=10_000)
    wait_idle(qtbot, explorer)
    assert "Saved" in explorer.window.message_bar.label.text()
    explorer.session.set_seed(99)
    explorer.session.set_size((32, 32))
    explorer.session.set_params(first.id, first.params.replace(iterations=1), "iterations")
    explorer.opener.open("gallery:oriented-zebra")
    qtbot.waitUntil(lambda: explorer.session.state.sample.source.name.startswith("gallery"), timeout=10_000)
    wait_idle(qtbot, explorer)
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(target))])
    drop(explorer.window, mime)
    qtbot.waitUntil(lambda: explorer.session.state.seed == 5, timeout=10_000)
    wait_idle(qtbot, explorer)
    assert explorer.session.state.size == (48, 48)
    assert explorer.session.selected_id == first.id
    assert explorer.session.selected_column.params == first.params
    assert np.array_equal(result_image(explorer, first.id), image)


def test_paste_and_copy(qtbot: Any, explorer: Explorer) -> None:
    picture = QImage(20, 24, QImage.Format.Format_RGB888)
    picture.fill(Qt.GlobalColor.white)
    for k in range(20):
        picture.setPixelColor(k, k, Qt.GlobalColor.red)
    QGuiApplication.clipboard().setImage(picture)
    qtbot.keyClick(explorer.window, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: explorer.session.state.sample.source.size == (24, 20), timeout=10_000)
    wait_idle(qtbot, explorer)
    assert np.array_equal(explorer.controller.exemplar.pixels[7, 7], [1, 0, 0])
    qtbot.keyClick(explorer.window, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    clipboard = QGuiApplication.clipboard()
    qtbot.waitUntil(lambda: clipboard.mimeData().hasFormat("image/png"))
    copied = QImage.fromData(clipboard.mimeData().data("image/png"))
    assert (copied.width(), copied.height()) == (48, 48)
    shown = explorer.controller.column_scene(explorer.session.selected_id).picture
    assert not np.array_equal(shown, shown[::-1])
    assert not np.array_equal(shown, shown[:, ::-1])
    colours = [[copied.pixelColor(x, y).getRgb()[:3] for x in range(48)] for y in range(48)]
    assert np.array_equal(colours, shown)


def test_what_is_no_image_gets_one_sentence_and_changes_nothing(
    qtbot: Any, explorer: Explorer, tmp_path: Path
) -> None:
    bad = tmp_path / "notes.png"
    bad.write_text("hello")
    state = explorer.session.state
    explorer.opener.open(str(bad))
    bar = explorer.window.message_bar
    qtbot.waitUntil(bar.isVisible, timeout=10_000)
    assert "notes.png" in bar.label.text()
    assert explorer.session.state is state
    wait_idle(qtbot, explorer)


def assert_same_view(one: Any, other: Any) -> None:
    """The same centre and the same scale; a pane that is a pixel wider shows a little more."""
    first, second = one.view_rect(), other.view_rect()
    assert (first.center().x(), first.center().y()) == pytest.approx((second.center().x(), second.center().y()))
    assert one.shown_scale == pytest.approx(other.shown_scale)


def test_linked_views_and_the_value_under_the_cursor(qtbot: Any, explorer: Explorer) -> None:
    first, second = ids(explorer)
    one, other = (explorer.workspace.columns[each].pane for each in (first, second))
    qtbot.keyClick(explorer.window, Qt.Key.Key_Plus)
    assert one.view_rect().width() < 48
    assert_same_view(one, other)
    before = one.view_rect()
    start = one.to_widget(24, 24).toPoint()
    drag(qtbot, one.viewport(), [start, start + QPoint(8, 0), start + QPoint(24, 4), start + QPoint(40, 8)])
    assert one.view_rect().left() < before.left()
    assert_same_view(one, other)
    qtbot.keyClick(explorer.window, Qt.Key.Key_F)
    assert one.view_rect().contains(QPointF(1, 1))
    qtbot.mouseMove(one.viewport(), one.to_widget(10.5, 20.5).toPoint())
    image = result_image(explorer, first)
    values = " ".join(f"{value:.3f}" for value in image[10, 20])
    qtbot.waitUntil(lambda: f"20, 10   RGB {values}" in explorer.window.status.pixel.text(), timeout=5_000)


def test_tiling_shows_four(qtbot: Any, explorer: Explorer) -> None:
    qtbot.keyClick(explorer.window, Qt.Key.Key_T)
    pane = explorer.workspace.columns[ids(explorer)[0]].pane
    assert pane.extent == (96, 96)
    assert pane.view_rect().contains(QPointF(95, 95))
    qtbot.keyClick(explorer.window, Qt.Key.Key_T)
    assert pane.extent == (48, 48)


@pytest.mark.parametrize("layout", ["explore", "teach", "tune"])
def test_layouts(qtbot: Any, explorer: Explorer, layout: str) -> None:
    explorer.window.actions_by_name[f"layout-{layout}"].trigger()
    assert explorer.window.docks["gallery"].isVisible() == (layout == "explore")
    assert explorer.window.docks["parameters"].isVisible() == (layout != "teach")
    explorer.window.actions_by_name["layout-explore"].trigger()


def test_themes_reach_palette_panes_and_docks(qtbot: Any, explorer: Explorer) -> None:
    explorer.window.actions_by_name["theme-dark"].trigger()
    assert QApplication.palette().window().color().lightness() < 80
    explorer.window.actions_by_name["surround-theme"].trigger()
    pane = explorer.workspace.exemplar.pane
    assert pane.backgroundBrush().color().lightness() < 60
    explorer.window.actions_by_name["theme-light"].trigger()
    assert QApplication.palette().window().color().lightness() > 200
    assert pane.backgroundBrush().color().lightness() > 200


def test_command_palette_finds_and_runs(qtbot: Any, explorer: Explorer) -> None:
    from texlab.window.palette import CommandPalette

    qtbot.keyClick(explorer.window, Qt.Key.Key_K, Qt.KeyboardModifier.ControlModifier)
    palette = explorer.window.findChild(CommandPalette)
    assert palette is not None
    qtbot.keyClicks(palette.field, "dupl")
    qtbot.keyClick(palette.field, Qt.Key.Key_Return)
    assert len(ids(explorer)) == 3
    wait_idle(qtbot, explorer)


def test_the_session_comes_back(
    qtbot: Any, explorer: Explorer, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer.session.set_seed(31)
    explorer.session.select(ids(explorer)[1])
    qtbot.mouseClick(explorer.workspace.exemplar.crop_button, Qt.MouseButton.LeftButton)
    wait_idle(qtbot, explorer)
    state = explorer.session.state
    explorer.window.close()
    again = open_window(None)
    assert again.session.state.seed == 31
    assert again.session.state.size == (48, 48)
    assert [each.params for each in again.session.state.columns] == [each.params for each in state.columns]
    assert again.session.state.sample.crop == state.sample.crop
    assert again.session.selected_column.params == state.columns[1].params
    assert again.settings.recent == [str(texture)]


def test_broken_settings_are_left_aside(open_window: Callable[..., Explorer], texlab_home: Path) -> None:
    folder = texlab_home / "config"
    folder.mkdir(parents=True)
    broken = {"session": {"columns": [{"method": "nothing"}, 3, None], "seed": -4, "size": "x"}, "recent": 7}
    (folder / "settings.json").write_text(json.dumps(broken))
    explorer = open_window("gallery:stochastic-sea", [hb()])
    assert explorer.session.state.seed == 1
    assert explorer.settings.recent == []


def test_an_unexpected_error_is_logged_and_told(qtbot: Any, explorer: Explorer, texlab_home: Path) -> None:
    import sys

    def crash() -> None:
        raise RuntimeError("a slot that fails")

    try:
        crash()
    except RuntimeError as error:
        sys.excepthook(type(error), error, error.__traceback__)
    text = explorer.window.message_bar.label.text()
    assert "a slot that fails" in text
    assert "Traceback" not in text
    log = (texlab_home / "log" / "texlab.log").read_text(encoding="utf-8")
    assert "in crash" in log
    assert explorer.controller.column_scene(ids(explorer)[0]).status == "finished"


def test_twenty_thousand_signals(qtbot: Any) -> None:
    from PySide6.QtCore import QObject, Signal

    class Emitter(QObject):
        sent = Signal(bool, object)

    emitter = Emitter()
    counts = [0, 0]

    def count(flag: bool, value: object) -> None:
        counts[flag] += value is None

    emitter.sent.connect(count)
    for number in range(20_000):
        emitter.sent.emit(number % 2 == 0, None)
    assert counts == [10_000, 10_000]


def test_help_opens_the_page_of_the_method(qtbot: Any, explorer: Explorer) -> None:
    qtbot.keyClick(explorer.window, Qt.Key.Key_F1)
    assert explorer.desk.help is not None
    assert explorer.desk.help.browser.page == "heeger-bergen"
    assert "pyramid" in explorer.desk.help.browser.toPlainText().lower()


def test_a_map_is_laid_over_the_picture(qtbot: Any, open_window: Callable[..., Explorer], texture: Path) -> None:
    from texlab.style.colouring import colour_map

    explorer = open_window(str(texture), [("de-bonet", texlab_params("de-bonet"))])
    (column_id,) = ids(explorer)
    view = explorer.workspace.columns[column_id]
    assert "source" in {action.objectName().split("-")[1] for action in view.map_menu.actions()}
    source = next(action for action in view.map_menu.actions() if action.objectName() == f"map-source-{column_id}")
    source.trigger()
    qtbot.waitUntil(lambda: view.pane._overlay is not None, timeout=10_000)
    shown = explorer.controller.column_scene(column_id).result.maps["source"]
    assert np.array_equal(view.pane._overlay.image, colour_map(shown, (40, 48)))
    view.map_menu.actions()[0].trigger()
    assert view.pane._overlay is None


def texlab_params(method: str) -> Any:
    from texlab_core.engine.registry import methods

    return methods()[method].params()


def test_efros_leung_is_drafted_while_a_slider_is_dragged(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    params = texlab_params("efros-leung").replace(window=5)
    explorer = open_window(str(texture), [("efros-leung", params)], size=64)
    (column_id,) = ids(explorer)
    explorer.controller._runners[column_id].seconds = 10.0
    explorer.controller.editing.params(column_id, params.replace(eps=0.3), "eps", False)
    scene = explorer.controller.column_scene
    qtbot.waitUntil(lambda: scene(column_id).draft and scene(column_id).status == "finished", timeout=20_000)
    assert scene(column_id).result is None
    assert "draft" in explorer.workspace.columns[column_id].line.text()
    explorer.controller.editing.params(column_id, params.replace(eps=0.3), "eps", True)
    wait_idle(qtbot, explorer)
    assert not scene(column_id).draft
    column = explorer.session.state.columns[0]
    assert np.array_equal(result_image(explorer, column_id), expected(str(texture), column, size=(64, 64)))


def test_spectra_are_compared_in_one_click(qtbot: Any, explorer: Explorer) -> None:
    before = ids(explorer)
    explorer.window.actions_by_name["spectra"].trigger()
    wait_idle(qtbot, explorer)
    assert [column.method for column in explorer.session.state.columns] == ["uncoded", "msg", "car", "ac-h"]
    lines = [explorer.workspace.columns[each].line.toolTip() for each in ids(explorer)]
    assert all("numbers" in line and " dB" in line for line in lines), lines
    explorer.session.undo()
    assert ids(explorer) == before
    wait_idle(qtbot, explorer)


def test_efros_leung_goes_on_after_a_stop_and_after_enlarging(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    params = texlab_params("efros-leung").replace(window=7)
    explorer = open_window(str(texture), [("efros-leung", params)], wait=False, size=150)
    controller, column = explorer.controller, explorer.session.state.columns[0]
    scene = controller.column_scene
    qtbot.waitUntil(
        lambda: scene(column.id).status == "running" and scene(column.id).fraction > 0.1, timeout=60_000
    )
    qtbot.keyClick(explorer.window, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: scene(column.id).status == "cancelled", timeout=5_000)
    line = explorer.workspace.columns[column.id].line
    qtbot.waitUntil(lambda: "F6 goes on" in line.text(), timeout=5_000)
    known = (scene(column.id).picture != 128).any(axis=2)
    assert 0.05 < known.mean() < 0.999
    qtbot.keyClick(explorer.window, Qt.Key.Key_F6)
    wait_idle(qtbot, explorer)
    whole = expected(str(texture), column, size=(150, 150))
    assert np.array_equal(result_image(explorer, column.id), whole)
    assert scene(column.id).resumable
    explorer.session.set_size((170, 170))
    qtbot.keyClick(explorer.window, Qt.Key.Key_F6)
    wait_idle(qtbot, explorer)
    grown = result_image(explorer, column.id)
    assert grown.shape == (170, 170, 3)
    assert np.array_equal(grown[10:160, 10:160], whole)


@pytest.mark.parametrize("other", ["method", "exemplar"])
def test_nothing_goes_on_from_where_something_else_stood(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, other: str
) -> None:
    explorer = open_window(str(texture), [("efros-leung", texlab_params("efros-leung").replace(window=7))])
    controller, (column_id,) = explorer.controller, ids(explorer)
    assert controller.column_scene(column_id).resumable
    # Every place is taken: what is asked for next does not begin.
    places = os.cpu_count() or 1
    for _ in range(places):
        assert controller.slots.acquire(lambda: False)
    if other == "method":
        explorer.handlers.choose_method(column_id, "heeger-bergen")
    else:
        explorer.opener.open("gallery:oriented-zebra")
        qtbot.waitUntil(lambda: not controller._errands.busy and not controller._preparation.busy)
    assert controller.column_scene(column_id).status == "waiting"
    controller.stop_all()
    for _ in range(places):
        controller.slots.release()
    assert controller.column_scene(column_id).status == "cancelled"
    assert not controller.column_scene(column_id).resumable
    wait_idle(qtbot, explorer)


def test_many_columns_come_back(qtbot: Any, open_window: Callable[..., Explorer], texture: Path) -> None:
    explorer = open_window(str(texture), [("pixels", texlab_params("pixels"))] * 14)
    explorer.close()
    assert len(ids(open_window(None))) == 14


def test_tuning_brings_the_threshold_table_to_the_front(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    explorer = open_window(str(texture), [hb(), ("de-bonet", texlab_params("de-bonet"))])
    first, second = ids(explorer)
    for column_id, front in ((second, "thresholds"), (first, "histograms")):
        explorer.session.select(column_id)
        explorer.window.actions_by_name["layout-tune"].trigger()
        shown = explorer.hosts[front].dock
        qtbot.waitUntil(lambda shown=shown: not shown.visibleRegion().isEmpty(), timeout=5_000)
    explorer.window.actions_by_name["layout-explore"].trigger()
    wait_idle(qtbot, explorer)


@pytest.mark.parametrize("size", [(4, 1024), (1024, 4), (20, 1024), (300, 200)])
def test_fit_shows_thin_pictures_too(qtbot: Any, open_window: Any, texture: Path, size: tuple[int, int]) -> None:
    explorer = open_window(str(texture), [("tiling", methods()["tiling"].params())])
    explorer.window.actions_by_name["link"].trigger()
    explorer.session.set_size(size)
    wait_idle(qtbot, explorer)
    (column_id,) = ids(explorer)
    pane, exemplar = explorer.workspace.columns[column_id].pane, explorer.workspace.exemplar.pane
    thin = min(size)
    for each in (pane, exemplar):
        scale = each.shown_scale
        assert scale * thin >= min(8, thin) - 1e-6
        # Not more than is needed, and whole where that is possible.
        whole = scale * size[0] <= each.height() + 1 and scale * size[1] <= each.width() + 1
        assert whole or scale * thin == pytest.approx(min(8, thin))
        assert each.view_rect().contains(QPointF(1, 1))
