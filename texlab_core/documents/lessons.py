"""Lessons: ordered steps as versioned JSON, data only. What a step asks for is checked, never run, here.

A step says what is on the screen (an exemplar, columns with methods and parameters, a drawing of the laboratory, a
tab and its settings, a pixel, a place, marks) and what is said about it (one large sentence, a note, a question
with its answer, something to try).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from texlab_core.documents.lesson_parts import (
    Drawing,
    Fields,
    LessonError,
    Place,
    Series,
    Shown,
    StepColumn,
    Tab,
    Taken,
)
from texlab_core.engine.job import check_seed
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_from_json
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

FORMAT = "texlab-lesson"
VERSION = 2
PAPERS = {
    "forsyth-ponce": "Forsyth and Ponce, ch. 11",
    "heeger-bergen": "Heeger and Bergen 1995",
    "de-bonet": "De Bonet 1997",
    "msg": "Navarro and Portilla 1996",
    "efros-leung": "Efros and Leung 1999",
}
MAX_STEPS, MAX_COLUMNS, MAX_MARKS, MAX_VALUES = 60, 8, 32, 12
SENTENCE, NOTE, TITLE = 160, 2000, 80
DEFAULT_SIZE = (256, 256)
_FIGURE = re.compile(r"([a-z-]+) ((?:table )?[0-9]{1,2}(?:\.[0-9]{1,2})?)")


@dataclass(frozen=True, kw_only=True)
class LessonStep:
    """One step.

    Parameters
    ----------
    sentence
        The one large sentence, 1 .. 160 characters.
    note
        What the teacher says about it, at most 2000 characters; line feeds part paragraphs.
    question, answer
        For the students; an answer goes with a question only.
    try_this
        What the students should try.
    figures
        The figures and tables that it redraws: "heeger-bergen 2", "msg table 1", "forsyth-ponce 11.15".
    exemplar
        What the columns work on; None where there are none and the drawing needs no picture.
    size
        Height and width of the results.
    seed
        Of the drawing, and of all columns that have none of their own.
    columns
        From left to right, at most 8.
    chosen
        Index of the chosen column.
    series
        One parameter of one column at several values, for a slider.
    drawing
        A picture of the laboratory.
    tab
        Which tab of the window is open, and how its controls stand.
    pixel
        Column, row and column of the pixel that is asked about.
    view
        Zoom and place of the pictures.
    marks
        Top, left, height and width of outlines in the exemplar, in pixels of the crop.
    """

    sentence: str
    note: str = ""
    question: str = ""
    answer: str = ""
    try_this: str = ""
    figures: tuple[str, ...] = ()
    exemplar: Taken | None = None
    size: tuple[int, int] = DEFAULT_SIZE
    seed: int = 1
    columns: tuple[StepColumn, ...] = ()
    chosen: int = 0
    series: Series | None = None
    drawing: Drawing | None = None
    tab: Tab | None = None
    pixel: Place | None = None
    view: Shown = field(default_factory=Shown)
    marks: tuple[tuple[int, int, int, int], ...] = ()

    def pictures(self) -> Iterator[Taken]:
        """Return every picture that it uses."""
        if self.exemplar is not None:
            yield self.exemplar
        for column in self.columns:
            yield from column.inputs.values()
        if self.drawing is not None and self.drawing.other is not None:
            yield self.drawing.other

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data; what is at its default is left out."""
        data: dict[str, Any] = {"sentence": self.sentence}
        words = {"note": self.note, "question": self.question, "answer": self.answer, "try": self.try_this}
        data |= {key: text for key, text in words.items() if text}
        if self.figures:
            data["figures"] = list(self.figures)
        if self.exemplar is not None:
            data["exemplar"] = self.exemplar.to_json()
        if self.columns:
            data["size"] = {"width": self.size[1], "height": self.size[0]}
            data["columns"] = [each.to_json() for each in self.columns]
        if self.columns or self.drawing is not None:
            data["seed"] = self.seed
        if self.chosen:
            data["chosen"] = self.chosen
        parts = {"series": self.series, "drawing": self.drawing, "tab": self.tab, "pixel": self.pixel}
        data |= {key: part.to_json() for key, part in parts.items() if part is not None}
        if self.view != Shown():
            data["view"] = self.view.to_json()
        if self.marks:
            sides = ("top", "left", "height", "width")
            data["marks"] = [dict(zip(sides, mark, strict=True)) for mark in self.marks]
        return data


@dataclass(frozen=True, kw_only=True)
class Lesson:
    """An ordered list of steps under a title.

    Parameters
    ----------
    title
        1 .. 80 characters.
    chapter
        Where it belongs in the textbook ("11.2"), or "" for none.
    papers
        Keys of ``PAPERS``.
    summary
        One or two sentences for the list.
    steps
        1 .. 60.
    folder
        Where its files are; None for a lesson that may use textures of the gallery only.
    """

    title: str
    steps: tuple[LessonStep, ...]
    chapter: str = ""
    papers: tuple[str, ...] = ()
    summary: str = ""
    folder: Path | None = field(default=None, compare=False)

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data."""
        # Older programs read what they can show.
        version = 1 if all(taken.is_plain for step in self.steps for taken in step.pictures()) else VERSION
        data: dict[str, Any] = {"format": FORMAT, "version": version, "title": self.title, "chapter": self.chapter}
        data |= {"papers": list(self.papers), "summary": self.summary}
        return data | {"steps": [each.to_json() for each in self.steps]}

    def locate(self, taken: Taken) -> str | Path:
        """Return where a picture is: ``gallery:NAME``, or a file below the lesson's folder.

        Raises
        ------
        LessonError
            When it is a file and the lesson has no folder.
        """
        if taken.source.startswith("gallery:"):
            return taken.source
        if self.folder is None:
            raise LessonError(f"{taken.source}: this lesson has no folder, so it can use the gallery only.")
        return self.folder.joinpath(*PurePosixPath(taken.source).parts)


def lesson_from_json(data: object, *, what: str = "the lesson", folder: Path | None = None) -> Lesson:
    """Build a lesson from JSON data.

    Raises
    ------
    LessonError
        With one sentence that starts with ``what`` and names the step and the key.
    """
    try:
        return _lesson(data, folder)
    except InputError as bad:
        raise LessonError(f"{what[:1].upper()}{what[1:]} cannot be used: {bad}") from bad


def read_lesson(path: str | os.PathLike[str]) -> Lesson:
    """Read a lesson from a file.

    Raises
    ------
    LessonError
        With one sentence when it cannot be read, is malformed, newer or hostile.
    """
    file = Path(path)
    name = f"the lesson {file.name or file}"
    return lesson_from_json(
        strict_json.load(file, what=name, error=LessonError), what=name, folder=file.absolute().parent
    )


def lesson_from_text(text: str | bytes, *, what: str = "the lesson") -> Lesson:
    """Read a lesson from its text; it has no folder."""
    return lesson_from_json(strict_json.loads(text, what=what, error=LessonError), what=what)


def write_lesson(lesson: Lesson, path: str | os.PathLike[str]) -> None:
    """Write a lesson under a temporary name, then rename.

    Raises
    ------
    LessonError
        When it cannot be written, or would not be read again.
    """
    lesson_from_json(lesson.to_json(), folder=lesson.folder)
    try:
        write_whole(Path(path), strict_json.dumps(lesson.to_json()).encode())
    except (InputError, OSError) as bad:
        raise LessonError(str(bad)) from bad


def figure_parts(figure: str) -> tuple[str, str]:
    """Return paper and number of "msg table 1"; raises ``LessonError`` when it is no such thing."""
    found = _FIGURE.fullmatch(figure)
    if found is None or found[1] not in PAPERS:
        papers = ", ".join(PAPERS)
        raise LessonError(
            f"figures: each must be a paper ({papers}) and a number, as in forsyth-ponce 11.4 or msg table 1,"
            f" got {strict_json.shorten(figure)}."
        )
    return found[1], found[2]


def _lesson(given: object, folder: Path | None) -> Lesson:
    data = strict_json.check_document(given, "lesson", form=FORMAT, version=VERSION, error=LessonError)
    fields = Fields(data, ("format", "version", "title", "chapter", "papers", "summary", "steps"))
    papers = fields.texts("papers")
    for paper in papers:
        if paper not in PAPERS:
            raise LessonError(
                f"papers: each must be one of {', '.join(PAPERS)}, got {strict_json.shorten(paper)}."
            )
    steps = fields.items("steps", 1, MAX_STEPS)
    made = []
    for number, each in enumerate(steps, 1):
        try:
            made.append(step_from_json(each))
        except InputError as bad:
            raise LessonError(f"step {number}: {bad}") from bad
    return Lesson(
        title=fields.text("title", TITLE, needed=True),
        chapter=fields.text("chapter", 20),
        papers=papers,
        summary=fields.text("summary", NOTE),
        steps=tuple(made),
        folder=folder,
    )


_STEP_KEYS = (
    *("sentence", "note", "question", "answer", "try", "figures", "exemplar", "size", "seed", "columns", "chosen"),
    *("series", "drawing", "tab", "pixel", "view", "marks"),
)


def step_from_json(data: object) -> LessonStep:
    """Build a step from JSON data; raises ``LessonError`` with one sentence that names the key."""
    fields = Fields(data, _STEP_KEYS)
    columns = fields.parts("columns", 0, MAX_COLUMNS, StepColumn.from_json)
    size = fields.data.get("size")
    figures = fields.texts("figures")
    for each in figures:
        figure_parts(each)
    step = LessonStep(
        sentence=fields.text("sentence", SENTENCE, needed=True),
        note=fields.text("note", NOTE, lines=True),
        question=fields.text("question", NOTE, lines=True),
        answer=fields.text("answer", NOTE, lines=True),
        try_this=fields.text("try", NOTE, lines=True),
        figures=figures,
        exemplar=fields.part("exemplar", Taken.from_json),
        size=DEFAULT_SIZE if size is None else _size(size),
        seed=check_seed(fields.data.get("seed", 1)),
        columns=columns,
        chosen=fields.whole("chosen", 0, 0, max(0, len(columns) - 1)),
        series=fields.part("series", Series.from_json),
        drawing=fields.part("drawing", Drawing.from_json),
        tab=fields.part("tab", Tab.from_json),
        pixel=fields.part("pixel", Place.from_json),
        view=fields.part("view", Shown.from_json) or Shown(),
        marks=fields.parts("marks", 0, MAX_MARKS, _mark),
    )
    _check_together(step)
    return step


def _check_together(step: LessonStep) -> None:
    """Refuse what only makes sense with something else that is not there."""
    if step.answer and not step.question:
        raise LessonError("answer: goes with a question, and there is none.")
    if step.columns and step.exemplar is None:
        raise LessonError("exemplar: is missing, and the columns work on it.")
    if step.marks and step.exemplar is None:
        raise LessonError("marks: lie in the exemplar, and there is none.")
    for key, part in (("series", step.series), ("pixel", step.pixel)):
        if part is not None and part.column >= len(step.columns):
            raise LessonError(f"{key}: column must be below {len(step.columns)}, the number of columns.")
    if step.series is not None:
        step.series.check(step.columns[step.series.column])
    if step.pixel is not None and (step.pixel.row >= step.size[0] or step.pixel.x >= step.size[1]):
        raise LessonError(f"pixel: must lie in {step.size[1]} x {step.size[0]} pixels.")


def _size(data: object) -> tuple[int, int]:
    if not isinstance(data, dict):
        raise LessonError(f"size: must be an object with width and height, got {strict_json.shorten(data)}.")
    height, width = size_from_json(data, 2)
    return height, width


def _mark(data: object) -> tuple[int, int, int, int]:
    fields = Fields(data, ("top", "left", "height", "width"))
    top, left = fields.whole("top", None, 0, 2**16), fields.whole("left", None, 0, 2**16)
    return top, left, fields.whole("height", None, 1, 2**16), fields.whole("width", None, 1, 2**16)


def title_of_method(column: StepColumn) -> str:
    """Return what a column is called where a step does not name it."""
    return column.title or find_method(column.method).title
