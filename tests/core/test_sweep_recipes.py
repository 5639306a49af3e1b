"""Sweeps as JSON: what is written comes back, ranges equal the command line's, what is wrong gets one sentence."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from tests.stub_method import StubParams, exemplar, stub  # noqa: F401
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.params import describe
from texlab_core.engine.registry import find_method
from texlab_core.errors import RecipeError
from texlab_core.files import strict_json
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.writing import write_image
from texlab_core.sheets.sweep import Cell, Vary, sweep_of
from texlab_core.sheets.sweep_recipes import TEXT_KEY, ExemplarChoice, SweepRecipe, sweep_recipe_from_json
from texlab_core.sheets.sweep_running import run_sweep
from texlab_core.sheets.sweep_sheet import sweep_sheet, write_sheet
from texlab_core.sheets.sweep_sources import bundled_sweeps, find_sweep

pytestmark = pytest.mark.usefixtures("stub")


def document(**changes):
    data = {
        "format": "texlab-sweep",
        "version": 1,
        "name": "levels",
        "method": "stub",
        "vary": [{"name": "level", "values": [0.5, 1]}],
    }
    return {key: value for key, value in (data | changes).items() if value is not ...}


@pytest.mark.parametrize(
    ("axis", "text"),
    [
        ({"from": 0, "to": 1, "count": 5}, "level=0:1:5"),
        ({"from": 0.01, "to": 1, "count": 5, "log": True}, "level=0.01:1:5:log"),
        ({"from": 1, "to": 0, "count": 3, "log": False}, "level=1:0:3"),
        ({"values": [3, 0.1]}, "level=3,0.1"),
    ],
)
def test_an_axis_is_what_the_command_line_makes_of_it(axis, text):
    recipe = sweep_recipe_from_json(document(vary=[{"name": "level"} | axis]))
    assert recipe.axes == (Vary.parse(text, StubParams),)


def test_what_is_written_comes_back():
    data = document(
        note="Two\nlines",
        parameters={"border": "wrap"},
        vary=[{"name": "seed", "values": [1, 2]}, {"name": "exact", "values": [True, False]}],
        size={"width": 30, "height": 20},
        seed=7,
        exemplar={"name": "gallery:stochastic-gravel", "crop": {"top": 1, "left": 2, "height": 16, "width": 24}},
    )
    recipe = sweep_recipe_from_json(data)
    again = sweep_recipe_from_json(json.loads(strict_json.dumps(recipe.to_json())))
    assert again == recipe
    assert recipe.exemplar.crop == Crop(top=1, left=2, height=16, width=24)
    sweep = recipe.sweep()
    assert sweep.base.size == (20, 30)
    assert [(job.seed, job.params.exact) for job in sweep.jobs] == [(1, True), (2, True), (1, False), (2, False)]
    assert all(job.params.border == "wrap" for job in sweep.jobs)
    assert sweep.base.inputs["exemplar"].size == (16, 24)


def test_a_sweep_describes_itself_completely():
    chosen = as_exemplar("gallery:stochastic-gravel", scale=0.5, crop=Crop(top=0, left=0, height=16, width=16))
    job = Job(method="stub", inputs={"exemplar": chosen}, params=StubParams(rounds=3), size=(8, 9), seed=4)
    sweep = sweep_of(job, ["level=1,2"])
    recipe = SweepRecipe.of(sweep, "mine")
    again = sweep_recipe_from_json(json.loads(json.dumps(recipe.to_json()))).sweep()
    assert [each.params for each in again.jobs] == [each.params for each in sweep.jobs]
    assert again.base.size == (8, 9)
    assert again.base.seed == 4
    assert again.base.inputs["exemplar"].sha256 == chosen.sha256


def test_the_sheet_of_a_sweep_holds_the_numbers_of_its_cells(tmp_path):
    """Those that there are, in their places; a cell that failed has none, and what is no number is left out."""
    chosen = as_exemplar("gallery:stochastic-gravel", scale=0.5, crop=Crop(top=0, left=0, height=16, width=16))
    job = Job(method="stub", inputs={"exemplar": chosen}, params=StubParams(), size=(8, 9), seed=4)
    sweep = sweep_of(job, ["level=1,2,3"])
    numbers = {"w1-bands": 0.25, "laid-down": float("nan")}
    cells = [
        Cell(index=0, job=sweep.jobs[0], values={"level": 1}, error="It failed."),
        Cell(index=2, job=sweep.jobs[2], values={"level": 3}, measures=numbers),
    ]
    for name in ("sheet.png", "sheet.svg", "sheet.pdf"):
        write_sheet(tmp_path / name, sweep, cells)
        assert find_sweep(str(tmp_path / name)).measures == ({}, {}, {"w1-bands": 0.25})
    write_sheet(tmp_path / "none.png", sweep, [])
    assert find_sweep(str(tmp_path / "none.png")).measures == ()


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ([], "it is no sweep"),
        (document(format="texlab-preset"), "it is no sweep"),
        (document(version=3), "made by a newer TexLab"),
        (document(version=1.0), "version: must be a whole number"),
        (document(colour=1), "key: must be one of"),
        (document(name=...), "name: must be text"),
        (document(name="a\x1b"), "name: must be at most 80 printable"),
        (document(note=[]), "note: must be text"),
        (document(method="no-such"), "method: must be one of"),
        (document(method=3), "method: must be text"),
        (document(parameters={"level": 9}), "level: must be a number from 0 to 4"),
        (document(parameters=[]), "parameters: must be a JSON object"),
        (document(vary={}), "vary: must be a list"),
        (document(vary=[]), "one or two knobs, got 0"),
        (document(vary=[1]), "vary: must hold JSON objects"),
        (document(vary=[{"name": "level", "values": [9]}]), "level: must be a number from 0 to 4"),
        (document(vary=[{"name": "level", "values": "all"}]), "a list of values for level"),
        (document(vary=[{"name": "nope", "values": [9]}]), "one of level, grain"),
        (document(vary=[{"name": "level"}]), "either values or from, to, count"),
        (document(vary=[{"name": "level", "from": 0, "to": 1, "count": 2.5}]), "a count from 1 to 400"),
        (
            document(vary=[{"name": "level", "from": 0, "to": 1, "count": 2, "log": 1}]),
            "log must be true or false",
        ),
        (document(vary=[{"name": "level", "from": 0, "to": 1, "count": 2, "log": True}]), "a range above 0"),
        (document(vary=[{"name": "border", "from": 0, "to": 1, "count": 2}]), "a list of values for border"),
        (document(inputs={"second": {"name": "gallery:stochastic-rock"}}), "inputs: has no place here"),
        (document(inputs=[1]), "inputs: has no place here"),
        (document(measures={}), "measures: must be a list"),
        (document(measures=[{}] * 7), "measures: must hold the numbers of"),
        (document(vary=[{"name": "level", "values": [1]}], measures=[{"d": "1"}]), "a few numbers by name"),
        (document(size=[1, 2]), "size: must be a width and a height"),
        (document(size={"width": 0, "height": 9}), "size: must be height and width"),
        (document(seed=-1), "seed: must be a whole number"),
        (document(seed="1"), "seed: must be a whole number"),
        (document(exemplar="gravel"), "exemplar: must hold a name"),
        (document(exemplar={"name": "a", "scale": 0}), "scale must be a number above 0"),
        (document(exemplar={"name": "a", "scale": True}), "scale must be a number above 0"),
        (document(exemplar={"name": "a", "crop": [0, 0, 1, 1]}), "crop must hold top, left, height, width"),
        (
            document(exemplar={"name": "a", "crop": {"top": 0.5, "left": 0, "height": 1, "width": 1}}),
            "crop must hold",
        ),
    ],
)
def test_what_is_wrong_gets_one_sentence(data, says, tmp_path):
    path = tmp_path / "x.json"
    path.write_text(json.dumps(data))
    with pytest.raises(RecipeError) as caught:
        find_sweep(str(path))
    message = str(caught.value)
    assert message.startswith("The sweep x.json cannot be used: ")
    assert says in message
    assert message.endswith(".")
    assert "\n" not in message


def test_a_sheet_carries_its_recipe(tmp_path):
    recipe = sweep_recipe_from_json(document(note="Größe"))
    text = json.dumps(recipe.to_json(), ensure_ascii=False)
    write_image(tmp_path / "sheet.png", np.zeros((4, 4), np.float32), text={TEXT_KEY: text})
    assert find_sweep(str(tmp_path / "sheet.png")) == recipe
    write_image(tmp_path / "plain.png", np.zeros((4, 4), np.float32))
    with pytest.raises(RecipeError, match=r"plain\.png is no contact sheet of a sweep"):
        find_sweep(str(tmp_path / "plain.png"))
    (tmp_path / "text.png").write_text("hello")
    with pytest.raises(RecipeError, match="is no contact sheet"):
        find_sweep(str(tmp_path / "text.png"))
    with pytest.raises(RecipeError, match=r"cannot be opened \(No such file or directory\)"):
        find_sweep(str(tmp_path / "missing.png"))


def test_another_image_of_the_same_name_is_noticed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_image("wall.png", np.full((8, 8), 0.25, np.float32))
    choice = ExemplarChoice.of(as_exemplar("wall.png"))
    assert choice.load().sha256 == choice.sha256
    write_image("wall.png", np.full((8, 8), 0.5, np.float32))
    with pytest.raises(RecipeError, match=r"wall\.png is not the image that the sweep was made with"):
        choice.load()
    assert dataclasses.replace(choice, sha256="").load().size == (8, 8)


def test_a_recipe_without_an_exemplar_asks_for_one():
    recipe = sweep_recipe_from_json(document())
    with pytest.raises(RecipeError, match="does not say for which exemplar"):
        recipe.sweep()
    assert recipe.sweep(exemplar()).base.size == (16, 20)


def test_bundled_sweeps_are_usable():
    recipes = bundled_sweeps()
    assert len({each.name for each in recipes}) == len(recipes)
    for each in recipes:
        assert find_sweep(each.name) == each
        assert len(each.note) > 20
        assert len(each.sweep().jobs) > 1
    with pytest.raises(RecipeError, match=r"did you mean de-bonet-fig-11\?"):
        find_sweep("debonet-fig11")


@pytest.mark.parametrize("texts", [["level=0:2:3"], ["level=0:2:3", "exact=yes,no"]])
def test_a_sheet_shows_what_has_finished(texts):
    sweep = sweep_of(Job(method="stub", inputs={"exemplar": exemplar()}, size=(40, 40)), texts)
    cells = run_sweep(sweep)
    whole = sweep_sheet(sweep, cells)
    assert np.array_equal(whole, sweep_sheet(sweep, cells[::-1]))
    part = sweep_sheet(sweep, cells[:1])
    first = (cells[0].result.image * 255 + 0.5).astype(np.uint8)
    for sheet in (whole, part):
        windows = np.lib.stride_tricks.sliding_window_view(sheet, first.shape)
        assert (windows[:, :, 0, ::20, ::20] == first[::20, ::20]).all(axis=(2, 3, 4)).any()
    failed = Cell(index=1, job=sweep.jobs[1], values=sweep.values(1), error="No.")
    assert not np.array_equal(sweep_sheet(sweep, [cells[0], failed]), part)


def test_the_textbooks_assignment_c_is_ready_made():
    knobs = [
        axis.name for part in ("windows", "shapes", "criteria") for axis in find_sweep(f"efros-leung-{part}").axes
    ]
    assert knobs == ["window", "seed", "shape", "window", "criterion", "window"]
    # Fig. 11.22 is a figure of Efros and Leung, who say which windows they used.
    assert find_sweep("efros-leung-windows").axes[0].values == (5, 11, 15, 23)
    for part, choices in (("shapes", "shape"), ("criteria", "criterion")):
        offered = next(each for each in describe(find_method("efros-leung").params) if each.name == choices)
        assert find_sweep(f"efros-leung-{part}").axes[0].values == tuple(offered.knob.choices)
