"""``texlab popout``: pictures and key, scores of answers, the machine, kept tests; refusals change nothing."""

from __future__ import annotations

import csv
import json
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from texlab.cli.main import main
from texlab.storage.paths import config_dir
from texlab_core.images.formats.writing import write_image
from texlab_core.popout.design import Design, figures
from texlab_core.popout.making import Made
from texlab_core.popout.record import Record, read_record
from texlab_core.popout.store import FOLDER, PopoutStore

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a test once: the pictures of an exemplar of noise, in ``test``."""
    out = tmp_path_factory.mktemp("popout")
    pixels = np.random.default_rng(0).random((96, 90, 3)).astype(np.float32)
    write_image(out / "wall.png", pixels)
    words = ["popout", "make", str(out / "wall.png"), "--methods", "tiling,pixels", "--repeats", "2"]
    words += ["--seed", "3", "--set", "tiling.mirror=true", "--size", "160x150", "--out", str(out / "test")]
    assert main(words) == 0
    return out


@pytest.fixture
def made(texlab: Texlab, folder: Path) -> Texlab:
    """Return a function that runs ``texlab`` in a folder with a test."""
    shutil.copytree(folder, ".", dirs_exist_ok=True)
    return texlab


def test_making_says_what_was_made(made: Texlab) -> None:
    shown = made("popout", "make", "wall.png", "--methods", "tiling", "--repeats", "1", "--out", "one")
    assert "one: 1 picture of 256 x 256 pixels with a piece of 45 x 48; a click in the middle" in shown.out
    answer = json.loads(
        made("popout", "make", "wall.png", "--methods", "tiling", "--repeats", "1", "--out", "two", "--json").out
    )
    assert answer["files"] == ["001.png", "answers.csv", "key.json"]
    assert Path("one/001.png").read_bytes() == Path("two/001.png").read_bytes()


def test_pictures_answers_and_scores(made: Texlab) -> None:
    assert sorted(os.listdir("test")) == ["001.png", "002.png", "003.png", "004.png", "answers.csv", "key.json"]
    key = read_record("test/key.json")
    assert key.design["settings"][0]["parameters"] == {"mirror": True}
    with Path("test/answers.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["picture"] for row in rows] == ["001.png", "002.png", "003.png", "004.png"]
    lines = ["trial,row,column,seconds"]
    lines += [f"{each.number},{each.top},{each.left},2.5" for each in key.trials[:2]]
    lines += ["3,,,9"]
    Path("a.csv").write_text("\n".join(lines) + "\n")
    shown = made("popout", "score", "a.csv", "--key", "test/key.json", "--out", "table.csv", "--json")
    answer = json.loads(shown.out)
    assert (answer["answers"], answer["pictures"]) == (3, 4)
    assert sum(each["hits"] for each in answer["scores"]) == 2
    assert sum(each["could_not_tell"] for each in answer["scores"]) == 1
    with Path("table.csv").open(newline="") as stream:
        assert [row["hit"] for row in csv.DictReader(stream)] == ["1", "1", "0", ""]
    words = made("popout", "score", "a.csv", "--key", "test/key.json").out
    assert "3 of 4 pictures answered; guessing: 18%" in words
    assert "2.5 s" in words


def test_the_machine_plays(made: Texlab) -> None:
    shown = made("popout", "observe", "test/key.json", "--json")
    found = {each["method"]: each for each in json.loads(shown.out)["scores"]}
    assert found["Tiling"]["hits"] + found["Tiling"]["misses"] == 2
    # The exemplar is noise itself: independent pixels of it are no other texture.
    assert found["Tiling"]["hits"] == found["Tiling"]["machine_hits"]


def test_figures_are_the_papers(texlab: Texlab, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Design] = []

    def record(design: Design, **_: object) -> Made:
        drawn.append(design)
        picture = np.zeros((*design.size, 3), np.uint8)
        return Made(Record.of(design), (picture,) * len(design.trials()))

    monkeypatch.setattr("texlab_core.popout.making.make", record)
    shown = texlab("popout", "figures", "--out", "figures", "--json")
    assert json.loads(shown.out)["pictures"] == 4
    assert [each.name for each in drawn[0].settings] == [each.name for each in figures().settings]
    assert "the machine did not look" in texlab("popout", "observe", "figures/key.json").err


def test_kept_tests_are_listed_and_written(made: Texlab) -> None:
    assert made("popout", "kept").out.strip() == "There are no tests yet."
    store = PopoutStore(config_dir() / FOLDER)
    store.save("2026-01-02-030405", read_record("test/key.json"))
    (store.folder / "broken.json").write_text("{")
    shown = made("popout", "kept", "--out", "all.csv")
    assert "2026-01-02-030405  0 of 4 pictures answered, wall" in shown.out
    assert "broken.json" in shown.err
    with Path("all.csv").open(newline="") as stream:
        assert {row["test"] for row in csv.DictReader(stream)} == {"2026-01-02-030405"}


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["make", "wall.png", "--out", "test"], "there are files in it"),
        (["make", "wall.png", "--out", "wall.png"], "is a file, and a folder is wanted"),
        (["make", "wall.png", "--out", "no/where"], "does not exist"),
        (["make", "wall.png", "--out", "new", "--methods", "solid"], "makes solids"),
        (["make", "wall.png", "--out", "new", "--methods", "rows"], "rows"),
        (["make", "wall.png", "--out", "new", "--repeats", "0"], "repeats: must be a whole number from 1 to 100"),
        (["make", "wall.png", "--out", "new", "--size", "64x64"], "a click in the middle would mostly be right"),
        (["make", "wall.png", "--out", "new", "--share", "2"], "share: must be a number above 0, at most 1"),
        (["make", "wall.png", "--out", "new", "--seed", "-1"], "seed"),
        (["score", "wall.png", "--key", "test/key.json"], "wall.png"),
        (["score", "test/answers.csv", "--key", "wall.png"], "wall.png"),
        (["score", "test/answers.csv", "--key", "test/key.json", "--out", "test/key.json"], "choose another file"),
        (["score", "test/answers.csv", "--key", "test/key.json", "--out", "no/a.csv"], "does not exist"),
        (["kept", "--out", "test"], "test"),
        ([], "ACTION"),
    ],
)
def test_refusals_are_one_sentence(made: Texlab, words: list[str], reason: str) -> None:
    before = sorted(os.listdir())
    shown = made("popout", *words)
    assert shown.code == 2
    assert reason in shown.err
    assert shown.err.count("\n") == 1
    assert sorted(os.listdir()) == before
