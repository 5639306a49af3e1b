"""The one decorator of the compiled kernels: no GIL, cached on disk wherever that is possible."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

if TYPE_CHECKING:
    from collections.abc import Callable

FunctionT = TypeVar("FunctionT", bound="Callable[..., Any]")


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
