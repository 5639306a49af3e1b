"""``encode`` and ``synth`` of a code: the same bits as from the image, and one sentence for what cannot work."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from texlab_core.images.formats.reading import read_image
from texlab_core.methods.spectral.codefile import read_code

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab

GRAVEL = "gallery:stochastic-gravel"


def test_a_code_makes_what_the_image_makes_without_it(texlab: Texlab) -> None:
    shown = texlab("encode", GRAVEL, "--out", "g.msg.json")
    assert (shown.code, shown.err) == (0, "")
    assert shown.out == f"g.msg.json: {GRAVEL} in 69 numbers.\n"
    options = ("--method", "msg", "--size", "90x70", "--seed", "3")
    assert texlab("synth", "g.msg.json", *options, "--out", "a.png").code == 0
    assert texlab("synth", GRAVEL, *options, "--out", "b.png").code == 0
    one, other = (read_image(Path(name), name).values for name in ("a.png", "b.png"))
    assert one.shape[:2] == (70, 90)
    np.testing.assert_array_equal(one, other)
    # The recipe holds the code: the image can be made again without the file.
    Path("g.msg.json").unlink()
    assert texlab("redo", "a.png", "--out", "c.png").code == 0
    np.testing.assert_array_equal(read_image(Path("c.png"), "c.png").values, one)


def test_encode_says_what_it_measured_as_json(texlab: Texlab) -> None:
    shown = texlab("encode", "gallery:stochastic-bark", "--out", "b.MSG.JSON", "--bandwidths", "paper", "--json")
    answer = json.loads(shown.out)
    assert answer["numbers"] == 113
    assert answer["code"]["bandwidth_measure"] == "paper"
    assert answer["code"] == json.loads(Path("b.MSG.JSON").read_text(encoding="utf-8"))


def test_encode_crops_and_reduces(texlab: Texlab) -> None:
    assert texlab("encode", GRAVEL, "--out", "a.msg.json", "--scale", "0.5", "--crop", "64x48+3+4").code == 0
    assert read_code(Path("a.msg.json")).code != read_code_of(texlab)


def read_code_of(texlab: Texlab) -> object:
    texlab("encode", GRAVEL, "--out", "whole.msg.json")
    return read_code(Path("whole.msg.json")).code


def test_a_table_that_was_edited_changes_the_result(texlab: Texlab) -> None:
    texlab("encode", GRAVEL, "--out", "g.msg.json")
    data = json.loads(Path("g.msg.json").read_text(encoding="utf-8"))
    data["energies"] = [[0] * 4, [0] * 4, [400, 0, 0, 0], [0] * 4]
    Path("edited.msg.json").write_text(json.dumps(data), encoding="utf-8")
    assert texlab("synth", "edited.msg.json", "--method", "msg", "--out", "a.png").code == 0
    values = read_image(Path("a.png"), "a.png").values.astype(float)[..., 0]
    assert values.shape == (256, 256)
    transform = np.abs(np.fft.rfft2(values - values.mean())) ** 2
    assert transform[:40, 16:48].sum() + transform[-40:, 16:48].sum() > 0.5 * transform.sum()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("encode", GRAVEL, "--out", "g.json"), "ends in .msg.json"),
        (("encode", GRAVEL, "--out", "nowhere/g.msg.json"), "does not exist"),
        (("encode", "missing.png", "--out", "g.msg.json"), "missing.png"),
        (("encode", GRAVEL, "--out", "g.msg.json", "--scale", "2"), "scale"),
        (("synth", "missing.msg.json", "--method", "msg", "--out", "a.png"), "missing.msg.json"),
        (("synth", "bad.msg.json", "--method", "msg", "--out", "a.png"), "no MSG code"),
        (("synth", "bad.msg.json", "--method", "car", "--out", "a.png"), "needs an image"),
        (
            ("synth", "bad.msg.json", "--method", "msg", "--scale", "0.5", "--out", "a.png"),
            "neither scaled nor cropped",
        ),
    ],
)
def test_what_cannot_work_is_said_in_one_sentence(texlab: Texlab, arguments: tuple[str, ...], says: str) -> None:
    Path("bad.msg.json").write_text("{}", encoding="utf-8")
    shown = texlab(*arguments)
    assert shown.code == 2
    assert says in shown.err
    assert shown.err.count("\n") == 1
    assert not Path("a.png").exists()
    assert not Path("g.msg.json").exists()
