"""OpenEXR: what is written holds the light of the picture; what is read is that light, whoever wrote it."""

from __future__ import annotations

import itertools
import struct
import zlib

import numpy as np
import pytest

from texlab_core.errors import ImageError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.writing import encode_image, write_image

RNG = np.random.default_rng(20)


def light_of(srgb):
    """IEC 61966-2-1, value by value."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def srgb_of(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def exr(planes, *, half=False, compression=0, version=2, top=0, sampling=1, order=1):
    """A file by hand from the description of the format: {name: (H, W)}, every line a block, no block deflated."""
    height, width = next(iter(planes.values())).shape
    kind = 1 if half else 2
    names = sorted(planes)
    channels = b"".join(n.encode() + b"\0" + struct.pack("<iB3xii", kind, 0, sampling, sampling) for n in names)
    head = b"\x76\x2f\x31\x01" + struct.pack("<i", version)
    head += attribute("channels", "chlist", channels + b"\0")
    head += attribute("compression", "compression", bytes([compression]))
    head += attribute("dataWindow", "box2i", struct.pack("<4i", 3, top, 2 + width, top + height - 1)) + b"\0"
    dtype = "<f2" if half else "<f4"
    blocks = []
    for row in range(height):
        data = b"".join(planes[name][row].astype(dtype).tobytes() for name in names)
        if compression == 2:
            halves = data[::2] + data[1::2]
            steps = bytes([halves[0], *((b - a + 128) % 256 for a, b in itertools.pairwise(halves))])
            data = zlib.compress(steps)
        blocks.append(struct.pack("<ii", top + row, len(data)) + data)
    at, offsets = len(head) + 8 * height, []
    for block in blocks:
        offsets.append(at)
        at += len(block)
    return head + struct.pack(f"<{height}Q", *offsets[::order]) + b"".join(blocks)


@pytest.mark.parametrize("shape", [(37, 21), (16, 9, 1), (33, 5, 3), (2, 2, 3)])
def test_a_picture_comes_back(tmp_path, shape):
    pixels = RNG.random(shape, np.float32)
    write_image(tmp_path / "a.exr", pixels, bits="float")
    found = as_exemplar(tmp_path / "a.exr")
    assert found.depth == "float"
    np.testing.assert_allclose(found.pixels.reshape(shape), pixels, atol=3e-7)


def test_the_file_holds_light_in_the_stated_order():
    pixels = RNG.random((3, 4, 3), np.float32)
    # Noise of so few pixels is not made shorter by deflate: the block is stored as it is.
    file = encode_image("a.exr", pixels, bits="float")
    lines = np.frombuffer(file[-3 * 4 * 3 * 4 :], "<f4").reshape(3, 3, 4)
    np.testing.assert_allclose(lines, light_of(pixels.astype(np.float64)).transpose(0, 2, 1)[:, ::-1], rtol=1e-5)


def test_transparency_is_multiplied_and_comes_back(tmp_path):
    pixels, alpha = RNG.random((5, 4, 3), np.float32), RNG.random((5, 4), np.float32) / 2 + 0.5
    file = encode_image("a.exr", pixels, bits="float", alpha=alpha)
    planes = np.frombuffer(file[-5 * 4 * 4 * 4 :], "<f4").reshape(5, 4, 4)
    np.testing.assert_allclose(planes[:, 0], alpha, rtol=1e-6)
    np.testing.assert_allclose(planes[:, 3], light_of(pixels[..., 0].astype(np.float64)) * alpha, rtol=1e-5)


@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize("compression", [0, 2])
@pytest.mark.parametrize("order", [1, -1])
def test_files_of_others_are_read(half, compression, order):
    light = RNG.random((6, 5, 3))
    planes = {name: light[..., k] for k, name in enumerate("RGB")} | {"Z": light[..., 0] * 9}
    found = as_exemplar(exr(planes, half=half, compression=compression, top=-7, order=order))
    np.testing.assert_allclose(found.pixels, srgb_of(light), atol=1e-3 if half else 1e-6)
    gray = as_exemplar(exr({"Y": light[..., 0]}, half=half, compression=compression))
    np.testing.assert_allclose(gray.pixels[..., 0], srgb_of(light[..., 0]), atol=1e-3 if half else 1e-6)
    assert gray.channels == 1


PLANE = {"Y": np.full((4, 4), 0.25)}


@pytest.mark.parametrize(
    ("file", "says"),
    [
        (exr(PLANE, compression=4), "compressed by PIZ; TexLab reads NONE, ZIPS, ZIP"),
        (exr(PLANE, compression=77), "compressed by 77"),
        (exr(PLANE, version=0x202), "with tiles"),
        (exr(PLANE, version=0x1002), "with several parts"),
        (exr({"Z": PLANE["Y"]}), "an OpenEXR image of Z; TexLab reads R, G and B, or Y"),
        (exr(PLANE, sampling=2), "reduced colours"),
        (exr({"Y": np.full((4, 4), np.nan)}), "not finite"),
    ],
)
def test_what_is_not_read_is_named(file, says):
    with pytest.raises(ImageError, match=says):
        as_exemplar(file)


def test_a_broken_file_is_refused_wherever_it_is_broken():
    file = exr(PLANE, compression=2)
    for length in range(4, len(file) - 1, 3):
        with pytest.raises(ImageError):
            as_exemplar(file[:length])
    # Bytes that are wrong give a picture or a sentence, never anything else.
    for place in range(4, len(file), 5):
        changed = bytearray(file)
        changed[place] ^= 0xFF
        try:
            found = as_exemplar(bytes(changed))
        except ImageError:
            continue
        assert np.isfinite(found.pixels).all()
