"""``texlab export``: files, figures and animations from results and from images."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pypdf
import pytest
from PIL import Image

from texlab_core.documents.project import Project, ProjectColumn, save_project
from texlab_core.documents.record import read_recipe
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.writing import write_image

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab


@pytest.fixture
def saved(texlab: Texlab) -> Texlab:
    """Lay a deep exemplar and two results of it."""
    pixels = np.random.default_rng(0).integers(0, 65536, (32, 32, 3)) / 65535
    write_image("deep.png", pixels.astype(np.float32), bits=16)
    for method in ("pixels", "tiling"):
        done = texlab("synth", "deep.png", "--method", method, "--seed", "9", "--out", f"{method}.png")
        assert done.code == 0
    return texlab


def test_seeds_and_sizes_of_a_result(saved: Texlab) -> None:
    done = saved("export", "pixels.png", "--out", "made", "--seeds", "1..2", "--sizes", "24x20,16x16")
    assert (done.code, done.err) == (0, "")
    names = [f"deep-pixels-{size}-seed{seed}.png" for size in ("24x20", "16x16") for seed in (1, 2)]
    assert sorted(os.listdir("made")) == sorted(names)
    assert done.out.splitlines() == [*(str(Path("made", name)) for name in names), "4 files written."]
    assert (
        saved("synth", "deep.png", "--method", "pixels", "--seed", "2", "--size", "24x20", "--out", "b.png").code
        == 0
    )
    one, other = (read_image(Path(name), name) for name in ("made/deep-pixels-24x20-seed2.png", "b.png"))
    assert one.peak == 65535
    assert len(np.unique(one.values)) > 256
    np.testing.assert_array_equal(one.values, other.values)


def test_several_results_keep_their_own_seeds(saved: Texlab) -> None:
    done = saved(
        "export", "pixels.png", "tiling.png", "--out", "made/", "--name", "{method}_{seed}", "--format", "tif"
    )
    assert done.code == 0
    assert sorted(os.listdir("made")) == ["pixels_9.tif", "tiling_9.tif"]
    assert read_recipe("made/pixels_9.tif").seed == 9


def test_a_preview_writes_nothing(saved: Texlab) -> None:
    before = sorted(os.listdir())
    for out in ("made", "a.png", "a.pdf", "a.gif"):
        animate = ("--animate", "growth") if out == "a.gif" else ()
        done = saved("export", "pixels.png", "--out", out, "--preview", "--json", *animate)
        assert done.code == 0
        answer = json.loads(done.out)
        assert answer["preview"] is True
        assert len(answer["written"]) == 1
    assert sorted(os.listdir()) == before


def test_an_image_and_a_method(texlab: Texlab) -> None:
    done = texlab(
        *("export", "gallery:stochastic-grass", "--crop", "32x32+0+0", "--method", "heeger-bergen"),
        *("--set", "iterations=2", "--out", "one.webp", "--quality", "70"),
    )
    assert (done.code, done.err) == (0, "")
    recipe = read_recipe("one.webp")
    assert recipe.params.to_json()["iterations"] == 2
    assert b"VP8 " in Path("one.webp").read_bytes()[:60]


def test_the_columns_of_a_project(saved: Texlab) -> None:
    exemplar = as_exemplar("deep.png")
    columns = tuple(ProjectColumn(name, find_method(name).params()) for name in ("pixels", "tiling"))
    save_project("a.texlab", Project(exemplar, columns, crop=Crop(0, 0, 20, 20), seed=9, size=(24, 24)))
    done = saved("export", "a.texlab", "--out", "made", "--name", "{method}")
    assert (done.code, done.err) == (0, "")
    assert sorted(os.listdir("made")) == ["pixels.png", "tiling.png"]
    part = as_exemplar(exemplar, crop=Crop(0, 0, 20, 20))
    wanted = run(Job(method="pixels", inputs={"exemplar": part}, size=(24, 24), seed=9)).image
    found = read_image(Path("made/pixels.png"), "a")
    np.testing.assert_array_equal(found.values, np.rint(wanted.astype(np.float64) * found.peak))
    save_project("b.texlab", Project(exemplar, ()))
    done = saved("export", "b.texlab", "--out", "made")
    assert (done.code, "has no columns" in done.err) == (2, True)
    Path("b.texlab").write_bytes(b"PK")
    assert saved("export", "b.texlab", "--out", "made").code == 2


def test_a_figure_of_a_selection(saved: Texlab) -> None:
    done = saved(
        "export", "pixels.png", "tiling.png", "--out", "a.pdf", "--seeds", "1,2", "--columns", "2", "--json"
    )
    assert json.loads(done.out) == {"written": ["a.pdf"], "preview": False, "panels": 4}
    text = pypdf.PdfReader("a.pdf").pages[0].extract_text()
    for wanted in ("(a)", "(d)", "Independent pixels", "32 x 32, seed 2"):
        assert wanted in re.sub(r"\s+", " ", text)


def test_animations(saved: Texlab) -> None:
    done = saved("export", "pixels.png", "--out", "a.webp", "--animate", "seed=1:4:4", "--back", "--json")
    assert json.loads(done.out)["frames"] == 6
    with Image.open("a.webp") as movie:
        assert (movie.n_frames, movie.info["loop"]) == (6, 0)
    done = saved(
        "export", "pixels.png", "--out", "frames", "--animate", "growth", "--frames", "3", "--recipe", "none"
    )
    assert done.code == 0
    assert sorted(os.listdir("frames")) == [f"frame-000{number}.png" for number in (1, 2, 3)]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("deep.png", "--out", "made"), "for an image say --method ID"),
        (("pixels.png", "--out", "a.png", "--seeds", "1..2"), "a folder for 2 files"),
        (("pixels.png", "--out", "a.xyz"), "images are written as"),
        (("pixels.png", "--out", "a.exr", "--bits", "16"), "float"),
        (("pixels.png", "--out", "a.png", "--name", "{seed}"), "name"),
        (("pixels.png", "--out", "a.png", "--format", "tif"), "format"),
        (("pixels.png", "--out", "a.png", "--quality", "70"), "quality"),
        (("pixels.png", "--out", "made", "--quality", "x"), "quality"),
        (("pixels.png", "--out", "made", "--seeds", "4..1"), "seeds"),
        (("pixels.png", "--out", "made", "--sizes", "4x"), "sizes"),
        (("pixels.png", "--out", "made", "--name", "{no}"), "{name}"),
        (("pixels.png", "--out", "made", "--seeds", "1,2", "--name", "x"), "add {seed} or {index}"),
        (("pixels.png", "--out", "made", "--dpi", "300"), "dpi"),
        (("pixels.png", "--out", "made", "--columns", "3"), "columns"),
        (("pixels.png", "--out", "made", "--frames", "3"), "frames"),
        (("pixels.png", "--out", "a.pdf", "--bits", "16"), "bits"),
        (("pixels.png", "--out", "a.gif", "--animate", "growth", "--seeds", "1,2"), "one result"),
        (("pixels.png", "--out", "a.gif", "--animate", "growth", "--recipe", "beside"), "recipe"),
        (("pixels.png", "--out", "a.avi", "--animate", "growth"), ".mp4"),
        (("pixels.png", "--out", "made", "--set", "a=1"), "--set needs --method"),
        (("deep.png", "pixels.png", "--method", "tiling", "--out", "made"), "one exemplar"),
        (("pixels.png", "--out", "deep.png/made"), "deep.png"),
        (("pixels.png", "--out", "pixels.png"), "what the result is made from"),
    ],
)
def test_what_cannot_be_is_one_sentence_and_writes_nothing(
    saved: Texlab, words: tuple[str, ...], said: str
) -> None:
    before = sorted(os.listdir())
    done = saved("export", *words)
    assert done.code == 2
    assert done.err.count("\n") == 1
    assert said in done.err
    assert sorted(os.listdir()) == before
