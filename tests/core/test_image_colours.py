"""Colour profiles, gamma, ranges of floats and transparency, against computations in doubles."""

import io
import struct
import zlib
from pathlib import Path

import imagecodecs
import numpy as np
import pytest
import tifffile

from texlab_core.engine.inputs import Crop
from texlab_core.errors import ImageError
from texlab_core.images.exemplar import as_exemplar, depth_of, take
from texlab_core.images.formats.decoded import Decoded
from texlab_core.images.formats.profiles import MAX_PROFILE
from texlab_core.images.masks import as_mask
from texlab_core.images.unit_range import UnitRange

CASES = Path(__file__).parents[1] / "data" / "images"
D65 = (0.3127, 0.3290)
D50 = (0.3457, 0.3585)
SPACES = {
    "Adobe RGB": ((0.64, 0.33, 0.21, 0.71, 0.15, 0.06), D65, 2.2),
    "P3": ((0.680, 0.320, 0.265, 0.690, 0.150, 0.060), D65, 2.4),
    "Rec. 2020": ((0.708, 0.292, 0.170, 0.797, 0.131, 0.046), D65, 2.4),
    "ProPhoto": ((0.7347, 0.2653, 0.1596, 0.8404, 0.0366, 0.0001), D50, 1.8),
}


def fixed(data, place):
    return struct.unpack_from(">i", data, place)[0] / 65536


def tag(profile, name):
    for index in range(struct.unpack_from(">I", profile, 128)[0]):
        found, start, length = struct.unpack_from(">4sII", profile, 132 + 12 * index)
        if found == name:
            return profile[start : start + length]
    raise KeyError(name)


def curve(profile, name, values):
    """A tone curve of an ICC profile (ICC.1:2010, 10.5 and 10.15)."""
    data = tag(profile, name)
    if data[:4] == b"curv":
        (count,) = struct.unpack_from(">I", data, 8)
        assert count == 1
        return values ** (struct.unpack_from(">H", data, 12)[0] / 256)
    assert data[:4] == b"para"
    (kind,) = struct.unpack_from(">H", data, 8)
    numbers = [fixed(data, 12 + 4 * index) for index in range((1, 3, 4, 5)[kind])]
    if kind == 0:
        return values ** numbers[0]
    assert kind == 3
    gamma, a, b, c, d = numbers
    return np.where(values >= d, np.maximum(a * values + b, 0) ** gamma, c * values)


def matrix(profile):
    columns = [
        [fixed(tag(profile, name), 8 + 4 * row) for row in range(3)] for name in (b"rXYZ", b"gXYZ", b"bXYZ")
    ]
    return np.array(columns).T


def in_srgb(values, profile):
    """Values in [0, 1] by curves and matrices alone, in doubles, with the inverse of sRGB's curve."""
    srgb = imagecodecs.cms_profile("srgb")
    linear = np.stack(
        [curve(profile, name, values[..., i]) for i, name in enumerate((b"rTRC", b"gTRC", b"bTRC"))], -1
    )
    light = np.clip(linear @ matrix(profile).T @ np.linalg.inv(matrix(srgb)).T, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def colours(dtype):
    """Random colours, those on the sides of the cube, and grays."""
    rng = np.random.default_rng(0)
    peak = np.iinfo(dtype).max
    values = rng.integers(0, peak, (40, 40, 3), dtype=dtype, endpoint=True)
    values[:10, :, 0] = 0
    values[10:20, :, 1] = peak
    values[20:25] = values[20:25, :, :1]
    return values


def tiff(values, **options):
    out = io.BytesIO()
    tifffile.imwrite(out, values, photometric="rgb", metadata=None, **options)
    return out.getvalue()


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize(("dtype", "tolerance"), [(np.uint8, 1.0), (np.uint16, 0.3)])
def test_profiles_agree_with_doubles(space, dtype, tolerance):
    primaries, white, gamma = SPACES[space]
    profile = imagecodecs.cms_profile("rgb", whitepoint=(*white, 1.0), primaries=primaries, gamma=gamma)
    values = colours(dtype)
    right = in_srgb(values / np.iinfo(dtype).max, profile)
    made = as_exemplar(tiff(values, iccprofile=profile))
    assert 255 * np.abs(made.pixels - right).max() <= tolerance
    assert made.notes == ("Colours were converted to sRGB by the image's profile.",)
    assert made.depth == (8 if dtype == np.uint8 else 16)


@pytest.mark.parametrize("name", ["adobe8.png", "adobe16.png"])
def test_one_green_of_adobe_rgb(name):
    made = as_exemplar(CASES / name)
    assert np.abs(255 * made.pixels[0, 0, 0] - 1.0) < 0.3


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(values, *chunks):
    data = imagecodecs.png_encode(values)
    return data[:33] + b"".join(chunk(*each) for each in chunks) + data[33:]


def iccp(profile):
    return b"iCCP", b"name\0\0" + zlib.compress(profile)


ADOBE = imagecodecs.cms_profile("adobergb")
RGB = colours(np.uint8)


@pytest.mark.parametrize(
    ("body", "says"),
    [
        (b"name\0\0" + zlib.compress(bytes(MAX_PROFILE + 1)), "too large"),
        (b"name\0\0" + b"nonsense", "damaged"),
        (b"name", "damaged"),
        (b"name\0\0" + zlib.compress(ADOBE)[:-9], "damaged"),
    ],
)
def test_profiles_that_cannot_be_used_are_said_and_ignored(body, says):
    made = as_exemplar(png(RGB, (b"iCCP", body)))
    assert np.array_equal(np.rint(255 * made.pixels), RGB)
    assert made.notes == (f"The colour profile is {says} and was ignored.",)


def test_profiles_beyond_any_size_are_not_even_read():
    made = as_exemplar(png(RGB, (b"iCCP", bytes(MAX_PROFILE + 1))))
    assert made.notes == ("The colour profile is too large and was ignored.",)
    made = as_exemplar(tiff(RGB, iccprofile=ADOBE + bytes(MAX_PROFILE)))
    assert made.notes == ("The colour profile is too large and was ignored.",)


def gama(gamma):
    return b"gAMA", struct.pack(">I", round(gamma * 100_000))


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("gamma", [1.0, 0.5556])
def test_gamma_is_converted(dtype, gamma):
    values = colours(dtype)
    light = (values / np.iinfo(dtype).max) ** (1 / gamma)
    right = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-12) ** (1 / 2.4) - 0.055)
    made = as_exemplar(png(values, gama(gamma)))
    assert 255 * np.abs(made.pixels - right).max() < 0.05
    assert made.notes == (f"The file's gamma of {gamma:g} was converted to that of sRGB.",)
    alpha = np.full((*values.shape[:2], 1), 77, dtype)
    kept = as_exemplar(png(np.dstack([values, alpha]), gama(gamma)), alpha="keep")
    assert np.array_equal(kept.pixels, made.pixels)
    assert np.abs(kept.alpha - 77 / np.iinfo(dtype).max).max() < 1e-6


@pytest.mark.parametrize(
    ("chunks", "notes"),
    [
        ([gama(0.45455)], ()),
        ([gama(1.0), (b"sRGB", b"\0")], ()),
        ([gama(9.0)], ("The file's gamma of 9 is none of any device and was ignored.",)),
        (
            [(b"cHRM", struct.pack(">8I", 31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600)), gama(0.45455)],
            ("The file's primary colours are not those of sRGB; they were ignored.",),
        ),
    ],
)
def test_gamma_that_changes_nothing(chunks, notes):
    made = as_exemplar(png(RGB, *chunks))
    assert np.array_equal(np.rint(255 * made.pixels), RGB)
    assert made.notes == notes


def test_a_profile_counts_more_than_gamma():
    both = as_exemplar(png(RGB, gama(1.0), iccp(ADOBE)))
    assert both.sha256 == as_exemplar(png(RGB, iccp(ADOBE))).sha256


# Floats.


def spread(low, high, seed=0):
    values = np.random.default_rng(seed).uniform(low, high, (60, 50))
    values.flat[:2] = low, high
    return values


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(
    ("values", "peak", "says"),
    [
        (spread(0, 255), 255, "Values from 0 to 255 were read as 0 to 255."),
        (spread(3, 90), 255, "Values from 3 to 90 were read as 0 to 255."),
        (spread(0, 65535), 65535, "Values from 0 to 65535 were read as 0 to 65535."),
        (spread(0, 1.5)[:40] / 1.5 * 1.04, 1, "Values from 0 to 1.04 were read as 0 to 1; {outside} outside were"),
        (spread(-0.02, 1), 1, "Values from -0.02 to 1 were read as 0 to 1; {outside} outside were clipped."),
        (
            np.where(np.arange(3000).reshape(60, 50) == 77, 40, spread(0, 1)),
            1,
            "to 40 were read as 0 to 1; 1 outside",
        ),
        (
            np.where(np.arange(3000).reshape(60, 50) == 77, 4e9, spread(0, 255)),
            255,
            "were read as 0 to 255; 1 outside",
        ),
    ],
)
def test_floats_are_read_by_their_range(values, peak, says, dtype):
    made = as_exemplar(values.astype(dtype))
    assert np.abs(made.pixels[..., 0] - np.clip(values / peak, 0, 1)).max() < 1e-6
    outside = np.count_nonzero((values.astype(dtype) < 0) | (values.astype(dtype) > peak))
    assert says.format(outside=outside) in made.notes[0]


@pytest.mark.parametrize("values", [spread(-1, 3), spread(0, 12), spread(1e5, 1e6), spread(-300, -200)])
def test_other_floats_are_mapped_by_percentiles(values):
    made = as_exemplar(values)
    low, high = (np.percentile(values, share, method=way) for share, way in ((0.5, "lower"), (99.5, "higher")))
    assert np.abs(made.pixels[..., 0] - np.clip((values - low) / (high - low), 0, 1)).max() < 1e-6
    assert "(0.5 and 99.5 percentiles) were mapped to 0 to 1, and the others clipped." in made.notes[0]


@pytest.mark.parametrize(
    ("name", "peak"), [("t_float_0_255.tif", 255), ("t_float_hdr.tif", 1), ("t_float_slightly_out.tif", 1)]
)
def test_float_files(name, peak):
    stored = tifffile.imread(CASES / name).astype(np.float64)
    made = as_exemplar(CASES / name)
    assert np.abs(made.pixels - np.clip(stored / peak, 0, 1)).max() < 1e-6
    assert f"were read as 0 to {peak}" in made.notes[0]


@pytest.mark.parametrize(
    ("values", "depth"),
    [
        (RGB / 255, 8),
        ((RGB / np.float32(255)).astype(np.float32), 8),
        (colours(np.uint16) / 65535, 16),
        (spread(0, 1), "float"),
        (RGB.astype(float), "float"),
        (RGB, 8),
        (colours(np.uint16), 16),
    ],
)
def test_depth_of_arrays(values, depth):
    assert as_exemplar(values).depth == depth
    if values.dtype.kind == "f":
        assert depth_of(values) == depth


# Transparency.

ALPHA = np.random.default_rng(1).integers(0, 256, (40, 40, 1), dtype=np.uint8)
RGBA = np.dstack([RGB, ALPHA])


def test_alpha_can_be_ignored_or_kept():
    ignored, kept = (as_exemplar(RGBA, alpha=way) for way in ("ignore", "keep"))
    assert np.array_equal(np.rint(255 * ignored.pixels), RGB)
    assert ignored.alpha is None
    assert ignored.notes == ("The alpha channel was ignored.",)
    assert kept.sha256 == ignored.sha256
    assert np.array_equal(np.rint(255 * kept.alpha), ALPHA)
    assert not kept.alpha.flags.writeable
    part = as_exemplar(kept, crop=Crop(3, 4, 10, 12))
    assert np.array_equal(part.alpha, kept.alpha[3:13, 4:16])
    half = as_exemplar(kept, scale=0.5)
    blocks = kept.alpha.reshape(20, 2, 20, 2).mean(axis=(1, 3))
    assert np.abs(half.alpha[..., 0] - blocks).max() < 1e-6
    assert as_exemplar(half, crop=Crop(0, 0, 8, 8)).alpha.shape == (8, 8, 1)


def test_colours_multiplied_by_alpha_are_divided_again():
    values = np.full((4, 4, 4), 64, np.uint8)
    values[..., 3] = 128
    values[0, 0] = [0, 0, 0, 0]
    values[0, 1] = [10, 20, 30, 255]
    data = tiff(values, extrasamples=["assocalpha"])
    for way in ("ignore", "keep"):
        made = as_exemplar(data, alpha=way)
        assert np.abs(made.pixels[1, 1] - 0.5).max() < 0.003
        assert made.pixels[0, 0].tolist() == [0, 0, 0]
        assert np.rint(255 * made.pixels[0, 1]).tolist() == [10, 20, 30]


def test_nearly_opaque_is_opaque():
    values = RGBA.copy()
    values[..., 3] = 254
    made = as_exemplar(values, background=0.0)
    assert np.array_equal(np.rint(255 * made.pixels), RGB)
    assert made.notes == ("The alpha channel is opaque everywhere (at least 254 of 255) and was dropped.",)
    values[0, 0, 3] = 253
    assert as_exemplar(values).notes == ("Transparent pixels were laid over white.",)


def test_float_alpha_follows_the_range_of_the_colours():
    values = RGBA.astype(np.float32)
    kept = as_exemplar(values, alpha="keep")
    assert np.abs(kept.alpha - ALPHA / 255).max() < 1e-6
    assert np.abs(kept.pixels - RGB / 255).max() < 1e-6
    values[..., 3] /= 255
    assert np.abs(as_exemplar(values, alpha="keep").alpha - ALPHA / 255).max() < 1e-6


def test_unknown_use_of_alpha():
    with pytest.raises(ImageError, match="use of alpha must be background, ignore or keep, got 'drop'"):
        as_exemplar(RGBA, alpha="drop")


# The promise.


@pytest.mark.parametrize("bad", [-0.1, 1.1, np.nan, np.inf])
def test_the_door_refuses_what_is_out_of_range(bad):
    pixels = np.full((4, 4, 3), 0.5, np.float32)
    pixels[2, 2, 1] = bad
    with pytest.raises(ImageError, match=r"^a: was read with values outside 0 to 1, and is refused\.$"):
        take(pixels, "a")


def test_integers_beyond_their_peak_are_refused():
    with pytest.raises(ImageError, match=r"^a: has the value 300, and at most 255 was expected\.$"):
        UnitRange(Decoded(np.full((2, 2, 1), 300, np.uint16), 255), "a", 1.0, "background")


# Masks.


def test_a_jpeg_mask_marks_what_its_original_does():
    right, found = (as_mask(CASES / name) for name in ("ell.png", "ell75.jpg"))
    assert set(np.unique(found.pixels)) == {0.0, 1.0}
    assert 0.1 < right.pixels.mean() < 0.2
    # Some pixels of the edge differ, and none elsewhere.
    assert np.count_nonzero(right.pixels != found.pixels) < 25
    anything = as_mask(CASES / "ell75.jpg", threshold=0)
    assert anything.pixels.sum() > 1.2 * found.pixels.sum()
    assert (
        found.notes[-1]
        == f"The mask ell75.jpg marks what is brighter than 0.5: {100 * found.pixels.mean():.3g} %."
    )


def test_masks_of_colours_and_alpha():
    values = np.zeros((4, 4, 4), np.uint8)
    values[0, 0] = [0, 0, 200, 255]
    values[1, 1] = [255, 255, 255, 60]
    values[2, 2] = [255, 255, 255, 255]
    assert np.argwhere(as_mask(values).pixels[..., 0]).tolist() == [[0, 0], [2, 2]]
    with pytest.raises(ImageError, match="threshold of a mask must be at least 0 and below 1, got 1"):
        as_mask(values, threshold=1)
