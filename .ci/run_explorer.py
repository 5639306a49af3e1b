"""What ``make run`` does: open the window or, without a display, save a picture of it and a sheet under build/."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

BUILD = Path(__file__).resolve().parent.parent / "build"
SAMPLE = "gallery:structured-pebbles"


def main() -> int:
    """Return the exit code."""
    from texlab.cli.main import main as texlab

    if has_display():
        return texlab([])
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    BUILD.mkdir(exist_ok=True)
    window, sheet = BUILD / "window.png", BUILD / "sheet.png"
    failed = texlab(["screenshot", "--out", str(window)])
    if failed:
        return failed
    more = ["--crop", "128x128+16+16", "--size", "256x256"]
    failed = texlab(["compare", SAMPLE, *more, "--out", str(sheet)])
    if failed:
        return failed
    print(
        f"There is no display, so the window was drawn off screen: {window}; four methods side by side: {sheet}."
    )
    return 0


def has_display() -> bool:
    """Return whether Qt can open a window; asked in another process, since Qt aborts when it cannot."""
    if sys.platform != "linux":
        return True
    if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return False
    probe = "from PySide6.QtGui import QGuiApplication; QGuiApplication([])"
    return subprocess.run([sys.executable, "-c", probe], capture_output=True, check=False).returncode == 0


if __name__ == "__main__":
    sys.exit(main())
