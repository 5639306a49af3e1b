"""What there is to see of a lesson: frozen values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from texlab_core.documents.lessons import Lesson, LessonStep
    from texlab_core.lessons.drawing import Drawn


@dataclass(frozen=True, eq=False)
class LessonScene:
    """What there is to see of lessons.

    Parameters
    ----------
    folder
        Where the user's own lessons are.
    shelf
        Counts up when a lesson was written there.
    name
        Of the lesson that is given; "" when there is none.
    lesson
        That lesson.
    own
        It is one of the user's own, which can be changed.
    place
        Index of the step that is shown.
    ready
        For each step, whether it shows at once.
    drawn
        The drawing of the step that is shown.
    column_id
        The column of its slider.
    can_undo, can_redo
        There are changes of the lesson to take back, or to make again.
    """

    folder: Path | None = None
    shelf: int = 0
    name: str = ""
    lesson: Lesson | None = None
    own: bool = False
    place: int = 0
    ready: tuple[bool, ...] = ()
    drawn: Drawn | None = None
    column_id: int = 0
    can_undo: bool = False
    can_redo: bool = False

    @property
    def step(self) -> LessonStep | None:
        """The step that is shown."""
        return None if self.lesson is None else self.lesson.steps[self.place]


NO_LESSON = LessonScene()
