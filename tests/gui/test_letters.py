"""Text has letters also where the system has no font."""

from __future__ import annotations

import ast
import html
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from texlab.style.letters import ensure_letters
from texlab_core.sheets.typeface import typeface

ROOT = Path(__file__).resolve().parents[2]
CODE = ("texlab", "texlab_core")
WRITTEN = {".md", ".json", ".toml", ".tsv", ".txt"}
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


signs = "mWe\\u03b1\\u2013\\u21b6\\u2605\\u283f"
shown = [len({drawn(letter, bold) for letter in signs}) for bold in (False, True)]
print(json.dumps([QFontInfo(made.font()).family(), *shown]))
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
    assert look("plain", tmp_path) == ["", 1, 1], "the oracle: without a font, every letter is the same box"
    assert look("ours", tmp_path) == ["DejaVu Sans", 8, 8]


def test_where_the_system_has_fonts_they_are_taken(qapp: Any) -> None:
    assert not ensure_letters()


def literals(source: str) -> str:
    """Return all texts that a module may show, one after the other."""
    nodes = ast.walk(ast.parse(source))
    return "".join(node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str))


def foreign(text: str) -> set[str]:
    """Return what one of our typefaces has no sign for; entities of rich text count as what they stand for."""
    faces = typeface("regular"), typeface("bold")
    signs = {each for each in html.unescape(text) if each.isprintable()}
    return {each for each in signs if any(ord(each) not in face.glyphs for face in faces)}


def test_what_has_no_sign_is_found() -> None:
    code = 'x = f"\\u00d7 {1} \U0001f600", "&#x1f601;", b"\\xff"'
    assert foreign(literals(code)) == {"\U0001f600", "\U0001f601"}


def test_the_programs_own_typeface_has_every_sign_of_its_texts() -> None:
    texts = {path: literals(path.read_text("utf-8")) for name in CODE for path in (ROOT / name).rglob("*.py")}
    written = (path for path in (ROOT / "resources").rglob("*") if path.suffix in WRITTEN)
    texts |= {path: path.read_text("utf-8") for path in written}
    assert len(texts) > 300
    assert {str(path): lacking for path, text in texts.items() if (lacking := foreign(text))} == {}
