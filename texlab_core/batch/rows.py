"""One job as the report of a batch shows it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

from texlab_core.measures.registry import measures

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab_core.batch.folder import Record


@dataclass(frozen=True, slots=True)
class Row:
    """One job in the report.

    Parameters
    ----------
    about
        What it was: input, part, variant, method, parameters, seed, size, as records have it.
    job
        Its hash; empty when it failed.
    picture, thumbnail, exemplar
        Paths of the pictures, relative to the report; empty when there is none.
    measures
        Numbers by name.
    findings, notes
        One sentence each.
    error
        Why it failed.
    """

    about: Mapping[str, Any]
    job: str = ""
    picture: str = ""
    thumbnail: str = ""
    exemplar: str = ""
    measures: Mapping[str, float | None] | None = None
    findings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    error: str = ""

    @classmethod
    def of(cls, record: Record) -> Self:
        """Return the row of a job that is done."""
        data = record.data
        return cls(
            about=data,
            job=record.key,
            picture=data["picture"],
            thumbnail=data["thumbnail"],
            exemplar=data.get("exemplar_thumbnail") or "",
            measures=data["measures"],
            findings=tuple(data["findings"]),
            notes=tuple(data["notes"]),
        )

    @classmethod
    def failed(cls, about: Mapping[str, Any], error: str) -> Self:
        """Return the row of a job that failed."""
        return cls(about=about, exemplar=about.get("exemplar_thumbnail") or "", error=error)

    @property
    def title(self) -> str:
        """Which job it is, in one line."""
        about = self.about
        part = f" ({about['part']})" if about["part"] else ""
        return f"{about['input']}{part}, {about['variant']}, {self.size}, seed {about['seed']}"

    @property
    def size(self) -> str:
        """Width and height (and depth), or the plan's rule when the exemplar could not be read."""
        size = self.about.get("size")
        return "x".join(str(side) for side in size.values()) if size else str(self.about["size_rule"])


def measure_names(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the names of all measures: in the registry's order, then what only methods know."""
    found = {name for row in rows for name in row.measures or {}}
    known = [name for name in measures() if name in found]
    return (*known, *sorted(found - set(known)))
