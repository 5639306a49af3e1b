"""The real window, drawn off screen and saved as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QBuffer, QCoreApplication, QEventLoop, QTimer

from texlab.app.start import application, build, complete, theme_choice
from texlab.storage.settings import Settings
from texlab.style.theme import ThemeSource

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    from texlab.app.explorer import Explorer

LAYOUTS_INSIDE_EACH_OTHER = 8
SCREENSHOT_LIMIT_MS = 120_000


def screenshot(
    out: str | os.PathLike[str],
    *,
    size: tuple[int, int],
    theme: str = "dark",
    gallery: str | None = None,
    columns: Sequence[str] | None = None,
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
    columns
        Ids of the methods of the columns; None takes the first four.
    """
    from texlab_core.engine.registry import methods
    from texlab_core.errors import InputError
    from texlab_core.files.whole import write_whole

    app = application()
    # A picture changes no one's settings, and is no one's session.
    settings = Settings(kept=False)
    themes = ThemeSource(theme_choice(theme))
    window = build(settings, themes)
    window.resize(*size)
    window.show()
    explorer = complete(window, settings, themes)
    chosen = None if columns is None else [(name, methods()[name].params()) for name in columns]
    explorer.start(f"gallery:{gallery}" if gallery else None, columns=chosen)
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
    if explorer.window.parameters.form is not None:
        explorer.window.parameters.form.complete()
    # A layout asks the one around it, which asks the next: each in a round of its own.
    for _ in range(LAYOUTS_INSIDE_EACH_OTHER):
        QCoreApplication.processEvents()
    return done
