"""Filling part by part: bounded, exact outside of the holes, and each part as the brute force has it."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.core.efros_leung_oracle import Oracle
from tests.core.test_efros_leung import texture
from texlab_core.documents.reading import read_recipe
from texlab_core.documents.record import carried_alpha, result_bits, save_result
from texlab_core.engine.inputs import ArraysInput
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image
from texlab_core.images.masks import as_blend, as_mask, feathered
from texlab_core.methods.efros_leung.by_parts import PartStreams
from texlab_core.methods.efros_leung.filling import grown_by, with_reach
from texlab_core.methods.efros_leung.params import EfrosLeungParams
from texlab_core.methods.efros_leung.parts import CELL, TILE, WHOLE, dilated, parts_of, size_of
from texlab_core.methods.efros_leung.patches import check_patches, pack_patches, patches_of
from texlab_core.methods.efros_leung.windows import integer_weights, offsets
from texlab_core.work.tasks import finish

PARAMS = EfrosLeungParams(window=5, reach=12)


def deep(height: int, width: int, seed: int = 0) -> Any:
    """Return a picture of 16 bits whose values are none of 8."""
    random = np.random.default_rng(seed)
    coarse = texture(height, width, 3, seed=seed).astype(np.uint16) * 257
    return as_exemplar(coarse // 2 + random.integers(0, 200, coarse.shape, dtype=np.uint16))


def marked(size: tuple[int, int], *boxes: tuple[slice, slice]) -> np.ndarray:
    mask = np.zeros(size, bool)
    for box in boxes:
        mask[box] = True
    return mask


def mask_of(mask: np.ndarray) -> Any:
    return as_mask(mask.astype(np.uint8) * np.uint8(255))


def fill(picture: Any, params: EfrosLeungParams = PARAMS, seed: int = 3, size: Any = None, **inputs: Any) -> Any:
    size = size or inputs.get("start", picture).size
    job = Job(method="efros-leung", inputs={"exemplar": picture, **inputs}, params=params, seed=seed, size=size)
    return run(job)


HOLES = (slice(20, 29), slice(22, 34)), (slice(70, 76), slice(100, 108))


def test_what_is_not_filled_keeps_its_bits_and_what_is_comes_from_nearby() -> None:
    picture, mask = deep(96, 128), marked((96, 128), *HOLES)
    result = fill(picture, mask=mask_of(mask))
    assert np.array_equal(result.image[~mask], picture.pixels[~mask])
    source = result.maps["source"].data
    assert np.array_equal(result.image, picture.pixels[source[..., 0], source[..., 1]])
    rows, columns = np.indices(mask.shape)
    assert np.array_equal(source[~mask], np.stack([rows, columns], axis=2)[~mask])
    for box in HOLES:
        near = dilated(box, 12, mask.shape)
        assert (source[box][..., 0] >= near[0].start).all()
        assert (source[box][..., 0] < near[0].stop).all()
        assert (source[box][..., 1] >= near[1].start).all()
        assert (source[box][..., 1] < near[1].stop).all()
    # No window of a candidate touches a hole.
    around = np.zeros(mask.shape, bool)
    for box in HOLES:
        around[dilated(box, 2, mask.shape)] = True
    assert not around[source[mask][:, 0], source[mask][:, 1]].any()
    order = result.maps["order"].data
    assert np.array_equal(np.sort(order[mask]), np.arange(1, mask.sum() + 1))
    assert not order[~mask].any()
    assert "in 2 parts" in result.notes[0]
    assert result.measures["copied-share"] <= 1


def test_a_part_is_filled_as_the_brute_force_fills_it() -> None:
    # All of the picture lies around the part.
    picture, mask = as_exemplar(texture(9, 10, 1, seed=4)), marked((9, 10), (slice(2, 6), slice(3, 8)))
    other, region = as_exemplar(texture(14, 12, 1, seed=8)), marked((14, 12), (slice(1, 13), slice(0, 11)))
    params = EfrosLeungParams(window=7, reach=64, tau=0.0)
    result = fill(other, params, start=picture, mask=mask_of(mask), region=mask_of(region))
    places = offsets(params.shape, params.window)
    weights = integer_weights(places, params.window, params.criterion, 1)
    streams = PartStreams(Streams(3), 0)
    start = np.rint(picture.pixels * 255).astype(int)
    expected = Oracle(
        exemplar=np.rint(other.pixels * 255).astype(int),
        image=np.where(mask[..., None], 0, start),
        known=~mask,
        weights={(int(y), int(x)): int(w) for (y, x), w in zip(places, weights, strict=True)},
        shape=params.shape,
        window=params.window,
        eps=Fraction(1, 10),
        tau=Fraction(0),
        choice_key=streams.key("choice"),
        order_key=streams.key("order"),
        region=region,
    ).run()
    assert np.array_equal(result.maps["source"].data[mask], expected.source[mask])
    assert np.array_equal(result.maps["order"].data, expected.order)
    assert np.array_equal(result.maps["matches"].data, expected.matches)


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.sampled_from([(300, 200), (97, 640), (33, 31)]))
def test_parts_cover_everything_and_each_touches_what_is_known(seed: int, count: int, size: Any) -> None:
    random = np.random.default_rng(seed)
    unknown = np.zeros(size, bool)
    for _ in range(count):
        top, left = (int(random.integers(side)) for side in size)
        height, width = (int(random.integers(1, 1 + side // 2)) for side in size)
        unknown[top : top + height, left : left + width] = True
    unknown[0, 0] = False
    boxes = finish(parts_of(unknown))
    left_over = unknown.copy()
    for box in boxes:
        assert max(size_of(box)) <= CELL * max(WHOLE, TILE)
        assert not left_over[dilated(box, 1, size)].all()
        left_over[box] = False
    assert not left_over.any()


def test_margins_larger_than_a_part_are_filled_from_the_nearest_border() -> None:
    picture = deep(40, 44, seed=2)
    params, size = grown_by(EfrosLeungParams(window=5, reach=8, tau=6.0), picture.size, (6, 0, 520, 3))
    assert size == (43, 570)
    result = fill(picture, params, size=size, start=picture)
    assert np.array_equal(result.image[:40, 6:50], picture.pixels)
    source = result.maps["source"].data
    assert np.array_equal(result.image, picture.pixels[source[..., 0], source[..., 1]])
    # Far to the right only the right border is near.
    assert source[:, -60:, 1].min() >= 44 - 8 - 1
    with pytest.raises(InputError, match="left, top: the start image of 44 x 40 pixels must lie inside"):
        fill(picture, params.replace(left=540), size=size, start=picture)
    with pytest.raises(InputError, match="margins: must be at least 0, got -1, 0, 0, 0"):
        grown_by(params, picture.size, (-1, 0, 0, 0))


def test_another_image_is_copied_from_and_the_deeper_one_decides_the_depth() -> None:
    picture, mask = deep(60, 50), marked((60, 50), (slice(10, 20), slice(10, 22)))
    other = as_exemplar(texture(30, 34, 3, seed=9))
    result = fill(other, start=picture, mask=mask_of(mask))
    source = result.maps["source"].data
    assert (source[~mask] == -1).all()
    assert np.array_equal(result.image[mask], other.pixels[source[mask][:, 0], source[mask][:, 1]])
    assert np.array_equal(result.image[~mask], picture.pixels[~mask])
    assert (other.depth, result_bits(result, "a.png")) == (8, 16)


def test_a_gray_mask_mixes_the_fill_with_what_was_there() -> None:
    picture = deep(64, 64, seed=5)
    hard = mask_of(marked((64, 64), (slice(20, 30), slice(20, 30))))
    blend = feathered(hard, 3)
    share = blend.pixels[..., 0]
    # One pixel outside: 1 - 1/4; the corner's distance is the root of 2.
    assert share[25, 30] == pytest.approx(0.75)
    assert share[30, 30] == pytest.approx(1 - np.sqrt(2) / 4, abs=1e-3)
    assert share[25, 33] == 0
    for params in (PARAMS, PARAMS.replace(reach=0)):
        result = fill(picture, params, blend=blend)
        whole = fill(picture, params, mask=mask_of(share > 0))
        expected = share[..., None] * whole.image.astype(float) + (1 - share[..., None]) * picture.pixels
        assert np.allclose(result.image, expected, atol=1e-6)
        assert np.array_equal(result.image[share == 0], picture.pixels[share == 0])
        assert np.array_equal(result.image[share == 1], whole.image[share == 1])
        assert f"{int(((share > 0) & (share < 1)).sum()):,} pixels of the edge" in result.notes[-1]
    with pytest.raises(InputError, match="mask, blend: both say what is filled"):
        fill(picture, mask=hard, blend=blend)
    with pytest.raises(InputError, match="feather: must be from 0 to 64 pixels for this mask, got -1"):
        feathered(hard, -1)
    assert feathered(as_mask(np.zeros((8, 8), np.uint8)), 4).pixels.max() == 0


def test_a_second_hole_is_filled_in_what_the_first_fill_made(tmp_path: Any) -> None:
    picture = deep(80, 80, seed=6)
    first_hole, second_hole = (slice(20, 30), slice(20, 30)), (slice(28, 40), slice(24, 36))
    first = fill(picture, mask=mask_of(marked((80, 80), first_hole)))
    mask = marked((80, 80), second_hole)
    patch = (first_hole, np.ones((10, 10), bool), first.image[first_hole])
    patches = pack_patches([patch])
    assert patches.arrays["pixels"].dtype == np.uint16
    ((box, marks, pixels),) = patches_of(patches)
    assert box == first_hole
    assert marks.all()
    assert np.array_equal(pixels, first.image[first_hole])
    second = fill(picture, mask=mask_of(mask), patches=patches)
    assert np.array_equal(second.image[~mask], first.image[~mask])
    source = second.maps["source"].data[mask]
    barred = marked((80, 80), *(dilated(each, 2, (80, 80)) for each in (first_hole, second_hole)))
    assert not barred[source[:, 0], source[:, 1]].any()
    assert np.array_equal(second.image[mask], picture.pixels[source[:, 0], source[:, 1]])
    # From the file alone.
    save_result(second, tmp_path / "filled.png")
    assert read_image(tmp_path / "filled.png", "filled").values.dtype == np.uint16
    again = run(read_recipe(tmp_path / "filled.png").job())
    assert np.array_equal(again.image, second.image)
    # Before a soft fill stands what the first one made.
    soft = feathered(mask_of(mask), 2)
    share = soft.pixels[..., 0]
    blended = fill(picture, blend=soft, patches=patches)
    whole = fill(picture, mask=mask_of(share > 0), patches=patches)
    expected = share[..., None] * whole.image.astype(float) + (1 - share[..., None]) * first.image
    assert np.allclose(blended.image, expected, atol=1e-6)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"places": np.array([[70, 70, 20, 20]], np.int32)}, "must lie inside the picture of 80 x 80"),
        ({"places": np.array([[0, 0, 10, -10]], np.int32)}, "must lie inside"),
        ({"places": np.zeros((0, 4), np.int32)}, "is not what was filled"),
        ({"marked": np.ones(100, np.uint8)}, "is not what was filled"),
        ({"pixels": np.full((100, 3), 2, np.float32)}, "has values outside 0 to 1"),
        ({"pixels": np.full((100, 3), np.nan, np.float32)}, "has values outside 0 to 1"),
        ({"other": np.zeros(1)}, "must have the arrays places, marked, pixels"),
    ],
)
def test_patches_that_are_none_are_refused(change: Any, sentence: str) -> None:
    good = {
        "places": np.array([[10, 10, 10, 10]], np.int32),
        "marked": np.ones(100, bool),
        "pixels": np.zeros((100, 3), np.uint8),
    }
    check_patches(ArraysInput(good, "good"), (80, 80), 3)
    with pytest.raises(InputError, match=sentence):
        check_patches(ArraysInput(good | change, "bad"), (80, 80), 3)


def test_patches_need_parts() -> None:
    picture = deep(40, 40)
    patches = pack_patches([((slice(0, 2), slice(0, 2)), np.ones((2, 2), bool), np.zeros((2, 2, 3), np.float32))])
    mask = mask_of(marked((40, 40), (slice(10, 12), slice(10, 12))))
    with pytest.raises(InputError, match="patches: are laid over a picture that is filled part by part"):
        fill(picture, PARAMS.replace(reach=0), mask=mask, patches=patches)


def test_where_nothing_near_is_left_it_looks_further_away() -> None:
    picture = deep(60, 60)
    region = marked((60, 60), (slice(48, 60), slice(48, 60)))
    mask = mask_of(marked((60, 60), (slice(4, 8), slice(4, 8))))
    result = fill(picture, mask=mask, region=mask_of(region))
    source = result.maps["source"].data[4:8, 4:8]
    assert source.min() >= 48
    crowded = ~marked((60, 60), (slice(0, 3), slice(0, 60)))
    with pytest.raises(InputError, match="No whole window of 5 x 5 pixels is left to copy from"):
        fill(picture, mask=mask_of(crowded))


def test_transparency_stays_with_the_picture() -> None:
    values = np.dstack([texture(40, 40, 3), np.full((40, 40), 255, np.uint8)])
    values[30:, :, 3] = 100
    picture = as_exemplar(values, alpha="keep")
    mask = marked((40, 40), (slice(10, 14), slice(10, 14)))
    other = as_exemplar(texture(30, 30, 3))
    for result in (fill(picture, mask=mask_of(mask)), fill(other, start=picture, mask=mask_of(mask))):
        alpha = carried_alpha(result)
        assert alpha is not None
        assert np.array_equal(alpha[~mask], picture.alpha[~mask])


def test_gray_masks_of_files_are_soft_masks() -> None:
    values = np.array([[0, 51, 255, 102]] * 3, np.uint8)
    blend = as_blend(values)
    assert np.allclose(blend.pixels[..., 0], values / 255)
    assert "25 % in full and 50 % in part" in blend.notes[-1]


def test_a_large_picture_is_searched_around_its_holes() -> None:
    plain = EfrosLeungParams()
    assert with_reach(plain, (512, 512)) == (plain, ())
    changed, said = with_reach(plain, (600, 600))
    assert changed.to_json()["reach"] == 64
    assert "within 64 pixels" in said[0]
    assert with_reach(changed, (600, 600)) == (changed, ())


def test_documents_from_before_are_filled_as_they_were() -> None:
    old = EfrosLeungParams().to_json()
    for name in ("reach", "left", "top", "tau_scale"):
        del old[name]
    back = EfrosLeungParams.from_json(old).to_json()
    assert (back["reach"], back["left"], back["top"], back["tau_scale"]) == (0, 0, 0, "absolute")


def test_the_spread_of_a_whole_picture_is_not_measured_while_parts_are_filled(monkeypatch: Any) -> None:
    """It takes as long as the picture is large, and nobody asks in between whether to stop."""
    seen: list[tuple[int, int]] = []
    usual = EfrosLeungParams.matching

    def watched(self: EfrosLeungParams, exemplar: Any) -> Any:
        seen.append(exemplar.size)
        return usual(self, exemplar)

    picture = deep(120, 160)
    holes = mask_of(marked(picture.size, *HOLES))
    inputs = {"exemplar": picture, "mask": holes}
    job = Job(method="efros-leung", inputs=inputs, params=PARAMS, seed=3, size=picture.size)
    before = run(job)
    monkeypatch.setattr(EfrosLeungParams, "matching", watched)
    again = run(job)
    assert np.array_equal(again.image, before.image)
    assert seen
    assert all(height * width < 120 * 160 / 4 for height, width in seen)
    # Another image is looked at once, however many parts are copied from it.
    seen.clear()
    other = deep(40, 48, seed=5)
    fill(other, start=picture, mask=holes)
    assert [size for size in seen if size == other.size].count(other.size) <= 2
