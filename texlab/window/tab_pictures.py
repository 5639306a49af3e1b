"""What a tab shows, taken away as a picture: copied, saved at a chosen size, dragged into another program."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QMimeData, QPoint, QStringListModel, Qt, QUrl
from PySide6.QtGui import QDrag, QGuiApplication, QImage, QPainter
from PySide6.QtWidgets import QAbstractSpinBox, QCheckBox, QComboBox, QDialog, QFileDialog, QWidget

from texlab.docks.frame import FramedDock
from texlab.style.tab_picture import SUFFIXES, picture_texts
from texlab.style.vector_picture import Recording, painted_anew, recorded
from texlab.window.tab_picture_dialog import LARGEST, SizeDialog

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.storage.settings import Settings
    from texlab.style.pictures import Picture
    from texlab.window.main_window import MainWindow

SHARPER = 2


class TabPictures:
    """Grabs a tab in the thread of the window and encodes it in another one."""

    def __init__(self, window: MainWindow, settings: Settings, controller: Controller) -> None:
        self._window = window
        self._settings = settings
        self._controller = controller
        self._newest = 0
        self._folder: Path | None = None

    def close(self) -> None:
        """Remove what was made for drags."""
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)

    def take(self, name: str, how: str) -> None:
        """Do what an intention says with the dock of this name: ``copy``, ``save`` or ``drag``."""
        dock = self._window.findChild(QWidget, f"dock-{name}")
        {"copy": self._copy, "save": self._save, "drag": self._drag}[how](dock)

    def take_front(self, how: str) -> None:
        """Do it with the tab that is in front."""
        self.take(self.front() or "", how)

    def front(self) -> str | None:
        """Return the name of the dock that is looked at; of parts within a dock, of the innermost."""
        found = [
            widget
            for widget in self._window.findChildren(FramedDock)
            if widget.isVisible() and not widget.visibleRegion().isEmpty()
        ]
        focus = self._window.focusWidget()
        chosen = next((each for each in found if focus is not None and each.isAncestorOf(focus)), None)
        chosen = chosen or (found[0] if found else None)
        return None if chosen is None else chosen.name

    # Taking.

    def _copy(self, dock: Any) -> None:
        def done(data: bytes) -> None:
            mime = clean_mime()
            mime.setData("image/png", data)
            QGuiApplication.clipboard().setMimeData(mime)
            self._controller.said.emit(f"Copied the picture of {dock.title}.")

        self._encode(dock, ".png", None, done)

    def _save(self, dock: Any) -> None:
        part = self._part(dock)
        if part is None:
            return
        dialog = SizeDialog(dock.title, part.width(), part.height(), self._window)
        if dialog.exec() != QDialog.DialogCode.Accepted:
            return
        folder = Path(self._settings.text("save-folder"))
        kinds = "PNG (*.png);;SVG, with letters and lines that stay sharp (*.svg)"
        path, kind = QFileDialog.getSaveFileName(
            self._window, f"Save the picture of {dock.title}", str(folder / f"{dock.name}.png"), kinds
        )
        if not path:
            return
        self._settings.values["save-folder"] = str(Path(path).parent)
        target = Path(path)
        if target.suffix.lower() not in SUFFIXES:
            target = Path(path + (".svg" if kind.startswith("SVG") else ".png"))
            if target.exists():
                # The dialog has not asked about this one.
                self._controller.problem.emit(f"{target} is already there: choose it to replace it.")
                return

        def done(_: bytes) -> None:
            self._controller.said.emit(f"Saved {target}, with how it was made.")

        self._encode(dock, target.suffix.lower(), dialog.width_chosen, done, target)

    def _drag(self, dock: Any) -> None:
        if self._folder is None:
            self._folder = Path(tempfile.mkdtemp(prefix="texlab-"))
        target = self._folder / f"{getattr(dock, 'name', 'picture')}.png"

        def done(data: bytes) -> None:
            if not QGuiApplication.mouseButtons() & Qt.MouseButton.LeftButton:
                return
            mime = QMimeData()
            mime.setData("image/png", data)
            mime.setUrls([QUrl.fromLocalFile(str(target))])
            drag = QDrag(self._window)
            drag.setMimeData(mime)
            drag.exec(Qt.DropAction.CopyAction)

        self._encode(dock, ".png", None, done, target)

    def _part(self, dock: Any) -> QWidget | None:
        """Return what of a dock is its picture, or say why there is none."""
        if not isinstance(dock, FramedDock):
            self._controller.problem.emit("No tab is open: choose one, then take its picture.")
            return None
        if dock.message is not None:
            self._controller.problem.emit(f"{dock.title} shows no picture yet: {dock.message}")
            return None
        return dock.body

    def _encode(self, dock: Any, suffix: str, width: int | None, done: Any, target: Path | None = None) -> None:
        part = self._part(dock)
        if part is None:
            return
        width = part.width() * SHARPER if width is None else width
        taken = recorded(part, dock.title, width) if suffix == ".svg" else grab(part, width)
        scene = self._controller.scene()
        selected = scene.selected
        result = None if selected is None else selected.result
        made = {
            "tab": dock.name,
            "stage": None if scene.stage is None else scene.stage.name,
            "controls": control_values(dock),
        }
        self._newest += 1
        number = self._newest

        def work(task: Task) -> bytes:
            data = encoded(taken, picture_texts(made, result))
            if target is not None:
                from texlab_core.files.whole import write_whole

                write_whole(target, data)
            return data

        def told(data: bytes) -> None:
            # A later one may have been quicker.
            if number == self._newest or target is not None:
                done(data)

        self._controller.once("picture", work, told)


def grab(widget: QWidget, width: int) -> QImage:
    """Return a widget painted this many pixels wide: letters and lines are drawn at that size, not enlarged."""
    width = min(width, LARGEST)
    factor = width / max(widget.width(), 1)
    image = QImage(width, max(round(widget.height() * factor), 1), QImage.Format.Format_RGB32)
    image.fill(widget.palette().window().color())
    painter = QPainter(image)
    painter.scale(factor, factor)
    with painted_anew(widget, factor):
        widget.render(painter, QPoint(0, 0))
    painter.end()
    return image


def encoded(taken: QImage | Recording, texts: Mapping[str, str]) -> bytes:
    """Return the bytes of a PNG of an image, of an SVG of a recording, with texts inside."""
    from texlab_core.images.formats.writing import encode_png

    return taken.svg(texts) if isinstance(taken, Recording) else encode_png(as_picture(taken), texts)


def as_picture(image: QImage) -> Picture:
    """Return (H, W, 3) uint8 of an image of 32 bits."""
    values = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine() // 4, 4)
    # In memory blue comes first.
    return np.ascontiguousarray(values[:, : image.width(), 2::-1])


def control_values(dock: FramedDock) -> dict[str, Any]:
    """Return how the controls of a dock are set, by their names."""
    found: dict[str, Any] = {}
    for control in dock.findChildren(QWidget):
        name = control.objectName()
        if not name.startswith(dock.name):
            continue
        if isinstance(control, QComboBox):
            found[name] = control.currentText()
        elif isinstance(control, QCheckBox):
            found[name] = control.isChecked()
        elif isinstance(control, QAbstractSpinBox):
            found[name] = control.text()
    return found


def clean_mime() -> QMimeData:
    """Return an empty one that Qt has made: the clipboard keeps it longer than Python lives."""
    model = QStringListModel([""])
    mime = model.mimeData([model.index(0)])
    mime.clear()
    return mime
