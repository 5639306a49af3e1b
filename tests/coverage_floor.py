"""Fail the session when too little of a package is covered: ``pytest --cov --coverage-floors``.

The report stands above pytest's summary line, which stays the last thing printed.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Generator

FLOORS = {"texlab_core": 90.0, "texlab": 80.0}
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
        session.config.stash[_COVERED] = {
            package: plugin.cov_controller.cov.report(include=[f"{package}/*"], file=io.StringIO())
            for package in FLOORS
        }
    return outcome


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> Generator[None, object, object]:
    outcome = yield
    for package, percent in config.stash.get(_COVERED, {}).items():
        terminalreporter.write_line(f"{package}: {percent:.1f} % covered, at least {FLOORS[package]:g} % wanted")
    return outcome


def pytest_sessionfinish(session: pytest.Session) -> None:
    covered = session.config.stash.get(_COVERED, {})
    short = any(percent < FLOORS[package] for package, percent in covered.items())
    if short and session.exitstatus == pytest.ExitCode.OK:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
