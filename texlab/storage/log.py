"""The log file: one writer for the window and the command line."""

from __future__ import annotations

import contextlib
import logging
import logging.handlers
import os
import sys
from typing import Any

from texlab.storage.paths import log_file
from texlab_core.files.regular import open_appending

MAX_BYTES = 1_000_000
OLD_FILES = 2


class LogFile(logging.handlers.RotatingFileHandler):
    """Writes to the log file; what cannot be written is lost without a word on the terminal: ``error`` has it."""

    error: BaseException | None = None

    def __init__(self) -> None:
        super().__init__(log_file(), maxBytes=MAX_BYTES, backupCount=OLD_FILES, encoding="utf-8", delay=True)
        self.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))

    def _open(self) -> Any:
        # Where nothing is said, no folder is made.
        with contextlib.suppress(OSError):
            os.makedirs(os.path.dirname(self.baseFilename), exist_ok=True)
        return open_appending(self.baseFilename)

    def handleError(self, record: logging.LogRecord) -> None:
        """Remember what is wrong."""
        self.error = sys.exc_info()[1] or OSError("it cannot be written")


def append_to_log(text: str) -> None:
    """Write a dated entry to the log file; raises ``OSError`` when that is not possible."""
    from texlab_core.version import __version__

    file = LogFile()
    try:
        entry = f"texlab {__version__}\n{text}"
        file.emit(logging.LogRecord("texlab", logging.ERROR, "", 0, entry, None, None))
    finally:
        file.close()
    if file.error is not None:
        raise file.error
