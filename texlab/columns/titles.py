"""What a column is called: its method, and what differs from the others of the same method."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.style.numbers import number
from texlab_core.engine.params import describe
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab.state.scene import ColumnScene
    from texlab_core.engine.params import Params

# More than this is no title any more; the tool tip of the form has all.
MOST_PARTS = 4


def titles(columns: Sequence[ColumnScene]) -> list[str]:
    """Return the title of every column.

    A column that was given a name has that. One that is alone with its method is called like the method; of
    several with one method, each says the parameters in which they differ ("De Bonet, alpha .15 / k1 .28").
    Columns that differ in nothing are numbered.
    """
    made = [column.name or described(column, columns) for column in columns]
    counts: dict[str, int] = {}
    numbered = []
    for title in made:
        counts[title] = counts.get(title, 0) + 1
        numbered.append(title if made.count(title) == 1 else f"{title} ({counts[title]})")
    return numbered


def described(column: ColumnScene, columns: Sequence[ColumnScene]) -> str:
    """Return the method's title with what tells a column from the others of its method."""
    family = [each for each in columns if each.method == column.method and not each.name]
    if column not in family or len(family) == 1:
        return column.title
    parts: list[str] = []
    for name in differing([each.params for each in family]):
        parts += _written(name, column, family)
    seeds = {each.seed for each in family}
    if len(seeds) > 1:
        parts.append("shared seed" if column.seed is None else f"seed {column.seed}")
    if not parts:
        return column.title
    more = len(parts) - MOST_PARTS
    shown = " / ".join(parts[:MOST_PARTS])
    return f"{column.title}, {shown}" + (f" and {more} more" if more > 0 else "")


def differing(all_params: Sequence[Params]) -> list[str]:
    """Return the names of the parameters in which any two of the same kind differ, in the order of the form."""
    return [
        field.name
        for field in describe(type(all_params[0]))
        if any(getattr(each, field.name) != getattr(all_params[0], field.name) for each in all_params)
    ]


def _written(name: str, column: ColumnScene, family: Sequence[ColumnScene]) -> list[str]:
    value = getattr(column.params, name)
    if not isinstance(value, ThresholdTable):
        return [f"{_words(name)} {_value(value)}"]
    tables: list[ThresholdTable] = [getattr(each.params, name) for each in family]
    parts = []
    for k in sorted({k for table in tables for (k, _), _ in table.cells}):
        rows = [_row(table, k) for table in tables]
        if any(row != rows[0] for row in rows):
            parts.append(f"k{k} {_span(_row(value, k))}")
    return parts


def _row(table: ThresholdTable, k: int) -> dict[str, float]:
    return {name: value for (level, name), value in table.cells if level == k}


def _span(row: dict[str, float]) -> str:
    """Write the cells of a row that were set by hand: one number, or from the least to the largest."""
    if not row:
        return "by law"
    low, high = min(row.values()), max(row.values())
    return _value(low) if low == high else f"{_value(low)}\u2013{_value(high)}"


def _words(name: str) -> str:
    return name.replace("_", " ")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, float):
        # As the field writes it: .15, not 0.15.
        return number(value).replace("0.", ".", 1) if 0 < abs(value) < 1 else number(value)
    return str(value).replace("_", " ")
