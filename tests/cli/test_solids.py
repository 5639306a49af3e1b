"""Solids on the command line: made, made again, drawn; inputs by name."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from texlab.cli.commands._options import parse_result_size
from texlab_core.errors import ParamError
from texlab_core.images.formats.volumes import read_volume

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab

MAKE = ("synth", "gallery:stochastic-granite", "--method", "solid", "--crop", "32x32+0+0", "--size", "12x10x8")


def test_sizes_have_as_many_numbers_as_the_method() -> None:
    assert parse_result_size("12x10x8", 3) == (8, 10, 12)
    assert parse_result_size("12X10×8", 3) == (8, 10, 12)
    assert parse_result_size("12x10", 2) == (10, 12)
    assert parse_result_size("12", 3) == (12, 12, 12)
    for text in ("12x10", "12x10x0", "12x10x8x4", "axbxc", "", "12x10x-8"):
        with pytest.raises(ParamError, match=f"width, height and depth as in 128x128x64.*got '{text}'"):
            parse_result_size(text, 3)


def test_a_solid_is_made_made_again_and_drawn(texlab: Texlab) -> None:
    made = texlab(*MAKE, "--out", "block.tif", "--json")
    assert (made.code, made.err) == (0, "")
    assert json.loads(made.out)["size"] == {"width": 12, "height": 10, "depth": 8}
    again = texlab("redo", "block.tif", "--out", "again.npy", "--json")
    assert (again.code, again.err) == (0, "")
    third = texlab("redo", "again.npy", "--out", "third.npy")
    assert "12 x 10 x 8 by solid" in third.out
    assert "The same bits" in third.out
    np.testing.assert_array_equal(read_volume("again.npy").values, read_volume("third.npy").values)
    for options, name in (
        ((), "a.png"),
        (("--show", "both", "--shape", "torus", "--yaw", "-40", "--zoom", "1.5"), "b.png"),
        (("--show", "slices", "--at", "11,9,7"), "c.png"),
        (("--motion", "turn", "--frames", "3", "--side", "32"), "d.webp"),
        (("--motion", "xz", "--rate", "5"), "e.gif"),
    ):
        drawn = texlab("solid", "block.tif", "--out", name, *options)
        assert (drawn.code, drawn.err) == (0, ""), drawn.err
        with Image.open(name) as picture:
            picture.load()
        redone = texlab("redo", name, "--out", "f.tif", "--json")
        assert (redone.code, json.loads(redone.out)["same_bits"]) == (0, None)
        np.testing.assert_array_equal(read_volume("f.tif").values, read_volume("block.tif").values)
    told = texlab("solid", "again.npy", "--out", "a.png", "--json")
    assert json.loads(told.out)["size"] == {"width": 12, "height": 10, "depth": 8}


def test_what_cannot_be_gets_one_sentence(texlab: Texlab) -> None:
    np.save("plain.npy", np.zeros((2, 2, 2, 1), np.float32))
    assert texlab("solid", "plain.npy", "--out", "a.png").code == 0
    for arguments, words in (
        ((*MAKE, "--out", "a.png"), "solids are written as"),
        ((*MAKE[:-1], "12x10", "--out", "a.tif"), "width, height and depth"),
        ((*MAKE[:-1], "300x2x2", "--out", "a.tif"), "at most 256 voxels a side"),
        ((*MAKE, "--out", "a.tif", "--input", "second=x.png"), "input: must be one of exemplar"),
        (("solid", "plain.npy", "--out", "a.png", "--at", "1,2"), "three whole numbers"),
        (("solid", "plain.npy", "--out", "a.png", "--show", "slices", "--at", "1,2,1"), "must lie in the solid"),
        (("solid", "plain.npy", "--out", "a.png", "--show", "both"), "holds no recipe"),
        (("solid", "plain.npy", "--out", "plain.npy"), "written as .png"),
        (("solid", "gone.tif", "--out", "a.png"), "cannot be opened"),
    ):
        shown = texlab(*arguments)
        assert shown.code == 2
        assert words in shown.err
        assert shown.err.count("\n") == 1


def test_what_the_machine_cannot_hold_is_refused_before_the_start(
    texlab: Texlab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("texlab_core.engine.estimate.machine_bytes", lambda: 1000)
    shown = texlab(*MAKE, "--out", "a.tif")
    assert (shown.code, shown.out) == (2, "")
    assert re.fullmatch(
        r".*Solid texture of 12 x 10 x 8 needs about 0\.0 GB of memory, and this machine has 0\.0 GB; .*\n",
        shown.err,
    )
    assert not Path("a.tif").exists()


def test_any_input_is_given_by_its_name(texlab: Texlab) -> None:
    mask = np.zeros((24, 20), np.uint8)
    mask[4:9, 5:11] = 255
    Image.fromarray(mask).save("mask.png")
    pebbles = "gallery:structured-pebbles"
    synth = ("synth", pebbles, "--method", "efros-leung", "--set", "window=5", "--size", "20x24")
    start = ("--input", f"start={pebbles}", "--input-scale", "start=0.5", "--input-crop", "start=20x24+3+4")
    made = texlab(*synth, "--crop", "30x30+0+0", "--out", "a.png", "--input", "mask=mask.png", *start)
    assert (made.code, made.err) == (0, "")
    assert json.loads(texlab("redo", "a.png", "--out", "b.png", "--json").out)["same_bits"] is True
    for options, words in (
        (("--input", "mask"), "a name and a source"),
        (("--input", "mask=mask.png", "--input", "mask=mask.png"), "given twice"),
        (("--input", "exemplar=mask.png"), "given twice"),
        (("--input-crop", "mask=2x2+0+0"), "--input does not"),
        (("--input", "mask=mask.png", "--input-scale", "mask=much"), "input-scale: must be a number"),
        (("--input", "state=mask.png"), "is no .npz file of arrays"),
        (("--input", "state=gone.npz"), "cannot be opened"),
        (("--input", "state=gone.npz", "--input-scale", "state=0.5"), "neither scaled nor cropped"),
        (("--input", "veil=mask.png"), "must be one of exemplar, start, mask, blend, region, patches, state"),
    ):
        shown = texlab(*synth, "--out", "c.png", *options)
        assert (shown.code, shown.err.count("\n")) == (2, 1)
        assert words in shown.err
    assert not Path("c.png").exists()


def test_a_code_may_be_named_too(texlab: Texlab) -> None:
    assert texlab("encode", "gallery:stochastic-rock", "--scale", "0.25", "--out", "a.msg.json").code == 0
    by_place = texlab("synth", "a.msg.json", "--method", "msg", "--size", "32x32", "--out", "a.png")
    assert (by_place.code, by_place.err) == (0, "")
    twice = texlab("synth", "a.msg.json", "--method", "msg", "--input", "code=a.msg.json", "--out", "b.png")
    assert "given twice" in twice.err


def test_methods_lists_what_a_method_takes(texlab: Texlab) -> None:
    shown = texlab("methods", "efros-leung").out
    assert "mask (image, not needed)" in shown
    assert "state (.npz file, not needed)" in shown
    assert "width x height from" in shown
    assert "width x height x depth" in texlab("methods", "solid").out
    assert json.loads(texlab("methods", "solid", "--json").out)["dimensions"] == 3


def test_a_strip_from_one_texture_to_another(texlab: Texlab) -> None:
    sweep = (
        "sweep",
        "gallery:stochastic-granite",
        "--method",
        "mixture",
        "--crop",
        "32x32+0+0",
        "--size",
        "24x24",
    )
    second = ("--input", "second=gallery:stochastic-bark", "--input-scale", "second=0.25")
    made = texlab(*sweep, "--vary", "weight=0:1:5", *second, "--out", "strip.png", "--json")
    assert (made.code, made.err) == (0, "")
    first = json.loads(made.out)
    assert [cell["error"] for cell in first["cells"]] == [None] * 5
    # The sheet knows both textures.
    assert texlab("sweep", "--recipe", "strip.png", "--out", "again.png").code == 0
    one, other = (np.asarray(Image.open(name).convert("RGB")) for name in ("strip.png", "again.png"))
    np.testing.assert_array_equal(one, other)
    other_second = ("--input", "second=gallery:stochastic-lava", "--input-crop", "second=32x32+0+0")
    assert texlab("sweep", "--recipe", "strip.png", *other_second, "--out", "third.png").code == 0
    assert (np.asarray(Image.open("third.png").convert("RGB")) != one).any()
    assert texlab("sweep", "--recipe", "mixture-strip", "--size", "16x16", "--out", "made.png").code == 0
    for arguments, words in (
        ((*sweep, "--vary", "weight=0,1", "--out", "x.png"), "needs the input second"),
        ((*sweep, "--vary", "weight=0,1", *second, "--out", "x.png", "--input", "thrid=a.png"), "must be one of"),
    ):
        shown = texlab(*arguments)
        assert (shown.code, shown.err.count("\n")) == (2, 1)
        assert words in shown.err
