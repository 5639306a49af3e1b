"""Changes of a lesson of the user's own: steps moved, doubled, removed, words changed; and back again."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab_core.documents.lessons import Lesson, LessonStep

# What is said at a step; all the rest is what it shows.
WORDS = ("sentence", "note", "question", "answer", "try_this")
# How far undo reaches back.
MOST = 200


@dataclass(frozen=True, eq=False)
class Version:
    """A lesson as it was, and which of its steps was shown."""

    lesson: Lesson
    place: int


class Versions:
    """What undo and redo know of a lesson."""

    def __init__(self) -> None:
        self._before: list[Version] = []
        self._after: list[Version] = []

    @property
    def can_undo(self) -> bool:
        """Whether there is a version before."""
        return bool(self._before)

    @property
    def can_redo(self) -> bool:
        """Whether there is one that was undone."""
        return bool(self._after)

    def note(self, left: Version) -> None:
        """Remember the version that is being left by a change; what was undone is forgotten."""
        self._before = [*self._before, left][-MOST:]
        self._after.clear()

    def undo(self, now: Version) -> Version | None:
        """Return the version before this one."""
        return self._step(self._before, self._after, now)

    def redo(self, now: Version) -> Version | None:
        """Return the version that was undone."""
        return self._step(self._after, self._before, now)

    def clear(self) -> None:
        """Forget everything."""
        self._before.clear()
        self._after.clear()

    @staticmethod
    def _step(taken: list[Version], kept: list[Version], now: Version) -> Version | None:
        if not taken:
            return None
        kept.append(now)
        return taken.pop()


def with_steps(lesson: Lesson, order: tuple[int, ...]) -> Lesson:
    """Return the lesson with the steps of these indices, in this order."""
    return dataclasses.replace(lesson, steps=tuple(lesson.steps[place] for place in order))


def moved(count: int, place: int, by: int) -> tuple[tuple[int, ...], int]:
    """Return the order of ``count`` steps with one moved by some places, and where it is then."""
    order = list(range(count))
    there = min(max(place + by, 0), count - 1)
    order.insert(there, order.pop(place))
    return tuple(order), there


def doubled(count: int, place: int) -> tuple[tuple[int, ...], int]:
    """Return the order of ``count`` steps with one doubled, and where its copy is."""
    return (*range(place + 1), *range(place, count)), place + 1


def removed(count: int, place: int) -> tuple[tuple[int, ...], int]:
    """Return the order of ``count`` steps without one, and the place to show then; the last step stays."""
    if count < 2:
        return tuple(range(count)), place
    return tuple(each for each in range(count) if each != place), min(place, count - 2)


def shown_alike(before: Lesson, after: Lesson) -> tuple[int | None, ...]:
    """Return for each step afterwards the index of one before that shows the same, None where there is none.

    What is said may differ. Of several the one at the same place comes first.
    """
    known = [_wordless(each) for each in before.steps]
    found: list[int | None] = []
    for place, step in enumerate(after.steps):
        wanted = _wordless(step)
        if place < len(known) and known[place] == wanted:
            found.append(place)
        else:
            found.append(known.index(wanted) if wanted in known else None)
    return tuple(found)


def with_words(step: LessonStep, words: dict[str, str]) -> LessonStep:
    """Return the step with other words, by the names of ``WORDS``; an answer without its question goes with it."""
    changed = dataclasses.replace(step, **words)  # type: ignore[arg-type]
    return changed if changed.question else dataclasses.replace(changed, answer="")


def _wordless(step: LessonStep) -> LessonStep:
    return dataclasses.replace(step, **dict.fromkeys(WORDS, ""))  # type: ignore[arg-type]
