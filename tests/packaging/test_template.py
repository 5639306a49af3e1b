"""The template of a package is built, installed and used; its method is found, named with it, keeps promises."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEMPLATE = ROOT / "resources" / "docs" / "template"


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the template installed from a copy."""
    source = tmp_path_factory.mktemp("source") / "template"
    shutil.copytree(TEMPLATE, source, ignore=shutil.ignore_patterns("__pycache__"))
    target = tmp_path_factory.mktemp("site")
    flags = ["--no-deps", "--no-build-isolation", "--no-index", "--quiet", "--disable-pip-version-check"]
    command = [sys.executable, "-m", "pip", "install", str(source), "--target", str(target), *flags]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return target


def call(place: Path, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run Python with what is installed in ``place`` beside the program."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(place), str(ROOT)])}
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, cwd=folder, env=environment, check=False
    )


def test_its_method_is_found_and_named_with_its_package(installed: Path, tmp_path: Path) -> None:
    done = call(installed, tmp_path, "-m", "texlab", "methods", "stripes", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    about = json.loads(done.stdout)
    assert (about["package"], about["title"]) == ("texlab-stripes", "Stripes (texlab-stripes)")
    words = ["synth", "gallery:structured-pebbles", "--method", "stripes", "--size", "12x9", "--set", "width=3"]
    made = call(installed, tmp_path, "-m", "texlab", *words, "--out", "stripes.png", "--json")
    assert made.returncode == 0, made.stderr
    assert json.loads(made.stdout)["measures"]["stripes"] == 3.0
    # Its picture carries a recipe as every other one does.
    again = call(installed, tmp_path, "-m", "texlab", "redo", "stripes.png", "--out", "again.png", "--json")
    assert json.loads(again.stdout)["same_bits"] is True


def test_it_keeps_every_promise(installed: Path, tmp_path: Path) -> None:
    done = call(installed, tmp_path, "-m", "texlab_core.contract", "texlab_stripes")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.startswith("Stripes (texlab-stripes):\n")
    assert done.stdout.endswith("Every promise is kept.\n")


IN_THE_WINDOW = """
from texlab.app import start
from texlab.storage.settings import Settings
from texlab.style.theme import ThemeSource
from PySide6.QtCore import QEventLoop
from PySide6.QtWidgets import QApplication, QComboBox

app = QApplication([])
settings, themes = Settings(), ThemeSource("light")
window = start.build(settings, themes)
explorer = start.complete(window, settings, themes)
explorer.start(None)
while not (boxes := [box for box in window.findChildren(QComboBox) if box.objectName().startswith("method-")]):
    app.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents)
chosen = {boxes[0].itemText(place) for place in range(boxes[0].count())}
print("Stripes (texlab-stripes)" in chosen, "|", window.message_bar.label.text())
explorer.close()
"""


def test_a_broken_copy_is_named_and_left_out(installed: Path, tmp_path: Path) -> None:
    shutil.copytree(installed, tmp_path / "site")
    method = tmp_path / "site" / "texlab_stripes" / "method.py"
    method.write_text(method.read_text("utf-8") + "\nimport no_such_module\n", "utf-8")
    done = call(tmp_path / "site", tmp_path, "-m", "texlab", "methods")
    assert done.returncode == 0
    assert "stripes" not in done.stdout
    assert "heeger-bergen" in done.stdout
    assert done.stderr == (
        "texlab: The methods of texlab-stripes in texlab_stripes.method are left out, since it cannot be loaded "
        "(ModuleNotFoundError: No module named 'no_such_module').\n"
    )
    checked = call(tmp_path / "site", tmp_path, "-m", "texlab_core.contract", "texlab-stripes")
    assert checked.returncode == 2
    assert "no_such_module" in checked.stderr


@pytest.mark.slow
@pytest.mark.parametrize("broken", [False, True], ids=["whole", "broken"])
def test_the_window_offers_it_or_says_what_is_missing(installed: Path, tmp_path: Path, broken: bool) -> None:
    shutil.copytree(installed, tmp_path / "site")
    if broken:
        (tmp_path / "site" / "texlab_stripes" / "method.py").write_text("1 / 0", "utf-8")
    done = call(tmp_path / "site", tmp_path, "-c", IN_THE_WINDOW)
    assert done.returncode == 0, done.stderr
    offered, said = (part.strip() for part in done.stdout.split("|"))
    assert offered == str(not broken)
    assert ("texlab-stripes" in said) == broken
