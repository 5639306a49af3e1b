"""What does not start before the user has asked for it: large jobs from files, and solids that take long."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from texlab.runs.column_run import with_exemplar
from texlab_core.engine.estimate import check_memory, estimate_of, in_words, is_large
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_text
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab.state.chosen import Column
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.registry import Estimate


@dataclasses.dataclass(frozen=True)
class _Asked:
    """The most that the user has asked of a column."""

    seconds: float
    nbytes: int

    def covers(self, expected: Estimate) -> bool:
        return (expected.seconds or 0.0) <= self.seconds and expected.nbytes <= self.nbytes


class Consent:
    """Knows which large jobs the user has asked for.

    A picture is seen while it grows, and stopped when it is not what was meant; so whatever is typed starts, but
    for what a file asks for. One more digit of a solid's sides is a thousand times the work: it starts by itself
    only where that is little, or no more than what was asked for before.
    """

    def __init__(self) -> None:
        self._from_file = False
        self._asked: dict[int, _Asked] = {}

    def ask_first(self) -> None:
        """Let every large job wait until the user asks for one: what comes next is from a file."""
        self._from_file = True

    def give(self, column: Column, exemplar: ImageInput | None, size: Sequence[int]) -> None:
        """Take it that the user has asked for this column, however large."""
        self._from_file = False
        expected = None if exemplar is None else _expected(column, exemplar, size)
        if expected is not None:
            before = self._asked.get(column.id, _Asked(0.0, 0))
            self._asked[column.id] = _Asked(
                max(before.seconds, expected.seconds or 0.0), max(before.nbytes, expected.nbytes)
            )

    def forget(self, column_id: int) -> None:
        """Forget a column that is gone."""
        self._asked.pop(column_id, None)

    def question(self, column: Column, exemplar: ImageInput, size: Sequence[int]) -> str:
        """Return the sentence that asks before a job starts; empty when it may start."""
        solid = find_method(column.method).dimensions == 3
        if not (self._from_file or solid):
            return ""
        expected = _expected(column, exemplar, size)
        if expected is None or not is_large(expected, size):
            return ""
        asked = self._asked.get(column.id)
        if not self._from_file and asked is not None and asked.covers(expected):
            return ""
        # What to press comes first: a narrow cell leaves out the end.
        return f"F5 runs it: {size_text(tuple(size))} needs {in_words(expected)}."


def _expected(column: Column, exemplar: ImageInput, size: Sequence[int]) -> Estimate | None:
    """Return what a column will take; None when it cannot work, which the run says at once."""
    method = find_method(column.method)
    try:
        expected = estimate_of(method, with_exemplar(exemplar, column.inputs), column.params, size)
        check_memory(method, expected, size)
    except InputError:
        return None
    return expected
