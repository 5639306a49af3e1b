"""A whole window for the tests: two Heeger-Bergen columns on a small texture."""

from __future__ import annotations

import gc
import weakref
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shiboken6
from mouse import drag, handle_point, move, on_screen  # noqa: F401
from PIL import Image
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.stub_method import stub  # noqa: F401
from texlab.app import explorer as texlab_explorer  # noqa: F401 (before any test changes what it imports)
from texlab.app import start as texlab_app
from texlab.docks.lab.dock import LabDock
from texlab.storage.settings import Settings
from texlab.style.text_size import set_least
from texlab.style.theme import LIGHT, ThemeSource, set_text_size
from texlab.window.main_window import MainWindow
from texlab_core.engine.registry import methods
from texlab_core.warming import warm_up

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from texlab.app.explorer import Explorer

PATIENCE_MS = 180_000


@pytest.fixture(scope="session", autouse=True)
def compiled() -> None:
    """Compile the methods' kernels before any test waits for one: in a new clone that takes most of a minute."""
    warm_up()
    # What is loaded by now stays: looking through it for garbage takes most of a collection.
    gc.collect()
    gc.freeze()


@pytest.fixture(autouse=True)
def screen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give the window 1280 x 800 pixels, whatever the screen of the tests has."""
    monkeypatch.setattr(MainWindow, "_available", lambda _: (0, 0, 1282, 832))


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give up late, whatever a test asks for: waits end with what they wait for, however busy the machine is."""
    for name in ("waitUntil", "waitSignal", "waitSignals", "waitExposed", "waitActive"):
        monkeypatch.setattr(QtBot, name, _patient(getattr(QtBot, name)))


@pytest.fixture(autouse=True)
def clicks_arrive(monkeypatch: pytest.MonkeyPatch) -> None:
    """Click only what is on the screen: what was just opened is waited for, whoever clicks in it."""
    for name in ("mouseClick", "mouseDClick", "mousePress"):
        monkeypatch.setattr(QtBot, name, staticmethod(_arriving(getattr(QtBot, name))))


def _arriving(click: Callable[..., None]) -> Callable[..., None]:
    def later(widget: Any, *given: Any, **options: Any) -> None:
        handle = widget.window().windowHandle()
        if widget.isVisible() and not handle.isExposed():
            assert QTest.qWaitForWindowExposed(handle, PATIENCE_MS)
        click(widget, *given, **options)

    return later


def _patient(wait: Callable[..., Any]) -> Callable[..., Any]:
    def longer(self: QtBot, what: Any, *, timeout: int = 0, **options: Any) -> Any:
        return wait(self, what, timeout=max(timeout, PATIENCE_MS), **options)

    return longer


@pytest.fixture
def texture(tmp_path: Path) -> Path:
    """A 40 x 48 colour texture in a file."""
    rows, columns = np.mgrid[:40, :48]
    waves = 127 + 60 * np.sin(rows / 2.0) + 50 * np.cos(columns / 3.0)
    pixels = np.stack([waves, waves[::-1], np.full_like(waves, 90)], 2)
    noise = np.random.default_rng(3).normal(0, 12, pixels.shape)
    path = tmp_path / "waves.png"
    Image.fromarray(np.clip(pixels + noise, 0, 255).astype(np.uint8)).save(path)
    return path


def hb(**changes: Any) -> tuple[str, Any]:
    return "heeger-bergen", methods()["heeger-bergen"].params.from_json({"scales": 2, "iterations": 2, **changes})


@pytest.fixture
def open_window(qtbot: Any, qapp: Any) -> Iterator[Callable[..., Explorer]]:
    """Return a function that opens a window and waits until its columns have finished."""
    # A test may close a window and look for what stays of it.
    opened: list[weakref.ref[Explorer]] = []
    points = qapp.font().pointSizeF()

    def make(
        source: str | None, columns: list[tuple[str, Any]] | None = None, *, wait: bool = True, size: int = 48
    ) -> Explorer:
        settings = Settings()
        themes = ThemeSource("light")
        window = texlab_app.build(settings, themes)
        with qtbot.waitActive(window):
            window.show()
            window.activateWindow()
        # Most tests look at panels; what a first start shows is tested where the stage is.
        settings.values.setdefault("panels", True)
        explorer = texlab_app.complete(window, settings, themes, source)
        opened.append(weakref.ref(explorer))
        if columns is not None:
            explorer.saved = explorer.saved or {"seed": 5, "size": [size, size]}
        explorer.start(source, columns=columns)
        if wait:
            wait_idle(qtbot, explorer)
        return explorer

    yield make
    for explorer in filter(None, (each() for each in opened)):
        if shiboken6.isValid(explorer):
            window = explorer.window
            window.close()
            window.deleteLater()
    if qapp.font().pointSizeF() != points:
        # A window that taught: text is the application's.
        set_least(0.0)
        set_text_size(qapp, points, LIGHT)


@pytest.fixture
def open_new(qtbot: Any, qapp: Any) -> Iterator[Callable[..., Explorer]]:
    """Return a function that opens a window as it is at the first start, of a given size.

    Without a source nothing is kept from before, and nobody waits for the methods of the first sight.
    """
    opened: list[MainWindow] = []

    def make(source: str | None, columns: list[tuple[str, Any]] | None, size: tuple[int, int]) -> Explorer:
        settings, themes = Settings(), ThemeSource("light")
        window = texlab_app.build(settings, themes)
        window.resize(*size)
        with qtbot.waitActive(window):
            window.show()
            window.activateWindow()
        explorer = texlab_app.complete(window, settings, themes)
        opened.append(window)
        if source is None:
            explorer.start(None)
            qtbot.waitUntil(lambda: explorer.session.state.sample is not None)
            return explorer
        explorer.saved = {"seed": 5, "size": [48, 48]}
        explorer.start(source, columns=columns)
        wait_idle(qtbot, explorer)
        return explorer

    yield make
    for window in opened:
        window.close()
        window.deleteLater()


@pytest.fixture
def explorer(open_window: Callable[..., Explorer], texture: Path) -> Explorer:
    """A window with two finished Heeger-Bergen columns of 48 x 48."""
    return open_window(str(texture), [hb(), hb(iterations=1)])


def wait_idle(qtbot: Any, explorer: Explorer) -> None:
    idle = False
    while not idle:
        qtbot.waitUntil(lambda: explorer.idle, timeout=PATIENCE_MS)
        # What was announced last is shown on the next turn of the event loop, and may ask for more.
        with qtbot.waitSignal(explorer.presenter.painted, timeout=PATIENCE_MS):
            explorer.controller._refresh.start()
        idle = explorer.idle


def make_everything(explorer: Explorer) -> None:
    """Make every tab and every experiment, as if each had been looked at: for walks through the whole window."""
    for dock in explorer.docks:
        if isinstance(dock, LabDock):
            for place in (*range(dock.bar.count()), 0):
                dock.bar.setCurrentIndex(place)


def ids(explorer: Explorer) -> list[int]:
    return [column.id for column in explorer.session.state.columns]


def result_image(explorer: Explorer, column_id: int) -> Any:
    scene = explorer.controller.column_scene(column_id)
    assert scene is not None
    assert scene.result is not None, scene.message
    return scene.result.image
