"""Text has letters also where the system has no font."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from texlab.style.letters import ensure_letters

ROOT = Path(__file__).resolve().parents[2]
EMPTY = '<?xml version="1.0"?><!DOCTYPE fontconfig SYSTEM "fonts.dtd"><fontconfig></fontconfig>'
# Letters as pixels, before and after: without a font each is the same box.
DRAWN = """
import json
import sys

from PySide6.QtGui import QColor, QFont, QFontInfo, QImage, QPainter

if sys.argv[1] == "ours":
    from texlab.app.start import application

    made = application()
else:
    from PySide6.QtWidgets import QApplication

    made = QApplication([])


def drawn(letter, bold):
    picture = QImage(60, 40, QImage.Format.Format_Grayscale8)
    picture.fill(QColor("white"))
    painter = QPainter(picture)
    font = QFont(made.font())
    font.setBold(bold)
    painter.setFont(font)
    painter.drawText(5, 25, letter)
    painter.end()
    return bytes(picture.constBits()).hex()


shown = [drawn(letter, bold) for bold in (False, True) for letter in "mWe\\u03b1\\u2013"]
print(json.dumps([QFontInfo(made.font()).family(), len(set(shown))]))
"""


def look(which: str, folder: Path) -> Any:
    (folder / "fonts.conf").write_text(EMPTY, "utf-8")
    there = os.environ | {"FONTCONFIG_FILE": str(folder / "fonts.conf"), "QT_QPA_PLATFORM": "offscreen"}
    done = subprocess.run(
        [sys.executable, "-c", DRAWN, which],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=there | {"TEXLAB_HOME": str(folder)},
        check=False,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.skipif(sys.platform != "linux", reason="Fonts are found by fontconfig")
def test_where_the_system_has_no_font_text_has_letters(tmp_path: Path) -> None:
    assert look("plain", tmp_path) == ["", 1], "the oracle: without a font, every letter is the same box"
    assert look("ours", tmp_path) == ["DejaVu Sans", 10]


def test_where_the_system_has_fonts_they_are_taken(qapp: Any) -> None:
    assert not ensure_letters()
