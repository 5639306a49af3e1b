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
from texlab_core.methods.efros_leung.params import EfrosLeungParams

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
        ((), "There is nothing to fill: give --mask, --transparent, --margins or a larger --size."),
        (("--mask", "mask.png", "--soft", "--feather", "2"), "Give either --soft or --feather."),
        (("--size", "40x40", "--margins", "4"), "Give either --size or --margins."),
        (("--margins", "1,2,3"), "margins: must be a number of pixels, or four for left, top, right and bottom"),
        (("--margins", "0"), "margins: must be at least one margin above 0, got '0'."),
        (("--margins", "4", "--soft"), "--soft needs --mask or --transparent."),
        (("--mask", "mask.png", "--feather", "x"), "feather: must be a whole number, got 'x'."),
        (("--mask", "mask.png", "--feather", "99"), "feather: must be from 0 to 30 pixels for this mask, got 99."),
        (("--mask", "mask.png", "--soft", "--threshold", "0.2"), "Give either --soft or --threshold."),
        (("--mask", "mask.png", "--exemplar-scale", "0.5"), "--exemplar-scale needs --exemplar."),
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


def test_margins_and_another_image_of_which_a_part_is_used(texlab: Texlab, wall: str) -> None:
    other = save("other.png", texture(40, 40, 3, seed=5))
    shown = texlab(
        *("fill", wall, "--margins", "3,0,5,2", "--exemplar", other, "--exemplar-crop", "20x22+4+6"),
        *("--out", "out.png", "--set", "window=5"),
    )
    assert (shown.code, shown.err) == (0, "")
    made = pixels("out.png")
    assert made.shape == (30, 38, 3)
    np.testing.assert_array_equal(made[:28, 3:33], pixels(wall))
    allowed = {tuple(pixel) for pixel in pixels(other)[6:28, 4:24].reshape(-1, 3)}
    assert {tuple(pixel) for pixel in made[28:].reshape(-1, 3)} <= allowed
    assert texlab("redo", "out.png", "--out", "again.png").code == 0
    np.testing.assert_array_equal(pixels("again.png"), made)


@pytest.mark.parametrize("how", [("--soft",), ("--feather", "2")])
def test_soft_edges_at_sixteen_bits(texlab: Texlab, how: tuple[str, ...]) -> None:
    random = np.random.default_rng(1)
    deep = texture(28, 30, 3).astype(np.float32) / 255 + random.random((28, 30, 3), np.float32) / 300
    write_image(Path("deep.png"), deep.clip(0, 1), bits=16)
    marks = np.zeros((28, 30, 1), np.float32)
    marks[HOLE] = 1
    if how == ("--soft",):
        marks[9, 12:20] = 0.4
    write_image(Path("mask.png"), marks)
    shown = texlab("fill", "deep.png", "--mask", "mask.png", *how, "--out", "out.png", "--set", "window=5")
    assert (shown.code, shown.err) == (0, "")
    made, was = pixels("out.png"), pixels("deep.png")
    assert made.dtype == np.uint16
    outside = np.ones((28, 30), bool)
    outside[7:21, 9:23] = False
    np.testing.assert_array_equal(made[outside], was[outside])
    assert (made[9, 12:20] != was[9, 12:20]).any()
    assert "pixels of the edge mix the fill with what was there." in shown.out
    # A mask is an image of its own: the recipe has it, and takes it from outside too.
    assert texlab("redo", "out.png", "--out", "again.png").code == 0
    np.testing.assert_array_equal(pixels("again.png"), made)


def test_how_transparent_a_pixel_is_says_how_much_is_filled(texlab: Texlab, wall: str) -> None:
    from PIL import Image

    alpha = np.full((28, 30, 1), 255, np.uint8)
    alpha[HOLE] = 0
    alpha[18, 12:20] = 204
    Image.fromarray(np.concatenate([pixels(wall), alpha], axis=2)).save("holes.png")
    shown = texlab(
        *("fill", "holes.png", "--transparent", "--soft", "--alpha", "ignore"),
        *("--out", "out.png", "--set", "window=5"),
    )
    assert (shown.code, shown.err) == (0, "")
    change = np.abs(pixels("out.png")[18, 12:20].astype(int) - pixels(wall)[18, 12:20])
    # A fifth of the fill, and four fifths of what was there.
    assert change.max() <= 52
    assert change.any()


def test_a_large_picture_is_filled_around_its_hole_and_says_so(texlab: Texlab) -> None:
    large = save("large.png", np.tile(texture(60, 60, 1), (9, 10, 1)))
    marks = np.zeros((540, 600, 1), np.uint8)
    marks[300:304, 200:206] = 255
    save("mask.png", marks)
    shown = texlab("fill", large, "--mask", "mask.png", "--out", "out.jpg", "--set", "window=5")
    assert (shown.code, shown.err) == (0, "")
    assert "24 pixels were filled, each from one of about" in shown.out
    assert (
        "Only what is within 64 pixels of a hole was looked at; reach=0 searches the whole picture." in shown.out
    )
    assert "A JPEG is compressed as a whole" in shown.out


def test_the_help_lists_the_knobs(texlab: Texlab) -> None:
    shown = texlab("fill", "--help")
    assert "--mask" in shown.out
    assert "error_limit" in shown.out
