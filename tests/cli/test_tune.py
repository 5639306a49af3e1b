"""``texlab tune``: the preset, the report, and refusals before any work."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from texlab_core.engine.inputs import Crop
from texlab_core.images.exemplar import as_exemplar
from texlab_core.sheets.own_line import own_measures
from texlab_core.sheets.tuning_search import DEFAULT_BUDGET

if TYPE_CHECKING:
    from conftest import Texlab

GRAVEL = ("gallery:stochastic-gravel", "--crop", "64x64+40+40")


def test_the_budget_is_the_searchs_own(texlab: Texlab) -> None:
    assert f"(default {DEFAULT_BUDGET})" in " ".join(texlab("tune", "--help").out.split())


def test_the_preset_makes_the_result_that_was_tried(texlab: Texlab) -> None:
    words = ("tune", *GRAVEL, "--size", "96x96", "--budget", "26", "--limit", "-1.5", "--out", "a.json", "--json")
    shown = texlab(*words)
    assert (shown.code, shown.err) == (0, "")
    told = json.loads(shown.out)
    assert 16 <= told["runs"] == len(told["trials"]) <= 26
    assert (told["limit"], told["budget"], told["knobs"]) == (-1.5, 26, [])
    found = told["found"]
    assert found["visual-difference"] >= told["start"]["visual-difference"]
    assert found["discriminability"] <= -1.5
    chosen = [each for each in told["trials"] if each["changes"] == found["changes"] and each["seed"] == 0]
    synth = ("synth", *GRAVEL, "--method", "de-bonet", "--preset", "a.json", "--size", "96x96")
    made = texlab(*synth, "--out", "a.png", "--json")
    assert made.code == 0
    answer = json.loads(made.out)
    assert answer["measures"]["discriminability"] == chosen[0]["discriminability"]
    assert answer["measures"]["visual-difference"] == chosen[0]["visual-difference"]
    listed = texlab("presets", "show", "a.json", "--json")
    assert json.loads(listed.out)["parameters"] == found["parameters"]
    assert json.loads(listed.out)["name"] == "tuned"


def test_for_people_and_any_numbers(texlab: Texlab) -> None:
    words = (
        "tune",
        *GRAVEL,
        "--method",
        "heeger-bergen",
        "--knobs",
        "iterations",
        "--budget",
        "24",
        "--limit",
        "9",
    )
    shown = texlab(*words, "--name", "h", "--out", "h.json")
    assert (shown.code, shown.err) == (0, "")
    lines = shown.out.splitlines()
    assert lines[-1] == "h.json: the preset h of heeger-bergen"
    assert "V" in lines[0]
    preset = json.loads(texlab("presets", "show", "h.json", "--json").out)
    said = [line for line in lines if line.startswith("  iterations = ")]
    assert said == [f"  iterations = {preset['parameters']['iterations']}"] or not said


def test_the_limit_may_be_the_exemplars_own(texlab: Texlab) -> None:
    words = ("tune", *GRAVEL, "--size", "64x64", "--limit", "own", "--budget", "24", "--out", "a.json", "--json")
    told = json.loads(texlab(*words).out)
    exemplar = as_exemplar(GRAVEL[0], crop=Crop(top=40, left=40, height=64, width=64))
    assert told["limit"] == own_measures(exemplar, ("discriminability",))["discriminability"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--method", "x"), "method: must be one of "),
        (("--knobs", "alhpa"), "(did you mean alpha?)"),
        (("--knobs", "border"), "knobs: must be numbers among alpha, beta, "),
        (("--knobs", ""), "must be one of alpha"),
        (("--method", "tiling"), "Tiling has no thresholds: say which of its numbers are to be tuned (knobs)."),
        (("--limit", "low"), "limit: must be a number, got 'low'."),
        (("--limit", "nan"), "limit: must be a number, or start"),
        (("--limit", "own", "--crop", "250x250+0+0"), "The exemplar's own D is not known"),
        (("--budget", "9"), "budget: must be a whole number from 24 to 5000, got 9."),
        (("--name", "a/b"), "can hold no slash"),
        (("--out", "a.png"), "out: must be a file that ends in .json, got 'a.png'."),
    ],
)
def test_one_sentence_for_what_cannot_be(texlab: Texlab, words: tuple[str, ...], said: str) -> None:
    shown = texlab("tune", *GRAVEL, "--out", "a.json", *words)
    assert (shown.code, shown.out) == (2, "")
    assert shown.err.count("\n") == 1
    assert said in shown.err
