"""Levels: the formula, what is automatic, and that a recipe knows them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texlab_core.documents.project import Project, encode_project
from texlab_core.documents.project_reading import read_project
from texlab_core.documents.reading import read_recipe
from texlab_core.documents.record import save_result
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.levels import BINS, Levels, histogram_of
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar


def dark(height: int = 30, width: int = 34) -> Any:
    """Return a dark picture of 16 bits."""
    values = np.random.default_rng(2).integers(2000, 9000, (height, width, 3)).astype(np.uint16)
    return as_exemplar(values, name="dark.tif")


@given(st.floats(0, 0.4), st.floats(0.5, 1), st.floats(0.1, 10), st.floats(0, 1))
def test_levels_are_the_formula(black: float, white: float, gamma: float, value: float) -> None:
    made = Levels(black, white, gamma).applied(np.full((2, 2, 1), value, np.float32))
    expected = np.clip((value - black) / (white - black), 0, 1) ** (1 / gamma)
    assert made.dtype == np.float32
    # A steep curve at black makes much of a rounding.
    slack = 1e-5 if expected > 1e-3 else 1e-6 ** (1 / gamma) + 1e-5
    assert made[0, 0, 0] == pytest.approx(expected, abs=slack)


def test_plain_levels_change_nothing() -> None:
    picture = dark()
    assert Levels().applied(picture.pixels) is picture.pixels
    assert as_exemplar(picture, levels=Levels()) is picture
    assert np.array_equal(Levels().table(), np.arange(256))
    table = Levels(0.2, 0.6, 2.0).table()
    assert (table[51], table[153]) == (0, 255)
    assert table[102] == round(255 * ((102 / 255 - 0.2) / 0.4) ** 0.5)


@pytest.mark.parametrize(
    "numbers",
    [(0.5, 0.5, 1), (-0.1, 1, 1), (0, 1.1, 1), (0, 1, 0), (0, 1, 11), (np.nan, 1, 1), (True, 1, 1)],
)
def test_levels_that_cannot_be_are_one_sentence(numbers: Any) -> None:
    with pytest.raises(InputError, match="levels: must be black, white and gamma as in"):
        Levels(*numbers)
    with pytest.raises(InputError, match="levels: must be"):
        Levels.from_json([*numbers])
    for text in ("1,2", "a,b,c", "0,1,1,1", ""):
        with pytest.raises(InputError, match="levels: must be"):
            Levels.parse(text)


def test_levels_are_written_and_read() -> None:
    levels = Levels(0.125, 0.75, 1.5)
    assert Levels.parse(levels.text) == levels
    assert Levels.from_json(levels.to_json()) == levels
    assert Levels.parse("AUTO") is None


def test_automatic_levels_use_the_whole_range() -> None:
    picture = dark()
    levels = Levels.auto(picture.pixels)
    low, high = np.quantile(picture.pixels, [0.001, 0.999])
    assert levels.black == pytest.approx(low, abs=2e-4)
    assert levels.white == pytest.approx(high, abs=2e-4)
    made = levels.applied(picture.pixels)
    assert (made.min(), made.max()) == (0, 1)
    # More than 256 grays are left of a deep picture.
    assert len(np.unique(made)) > 1500
    assert Levels.auto(np.full((4, 4, 1), 0.3, np.float32)).plain


def test_a_histogram_is_by_channel_and_sums_to_one() -> None:
    picture = dark()
    shares = histogram_of(picture.pixels)
    assert shares.shape == (3, BINS)
    assert np.allclose(shares.sum(axis=1), 1)
    expected = np.histogram(picture.pixels[..., 1], 256, (0, 1))[0] / (30 * 34)
    assert np.allclose(shares[1], expected)


def test_levels_come_after_scale_and_crop_and_are_said() -> None:
    picture, levels, crop = dark(), Levels(0.02, 0.15, 0.8), Crop(2, 3, 12, 10)
    plain = as_exemplar(picture, scale=0.5, crop=crop)
    made = as_exemplar(picture, scale=0.5, crop=crop, levels=levels)
    assert np.array_equal(made.pixels, levels.applied(plain.pixels))
    assert made.notes[-1] == "The levels are black 0.02, white 0.15, gamma 0.8."
    # Taken anew from its source, not once more from what was made of it.
    assert np.array_equal(as_exemplar(made, levels=levels).pixels, levels.applied(picture.pixels))


@pytest.mark.parametrize("embedded", [True, False])
def test_a_recipe_knows_the_levels(tmp_path: Any, monkeypatch: pytest.MonkeyPatch, embedded: bool) -> None:
    from texlab_core.documents import embedding, recipe

    if not embedded:
        monkeypatch.setattr(recipe, "MAX_EMBEDDED", 10)
        monkeypatch.setattr(recipe, "MAX_USED", 10)
        monkeypatch.setattr(embedding, "MAX_EMBEDDED", 10)
        monkeypatch.setattr(embedding.embed, "__kwdefaults__", {"limit": 10, "used": 10})
    exemplar = as_exemplar(dark(), crop=Crop(2, 2, 24, 24), levels=Levels(0.02, 0.15, 1.2))
    result = run(Job(method="pixels", inputs={"exemplar": exemplar}, seed=4))
    save_result(result, tmp_path / "a.png")
    found = read_recipe(tmp_path / "a.png")
    assert found.inputs["exemplar"].levels == Levels(0.02, 0.15, 1.2)
    assert found.inputs["exemplar"].is_embedded == embedded
    again = run(found.job() if embedded else found.job(dark()))
    assert np.array_equal(again.image, result.image)


def test_a_project_keeps_the_levels(tmp_path: Any) -> None:
    levels = Levels(0.02, 0.15, 1.2)
    for each in (levels, None):
        (tmp_path / "a.texlab").write_bytes(encode_project(Project(dark(), (), levels=each)))
        assert read_project(tmp_path / "a.texlab").levels == each
