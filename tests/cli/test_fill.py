"""``texlab fill``: what is filled is copied, the rest stays; one sentence for what cannot work."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.core.test_efros_leung import texture
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.writing import write_image
from texlab_core.methods.efros_leung.method import EfrosLeungParams

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab

HOLE = (slice(10, 18), slice(12, 20))


def save(path: str, values: np.ndarray) -> str:
    write_image(Path(path), (values / np.float32(255)).astype(np.float32))
    return path


@pytest.fixture
def wall(texlab: Texlab) -> str:
    """An image in the current folder."""
    return save("wall.png", texture(28, 30, 3))


@pytest.fixture
def mask(texlab: Texlab) -> str:
    marks = np.zeros((28, 30, 1), np.uint8)
    marks[HOLE] = 255
    return save("mask.png", marks)


def pixels(path: str) -> np.ndarray:
    return read_image(Path(path), path).values


def test_a_hole_is_filled_as_in_the_python_api(texlab: Texlab, wall: str, mask: str) -> None:
    shown = texlab("fill", wall, "--mask", mask, "--out", "out.png", "--seed", 3, "--set", "window=7", "--json")
    assert (shown.code, shown.err) == (0, "")
    assert json.loads(shown.out)
    inputs = {"exemplar": as_exemplar(wall), "mask": as_exemplar(mask)}
    expected = run(Job(method="efros-leung", inputs=inputs, params=EfrosLeungParams(window=7), seed=3)).image
    made = pixels("out.png")
    np.testing.assert_array_equal(made, np.rint(expected * 255).astype(np.uint8))
    outside = np.ones((28, 30), bool)
    outside[HOLE] = False
    np.testing.assert_array_equal(made[outside], pixels(wall)[outside])


def test_what_is_transparent_is_filled(texlab: Texlab, wall: str, mask: str) -> None:
    from PIL import Image

    whole = pixels(wall)
    alpha = 255 - pixels(mask)[..., :1]
    Image.fromarray(np.concatenate([whole, alpha], axis=2)).save("holes.png")
    shown = texlab("fill", "holes.png", "--transparent", "--out", "out.png", "--set", "window=7")
    assert (shown.code, shown.err) == (0, "")
    opaque = alpha[..., 0] == 255
    made = pixels("out.png")
    np.testing.assert_array_equal(made[opaque], whole[opaque])
    # White is what transparent pixels are laid over, and none of it is copied.
    assert (made[~opaque].min(axis=1) < 255).all()
    assert texlab("fill", wall, "--transparent", "--out", "out.png").err == (
        "texlab: wall.png has no transparency; give --mask.\n"
    )


def test_growing_outward(texlab: Texlab, wall: str) -> None:
    settings = ("--set", "window=7", "--set", "anchor=top-left")
    shown = texlab("fill", wall, "--size", "38x33", "--out", "out.png", *settings)
    assert (shown.code, shown.err) == (0, "")
    made = pixels("out.png")
    assert made.shape == (33, 38, 3)
    np.testing.assert_array_equal(made[:28, :30], pixels(wall))


def test_another_exemplar_and_a_region(texlab: Texlab, wall: str, mask: str) -> None:
    other = save("other.png", texture(20, 22, 3, seed=5))
    marks = np.zeros((20, 22, 1), np.uint8)
    marks[3:14] = 255
    region = save("region.png", marks)
    shown = texlab(
        *("fill", wall, "--mask", mask, "--exemplar", other, "--region", region),
        *("--out", "out.png", "--set", "window=5", "--maps", "maps"),
    )
    assert (shown.code, shown.err) == (0, "")
    allowed = {tuple(pixel) for pixel in pixels(other)[3:14].reshape(-1, 3)}
    assert {tuple(pixel) for pixel in pixels("out.png")[HOLE].reshape(-1, 3)} <= allowed


def test_a_recipe_makes_the_same_fill_again(texlab: Texlab, wall: str, mask: str) -> None:
    assert texlab("fill", wall, "--mask", mask, "--out", "out.png", "--set", "window=7").code == 0
    assert texlab("redo", "out.png", "--out", "again.png").code == 0
    np.testing.assert_array_equal(pixels("again.png"), pixels("out.png"))


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((), "There is nothing to fill: give --mask, --transparent or a larger --size."),
        (("--mask", "mask.png", "--transparent"), "Give either --mask or --transparent."),
        (("--mask", "small.png"), "mask: must have the size of the exemplar, 30 x 28 pixels, got 5 x 4."),
        (("--mask", "black.png"), "mask: marks no pixel, so that there is nothing to fill."),
        (("--mask", "white.png"), "mask: covers the whole image, so that nothing is left to grow from."),
        (("--size", "20x20"), "size: must be at least that of the start image, 30 x 28 pixels, got 20 x 20."),
        (("--mask", "mask.png", "--set", "window=2"), "window: must be an odd whole number from 3 to 41, got 2."),
        (("--mask", "mask.png", "--out", "wall.png"), "wall.png is what the result is made from"),
    ],
)
def test_what_cannot_work_is_said_in_one_sentence(
    texlab: Texlab, wall: str, mask: str, arguments: tuple[str, ...], sentence: str
) -> None:
    save("small.png", np.full((4, 5, 1), 255, np.uint8))
    save("black.png", np.zeros((28, 30, 1), np.uint8))
    save("white.png", np.full((28, 30, 1), 255, np.uint8))
    shown = texlab("fill", wall, "--out", "out.png", *arguments)
    assert shown.code == 2
    assert sentence in shown.err
    assert shown.err.count("\n") == 1
    assert not Path("out.png").exists()


def test_the_help_lists_the_knobs(texlab: Texlab) -> None:
    shown = texlab("fill", "--help")
    assert "--mask" in shown.out
    assert "error_limit" in shown.out
