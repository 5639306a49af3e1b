"""The gallery's pictures, made in the background."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject

from texlab.runs.worker import Task, Worker
from texlab.style.pictures import to_picture
from texlab_core.images.gallery import gallery

if TYPE_CHECKING:
    from texlab.style.pictures import Picture
    from texlab.window.gallery import GalleryView

SIDE = 48


class Thumbnails(QObject):
    """Lists the textures of the gallery at once, and shows their pictures as they are made."""

    def __init__(self, view: GalleryView, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._view = view
        entries = gallery()
        view.show_entries(
            (
                entry.uri,
                entry.cls,
                entry.title,
                f"{entry.title}: {entry.author}, {entry.licence}",
                " ".join(entry.keywords),
            )
            for entry in entries
        )
        self._worker = Worker("thumbnails", parent=self)
        self._worker.progressed.connect(self._show)
        self._worker.finished.connect(self._show)
        self._worker.submit(partial(make_thumbnails, [entry.uri for entry in entries]))

    def close(self) -> None:
        """Stop and wait for the thread's end."""
        self._worker.close()

    def _show(self, made: tuple[tuple[str, Picture], ...]) -> None:
        for name, picture in made[self._view.thumbnails :]:
            self._view.set_thumbnail(name, picture)


def make_thumbnails(names: list[str], task: Task) -> tuple[tuple[str, Picture], ...]:
    """Return small pictures of textures, reporting those made so far on the way."""
    import cv2

    from texlab_core.images.exemplar import as_exemplar

    made: list[tuple[str, Picture]] = []
    for name in names:
        if task.should_stop():
            break
        picture = to_picture(as_exemplar(name).pixels)
        side = min(picture.shape[:2])
        small = cv2.resize(picture[:side, :side], (SIDE, SIDE), interpolation=cv2.INTER_AREA)
        made.append((name, small.astype(np.uint8)))
        if task.due():
            task.progress(tuple(made))
    return tuple(made)
