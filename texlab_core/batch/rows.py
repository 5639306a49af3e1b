"""One job as the report of a batch shows it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self, overload

from texlab_core.measures.registry import measures

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

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


class Rows(Sequence[Row]):
    """The rows of a batch in the order of its plan; those of finished jobs are read when they are wanted.

    So a batch takes no more memory for more jobs than their hashes.

    Parameters
    ----------
    read
        Returns the record of a job by its hash.
    """

    def __init__(self, read: Callable[[str], Record]) -> None:
        self._read = read
        self._kept: dict[int, bytes | Row] = {}
        self._measures: set[str] = set()
        self._failed = 0

    def add(self, place: int, row: Row) -> None:
        """Take the row of a job at its place in the plan."""
        self._kept[place] = row if row.error else bytes.fromhex(row.job)
        self._measures.update(row.measures or ())
        self._failed += bool(row.error)

    @property
    def failures(self) -> tuple[Row, ...]:
        """The rows of the jobs that failed."""
        kept = (self._kept[place] for place in sorted(self._kept))
        return tuple(each for each in kept if isinstance(each, Row))

    @property
    def failed(self) -> int:
        """How many failed."""
        return self._failed

    @property
    def measures(self) -> tuple[str, ...]:
        """Ids of all measures: in the registry's order, then what only methods know."""
        known = [name for name in measures() if name in self._measures]
        return (*known, *sorted(self._measures - set(known)))

    def __len__(self) -> int:
        return len(self._kept)

    def __iter__(self) -> Iterator[Row]:
        return (self._row(place) for place in sorted(self._kept))

    @overload
    def __getitem__(self, index: int) -> Row: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Row, ...]: ...

    def __getitem__(self, index: int | slice) -> Row | tuple[Row, ...]:
        """Return one row, or several."""
        places = sorted(self._kept)[index]
        return self._row(places) if isinstance(places, int) else tuple(map(self._row, places))

    def _row(self, place: int) -> Row:
        kept = self._kept[place]
        return kept if isinstance(kept, Row) else Row.of(self._read(kept.hex()))
