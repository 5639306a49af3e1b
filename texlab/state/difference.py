"""Which columns a change of the session concerns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab.state.chosen import Column, State


@dataclass(frozen=True)
class Difference:
    """What must happen when the session goes from one state to another."""

    sample: bool
    added: tuple[int, ...]
    removed: tuple[int, ...]
    run: tuple[int, ...]


def difference(before: State, after: State) -> Difference:
    """Return what differs between two states, in terms of what has to be done."""
    old = {column.id: column for column in before.columns}
    new = {column.id: column for column in after.columns}
    run = tuple(key for key, column in new.items() if key not in old or not _same(old[key], column, before, after))
    before_key = before.sample.key if before.sample is not None else None
    after_key = after.sample.key if after.sample is not None else None
    return Difference(
        sample=before_key != after_key,
        added=tuple(key for key in new if key not in old),
        removed=tuple(key for key in old if key not in new),
        run=run,
    )


def _same(old: Column, new: Column, before: State, after: State) -> bool:
    """Whether a column has the same result in both states: names and places decide no pixels."""
    return old.work == new.work and before.seed_of(old) == after.seed_of(new) and before.size == after.size
