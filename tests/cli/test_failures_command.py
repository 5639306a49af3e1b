"""``texlab failures``: the list, one of them explained, one of them made."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from texlab_core.documents.reading import read_recipe
from texlab_core.findings.failures import examples

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab


def test_the_list(texlab: Texlab) -> None:
    shown = texlab("failures")
    assert shown.code == 0
    for each in examples().values():
        assert f"  {each.name} " in shown.out
    listed = json.loads(texlab("failures", "--json").out)
    assert [each["name"] for each in listed] == list(examples())
    assert set(listed[0]) >= {"exemplar", "method", "parameters", "look_at", "why", "finding"}


def test_one_of_them(texlab: Texlab) -> None:
    shown = texlab("failures", "marble")
    assert "why: " in shown.out
    assert json.loads(texlab("failures", "marble", "--json").out)["method"] == "heeger-bergen"
    made = texlab("failures", "small-thresholds", "--out", "a.png", "--size", "96x80", "--json")
    assert made.code == 0
    answer = json.loads(made.out)
    assert answer["failure"]["name"] == "small-thresholds"
    assert "alpha-range" in {each["id"] for each in answer["findings"]}
    recipe = read_recipe(Path("a.png"))
    assert (recipe.method, recipe.size) == ("de-bonet", (80, 96))
    assert recipe.params.alpha == 0.02  # type: ignore[attr-defined]
    assert "look at: " in texlab("failures", "tiling", "--out", "b.png", "--size", "64x64").out


def test_what_cannot_be(texlab: Texlab) -> None:
    for arguments, words in (
        (("nonsense",), "failure: must be one of"),
        (("--out", "a.png"), "needs the NAME"),
        (("--size", "64x64"), "needs the NAME"),
        (("marble", "--size", "64x64"), "needs --out"),
        (("marble", "--out", "a.gif"), "a.gif"),
    ):
        shown = texlab("failures", *arguments)
        assert shown.code == 2
        assert words in shown.err
        assert len(shown.err.strip().splitlines()) == 1
