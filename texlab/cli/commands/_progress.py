"""A progress bar on standard error, only where someone can see it."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

from texlab.cli.terminal import complain, shows_progress

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab_core.batch.running import Progress as BatchProgress
    from texlab_core.engine.steps import Step


@contextlib.contextmanager
def progress(title: str) -> Iterator[Callable[[Step], None] | None]:
    """Show a bar within the block.

    Yields
    ------
    callable or None
        What ``run`` calls with every step; None when standard error is no terminal.
    """
    if not shows_progress():
        yield None
        return
    from texlab_core.progress import progress_bar

    with progress_bar(title) as show:
        yield show


@contextlib.contextmanager
def share_bar(title: str) -> Iterator[Callable[[float], None] | None]:
    """Show a bar for several jobs within the block.

    Yields
    ------
    callable or None
        What takes the share that is done, 0 to 1; None when standard error is no terminal.
    """
    if not shows_progress():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    percent = TextColumn("{task.percentage:>3.0f} %")
    columns = (TextColumn("{task.description}"), BarColumn(), percent, TimeElapsedColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=1.0)
        yield lambda share: bar.update(task, completed=share)


@contextlib.contextmanager
def batch_bar(title: str) -> Iterator[Callable[[BatchProgress], None]]:
    """Show a bar for a batch within the block, and say at once what fails.

    Yields
    ------
    callable
        What ``run_batch`` calls; without a terminal it only says what fails.
    """

    def tell(progress: BatchProgress) -> None:
        if progress.error:
            complain(progress.error)

    if not shows_progress():
        yield tell
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    counts, rest = (
        TextColumn("{task.fields[counts]}", markup=False),
        TextColumn("{task.fields[rest]}", markup=False),
    )
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), counts, TimeElapsedColumn(), rest)
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=1.0, counts="", rest="")

        def show(progress: BatchProgress) -> None:
            # Printed through the bar, which goes on below.
            tell(progress)
            failed = f", {progress.failed} failed" if progress.failed else ""
            rest = "" if progress.remaining_s is None else f"{spoken(progress.remaining_s)} left"
            counts = f"{progress.done + progress.failed} of {progress.total}{failed}"
            bar.update(task, completed=progress.fraction, counts=counts, rest=rest)

        yield show


def spoken(seconds: float) -> str:
    """Return a time as people say it: "40 s", "5 min", "2 h 10 min"."""
    if seconds < 90:
        return f"{max(1, round(seconds))} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60:02} min"
