"""``gui`` and ``screenshot``: what they hand to the window, and a real picture of it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.core.batch_tools import run_python
from texlab_core.images.formats.reading import read_image

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What the window was asked for."""
    import texlab.app.screenshot
    import texlab.app.start

    seen: list[Any] = []

    def screenshot(out: Path, **options: Any) -> int:
        seen.append((out, options))
        return 0

    def run_gui(image: str | None) -> int:
        seen.append(image)
        return 0

    monkeypatch.setattr(texlab.app.start, "run_gui", run_gui)
    monkeypatch.setattr(texlab.app.screenshot, "screenshot", screenshot)
    return seen


@pytest.mark.parametrize(("arguments", "image"), [([], None), (["gui"], None), (["gui", "wall.png"], "wall.png")])
def test_the_window_opens_with_or_without_an_image(
    texlab: Texlab, calls: list[Any], arguments: list[str], image: str | None
) -> None:
    assert texlab(*arguments).code == 0
    assert calls == [image]


def test_a_missing_library_is_said_in_one_sentence(texlab: Texlab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "PySide6.QtWidgets", None)
    shown = texlab("gui")
    assert shown.code == 2
    assert shown.err.startswith("texlab: The window needs Qt, which cannot be loaded (")
    assert shown.err.count("\n") == 1


def test_a_screenshot_has_width_first_and_a_known_texture(texlab: Texlab, calls: list[Any]) -> None:
    options = ("--size", "1000x700", "--theme", "light", "--gallery", "gallery:oriented-zebra")
    assert texlab("screenshot", "--out", "a.png", *options).code == 0
    given = {"size": (1000, 700), "theme": "light", "gallery": "oriented-zebra", "columns": None}
    assert calls == [(Path("a.png"), given)]


def test_a_screenshot_shows_the_columns_that_are_named(texlab: Texlab, calls: list[Any]) -> None:
    assert texlab("screenshot", "--out", "a.png", "--columns", "tiling, pixels,tiling").code == 0
    assert calls[0][1]["columns"] == ["tiling", "pixels", "tiling"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--out", "a.jpg"], "out: must be a file name that ends in .png"),
        (["--out", "no/a.png"], "The folder no does not exist"),
        (["--out", "a.png", "--size", "big"], "size: must be"),
        (["--out", "a.png", "--size", "100000x100"], "size: must be at most 8192 pixels a side"),
        (["--out", "a.png", "--gallery", "oriented-zebr"], "did you mean oriented-zebra"),
        (["--out", "a.png", "--theme", "pink"], "invalid choice"),
        (["--out", "a.png", "--columns", "tilin"], "did you mean tiling"),
        (["--out", "a.png", "--columns", ""], "method: must be"),
        (
            ["--out", "a.png", "--columns", ",".join(["tiling"] * 13)],
            "columns: must be at most 12 methods",
        ),
    ],
)
def test_mistakes_are_refused_before_the_window_is_made(
    texlab: Texlab, calls: list[Any], arguments: list[str], words: str
) -> None:
    shown = texlab("screenshot", *arguments)
    assert (shown.code, calls) == (2, [])
    assert words in shown.err
    assert shown.err.count("\n") == 1


def without_display() -> dict[str, str]:
    """Return the environment of a machine that has no display."""
    without = {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM", "QT_LOGGING_RULES"}
    return {name: value for name, value in os.environ.items() if name not in without}


@pytest.mark.slow
def test_the_real_window_is_drawn_off_screen(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "texlab", "screenshot", "--out", str(tmp_path / "window.png")]
    done = subprocess.run(
        [*command, "--size", "1100x750", "--gallery", "oriented-zebra", "--columns", "tiling,heeger-bergen"],
        capture_output=True,
        text=True,
        env=without_display(),
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    window = read_image(tmp_path / "window.png", "window").values
    assert window.shape[:2] == (750, 1100)
    # The zebra is black and white on a dark window: its columns hold far more contrast than the window's frame.
    middle = window[200:400, 300:800, :3].astype(np.float64)
    assert middle.std() > 40
    assert np.median(window[..., :3]) < 80


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="limits of Unix")
def test_a_screenshot_that_finds_no_room_leaves_what_was_there(tmp_path: Path) -> None:
    out = tmp_path / "out" / "window.png"
    out.parent.mkdir()
    out.write_bytes(b"before")
    limited = (
        "import resource, signal, sys\nfrom texlab.cli.main import main\nfrom texlab_core.files import whole\n"
        "write = whole.write_whole\n"
        "def limited(path, data):\n"
        "    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "    resource.setrlimit(resource.RLIMIT_FSIZE, (5_000, 5_000))\n"
        "    write(path, data)\n"
        "whole.write_whole = limited\nsys.exit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", limited, "screenshot", "--size", "900x700", "--columns", "tiling", "--out"]
    done = subprocess.run(
        [*command, str(out)],
        capture_output=True,
        text=True,
        env=without_display(),
        check=False,
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"texlab: {out}: cannot be written (File too large).\n"
    assert os.listdir(out.parent) == ["window.png"]
    assert out.read_bytes() == b"before"


def test_what_shows_the_window_loads_no_reader_and_no_method() -> None:
    code = (
        "import sys\nimport texlab.app.start, texlab.window.main_window\n"
        "late = ('texlab_core.documents', 'texlab_core.images', 'texlab_core.methods', 'cv2', 'numba', 'scipy')\n"
        "print([name for name in sys.modules if name.startswith(late)])"
    )
    done = run_python("-c", code)
    assert (done.stdout, done.stderr) == ("[]\n", "")
