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
from PySide6.QtCore import QByteArray, QPoint, QSize, Qt
from PySide6.QtGui import QColor, QDrag, QGuiApplication, QImage, QPainter
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QDialog, QFileDialog, QWidget

from tests.gui.conftest import wait_idle
from texlab.docks.bands.histograms import HistogramsDock
from texlab.docks.bands.pyramid import PyramidDock
from texlab.docks.spectral.spectrum import SpectrumDock
from texlab.state.intentions import TakePicture
from texlab.style.tab_picture import TAB_KEY
from texlab.style.theme import LIGHT
from texlab.style.vector_picture import recorded
from texlab.widgets.plots import Plot
from texlab.window import tab_pictures
from texlab.window.tab_picture_dialog import SizeDialog
from texlab.window.tab_pictures import as_picture, encoded, grab
from texlab_core.documents.reading import KEY

SVG = "{http://www.w3.org/2000/svg}"


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


def test_a_png_has_its_texts():
    image = QImage(7, 5, QImage.Format.Format_RGB32)
    image.fill(QColor(10, 120, 200))
    texts = {TAB_KEY: '{"tab":"a <b> & c"}'}
    with Image.open(io.BytesIO(encoded(image, texts))) as found:
        assert found.size == (7, 5)
        assert found.getpixel((3, 3)) == (10, 120, 200)
        assert found.text == texts


def drawn(data, size):
    """An SVG as another program would show it."""
    shown = QImage(size, QImage.Format.Format_RGB32)
    painter = QPainter(shown)
    QSvgRenderer(QByteArray(data)).render(painter)
    painter.end()
    return as_picture(shown)


def coarse(picture):
    """(H // 4, W // 4, 3) means."""
    height, width = picture.shape[0] // 4, picture.shape[1] // 4
    return picture[: 4 * height, : 4 * width].reshape(height, 4, width, 4, 3).mean((1, 3))


def svg_of(dock, texts=None, width=1800):
    """The parts of a tab's SVG: the root, and all elements by their names."""
    # A table lays its columns out on the next turn of the event loop.
    QGuiApplication.processEvents()
    data = encoded(recorded(dock.body, dock.title, width), texts or {})
    root = ET.fromstring(data)
    parts = {}
    for each in root.iter():
        parts.setdefault(each.tag.removeprefix(SVG), []).append(each)
    return data, root, parts


def pixels_inside(parts):
    """Width and height of the pictures that an SVG has inside, as they are encoded."""
    found = []
    for each in parts.get("image", []):
        inside = each.get("{http://www.w3.org/1999/xlink}href").removeprefix("data:image/png;base64,")
        with Image.open(io.BytesIO(base64.b64decode(inside))) as picture:
            found.append(picture.size)
    return found


def test_an_svg_of_plots_and_tables_is_letters_and_lines_alone(qtbot):
    dock = shown(qtbot, HistogramsDock())
    feed(dock, scene_of(column_of(noise()), exemplar=noise(seed=2)))
    texts = {TAB_KEY: '{"tab":"a <b> & c"}'}
    data, root, parts = svg_of(dock, texts)
    width, height = dock.body.width(), dock.body.height()
    assert root.get("viewBox") == f"0 0 {width} {height}"
    assert (root.get("width"), root.get("height")) == ("1800", str(round(1800 * height / width)))
    assert json.loads(parts["metadata"][0].text) == texts
    assert parts["title"][0].text == dock.title
    said = {(each.text or "").strip() for each in parts["text"]}
    # The axes, the heads of the table and its numbers are words that can be searched for.
    assert {"luma", "exemplar", "result", "skewness"} <= said
    assert dock.table.item(0, 0).text() in said
    assert len(parts["path"]) > 10
    assert "image" not in parts
    # It looks as the tab does, but for the edges of letters.
    one, other = (coarse(each) for each in (drawn(data, QSize(width, height)), as_picture(grab(dock.body, width))))
    assert np.abs(one - other).mean() < 2
    assert np.abs(one - coarse(np.full((height, width, 3), 255))).mean() > 10


def test_pictures_in_an_svg_keep_the_pixels_that_they_have(qtbot):
    dock = shown(qtbot, SpectrumDock())
    feed(dock, scene_of(column_of(noise()), exemplar=noise(seed=2)))
    _, _, parts = svg_of(dock)
    sizes = pixels_inside(parts)
    # The two spectra, of 64 x 48 frequencies; the colour bar has one pixel across.
    assert sizes.count((64, 48)) == 2
    assert all(size == (64, 48) or size[0] == 1 for size in sizes)
    assert any("cycles per pixel" in (each.text or "") for each in parts["text"])


def test_points_are_circles_at_any_size(qtbot):
    plot = Plot("plot", "Points")
    qtbot.addWidget(plot)
    plot.resize(300, 200)
    plot.set_theme(LIGHT)
    plot.show()
    plot.points([1.0, 2.0, 3.0], [1.0, 3.0, 2.0], "result")
    plot.fit()
    before = as_picture(grab(plot, 300))
    root = ET.fromstring(recorded(plot, "Points", 300).svg({}))
    assert not root.findall(f".//{SVG}image")
    # What the screen shows is as it was.
    assert np.array_equal(as_picture(grab(plot, 300)), before)


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
    found, usual = [], tab_pictures.encoded

    def noted(*args):
        found.append(threading.current_thread())
        return usual(*args)

    monkeypatch.setattr(tab_pictures, "encoded", noted)
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
    root = ET.parse(tmp_path / "tab.svg").getroot()
    assert root.get("width") == "900"
    assert json.loads(json.loads(root.find(f"{SVG}metadata").text)[KEY])["method"] == "heeger-bergen"
    assert root.findall(f".//{SVG}text")
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
    for name in explorer.hosts:
        explorer.window.docks[name].hide()
    explorer.tabs.take_front("copy")
    assert said == ["No tab is open: choose one, then take its picture."]
