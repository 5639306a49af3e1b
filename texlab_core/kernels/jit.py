"""The one decorator of the compiled kernels: no GIL, cached on disk wherever that is possible."""

from __future__ import annotations

import contextlib
import os
import tempfile
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

from texlab_core.errors import Cancelled

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

FunctionT = TypeVar("FunctionT", bound="Callable[..., Any]")
# What numba calls the event of a pass of its compiler.
_PASS = "numba:run_pass"


def njit(function: FunctionT) -> FunctionT:
    """Compile a function on its first call, releasing the GIL while it runs.

    The machine code is kept beside the source or, when that folder is read-only, in the user's cache folder; where
    neither can be written the function is compiled anew in every process.
    """
    import numba

    try:
        return cast("FunctionT", numba.njit(nogil=True, cache=True)(function))
    except RuntimeError:
        # numba raises on decoration when it finds no folder to write its cache to.
        return cast("FunctionT", numba.njit(nogil=True)(function))


@contextlib.contextmanager
def stoppable_compiling(should_stop: Callable[[], bool] | None) -> Iterator[None]:
    """Within the block, ask ``should_stop`` before every pass of the compiler in this thread.

    A kernel that is compiled for the first time on a machine takes seconds, a pass of it mostly hundredths.

    Raises
    ------
    Cancelled
        Out of the call that compiles, when ``should_stop`` said so; the next call compiles the kernel.
    """
    if should_stop is None:
        yield
        return
    from numba.core import event

    here, is_over = threading.get_ident(), should_stop

    class Asking(event.Listener):  # type: ignore[misc]  # numba has no types
        def on_start(self, event: Any) -> None:
            if threading.get_ident() == here and is_over():
                raise Cancelled

        def on_end(self, event: Any) -> None:
            pass

    with event.install_listener(_PASS, Asking()):
        yield


def _choose_cache_directory() -> None:
    """Send numba's cache to the user's cache folder when the installation is read-only."""
    if "NUMBA_CACHE_DIR" in os.environ or _writable(Path(__file__).parent):
        return
    import platformdirs

    from texlab_core.version import __version__

    # By version: an index of another version may name types that are gone, and would not load.
    folder = Path(platformdirs.user_cache_dir("texlab", appauthor=False)) / "numba" / __version__
    if _writable(folder):
        os.environ["NUMBA_CACHE_DIR"] = str(folder)


def _writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


_choose_cache_directory()
