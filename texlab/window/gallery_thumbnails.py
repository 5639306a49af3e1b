"""The gallery's pictures, made in the background."""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject

from texlab.runs.worker import Task, Worker
from texlab.storage.reading import open_source
from texlab.style.pictures import to_picture
from texlab_core.errors import InputError
from texlab_core.images.gallery import gallery

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab.storage.reading import Source
    from texlab.style.pictures import Picture
    from texlab.window.gallery import GalleryView
    from texlab_core.engine.steps import FloatImage

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
        self._strip = Worker("strip", parent=self)
        self._strip.progressed.connect(self._show_several)
        self._strip.finished.connect(self._show_several)

    def show_several(self, sources: Sequence[Source]) -> None:
        """Show what was opened together in the strip under the gallery."""
        self._view.strip.show_sources(sources)
        self._strip.submit(partial(make_several, tuple(sources)))

    def close(self) -> None:
        """Stop and wait for the threads' ends."""
        self._worker.close()
        self._strip.close()

    def _show_several(self, made: tuple[tuple[int, Picture | str], ...]) -> None:
        for place, shown in made:
            if isinstance(shown, str):
                self._view.strip.refuse(place, shown)
            else:
                self._view.strip.set_thumbnail(place, shown)

    def _show(self, made: tuple[tuple[str, Picture], ...]) -> None:
        for name, picture in made[self._view.thumbnails :]:
            self._view.set_thumbnail(name, picture)


def make_thumbnails(names: list[str], task: Task) -> tuple[tuple[str, Picture], ...]:
    """Return small pictures of textures, reporting those made so far on the way."""
    made: list[tuple[str, Picture]] = []
    for name in names:
        if task.should_stop():
            break
        made.append((name, _thumbnail(name)))
        if task.due():
            task.progress(tuple(made))
    return tuple(made)


def make_several(sources: Sequence[Source], task: Task) -> tuple[tuple[int, Picture | str], ...]:
    """Return a small picture of each source by its place, or the sentence that says why there is none."""
    made: list[tuple[int, Picture | str]] = []
    for place, source in enumerate(sources):
        if task.should_stop():
            break
        try:
            made.append((place, _small(open_source(source, task.should_stop).image.pixels)))
        except (InputError, OSError) as error:
            made.append((place, str(error)))
        task.progress(tuple(made))
    return tuple(made)


@cache
def _thumbnail(name: str) -> Picture:
    """Return the small picture of a texture of the gallery; every window of the program has the same."""
    from texlab_core.images.exemplar import as_exemplar

    made = _small(as_exemplar(name).pixels)
    made.flags.writeable = False
    return made


def _small(pixels: FloatImage) -> Picture:
    import cv2

    side = min(pixels.shape[:2])
    # What is reduced first need not be coloured whole.
    small = cv2.resize(pixels[:side, :side], (SIDE, SIDE), interpolation=cv2.INTER_AREA)
    return to_picture(np.float32(small).reshape(SIDE, SIDE, -1))
