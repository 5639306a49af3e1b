"""Where orders are carried out: one interface, and its simplest form, this process."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Generator, Iterable, Mapping
from typing import TYPE_CHECKING, Protocol

from texlab_core.batch.orders import Order, Outcome, Workbench
from texlab_core.errors import Cancelled

if TYPE_CHECKING:
    from collections.abc import Iterator
    from contextlib import AbstractContextManager

    from texlab_core.batch.parcels import Parcel

Loaded = tuple[Order, Mapping[str, "Parcel"]]
ShouldStop = Callable[[], bool]
Outcomes = Generator[Outcome, None, None]
POLL_S = 0.02


class Place(Protocol):
    """Somewhere orders are carried out. No bit of an outcome depends on which place it is."""

    title: str

    @property
    def width(self) -> int:
        """How many orders run side by side."""
        ...

    def run(self, orders: Iterable[Loaded], should_stop: ShouldStop | None = None) -> Outcomes:
        """Carry orders out and yield their outcomes as they come.

        Orders are taken one by one as there is room for them, so that an endless supply takes no memory.

        Raises
        ------
        Cancelled
            When ``should_stop``, which is asked many times a second, said so. Nothing runs any more then.
        """
        ...

    def kept(self) -> AbstractContextManager[None]:
        """Keep what a run starts (processes, a cluster, analyses) for the next ones within the context."""
        ...


class InProcess:
    """One order after the other, in the calling thread."""

    title = "this process"
    width = 1

    def __init__(self) -> None:
        self._bench: Workbench | None = None

    @contextlib.contextmanager
    def kept(self) -> Iterator[None]:
        """Keep analyses from one run to the next; see :meth:`Place.kept`."""
        self._bench = Workbench()
        try:
            yield
        finally:
            self._bench = None

    def run(self, orders: Iterable[Loaded], should_stop: ShouldStop | None = None) -> Outcomes:
        """Carry orders out in their order; see :meth:`Place.run`."""
        bench = self._bench or Workbench()
        for order, parcels in orders:
            if should_stop is not None and should_stop():
                raise Cancelled
            yield bench.carry_out(order, parcels, should_stop, threads=None)
