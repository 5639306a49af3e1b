"""Everything that must hold, stage by stage, with the time of each: ``python .ci/check.py [lint|test]``.

Runs in the virtual environment that ``setup_env.py`` has made. The stages of lint run beside each other; tests run
only when none of them fails, and stop at the first stage that does.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
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
# In a new clone compiling takes as long as all of lint together; the tests' processes would each do it again.
KERNELS = {"kernels": [PYTHON, "-c", "from texlab_core.warming import warm_up; warm_up()"]}
COVERAGE = ["--cov", "--cov-report="]
SCREEN = ["-o", "xvfb_width=1920", "-o", "xvfb_height=1200", "-o", "xvfb_colordepth=24"]


def main(goal: str) -> int:
    """Run the stages of ``goal``; return the exit code of the first that fails, or 0."""
    code = at_once(LINT if goal == "lint" else LINT | KERNELS)
    if code or goal == "lint":
        return code
    stages = tests()
    for name, command in stages.items():
        print(f"== {name}", flush=True)
        start = time.monotonic()
        environment = dict(os.environ)
        if "under Xvfb" in name:
            environment["TEXLAB_TEST_PLATFORM"] = "xcb"
        code = subprocess.run(command, cwd=ROOT, env=environment, stdin=subprocess.DEVNULL, check=False).returncode
        # pytest's own last lines tell the time of the last stage, and stay the last ones.
        if code or name != list(stages)[-1]:
            print(f"== {name}: {'failed after ' if code else ''}{time.monotonic() - start:.0f} s", flush=True)
        if code:
            return code
    return 0


def at_once(stages: dict[str, list[str]]) -> int:
    """Run stages beside each other, print what each says at its end; return 0, or the code of one that failed."""

    def run(name: str) -> int:
        start = time.monotonic()
        done = subprocess.run(
            stages[name], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
        )
        said = f"{done.stdout}{done.stderr}".strip()
        failed = "failed after " if done.returncode else ""
        lines = [f"== {name}", said, f"== {name}: {failed}{time.monotonic() - start:.0f} s"]
        print("\n".join(filter(None, lines)), flush=True)
        return done.returncode

    # The longest first: they wait for a processor, not for each other.
    with ThreadPoolExecutor(max(2, os.cpu_count() or 1)) as pool:
        return next(filter(None, list(pool.map(run, reversed(stages)))), 0)


def tests() -> dict[str, list[str]]:
    """Return the runs of pytest, several processes each; together they run every test once.

    The window's tests need a real X server where there is one to be had: only there do windows take the focus,
    does the pointer really move between widgets, and has the clipboard an owner. Elsewhere they run off screen.
    """
    pytest = [PYTHON, "-m", "pytest", "-q"]
    if importlib.util.find_spec("xdist"):
        # One more than processors, since tests wait for threads and processes; at most four, for the memory.
        pytest += ["-n", str(min(4, (os.cpu_count() or 1) + 1)), "--dist", "worksteal"]
    last = ["--cov-append", "--cov-report=", "--coverage-floors"]
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
