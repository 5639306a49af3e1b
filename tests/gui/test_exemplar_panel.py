"""The exemplar's crop and levels, typed: what the methods see, what is only shown, and what is said."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QContextMenuEvent
from PySide6.QtWidgets import QApplication, QMenu

from tests.gui.conftest import ids, wait_idle
from texlab.state.changes import part_words
from texlab_core.engine.inputs import Crop
from texlab_core.engine.levels import Levels
from texlab_core.engine.registry import methods
from texlab_core.images.formats.writing import write_image

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer


def test_crop_and_levels_are_typed(qtbot: Any, open_window: Callable[..., Explorer], tmp_path: Path) -> None:
    values = np.random.default_rng(4).integers(3000, 9000, (120, 150, 3)) / np.float32(65535)
    write_image(tmp_path / "dark.png", values.astype(np.float32), bits=16)
    explorer = open_window(str(tmp_path / "dark.png"), [("pixels", methods()["pixels"].params())])
    exemplar, session, controller = explorer.workspace.exemplar, explorer.session, explorer.controller
    qtbot.mouseClick(exemplar.more, Qt.MouseButton.LeftButton)
    panel = exemplar.panel
    assert panel.isVisible()
    # The crop.
    panel.boxes["width"].setValue(60)
    panel.boxes["height"].setValue(40)
    panel.boxes["x"].setValue(30)
    assert session.state.sample.crop == Crop(0, 30, 40, 60)
    panel.lock.setChecked(True)
    panel.boxes["width"].setValue(90)
    assert session.state.sample.crop == Crop(0, 30, 60, 90)
    panel.lock.setChecked(False)
    qtbot.mouseClick(panel.powers_button, Qt.MouseButton.LeftButton)
    crop = session.state.sample.crop
    assert (crop.height, crop.width) == (64, 64)
    # Beyond the picture it is moved inside.
    panel.boxes["x"].setValue(149)
    assert session.state.sample.crop.left == 150 - 64
    wait_idle(qtbot, explorer)
    assert f"64 x 64 colour at 86, {crop.top} of 150 x 120" in exemplar.line.text()
    session.set_sample(part_scaled(session, 0.5))
    wait_idle(qtbot, explorer)
    assert "scaled to 50 %" in exemplar.line.text()
    qtbot.mouseClick(panel.full_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: session.state.sample.scale == 1.0, timeout=5_000)
    qtbot.mouseClick(panel.whole_button, Qt.MouseButton.LeftButton)
    assert session.state.sample.crop is None
    wait_idle(qtbot, explorer)
    # Levels for the methods too.
    plain = controller.exemplar.pixels
    qtbot.mouseClick(panel.auto_button, Qt.MouseButton.LeftButton)
    wait_idle(qtbot, explorer)
    levels = session.state.sample.levels
    assert levels == Levels.auto(plain)
    assert np.array_equal(controller.exemplar.pixels, levels.applied(plain))
    assert "levels black 0.04" in exemplar.line.text()
    column = controller.column_scene(ids(explorer)[0])
    assert column.result.image.max() == 1
    assert session.undo_text == "levels"
    # For looking only.
    panel.use.setCurrentIndex(1)
    panel.use.activated.emit(1)
    wait_idle(qtbot, explorer)
    assert np.array_equal(controller.exemplar.pixels, plain)
    assert "for looking only" in exemplar.line.text()
    pane = explorer.workspace.columns[ids(explorer)[0]].pane
    assert pane.picture.max() < 50
    assert pane.item.image.max() == 255
    assert exemplar.pane.picture.max() == 255
    # White below black: the other end makes room.
    panel.white.setValue(0.01)
    wait_idle(qtbot, explorer)
    assert session.state.sample.levels.black < 0.01
    # The session has them when it comes back.
    wanted = session.state.sample.levels
    explorer.window.close()
    again = open_window(None)
    assert (again.session.state.sample.levels, again.session.state.sample.look_only) == (wanted, True)
    again.workspace.exemplar.panel.reset_button.click()
    wait_idle(qtbot, again)
    assert again.session.state.sample.levels is None
    assert not again.session.state.sample.look_only
    # The right button offers the same.
    view = again.workspace.exemplar
    where = view.rect().center()
    QApplication.sendEvent(view, QContextMenuEvent(QContextMenuEvent.Reason.Mouse, where, view.mapToGlobal(where)))
    menu = view.findChild(QMenu, "exemplar-menu")
    texts = [action.text() for action in menu.actions()]
    assert {"Crop", "Powers of two", "Work at 100 %", "Crop in numbers, levels ..."} <= set(texts)
    menu.close()


def part_scaled(session: Any, scale: float) -> Any:
    import dataclasses

    sample = dataclasses.replace(session.state.sample, scale=scale, crop=Crop(0, 0, 32, 32))
    assert part_words(sample, (60, 75)) == "at 0, 0 of 75 x 60, 150 x 120 scaled to 50 %"
    return sample


def test_a_crop_is_of_the_sample_in_use_before_its_picture_has_come(explorer: Explorer, qtbot: Any) -> None:
    """Crop pressed while another scale is being prepared frames the middle of the scaled source."""
    exemplar, session = explorer.workspace.exemplar, explorer.session
    height, width = session.state.sample.source.size
    shown = exemplar.pane.picture
    explorer.controller.editing.scale(0.5)
    assert exemplar.pane.picture is shown
    qtbot.mouseClick(exemplar.crop_button, Qt.MouseButton.LeftButton)
    crop = session.state.sample.crop
    assert (crop.height, crop.width) == (round(height / 2) // 2, round(width / 2) // 2)
    assert exemplar.panel.boxes["width"].maximum() <= width // 2
    wait_idle(qtbot, explorer)
    assert explorer.controller.exemplar.size == (crop.height, crop.width)
