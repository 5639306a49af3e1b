"""The lessons that come with the program, and those of a folder."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from texlab_core.documents.lesson_parts import LessonError
from texlab_core.documents.lessons import lesson_from_text, read_lesson
from texlab_core.files.resources import resource
from texlab_core.files.strict_json import shorten
from texlab_core.files.wording import did_you_mean

if TYPE_CHECKING:
    from pathlib import Path

    from texlab_core.documents.lessons import Lesson

SUFFIX = ".json"


@functools.cache
def bundled() -> dict[str, Lesson]:
    """Return the lessons that come with the program by name, in the order of their files."""
    folder = resource("lessons")
    files = sorted(each.name for each in folder.iterdir() if each.name.endswith(SUFFIX))
    found = {}
    for file in files:
        # The number in front only says the order.
        name = file.removesuffix(SUFFIX).partition("-")[2]
        found[name] = lesson_from_text(resource(f"lessons/{file}").read_bytes(), what=f"the lesson {name}")
    return found


def own(folder: Path) -> tuple[dict[str, Lesson], tuple[str, ...]]:
    """Return the usable lessons of a folder by their names, and one sentence for each file that is not."""
    found: dict[str, Lesson] = {}
    problems = []
    files = sorted(folder.glob(f"*{SUFFIX}")) if folder.is_dir() else []
    for file in files:
        try:
            found[file.stem] = read_lesson(file)
        except LessonError as bad:
            problems.append(str(bad))
    return found, tuple(problems)


def find(name: str) -> Lesson:
    """Return a lesson by the path of its file, or the name of one that comes with the program.

    Raises
    ------
    LessonError
        With one sentence, when there is none or it cannot be used.
    """
    if name.endswith(SUFFIX) or "/" in name or "\\" in name:
        return read_lesson(name)
    known = bundled()
    if name not in known:
        hint = did_you_mean(name, known) or f"there are {', '.join(known)}"
        raise LessonError(f"There is no lesson called {shorten(name)} ({hint}).")
    return known[name]
