"""The window fits the screen that it is on."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import QRect

from tests.gui.conftest import make_everything
from texlab.app import start
from texlab.storage.settings import Settings
from texlab.style.theme import ThemeSource
from texlab.window.main_window import MainWindow
from texlab.window.screen_fit import first_window, panel_sizes, within

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer
    from texlab.window.screen_fit import Rect

SCREENS = [
    (round(width / scale), round((height - 40) / scale))
    for width, height in ((1024, 768), (1366, 768), (1920, 1080), (3840, 2160))
    for scale in (1.0, 1.5, 2.0)
]


@pytest.mark.parametrize("screen", SCREENS, ids=str)
def test_the_first_window_fits_and_uses_the_room(screen: tuple[int, int]) -> None:
    available = (100, 40, *screen)
    left, top, width, height = first_window(available)
    assert left >= 100
    assert top >= 40
    assert left + width <= 100 + screen[0]
    assert top + height <= 40 + screen[1]
    assert width >= min(1280, screen[0] - 2)
    assert width * height >= 0.6 * screen[0] * screen[1]
    gallery, parameters, docks = panel_sizes(width, height)
    assert width - gallery - parameters >= 0.35 * width
    assert docks <= 0.45 * height


@pytest.mark.parametrize("screen", SCREENS, ids=str)
@pytest.mark.parametrize(
    "window", [(0, 0, 800, 600), (-500, -500, 800, 600), (9000, 4000, 1280, 800), (10, 50, 7000, 5000)], ids=str
)
def test_a_window_that_comes_back_is_on_the_screen(screen: tuple[int, int], window: Rect) -> None:
    available = (0, 0, *screen)
    left, top, width, height = within(window, available)
    assert min(left, top) >= 0
    assert left + width <= screen[0]
    assert top + height <= screen[1]
    assert within((left, top, width, height), available) == (left, top, width, height)
    # What fits is not made smaller.
    assert width == min(window[2], screen[0] - 2)
    assert height == min(window[3], screen[1] - 32)


@pytest.mark.parametrize("screen", [(1024, 728), (1366, 728), (1920, 1040), (3840, 2120)], ids=str)
def test_a_real_window_takes_the_screens_size(
    qtbot: Any, monkeypatch: pytest.MonkeyPatch, screen: tuple[int, int]
) -> None:
    monkeypatch.setattr(MainWindow, "_available", lambda _: (0, 0, *screen))
    settings = Settings()
    window = start.build(settings, ThemeSource("light"))
    qtbot.addWidget(window)
    assert QRect(0, 0, *screen).contains(window.geometry())
    # A session from a larger screen.
    window.setGeometry(3000, 1500, 3600, 1900)
    settings.values["geometry"] = base64.b64encode(window.saveGeometry().data()).decode()
    again = start.build(settings, ThemeSource("light"))
    qtbot.addWidget(again)
    assert QRect(0, 0, *screen).contains(again.geometry())


def test_no_tab_makes_the_window_wider_than_a_small_screen(explorer: Explorer) -> None:
    """1366 x 768 at 200 % leaves 681 pixels within the frame."""
    make_everything(explorer)
    needed = {name: dock.minimumSizeHint().width() for name, dock in explorer.window.docks.items()}
    for name in needed.keys() - {"gallery", "parameters"}:
        assert needed["gallery"] + needed[name] + needed["parameters"] < 681 - 10, (name, needed[name])
    assert explorer.window.minimumSizeHint().width() <= 681
