"""Starting the window, and drawing it off screen."""

from __future__ import annotations

import contextlib
import gc
import signal
import sys
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QBuffer, QCoreApplication, QEventLoop, QTimer
from PySide6.QtWidgets import QApplication

from texlab.storage.settings import Settings
from texlab.style.theme import ThemeName, ThemeSource, apply_theme
from texlab.window.main_window import MainWindow

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from texlab.app.explorer import Explorer

SWITCH_INTERVAL_S = 0.001
SCREENSHOT_LIMIT_MS = 120_000


def application() -> QApplication:
    """Return the application, made on the first call."""
    existing = QApplication.instance()
    if isinstance(existing, QApplication):
        return existing
    made = QApplication(sys.argv[:1])
    made.setApplicationName("texlab")
    made.setApplicationDisplayName("")
    made.setDesktopFileName("texlab")
    # Work in other threads gives the window its turn sooner.
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    return made


def build(settings: Settings, themes: ThemeSource) -> MainWindow:
    """Return the shell of the window, without what is slow to import."""
    apply_theme(application(), themes.theme)
    return MainWindow(settings, themes)


def complete(window: MainWindow, settings: Settings, themes: ThemeSource) -> Explorer:
    """Put the images, the docks and the program behind them into the shell."""
    from texlab.style.theme import configure_pyqtgraph

    configure_pyqtgraph()
    from texlab.app.explorer import Explorer

    return Explorer(window, settings, themes)


def run_gui(image: str | None = None) -> int:
    """Open the window and return the exit code when it is closed."""
    app = application()
    settings = Settings()
    themes = ThemeSource(_choice(settings.text("theme", "auto")))
    window = build(settings, themes)
    window.show()

    def fill() -> None:
        explorer = complete(window, settings, themes)
        # What is there by now stays: collections of garbage, while code is loaded, take less of the window's time.
        gc.freeze()
        explorer.start(image)

    # The shell is painted before the rest is imported.
    QTimer.singleShot(0, lambda: QTimer.singleShot(0, fill))
    with closed_by_signals(window):
        code = app.exec()
    window.deleteLater()
    return code


@contextlib.contextmanager
def closed_by_signals(window: MainWindow) -> Iterator[None]:
    """Close the window properly on Ctrl+C in the terminal and when the system asks the program to end."""

    def close(*_: object) -> None:
        QTimer.singleShot(0, window.close)

    before = {number: signal.signal(number, close) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def screenshot(
    out: str | os.PathLike[str], *, size: tuple[int, int], theme: str = "dark", gallery: str | None = None
) -> int:
    """Draw the window with finished columns and save it.

    Parameters
    ----------
    out
        PNG file to write.
    size
        Width and height of the window.
    theme
        ``light`` or ``dark``.
    gallery
        Texture of the gallery; None takes the first one.
    """
    from texlab_core.errors import InputError
    from texlab_core.files.whole import write_whole

    app = application()
    settings = Settings()
    settings.values = {}
    settings.save = lambda: None  # type: ignore[method-assign]  # a picture changes no one's settings
    themes = ThemeSource(_choice(theme))
    window = build(settings, themes)
    window.resize(*size)
    window.show()
    explorer = complete(window, settings, themes)
    explorer.start(f"gallery:{gallery}" if gallery else None)
    finished = wait_until_idle(explorer)
    app.processEvents()
    picture = QBuffer()
    window.grab().save(picture, "PNG")
    window.close()
    window.deleteLater()
    app.processEvents()
    if not finished:
        raise InputError(f"The columns did not finish within {SCREENSHOT_LIMIT_MS // 1000} seconds.")
    write_whole(out, bytes(picture.data().data()))
    return 0


def wait_until_idle(explorer: Explorer, limit_ms: int = SCREENSHOT_LIMIT_MS) -> bool:
    """Process events until every column and every visible dock is done; False after the limit."""
    loop = QEventLoop()
    done = False

    def look() -> None:
        nonlocal done
        if explorer.idle:
            done = True
            loop.quit()

    watch, limit = QTimer(), QTimer()
    watch.setInterval(50)
    watch.timeout.connect(look)
    limit.setSingleShot(True)
    limit.timeout.connect(loop.quit)
    watch.start()
    limit.start(limit_ms)
    loop.exec()
    watch.stop()
    limit.stop()
    QCoreApplication.processEvents()
    return done


def _choice(name: str) -> ThemeName:
    return cast("ThemeName", name) if name in ("auto", "light", "dark") else "auto"
