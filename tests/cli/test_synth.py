"""``synth`` and ``redo``: what is saved, printed and refused; the same bits again."""

from __future__ import annotations

import itertools
import json
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.core.toy import NoiseParams, noise_method, stock
from texlab_core import synthesize
from texlab_core.documents.embedding import embed
from texlab_core.documents.reading import KEY
from texlab_core.documents.record import read_recipe, save_result
from texlab_core.engine import registry
from texlab_core.engine.inputs import ArraysInput, Crop
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.png_text import read_text
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.volumes import read_volume
from texlab_core.images.formats.writing import write_image

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab

RAMP = np.linspace(0, 1, 20 * 30 * 3, dtype=np.float32).reshape(20, 30, 3)
TOY = ("--method", "toy-noise")


@pytest.fixture(autouse=True)
def toy(monkeypatch: pytest.MonkeyPatch) -> None:
    """Register a method with a known answer."""
    stock(monkeypatch, registry._METHODS, noise_method())


@pytest.fixture
def ramp(texlab: Texlab) -> Path:
    """An exemplar in the current folder."""
    path = Path("ramp.png")
    write_image(path, RAMP)
    return path


def test_the_file_is_what_the_python_api_makes(texlab: Texlab, ramp: Path) -> None:
    shown = texlab(
        *("synth", ramp, *TOY, "--out", "a.png", "--size", "24x10", "--seed", "7"),
        *("--set", "rounds=2", "--set", "spread=0.5"),
    )
    assert (shown.code, shown.err) == (0, "")
    assert re.fullmatch(r"a\.png: 24 x 10 by toy-noise, seed 7, in \d+\.\d\d s\.\n", shown.out)
    expected = synthesize(str(ramp), "toy-noise", size=(10, 24), seed=7, rounds=2, spread=0.5)
    np.testing.assert_array_equal(
        read_image(Path("a.png"), "a.png").values, np.rint(expected.image * 255).astype(np.uint8)
    )
    recipe = read_recipe("a.png")
    assert (recipe.method, recipe.size, recipe.seed) == ("toy-noise", (10, 24), 7)
    assert recipe.params == NoiseParams(rounds=2, spread=0.5)


def test_json_is_exactly_one_object(texlab: Texlab, ramp: Path) -> None:
    shown = texlab("synth", ramp, *TOY, "--out", "a.png", "--json", "--crop", "16x8+3+4")
    assert (shown.code, shown.err) == (0, "")
    made = json.loads(shown.out)
    assert made.pop("elapsed_s") > 0
    exemplar = made.pop("exemplar")
    assert (exemplar["name"], exemplar["size"]) == ("ramp.png", {"width": 16, "height": 8})
    assert re.fullmatch("[0-9a-f]{64}", exemplar["sha256"])
    # Too small to be examined.
    assert made.pop("findings") == []
    assert {"mean", "w1-pixels", "spectral-distance"} < made.pop("measures").keys()
    assert made.pop("curves")["distance"]["y"] == [0.5, 0.25]
    assert made == {
        "method": "toy-noise",
        "parameters": NoiseParams().to_json(),
        "size": {"width": 16, "height": 8},
        "seed": 0,
        "out": "a.png",
    }


def test_scale_and_crop_are_part_of_the_recipe(texlab: Texlab, ramp: Path) -> None:
    assert texlab("synth", ramp, *TOY, "--out", "a.png", "--scale", "0.5", "--crop", "8x5+2+1").code == 0
    exemplar = read_recipe("a.png").inputs["exemplar"]
    assert (exemplar.scale, exemplar.crop, exemplar.size) == (0.5, Crop(1, 2, 5, 8), (5, 8))


@pytest.mark.parametrize(
    ("name", "bits", "peak"), [("a.png", "16", 65535), ("a.tif", "float", None), ("a.jpg", "8", 255)]
)
def test_depths_and_formats(texlab: Texlab, ramp: Path, name: str, bits: str, peak: int | None) -> None:
    assert texlab("synth", ramp, *TOY, "--out", name, "--bits", bits).code == 0
    assert read_image(Path(name), name).peak == peak


def test_maps_and_curves_go_to_a_folder(texlab: Texlab, ramp: Path) -> None:
    assert texlab("synth", ramp, *TOY, "--out", "a.png", "--maps", "maps").code == 0
    assert {"index.json", "distance.csv"} <= {path.name for path in Path("maps").iterdir()}


def test_an_existing_file_is_replaced_whole(texlab: Texlab, ramp: Path) -> None:
    Path("a.png").write_bytes(b"old")
    assert texlab("synth", ramp, *TOY, "--out", "a.png").code == 0
    assert read_recipe("a.png").method == "toy-noise"
    assert sorted(path.name for path in Path().iterdir()) == ["a.png", "ramp.png"]


def test_a_preset_is_the_base_of_settings(texlab: Texlab, ramp: Path) -> None:
    assert texlab("presets", "save", "mine", *TOY, "--set", "spread=0.75", "--set", "rounds=9").code == 0
    shown = texlab("synth", ramp, *TOY, "--out", "a.png", "--preset", "mine", "--set", "rounds=1", "--json")
    assert json.loads(shown.out)["parameters"] == NoiseParams(spread=0.75, rounds=1).to_json()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--method", "toy-nose"], "did you mean toy-noise"),
        (["--set", "rounds=0"], "rounds: must be a whole number from 1 to 9, got 0"),
        (["--set", "round=1"], "did you mean rounds"),
        (["--set", "rounds"], "a name and a value"),
        (["--size", "nine"], "size: must be width and height"),
        (["--size", "99999x99999"], "64 megapixels"),
        (["--seed", "-1"], "seed: must be a whole number from 0"),
        (["--seed", "x"], "seed: must be a whole number, got 'x'"),
        (["--scale", "2"], "scale must be above 0 and at most 1"),
        (["--scale", "half"], "scale: must be a number"),
        (["--crop", "64x64+0+0"], "crop must lie inside"),
        (["--crop", "9"], "crop: must be width"),
        (["--out", "a.gif"], "a.gif: images are written as"),
        (["--out", "no/a.png"], "The folder no does not exist"),
        (["--out", "ramp.png"], "is what the result is made from"),
        (["--out", "a.png", "--bits", "float"], "float"),
        (["--maps", "no/maps"], "The folder no does not exist"),
        (["--maps", "ramp.png"], "is a file"),
        (["--preset", "none such"], "none such"),
    ],
    ids=lambda each: " ".join(each) if isinstance(each, list) else "",
)
def test_mistakes_are_refused_before_the_work_starts(
    texlab: Texlab, ramp: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], words: str
) -> None:
    monkeypatch.setattr("texlab_core.engine.run.run", lambda *_: pytest.fail("The work started."))
    before = ramp.read_bytes()
    shown = texlab("synth", ramp, *TOY, "--out", "a.png", "--json", *arguments)
    assert shown.code == 2
    assert shown.out == ""
    assert words in shown.err
    assert shown.err.count("\n") == 1
    assert ramp.read_bytes() == before
    assert [path.name for path in Path().iterdir()] == ["ramp.png"]


@pytest.mark.parametrize("image", ["missing.png", "gallery:nothing", ".", "text.png"])
def test_an_image_that_cannot_be_read_is_said(texlab: Texlab, image: str) -> None:
    Path("text.png").write_text("not an image")
    shown = texlab("synth", image, *TOY, "--out", "a.png")
    assert (shown.code, shown.out) == (2, "")
    assert shown.err.startswith("texlab: ")
    assert shown.err.count("\n") == 1


def test_an_interrupted_run_leaves_no_file(texlab: Texlab, ramp: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("texlab_core.engine.run.run", interrupted)
    shown = texlab("synth", ramp, *TOY, "--out", "a.png")
    assert (shown.code, shown.out, shown.err) == (130, "", "")
    assert not Path("a.png").exists()


def test_progress_is_shown_on_a_terminal_only(texlab: Texlab, ramp: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    shown = texlab("synth", ramp, *TOY, "--out", "a.png", "--json")
    assert shown.code == 0
    json.loads(shown.out)
    assert "toy-noise" in shown.err


@pytest.mark.parametrize(("name", "bits"), [("a.png", "8"), ("a.png", "16"), ("a.tif", "float"), ("a.tif", "8")])
def test_redo_makes_the_same_bits_from_the_file_alone(texlab: Texlab, ramp: Path, name: str, bits: str) -> None:
    options = ("--size", "24x10", "--seed", "7", "--set", "spread=0.5", "--crop", "16x8+3+4", "--bits", bits)
    assert texlab("synth", ramp, *TOY, "--out", name, *options).code == 0
    ramp.unlink()
    again = f"again{Path(name).suffix}"
    shown = texlab("redo", name, "--out", again)
    assert (shown.code, shown.err) == (0, "")
    assert shown.out.endswith(f"  The same bits as in {name}.\n")
    one, other = (read_image(Path(each), each) for each in (name, again))
    assert one.peak == other.peak
    np.testing.assert_array_equal(one.values, other.values)
    assert json.loads(texlab("redo", again, "--out", "third.png", "--json").out)["seed"] == 7


def test_redo_can_replace_its_own_file(texlab: Texlab, ramp: Path) -> None:
    assert texlab("synth", ramp, *TOY, "--out", "a.png").code == 0
    assert json.loads(texlab("redo", "a.png", "--out", "a.png", "--json").out)["same_bits"] is True


def test_redo_of_a_jpeg_cannot_compare(texlab: Texlab, ramp: Path) -> None:
    assert texlab("synth", ramp, *TOY, "--out", "a.jpg").code == 0
    made = json.loads(texlab("redo", "a.jpg", "--out", "b.png", "--json").out)
    assert made["same_bits"] is None


def test_redo_says_when_the_image_was_changed(texlab: Texlab, ramp: Path) -> None:
    assert texlab("synth", ramp, *TOY, "--out", "a.png").code == 0
    with open("a.png", "rb") as file:
        recipe = read_text(file, KEY, 2**20)
    assert recipe is not None
    write_image("changed.png", RAMP, text={KEY: recipe})
    shown = texlab("redo", "changed.png", "--out", "b.png", "--json")
    assert json.loads(shown.out)["same_bits"] is False
    assert shown.err == (
        "texlab: The result is not bit for bit that of changed.png: the image was changed after it was saved.\n"
    )
    other = recipe.replace(f'"numpy":"{np.__version__}"', '"numpy":"1.0"')
    write_image("older.png", RAMP, text={KEY: other})
    said = texlab("redo", "older.png", "--out", "b.png").err
    assert f"the versions differ (numpy 1.0 then, {np.__version__} here)" in said


LARGE = np.random.Generator(np.random.PCG64(0)).random((900, 1000, 3), dtype=np.float32)


def test_without_a_method_it_is_de_bonet(texlab: Texlab, ramp: Path) -> None:
    assert texlab("synth", ramp, "--size", "16", "--out", "a.png").code == 0
    assert read_recipe("a.png").method == "de-bonet"


@pytest.fixture
def short_recipes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep no picture in a recipe that is longer than a gallery texture, so that small ones are too large."""
    monkeypatch.setitem(embed.__kwdefaults__, "limit", 256**2 * 3)


def test_redo_says_what_is_missing_and_takes_it(texlab: Texlab, short_recipes: None) -> None:
    large = LARGE[:270, :260]
    write_image("large.png", large)
    write_image("other.png", 1 - large)
    assert texlab("synth", "large.png", *TOY, "--out", "a.png", "--size", "9x9").code == 0
    shown = texlab("redo", "a.png", "--out", "b.png")
    assert (shown.code, shown.out) == (2, "")
    assert "large.png" in shown.err
    assert "--exemplar" in shown.err
    assert shown.err.count("\n") == 1
    assert not Path("b.png").exists()
    wrong = texlab("redo", "a.png", "--exemplar", "other.png", "--out", "b.png")
    assert wrong.code == 2
    assert "other.png is not the image of the recipe" in wrong.err
    right = texlab("redo", "a.png", "--exemplar", "large.png", "--out", "b.png", "--json")
    assert json.loads(right.out)["same_bits"] is True


def test_redo_takes_every_missing_image_by_its_name(texlab: Texlab, short_recipes: None) -> None:
    large = LARGE[:270, :260]
    write_image("large.png", large)
    write_image("other.png", 1 - large)
    fill = ("--size", "261x270", "--set", "window=3", "--out", "a.png")
    assert texlab("fill", "large.png", *fill).code == 0
    # The image that is grown outward is its own exemplar, and named once.
    one = texlab("redo", "a.png", "--exemplar", "large.png", "--out", "b.png", "--json")
    assert json.loads(one.out)["same_bits"] is True
    assert texlab("fill", "large.png", "--exemplar", "gallery:structured-pebbles", *fill).code == 0
    for given in ((), ("--exemplar", "gallery:structured-pebbles")):
        shown = texlab("redo", "a.png", "--out", "b.png", *given)
        assert (shown.code, shown.out) == (2, "")
        assert "does not hold the start large.png" in shown.err
        assert shown.err.endswith("give it with --input start=IMAGE.\n")
    other = texlab("redo", "a.png", "--out", "b.png", "--input", "start=large.png", "--json")
    assert json.loads(other.out)["same_bits"] is True
    for wrong, says in (
        (("--input", "start=other.png"), "other.png is not the image of the recipe"),
        (("--input", "magic=large.png"), "does not hold the start"),
        (("--input", "magic=large.png", "--input", "start=large.png"), "has no image called magic"),
        (("--input", "start"), "a name and an image"),
        (("--input", "start=a.png", "--input", "start=b.png"), "given twice"),
        (("--input", "start=large.png", "--out", "large.png"), "is what the result is made from"),
    ):
        shown = texlab("redo", "a.png", "--out", "b.png", *wrong)
        assert (shown.code, shown.err.count("\n")) == (2, 1)
        assert says in shown.err


def test_redo_without_its_state_says_that_nothing_can_replace_it(
    texlab: Texlab, monkeypatch: pytest.MonkeyPatch
) -> None:
    inputs = (registry.EXEMPLAR, registry.InputSpec("state", "Arrays.", kind="arrays", required=False))
    stock(monkeypatch, registry._METHODS, noise_method(inputs=inputs))
    exemplar = as_exemplar(RAMP, name="ramp.png")
    for side, missing in ((8, False), (1000, True)):
        state = ArraysInput({"a": LARGE[:side, :side]}, "a state")
        made = run(Job(method="toy-noise", inputs={"exemplar": exemplar, "state": state}, size=(9, 9)))
        save_result(made, "a.png")
        shown = texlab("redo", "a.png", "--out", "b.png")
        assert (shown.code, shown.err.count("\n")) == (2 if missing else 0, 1 if missing else 0)
    assert shown.err.startswith("texlab: a.png does not hold the state a state")
    assert shown.err.endswith(", and cannot be made again without it.\n")
    given = texlab("redo", "a.png", "--out", "c.png", "--input", "state=a.png")
    assert given.code == 2
    assert given.err.count("\n") == 1
    assert not Path("c.png").exists()


def test_a_map_overwrites_neither_exemplar_nor_result(texlab: Texlab) -> None:
    Path("maps").mkdir()
    write_image("maps/source.png", LARGE[:9, :9])
    before = Path("maps/source.png").read_bytes()
    shown = texlab("synth", "maps/source.png", "--method", "tiling", "--out", "a.png", "--maps", "maps")
    assert shown.code == 2
    assert "would be overwritten by a map" in shown.err
    assert Path("maps/source.png").read_bytes() == before
    again = texlab("synth", "a.png", "--method", "tiling", "--out", "maps/source.png", "--maps", "maps")
    assert again.code == 2
    assert Path("maps/source.png").read_bytes() == before
    assert [path.name for path in Path("maps").iterdir()] == ["source.png"]
    full = texlab("synth", "maps/source.png", "--method", "tiling", "--out", "c.png", "--maps", "new")
    assert full.code == 0
    assert read_recipe("c.png").method == "tiling"
    assert texlab("synth", "a.png", "--method", "tiling", "--out", "b.png", "--maps", "").code == 2


def test_redo_refuses_files_without_a_recipe(texlab: Texlab, ramp: Path) -> None:
    for name in ("ramp.png", "missing.png"):
        shown = texlab("redo", name, "--out", "b.png")
        assert (shown.code, shown.out) == (2, "")
        assert shown.err.count("\n") == 1
    assert texlab("redo", "ramp.png", "--out", "no/b.png").code == 2


@pytest.mark.slow
@pytest.mark.parametrize("name", list(registry.methods()))
def test_every_method_can_be_redone(texlab: Texlab, name: str) -> None:
    method = registry.find_method(name)
    options = ["--crop", "48x40+10+20", "--size", "32x24" if method.dimensions == 2 else "32x24x10", "--seed", "5"]
    for spec in method.inputs:
        if spec.required and spec.name != "exemplar":
            options += [
                "--input",
                f"{spec.name}=gallery:stochastic-rock",
                "--input-crop",
                f"{spec.name}=40x48+7+9",
            ]
    suffix, read = {2: (".png", read_image), 3: (".tif", lambda path, _: read_volume(path))}[method.dimensions]
    made = texlab("synth", "gallery:structured-pebbles", "--method", name, "--out", f"a{suffix}", *options)
    assert (made.code, made.err) == (0, "")
    assert json.loads(texlab("redo", f"a{suffix}", "--out", f"b{suffix}", "--json").out)["same_bits"] is True
    one, other = (read(Path(each), each).values for each in (f"a{suffix}", f"b{suffix}"))
    np.testing.assert_array_equal(one, other)
    assert list(itertools.chain(Path().glob(".texlab*"), Path().glob("*.tmp"))) == []


def test_levels_are_used_kept_and_made_again(texlab: Texlab) -> None:
    from texlab_core.documents.reading import read_recipe
    from texlab_core.engine.levels import Levels

    values = np.random.default_rng(4).integers(2000, 9000, (24, 24, 1)) / np.float32(65535)
    write_image(Path("dark.png"), values.astype(np.float32), bits=16)
    base = ("synth", "dark.png", "--method", "pixels", "--size", "24x24")
    for given, wanted in (("0.02,0.15,1.2", Levels(0.02, 0.15, 1.2)), ("auto", None)):
        shown = texlab(*base, "--levels", given, "--out", "a.png")
        assert (shown.code, shown.err) == (0, "")
        assert "The levels are black 0.0" in shown.out
        levels = read_recipe("a.png").inputs["exemplar"].levels
        assert levels == wanted or (wanted is None and levels is not None and 0.02 < levels.black < 0.04)
        assert texlab("redo", "a.png", "--out", "b.png").code == 0
        first, second = (read_image(Path(name), name).values for name in ("a.png", "b.png"))
        assert np.array_equal(first, second)
        assert first.max() > 60000
    refused = texlab(*base, "--levels", "0.5,0.2,1", "--out", "c.png")
    assert refused.code == 2
    assert refused.err.startswith("texlab: levels: must be black, white and gamma as in 0.1,0.8,1.2")
    assert refused.err.count("\n") == 1
