"""What stays on the clipboard when the program ends."""

from __future__ import annotations

import subprocess
import sys

PROGRAM = """
import numpy as np
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QApplication
from texlab.window.exchange import put_on_clipboard
app = QApplication([])
put_on_clipboard(b"bytes", np.zeros((4, 4, 3), np.uint8))
print(bytes(QGuiApplication.clipboard().mimeData().data("image/png").data()).decode())
"""


def test_the_program_ends_well_with_a_copied_picture() -> None:
    ended = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=120, check=False
    )
    assert (ended.returncode, ended.stdout.strip()) == (0, "bytes"), ended.stderr
