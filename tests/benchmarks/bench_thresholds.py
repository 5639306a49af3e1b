"""Under the hand: from a real mouse event to the repainted pane, the explained pixel, the turned solid.

A window is opened under a virtual screen (Xvfb) in a process of its own, and the pointer is moved by the X server
(XTest), so that the whole way is measured: X, Qt, session, worker, synthesis, scene, paint. Prints figures, judges
nothing.
"""

from __future__ import annotations

import ctypes.util
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.benchmark

SCRIPT = Path(__file__).with_name("_hand.py")


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    """Start a virtual screen; yields its name."""
    if shutil.which("Xvfb") is None or ctypes.util.find_library("Xtst") is None:
        pytest.skip("needs Xvfb and libXtst")
    reader, writer = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writer), "-screen", "0", "1920x1080x24", "-nolisten", "tcp"],
        pass_fds=(writer,),
        stderr=subprocess.DEVNULL,
    )
    os.close(writer)
    with os.fdopen(reader) as pipe:
        yield f":{pipe.readline().strip()}"
    server.terminate()
    server.wait()


TRIED = [*((what, count) for what in ("slider", "cell", "explain", "measures") for count in (1, 4)), ("turn", 1)]


@pytest.mark.parametrize(("what", "columns"), TRIED)
def test_hand(display: str, tmp_path: Any, what: str, columns: int) -> None:
    environment = os.environ | {
        "DISPLAY": display,
        "QT_QPA_PLATFORM": "xcb",
        "TEXLAB_HOME": str(tmp_path),
        "PYTHONPATH": str(SCRIPT.parents[2]),
    }
    out = subprocess.run(
        [sys.executable, str(SCRIPT), what, str(columns)],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert out.returncode == 0, out.stderr
    print("\n" + out.stdout.strip())
