"""The first run of a method: its code is loaded beside the columns, and nobody is held up by it."""

from __future__ import annotations

import os
import threading
from typing import TYPE_CHECKING, Any

import pytest

from tests.gui.conftest import PATIENCE_MS, hb, ids, wait_idle
from tests.stub_method import StubParams
from texlab.app.start import await_threads
from texlab.columns.status import status_parts
from texlab.runs import controller
from texlab_core.errors import Cancelled
from texlab_core.warming import Need, Warmth, every_need

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from texlab.app.explorer import Explorer
    from texlab_core.engine.registry import Method

STUB = ("stub", StubParams())


class Loader:
    """Everything is loaded at once but the stub, which takes until it may come, and minds no cancel."""

    def __init__(self) -> None:
        self.may_come = threading.Event()
        self.minds = False
        self.seen: list[Need] = []

    def __call__(self, need: Need, should_stop: Callable[[], bool]) -> None:
        self.seen.append(need)
        if need.method != "stub":
            return
        while not self.may_come.wait(0.001):
            if self.minds and should_stop():
                raise Cancelled


@pytest.fixture
def loader(monkeypatch: pytest.MonkeyPatch) -> Iterator[Loader]:
    loader = Loader()
    monkeypatch.setattr(controller, "Warmth", lambda: Warmth(loader))
    yield loader
    loader.may_come.set()


def status(explorer: Explorer, column_id: int) -> str:
    scene = explorer.controller.column_scene(column_id)
    assert scene is not None
    return scene.status


def wait_status(qtbot: Any, explorer: Explorer, column_id: int, wanted: str) -> None:
    qtbot.waitUntil(lambda: status(explorer, column_id) == wanted, timeout=PATIENCE_MS)


def line(explorer: Explorer, column_id: int) -> str:
    scene = explorer.controller.column_scene(column_id)
    assert scene is not None
    return " · ".join(status_parts(scene))


def wait_loading(qtbot: Any, explorer: Explorer, column_id: int) -> None:
    qtbot.waitUntil(lambda: line(explorer, column_id) == "loading", timeout=PATIENCE_MS)
    assert status(explorer, column_id) == "waiting"


def test_a_column_that_waits_for_its_code_is_free_as_soon_as_it_is_cancelled(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, stub: Method, loader: Loader
) -> None:
    explorer = open_window(str(texture), [hb(iterations=1)])
    (column_id,) = ids(explorer)
    session = explorer.session
    session.set_method(column_id, *STUB)
    wait_loading(qtbot, explorer, column_id)
    explorer.controller.stop_column(column_id)
    assert status(explorer, column_id) == "cancelled"
    # Its thread runs another method while that code is still being loaded.
    session.set_method(column_id, *hb(iterations=2))
    wait_status(qtbot, explorer, column_id, "finished")
    assert not loader.may_come.is_set()
    session.set_method(column_id, *STUB)
    wait_loading(qtbot, explorer, column_id)
    loader.may_come.set()
    wait_status(qtbot, explorer, column_id, "finished")
    assert "loading" not in line(explorer, column_id)


def test_a_column_that_waits_for_its_code_leaves_the_cores_to_others(
    qtbot: Any,
    open_window: Callable[..., Explorer],
    texture: Path,
    stub: Method,
    loader: Loader,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    explorer = open_window(str(texture), [hb(iterations=1), hb(iterations=1)])
    first, second = ids(explorer)
    explorer.session.set_method(first, *STUB)
    wait_loading(qtbot, explorer, first)
    explorer.controller.run_column(second)
    wait_status(qtbot, explorer, second, "finished")
    assert status(explorer, first) == "waiting"
    loader.may_come.set()
    wait_idle(qtbot, explorer)
    assert status(explorer, first) == "finished"


def test_what_the_columns_need_is_loaded_first(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, stub: Method, loader: Loader
) -> None:
    explorer = open_window(str(texture), [STUB, hb()], wait=False)
    wait_loading(qtbot, explorer, ids(explorer)[0])
    assert set(loader.seen) <= {Need("stub", 3), Need("heeger-bergen", 3)}
    loader.may_come.set()
    wait_idle(qtbot, explorer)
    # The rest comes when every column has its picture.
    qtbot.waitUntil(lambda: set(every_need()) <= set(loader.seen), timeout=PATIENCE_MS)


def test_a_method_whose_code_cannot_be_loaded_runs_all_the_same(
    qtbot: Any,
    open_window: Callable[..., Explorer],
    texture: Path,
    stub: Method,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    def fail(need: Need, should_stop: Callable[[], bool]) -> None:
        raise RuntimeError("No code.")

    monkeypatch.setattr(controller, "Warmth", lambda: Warmth(fail))
    explorer = open_window(str(texture), [STUB])
    assert status(explorer, ids(explorer)[0]) == "finished"
    assert "Loading stub failed" in caplog.text


def test_the_window_closes_while_code_is_loaded(
    qtbot: Any,
    open_window: Callable[..., Explorer],
    texture: Path,
    stub: Method,
    loader: Loader,
    caplog: pytest.LogCaptureFixture,
) -> None:
    loader.minds = True
    explorer = open_window(str(texture), [STUB], wait=False)
    wait_loading(qtbot, explorer, ids(explorer)[0])
    explorer.window.close()
    assert not explorer.window.isVisible()
    assert "did not end" not in caplog.text


def test_the_window_does_not_wait_for_what_is_being_compiled(
    open_window: Callable[..., Explorer],
    texture: Path,
    stub: Method,
    loader: Loader,
    qtbot: Any,
    caplog: pytest.LogCaptureFixture,
) -> None:
    explorer = open_window(str(texture), [STUB], wait=False)
    wait_loading(qtbot, explorer, ids(explorer)[0])
    explorer.window.close()
    # Closed, although the loader minds no cancel; at the end of the program its thread is waited for.
    (thread,) = (each for each in threading.enumerate() if each.name == "texlab-warming")
    assert thread.is_alive()
    assert "did not end" not in caplog.text
    loader.may_come.set()
    await_threads()
    assert not thread.is_alive()
