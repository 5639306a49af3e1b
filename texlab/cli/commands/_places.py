"""Where many jobs run: in this process, in several, or on a cluster."""

from __future__ import annotations

import contextlib
from functools import partial
from typing import TYPE_CHECKING

from texlab.cli.commands._options import parse_number

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from texlab.cli.parser import Parser
    from texlab_core.batch.places import Place
    from texlab_core.sheets.sweep_running import Elsewhere


def add_place_options(parser: Parser, processes: str) -> None:
    """Add ``--processes``, with its help in ``processes``, and ``--cluster``."""
    place = parser.add_mutually_exclusive_group()
    place.add_argument("--processes", metavar="N", help=processes)
    place.add_argument("--cluster", metavar="ADDRESS", help="Dask: tcp://HOST:PORT, or local:N to start one here")


def parse_place(args: argparse.Namespace) -> Place | None:
    """Return the place that is named, if any; raises ``InputError``."""
    if args.cluster is not None:
        from texlab_core.batch.cluster import Cluster

        return Cluster(args.cluster)
    return None if args.processes is None else processes(parse_number("processes", args.processes, int))


def processes(count: int | None) -> Place:
    """Return so many processes (None: one for each core); one is this process. Raises ``ParamError``."""
    from texlab_core.batch.places import InProcess
    from texlab_core.batch.processes import Processes

    place = Processes(count)
    return InProcess() if place.width == 1 else place


@contextlib.contextmanager
def elsewhere(place: Place | None) -> Iterator[Elsewhere | None]:
    """Keep a place within the block, and give what runs the jobs of a sweep there; None for no place."""
    if place is None:
        yield None
        return
    from texlab_core.batch.running import run_jobs

    with place.kept():
        yield partial(run_jobs, place=place)
