"""Fail the session when too little of a package is covered: ``pytest --cov --coverage-floors``.

The report stands above pytest's summary line, which stays the last thing printed.
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Generator

FLOORS = {"texlab_core": 90.0, "texlab": 80.0}
# Name, statements and missing ones of every file.
Row = tuple[str, int, int]
_TABLE = pytest.StashKey[list[Row]]()
_COVERED = pytest.StashKey[dict[str, float]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--coverage-floors", action="store_true", help="fail when a package is covered too little")


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> Generator[None, object, object]:
    outcome = yield
    plugin = session.config.pluginmanager.getplugin("_cov")
    if session.config.getoption("--coverage-floors"):
        if plugin is None or plugin.cov_controller is None:
            raise pytest.UsageError("--coverage-floors needs --cov.")
        session.config.stash[_TABLE] = _analyze(plugin.cov_controller.cov)
        session.config.stash[_COVERED] = {
            package: share(session.config.stash[_TABLE], package) for package in FLOORS
        }
    return outcome


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> Generator[None, object, object]:
    outcome = yield
    rows = config.stash.get(_TABLE, [])
    lacking = [row for row in rows if row[2]]
    for name, statements, missing in lacking:
        part = _percent([(name, statements, missing)])
        terminalreporter.write_line(f"{name:64} {statements:6} {missing:5} {part:5.1f} %")
    if rows:
        terminalreporter.write_line(f"{len(rows) - len(lacking)} files are covered wholly.")
    for package, percent in config.stash.get(_COVERED, {}).items():
        terminalreporter.write_line(f"{package}: {percent:.1f} % covered, at least {FLOORS[package]:g} % wanted")
    return outcome


def _analyze(coverage: Any) -> list[Row]:
    """Look at every file once: reports for people do it once each."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "coverage.json")
        coverage.json_report(outfile=str(path))
        files = json.loads(path.read_text("utf-8"))["files"]
    counts = {
        name: (file["summary"]["num_statements"], file["summary"]["missing_lines"]) for name, file in files.items()
    }
    return [(Path(name).as_posix(), *counts[name]) for name in sorted(counts)]


def _percent(rows: list[Row]) -> float:
    statements = sum(row[1] for row in rows)
    return 100.0 * (1 - sum(row[2] for row in rows) / statements) if statements else 100.0


def share(rows: list[Row], package: str) -> float:
    own = [row for row in rows if row[0].startswith(f"{package}/")]
    if not own:
        raise pytest.UsageError(
            f"--coverage-floors: no file of {package} was measured; run from the project's folder."
        )
    return _percent(own)


def pytest_sessionfinish(session: pytest.Session) -> None:
    covered = session.config.stash.get(_COVERED, {})
    short = any(percent < FLOORS[package] for package, percent in covered.items())
    if short and session.exitstatus == pytest.ExitCode.OK:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
