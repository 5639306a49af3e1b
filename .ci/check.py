"""Everything that must hold, stage by stage, with the time of each: ``python .ci/check.py [lint|test]``.

Runs in the virtual environment that ``setup_env.py`` has made, and stops at the first stage that fails.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PYTHON = sys.executable
LINT = {
    "ruff": [PYTHON, "-m", "ruff", "check", "."],
    "format": [PYTHON, "-m", "ruff", "format", "--check", "."],
    "types": [PYTHON, "-m", "mypy"],
    "import contracts": [
        PYTHON,
        "-c",
        "from importlinter.cli import lint_imports_command; lint_imports_command()",
    ],
}
COVERAGE = ["--cov", "--cov-report="]
SCREEN = ["-o", "xvfb_width=1920", "-o", "xvfb_height=1200", "-o", "xvfb_colordepth=24"]


def main(goal: str) -> int:
    """Run the stages of ``goal``; return the exit code of the first that fails, or 0."""
    stages = dict(LINT) if goal == "lint" else LINT | tests()
    for name, command in stages.items():
        print(f"== {name}", flush=True)
        start = time.monotonic()
        environment = dict(os.environ)
        if "under Xvfb" in name:
            environment["TEXLAB_TEST_PLATFORM"] = "xcb"
        code = subprocess.run(command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, check=False).returncode
        # pytest's own last lines tell the time of the last stage, and stay the last ones.
        if code or name != list(stages)[-1] or goal == "lint":
            print(f"== {name}: {'failed after ' if code else ''}{time.monotonic() - start:.0f} s", flush=True)
        if code:
            return code
    return 0


def tests() -> dict[str, list[str]]:
    """Return the runs of pytest, several processes each; together they run every test once.

    The window's tests need a real X server where there is one to be had: only there do windows take the focus,
    does the pointer really move between widgets, and has the clipboard an owner. Elsewhere they run off screen.
    """
    pytest = [PYTHON, "-m", "pytest", "-q"]
    if importlib.util.find_spec("xdist"):
        pytest += ["-n", str(max(1, min(4, os.cpu_count() or 1))), "--dist", "worksteal"]
    last = ["--cov-append", "--cov-report=term:skip-covered", "--coverage-floors"]
    if shutil.which("Xvfb") is None:
        return {"tests, off screen": [*pytest, "--no-xvfb", "--cov", *last[1:]]}
    return {
        "tests without a window, and windows off screen": [
            *pytest, "--no-xvfb", *COVERAGE, "--ignore=tests/gui",
        ],
        "window tests under Xvfb": [*pytest, "tests/gui", *SCREEN, "--cov", *last],
    }  # fmt: skip


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else "test"))
