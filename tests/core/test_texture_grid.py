"""One preset over many textures: cells as the method alone makes them, what is left out, sheets that come back."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from tests.stub_method import StubParams, stub  # noqa: F401
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError, RecipeError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.writing import write_image
from texlab_core.images.gallery import gallery
from texlab_core.images.sources import sources_of
from texlab_core.sheets.sweep import Sweep, Vary
from texlab_core.sheets.sweep_recipes import SweepRecipe, sweep_recipe_from_json
from texlab_core.sheets.sweep_running import run_sweep
from texlab_core.sheets.sweep_sheet import sweep_title, write_sheet
from texlab_core.sheets.sweep_sources import find_sweep
from texlab_core.sheets.texture_grid import left_out_words, read_textures, texture_grid

pytestmark = pytest.mark.usefixtures("stub")


def texture(seed, name, height=12, width=10, channels=1):
    pixels = np.random.default_rng(seed).random((height, width, channels), np.float32)
    return as_exemplar(pixels, name=name)


@pytest.fixture
def textures():
    return [texture(1, "gallery:stochastic-gravel"), texture(2, "two.png", 9, 14, 3), texture(3, "three.png")]


def test_every_cell_is_what_the_method_makes_of_its_texture(textures):
    params = StubParams(level=1.0)
    grid, left_out = texture_grid(
        textures, "stub", params, size=(16, 24), seed=7, down=Vary("border", ("reflect", "wrap"))
    )
    assert left_out == ()
    assert grid.axes == (Vary("texture", ("Gravel", "two.png", "three.png")), Vary("border", ("reflect", "wrap")))
    cells = run_sweep(grid)
    assert [cell.setting for cell in cells[:4]] == [
        "Gravel, border reflect", "two.png, border reflect", "three.png, border reflect", "Gravel, border wrap",
    ]  # fmt: skip
    for index, cell in enumerate(cells):
        own = textures[index % 3]
        wanted = params.replace(border=("reflect", "wrap")[index // 3])
        alone = run(Job(method="stub", inputs={"exemplar": own}, params=wanted, size=(16, 24), seed=7))
        assert cell.job.key == alone.job.key
        assert np.array_equal(cell.result.image, alone.image)
        assert cell.result.image.shape == (16, 24, own.channels)
    assert sweep_title(grid) == ("Stub: texture across, border down", "24 x 16, seed 7, level 1")


def test_cells_have_one_size_that_of_the_first_texture_by_default(textures):
    grid, _ = texture_grid(textures, "stub")
    assert {job.size for job in grid.jobs} == {(12, 10)}
    seeds, _ = texture_grid(textures, "stub", seed=4, down=Vary("seed", (1, 2)))
    assert [job.seed for job in seeds.jobs] == [1, 1, 1, 2, 2, 2]


def test_a_texture_that_a_method_cannot_use_is_left_out_with_its_reason():
    good = texture(1, "good", 40, 40)
    small = texture(2, "small", 3, 3)
    grid, left_out = texture_grid([small, good], "efros-leung", size=(16, 16))
    assert [each.name for each in grid.textures] == ["good"]
    assert [name for name, _ in left_out] == ["small"]
    assert left_out_words(left_out).startswith("One texture is left out: ")
    assert left_out_words(()) == ""
    with pytest.raises(InputError) as alone:
        Job(method="efros-leung", inputs={"exemplar": small}, size=(16, 16))
    assert left_out[0][1] == str(alone.value)
    with pytest.raises(InputError, match="^" + re.escape(left_out[0][1])):
        texture_grid([small], "efros-leung", size=(16, 16))


def test_what_makes_no_grid(textures):
    with pytest.raises(InputError, match="at least one that can be read"):
        texture_grid([], "stub")
    with pytest.raises(InputError, match="at most 400 cells, got 402"):
        texture_grid(textures, "stub", down=Vary("seed", tuple(range(134))))


def test_textures_are_read_reduced_and_left_out(tmp_path):
    write_image(tmp_path / "b.png", texture(1, "b", 300, 512).pixels)
    write_image(tmp_path / "a.png", texture(2, "a", 20, 30).pixels)
    (tmp_path / "c.png").write_bytes(b"no picture")
    (tmp_path / "d.txt").write_text("text")
    sources = [source for source, _ in sources_of(str(tmp_path), tmp_path)]
    found, left_out = read_textures(sources)
    assert [each.size for each in found] == [(20, 30), (150, 256)]
    assert "50 %" in " ".join(found[1].notes)
    assert [name for name, _ in left_out] == [str(tmp_path / "c.png")]
    whole, _ = read_textures(sources[:2], scale=1.0)
    assert [each.size for each in whole] == [(20, 30), (300, 512)]
    with pytest.raises(Cancelled):
        read_textures(sources, should_stop=lambda: True)


def test_a_class_of_the_gallery_is_a_list_of_textures(tmp_path):
    named = [source for source, _ in sources_of("gallery:letters", tmp_path)]
    assert named == [each.uri for each in gallery() if each.cls == "letters"]
    with pytest.raises(InputError, match=r"^textures: there is no file or folder nowhere"):
        list(sources_of("nowhere", tmp_path, "textures"))


def test_a_sheet_carries_its_textures(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, seed in (("one.png", 1), ("two.png", 2)):
        write_image(tmp_path / name, texture(seed, name).pixels)
    found, _ = read_textures(["one.png", "two.png"])
    grid, _ = texture_grid(found, "stub", StubParams(level=2.0), size=(8, 8), down=Vary("seed", (3, 4)))
    write_sheet(tmp_path / "sheet.png", grid, run_sweep(grid), name="mine")
    recipe = find_sweep("sheet.png")
    assert recipe.to_json()["version"] == 2
    assert [each["copied-share"] for each in recipe.measures] == [0.5] * 4
    again = recipe.sweep()
    assert [job.key for job in again.jobs] == [job.key for job in grid.jobs]
    assert again.axes == grid.axes
    # Another picture of the same name is noticed.
    write_image(tmp_path / "two.png", texture(9, "two").pixels)
    with pytest.raises(RecipeError, match=r"two\.png is not the image"):
        recipe.sweep()


def test_files_of_the_first_version_stay_of_the_first_version(textures):
    sweep = Sweep(Job(method="stub", inputs={"exemplar": textures[1]}), (Vary("level", (1.0, 2.0)),))
    data = SweepRecipe.of(sweep, "old").to_json()
    assert data["version"] == 1
    assert "textures" not in data
    assert sweep_recipe_from_json(data) == SweepRecipe.of(sweep, "old")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"textures": []}, "vary: must hold one or two knobs, got 0"),
        ({"textures": 3}, "textures: must be a list"),
        ({"textures": [{"name": 3}]}, "name: must be text"),
        ({"textures": [{}]}, "textures: must hold a name"),
        ({"textures": [{"name": "a"}] * 401}, "at most 400, got 401"),
        (
            {"vary": [{"name": "level", "values": [1]}, {"name": "seed", "values": [1]}]},
            "at most one knob beside textures, got 2",
        ),
    ],
)
def test_what_is_wrong_with_textures_gets_one_sentence(change, says):
    data = {"format": "texlab-sweep", "version": 2, "name": "x", "method": "stub", "vary": []}
    data |= {"textures": [{"name": "a"}]}
    assert sweep_recipe_from_json(json.loads(json.dumps(data))).textures[0].name == "a"
    with pytest.raises(RecipeError, match=says):
        sweep_recipe_from_json(data | change)
