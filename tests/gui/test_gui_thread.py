"""Nothing is encoded, decoded, hashed or written in the window's own thread, whatever the user does."""

from __future__ import annotations

import hashlib
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QGuiApplication, QImage, QPixmap
from PySide6.QtWidgets import QApplication, QFileDialog

import texlab
import texlab_core
from tests.gui.conftest import hb, ids, wait_idle
from texlab.widgets.pasted import pixels_of
from texlab_core.engine.inputs import ImageInput, hash_arrays

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

    from texlab.app.explorer import Explorer

CONTROL = Qt.KeyboardModifier.ControlModifier
LEFT = Qt.MouseButton.LeftButton
WINDOW, CORE = (Path(package.__file__).parent for package in (texlab, texlab_core))
# Whoever enters these works on whole files or pictures.
HEAVY_CODE = tuple(
    str(place)
    for place in (
        CORE / "images" / "formats" / "reading.py",
        CORE / "images" / "formats" / "writing.py",
        CORE / "images" / "exemplar.py",
        CORE / "files" / "whole.py",
        CORE / "files" / "regular.py",
        CORE / "documents" / "record.py",
        CORE / "documents" / "reading.py",
        WINDOW / "storage" / "arrays.py",
        WINDOW / "style" / "pictures.py",
        Path(Image.__file__).parent,
        Path(np.__file__).parent / "lib",
    )
)
# Small questions that the window may ask there.
LIGHT = {"scaled_size", "describe_pixel", "named_with_suffix", "default_bits", "check_format", "reduction_note"}
# At most 128 x 128 pixels of one that is shown.
LIGHT |= {"thinned"}
LIGHT |= {"can_hold_alpha", "result_bits", "carried_alpha", "reason"}
HEAVY_CALLS = {"zlib", "_bz2", "_lzma", "cv2"}
HEAVY_OF_QT = {"save", "load", "convertToFormat", "scaled"}
# Of classes and of pictures alike.
DECODERS = {"fromData", "loadFromData"}
HASHED_BYTES = 4096


class Watch:
    """Notes what the window's thread does that belongs into another one."""

    def __init__(self) -> None:
        self.found: list[str] = []
        self._inside = 0

    def __call__(self, frame: FrameType, event: str, argument: Any) -> None:
        if event == "call":
            code = frame.f_code
            if (
                code.co_filename.startswith(HEAVY_CODE)
                and code.co_name[0] not in "<_"
                and code.co_name not in LIGHT
            ):
                caller = frame.f_back.f_code if frame.f_back is not None else code
                self.found.append(f"{code.co_filename}:{code.co_name} called by {caller.co_qualname}")
        elif event == "c_call":
            name, owner = argument.__name__, getattr(argument, "__self__", None)
            of_qt = name in DECODERS or (name in HEAVY_OF_QT and isinstance(owner, QImage | QPixmap))
            if of_qt or (getattr(argument, "__module__", None) or "").split(".")[0] in HEAVY_CALLS:
                self.found.append(f"{name} called by {frame.f_code.co_qualname}")


@pytest.fixture
def watch(monkeypatch: pytest.MonkeyPatch) -> Iterator[Watch]:
    """Watch the thread of the test, which is that of the window."""
    watch, here, sha256 = Watch(), threading.get_ident(), hashlib.sha256

    def hashed(data: Any = b"", **options: Any) -> Any:
        if threading.get_ident() == here and (not data or memoryview(data).nbytes > HASHED_BYTES):
            caller = sys._getframe(1)
            outer = caller.f_back.f_code.co_qualname if caller.f_back is not None else ""
            watch.found.append(f"sha256 called by {caller.f_code.co_qualname} from {outer}")
        return sha256(data, **options)

    monkeypatch.setattr(hashlib, "sha256", hashed)
    before = sys.getprofile()
    yield watch
    sys.setprofile(before)


def watched(watch: Watch, do: Callable[[], Any]) -> None:
    """Do something under watch."""
    sys.setprofile(watch)
    try:
        do()
    finally:
        sys.setprofile(None)


def drop(window: Any, mime: QMimeData, action: Qt.DropAction = Qt.DropAction.CopyAction) -> QDropEvent:
    plain = Qt.KeyboardModifier.NoModifier
    enter = QDragEnterEvent(QPoint(200, 200), action, mime, LEFT, plain)
    QApplication.sendEvent(window, enter)
    event = QDropEvent(QPointF(200, 200), action, mime, LEFT, plain)
    QApplication.sendEvent(window, event)
    return event


def picture(side: int) -> QImage:
    image = QImage(side, side, QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.darkCyan)
    image.setPixelColor(3, 5, Qt.GlobalColor.red)
    return image


def test_the_watch_sees_what_it_is_there_for(tmp_path: Path, watch: Watch) -> None:
    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.images.formats import writing

    path = tmp_path / "one.png"
    acts = (
        lambda: picture(8).save(str(path), "PNG"),
        lambda: as_exemplar(str(path)),
        lambda: writing.write_image(path, np.zeros((8, 8, 3))),
        lambda: QImage.fromData(path.read_bytes()),
        lambda: Image.open(path).load(),
        lambda: hash_arrays({"a": np.zeros(9)}),
    )
    for number, do in enumerate(acts):
        watch.found.clear()
        watched(watch, do)
        assert watch.found, number


@pytest.mark.slow
def test_the_window_leaves_all_work_on_files_and_pictures_to_others(
    qtbot: Any,
    open_window: Callable[..., Explorer],
    texture: Path,
    tmp_path: Path,
    watch: Watch,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    explorer = open_window(str(texture), [hb(), hb(iterations=1)])
    window, session = explorer.window, explorer.session
    target, other = tmp_path / "out.png", tmp_path / "other.png"
    picture(40).save(str(other))
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(target), ""))
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: ([str(texture), str(other)], ""))

    def settle() -> None:
        qtbot.waitUntil(lambda: explorer.idle and not explorer.autosave.busy)
        wait_idle(qtbot, explorer)

    def press(key: Qt.Key) -> None:
        qtbot.keyClick(window, key, CONTROL)

    def paste() -> None:
        QGuiApplication.clipboard().setImage(picture(300))
        press(Qt.Key.Key_V)
        qtbot.waitUntil(lambda: session.state.sample.source.size == (300, 300))
        settle()
        assert explorer.controller.exemplar is not None

    def bring() -> None:
        mime = QMimeData()
        mime.setImageData(picture(60))
        drop(window, mime)
        qtbot.waitUntil(lambda: session.state.sample.source.size == (60, 60))
        files = QMimeData()
        files.setUrls([QUrl.fromLocalFile(str(each)) for each in (other, texture)])
        drop(window, files)
        qtbot.waitUntil(lambda: session.state.sample.path == str(other))
        settle()

    def open_both() -> None:
        press(Qt.Key.Key_O)
        qtbot.waitUntil(lambda: session.state.sample.path == str(texture))
        settle()

    def copy() -> None:
        press(Qt.Key.Key_C)
        qtbot.waitUntil(lambda: QGuiApplication.clipboard().mimeData().hasFormat("image/png"))

    def save() -> None:
        press(Qt.Key.Key_S)
        qtbot.waitUntil(target.exists)
        settle()

    def keep_inputs() -> None:
        mask = np.zeros((48, 48, 1), np.float32)
        mask[4:9, 4:9] = 1
        given = ImageInput(mask, "mask", "0" * 64)
        session.set_inputs(ids(explorer)[0], (("mask", given),), "mask")
        settle()

    def use() -> None:
        explorer.handlers.column_command(ids(explorer)[1], "use")
        qtbot.waitUntil(lambda: session.state.sample.path is None)
        settle()

    steps: list[Callable[[], Any]] = [
        paste,
        bring,
        lambda: (
            press(Qt.Key.Key_O),
            qtbot.waitUntil(lambda: session.state.sample.path == str(texture)),
            settle(),
        ),
        copy,
        save,
        lambda: (press(Qt.Key.Key_Z), settle()),
        keep_inputs,
        use,
        window.close,
    ]
    for step in steps:
        watched(watch, step)
        assert not watch.found, "\n".join(watch.found[:12])
    assert target.exists()


def test_kept_inputs_are_read_elsewhere_at_the_start(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, watch: Watch
) -> None:
    from texlab_core.engine.registry import methods

    el = methods()["efros-leung"]
    first = open_window(str(texture), [("efros-leung", el.params.from_json({"window": 3}))], size=16)
    start = np.random.default_rng(3).random((16, 16, 3)).astype(np.float32)
    mask = np.zeros((16, 16, 1), np.float32)
    mask[4:9, 4:9] = 1
    given = tuple(
        (name, ImageInput(pixels, name, hash_arrays({"pixels": pixels})))
        for name, pixels in (("mask", mask), ("start", start))
    )
    first.session.set_inputs(ids(first)[0], given, "fill")
    wait_idle(qtbot, first)
    first.window.close()
    watch.found.clear()
    opened: list[Explorer] = []
    watched(watch, lambda: opened.append(open_window(None)))
    assert not [each for each in watch.found if "unpack" in each or "sha256" in each]
    back = dict(opened[0].session.state.columns[0].inputs)
    assert np.array_equal(back["start"].pixels, start)


@pytest.mark.parametrize(
    ("kind", "peak", "samples"),
    [
        ("Format_RGB32", 255, 3),
        ("Format_ARGB32", 255, 4),
        ("Format_RGBA64", 65535, 4),
        ("Format_RGBX64", 65535, 3),
    ],
)
def test_pasted_pixels_are_those_of_the_picture(kind: str, peak: int, samples: int) -> None:
    rng = np.random.default_rng(1)
    dtype = np.uint8 if peak == 255 else np.uint16
    values = rng.integers(0, peak + 1, (700, 401, 4)).astype(dtype)
    made = QImage.Format.Format_RGBA8888 if peak == 255 else QImage.Format.Format_RGBA64
    if samples == 3:
        values[..., 3] = peak
    image = QImage(values.tobytes(), 401, 700, values.strides[0], made).convertToFormat(
        getattr(QImage.Format, kind)
    )
    assert np.array_equal(pixels_of(image), values[..., :samples])


def test_gray_of_16_bits_is_pasted_as_it_is() -> None:
    values = np.arange(0, 65536, 7, dtype=np.uint16)[:9000].reshape(90, 100)
    image = QImage(values.tobytes(), 100, 90, 200, QImage.Format.Format_Grayscale16)
    assert np.array_equal(pixels_of(image), np.repeat(values[..., None], 3, axis=2))
