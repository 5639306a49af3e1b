"""The one door: arrays, image inputs, scale, crop and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from texlab_core.engine.inputs import Crop, hash_arrays
from texlab_core.errors import ImageError
from texlab_core.images.exemplar import as_exemplar


def colour(height=6, width=8, dtype=np.uint8, seed=0):
    peak = np.iinfo(dtype).max
    return np.random.default_rng(seed).integers(0, peak, (height, width, 3), dtype=dtype, endpoint=True)


@settings(deadline=None)
@given(
    hnp.arrays(
        st.sampled_from([np.uint8, np.uint16]),
        st.tuples(st.integers(2, 7), st.integers(2, 7), st.sampled_from([1, 3])),
    )
)
def test_integers_become_k_over_peak_and_stay_recoverable(array):
    made = as_exemplar(array)
    peak = np.iinfo(array.dtype).max
    assert made.pixels.dtype == np.float32
    assert made.pixels.flags.c_contiguous
    assert not made.pixels.flags.writeable
    kept = array[..., :1] if (array == array[..., :1]).all() else array
    assert np.array_equal(np.rint(made.pixels.astype(np.float64) * peak), kept)
    assert np.abs(made.pixels - kept / peak).max() <= 2**-24
    assert made.sha256 == hash_arrays({"pixels": made.pixels})


@settings(deadline=None)
@given(
    hnp.arrays(
        st.sampled_from([np.float32, np.float64]),
        st.tuples(st.integers(2, 5), st.integers(2, 5), st.just(1)),
        elements=st.floats(allow_nan=False, allow_infinity=False, width=32),
    )
)
def test_any_finite_floats_land_in_the_unit_range(array):
    made = as_exemplar(array).pixels
    low, high = float(array.min()), float(array.max())
    assert made.min() >= 0
    assert made.max() <= 1
    if low >= 0 and high <= 1:
        assert np.array_equal(made, array.astype(np.float32))
    elif (made != 0.5).any():
        order = np.argsort(array.ravel(), kind="stable")
        assert (np.diff(made.ravel()[order]) >= 0).all()


def test_floats_outside_are_mapped_from_their_range_and_it_says_so():
    made = as_exemplar(np.array([[-1.0, 0.0], [1.0, 3.0]]))
    assert np.array_equal(made.pixels[..., 0], np.float32([[0, 0.25], [0.5, 1]]))
    assert made.notes == ("Values from -1 to 3 were mapped to 0 to 1.",)


def test_the_widest_floats_do_not_overflow():
    top = np.finfo(np.float64).max
    made = as_exemplar(np.array([[-top, 0.0], [top, top]]))
    assert np.array_equal(made.pixels[..., 0], np.float32([[0, 0.5], [1, 1]]))


def test_a_constant_outside_the_range_is_middle_gray():
    made = as_exemplar(np.full((3, 3), 7.0))
    assert (made.pixels == 0.5).all()
    assert made.notes == ("All values are 7, outside 0 to 1, and were set to 0.5.",)


def test_negative_zero_has_the_hash_of_zero():
    zeros = np.zeros((2, 2), np.float32)
    assert as_exemplar(-zeros).sha256 == as_exemplar(zeros).sha256


def test_hash_depends_on_shape_and_values():
    array = colour(4, 4)
    hashes = {as_exemplar(each).sha256 for each in (array, array[:2].copy(), array.swapaxes(0, 1), array // 2)}
    assert len(hashes) == 4
    assert as_exemplar(np.asfortranarray(array)).sha256 == as_exemplar(array).sha256


def test_later_changes_to_the_array_do_not_reach_the_exemplar():
    array = np.full((2, 2), 0.5, np.float32)
    made = as_exemplar(array)
    array[:] = 0
    assert (made.pixels == 0.5).all()
    with pytest.raises(ValueError, match="read-only"):
        made.pixels[0, 0, 0] = 1


def test_read_only_views_are_copied_too():
    base = np.full((4, 4, 1), 0.5, np.float32)
    view = base[:]
    view.flags.writeable = False
    made = as_exemplar(view)
    base[:] = 0
    assert (made.pixels == 0.5).all()


@pytest.mark.parametrize("dtype", [">u2", ">f4", "<f8", ">f2", "u1"])
def test_the_order_of_bytes_and_subclasses_do_not_matter(dtype):
    values = np.arange(12).reshape(3, 4).astype(dtype)
    values = values / 12 if values.dtype.kind == "f" else values
    plain = as_exemplar(values.astype(values.dtype.newbyteorder("=")))
    for each in (values, np.ma.masked_array(values)):
        assert as_exemplar(each).sha256 == plain.sha256


def test_an_empty_name_is_said_to_be_empty():
    with pytest.raises(ImageError, match="The name of the image is empty"):
        as_exemplar("")


def test_equal_channels_become_gray_with_a_note():
    gray = np.random.default_rng(0).integers(0, 256, (5, 4, 1), dtype=np.uint8)
    made = as_exemplar(np.repeat(gray, 3, axis=2))
    assert made.channels == 1
    assert made.sha256 == as_exemplar(gray).sha256
    assert made.notes == ("The three channels are equal, so the image is used as gray.",)


@pytest.mark.parametrize(("background", "shown"), [(1.0, "white"), (0.0, "black"), (0.25, "gray 0.25")])
def test_alpha_is_laid_over_the_stated_background(background, shown):
    array = np.zeros((2, 2, 4), np.uint8)
    array[..., 0] = 200
    array[..., 3] = [[0, 51], [102, 255]]
    made = as_exemplar(array, background=background)
    alpha = array[..., 3:] / 255
    expected = array[..., :3] / 255 * alpha + background * (1 - alpha)
    assert np.abs(made.pixels - expected).max() < 1e-6
    assert made.pixels[1, 1, 0] == np.float32(200) / np.float32(255)
    assert made.notes == (f"Transparent pixels were laid over {shown}.",)


def test_opaque_alpha_changes_nothing():
    array = colour()
    opaque = np.concatenate([array, np.full((6, 8, 1), 255, np.uint8)], axis=2)
    made = as_exemplar(opaque)
    assert made.sha256 == as_exemplar(array).sha256
    assert made.notes == ("The alpha channel is opaque everywhere and was dropped.",)


def test_float_alpha():
    array = np.full((2, 2, 4), 0.5)
    array[0, 0, 0] = 1
    assert as_exemplar(array, background=0).pixels[0, 0].tolist() == [0.5, 0.25, 0.25]
    array[0, 0, 3] = np.nan
    with pytest.raises(ImageError, match="alpha channel has values that are not finite"):
        as_exemplar(array)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_values_that_are_not_finite_are_refused(bad, dtype):
    array = np.zeros((3, 4), dtype)
    array[1, 1] = bad
    with pytest.raises(ImageError, match=r"^array: 1 of 12 values are not finite \(NaN or infinite\)\.$"):
        as_exemplar(array)


@pytest.mark.parametrize(
    ("array", "says"),
    [
        (np.zeros((0, 5)), "array: the image is empty (5 x 0 pixels)."),
        (np.zeros((1, 1)), "array: an exemplar needs at least 2 x 2 pixels, got 1 x 1."),
        (np.zeros((1, 9)), "array: an exemplar needs at least 2 x 2 pixels, got 9 x 1."),
        (np.zeros(5), "array: the shape must be (H, W) or (H, W, 1, 3 or 4), got (5,)."),
        (np.zeros((4, 4, 2)), "array: the shape must be (H, W) or (H, W, 1, 3 or 4), got (4, 4, 2)."),
        (np.zeros((2, 4, 4, 3)), "array: the shape must be (H, W) or (H, W, 1, 3 or 4), got (2, 4, 4, 3)."),
        (np.zeros((4, 4), complex), "array: the values must be bools, integers or floats, got complex128."),
        (np.zeros((4, 4), object), "array: the values must be bools, integers or floats, got object."),
        (
            np.broadcast_to(np.uint8(0), (9000, 9000)),
            "array: the image has 9000 x 9000 pixels; at most 64 megapixels are read, as in 8192 x 8192; a scale "
            "or a crop makes a larger one fit.",
        ),
        (
            [[1, 2], [3, 4]],
            "An image must be an array, a path, the bytes of a file, an image input or gallery:NAME, got list.",
        ),
    ],
)
def test_unusable_arrays_get_one_sentence(array, says):
    with pytest.raises(ImageError) as caught:
        as_exemplar(array)
    assert str(caught.value) == says


@pytest.mark.parametrize("background", [-0.1, 1.1, math.nan])
def test_background_out_of_range(background):
    with pytest.raises(ImageError, match="background must be a gray level from 0 to 1"):
        as_exemplar(np.zeros((2, 2)), background=background)


@pytest.mark.parametrize("factor", [2, 4, 5])
def test_scaling_by_a_whole_factor_is_the_mean_of_blocks(factor):
    array = np.random.default_rng(1).random((5 * factor, 7 * factor, 3)).astype(np.float32)
    made = as_exemplar(array, scale=1 / factor)
    blocks = array.reshape(5, factor, 7, factor, 3).mean(axis=(1, 3), dtype=np.float64)
    assert made.pixels.shape == (5, 7, 3)
    assert np.abs(made.pixels - blocks).max() < 1e-6
    assert made.origin.scale == 1 / factor
    assert made.origin.pixels.shape == array.shape


@settings(deadline=None)
@given(st.integers(2, 30), st.integers(2, 30), st.floats(0.3, 1))
def test_scaling_keeps_the_range_and_a_constant(height, width, scale):
    if round(height * scale) < 2 or round(width * scale) < 2:
        return
    made = as_exemplar(np.full((height, width), 0.7, np.float32), scale=scale)
    assert made.size == (round(height * scale), round(width * scale))
    assert np.abs(made.pixels - np.float32(0.7)).max() < 1e-6


def test_the_crop_is_taken_from_the_scaled_source():
    array = np.random.default_rng(2).random((20, 30, 3)).astype(np.float32)
    crop = Crop(top=1, left=2, height=5, width=7)
    made = as_exemplar(array, scale=0.5, crop=crop)
    scaled = as_exemplar(array, scale=0.5)
    assert np.array_equal(made.pixels, scaled.pixels[1:6, 2:9])
    assert made.pixels.flags.c_contiguous
    assert (made.origin.scale, made.origin.crop) == (0.5, crop)
    assert np.array_equal(made.origin.pixels, array)


def test_an_image_input_is_taken_from_its_source_anew():
    array = np.random.default_rng(3).random((20, 30, 3)).astype(np.float32)
    first = as_exemplar(array, name="wall", scale=0.5, crop=Crop(0, 0, 4, 4))
    assert as_exemplar(first) is first
    again = as_exemplar(first, crop=Crop(10, 10, 8, 8))
    assert np.array_equal(again.pixels, array[10:18, 10:18])
    assert again.name == "wall"
    assert again.origin.pixels is first.origin.pixels
    renamed = as_exemplar(first, name="other")
    assert (renamed.name, renamed.sha256) == ("other", first.sha256)


@pytest.mark.parametrize(
    "crop",
    [
        Crop(-1, 0, 2, 2),
        Crop(0, -1, 2, 2),
        Crop(0, 0, 0, 2),
        Crop(0, 0, 2, 0),
        Crop(4, 0, 3, 2),
        Crop(0, 7, 2, 2),
        Crop(0, 0, 2.5, 2),
        Crop(0, 0, 2, 10**30),
    ],
)
def test_a_crop_that_does_not_lie_inside_is_refused(crop):
    with pytest.raises(ImageError, match="the crop must lie inside the scaled image of 8 x 6 pixels"):
        as_exemplar(colour(6, 8), crop=crop)


@pytest.mark.parametrize("scale", [0, -1, 1.5, math.nan, math.inf, True, "half"])
def test_a_scale_out_of_range_is_refused(scale):
    with pytest.raises(ImageError, match="the scale must be above 0 and at most 1"):
        as_exemplar(colour(), scale=scale)


def test_scaling_to_nothing_is_refused():
    with pytest.raises(ImageError, match="at least 2 x 2 pixels, got 1 x 1"):
        as_exemplar(colour(), scale=1e-6)
