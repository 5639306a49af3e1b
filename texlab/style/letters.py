"""Letters where the system has none: in a bare root, or a container."""

from __future__ import annotations

from PySide6.QtGui import QFontDatabase, QFontInfo, QGuiApplication

_FILES = ("DejaVuSans", "DejaVuSans-Bold")


def ensure_letters() -> bool:
    """Take the program's own typeface where the system has no font at all, since text would be boxes there.

    Returns
    -------
    bool
        Whether it was needed.
    """
    # Names of families are listed also where no file stands behind them.
    if QFontInfo(QGuiApplication.font()).family():
        return False
    from texlab_core.files.resources import resource

    for name in _FILES:
        QFontDatabase.addApplicationFontFromData(resource(f"fonts/{name}.ttf").read_bytes())
    return True
