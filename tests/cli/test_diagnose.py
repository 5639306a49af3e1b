"""``texlab diagnose``: pictures from anywhere, results that carry their exemplar, refusals in one sentence."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from PIL import Image

from texlab_core.findings.registry import detectors
from texlab_core.measures.registry import find_measure

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab
    from texlab_core.findings.registry import Case, Seen

LABELS = Path(__file__).parents[1] / "data/labels/gallery"
GRAVEL = LABELS / "stochastic-gravel.exemplar.webp"
BROKEN = LABELS / "stochastic-gravel.heeger-bergen.webp"


def test_a_picture_from_another_program(texlab: Texlab) -> None:
    shown = texlab("diagnose", GRAVEL, BROKEN, "--json")
    assert (shown.code, shown.err) == (0, "")
    answer = json.loads(shown.out)
    assert answer["method"] is None
    assert {"discriminability", "visual-difference"} <= set(answer["measures"])
    found = {each["id"]: each for each in answer["findings"]}
    assert found["structure-lost"]["certainty"] == "look at"
    assert set(found["structure-lost"]) >= {"id", "title", "what", "why", "try", "where", "certainty"}
    assert answer["counts"]["findings"] == sum(each["certainty"] == "finding" for each in answer["findings"])


def test_for_people(texlab: Texlab) -> None:
    shown = texlab("diagnose", GRAVEL, BROKEN)
    assert shown.code == 0
    first, second, *rest = shown.out.splitlines()
    assert "no findings, 1 to look at" in first
    assert second.startswith("  D ")
    text = "\n".join(rest)
    for word in ("Look at:", "Structure lost", "where: ", "why: ", "try: "):
        assert word in text
    assert max(map(len, rest)) <= 100


def test_what_was_not_looked_for_is_said(texlab: Texlab, monkeypatch: pytest.MonkeyPatch) -> None:
    assert json.loads(texlab("diagnose", GRAVEL, BROKEN, "--json").out)["unexamined"] is None
    with Image.open(BROKEN) as broken:
        broken.crop((0, 0, 30, 40)).save("small.png")
    small = texlab("diagnose", GRAVEL, "small.png")
    said = "Nothing is looked for where the result or the exemplar is under 32 pixels."
    assert said in small.out
    answer = json.loads(texlab("diagnose", GRAVEL, "small.png", "--json").out)
    assert (answer["findings"], answer["unexamined"]) == ([], said)

    def breaks(case: Case) -> Seen:
        raise ZeroDivisionError

    spoiled = {name: replace(detectors()[name], see=breaks) for name in ("cuts", "structure-lost")}
    monkeypatch.setattr("texlab_core.findings.registry.detectors", lambda: spoiled)
    answer = json.loads(texlab("diagnose", GRAVEL, BROKEN, "--json").out)
    titles = ", ".join(each.title for each in spoiled.values())
    said = f"Not looked for, since these detectors failed: {titles}. The log says why."
    assert (answer["findings"], answer["unexamined"]) == ([], said)


def test_a_result_knows_its_method_and_carries_its_exemplar(texlab: Texlab) -> None:
    options = ("--method", "de-bonet", "--set", "alpha=0.9", "--size", "128x128", "--crop", "64x64+0+0")
    assert texlab("synth", GRAVEL, *options, "--out", "a.png").code == 0
    alone = json.loads(texlab("diagnose", "a.png", "--json").out)
    assert alone["method"] == "de-bonet"
    assert alone["parameters"]["alpha"] == 0.9
    assert alone["exemplar"]["size"] == {"width": 64, "height": 64}
    assert "alpha-range" in {each["id"] for each in alone["findings"]}
    # With another exemplar the recipe still tells how it was made.
    other = json.loads(texlab("diagnose", GRAVEL, "a.png", "--json").out)
    assert other["method"] == "de-bonet"
    assert other["exemplar"]["size"] == {"width": 128, "height": 128}
    Image.open("a.png").convert("L").save("gray.png")
    assert json.loads(texlab("diagnose", GRAVEL, "gray.png", "--json").out)["method"] is None


def test_what_cannot_be_diagnosed_is_said_in_one_sentence(texlab: Texlab) -> None:
    Path("text.png").write_text("no picture")
    options = ("--method", "solid", "--size", "12x12x12", "--set", "iterations=1", "--crop", "24x24+0+0")
    assert texlab("synth", GRAVEL, *options, "--out", "solid.tif").code == 0
    for arguments, words in (
        ((BROKEN,), "does not hold its exemplar"),
        (("none.png",), "there is no such file"),
        ((GRAVEL, "none.png"), "none.png"),
        (("none.png", BROKEN), "none.png"),
        ((GRAVEL, "text.png"), "text.png"),
        (("gallery:nonsense", BROKEN), "nonsense"),
        ((GRAVEL, "solid.tif"), "holds a solid"),
    ):
        shown = texlab("diagnose", *arguments, "--json")
        assert shown.code == 2, arguments
        assert shown.out == ""
        assert words in shown.err
        assert len(shown.err.strip().splitlines()) == 1


def test_a_damaged_recipe_matters_only_where_it_is_needed(texlab: Texlab) -> None:
    assert texlab("synth", GRAVEL, "--method", "tiling", "--crop", "48x48+0+0", "--out", "a.png").code == 0
    from PIL.PngImagePlugin import PngInfo

    info = PngInfo()
    info.add_text("texlab", '{"texlab": 99}')
    Image.open("a.png").save("b.png", pnginfo=info)
    assert texlab("diagnose", "b.png").code == 2
    assert json.loads(texlab("diagnose", GRAVEL, "b.png", "--json").out)["method"] is None


@pytest.mark.parametrize("size", ["8x8", "20x70"])
def test_small_pictures_have_fewer_numbers_and_no_mistakes(texlab: Texlab, size: str) -> None:
    assert texlab("synth", GRAVEL, "--method", "tiling", "--size", size, "--out", "a.png").code == 0
    answer = json.loads(texlab("diagnose", GRAVEL, "a.png", "--json").out)
    assert "discriminability" not in answer["measures"]


def test_synth_and_redo_say_what_they_find(texlab: Texlab) -> None:
    options = ("--method", "heeger-bergen", "--size", "96x96", "--crop", "64x64+0+0", "--json")
    made = json.loads(texlab("synth", "gallery:oriented-zebra", *options, "--out", "a.png").out)
    assert "structure-lost" in {each["id"] for each in made["findings"]}
    again = json.loads(texlab("redo", "a.png", "--out", "b.png", "--json").out)
    assert again["findings"] == made["findings"]
    # What was measured is kept in the file, and told again.
    assert again["measures_then"] == again["measures"] == made["measures"]
    told = texlab("redo", "b.png", "--out", "c.png").out
    number = find_measure("discriminability").text(made["measures"]["discriminability"])
    assert f"  b.png was saved with D {number}, " in told
    # What is saved in 8 bits is judged nearly as what was computed.
    again = json.loads(texlab("diagnose", "a.png", "--json").out)
    assert [each["id"] for each in again["findings"]] == [each["id"] for each in made["findings"]]
