"""Anything unexpected: logged, told in one sentence, and the session goes on."""

from __future__ import annotations

import faulthandler
import logging
import sys
import threading
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QtMsgType, Signal, qInstallMessageHandler

from texlab.storage.log import LogFile
from texlab.storage.paths import log_file
from texlab_core.files.regular import reason

if TYPE_CHECKING:
    from types import TracebackType

log = logging.getLogger("texlab")
_QT_LEVELS = {
    QtMsgType.QtDebugMsg: logging.DEBUG,
    QtMsgType.QtInfoMsg: logging.INFO,
    QtMsgType.QtWarningMsg: logging.WARNING,
    QtMsgType.QtCriticalMsg: logging.ERROR,
    QtMsgType.QtFatalMsg: logging.CRITICAL,
}


class CrashHandler(QObject):
    """Catches what nothing else caught, in slots and in threads; ``crashed(sentence)`` tells the window."""

    crashed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._handler: LogFile | None = None
        self._before = (sys.excepthook, threading.excepthook)

    def install(self) -> None:
        """Start logging to the file and take over the hooks."""
        self._handler = LogFile()
        log.addHandler(self._handler)
        log.setLevel(logging.INFO)
        sys.excepthook = self._caught
        threading.excepthook = self._caught_in_thread
        qInstallMessageHandler(self._qt_message)
        if sys.stderr is not None and not faulthandler.is_enabled():
            faulthandler.enable()

    def remove(self) -> None:
        """Give the hooks back."""
        sys.excepthook, threading.excepthook = self._before
        qInstallMessageHandler(None)
        if self._handler is not None:
            log.removeHandler(self._handler)
            self._handler.close()
            self._handler = None

    def _caught(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if issubclass(kind, KeyboardInterrupt):
            self._before[0](kind, error, trace)
            return
        log.critical("Unexpected error.", exc_info=(kind, error, trace))
        trouble = None if self._handler is None else self._handler.error
        where = (
            f"the log {log_file()} cannot be written ({reason(trouble)})"
            if trouble is not None
            else f"the details are in {log_file()}"
        )
        self.crashed.emit(
            f"Something went wrong that should not ({kind.__name__}: {error}). Your session goes on; {where}."
        )

    def _caught_in_thread(self, caught: Any) -> None:
        if caught.exc_type is not SystemExit:
            self._caught(caught.exc_type, caught.exc_value or caught.exc_type(), caught.exc_traceback)

    def _qt_message(self, level: QtMsgType, context: object, text: str) -> None:
        log.log(_QT_LEVELS.get(level, logging.INFO), "Qt: %s", text)
