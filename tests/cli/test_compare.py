"""``compare``: a sheet of several methods, parameter counts, distances, one phase or several."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from texlab_core.engine.inputs import Crop
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image
from texlab_core.sheets.comparison import FIG_8, FIRST_SIGHT, compare, comparison_sheet, plan

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab

GRASS = "gallery:stochastic-grass"
SMALL = ("--crop", "96x96+0+0")


def test_the_sheet_of_figure_8(texlab: Texlab) -> None:
    shown = texlab("compare", GRASS, "--same-phase", "--out", "s.png", *SMALL, "--json")
    assert (shown.code, shown.err) == (0, "")
    answer = json.loads(shown.out)
    found = {each["method"]: each for each in answer["methods"]}
    assert tuple(found) == FIG_8
    assert {each["seed"] for each in answer["methods"]} == {0}
    assert [found[name]["numbers"] for name in FIG_8] == [96 * 96 // 2 + 2 + 256, 69, 76, 77]
    assert found["uncoded"]["log_spectral_distance_db"] == min(
        each["log_spectral_distance_db"] for each in answer["methods"]
    )
    sheet = read_image(Path("s.png"), "s.png").values
    assert sheet.shape[1] > 5 * 96
    exemplar = as_exemplar(GRASS).pixels[:96, :96, 0]
    np.testing.assert_array_equal(sheet[8:104, 8:104, 0], np.rint(exemplar * 255))


def test_the_cells_are_what_synth_makes(texlab: Texlab) -> None:
    exemplar = as_exemplar(GRASS)
    jobs = plan(exemplar, ("msg", "car"), size=(60, 80), seed=5)
    assert [job.seed for job in jobs] == [5, 6]
    for job, each in zip(jobs, compare(jobs), strict=True):
        assert each.result is not None
        np.testing.assert_array_equal(each.result.image, run(job).image)


def test_each_method_gets_a_line(texlab: Texlab) -> None:
    shown = texlab("compare", GRASS, "--methods", "msg, ac-h", "--size", "64x64", "--out", "s.png", *SMALL)
    lines = shown.out.splitlines()
    assert lines[0].startswith("msg, seed 0: 69 numbers; ")
    assert lines[1].startswith("ac-h, seed 1: 77 numbers; ")
    assert lines[2] == "s.png: 2 methods"


def test_the_first_sight_names_methods_that_exist() -> None:
    assert set(FIG_8) | set(FIRST_SIGHT) <= set(methods())


def test_a_comparison_can_be_stopped() -> None:
    exemplar = as_exemplar(GRASS)
    stop = threading.Event()
    seen: list[float] = []

    def watch(share: float) -> None:
        seen.append(share)
        stop.set()

    with pytest.raises(Cancelled):
        compare(plan(exemplar, FIG_8), on_progress=watch, should_stop=stop.is_set)
    assert seen


def test_a_method_that_fails_leaves_its_place_and_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    import texlab_core.sheets.comparison as module

    def refuse(*args: object, **options: object) -> None:
        raise InputError("It cannot be done.")

    exemplar = as_exemplar(GRASS)
    jobs = plan(exemplar, ("msg",))
    monkeypatch.setattr(module, "run", refuse)
    compared = compare(jobs)
    assert compared[0].result is None
    assert compared[0].error == "It cannot be done."
    assert comparison_sheet(exemplar, compared).shape[2] == 3


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--methods", "msg,nope"), "nope"),
        (("--methods", ""), "method"),
        (("--size", "0x4"), "size"),
        (("--columns", "0"), "columns"),
        (("--seed", "-1"), "seed"),
        (("--out", "s.jpg"), ".png"),
    ],
)
def test_what_cannot_work_is_said_in_one_sentence(texlab: Texlab, arguments: tuple[str, ...], says: str) -> None:
    shown = texlab("compare", GRASS, "--out", "s.png", *arguments)
    assert shown.code == 2
    assert says in shown.err
    assert shown.err.count("\n") == 1
    assert not Path("s.png").exists()


def test_the_answer_holds_the_measures_by_id(texlab: Texlab, tmp_path: Path) -> None:
    sheet = tmp_path / "measures.png"
    shown = texlab(
        "compare",
        "gallery:stochastic-gravel",
        "--methods",
        "uncoded,tiling",
        "--crop",
        "64x64+0+0",
        "--out",
        sheet,
        "--json",
    )
    found = {each["method"]: each["measures"] for each in json.loads(shown.out)["methods"]}
    assert found["tiling"]["copied-share"] == found["tiling"]["tile-share"] == 1
    assert found["tiling"]["visual-difference"] < 1e-3 < found["uncoded"]["visual-difference"]
    assert found["uncoded"]["discriminability"] > found["tiling"]["discriminability"]
    assert "copied-share" not in found["uncoded"]


def test_parameters_of_one_method_reach_that_method(texlab: Texlab) -> None:
    words = ("compare", GRASS, "--methods", "tiling,car,msg", *SMALL, "--out")
    assert texlab(*words, "a.png", "--json").code == 0
    shown = texlab(*words, "b.png", "--json", "--set", "car.synthesis=recursion", "--set", "msg.bandwidths=paper")
    assert shown.code == 0
    before, after = (read_image(Path(name), name).values for name in ("a.png", "b.png"))
    # A sheet is the exemplar and three results from left to right.
    assert np.array_equal(before[:, : before.shape[1] // 2], after[:, : before.shape[1] // 2])
    assert not np.array_equal(before, after)


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        ("synthesis=recursion", "set: must be a method, a name and a value"),
        ("car.synthesis", "set: must be a method, a name and a value"),
        (".synthesis=recursion", "set: must be a method, a name and a value"),
        ("msg.bandwidths=paper", "set: must be a parameter of one of the compared methods (car)"),
        ("car.no_such=1", "parameter name: must be one of"),
        ("car.synthesis=quick", "synthesis: must be one of spectrum, recursion"),
    ],
)
def test_parameters_of_no_method(texlab: Texlab, setting: str, says: str) -> None:
    shown = texlab("compare", GRASS, "--methods", "car", *SMALL, "--out", "a.png", "--set", setting)
    assert shown.code == 2
    assert says in shown.err
    twice = texlab(
        "compare", GRASS, "--methods", "car", *SMALL, "--out", "a.png", *["--set", "car.synthesis=spectrum"] * 2
    )
    assert (twice.code, "synthesis is set twice." in twice.err) == (2, True)


def test_a_further_input_reaches_every_method_that_takes_it(texlab: Texlab) -> None:
    words = ("--input", "second=gallery:stochastic-rock", "--input-crop", "second=96x96+0+0", "--json")
    shown = texlab(
        "compare", GRASS, "--methods", "tiling,mixture", "--size", "40x32", *SMALL, *words, "--out", "a.png"
    )
    assert (shown.code, shown.err) == (0, "")
    exemplar, second = (
        as_exemplar(as_exemplar(name), crop=Crop(0, 0, 96, 96)) for name in (GRASS, "gallery:stochastic-rock")
    )
    jobs = plan(exemplar, ("tiling", "mixture"), size=(32, 40), inputs={"second": second})
    found = [each["measures"] for each in json.loads(shown.out)["methods"]]
    assert found == [dict(each.measures) for each in compare(jobs)]
    with pytest.raises(InputError, match=r"a further input of a compared method \(they take none\)"):
        plan(exemplar, ("tiling",), inputs={"second": second})


@pytest.mark.parametrize("role", ["third", "exemplar", "nothing"])
def test_inputs_that_no_method_takes(texlab: Texlab, role: str) -> None:
    shown = texlab("compare", GRASS, "--methods", "msg", *SMALL, "--out", "a.png", "--input", f"{role}={GRASS}")
    assert shown.code == 2
    assert f"input: must be a further input of one of the compared methods (msg), got '{role}'" in shown.err


def test_a_solid_is_as_deep_as_its_shorter_side() -> None:
    exemplar = as_exemplar(GRASS)
    jobs = plan(exemplar, ("msg", "solid"), size=(20, 30))
    assert [job.size for job in jobs] == [(20, 30), (20, 20, 30)]
    assert plan(exemplar, ("solid",))[0].size == (64, 64, 64)
