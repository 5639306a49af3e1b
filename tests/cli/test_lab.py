"""``texlab lab``: every experiment says its numbers and draws its picture; bad input is one sentence."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from texlab.cli.commands.lab import EXPERIMENTS
from texlab_core.images.formats.reading import read_image

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab

ZEBRA = ("gallery:oriented-zebra", "--crop", "96x96+0+0")
CASES = {
    "filters": (*ZEBRA, "--scales", "1,2"),
    "representation": (*ZEBRA, "--classes", "3"),
    "gabor": (*ZEBRA, "--wavelength", "28", "--orientation", "12", "--local"),
    "dependence": (*ZEBRA, "--result", "gallery:stochastic-lava", "--values", "magnitudes"),
    "equalize": ("ramp", "cube-root", "--ties", "together", "--value", "0.3"),
    "pyramid": (*ZEBRA, "--levels", "2", "--orientations", "2"),
    "search": (*ZEBRA, "--threshold", "0.3"),
    "shape": ("discs", "--slant", "50", "--tilt", "30", "--size", "128x128"),
    "homogeneity": ("marks", "--slant", "40", "--trials", "5"),
    "sphere": ("--side", "128", "--window", "20"),
}


def answer(texlab: Texlab, *arguments: object) -> dict:
    shown = texlab("lab", *arguments, "--json")
    assert (shown.code, shown.err) == (0, "")
    return json.loads(shown.out)


def test_every_experiment_has_a_case() -> None:
    assert set(CASES) == set(EXPERIMENTS)


@pytest.mark.parametrize("name", CASES)
def test_every_experiment_prints_json_or_lines_and_draws(texlab: Texlab, name: str) -> None:
    picture = () if name == "search" else ("--out", "sheet.png")
    found = answer(texlab, name, *CASES[name], *picture)
    lines = texlab("lab", name, *CASES[name]).out.splitlines()
    assert lines
    assert not any(line.startswith("{") for line in lines)
    if picture:
        assert found["out"] == "sheet.png"
        pixels = read_image(Path("sheet.png"), "sheet.png").values
        assert pixels.shape[2] == 3
        assert pixels.std() > 10
        assert texlab("lab", name, *CASES[name], "--out", "sheet.png").out.splitlines() == [*lines, "sheet.png"]


def test_numbers_are_those_of_the_core(texlab: Texlab) -> None:
    ramps = answer(texlab, "equalize", *CASES["equalize"])
    assert ramps["new_value"] == pytest.approx(0.3 ** (1 / 3), abs=0.01)
    assert ramps["distance_after"] == pytest.approx(0, abs=1e-6)
    plane = answer(texlab, "shape", *CASES["shape"])
    assert plane["truth"]["slant"] == 50
    assert plane["search"]["error"] < 5
    assert plane["frontal"]["isotropic"] is True
    bands = answer(texlab, "pyramid", *CASES["pyramid"])["bands"]
    assert len(bands) == 2 * 2 + 2
    assert sum(band["share_of_power"] for band in bands) == pytest.approx(1, abs=1e-3)
    steps = answer(texlab, "pyramid", *ZEBRA, "--levels", "2", "--steps", "--out", "steps.png")
    assert steps["error"] < 1e-6
    assert len(steps["rms"]) == 2
    gabor = answer(texlab, "gabor", *CASES["gabor"])
    assert gabor["sigma"] == 14
    assert 15 < gabor["local_wavelength"][0] < 40


def test_dependence_tells_the_measure(texlab: Texlab) -> None:
    from texlab_core.measures.registry import find_measure
    from texlab_core.measures.subject import Subject

    names = "gallery:structured-pebbles", "gallery:stochastic-lava"
    both = "dependence", names[0], "--result", names[1]
    found = answer(texlab, *both)
    expected = find_measure("dependence-difference").of(Subject.of_images(*names))
    assert found["dependence"] == pytest.approx(expected, abs=1e-12)
    assert "(the measure)" in texlab("lab", *both).out
    alone = answer(texlab, "dependence", names[0], "--relation", "orientation", "--orientation", "45")
    assert alone["pair"] == "level 0, 45°, given the orientation turned by 90°"
    assert "dependence" not in alone
    assert len(alone["exemplar"]["joint"]) == 33
    bits = answer(texlab, "dependence", names[0], "--values", "ranks")["exemplar"]
    assert bits["information"] == found["exemplar"]["information"]


def test_all_ways_of_searching_find_as_many(texlab: Texlab) -> None:
    everywhere = answer(texlab, "search", *CASES["search"])
    assert everywhere["blank_search"]["verified"] == everywhere["structures"]
    here = answer(texlab, "search", *CASES["search"], "--pixel", "3,5", "--level", "2")
    for found in (everywhere, here):
        counts = {found[way]["found"] for way in ("blank_search", "hash_keys", "hierarchy")}
        assert len(counts) == 1
    assert here["hierarchy"]["verified"] < everywhere["blank_search"]["verified"]


@pytest.mark.parametrize("kind", ["orthographic", "border", "perspective", "counts"])
def test_the_panel_s_other_experiments(texlab: Texlab, kind: str) -> None:
    found = answer(
        texlab, "homogeneity", kind, "--slant", "40", "--trials", "12", "--points", "300", "--out", "a.png"
    )
    assert Path("a.png").is_file()
    if kind == "border":
        assert found["chosen_frontal"] > 0.8
    elif kind == "orthographic":
        assert found["count_ratio"] == pytest.approx(1, abs=0.35)
    elif kind == "perspective":
        assert found["mean_error"] < 6
    else:
        assert found["regular"]["even"] == 1
        assert found["area_on_plane"]["smallest"] == found["area_on_plane"]["largest"]


def test_a_view_of_the_user_s_own_has_no_truth(texlab: Texlab) -> None:
    found = answer(texlab, "shape", "gallery:stochastic-lava", "--out", "a.png")
    assert "truth" not in found
    slanted = texlab("lab", "shape", "gallery:oriented-planks", "--slant", "40")
    assert "neither estimate can be trusted" in slanted.out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("filters", ZEBRA[0], "--scales", "0.5"), "scale: must be a number from 1 to 16, got 0.5"),
        (("filters", ZEBRA[0], "--scales", "1,2,x"), "scales: must be a number, got 'x'"),
        (("filters", ZEBRA[0], "--scales", "1,1,1,1,1,1,1"), "scales: must be at most 6 numbers"),
        (("gabor", ZEBRA[0], "--wavelength", "1"), "wavelength: must be a number of pixels from 2 to 256"),
        (("representation", ZEBRA[0], "--classes", "9"), "classes: must be a whole number from 2 to 8, got 9"),
        (("representation", ZEBRA[0], "--seed", "-1"), "seed: must be"),
        (("pyramid", ZEBRA[0], "--levels", "-1"), "levels: must be a whole number from 0, got -1"),
        (("pyramid", ZEBRA[0], "--orientations", "0"), "orientations: must be a whole number from 1 to 18"),
        (("pyramid", ZEBRA[0], "--steps", "--levels", "20"), "levels: must be a whole number from 1 to 8"),
        (
            ("dependence", ZEBRA[0], "--orientation", "30"),
            "orientation: must be 0, 45, 90 or 135 degrees, got '30'",
        ),
        (("dependence", ZEBRA[0], "--turn", "0"), "turn: must be 45, 90 or 135 degrees, got '0'"),
        (("dependence", ZEBRA[0], "--offset", "3"), "offset: must be columns and rows as in 1,0, got '3'"),
        (("dependence", ZEBRA[0], "--relation", "neighbour", "--offset", "0,0"), "not 0,0"),
        (("dependence", ZEBRA[0], "--level", "9"), "level: must be a whole number from 0 to 3, got 9"),
        (("dependence", *ZEBRA, "--level", "3"), "at least 320 pixels high and wide for level 3, got '96 x 96'"),
        (("search", ZEBRA[0], "--pixel", "3"), "pixel: must be column and row as in 10,20, got '3'"),
        (("shape", "noise", "--slant", "85"), "slant: must be at most 80 degrees"),
        (("shape", "noise", "--size", "4000x20"), "size: must be at most 1024x1024"),
        (("shape", "noise", "--out", "a.jpg"), "out: must be a file name that ends in .png, got 'a.jpg'"),
        (("homogeneity", "marks", "--trials", "0"), "trials: must be a whole number from 1 to 1000, got 0"),
        (("homogeneity", "marks", "--points", "3"), "points: must be a whole number from 20 to 20000, got 3"),
        (("homogeneity", "perspective", "--slant", "75"), "horizon stays outside"),
        (("sphere", "--side", "20"), "side: must be a whole number from 96 to 1024, got 20"),
    ],
)
def test_bad_input_is_one_sentence(texlab: Texlab, arguments: tuple[str, ...], sentence: str) -> None:
    shown = texlab("lab", *arguments)
    assert shown.code == 2
    assert shown.out == ""
    assert sentence in shown.err
    assert len(shown.err.strip().splitlines()) == 1


def test_quiet_and_pipes_work_as_with_every_command(texlab: Texlab, monkeypatch: pytest.MonkeyPatch) -> None:
    shown = texlab("lab", "gabor", *ZEBRA, "--out", "a.png", "--quiet")
    assert (shown.code, shown.out, shown.err) == (0, "", "")
    assert json.loads(texlab("lab", "gabor", *ZEBRA, "--quiet", "--json").out)["wavelength"] == 8
    both = texlab("lab", "gabor", *ZEBRA, "--out", "-", "--json")
    assert both.code == 2
    assert "both want standard output" in both.err


def test_the_gallery_s_anisotropic_textures_are_those_that_the_help_counts() -> None:
    from texlab_core.files.resources import resource
    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.images.gallery import gallery
    from texlab_core.shape.isotropy import DOUBTFUL, isotropy_spectrum
    from texlab_core.transforms.luma import luma

    slants = [isotropy_spectrum(luma(as_exemplar(entry.uri).pixels)).by_moments().slant for entry in gallery()]
    doubtful = sum(slant > DOUBTFUL for slant in slants)
    page = resource("help/shape-from-texture.md").read_text(encoding="utf-8")
    assert f"{doubtful} of the gallery's {len(slants)} textures" in " ".join(page.split())
