"""What cannot be written or read is refused before anything is computed, by every command alike."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab.cli.main import find_commands
from texlab_core.images.formats.writing import write_image

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.cli.conftest import Texlab

pytestmark = pytest.mark.skipif(os.name == "nt", reason="pipes, devices and links of Unix")

EXEMPLAR = "exemplar.png"
WRITERS = {
    "synth": (["synth", EXEMPLAR, "--method", "tiling", "--out"], ".png"),
    "redo": (["redo", "saved.png", "--out"], ".png"),
    "fill": (["fill", EXEMPLAR, "--size", "40x40", "--out"], ".png"),
    "compare": (["compare", EXEMPLAR, "--methods", "tiling", "--out"], ".png"),
    "sweep": (["sweep", EXEMPLAR, "--method", "tiling", "--vary", "seed=1:2:2", "--out"], ".png"),
    "export": (["export", "saved.png", "--seeds", "1", "--out"], ".png"),
    "encode": (["encode", EXEMPLAR, "--out"], ".msg.json"),
    "solid": (["solid", "missing.tif", "--out"], ".png"),
    "screenshot": (["screenshot", "--out"], ".png"),
    "failures": (["failures", "coral", "--out"], ".png"),
    "tune": (["tune", EXEMPLAR, "--out"], ".json"),
}
READERS = {
    "synth": ["synth", "", "--method", "tiling", "--out", "a.png"],
    "redo": ["redo", "", "--out", "a.png"],
    "fill": ["fill", "", "--size", "40x40", "--out", "a.png"],
    "compare": ["compare", "", "--out", "a.png"],
    "sweep": ["sweep", "", "--method", "tiling", "--vary", "seed=1:2:2", "--out", "a.png"],
    "export": ["export", "", "--out", "a.png"],
    "encode": ["encode", "", "--out", "a.msg.json"],
    "tune": ["tune", "", "--out", "a.json"],
}


def folder(path: Path) -> None:
    path.mkdir()


def pipe(path: Path) -> None:
    os.mkfifo(path)


def device(path: Path) -> None:
    path.symlink_to("/dev/null")


def dangling(path: Path) -> None:
    path.symlink_to("nowhere.png")


@pytest.fixture
def ready(texlab: Texlab, monkeypatch: pytest.MonkeyPatch) -> Texlab:
    """Lay an exemplar and a saved result, and forbid to compute anything more."""
    pixels = np.random.default_rng(0).random((32, 32, 3)).astype(np.float32)
    write_image(EXEMPLAR, pixels)
    assert texlab("synth", EXEMPLAR, "--method", "tiling", "--out", "saved.png").code == 0

    def never(*_: Any, **__: Any) -> None:
        raise AssertionError("It was computed.")

    monkeypatch.setattr("texlab_core.engine.run._drive", never)
    monkeypatch.setattr("texlab_core.methods.spectral.encoding.encode", never)
    monkeypatch.setattr("texlab.app.screenshot.screenshot", never)
    return texlab


def test_every_command_that_writes_is_walked() -> None:
    import argparse

    from texlab.cli.main import build_parser

    (subparsers,) = (each for each in build_parser()._actions if isinstance(each, argparse._SubParsersAction))
    with_out = {
        name
        for name, parser in subparsers.choices.items()
        if any("--out" in action.option_strings for action in parser._actions)
    }
    assert with_out <= set(find_commands())
    # A batch writes into a folder, as maps are, and the laboratory's own tests walk its files.
    assert with_out - {"batch", "lab"} == set(WRITERS)


@pytest.mark.parametrize("make", [folder, pipe, device, dangling], ids=lambda make: make.__name__)
@pytest.mark.parametrize("command", WRITERS)
def test_targets_that_are_no_files(ready: Texlab, command: str, make: Callable[[Path], None]) -> None:
    words, suffix = WRITERS[command]
    make(Path(f"target{suffix}"))
    before = sorted(os.listdir())
    shown = ready(*words, f"target{suffix}")
    assert shown.code == 2
    assert shown.err.count("\n") == 1
    assert f"target{suffix}" in shown.err
    assert sorted(os.listdir()) == before


@pytest.mark.parametrize("command", WRITERS)
def test_targets_without_a_name_or_a_folder(ready: Texlab, command: str) -> None:
    words, suffix = WRITERS[command]
    before = sorted(os.listdir())
    for target in ("", f"missing/a{suffix}", f"{EXEMPLAR}/a{suffix}"):
        shown = ready(*words, target)
        assert shown.code == 2
        assert shown.err.count("\n") == 1
    assert sorted(os.listdir()) == before


@pytest.mark.parametrize("command", READERS)
def test_sources_without_a_name(ready: Texlab, command: str) -> None:
    shown = ready(*READERS[command])
    assert shown.code == 2
    assert "is empty" in shown.err
    assert shown.err.count("\n") == 1


@pytest.mark.parametrize("target", ["", "exemplar.png", "missing/maps", "dangling"])
def test_folders_for_maps(ready: Texlab, target: str) -> None:
    Path("dangling").symlink_to("nowhere")
    before = sorted(os.listdir())
    shown = ready("synth", EXEMPLAR, "--method", "tiling", "--out", "a.png", "--maps", target)
    assert shown.code == 2
    assert shown.err.count("\n") == 1
    assert sorted(os.listdir()) == before


def test_a_full_disk_replaces_nothing(texlab: Texlab, monkeypatch: pytest.MonkeyPatch) -> None:
    write_image(EXEMPLAR, np.random.default_rng(0).random((32, 32)).astype(np.float32))
    Path("o.png").write_bytes(b"old")
    write = os.write

    def full(descriptor: int, data: bytes) -> int:
        # The image fits, its maps do not.
        if len(os.listdir("maps")) > 1:
            raise OSError(28, "No space left on device")
        return write(descriptor, data)

    with monkeypatch.context() as patch:
        patch.setattr("texlab_core.files.whole.os.write", full)
        shown = texlab("synth", EXEMPLAR, "--method", "tiling", "--out", "o.png", "--maps", "maps")
    assert shown.code == 2
    assert "cannot be written (No space left on device)" in shown.err
    assert Path("o.png").read_bytes() == b"old"
    assert sorted(os.listdir()) == [EXEMPLAR, "o.png"]
