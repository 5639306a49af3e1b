"""Writes lessons of the user's own: what the window shows as a step, a changed lesson, one after the other."""

from __future__ import annotations

import dataclasses
import threading
from functools import partial
from typing import TYPE_CHECKING, Any

from texlab.runs.worker import Worker
from texlab.state.lessons import Draft, file_of, source_of, step_of
from texlab.storage.sessions import writing
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from texlab.docks.host import DockHost
    from texlab.runs.controller import Controller
    from texlab.state.intentions import OpenLesson
    from texlab.window.main_window import MainWindow
    from texlab_core.documents.lessons import Lesson, LessonStep
    from texlab_core.engine.inputs import ImageInput

LESSONS = "lessons"


def tab_of(step: LessonStep) -> str:
    """Return the name of the tab that a step opens."""
    return LESSONS if step.tab is None else step.tab.name


class LessonDesk:
    """Makes steps of what there is to see, and writes lessons in the background.

    Parameters
    ----------
    folder
        Where the user's own lessons are; made when the first is written.
    """

    def __init__(
        self, window: MainWindow, controller: Controller, hosts: Mapping[str, DockHost], folder: Path
    ) -> None:
        self._window = window
        self._controller = controller
        self._hosts = hosts
        self.folder = folder
        # What waits to be written, by name; it is taken by the thread that writes.
        self._waiting: dict[str, tuple[Lesson, ImageInput | None]] = {}
        # The tab that was looked at before the lessons were: what is kept is kept from there.
        self._tab = ""
        self._told: dict[str, Callable[[], None]] = {}
        # What this window has last read or written of each file; another window may have written since.
        self._known: dict[str, Lesson] = {}
        self._moved: dict[str, str] = {}
        self.moved: Callable[[str, str], None] = lambda name, free: None
        """Told when a lesson goes on under another name, since its file was changed by somebody else."""
        self._said: set[str] = set()
        self._lock = threading.Lock()
        self._worker = Worker("lessons", parent=window)
        self._worker.finished.connect(self._written)
        self._worker.failed.connect(controller.problem)

    def note(self, name: str, lesson: Lesson) -> None:
        """Take note of a lesson of the user's own that was just read."""
        with self._lock:
            self._known[name] = lesson
            self._moved.pop(name, None)

    def current(self, name: str) -> str:
        """Return the name under which a lesson goes on."""
        with self._lock:
            return self._moved.get(name, name)

    def watch_tabs(self) -> None:
        """Take note of the tab that is in front, from now on: the window has its tabs."""
        for name, frame in self._window.docks.items():
            if name in self._hosts and name != LESSONS:
                frame.visibilityChanged.connect(partial(self._saw, name))

    def step(self, name: str, sentence: str) -> LessonStep:
        """Return what the window shows as a step of the lesson of this name; LessonError when it cannot be one."""
        sample = self._controller.session.state.sample
        file = "" if sample is None else f"{name}/{file_of(sample.source)}"
        return step_of(self._draft(), sentence, file)

    def free_name(self, title: str) -> str:
        """Return a name that no lesson of the user's own has."""
        stem = "".join(sign if sign.isalnum() else "-" for sign in title.lower()).strip("-") or "lesson"
        names = (stem, *(f"{stem}-{number}" for number in range(2, 1000)))
        return next(each for each in names if not (self.folder / f"{each}.json").exists())

    def write(self, name: str, lesson: Lesson, done: Callable[[], None], *, pictures: bool = False) -> None:
        """Write a lesson, then call ``done``; of several that wait the newest alone is written.

        A file that was changed by somebody else since this window has seen it stays as it is: the lesson goes on
        under a name of its own.

        Parameters
        ----------
        name
            Of its file, without suffix.
        lesson
            What is written.
        done
            Called in the window's thread, unless a newer one took its place.
        pictures
            With the exemplar that the window shows beside it, unless that is one of the gallery's.
        """
        sample = self._controller.session.state.sample
        image = sample.source if pictures and sample is not None else None
        with self._lock:
            before = self._waiting.get(name)
            self._waiting[name] = lesson, image or (before[1] if before else None)
        self._told[name] = done
        self._worker.submit(self._work, patient=True)

    def close(self) -> None:
        """Wait until everything is written: what is changed while the window closes is written too."""
        self._worker.finish()

    def _work(self, _: Any) -> list[tuple[str, str]]:
        names: list[tuple[str, str]] = []
        while True:
            with self._lock:
                if not self._waiting:
                    return names
                name = next(iter(self._waiting))
                lesson, image = self._waiting.pop(name)
            names.append((name, self._write_one(name, lesson, image)))

    def _write_one(self, name: str, lesson: Lesson, image: ImageInput | None) -> str:
        """Write a lesson; return the name under which it is kept."""
        from texlab_core.documents.lessons import write_lesson

        self.folder.mkdir(parents=True, exist_ok=True)
        if image is not None and source_of(image, "") == "":
            save_picture(image, self.folder / name / file_of(image))
        # No other window writes between the look and the writing.
        with writing(LESSONS):
            kept = self.current(name)
            if self._is_changed(kept):
                kept = self.free_name(kept)
            write_lesson(dataclasses.replace(lesson, folder=self.folder), self.folder / f"{kept}.json")
        with self._lock:
            self._known[kept] = lesson
            if kept != name:
                self._moved[name] = kept
        return kept

    def _is_changed(self, name: str) -> bool:
        """Return whether a file holds something else than what this window has last seen there."""
        from texlab_core.documents.lessons import read_lesson

        path = self.folder / f"{name}.json"
        if not path.exists():
            return False
        with self._lock:
            known = self._known.get(name)
        try:
            return known is None or read_lesson(path).to_json() != known.to_json()
        except InputError:
            # What somebody is writing by hand stays too.
            return True

    def _written(self, names: list[tuple[str, str]]) -> None:
        for name, kept in names:
            if kept != name and kept not in self._said:
                self._said.add(kept)
                self.moved(name, kept)
                self._controller.problem.emit(
                    f"The lesson {name} was changed by another window or program, and stays as it is there; what"
                    f" is changed here is kept in {kept}."
                )
        for name, _ in dict.fromkeys(names):
            with self._lock:
                told = None if name in self._waiting else self._told.pop(name, None)
            if told is not None:
                told()

    def _saw(self, name: str, shown: bool) -> None:
        # Of the one that was in front from the beginning only its going is told.
        if shown or not self._tab:
            self._tab = name

    def _draft(self) -> Draft:
        name = self._window.front_dock()
        name = self._tab if name == LESSONS else name
        host = self._hosts.get(name)
        controller, session = self._controller, self._controller.session
        probe = controller.pointing.probe
        kept = probe is not None and probe.pinned
        return Draft(
            session.state,
            session.selected_id,
            (probe.column_id, probe.row, probe.column) if probe is not None and kept else None,
            "" if host is None else name,
            {} if host is None else host.dock.settings(),
            self._window.actions_by_name["tile"].isChecked(),
        )


def read(wanted: OpenLesson, folder: Path | None) -> Lesson:
    """Read a lesson (in the background)."""
    from texlab_core.documents.lessons import read_lesson
    from texlab_core.lessons.shelf import find

    return read_lesson(folder / f"{wanted.name}.json") if wanted.own and folder is not None else find(wanted.name)


def save_picture(image: ImageInput, path: Path) -> None:
    """Write a step's exemplar with its transparency beside its lesson, unless it is there (in the background)."""
    import numpy as np

    from texlab_core.files.whole import write_whole
    from texlab_core.images.formats.writing import encode_png

    if not path.exists():
        pixels = image.pixels
        if image.alpha is not None:
            pixels = np.concatenate([np.broadcast_to(pixels, (*image.size, 3)), image.alpha], 2)
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, encode_png(np.rint(pixels * 255).astype(np.uint8)))
