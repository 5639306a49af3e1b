"""What comes in and goes out by dialogs and the clipboard."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtGui import QGuiApplication, QImage
from PySide6.QtWidgets import QFileDialog

from texlab.widgets.mime import source_of
from texlab_core.engine.sizes import size_text
from texlab_core.images.formats.kinds import READABLE_SUFFIXES

if TYPE_CHECKING:
    from texlab.runs.controller import Controller
    from texlab.storage.settings import Settings
    from texlab.window.main_window import MainWindow
    from texlab.window.opener import Opener


class Exchange:
    """Asks for files to open and to write, pastes and copies."""

    def __init__(self, window: MainWindow, settings: Settings, controller: Controller, opener: Opener) -> None:
        self._window = window
        self._settings = settings
        self._controller = controller
        self._opener = opener

    def ask_open(self) -> None:
        """Ask for an image, a code or a preset."""
        pattern = " ".join(f"*{suffix}" for suffix in READABLE_SUFFIXES)
        kinds = f"Images ({pattern});;MSG codes and presets (*.json);;All files (*)"
        folder = self._settings.text("open-folder")
        path, _ = QFileDialog.getOpenFileName(self._window, "Open image", folder, kinds)
        if path:
            self._settings.values["open-folder"] = str(Path(path).parent)
            self._opener.open(path)

    def paste(self) -> None:
        """Take the image on the clipboard."""
        source = source_of(QGuiApplication.clipboard().mimeData())
        if source is None:
            self._tell("There is no image on the clipboard.")
        else:
            self._opener.open(source)

    def export(self, column_id: int) -> None:
        """Ask where to save a result."""
        scene = self._controller.column_scene(column_id)
        if scene is None or scene.result is None:
            self._tell("The chosen column has no finished result to save.")
            return
        job = scene.result.job
        name = self._exemplar_name().replace("gallery:", "").replace("/", "-")
        kinds = {"PNG (*.png)": ".png", "TIFF (*.tif)": ".tif", "JPEG (*.jpg)": ".jpg"}
        if scene.result.volume is not None:
            kinds = {"TIFF stack (*.tif)": ".tif", "NumPy array (*.npy)": ".npy"}
        usual = next(iter(kinds.values()))
        suggested = f"{Path(name).stem}-{job.method}-{size_text(job.size, 'x')}-seed{job.seed}{usual}"
        suggested = str(Path(self._settings.text("save-folder")) / suggested)
        path, kind = QFileDialog.getSaveFileName(self._window, "Save result", suggested, ";;".join(kinds))
        if path:
            self._settings.values["save-folder"] = str(Path(path).parent)
            target = path if Path(path).suffix else path + kinds.get(kind, usual)
            if target != path and Path(target).exists():
                # The dialog has not asked about this one.
                self._tell(f"{target} is already there: choose it to replace it.")
                return
            self._opener.save(scene.result, target)

    def copy(self, column_id: int) -> None:
        """Put a column's picture on the clipboard."""
        scene = self._controller.column_scene(column_id)
        if scene is not None and scene.picture is not None:
            height, width = scene.picture.shape[:2]
            data = scene.picture.tobytes()
            image = QImage(data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()
            QGuiApplication.clipboard().setImage(image)

    def _exemplar_name(self) -> str:
        sample = self._controller.session.state.sample
        return sample.source.name if sample is not None else "texture"

    def _tell(self, sentence: str) -> None:
        self._window.message_bar.tell(sentence, "problem")
