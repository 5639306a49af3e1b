"""Two ways to go through a generator that returns a value."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Generator

ItemT = TypeVar("ItemT")
ValueT = TypeVar("ValueT")


def through(work: Generator[Any, None, ValueT], item: ItemT) -> Generator[ItemT, None, ValueT]:
    """Yield ``item`` whenever ``work`` yields, and return what it returns."""
    while True:
        try:
            next(work)
        except StopIteration as end:
            value: ValueT = end.value
            return value
        yield item


def finish(work: Generator[Any, None, ValueT]) -> ValueT:
    """Run ``work`` to its end and return what it returns."""
    while True:
        try:
            next(work)
        except StopIteration as end:
            value: ValueT = end.value
            return value
