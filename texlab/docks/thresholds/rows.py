"""Rows of a threshold table as text, for the clipboard: also a spreadsheet can read and write it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab.style.numbers import parse_number
from texlab_core.errors import InputError
from texlab_core.methods.de_bonet.thresholds import MAX_THRESHOLD

if TYPE_CHECKING:
    from collections.abc import Iterable

    from texlab.docks.thresholds.table import TableView
    from texlab_core.methods.de_bonet.thresholds import Cell

FIRST = "k"
LONGEST = 2**20


def rows_text(view: TableView, rows: Iterable[int]) -> str:
    """Return rows of a table, the law's numbers too: a line of names, then one line for each k."""
    names = [feature.name for feature in view.axes.features]
    lines = ["\t".join((FIRST, *names))]
    for row in sorted(set(rows)):
        lines.append("\t".join((str(row + 1), *(f"{view.value((row + 1, name)):.9g}" for name in names))))
    return "\n".join(lines) + "\n"


def pasted(text: str, view: TableView, rows: Iterable[int]) -> tuple[dict[Cell, float], str]:
    """Return the cells that copied rows set in a table, and what of them it does not have, in words.

    A single row goes into each of ``rows``, several go where they came from.

    Raises
    ------
    InputError
        When the text is no copied rows, or this table has none of their levels and features.
    """
    lines = [line.split("\t") for line in text[:LONGEST].splitlines() if line.strip()]
    if len(lines) < 2 or lines[0][0].strip() != FIRST:
        raise InputError("There are no rows of a threshold table on the clipboard: copy some first (Ctrl+C).")
    names = [name.strip() for name in lines[0][1:]]
    known = {feature.name for feature in view.axes.features}
    read = [(_whole(line[0]), [_threshold(each) for each in line[1:]]) for line in lines[1:]]
    if any(len(values) != len(names) for _, values in read):
        raise InputError("The copied rows have more or fewer numbers than names.")
    places = [(k, values) for k, values in read if k <= view.axes.depth]
    if len(read) == 1:
        places = [(row + 1, read[0][1]) for row in sorted(set(rows))]
    cells = {
        (k, name): value
        for k, values in places
        for name, value in zip(names, values, strict=True)
        if name in known
    }
    if not cells:
        raise InputError("This table has none of the copied levels and features.")
    missing = [name for name in names if name not in known]
    notes = []
    if missing:
        notes.append(f"{len(missing)} feature{'s' * (len(missing) != 1)}")
    if len(read) > 1 and len(places) < len(read):
        notes.append(f"{len(read) - len(places)} level{'s' * (len(read) - len(places) != 1)}")
    return cells, f"This exemplar does not have {' and '.join(notes)} of the copied rows." if notes else ""


def _whole(text: str) -> int:
    number = parse_number(text)
    if number is None or number != int(number) or number < 1:
        raise InputError(f"Every copied row begins with k, a whole number from 1, got {text[:20]!r}.")
    return int(number)


def _threshold(text: str) -> float:
    number = parse_number(text)
    if number is None or not 0 <= number <= MAX_THRESHOLD:
        raise InputError(f"A threshold is a number from 0 to {MAX_THRESHOLD:.0f}, got {text[:20]!r}.")
    return number
