"""What the command line says on standard error, and how Ctrl-C ends it."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType

_PATIENCE_S = 0.3
_RETRY_S = 0.02
_SHOW_CURSOR = "\x1b[?25h"
INTERRUPTED = 130


def complain(sentence: str, program: str = "texlab") -> None:
    """Print one line on standard error; nowhere when that is closed or full.

    What would move the cursor or change colours, in the name of a file say, is shown as an escape.
    """
    line = "".join(each if each.isprintable() else ascii(each)[1:-1] for each in sentence)
    if sys.stderr is None:
        return
    try:
        print(f"{program}: {line}", file=sys.stderr, flush=True)
    except (OSError, ValueError):
        # Python would try again when it ends, fail, and change the exit code.
        with contextlib.suppress(OSError, ValueError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, sys.stderr.fileno())
            os.close(nowhere)


@contextlib.contextmanager
def logged_quietly() -> Iterator[None]:
    """Within the block, what the core logs goes to the log file, not to the terminal."""
    import logging

    from texlab.storage.log import LogFile

    handler, core = LogFile(), logging.getLogger("texlab_core")
    core.addHandler(handler)
    try:
        yield
    finally:
        core.removeHandler(handler)
        handler.close()


class _Manners:
    """Whether progress is shown; no dataclass, which would take longer to import than all else."""

    def __init__(self) -> None:
        self.quiet = False


_manners = _Manners()


@contextlib.contextmanager
def quietly(quiet: bool, *, keep_output: bool = False) -> Iterator[None]:
    """Within the block, show no progress, and print nothing on standard output unless it is to be kept."""
    _manners.quiet = quiet
    try:
        if not quiet or keep_output:
            yield
            return
        with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
            yield
    finally:
        _manners.quiet = False


def shows_progress() -> bool:
    """Return whether somebody watches: standard error is a terminal, and nobody asked for quiet."""
    return not _manners.quiet and sys.stderr is not None and sys.stderr.isatty()


class _Interruption:
    """Whether Ctrl-C was pressed, and whether the work has learnt of it."""

    def __init__(self) -> None:
        self.pressed = False
        self.heard = False


_interruption = _Interruption()


def interrupted() -> bool:
    """Return whether Ctrl-C was pressed: what commands give to the core as ``should_stop``."""
    # Looked at once: pressed in between, it would be reported and yet not be heard.
    pressed = _interruption.pressed
    if pressed:
        _interruption.heard = True
    return pressed


@contextlib.contextmanager
def orderly_interrupts() -> Iterator[None]:
    """Within the block, Ctrl-C makes :func:`interrupted` true, and raises ``KeyboardInterrupt`` if nobody asks.

    It is never raised where it would be lost: while modules are imported or code is compiled, C libraries turn it
    into errors of their own. Where Python itself swallows it, in a destructor, it is raised once more. A second
    Ctrl-C ends the process at once; no file is half written then, because all are renamed into place. A process
    that was started with the signal ignored, in the background of a script say, goes on ignoring it.

    Raises
    ------
    KeyboardInterrupt
        At the latest at the end of the block.
    """
    ours = threading.current_thread() is threading.main_thread() and hasattr(signal, "setitimer")
    if not ours or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    state = _interruption
    state.pressed = state.heard = False

    def interrupt(number: int, frame: FrameType | None) -> None:
        if number == signal.SIGINT:
            if state.pressed:
                _end_at_once()
            # Before the clock is set: however late it is, the alarm finds it so.
            state.pressed = True
            # Again and again: an alarm just before a wait begins does not end the wait.
            signal.setitimer(signal.ITIMER_REAL, _PATIENCE_S, _RETRY_S)
        elif state.pressed and not state.heard and _would_be_lost(frame):
            signal.setitimer(signal.ITIMER_REAL, _RETRY_S, _RETRY_S)
        else:
            signal.setitimer(signal.ITIMER_REAL, 0)
            if state.pressed and not state.heard:
                raise KeyboardInterrupt

    alarm, unraisable = signal.getsignal(signal.SIGALRM), sys.unraisablehook

    def swallowed(caught: sys.UnraisableHookArgs) -> None:
        if issubclass(caught.exc_type, KeyboardInterrupt):
            signal.setitimer(signal.ITIMER_REAL, _RETRY_S, _RETRY_S)
        else:
            unraisable(caught)

    sys.unraisablehook = swallowed
    signal.signal(signal.SIGALRM, interrupt)
    signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        # From here on it is raised at once; what was pressed before is known by then.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        pressed, state.pressed = state.pressed, False
        if pressed:
            signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, alarm)
        sys.unraisablehook = unraisable
        if pressed:
            # While Python shuts down it has nothing left to do in good order.
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            raise KeyboardInterrupt


def _would_be_lost(frame: FrameType | None) -> bool:
    while frame is not None:
        module = frame.f_globals.get("__name__") or ""
        if module.partition(".")[0] == "llvmlite" or frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


def _end_at_once() -> None:
    if sys.stderr is not None and sys.stderr.isatty():
        # The progress bar hides it.
        os.write(sys.stderr.fileno(), _SHOW_CURSOR.encode())
    os._exit(INTERRUPTED)
