"""What a tab shows as a picture: of any tab, at any size, with its recipe; encoded outside the window's thread."""

from __future__ import annotations

import base64
import io
import json
import threading
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from dock_scenes import column_of, feed, noise, scene_of, shown
from PIL import Image
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QDrag, QGuiApplication, QImage
from PySide6.QtWidgets import QDialog, QFileDialog, QWidget

from tests.gui.conftest import wait_idle
from texlab.docks.bands.pyramid import PyramidDock
from texlab.state.intentions import TakePicture
from texlab.style import tab_picture
from texlab.style.tab_picture import TAB_KEY, encode_picture
from texlab.window import tab_pictures
from texlab.window.tab_picture_dialog import SizeDialog
from texlab.window.tab_pictures import as_picture, grab
from texlab_core.documents.reading import KEY


def test_pixels_come_out_as_they_are():
    image = QImage(3, 2, QImage.Format.Format_RGB32)
    for row in range(2):
        for column in range(3):
            image.setPixelColor(column, row, QColor(10 * column, 20 * row, 200))
    rows, columns = np.mgrid[:2, :3]
    assert np.array_equal(as_picture(image), np.stack([10 * columns, 20 * rows, 0 * rows + 200], 2))


def test_letters_are_drawn_at_the_size_wanted(qtbot):
    dock = shown(qtbot, PyramidDock())
    feed(dock, scene_of(column_of(noise()), exemplar=noise(seed=2)))
    small, large = (as_picture(grab(dock.body, width)) for width in (dock.body.width(), 2 * dock.body.width()))
    assert large.shape == (2 * small.shape[0], 2 * small.shape[1], 3)
    # Enlarged pixels would be equal in pairs everywhere.
    assert not np.array_equal(large[::2, ::2], large[1::2, 1::2])


@pytest.mark.parametrize("suffix", [".png", ".svg"])
def test_what_is_encoded_is_read_again(suffix):
    picture = np.random.default_rng(1).integers(0, 256, (5, 7, 3), np.uint8)
    texts = {TAB_KEY: '{"tab":"a <b> & c"}'}
    data = encode_picture(suffix, picture, texts)
    if suffix == ".svg":
        root = ET.fromstring(data)
        assert (root.get("width"), root.get("height")) == ("7", "5")
        space = {"s": "http://www.w3.org/2000/svg"}
        assert json.loads(root.find("s:metadata", space).text) == texts
        data = base64.b64decode(root.find("s:image", space).get("href").removeprefix("data:image/png;base64,"))
    with Image.open(io.BytesIO(data)) as found:
        assert np.array_equal(np.asarray(found), picture)
        assert found.text == texts


def test_other_suffixes_are_refused():
    with pytest.raises(ValueError, match=r"\.png or \.svg, not as \.gif"):
        encode_picture(".gif", np.zeros((2, 2, 3), np.uint8), {})


def test_the_handle_copies_on_a_click_and_drags(qtbot):
    dock, wanted = shown(qtbot, PyramidDock()), []
    dock.intention.connect(wanted.append)
    left = Qt.MouseButton.LeftButton
    qtbot.mouseClick(dock.handle, left)
    assert wanted == [TakePicture("pyramid", "copy")]
    qtbot.mousePress(dock.handle, left, pos=QPoint(5, 5))
    qtbot.mouseMove(dock.handle, QPoint(7, 5))
    assert len(wanted) == 1
    qtbot.mouseMove(dock.handle, QPoint(60, 30))
    qtbot.mouseMove(dock.handle, QPoint(90, 30))
    qtbot.mouseRelease(dock.handle, left, pos=QPoint(90, 30))
    assert wanted[1:] == [TakePicture("pyramid", "drag")]


@pytest.fixture
def encoders(monkeypatch):
    """Threads in which pictures were encoded."""
    found, usual = [], tab_picture.encode_picture

    def noted(*args):
        found.append(threading.current_thread())
        return usual(*args)

    monkeypatch.setattr(tab_pictures, "encode_picture", noted)
    return found


def test_every_tab_is_copied_saved_and_dragged(explorer, qtbot, tmp_path, monkeypatch, encoders):
    window, dragged = explorer.window, []
    window.raise_dock("histograms")
    wait_idle(qtbot, explorer)
    QGuiApplication.clipboard().setText("something else")
    explorer.tabs.take_front("copy")
    qtbot.waitUntil(lambda: QGuiApplication.clipboard().mimeData().hasFormat("image/png"))
    data = bytes(QGuiApplication.clipboard().mimeData().data("image/png").data())
    with Image.open(io.BytesIO(data)) as found:
        assert json.loads(found.text[TAB_KEY])["tab"] == "histograms"
        assert json.loads(found.text[KEY])["method"] == "heeger-bergen"
    monkeypatch.setattr(SizeDialog, "exec", lambda self: (self.box.setValue(900), QDialog.DialogCode.Accepted)[1])
    for suffix in (".png", ".svg"):
        target = tmp_path / f"tab{suffix}"
        monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_, target=target: (str(target), ""))
        with qtbot.waitSignal(explorer.controller.said):
            window.actions_by_name["save-tab"].trigger()
        assert target.exists()
    with Image.open(tmp_path / "tab.png") as found:
        assert found.size[0] == 900
    # Dropped on the window, it gives the recipe back.
    from texlab_core.documents.record import read_recipe

    assert read_recipe(tmp_path / "tab.png").method == "heeger-bergen"

    def drag(self, *_):
        mime = self.mimeData()
        dragged.append((mime.urls()[0].toLocalFile(), mime.hasFormat("image/png")))

    monkeypatch.setattr(QDrag, "exec", drag)
    monkeypatch.setattr(QGuiApplication, "mouseButtons", lambda: Qt.MouseButton.LeftButton)
    explorer.tabs.take("histograms", "drag")
    qtbot.waitUntil(lambda: bool(dragged))
    with Image.open(dragged[0][0]) as found:
        assert found.size[0] == 2 * window.findChild(QWidget, "histograms-body").width()
    assert dragged[0][1]
    assert len(encoders) == 4
    assert threading.main_thread() not in encoders


def test_a_tab_without_a_picture_says_so(open_window, qtbot):
    explorer = open_window(None, wait=False)
    said = []
    explorer.controller.problem.connect(said.append)
    for dock in explorer.docks:
        explorer.window.docks[dock.name].hide()
    explorer.tabs.take_front("copy")
    assert said == ["No tab is open: choose one, then take its picture."]
