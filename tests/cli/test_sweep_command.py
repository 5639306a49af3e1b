"""``texlab sweep``: the sheet, its recipe, the report, and refusals before any work."""

from __future__ import annotations

import json
import re

import pytest
from PIL import Image

from tests.stub_method import running, stub  # noqa: F401
from texlab.cli.commands._options import own_presets
from texlab.cli.main import main
from texlab_core.documents.presets import Preset
from texlab_core.sheets.sweep_sources import find_sweep

pytestmark = pytest.mark.usefixtures("stub")
GRAVEL = "gallery:stochastic-gravel"


@pytest.fixture
def call(capsys, tmp_path):
    def run(*words, code=0):
        assert main(["sweep", *map(str, words), "--out", str(tmp_path / "sheet.png")]) == code
        return capsys.readouterr()

    return run


def answer(captured):
    assert captured.err == ""
    return json.loads(captured.out)


def test_one_knob_for_people(call, tmp_path):
    words = (GRAVEL, "--method", "stub", "--vary", "level=0:2:3", "--crop", "32x24+8+4", "--size", "40x20")
    lines = call(*words).out.splitlines()
    for level, line in enumerate(lines[:3]):
        assert re.fullmatch(rf"level {level}, V 0\.\d\d, copied {25 * level}%, candidates 7", line)
    assert lines[3:] == [f"{tmp_path / 'sheet.png'}: 3 cells"]
    with Image.open(tmp_path / "sheet.png") as sheet:
        assert sheet.mode == "RGB"
    recipe = find_sweep(str(tmp_path / "sheet.png"))
    assert recipe.size == (20, 40)
    assert recipe.axes[0].values == (0.0, 1.0, 2.0)
    assert recipe.exemplar.name == GRAVEL
    assert (recipe.exemplar.crop.width, recipe.exemplar.crop.top) == (32, 4)


def test_in_a_place_of_its_own_the_sheet_is_the_same(call, tmp_path):
    words = (GRAVEL, "--method", "stub", "--vary", "level=0:2:3", "--crop", "32x24+8+4", "--size", "40x20")
    lines = call(*words).out
    sheet = (tmp_path / "sheet.png").read_bytes()
    assert call(*words, "--processes", 1).out == lines
    assert (tmp_path / "sheet.png").read_bytes() == sheet
    assert "processes: must be a whole number from 1 to 256" in call(*words, "--processes", 0, code=2).err
    assert "cluster: must be an address" in call(*words, "--cluster", "here", code=2).err


def test_a_sheet_can_be_made_again_from_itself(call, tmp_path):
    call(
        GRAVEL,
        "--method",
        "stub",
        "--vary",
        "level=1,2",
        "--vary",
        "seed=1,2",
        "--size",
        "30x30",
        "--set",
        "rounds=3",
    )
    (tmp_path / "sheet.png").rename(tmp_path / "first.png")
    call("--sweep", tmp_path / "first.png")
    assert (tmp_path / "sheet.png").read_bytes() == (tmp_path / "first.png").read_bytes()


def test_json(call):
    found = answer(
        call(GRAVEL, "--method", "stub", "--vary", "level=1,3", "--size", "20x20", "--seed", "5", "--json")
    )
    assert found["method"] == "stub"
    assert found["seed"] == 5
    assert found["vary"] == [{"name": "level", "values": [1.0, 3.0]}]
    assert found["size"] == {"width": 20, "height": 20}
    assert [cell["values"] for cell in found["cells"]] == [{"level": 1.0}, {"level": 3.0}]
    assert found["cells"][0]["candidates"] == found["cells"][0]["measures"]["median-candidates"] == 7
    assert found["cells"][0]["error"] is None
    assert found["cells"][1] == {
        "values": {"level": 3.0},
        "copied": None,
        "candidates": None,
        "measures": {},
        "elapsed_s": None,
        "error": "level: 3 is what this stub fails at.",
    }


def test_one_preset_over_many_textures(call, tmp_path):
    folder = tmp_path / "photos"
    folder.mkdir()
    for name, side in (("b.png", 30), ("a.png", 20)):
        Image.effect_noise((side, side), 64).save(folder / name)
    (folder / "c.png").write_bytes(b"no picture")
    given = ("--textures", folder, "--textures", GRAVEL, "--method", "stub", "--size", "24x16", "--seed", "5")
    said = call(*given, "--vary", "seed=1,2", "--json")
    found = json.loads(said.out)
    assert said.err.startswith("texlab: One texture is left out: ")
    assert [each["name"] for each in found["textures"]] == ["a.png", "b.png", GRAVEL]
    assert found["exemplar"] is None
    assert found["size"] == {"width": 24, "height": 16}
    names = ("a.png", "b.png", "Gravel")
    assert [each["values"] for each in found["cells"]] == [
        {"texture": name, "seed": seed} for seed in (1, 2) for name in names
    ]
    lines = call(*given).out.splitlines()
    assert [line.partition(",")[0] for line in lines[:3]] == list(names)
    # In a process of its own, and again from its own sheet (of textures that are found by their names).
    call("--textures", GRAVEL, "--method", "stub", "--size", "24x16")
    first = (tmp_path / "sheet.png").read_bytes()
    call("--textures", GRAVEL, "--method", "stub", "--size", "24x16", "--processes", 1)
    assert (tmp_path / "sheet.png").read_bytes() == first
    (tmp_path / "sheet.png").rename(tmp_path / "first.png")
    call("--sweep", tmp_path / "first.png")
    assert (tmp_path / "sheet.png").read_bytes() == first


def test_failed_cells_are_counted(call):
    lines = call(GRAVEL, "--method", "stub", "--vary", "level=1,3", "--size", "20x20").out.splitlines()
    assert lines[1] == "level 3, failed: level: 3 is what this stub fails at."
    assert lines[2].endswith("2 cells, 1 failed")


def test_the_command_line_comes_before_recipe_and_preset(call, tmp_path):
    own_presets().save(Preset(name="mine", method="stub", parameters={"rounds": 5, "grain": 2}))
    recipe = {
        "format": "texlab-sweep",
        "version": 1,
        "name": "r",
        "method": "stub",
        "parameters": {"rounds": 4, "window": 9},
        "vary": [{"name": "level", "values": [1]}],
        "exemplar": {"name": GRAVEL, "scale": 0.5},
        "seed": 3,
    }
    (tmp_path / "r.json").write_text(json.dumps(recipe))
    words = ("--recipe", tmp_path / "r.json", "--size", "9x9", "--json")
    found = answer(call(*words))
    assert (found["parameters"]["rounds"], found["parameters"]["window"], found["seed"]) == (4, 9, 3)
    assert found["exemplar"]["name"] == GRAVEL
    found = answer(call(*words, "--preset", "mine", "--set", "grain=3", "--seed", "8", "--vary", "level=2"))
    assert (found["parameters"]["rounds"], found["parameters"]["window"], found["seed"]) == (5, 9, 8)
    assert found["parameters"]["grain"] == 3
    assert found["vary"] == [{"name": "level", "values": [2.0]}]
    other = answer(call("gallery:stochastic-cork", *words))
    assert other["exemplar"]["name"] == "gallery:stochastic-cork"
    cropped = answer(call(*words, "--crop", "16x16+0+0", "--scale", "1"))
    assert cropped["exemplar"]["sha256"] not in (found["exemplar"]["sha256"], other["exemplar"]["sha256"])


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ((GRAVEL, "--vary", "level=1,2"), "A sweep needs a method"),
        ((GRAVEL, "--method", "stub"), "A sweep varies one or two knobs"),
        (("--method", "stub", "--vary", "level=1,2"), "A sweep needs an exemplar"),
        ((GRAVEL, "--method", "stub", "--vary", "level=0:9:3"), "level: must be a number from 0 to 4, got 9."),
        ((GRAVEL, "--method", "stub", "--vary", "levle=1"), "did you mean level?"),
        ((GRAVEL, "--method", "stub", "--vary", "level=1", "--vary", "level=2"), "level twice"),
        (
            (GRAVEL, "--method", "stub", "--vary", "level=1", "--cell", "20"),
            "cell: must be a whole number from 64",
        ),
        (
            (GRAVEL, "--method", "stub", "--vary", "seed=1:400:400", "--size", "512x512"),
            "megapixels, and at most 64",
        ),
        ((GRAVEL, "--method", "no-such", "--vary", "level=1"), "method: must be one of"),
        (("--sweep", "no-such"), "There is no sweep called 'no-such'"),
        (("--sweep", "de-bonet-fig-11", "--method", "stub"), "is for the method de-bonet, not for stub."),
        (("--preset", "no-such", "--vary", "level=1"), "There is no preset called"),
        ((GRAVEL, "--method", "stub", "--vary", "level=1", "--seed", "x"), "seed: must be a whole number"),
    ],
)
def test_refusals_come_before_the_work(call, words, says, tmp_path):
    captured = call(*words, code=2)
    assert says in captured.err
    assert captured.err.count("\n") == 1
    assert captured.out == ""
    assert not running
    assert not (tmp_path / "sheet.png").exists()


def test_only_png_is_written(capsys, tmp_path):
    words = ["sweep", GRAVEL, "--method", "stub", "--vary", "level=1", "--out", str(tmp_path / "a.jpg")]
    assert main(words) == 2
    assert "out: must be a file name that ends in .png" in capsys.readouterr().err
