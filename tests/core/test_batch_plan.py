"""Plans are data: every combination once, in order, and one sentence for what does not fit."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from tests.core.batch_tools import photos
from texlab_core.batch.choices import ExemplarChoice, Grid, choices_of
from texlab_core.batch.further import load_further
from texlab_core.batch.plan import PlanError, SizeRule, bundled_plans, find_plan, plan_from_json, read_plan
from texlab_core.documents.preset_store import PresetStore
from texlab_core.documents.presets import Preset, write_preset
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.gallery import gallery
from texlab_core.methods.spectral.codefile import write_code

if TYPE_CHECKING:
    from pathlib import Path

WHOLE = {"inputs": ["in/*.png"], "methods": ["heeger-bergen", "de-bonet"], "seeds": [1, 2], "sizes": ["128x128"]}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    photos(tmp_path / "in")
    return tmp_path


def test_four_lists_are_a_whole_plan(folder: Path) -> None:
    plan = plan_from_json(WHOLE, folder=folder)
    assert [each.name for each in plan.exemplars] == ["in/photo-0.png", "in/photo-1.png", "in/photo-2.png"]
    assert [(each.name, each.method) for each in plan.variants] == [
        ("heeger-bergen", "heeger-bergen"),
        ("de-bonet", "de-bonet"),
    ]
    assert plan.seeds == (1, 2)
    assert plan.count == 3 * 2 * 2 * 1
    assert plan.sizes[0].of((30, 40)) == (128, 128)


def test_json_and_toml_say_the_same(folder: Path) -> None:
    (folder / "a.json").write_text(json.dumps(WHOLE), "utf-8")
    lines = [f"{key} = {json.dumps(value)}" for key, value in WHOLE.items()]
    (folder / "a.toml").write_text("\n".join(lines), "utf-8")
    assert read_plan(folder / "a.json") == read_plan(folder / "a.toml")
    assert read_plan(folder / "a.json").name == "a"
    (folder / "b.json").write_text(json.dumps(WHOLE | {"name": "Named"}), "utf-8")
    assert find_plan(str(folder / "b.json")).name == "Named"


def test_paths_are_relative_to_the_plan(folder: Path, tmp_path_factory: Any, monkeypatch: Any) -> None:
    (folder / "a.json").write_text(json.dumps(WHOLE), "utf-8")
    monkeypatch.chdir(tmp_path_factory.mktemp("elsewhere"))
    assert as_exemplar(read_plan(folder / "a.json").exemplars[0].source).size == (26, 30)


def test_every_form_of_input(folder: Path) -> None:
    (folder / "in" / "notes.txt").write_text("none", "utf-8")
    (folder / "list.txt").write_text("\ufeffin/photo-2.png\n\n gallery:oriented-fur \n", "utf-8")
    found = choices_of(
        ["in", "in/photo-0.png", "in/photo-[12].png", "gallery:oriented-fur", {"list": "list.txt"}], folder
    )
    # Each once, where it was first named.
    assert [each.name for each in found] == [
        *(f"in/photo-{number}.png" for number in range(3)),
        "gallery:oriented-fur",
    ]
    letters = choices_of(["gallery:letters"], folder)
    assert [each.source for each in letters] == [each.uri for each in gallery() if each.cls == "letters"]
    assert len(choices_of(["gallery:*"], folder)) == len(gallery())
    assert {each.source for each in choices_of(["gallery:*-fur"], folder)} == {"gallery:oriented-fur"}
    assert len(choices_of(["**/*.png"], folder)) == 3


def test_crops_and_scales_of_each(folder: Path) -> None:
    entry = {"from": "in/photo-1.png", "scales": [1, 0.5], "crops": ["10x8+3+2", "9x9+0+0"]}
    found = choices_of([entry], folder)
    assert [(each.scale, each.crop) for each in found] == [
        (scale, crop) for scale in (1.0, 0.5) for crop in (Crop(2, 3, 8, 10), Crop(0, 0, 9, 9))
    ]
    exemplar = found[0].load()
    assert exemplar.sha256 == as_exemplar(folder / "in/photo-1.png", crop=Crop(2, 3, 8, 10)).sha256
    assert found[2].part == "scale 0.5, crop 10x8+3+2"


def test_a_grid_of_crops_goes_from_edge_to_edge(folder: Path) -> None:
    found = choices_of([{"from": "in/photo-0.png", "crops": {"size": "10x6", "grid": "3x2"}}], folder)
    grids = [each.crop for each in found]
    assert all(isinstance(each, Grid) for each in grids)
    crops = [each.crop(26, 30, "a") for each in grids if isinstance(each, Grid)]
    assert crops == [Crop(top, left, 6, 10) for top in (0, 20) for left in (0, 10, 20)]
    assert found[4].part == "crop 5 of 6"
    assert Grid(4, 4, 1, 1, 0).crop(10, 20, "a") == Crop(3, 8, 4, 4), "a single one lies in the middle"
    with pytest.raises(
        InputError, match=r"^in/photo-0.png: crops of 64 x 6 pixels do not fit into its 30 x 26\.$"
    ):
        ExemplarChoice(str(folder / "in/photo-0.png"), "in/photo-0.png", 1.0, Grid(6, 64, 1, 1, 0)).load()


@pytest.mark.parametrize(
    ("text", "size"),
    [
        ("40x30", (30, 40)),
        ("40X30", (30, 40)),
        ("24", (24, 24)),
        ("2x", (20, 26)),
        ("1x", (10, 13)),
        ("0.5x", (5, 6)),
        ("1.5x", (15, 20)),
    ],
)
def test_sizes(text: str, size: tuple[int, int]) -> None:
    assert SizeRule(text).of((10, 13)) == size


def test_one_number_is_a_square(folder: Path) -> None:
    crops = [{"from": "in/photo-0.png", "crops": {"size": "8", "grid": "2"}}]
    plan = plan_from_json(WHOLE | {"inputs": crops, "sizes": [24, "32"]}, folder=folder)
    assert [each.of((10, 13)) for each in plan.sizes] == [(24, 24), (32, 32)]
    assert [each.load().size for each in plan.exemplars] == [(8, 8)] * 4


@pytest.mark.parametrize(
    ("text", "size"), [("6x5x4", (4, 5, 6)), ("7", (7, 7, 7)), ("1x", (10, 10, 10)), ("0.5x", (5, 5, 5))]
)
def test_sizes_of_solids(text: str, size: tuple[int, ...]) -> None:
    assert SizeRule(text).of((10, 13), 3) == size


def test_presets_and_settings(folder: Path) -> None:
    own = PresetStore(folder / "own")
    own.save(Preset(name="rough", method="de-bonet", parameters={"alpha": 0.3}))
    write_preset(Preset(name="file", method="de-bonet", parameters={"alpha": 0.4}), folder / "mine.json")
    data = {
        "inputs": ["in"],
        "methods": [{"method": "de-bonet", "set": {"alpha": 0.2}}, {"method": "de-bonet", "name": "plain"}],
        "presets": ["rough", "mine.json", "de-bonet/paper"],
        "seeds": {"from": 3, "count": 2},
    }
    plan = plan_from_json(data, folder=folder, presets=own)
    named = [(each.name, each.params.to_json()["alpha"]) for each in plan.variants]
    assert named == [
        ("de-bonet (alpha 0.2)", 0.2),
        ("plain", 0.15),
        ("de-bonet/rough", 0.3),
        ("de-bonet/file", 0.4),
        ("de-bonet/paper", 0.15),
    ]
    assert plan.seeds == (3, 4)
    assert plan.sizes == (SizeRule("1x"),)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"inputs": []}, "inputs: at least one is needed"),
        ({"inputs": ["out/*.png"]}, "inputs: out/*.png matches no image"),
        ({"inputs": ["missing.png"]}, "there is no file or folder missing.png"),
        ({"inputs": ["empty"]}, "the folder empty holds no image"),
        ({"inputs": [""]}, "the name of an image is empty"),
        ({"inputs": ["gallery:nothing-*"]}, "matches no texture"),
        ({"inputs": ["gallery:nothing"]}, "no texture called 'nothing'"),
        ({"inputs": [7]}, "inputs: must hold names"),
        ({"inputs": [{"from": "in", "cut": 1}]}, "key: must be one of from, list"),
        ({"inputs": [{"from": [1]}]}, "from: must be a name"),
        ({"inputs": [{"list": "none.txt"}]}, "list: none.txt cannot be read"),
        ({"inputs": [{"list": "in/photo-0.png"}]}, "it is not UTF-8 text"),
        ({"inputs": [{"from": "in", "scale": 1, "scales": [1]}]}, "either one scale or several"),
        ({"inputs": [{"from": "in", "scale": 1.5}]}, "scales: must be above 0"),
        ({"inputs": [{"from": "in", "scale": True}]}, "scales: must be above 0"),
        ({"inputs": [{"from": "in", "crops": []}]}, "crops: at least one"),
        ({"inputs": [{"from": "in", "crops": ["8x8"]}]}, "crops: must be width, height, left and top"),
        ({"inputs": [{"from": "in", "crops": {"size": "8x"}}]}, "crops: size must be two numbers"),
        ({"inputs": [{"from": "in", "crops": {"size": "8x8", "grid": "0x1"}}]}, "crops: grid must be two numbers"),
        ({"inputs": [{"from": "in", "crops": {"size": "8x8", "grid": "999x999"}}]}, "crops: at most"),
        ({"methods": ["de-bonnet"]}, "did you mean de-bonet"),
        ({"methods": []}, "methods: at least one"),
        ({"methods": [{"set": {}}]}, "methods: must hold ids"),
        ({"methods": [{"method": "de-bonet", "set": 1}]}, "set: must be an object"),
        ({"methods": [{"method": "de-bonet", "set": {"alpha": -1}}]}, "alpha: must be"),
        ({"methods": ["de-bonet", "de-bonet"]}, "de-bonet is there twice"),
        ({"presets": ["nothing"]}, "no preset called"),
        ({"presets": [1]}, "presets: must hold names or objects"),
        ({"seeds": []}, "seeds: must be a list"),
        ({"seeds": 3}, "seeds: must be a list"),
        ({"seeds": [-1]}, "seed: must be a whole number"),
        ({"seeds": {"from": 0}}, "seeds: count must be"),
        ({"seeds": {"from": 2147483647, "count": 2}}, "seed: must be a whole number"),
        ({"sizes": ["big"]}, "sizes: must be width and height"),
        ({"sizes": ["0x"]}, "sizes: must be width and height"),
        ({"sizes": ["0x8"]}, "for all sides, got '0x8'."),
        ({"sizes": [True]}, "sizes: must be a text"),
        ({"sizes": [-8]}, "sizes: must be width and height"),
        ({"measures": "w1-pixels"}, "measures: must be quick, all, or a list of ids"),
        ({"measures": ["w1-pixel"]}, "did you mean w1-pixels"),
        ({"bits": 12}, "bits: must be 8 or 16"),
        ({"bits": True}, "bits: must be 8 or 16"),
        ({"colour": 1}, "key: must be one of"),
        ({"format": "texlab-preset", "version": 1}, "it is no batch plan"),
        ({"format": "texlab-batch", "version": 2}, "made by a newer TexLab"),
        ({"seeds": {"count": 99999}}, "at most 100000 jobs"),
    ],
)
def test_what_does_not_fit_is_one_sentence(folder: Path, changes: dict[str, Any], sentence: str) -> None:
    (folder / "empty").mkdir()
    with pytest.raises(PlanError) as caught:
        plan_from_json(WHOLE | changes, folder=folder)
    assert sentence in str(caught.value)
    assert str(caught.value).startswith("The plan cannot be followed: ")
    assert str(caught.value).endswith(".")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("key", ["inputs", "methods"])
def test_what_is_missing_is_named(folder: Path, key: str) -> None:
    with pytest.raises(PlanError, match=f"{key}: is missing"):
        plan_from_json({name: value for name, value in WHOLE.items() if name != key}, folder=folder)
    with pytest.raises(PlanError, match="must be an object"):
        plan_from_json([], folder=folder)


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        ("a.json", "{", "is not valid JSON"),
        ("a.toml", "inputs = [", "is not valid TOML"),
        ("a.toml", b"\xff", "is not valid TOML"),
        ("a.toml", "name = nan", "holds a value that no plan has"),
        ("a.toml", "name = 2020-01-01", "holds a value that no plan has"),
        ("a.toml", "#" * 2**20 + "#", "is longer than"),
        ("a.txt", "", "A plan is a .json or .toml file"),
    ],
)
def test_files_that_are_no_plan(tmp_path: Path, name: str, text: str | bytes, sentence: str) -> None:
    (tmp_path / name).write_bytes(text.encode() if isinstance(text, str) else text)
    with pytest.raises(PlanError, match=sentence):
        read_plan(tmp_path / name)
    with pytest.raises(PlanError, match="cannot be read"):
        read_plan(tmp_path / f"no-{name}" if name != "a.txt" else tmp_path / "no.toml")


def test_a_sample_is_spread_over_the_plan(folder: Path) -> None:
    plan = plan_from_json(WHOLE, folder=folder)
    assert plan.sample(4) == {0, 3, 6, 9}
    assert plan.sample(99) == set(range(12))
    with pytest.raises(PlanError, match="sample: must be"):
        plan.sample(0)


def test_the_bundled_plan_is_de_bonets_experiment() -> None:
    assert bundled_plans() == ("de-bonet-800",)
    plan = find_plan("gallery:de-bonet-800")
    assert plan.count == len(plan.exemplars) == 800
    assert [each.method for each in plan.variants] == ["de-bonet"]
    assert plan.sizes[0].of((64, 64)) == (128, 128), "four times the area"
    for place in (0, 639, 640, 799):
        exemplar = plan.exemplars[place].load()
        assert exemplar.size == (64, 64)
        assert exemplar.channels == 3
    with pytest.raises(PlanError, match="there are gallery:de-bonet-800"):
        find_plan("gallery:nothing")


def test_further_inputs_of_a_method(folder: Path) -> None:
    second = {"from": "in/photo-1.png", "scale": 0.5, "crop": "10x8+1+2"}
    plan = plan_from_json(
        {
            "inputs": ["in"],
            "methods": [
                {"method": "mixture", "inputs": {"second": "gallery:stochastic-rock"}},
                {"method": "mixture", "set": {"weight": 0.25}, "inputs": {"second": second}},
                {"method": "mixture", "inputs": {"second": as_exemplar("gallery:oriented-fur")}, "name": "read"},
                {"method": "msg", "inputs": {"code": "code.msg.json"}},
            ],
        },
        folder=_with_code(folder),
    )
    assert [each.name for each in plan.variants] == [
        "mixture (second gallery:stochastic-rock)",
        "mixture (weight 0.25, second in/photo-1.png)",
        "read",
        "msg (code code.msg.json)",
    ]
    loaded = [load_further(each.inputs, find_method(each.method)) for each in plan.variants]
    taken = as_exemplar(folder / "in" / "photo-1.png", scale=0.5, crop=Crop(2, 1, 8, 10))
    assert loaded[0]["second"].sha256 == as_exemplar("gallery:stochastic-rock").sha256
    assert loaded[1]["second"].sha256 == taken.sha256
    assert loaded[2]["second"].sha256 == as_exemplar("gallery:oriented-fur").sha256
    assert type(loaded[3]["code"]).__name__ == "DataInput"


def _with_code(folder: Path) -> Path:
    code = run(Job(method="msg", inputs={"exemplar": as_exemplar("gallery:stochastic-rock", scale=0.25)})).model
    write_code(code.code, folder / "code.msg.json")
    return folder


@pytest.mark.parametrize(
    ("inputs", "sentence"),
    [
        ({}, "Mixture needs the input second"),
        ([], "inputs: must be an object as in"),
        ({"second": 3}, "second must be a file, gallery:NAME or an object"),
        ({"second": {"scale": 1}}, "second must be a file, gallery:NAME or an object"),
        ({"second": {"from": "in/photo-0.png", "size": 1}}, "size"),
        ({"second": {"from": "in/photo-0.png", "crop": "1x"}}, "crops: must be width, height, left and top"),
        ({"second": {"from": "in/photo-0.png", "crop": 5}}, "crops: must be width, height, left and top"),
        ({"second": {"from": "in/photo-0.png", "scale": True}}, "scales: must be above 0 and at most 1"),
        ({"second": "in/none.png"}, "there is no file 'in/none.png' for second"),
        ({"second": "in"}, "there is no file 'in' for second"),
        ({"second": "gallery:none"}, "gallery"),
        ({"second": "in/photo-0.png", "nope": "in/photo-0.png"}, "input: must be one of exemplar, second"),
        ({"exemplar": "in/photo-0.png"}, "the exemplars stand in the plan's own inputs"),
    ],
)
def test_further_inputs_that_do_not_fit(folder: Path, inputs: Any, sentence: str) -> None:
    with pytest.raises(PlanError) as caught:
        plan_from_json({"inputs": ["in"], "methods": [{"method": "mixture", "inputs": inputs}]}, folder=folder)
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_presets_take_further_inputs_too(folder: Path) -> None:
    write_preset(Preset.of("half", "mixture", find_method("mixture").params(weight=0.5)), folder / "half.json")
    given = {"preset": "half.json", "inputs": {"second": "in/photo-1.png"}}
    (variant,) = plan_from_json({"inputs": ["in"], "presets": [given]}, folder=folder).variants
    assert variant.name == "mixture/half (second in/photo-1.png)"
    assert [role for role, _ in variant.inputs] == ["second"]
    with pytest.raises(PlanError, match="presets: must hold names or objects"):
        plan_from_json({"inputs": ["in"], "presets": [{"inputs": {}}]}, folder=folder)
