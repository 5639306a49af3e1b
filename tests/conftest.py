"""What holds for every test: nothing outside the test's folder is touched, and nothing is left running."""

from __future__ import annotations

import gc
import os
import random
import threading
import time
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from weakref import WeakSet

    from PySide6.QtCore import QPoint
    from PySide6.QtWidgets import QWidget

PLATFORM = os.environ.get("TEXLAB_TEST_PLATFORM", "offscreen")
os.environ["QT_QPA_PLATFORM"] = PLATFORM
os.environ["QT_LOGGING_RULES"] = "qt.qpa.*=false"
os.environ.setdefault("PYTHONHASHSEED", "0")

# The same examples on every run, and no clock: a failure can be repeated and load cannot cause one.
settings.register_profile("texlab", deadline=None, derandomize=True, database=None)
settings.load_profile("texlab")

pytest_plugins = ["tests.coverage_floor", "tests.coverage_rest"]
PATIENCE_S = 20.0
MOVE_S = 2.0


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the slow ones: of several processes none is left alone with one of them at the end."""
    items.sort(key=lambda item: item.get_closest_marker("slow") is None)


@pytest.fixture(autouse=True)
def texlab_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Keep settings, logs and presets of a test inside its own folder."""
    home = tmp_path / "texlab-home"
    monkeypatch.setenv("TEXLAB_HOME", str(home))
    return home


@pytest.fixture(autouse=True)
def no_global_random(request: pytest.FixtureRequest) -> Iterator[None]:
    """Fail a test whose code draws from a global generator; the terminal's library may draw from Python's."""
    import numpy as np

    def state() -> tuple[object, ...]:
        numpys = str(np.random.get_state())  # noqa: NPY002
        return (numpys, random.getstate()) if {"core", "contract"} & set(request.path.parts) else (numpys,)

    before = state()
    yield
    if state() != before:
        pytest.fail("The test (or what it called) used a global random generator.")


@pytest.fixture(autouse=True)
def no_leaked_threads() -> Iterator[None]:
    """Fail a test that leaves a thread behind."""
    before = set(threading.enumerate())
    yield

    def left() -> list[str]:
        return [each.name for each in threading.enumerate() if each not in before and each.is_alive()]

    if _persists(left):
        pytest.fail(f"Threads left running: {', '.join(left())}.")


@pytest.fixture(autouse=True)
def no_leaked_qt(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Iterator[None]:
    """Fail a test that leaves a top-level widget or a running timer behind."""
    if "gui" not in request.path.parts:
        yield
        return
    from PySide6.QtWidgets import QApplication

    before = {id(widget) for widget in QApplication.topLevelWidgets()}
    started = _watch_timers(monkeypatch)
    yield

    def left() -> list[str]:
        _delete_deferred()
        widgets = [widget for widget in QApplication.topLevelWidgets() if id(widget) not in before]
        timers = [timer for timer in list(started) if _is_running(timer)]
        return [f"{type(each).__name__} {each.objectName()!r}" for each in [*widgets, *timers]]

    if _persists(left):
        pytest.fail(f"Qt objects left behind: {', '.join(left())}.")


@pytest.fixture(autouse=True)
def desktop(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Make a bare X server a desktop: windows that appear get the keyboard, and moves of the mouse arrive."""
    if PLATFORM != "xcb" or "gui" not in request.path.parts:
        yield
        return
    from PySide6.QtCore import QEvent, QObject, Qt
    from PySide6.QtGui import QCursor, QShowEvent
    from PySide6.QtWidgets import QWidget

    app = request.getfixturevalue("qapp")
    activated = (Qt.WindowType.Window, Qt.WindowType.Dialog)

    class Manager(QObject):
        def eventFilter(self, watched: QObject, event: QEvent) -> bool:
            # Every event of the application comes here: asking for its class costs least.
            shown = isinstance(event, QShowEvent) and isinstance(watched, QWidget) and watched.isWindow()
            if shown and watched.windowType() in activated:
                watched.activateWindow()
                app.processEvents()
            return False

    # The server tells of a move only when there is one: every test starts with the pointer out of the way.
    QCursor.setPos(app.primaryScreen().geometry().bottomRight())
    manager = Manager()
    app.installEventFilter(manager)
    monkeypatch.setattr("pytestqt.qtbot.QtBot.mouseMove", staticmethod(_move_mouse))
    yield
    app.removeEventFilter(manager)


def _move_mouse(widget: QWidget, pos: QPoint, delay: int = -1) -> None:
    """Move the pointer and wait until the server, which answers later, has told of it."""
    from PySide6.QtCore import QEvent, QObject
    from PySide6.QtGui import QCursor, QMouseEvent
    from PySide6.QtTest import QTest
    from PySide6.QtWidgets import QApplication

    target = widget.mapToGlobal(pos)
    told: list[QPoint] = []

    class Listener(QObject):
        def eventFilter(self, watched: QObject, event: QEvent) -> bool:
            if isinstance(event, QMouseEvent) and event.type() == QEvent.Type.MouseMove:
                told.append(event.globalPosition().toPoint())
            return False

    listener = Listener()
    app = QApplication.instance()
    assert app is not None
    there = QCursor.pos() == target
    app.installEventFilter(listener)
    try:
        QTest.mouseMove(widget, pos, delay)
        # A pointer that is there already does not move, and beside the windows nothing is told.
        limit = time.monotonic() + MOVE_S
        while not there and target not in told and time.monotonic() < limit:
            QTest.qWait(1)
    finally:
        app.removeEventFilter(listener)


def _persists(left: Callable[[], list[str]]) -> bool:
    """Return whether something is left even after what is on its way out had time to go."""
    if not left():
        return False
    gc.collect()
    deadline = time.monotonic() + PATIENCE_S
    while left():
        if time.monotonic() > deadline:
            return True
        time.sleep(0.02)
    return False


def _delete_deferred() -> None:
    from PySide6.QtCore import QCoreApplication, QEvent

    if QCoreApplication.instance() is not None:
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def _watch_timers(monkeypatch: pytest.MonkeyPatch) -> WeakSet[object]:
    from weakref import WeakSet

    from PySide6.QtCore import QTimer

    started: WeakSet[object] = WeakSet()
    start = QTimer.start

    def recorded(timer: QTimer, *args: object) -> None:
        started.add(timer)
        start(timer, *args)  # type: ignore[call-overload]

    monkeypatch.setattr(QTimer, "start", recorded)
    return started


def _is_running(timer: object) -> bool:
    import shiboken6

    return shiboken6.isValid(timer) and timer.isActive()  # type: ignore[attr-defined]
