"""What comes in and goes out by dialogs and the clipboard."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QMimeData, QStringListModel
from PySide6.QtGui import QGuiApplication, QImage
from PySide6.QtWidgets import QFileDialog

from texlab.columns.status import known_numbers
from texlab.storage.projects import SUFFIX as PROJECT
from texlab.widgets.mime import brought_by
from texlab.widgets.plain import message_box
from texlab.window.save_kinds import chosen_bits, named, save_kinds
from texlab_core.engine.inputs import ImageInput
from texlab_core.engine.sizes import size_text
from texlab_core.images.formats.kinds import READABLE_SUFFIXES

if TYPE_CHECKING:
    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.storage.reading import Lacking
    from texlab.storage.settings import Settings
    from texlab.style.pictures import Picture
    from texlab.widgets.mime import Brought
    from texlab.window.main_window import MainWindow
    from texlab.window.opener import Opener


class Exchange:
    """Asks for files to open and to write, pastes and copies."""

    def __init__(self, window: MainWindow, settings: Settings, controller: Controller, opener: Opener) -> None:
        self._window = window
        self.settings = self._settings = settings
        self._controller = controller
        self._opener = opener
        self._copies = 0

    def ask_open(self) -> None:
        """Ask for images, codes or presets."""
        pattern = " ".join(f"*{suffix}" for suffix in READABLE_SUFFIXES)
        kinds = f"Images ({pattern});;Projects (*{PROJECT});;MSG codes and presets (*.json);;All files (*)"
        folder = self._settings.text("open-folder")
        paths, _ = QFileDialog.getOpenFileNames(self._window, "Open images", folder, kinds)
        if paths:
            self._settings.values["open-folder"] = str(Path(paths[0]).parent)
            self._opener.open_all(paths)

    def ask_locate(self, lacking: Lacking) -> None:
        """Ask where the images are that a saved result lacks, then open it with them."""
        name = Path(lacking.source).name
        kept = "; ".join(each.described for each in lacking.missing)
        box = message_box(
            self._window,
            "Locate exemplar",
            f"{name} does not hold {kept}.",
            "It is needed to make the result again.",
        )
        box.setObjectName("locate-box")
        locate = box.addButton("Locate ...", box.ButtonRole.AcceptRole)
        box.addButton(box.StandardButton.Cancel)
        locate.clicked.connect(lambda: self._locate(lacking))
        box.open()

    def _locate(self, lacking: Lacking) -> None:
        pattern = " ".join(f"*{suffix}" for suffix in READABLE_SUFFIXES)
        given = {}
        for each in lacking.missing:
            folder = str(Path(lacking.source).parent / Path(each.name).name)
            title = f"Where is {each.name}?"
            path, _ = QFileDialog.getOpenFileName(
                self._window, title, folder, f"Images ({pattern});;All files (*)"
            )
            if not path:
                return
            given[each.role] = path
        self._opener.open_located(lacking.source, given)

    def paste(self) -> None:
        """Take the image on the clipboard."""
        self.take(brought_by(QGuiApplication.clipboard().mimeData()))

    def take(self, brought: Brought) -> None:
        """Open what was dropped or pasted, or say why not."""
        if brought.sources:
            self._opener.open_all(brought.sources)
        else:
            self._tell(brought.refusal or "There is no image on the clipboard.")

    def export(self, column_id: int) -> None:
        """Ask where to save a result."""
        scene = self._controller.column_scene(column_id)
        if scene is None or scene.result is None:
            self._tell("The chosen column has no finished result to save.")
            return
        job = scene.result.job
        name = self._exemplar_name().replace("gallery:", "").replace("/", "-")
        suggested = f"{Path(name).stem}-{job.method}-{size_text(job.size, 'x')}-seed{job.seed}"
        exemplar = job.inputs.get("exemplar")
        depth = exemplar.depth if isinstance(exemplar, ImageInput) else 8
        kinds = save_kinds(depth, solid=scene.result.volume is not None)
        suggested = str(Path(self._settings.text("save-folder")) / suggested) + kinds[0].suffix
        lines = ";;".join(kind.label for kind in kinds)
        path, line = QFileDialog.getSaveFileName(self._window, "Save result", suggested, lines)
        if path:
            self._settings.values["save-folder"] = str(Path(path).parent)
            kind = next((kind for kind in kinds if kind.label == line), kinds[0])
            target = named(path, kind)
            if str(target) != path and target.exists():
                # The dialog has not asked about this one.
                self._tell(f"{target} is already there: choose it to replace it.")
                return
            self._opener.save(scene.result, str(target), chosen_bits(target, kind), known_numbers(scene))

    def copy(self, column_id: int) -> None:
        """Put a column's picture on the clipboard."""
        scene = self._controller.column_scene(column_id)
        if scene is None or scene.picture is None:
            self._tell("The chosen column has no picture to copy yet.")
            return
        picture = scene.picture
        self._copies += 1
        number = self._copies

        def work(task: Task) -> bytes:
            from texlab_core.images.formats.writing import encode_png

            return encode_png(picture)

        def done(png: bytes) -> None:
            # A later copy may have been quicker.
            if number == self._copies:
                put_on_clipboard(png, picture)
                self._controller.said.emit(f"Copied {picture.shape[1]} x {picture.shape[0]} pixels.")

        self._controller.once("copy", work, done)

    def _exemplar_name(self) -> str:
        sample = self._controller.session.state.sample
        return sample.source.name if sample is not None else "texture"

    def _tell(self, sentence: str) -> None:
        self._window.message_bar.tell(sentence, "problem")


def put_on_clipboard(png: bytes, picture: Picture) -> None:
    """Offer a picture to other programs as PNG that is encoded already.

    Where Qt has to make the system's own format of it (not on Linux), it gets the pixels as well.
    """
    mime = _mime_data()
    mime.setData("image/png", png)
    if sys.platform != "linux":
        height, width = picture.shape[:2]
        mime.setImageData(QImage(picture.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy())
    QGuiApplication.clipboard().setMimeData(mime)


def _mime_data() -> QMimeData:
    """Return an empty one that Qt itself has made.

    The clipboard keeps it beyond the end of Python, where one that Python made would crash the program.
    """
    model = QStringListModel([""])
    mime = model.mimeData([model.index(0)])
    mime.clear()
    return mime
