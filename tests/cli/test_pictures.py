"""Depth, transparency, masks and large pictures on the command line."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import imagecodecs
import numpy as np
import pytest

from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats import decoded
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.writing import write_image

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab

CASES = Path(__file__).parents[1] / "data" / "images"
NOISE = np.random.default_rng(0).integers(0, 256, (24, 20, 4), dtype=np.uint8)
DEEP = np.random.default_rng(1).integers(0, 65536, (24, 20, 3), dtype=np.uint16)


@pytest.fixture
def leaf(texlab: Texlab) -> str:
    """A picture with transparency, in the current folder."""
    Path("leaf.png").write_bytes(imagecodecs.png_encode(NOISE))
    return "leaf.png"


@pytest.mark.parametrize(
    ("options", "right"),
    [
        ((), {"background": 1.0}),
        (("--background", "black"), {"background": 0.0}),
        (("--background", "0.25"), {"background": 0.25}),
        (("--alpha", "ignore"), {"alpha": "ignore"}),
    ],
)
def test_transparency_is_used_as_asked(texlab: Texlab, leaf: str, options: tuple[str, ...], right: dict) -> None:
    done = texlab("synth", leaf, "--method", "tiling", "--out", "a.tif", "--bits", "float", *options)
    assert done.code == 0, done.err
    exemplar = as_exemplar(leaf, **right)
    assert exemplar.notes[0] in done.out
    made = read_image(Path("a.tif"), "a").values
    used = {tuple(each) for each in exemplar.pixels.reshape(-1, 3)}
    assert {tuple(each) for each in made.reshape(-1, 3)} <= used


def test_transparency_is_carried_and_redone(texlab: Texlab, leaf: str) -> None:
    done = texlab("synth", leaf, "--method", "pixels", "--alpha", "keep", "--out", "a.png")
    assert "The exemplar's transparency was carried along by the source map." in done.out
    made = read_image(Path("a.png"), "a").values
    # Colour and transparency come from one place.
    assert {tuple(each) for each in made.reshape(-1, 4)} <= {tuple(each) for each in NOISE.reshape(-1, 4)}
    again = texlab("redo", "a.png", "--out", "b.png")
    assert "The same bits as in a.png." in again.out
    done = texlab("synth", leaf, "--method", "pixels", "--alpha", "keep", "--out", "a.jpg")
    assert "The format holds no transparency; choose PNG, TIFF or WebP to keep it." in done.out
    done = texlab("synth", leaf, "--method", "heeger-bergen", "--alpha", "keep", "--out", "a.png")
    assert "The method keeps no places, so that the exemplar's transparency cannot come along." in done.out
    assert read_image(Path("a.png"), "a").values.shape[2] == 3


@pytest.mark.parametrize("level", ["-1", "1.5", "blue", "nan"])
def test_a_background_that_is_none(texlab: Texlab, leaf: str, level: str) -> None:
    done = texlab("synth", leaf, "--method", "tiling", "--out", "a.png", f"--background={level}")
    assert done.code == 2
    assert "background: must be black, white or a gray level from 0 to 1" in done.err


def test_commands_without_places_do_not_offer_to_keep(texlab: Texlab, leaf: str) -> None:
    done = texlab("compare", leaf, "--out", "a.png", "--alpha", "keep")
    assert done.code == 2
    assert "keep" in done.err


@pytest.mark.parametrize(
    ("name", "peak", "says"),
    [
        ("a.png", 65535, "Saved in 16 bits, as the exemplar has them."),
        ("a.tif", 65535, "Saved in 16 bits, as the exemplar has them."),
        ("a.webp", 255, "Saved in 8 bits, the most that the format holds; the exemplar has 16 bits."),
    ],
)
def test_results_are_as_deep_as_the_exemplar(texlab: Texlab, name: str, peak: int, says: str) -> None:
    Path("deep.png").write_bytes(imagecodecs.png_encode(DEEP))
    done = texlab("synth", "deep.png", "--method", "pixels", "--out", name)
    assert says in done.out
    assert read_image(Path(name), name).peak == peak
    plain = texlab("synth", "deep.png", "--method", "pixels", "--out", name, "--bits", "8")
    assert "Saved in" not in plain.out
    assert read_image(Path(name), name).peak == 255


def test_a_jpeg_mask_fills_what_its_original_does(texlab: Texlab) -> None:
    shutil.copy(CASES / "ell75.jpg", "ell75.jpg")
    options = ("--set", "window=5", "--set", "border=periodic")
    done = texlab("fill", CASES / "peb.png", "--mask", "ell75.jpg", "--out", "a.png", *options)
    assert done.code == 0, done.err
    assert "The mask ell75.jpg marks what is brighter than 0.5: 13.4 %." in done.out
    before, after = (read_image(Path(name), "a").values for name in (CASES / "peb.png", "a.png"))
    hole = np.pad(read_image(CASES / "ell.png", "a").values[..., 0] > 0, 1)
    near = hole[:-2, 1:-1] | hole[2:, 1:-1] | hole[1:-1, :-2] | hole[1:-1, 2:] | hole[1:-1, 1:-1]
    changed = (before != after).any(axis=2)
    assert not (changed & ~near).any()
    assert changed.sum() > 0.8 * hole.sum()
    refused = texlab("fill", CASES / "peb.png", "--mask", "ell75.jpg", "--out", "a.png", "--threshold", "2")
    assert refused.code == 2
    assert "threshold of a mask must be at least 0 and below 1, got 2.0" in refused.err


def test_a_gray_exemplar_and_a_start_in_colour(texlab: Texlab) -> None:
    write_image("gray.png", np.random.default_rng(2).random((20, 20)))
    write_image("colour.png", np.random.default_rng(2).random((20, 20, 3)))
    done = texlab("fill", "colour.png", "--exemplar", "gray.png", "--size", "30x30", "--out", "a.png")
    assert done.code == 2
    assert "The start image colour.png is in colour, and the exemplar gray.png is gray; choose a gray" in done.err


def test_folders_name_their_pictures(texlab: Texlab, leaf: str) -> None:
    done = texlab("synth", ".", "--method", "pixels", "--out", "a.png")
    assert done.code == 2
    assert ".: is a folder, not an image; its pictures: leaf.png." in done.err


def test_large_pictures_come_in_parts_and_can_be_redone(texlab: Texlab, monkeypatch: pytest.MonkeyPatch) -> None:
    write_image("large.png", np.random.default_rng(3).random((60, 80, 3)), bits=16)
    monkeypatch.setattr(decoded, "MAX_PIXELS", 1000)
    monkeypatch.setattr("texlab_core.images.exemplar.MAX_PIXELS", 1000)
    refused = texlab("synth", "large.png", "--method", "pixels", "--out", "a.png")
    assert refused.code == 2
    assert "a scale or a crop makes a larger one fit" in refused.err
    done = texlab("synth", "large.png", "--method", "pixels", "--out", "a.png", "--scale", "0.25", "--json")
    assert json.loads(done.out)["exemplar"]["size"] == {"width": 20, "height": 15}
    assert "The same bits" in texlab("redo", "a.png", "--exemplar", "large.png", "--out", "b.png").out


@pytest.mark.skipif(not hasattr(signal, "SIGTERM") or sys.platform == "win32", reason="needs POSIX signals")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT"])
def test_a_signal_ends_a_decoder(tmp_path: Path, name: str) -> None:
    """The process that decodes goes with the one that waits for it."""
    started = tmp_path / "started"
    sleeper = f"import os; open({str(started)!r}, 'w').write(str(os.getpid())); "
    code = (
        "import sys\n"
        "from texlab_core.images.formats import apart, decoded\n"
        "decoded.LIGHT_PIXELS = 0\n"
        # A decoder that never ends, confined as all are.
        f"apart._START = {sleeper!r} + 'import json, sys, time; path, job = json.loads(sys.argv[1]); '"
        " 'sys.path[:] = path; from texlab_core.images.formats.apart import _confine; _confine(job); '"
        " 'time.sleep(600) #{module}'\n"
        "from texlab.cli.main import main\n"
        f"sys.exit(main(['synth', {str(CASES / 'peb.png')!r}, '--method', 'pixels', '--out', "
        f"{str(tmp_path / 'a.png')!r}]))\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], cwd=Path(__file__).parents[2])
    try:
        while not started.exists() or not started.read_text():
            assert process.poll() is None
            time.sleep(0.01)
        child = int(started.read_text())
        process.send_signal(getattr(signal, name))
        assert process.wait(60) != 0
        # Nobody decodes any more; an orphan looks every 0.2 s whether it has a parent.
        while Path(f"/proc/{child}/stat").exists() and " Z " not in Path(f"/proc/{child}/stat").read_text():
            time.sleep(0.01)
    finally:
        process.kill()
    assert not (tmp_path / "a.png").exists()
