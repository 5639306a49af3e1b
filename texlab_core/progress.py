"""A progress bar where somebody sees one: in a notebook, or on a terminal."""

from __future__ import annotations

import contextlib
import sys
import time
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab_core.engine.steps import Step

# A notebook is told no more often, whatever the number of steps.
INTERVAL_S = 0.1


@contextlib.contextmanager
def progress_bar(title: str = "") -> Iterator[Callable[[Step], None]]:
    """Show a bar within the block; it goes when the block is left.

    Parameters
    ----------
    title
        What is being done.

    Yields
    ------
    callable
        Takes every step, as ``on_step`` of ``synthesize`` and ``run``. Where nobody would see a bar (no notebook,
        and standard error is no terminal), it does nothing.

    Examples
    --------
    >>> from texlab_core import progress_bar, synthesize
    >>> with progress_bar("pebbles") as show:
    ...     result = synthesize("gallery:structured-pebbles", size=(32, 32), on_step=show)
    """
    if (display := _notebook_display()) is not None:
        yield from _in_notebook(title, display)
    elif sys.stderr is not None and sys.stderr.isatty():
        yield from _on_terminal(title)
    else:
        yield lambda step: None


def _notebook_display() -> Any | None:
    """Return ``IPython.display`` in a notebook, and None elsewhere."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    # A kernel has a front end that shows HTML; IPython in a terminal has none.
    if shell is None or getattr(shell, "kernel", None) is None:
        return None
    import importlib

    return importlib.import_module("IPython.display")


def _in_notebook(title: str, display: Any) -> Iterator[Callable[[Step], None]]:
    handle = display.display(display.HTML(_bar(title, 0.0, "")), display_id=True)
    last = [-INTERVAL_S]

    def show(step: Step) -> None:
        now = time.monotonic()
        if now - last[0] >= INTERVAL_S:
            last[0] = now
            handle.update(display.HTML(_bar(title, _share(step), step.stage)))

    try:
        yield show
    finally:
        handle.update(display.HTML(""))


def _bar(title: str, share: float, stage: str) -> str:
    return f'{escape(title)} <progress value="{share:.3f}" max="1"></progress> {share:.0%} {escape(stage)}'


def _on_terminal(title: str) -> Iterator[Callable[[Step], None]]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[stage]}", style="dim", markup=False),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=1.0, stage="")
        yield lambda step: bar.update(task, completed=_share(step), stage=step.stage)


def _share(step: Step) -> float:
    # The analysis is a small part of every method; its bar gives way to that of the synthesis.
    return step.fraction if step.phase == "synthesis" else 0.0
