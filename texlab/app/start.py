"""Starting the window, and drawing it off screen."""

from __future__ import annotations

import contextlib
import gc
import signal
import sys
import threading
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QTimer
from PySide6.QtGui import QIcon, QPixmap
from PySide6.QtWidgets import QApplication

from texlab.app.malloc import keep_little
from texlab.storage.settings import Settings
from texlab.style.letters import ensure_letters
from texlab.style.theme import ThemeName, ThemeSource, apply_theme
from texlab.window.main_window import MainWindow

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab.app.explorer import Explorer

SWITCH_INTERVAL_S = 0.001
# The window has gone by then.
LAST_S = 30.0
ICON_SIZES = (32, 64, 256)


def application() -> QApplication:
    """Return the application, made on the first call."""
    existing = QApplication.instance()
    if isinstance(existing, QApplication):
        return existing
    keep_little()
    made = QApplication(sys.argv[:1])
    made.setApplicationName("texlab")
    made.setApplicationDisplayName("")
    made.setDesktopFileName("texlab")
    made.setWindowIcon(icon())
    ensure_letters()
    # Work in other threads gives the window its turn sooner.
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    return made


def icon() -> QIcon:
    """Return the program's icon; read as bytes, since the resources may lie inside an archive."""
    from texlab_core.files.resources import resource

    found = QIcon()
    for size in ICON_SIZES:
        picture = QPixmap()
        picture.loadFromData(resource(f"icons/texlab-{size}.png").read_bytes())
        found.addPixmap(picture)
    return found


def build(settings: Settings, themes: ThemeSource) -> MainWindow:
    """Return the shell of the window, without what is slow to import."""
    apply_theme(application(), themes.theme)
    return MainWindow(settings, themes)


def complete(window: MainWindow, settings: Settings, themes: ThemeSource, source: str | None = None) -> Explorer:
    """Put the images, the docks and the program behind them into the shell, to be started with a source."""
    from texlab.style.theme import configure_pyqtgraph

    configure_pyqtgraph()
    from texlab.app.explorer import Explorer
    from texlab.storage.projects import is_whole_session

    return Explorer(window, settings, themes, fresh=is_whole_session(source))


def run_gui(image: str | None = None) -> int:
    """Open the window and return the exit code when it is closed."""
    app = application()
    settings = Settings()
    themes = ThemeSource(theme_choice(settings.text("theme", "auto")))
    window = build(settings, themes)
    window.show()

    def fill() -> None:
        explorer = complete(window, settings, themes, image)
        # What is there by now stays: collections of garbage, while code is loaded, take less of the window's time.
        gc.freeze()
        explorer.start(image)
        explorer.tabs_at_rest.start()

    # The shell is painted before the rest is imported.
    QTimer.singleShot(0, lambda: QTimer.singleShot(0, fill))
    with closed_by_signals(window):
        code = app.exec()
    window.deleteLater()
    await_threads()
    return code


def await_threads() -> None:
    """Wait until the program's own threads have ended: compiled code must not be torn down under one of them."""
    for thread in threading.enumerate():
        if thread.name.startswith("texlab-") and thread is not threading.current_thread():
            thread.join(LAST_S)


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


def theme_choice(name: str) -> ThemeName:
    """Return the theme of this name, or what follows the system."""
    return cast("ThemeName", name) if name in ("auto", "light", "dark") else "auto"
