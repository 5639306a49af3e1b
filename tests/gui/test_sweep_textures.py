"""One preset over many textures in the sweeps dock, and two cells side by side."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QContextMenuEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QMenu
from sweep_bench import LEFT, PATIENCE_MS, choose, click_cell, complete, make_bench, set_range, start  # noqa: F401

from tests.stub_method import StubParams, stub  # noqa: F401
from texlab.docks.sweeps.textures import ITEMS
from texlab.state.chosen import Column
from texlab.storage.projects import is_handed_on, open_project
from texlab.style.pictures import to_picture
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.pair_layer import difference_picture
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.gallery import CLASSES, gallery

pytestmark = pytest.mark.usefixtures("stub")


@pytest.fixture
def photos(tmp_path):
    for seed, name in enumerate(("one.png", "two.png", "three.png")):
        pixels = np.random.default_rng(seed).integers(0, 256, (20 + seed, 24, 3), np.uint8)
        Image.fromarray(pixels).save(tmp_path / name)
    return tmp_path


def over_folder(qtbot, dock, folder, *, say=True):
    """Choose the textures of a folder through its dialog."""
    choose(qtbot, dock.panel.across.knob, "texture")
    box = dock.panel.across.texture_choice.box
    choose(qtbot, box, "a folder ...")
    box.activated.emit(box.currentIndex())
    dialog = dock.findChild(QFileDialog, "sweeps-textures-dialog")
    dialog.setOption(QFileDialog.Option.DontUseNativeDialog)
    # A field that has the keyboard keeps its text: the file that is selected would not be taken.
    dialog.setDirectory(str(folder))
    dialog.accept()
    choose(qtbot, dock.panel.side_box, "64 x 64")


def test_a_folder_of_textures_becomes_a_grid(qtbot, bench, photos):
    here = bench(Column(1, "stub", StubParams(level=1.0)))
    dock, session, canvas = here.dock, here.session, here.dock.sheet.canvas
    (photos / "broken.png").write_bytes(b"no picture")
    over_folder(qtbot, dock, photos)
    assert dock.panel.across.texture_choice.words.text() == f"the images in {photos.name}"
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    names = ["one.png", "three.png", "two.png"]
    assert canvas.headings == (names, ["border reflect", "border wrap"])
    assert dock.heading.text().startswith(
        "Stub: texture across, border down · 64 x 64, seed 5, level 1 · One texture"
    )
    assert "broken.png" in dock.heading.text()
    for index in (1, 5):
        texture = as_exemplar(photos / names[index % 3])
        cell = dock.cells[index].cell
        assert cell.job.inputs["exemplar"].sha256 == texture.sha256
        assert cell.job.params == StubParams(level=1.0, border=("reflect", "wrap")[index // 3])
        assert np.array_equal(cell.result.image, run(cell.job).image)
        assert dock.cells[index].picture.shape == (64, 64, 3)
    # Nothing of the session has changed; a cell as a column brings its texture, in one step.
    assert session.undo_text is None
    canvas.setFocus()
    qtbot.keyClick(canvas, Qt.Key.Key_End)
    assert "Click to take the texture and parameters." in canvas.accessibleDescription()
    # All columns share their exemplar: a cell of another one opens in a window of its own.
    qtbot.keyClick(canvas, Qt.Key.Key_N)
    qtbot.waitUntil(lambda: bool(here.asked["open_window"]), timeout=PATIENCE_MS)
    assert session.undo_text is None
    (path,) = here.asked["open_window"]
    assert is_handed_on(path)
    handed = open_project(path)
    assert not Path(path).exists()
    assert not Path(path).parent.exists()
    job = dock.cells[5].cell.job
    assert handed.state.sample.source.sha256 == job.inputs["exemplar"].sha256
    assert [(each.method, each.params) for each in handed.state.columns] == [(job.method, job.params)]
    assert handed.state.seed == job.seed
    # The menu offers both, and says what the other does.
    QApplication.sendEvent(
        canvas, QContextMenuEvent(QContextMenuEvent.Reason.Keyboard, QPoint(), canvas.mapToGlobal(QPoint()))
    )
    menu = canvas.findChild(QMenu, "sweeps-cell-menu")
    names = [each.text().replace("&", "") for each in menu.actions()]
    assert names[1] == "Open in a new window\tN"
    assert names[2] == "Open as a column here: all columns take its texture"
    menu.actions()[2].trigger()
    menu.close()
    assert session.undo_text == "column of a sweep"
    assert [each.params.border for each in session.state.columns] == ["reflect", "wrap"]
    assert session.state.sample.source.name == "two.png"
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)
    assert here.controller.exemplar.sha256 == dock.cells[5].cell.job.inputs["exemplar"].sha256
    qtbot.waitUntil(lambda: canvas.marked == 5, timeout=PATIENCE_MS)
    session.undo()
    assert session.state.sample.source.name == "noise"
    assert len(session.state.columns) == 1
    # A click takes texture and parameters.
    click_cell(qtbot, dock, 1)
    assert session.state.sample.source.name == "three.png"
    qtbot.waitUntil(lambda: canvas.marked == 1, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)


def test_what_textures_there_are_to_choose_from(qtbot, bench, photos):
    here = bench()
    dock, axis = here.dock, here.dock.panel.across
    assert dock.panel.down.texture_choice is None
    assert axis.textures is None
    choose(qtbot, axis.knob, "texture")
    assert axis.vary() is None
    assert axis.texture_choice.isVisible()
    for name, title in CLASSES.items():
        choose(qtbot, axis.texture_choice.box, f"gallery: {title.lower()}")
        assert axis.textures.texts == (f"gallery:{name}",)
    assert len(ITEMS) == len(CLASSES) + 4
    # No folder has been chosen: one sentence, and nothing starts.
    axis.texture_choice.choose("folder")
    start(qtbot, dock)
    assert "textures: must be a class of the gallery, or files" in dock.panel.error.text()
    assert dock.shown.number == 0
    # The files that are open.
    here.controller.tell_opened((str(photos / "one.png"), str(photos / "two.png")))
    axis.texture_choice.choose("opened")
    qtbot.waitUntil(lambda: axis.texture_choice.words.text() == "2 files")
    choose(qtbot, dock.panel.side_box, "64 x 64")
    complete(qtbot, dock)
    assert dock.sheet.canvas.settings == ["one.png", "two.png"]
    # What is chosen comes back with the method.
    left = axis.choice
    axis.choose_knob("seed")
    axis.show_method(StubParams, left)
    assert axis.textures.texts == (str(photos / "one.png"), str(photos / "two.png"))


def test_textures_that_cannot_be_read_are_said_in_place(qtbot, bench, tmp_path):
    dock = bench().dock
    choose(qtbot, dock.panel.across.knob, "texture")
    dock.panel.across.texture_choice.choose("folder", [str(tmp_path)])
    start(qtbot, dock)
    qtbot.waitUntil(lambda: "holds no image" in dock.panel.error.text(), timeout=PATIENCE_MS)
    assert dock.shown.status == "failed"
    (tmp_path / "broken.png").write_bytes(b"no picture")
    dock.panel.tell("")
    start(qtbot, dock)
    qtbot.waitUntil(lambda: "broken.png" in dock.panel.error.text(), timeout=PATIENCE_MS)


def test_too_many_textures_are_refused_before_they_are_read(qtbot, bench, photos):
    dock = bench().dock
    choose(qtbot, dock.panel.across.knob, "texture")
    dock.panel.across.texture_choice.choose("folder", [str(photos)])
    set_range(qtbot, dock.panel.down, "seed", "1", "134", "134")
    start(qtbot, dock)
    qtbot.waitUntil(lambda: "at most 400 cells, and these textures make 402" in dock.panel.error.text())


def test_the_gallery_stops_at_once(qtbot, bench):
    here = bench(Column(1, "stub", StubParams(rounds=400)))
    dock = here.dock
    choose(qtbot, dock.panel.across.knob, "texture")
    dock.panel.across.texture_choice.choose("gallery:*")
    start(qtbot, dock)
    qtbot.waitUntil(lambda: dock.sweep is not None, timeout=PATIENCE_MS)
    assert len(dock.sweep.jobs) == len(gallery())
    dock.stop()
    qtbot.waitUntil(lambda: not dock.running, timeout=PATIENCE_MS)
    assert "stopped" in dock.status.text()
    assert len(dock.cells) < len(gallery())


def test_a_method_that_cannot_use_any_says_why(qtbot, bench, photos):
    params = find_method("efros-leung").params(window=31)
    dock = bench(Column(1, "efros-leung", params)).dock
    choose(qtbot, dock.panel.across.knob, "texture")
    dock.panel.across.texture_choice.choose("folder", [str(photos)])
    start(qtbot, dock)
    qtbot.waitUntil(lambda: "window" in dock.panel.error.text(), timeout=PATIENCE_MS)


def test_two_cells_side_by_side(qtbot, bench):
    here = bench()
    dock, canvas = here.dock, here.dock.sheet.canvas
    set_range(qtbot, dock.panel.across, "seed", "1", "4", "4")
    choose(qtbot, dock.panel.side_box, "64 x 64")
    complete(qtbot, dock)
    assert not dock.compare_button.isEnabled()
    canvas.setFocus()
    for key in (Qt.Key.Key_K, Qt.Key.Key_End, Qt.Key.Key_K, Qt.Key.Key_Left, Qt.Key.Key_K):
        qtbot.keyClick(canvas, key)
    assert dock.kept == [0, 3, 2]
    assert dock.compare_button.isEnabled()
    qtbot.keyClick(canvas, Qt.Key.Key_C)
    pair = dock.pair
    assert dock.compares
    assert not dock.sheet.isVisible()
    a, b = (to_picture(dock.cells[index].cell.result.image) for index in (2, 3))
    assert np.array_equal(pair.panes[0].picture, a)
    assert np.array_equal(pair.panes[1].picture, b)
    assert [each.text().partition(",")[0] for each in pair.captions] == ["A: seed 3", "B: seed 4"]
    assert pair.layer.layer is None
    qtbot.keyClick(pair.back, Qt.Key.Key_B)
    assert np.array_equal(pair.layer.layer, b)
    qtbot.keyClick(pair.back, Qt.Key.Key_B)
    assert pair.layer.layer is None
    buttons = {each.text(): each for each in pair._buttons.values()}
    qtbot.mouseClick(buttons["Difference"], LEFT)
    qtbot.waitUntil(lambda: pair.layer.layer is not None, timeout=PATIENCE_MS)
    assert np.array_equal(pair.layer.layer, difference_picture(a, b, 4))
    assert buttons["Difference"].isChecked()
    choose(qtbot, pair.gain, "× 16")
    pair.gain.activated.emit(pair.gain.currentIndex())
    wanted = difference_picture(a, b, 16)
    qtbot.waitUntil(lambda: np.array_equal(pair.layer.layer, wanted), timeout=PATIENCE_MS)
    # Both move together.
    pair.link.zoom(2.0)
    assert pair.panes[0].view_rect() == pair.panes[1].view_rect()
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        assert pair.panes[0].backgroundBrush().color().name() == theme.canvas
    pair.back.setFocus()
    qtbot.keyClick(pair.back, Qt.Key.Key_Escape)
    assert not dock.compares
    assert dock.sheet.isVisible()
    assert canvas.hasFocus()
    # Another sweep shows its sheet.
    dock.compare()
    complete(qtbot, dock)
    assert not dock.compares
    assert dock.kept == []
    assert canvas.index_at(QPoint(-1, -1)) is None
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)
