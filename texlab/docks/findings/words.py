"""What the findings dock shows and sends, decided without a widget."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab.state.intentions import ChangeMethod, EditParams
from texlab.style.pictures import Mark

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab.state.intentions import Intention
    from texlab.state.scene import ColumnScene
    from texlab_core.findings.finding import Finding

# What is always compared before and after, besides what the finding rests on.
ALWAYS = ("discriminability", "visual-difference")
MOST = 5


@dataclass(frozen=True)
class Tried:
    """What was applied to a column, and the numbers before it.

    Parameters
    ----------
    column_id
        The column.
    title
        Of the finding.
    words
        What was to be tried.
    measures
        Ids of the numbers to compare.
    before
        Their values.
    """

    column_id: int
    title: str
    words: str
    measures: tuple[str, ...]
    before: Mapping[str, float]


def nothing_to_list(column: ColumnScene) -> str:
    """Return why there is no finding of a finished column: nothing is wrong, or nobody has looked."""
    if column.findings is not None and column.measures and not column.draft:
        said = f"Nothing was found in the result of {column.title}."
        return f"{said} {column.unexamined}".rstrip()
    return column.unexamined or f"The result of {column.title} is not examined yet."


def heading(found: Finding) -> str:
    """Return the line of a finding in the list."""
    return f"! {found.title}" if found.certainty == "finding" else f"? {found.title}"


def explanation(found: Finding) -> str:
    """Return everything that is said of a finding, one paragraph each."""
    sure = "" if found.certainty == "finding" else "Look at this; it is not certain. "
    return "\n\n".join(
        (
            f"{sure}{found.what}",
            f"Where: {found.where.words}.",
            f"Why: {found.why}",
            f"What to do: {found.remedy.words}",
        )
    )


def marks(found: Finding) -> tuple[Mark, ...]:
    """Return the regions to outline, the worst one apart."""
    return tuple(
        Mark(each.top, each.left, each.height, each.width, "chosen" if place == 0 else "candidate")
        for place, each in enumerate(found.where.regions)
    )


def attempt(column: ColumnScene, found: Finding) -> Intention | None:
    """Return what "Try this" sends; None where the words are all there is, or the column has other parameters."""
    remedy = found.remedy
    if remedy.method:
        return ChangeMethod(column.id, remedy.method)
    if not remedy.params or not all(hasattr(column.params, name) for name in remedy.params):
        return None
    return EditParams(column.id, column.params.replace(**remedy.params), f"try: {found.title.lower()}")


def try_it(column: ColumnScene, found: Finding) -> Tried:
    """Return what there is to remember when a remedy is applied."""
    ids = tuple(dict.fromkeys((*ALWAYS, *found.measures)))
    shown = {name: column.measures[name] for name in ids if name in column.measures}
    return Tried(column.id, found.title, found.remedy.words, ids, shown)


def before_and_after(tried: Tried | None, columns: tuple[ColumnScene, ...]) -> str:
    """Return the numbers before and after what was tried, in one line; empty when nothing was."""
    from texlab_core.measures.registry import find_measure

    column = next((each for each in columns if tried is not None and each.id == tried.column_id), None)
    if tried is None or column is None:
        return ""
    begun = f"Tried against {tried.title.lower()}: {tried.words}"
    if column.status == "failed":
        return f"{begun} {column.message}"
    if column.status != "finished" or not column.measures:
        return f"{begun} The numbers come when it has finished."
    lines = []
    for name in tried.measures:
        if name in tried.before and name in column.measures:
            measure = find_measure(name)
            before, after = measure.text(tried.before[name]), measure.text(column.measures[name])
            lines.append(f"{measure.title} {before} → {after}")
    left = column.findings
    gone = left is not None and all(each.title != tried.title for each in left)
    return f"{begun} {', '.join(lines[:MOST])}.{' The finding is gone.' if gone else ''}"
