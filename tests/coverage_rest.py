"""Let files rest of which every line has run: nothing new can come of tracing them, and tracing costs half a run.

A file rests only when each line that its code can reach was recorded, in this process or in the data that will be
appended to; what is reported is therefore the same to the line. On a version of coverage that keeps its tables
elsewhere every file is traced to the end.
"""

from __future__ import annotations

import importlib.machinery
import itertools
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Generator
    from types import CodeType


class Rest:
    """Watches one tracer; :meth:`look` puts to rest what is complete, and returns the names of these files.

    Parameters
    ----------
    coverage
        The ``coverage.Coverage`` that traces this process.
    before
        Lines that ran in an earlier process whose data stay, by file.
    """

    def __init__(self, coverage: Any, before: dict[str, set[int]]) -> None:
        collector = getattr(coverage, "_collector", None)
        self._files: dict[str, Any] = getattr(collector, "should_trace_cache", {})
        self._ran: dict[str, set[int]] = getattr(collector, "data", {})
        self._before = before
        self._missing: dict[str, set[int]] = {}
        self._counts: dict[str, int] = {}

    def look(self) -> list[str]:
        rested = []
        for file in list(self._files.values()):
            if not file.trace:
                continue
            name = file.source_filename
            ran = self._ran.get(name, set())
            if self._counts.get(name) == len(ran):
                continue
            self._counts[name] = len(ran)
            if name not in self._missing:
                self._missing[name] = reachable(name) - self._before.get(name, set())
            self._missing[name] -= ran
            if not self._missing[name]:
                file.trace = False
                rested.append(name)
        return rested


def reachable(name: str) -> set[int]:
    """Return the lines of a file that can run; without a type checker some cannot."""
    code = importlib.machinery.SourceFileLoader(name, name).get_code(name)
    return _lines(code) - _checked(Path(name).read_text("utf-8").splitlines())


def _lines(code: CodeType) -> set[int]:
    own = {line for _, _, line in code.co_lines() if line}
    return own.union(*(_lines(each) for each in code.co_consts if hasattr(each, "co_lines")))


def _checked(text: list[str]) -> set[int]:
    """Return the numbers of lines that stand under ``if TYPE_CHECKING:`` at the left margin."""
    found: set[int] = set()
    for place, line in enumerate(text):
        if line == "if TYPE_CHECKING:":
            under = itertools.takewhile(
                lambda each: not each[1] or each[1][0] == " ", enumerate(text[place + 1 :])
            )
            found |= {place + 2 + number for number, _ in under}
    return found


_REST = pytest.StashKey[Rest]()


@pytest.hookimpl(wrapper=True, trylast=True)
def pytest_runtestloop(session: pytest.Session) -> Generator[None, object, object]:
    plugin = session.config.pluginmanager.getplugin("_cov")
    coverage = None if plugin is None or plugin.cov_controller is None else plugin.cov_controller.cov
    if coverage is not None:
        before: dict[str, set[int]] = {}
        if session.config.getoption("cov_append"):
            from coverage import CoverageData

            data = CoverageData(session.config.rootpath / coverage.get_option("run:data_file"))
            data.read()
            before = {name: set(data.lines(name) or ()) for name in data.measured_files()}
        session.config.stash[_REST] = Rest(coverage, before)
    return (yield)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    outcome = yield
    rest = item.config.stash.get(_REST, None)
    if rest is not None:
        rest.look()
    return outcome
