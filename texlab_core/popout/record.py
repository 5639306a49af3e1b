"""A pop-out test as a document: how it was made, what was answered, what came of it; and as a table."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Self

from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.regular import read_regular, reason
from texlab_core.files.wording import harmless
from texlab_core.popout.design import MAX_NAME, MAX_SETTINGS, MAX_TRIALS, Trial, chance
from texlab_core.popout.scoring import Answer, Score, score

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Mapping

    from texlab_core.popout.design import Design

FORMAT = "texlab-popout"
VERSION = 1
MAX_BYTES = 2**24
_MAX_SIDE = 2**20
_MAX_SEED = 2**64
_KEYS = ("format", "version", "design", "trials", "answers", "machine")
_DESIGN = ("exemplar", "settings", "repeats", "size", "piece", "share", "feather", "seed")
_TRIAL = ("number", "setting", "seed", "top", "left", "piece_top", "piece_left")
# Of answers as a table: what other programs are asked for.
ANSWER_COLUMNS = ("trial", "row", "column", "seconds")
COLUMNS = (
    *(
        "test",
        "trial",
        "method",
        "parameters",
        "seed",
        "width",
        "height",
        "left",
        "top",
        "piece_width",
        "piece_height",
    ),
    *("feather", "answer_column", "answer_row", "seconds", "hit", "machine_column", "machine_row", "machine_hit"),
    *("exemplar", "exemplar_sha256", "test_seed"),
)


@dataclass(frozen=True, kw_only=True)
class Record:
    """A test with its answers.

    Parameters
    ----------
    design
        As :meth:`~texlab_core.popout.design.Design.to_json` gives it.
    trials
        Its pictures, in the order of showing.
    answers
        One for each picture that was answered.
    machine
        The clicks of the machine observer; a picture without one is not answered, none at all: it did not look.
    """

    design: Mapping[str, Any]
    trials: tuple[Trial, ...]
    answers: tuple[Answer, ...] = ()
    machine: tuple[Answer, ...] = field(default=())

    @classmethod
    def of(cls, design: Design) -> Self:
        """Return the record of a test that begins."""
        return cls(design=design.to_json(), trials=design.trials())

    @property
    def size(self) -> tuple[int, int]:
        """Height and width of the pictures."""
        height, width = self.design["size"]
        return height, width

    @property
    def piece(self) -> tuple[int, int]:
        """Height and width of the piece."""
        height, width = self.design["piece"]
        return height, width

    @property
    def chance(self) -> float:
        """Share of hits of the best click without looking."""
        return chance(self.size, self.piece)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the settings."""
        return tuple(each["name"] for each in self.design["settings"])

    def trial(self, number: int) -> Trial:
        """Return a picture by its number; raises ``InputError`` when there is none."""
        if not 1 <= number <= len(self.trials):
            raise InputError(f"trial: must be from 1 to {len(self.trials)}, got {number}.")
        return self.trials[number - 1]

    def answered(self, answer: Answer) -> Self:
        """Return it with one more answer; an earlier one about the same picture goes."""
        self._check(answer)
        others = tuple(each for each in self.answers if each.trial != answer.trial)
        return replace(self, answers=(*others, answer))

    def with_answers(self, answers: Iterable[Answer]) -> Self:
        """Return it with these answers and no others.

        Raises
        ------
        InputError
            When one is about no picture of the test, outside of it, or the second one about a picture.
        """
        listed = tuple(answers)
        seen: set[int] = set()
        for each in listed:
            self._check(each)
            if each.trial in seen:
                raise InputError(f"trial: {each.trial} is answered twice.")
            seen.add(each.trial)
        return replace(self, answers=listed)

    def with_machine(self, clicks: Iterable[Answer]) -> Self:
        """Return it with the machine's clicks; raises as :meth:`with_answers`."""
        return replace(self, machine=self.with_answers(clicks).answers)

    def _check(self, answer: Answer) -> None:
        self.trial(answer.trial)
        if answer.row is None or answer.column is None:
            return
        height, width = self.size
        if not (0 <= answer.row < height and 0 <= answer.column < width):
            raise InputError(
                f"The answer to picture {answer.trial} must be a row from 0 to {height - 1} and a column from 0 to"
                f" {width - 1}, got {answer.row}, {answer.column}."
            )

    def hit(self, answer: Answer) -> bool:
        """Whether an answer is on the piece."""
        if answer.row is None or answer.column is None:
            return False
        trial, (height, width) = self.trial(answer.trial), self.piece
        return trial.top <= answer.row < trial.top + height and trial.left <= answer.column < trial.left + width

    def scores(self) -> tuple[Score, ...]:
        """Return the score of every setting, in their order."""
        setting = {each.number: each.setting for each in self.trials}
        found = []
        answered = {each.trial for each in self.answers}
        for place, name in enumerate(self.names):
            own = [(each, self.hit(each)) for each in self.answers if setting[each.trial] == place]
            clicks = [each for each in self.machine if setting[each.trial] == place and each.trial in answered]
            machine = sum(self.hit(each) for each in clicks) if self.machine else None
            found.append(score(name, own, self.chance, machine))
        return tuple(found)

    # As data.

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data."""

        def listed(answers: Iterable[Answer]) -> list[dict[str, Any]]:
            return [{"trial": a.trial, "row": a.row, "column": a.column, "seconds": a.seconds} for a in answers]

        return {
            "format": FORMAT,
            "version": VERSION,
            "design": dict(self.design),
            "trials": [{name: getattr(each, name) for name in _TRIAL} for each in self.trials],
            "answers": listed(self.answers),
            "machine": listed(self.machine),
        }

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Return the record that JSON data hold; raises ``InputError`` naming what does not fit."""
        given = strict_json.check_document(data, "pop-out test", form=FORMAT, version=VERSION)
        strict_json.check_keys(given, _KEYS)
        design = _design(given.get("design"))
        trials = []
        for place, each in enumerate(_list(given, "trials", MAX_TRIALS), 1):
            trials.append(_trial(each, place, design))
        answers = [_answer(each) for each in _list(given, "answers", MAX_TRIALS)]
        machine = [_answer(each) for each in _list(given, "machine", MAX_TRIALS)]
        return cls(design=design, trials=tuple(trials)).with_answers(answers).with_machine(machine)

    def rows(self) -> Iterable[list[Any]]:
        """Return the cells of :data:`COLUMNS` but the first, for every picture in the order of showing."""
        answers = {each.trial: each for each in self.answers}
        machine = {each.trial: each for each in self.machine}
        (height, width), (rows, columns), design = self.size, self.piece, self.design
        for each in self.trials:
            setting = design["settings"][each.setting]
            cells: list[Any] = [each.number, setting["name"], strict_json.packed(setting["parameters"]), each.seed]
            cells += [width, height, each.left, each.top, columns, rows, design["feather"]]
            cells += self._said(answers.get(each.number), timed=True) + self._said(machine.get(each.number))
            cells += [design["exemplar"]["name"], design["exemplar"]["sha256"], design["seed"]]
            yield [harmless(cell) for cell in cells]

    def _said(self, answer: Answer | None, *, timed: bool = False) -> list[Any]:
        if answer is None:
            return [""] * (4 if timed else 3)
        place = ["" if each is None else each for each in (answer.column, answer.row)]
        seconds = ["" if answer.seconds is None else f"{answer.seconds:.3f}"] if timed else []
        return [*place, *seconds, int(self.hit(answer))]


def table_of(records: Iterable[tuple[str, Record]]) -> str:
    """Return tests as CSV, each with its name: a line for each picture, answered or not."""
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow(COLUMNS)
    for name, record in records:
        writer.writerows([harmless(name), *cells] for cells in record.rows())
    return out.getvalue()


def read_record(path: str | os.PathLike[str]) -> Record:
    """Read a test from its file; raises ``InputError`` in one sentence."""
    data = strict_json.load(path, max_bytes=MAX_BYTES)
    try:
        return Record.from_json(data)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def read_answers(path: str | os.PathLike[str]) -> tuple[Answer, ...]:
    """Read answers from a CSV file with the columns trial, row, column and, if there are times, seconds.

    A line without row and column says that the viewer could not tell, if it has seconds; else that there was no
    answer. Other columns are passed over.

    Raises
    ------
    InputError
        Naming the line that does not fit.
    """
    try:
        text = read_regular(path, MAX_BYTES).decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({reason(error)}).") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is no text in UTF-8.") from error
    try:
        rows = list(csv.DictReader(io.StringIO(text, newline=""), strict=True))
    except csv.Error as error:
        raise InputError(f"{path}: is no table of comma-separated values ({error}).") from error
    missing = [each for each in ANSWER_COLUMNS[:3] if not rows or each not in rows[0]]
    if missing:
        raise InputError(
            f"{path}: must have the columns {', '.join(ANSWER_COLUMNS)} and a line for each picture;"
            f" {missing[0]} is missing."
        )
    found = [_answer_of(row, f"{path}, line {line}") for line, row in enumerate(rows, 2)]
    return tuple(each for each in found if each is not None)


def _answer_of(row: Mapping[str, str | None], where: str) -> Answer | None:
    cells = {name: (row.get(name) or "").strip() for name in ANSWER_COLUMNS}
    if not cells["row"] and not cells["column"] and not cells["seconds"]:
        return None
    numbers: dict[str, int | None] = {}
    for name in ("trial", "row", "column"):
        if not cells[name] and name != "trial":
            numbers[name] = None
            continue
        if not cells[name].isdecimal() or len(cells[name]) > 9:
            raise InputError(f"{where}: {name} must be a whole number from 0, got {cells[name]!r}.")
        numbers[name] = int(cells[name])
    if (numbers["row"] is None) != (numbers["column"] is None):
        raise InputError(f"{where}: must have both row and column, or neither.")
    seconds = None
    if cells["seconds"]:
        try:
            seconds = float(cells["seconds"])
        except ValueError:
            seconds = math.nan
        if not (math.isfinite(seconds) and seconds >= 0):
            raise InputError(f"{where}: seconds must be a number from 0, got {cells['seconds']!r}.")
    assert numbers["trial"] is not None
    return Answer(numbers["trial"], numbers["row"], numbers["column"], seconds)


# Reading data: each check says what is wrong in one sentence.


def _list(data: Mapping[str, Any], name: str, most: int) -> list[Any]:
    found = data.get(name)
    if not isinstance(found, list) or len(found) > most:
        raise InputError(f"{name}: must be a list of at most {most} objects.")
    return found


def _object(value: object, what: str, keys: tuple[str, ...]) -> dict[str, Any]:
    if not isinstance(value, dict) or set(value) != set(keys):
        raise InputError(f"{what}: must be an object with {', '.join(keys)}.")
    return value


def _whole(value: object, what: str, low: int, high: int) -> int:
    if type(value) is not int or not low <= value <= high:
        raise InputError(f"{what}: must be a whole number from {low} to {high}, got {strict_json.shorten(value)}.")
    return value


def _text(value: object, what: str) -> str:
    if not isinstance(value, str) or len(value) > MAX_NAME:
        raise InputError(f"{what}: must be a text of at most {MAX_NAME} characters.")
    return value


def _pair(value: object, what: str) -> list[int]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"{what}: must be a list of two whole numbers.")
    return [_whole(each, what, 1, _MAX_SIDE) for each in value]


def _design(value: object) -> dict[str, Any]:
    design = _object(value, "design", _DESIGN)
    exemplar = _object(design["exemplar"], "exemplar", ("name", "sha256", "size"))
    for name in ("name", "sha256"):
        _text(exemplar[name], name)
    whole = _pair(exemplar["size"], "exemplar size")
    if not isinstance(design["settings"], list) or not 1 <= len(design["settings"]) <= MAX_SETTINGS:
        raise InputError(f"settings: must be a list of 1 to {MAX_SETTINGS} objects.")
    for each in design["settings"]:
        setting = _object(each, "setting", ("name", "method", "parameters"))
        for name in ("name", "method"):
            _text(setting[name], name)
        if not isinstance(setting["parameters"], dict):
            raise InputError("parameters: must be an object.")
    size, piece = _pair(design["size"], "size"), _pair(design["piece"], "piece")
    if any(n > side for n, side in zip((*piece, *piece), (*size, *whole), strict=True)):
        raise InputError("piece: must fit into picture and exemplar.")
    _whole(design["repeats"], "repeats", 1, MAX_TRIALS)
    _whole(design["feather"], "feather", 0, _MAX_SIDE)
    _whole(design["seed"], "seed", 0, _MAX_SEED)
    if not isinstance(design["share"], int | float) or not 0 < design["share"] <= 1:
        raise InputError("share: must be a number above 0, at most 1.")
    return design


def _trial(value: object, place: int, design: Mapping[str, Any]) -> Trial:
    given = _object(value, f"trial {place}", _TRIAL)
    (height, width), (rows, columns), whole = design["size"], design["piece"], design["exemplar"]["size"]
    highest = {
        "number": place,
        "setting": len(design["settings"]) - 1,
        "seed": _MAX_SEED,
        "top": height - rows,
        "left": width - columns,
        "piece_top": whole[0] - rows,
        "piece_left": whole[1] - columns,
    }
    lowest = {"number": place}
    numbers = {
        name: _whole(given[name], f"{name} of trial {place}", lowest.get(name, 0), high)
        for name, high in highest.items()
    }
    return Trial(**numbers)


def _answer(value: object) -> Answer:
    given = _object(value, "answer", ANSWER_COLUMNS)
    trial = _whole(given["trial"], "trial", 1, MAX_TRIALS)
    if (given["row"] is None) != (given["column"] is None):
        raise InputError("answer: must have both row and column, or neither.")
    row, column = (
        None if given[name] is None else _whole(given[name], name, 0, _MAX_SIDE) for name in ("row", "column")
    )
    seconds = given["seconds"]
    if seconds is not None and not (
        isinstance(seconds, int | float) and type(seconds) is not bool and seconds >= 0
    ):
        raise InputError("seconds: must be a number from 0, or null.")
    return Answer(trial, row, column, seconds)
