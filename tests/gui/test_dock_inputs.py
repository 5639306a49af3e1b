"""The dock of inputs: further images from gallery, file, clipboard, drop and columns, with part and scale."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, image_input, noise, scene_of, shown
from mouse import drag, handle_point
from PIL import Image
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QGuiApplication, QImage
from PySide6.QtWidgets import QApplication, QFileDialog, QSlider

from texlab.docks.inputs.dock import InputsDock
from texlab.state.intentions import AskOnce, EditInputs, Tell
from texlab.state.scene import ColumnScene
from texlab_core.engine.inputs import Crop
from texlab_core.engine.registry import find_method
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer
    from texlab_core.engine.inputs import ImageInput

LEFT = Qt.MouseButton.LeftButton


def column(*inputs: tuple[str, Any], method: str = "mixture") -> ColumnScene:
    return ColumnScene(1, method, method.capitalize(), find_method(method).params(), inputs=inputs)


class Watched:
    """A dock whose intentions are carried out on the spot."""

    def __init__(self, qtbot: Any) -> None:
        self.dock: InputsDock = shown(qtbot, InputsDock(), 900, 300)
        self.told: list[Any] = []
        self.column = column()
        self.others: tuple[ColumnScene, ...] = ()
        self.dock.intention.connect(self._carry)
        self.feed()

    def feed(self) -> Any:
        return feed(self.dock, scene_of(self.column, *self.others))

    def _carry(self, intention: Any) -> None:
        self.told.append(intention)
        if isinstance(intention, AskOnce):
            intention.done(intention.compute(lambda: False))
        if isinstance(intention, EditInputs):
            self.column = dataclasses.replace(self.column, inputs=intention.inputs)
            self.feed()

    @property
    def given(self) -> ImageInput:
        return dict(self.column.inputs)[self.dock.which.currentData()]


@pytest.fixture
def here(qtbot: Any) -> Watched:
    return Watched(qtbot)


def test_it_asks_for_what_the_method_takes(here: Watched) -> None:
    dock = here.dock
    texts = [dock.which.itemText(place) for place in range(3)]
    assert texts == ["second", "third (not needed)", "fourth (not needed)"]
    assert "The texture at weight 1." in (dock.message or "")
    assert not dock.remove.isEnabled()
    check_controls(dock)
    here.column = column(method="tiling")
    assert here.feed() is None
    assert "takes no further images" in (dock.message or "")
    assert not dock.controls.isVisible()
    here.column = column(method="efros-leung")
    here.feed()
    assert [dock.which.itemData(place) for place in range(dock.which.count())] == [
        "start", "mask", "blend", "region",
    ]  # fmt: skip


def test_a_texture_of_the_gallery(here: Watched) -> None:
    menu = here.dock.gallery.menu()
    menu.aboutToShow.emit()
    group = next(each for each in menu.actions() if each.text() == "Stochastic")
    next(each for each in group.menu().actions() if each.text() == "lava").trigger()
    assert here.given.name == "gallery:stochastic-lava"
    assert here.dock.message is None
    assert here.dock.source.picture.shape[:2] == here.given.size  # type: ignore[union-attr]


def test_a_large_texture_is_reduced_and_a_mask_is_not(here: Watched, tmp_path: Path, monkeypatch: Any) -> None:
    path = tmp_path / "large.png"
    Image.fromarray((255 * noise(300, 640)).astype(np.uint8)).save(path)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", staticmethod(lambda *_: (str(path), "")))
    here.dock.findChild(object, "inputs-file").click()  # type: ignore[union-attr]
    assert max(here.given.size) == 256
    assert here.dock.scale.value() == 40
    here.column = column(method="efros-leung")
    here.feed()
    here.dock.findChild(object, "inputs-file").click()  # type: ignore[union-attr]
    assert here.given.size == (300, 640)


def test_part_and_scale_by_hand(qtbot: Any, here: Watched) -> None:
    here.dock.take(noise(80, 100))
    pane = here.dock.source
    assert pane.crop is None
    drag(qtbot, pane, [pane.place_of(*place).toPoint() for place in ((10, 20), (30, 50), (50, 60))])
    assert here.given.origin is not None
    crop = here.given.origin.crop
    assert crop is not None
    assert abs(crop.top - 10) + abs(crop.left - 20) + abs(crop.height - 40) + abs(crop.width - 40) <= 4
    whole = as_exemplar(noise(80, 100))
    np.testing.assert_array_equal(here.given.pixels, as_exemplar(whole, crop=crop).pixels)
    here.dock.scale.setFocus()
    here.dock.scale.selectAll()
    qtbot.keyClicks(here.dock.scale, "50")
    qtbot.keyClick(here.dock.scale, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: here.given.origin is not None and here.given.origin.scale == 0.5)
    half = here.given.origin.crop
    assert half is not None
    assert abs(half.top - crop.top / 2) <= 1
    assert abs(half.width - crop.width / 2) <= 1
    assert here.dock.source.picture.shape[:2] == (40, 50)  # type: ignore[union-attr]
    qtbot.keyClick(pane, Qt.Key.Key_Delete)
    assert here.given.origin.crop is None
    assert here.given.size == (40, 50)
    drag(qtbot, pane, [pane.place_of(1, 1).toPoint(), pane.place_of(3, 3).toPoint()])
    assert here.given.size == (40, 50), "a slip of the hand is no part"
    here.dock.whole.click()
    here.dock.remove.click()
    assert here.column.inputs == ()


def test_paste_drop_and_another_columns_result(qtbot: Any, here: Watched, tmp_path: Path) -> None:
    clipboard = QGuiApplication.clipboard()
    clipboard.clear()
    here.dock.findChild(object, "inputs-paste").click()  # type: ignore[union-attr]
    assert here.told[-1] == Tell("There is no image on the clipboard.", problem=True)
    picture = QImage(30, 20, QImage.Format.Format_RGB888)
    picture.fill(Qt.GlobalColor.red)
    clipboard.setImage(picture)
    here.dock.findChild(object, "inputs-paste").click()  # type: ignore[union-attr]
    assert here.given.size == (20, 30)
    clipboard.clear()

    path = tmp_path / "dropped.png"
    Image.fromarray((255 * noise(33, 44)).astype(np.uint8)).save(path)
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path))])
    enter = QDragEnterEvent(QPoint(9, 9), Qt.DropAction.CopyAction, mime, LEFT, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(here.dock, enter)
    assert enter.isAccepted()
    drop = QDropEvent(QPointF(9, 9), Qt.DropAction.CopyAction, mime, LEFT, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(here.dock, drop)
    assert (here.given.name, here.given.size) == ("dropped.png", (33, 44))

    menu = here.dock.results.menu()
    menu.aboutToShow.emit()
    assert not menu.actions()[0].isEnabled()
    here.others = (column_of(noise(26, 27), column_id=7, title="Other"),)
    here.feed()
    menu.aboutToShow.emit()
    (action,) = menu.actions()
    assert action.text() == "2. Other"
    action.trigger()
    assert (here.given.name, here.given.size) == ("stub result", (26, 27))
    # The one stays when another is chosen.
    here.dock.which.setCurrentIndex(1)
    here.feed()
    here.dock.take(noise(12, 13))
    assert set(dict(here.column.inputs)) == {"second", "third"}


def test_what_came_too_late_is_for_nobody(here: Watched) -> None:
    kept: list[AskOnce] = []
    here.dock.intention.disconnect(here._carry)
    here.dock.intention.connect(kept.append)
    here.dock.take(image_input(noise(9, 9)))
    here.column = column(method="tiling")
    here.feed()
    (late,) = kept
    late.done(late.compute(lambda: False))
    assert kept == [late]


def test_a_mixture_in_the_window(qtbot: Any, open_window: Callable[..., Explorer], texture: Path) -> None:
    from tests.gui.conftest import ids, wait_idle
    from texlab_core.engine.run import run

    params = find_method("mixture").params(iterations=1, scales=2)
    explorer = open_window(str(texture), [("mixture", params)])
    (column_id,) = ids(explorer)
    failed = explorer.controller.column_scene(column_id)
    assert failed is not None
    assert failed.message == "Mixture needs the input second, and none was given."
    explorer.window.docks["inputs"].raise_()
    dock = explorer.hosts["inputs"].dock
    assert isinstance(dock, InputsDock)
    qtbot.waitUntil(lambda: dock.which.count() == 3)
    dock.take("gallery:stochastic-rock")

    def made() -> bool:
        found = explorer.controller.column_scene(column_id)
        return found is not None and found.result is not None

    qtbot.waitUntil(made)
    wait_idle(qtbot, explorer)
    dock._crop(Crop(0, 0, 40, 40))
    qtbot.waitUntil(lambda: dock.given is not None and dock.given.size == (40, 40))
    wait_idle(qtbot, explorer)
    # The weight follows the hand, and the end of the slider is the plain texture of the second exemplar.
    slider = explorer.window.findChild(QSlider, "slider-weight")
    drag(qtbot, slider, [handle_point(slider), handle_point(slider, 0.7), handle_point(slider, 1.0)])
    wait_idle(qtbot, explorer)
    scene = explorer.controller.column_scene(column_id)
    assert scene is not None
    assert scene.result is not None
    assert scene.result.job.params.weight == 1.0
    np.testing.assert_array_equal(scene.result.image, run(scene.result.job).image)
