"""A progress bar on standard error, only where someone can see it."""

from __future__ import annotations

import contextlib
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab_core.engine.steps import Step


@contextlib.contextmanager
def progress(title: str) -> Iterator[Callable[[Step], None] | None]:
    """Show a bar within the block.

    Yields
    ------
    callable or None
        What ``run`` calls with every step; None when standard error is no terminal.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[stage]}", style="dim", markup=False),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        # The analysis is a small part of every method; its bar gives way to that of the synthesis.
        task = bar.add_task(title, total=1.0, stage="")

        def show(step: Step) -> None:
            bar.update(task, completed=step.fraction if step.phase == "synthesis" else 0.0, stage=step.stage)

        yield show


@contextlib.contextmanager
def share_bar(title: str) -> Iterator[Callable[[float], None] | None]:
    """Show a bar for several jobs within the block.

    Yields
    ------
    callable or None
        What takes the share that is done, 0 to 1; None when standard error is no terminal.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    percent = TextColumn("{task.percentage:>3.0f} %")
    columns = (TextColumn("{task.description}"), BarColumn(), percent, TimeElapsedColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=1.0)
        yield lambda share: bar.update(task, completed=share)
