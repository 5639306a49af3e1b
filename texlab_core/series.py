"""Several jobs that are run when somebody asks for their results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, overload

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.run import run

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.engine.job import Job
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Step


class Series(Sequence["Result"]):
    """Results that are made when they are asked for: by index, by slice, or one after the other in a loop.

    Every job was checked when the series was made. A result is made anew each time, so that a long series takes no
    memory; what jobs have in common in their analysis is made once.

    Parameters
    ----------
    jobs
        What to run.
    values
        What differs from job to job, by name.
    on_step
        Called with every step of every run.
    cache
        Where analyses are kept; a new one when None.
    """

    def __init__(
        self,
        jobs: Sequence[Job],
        values: Sequence[Mapping[str, Any]],
        *,
        on_step: Callable[[Step], None] | None = None,
        cache: AnalysisCache | None = None,
    ) -> None:
        self.jobs = tuple(jobs)
        self.values = tuple(frozen_mapping(each) for each in values)
        self._on_step = on_step
        self._cache = AnalysisCache() if cache is None else cache

    def __len__(self) -> int:
        """Return how many jobs there are."""
        return len(self.jobs)

    @overload
    def __getitem__(self, index: int) -> Result: ...
    @overload
    def __getitem__(self, index: slice) -> Series: ...
    def __getitem__(self, index: int | slice) -> Result | Series:
        """Run one job, or return a part of the series, which runs nothing yet."""
        if isinstance(index, slice):
            return Series(self.jobs[index], self.values[index], on_step=self._on_step, cache=self._cache)
        return run(self.jobs[index], self._on_step, cache=self._cache)

    def __iter__(self) -> Iterator[Result]:
        """Run the jobs one after the other, each when it is reached."""
        return (self[index] for index in range(len(self)))

    def items(self) -> Iterator[tuple[Mapping[str, Any], Result]]:
        """Yield what differs, with the result."""
        return zip(self.values, self, strict=True)

    def __repr__(self) -> str:
        """Return one short line; runs nothing."""
        first = f", from {self.jobs[0].brief}" if self.jobs else ""
        return f"<Series: {len(self)} jobs{first}>"

    def _repr_html_(self) -> str:
        """Return a table of what differs; runs nothing."""
        names = list(dict.fromkeys(name for each in self.values for name in each))
        head = "".join(f"<th>{escape(name)}</th>" for name in ("", *names))
        rows = "".join(
            f"<tr><td>{index}</td>"
            + "".join(f"<td>{escape(str(each.get(name, '')))}</td>" for name in names)
            + "</tr>"
            for index, each in enumerate(self.values)
        )
        return f"<table><tr>{head}</tr>{rows}</table>"
