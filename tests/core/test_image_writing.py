"""Writing images: correct rounding, other programs read the same values, whole or not at all."""

import io
import os
import struct
import zlib

import numpy as np
import pytest
import tifffile
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from PIL import Image

from texlab_core.errors import ImageError, InputError
from texlab_core.files.whole import write_whole
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.png_text import read_text, with_text
from texlab_core.images.formats.writing import encode_png, quantize, write_image

NOISE = np.random.default_rng(0).random((9, 7, 3)).astype(np.float32)


@pytest.mark.parametrize("peak", [255, 65535])
def test_every_level_survives_and_halves_go_to_the_nearest(peak):
    levels = np.arange(peak + 1, dtype=np.float64)
    assert np.array_equal(quantize((levels / peak).astype(np.float32), peak), levels)
    between = (levels[:-1, None] + [0.499, 0.501]) / peak
    assert np.array_equal(quantize(between, peak), levels[:-1, None] + [0, 1])
    assert quantize(np.array([-3.0, 4.0]), peak).tolist() == [0, peak]


@settings(deadline=None, max_examples=50)
@given(
    hnp.arrays(
        st.sampled_from([np.uint8, np.uint16]),
        st.one_of(
            st.tuples(st.integers(1, 9), st.integers(1, 9)),
            st.tuples(st.integers(1, 9), st.integers(1, 9), st.sampled_from([1, 3])),
        ),
    )
)
def test_png_holds_the_values_for_other_readers(values):
    import cv2

    data = encode_png(values, {"key": "text"})
    read = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    expected = values[..., 0] if values.shape[2:] == (1,) else values[..., ::-1] if values.ndim == 3 else values
    assert read.dtype == values.dtype
    assert np.array_equal(read, expected)
    assert Image.open(io.BytesIO(data)).text == {"key": "text"}


@pytest.mark.parametrize("suffix", [".png", ".PNG", ".tif", ".tiff"])
@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("channels", [0, 1, 3])
def test_integers_come_back_as_they_were(tmp_path, suffix, bits, channels):
    peak = 2**bits - 1
    shape = (6, 5, channels) if channels else (6, 5)
    values = np.random.default_rng(1).integers(0, peak, shape, endpoint=True)
    pixels = (values / peak).astype(np.float32)
    path = tmp_path / f"out{suffix}"
    write_image(path, pixels, bits=bits)
    assert np.array_equal(as_exemplar(path).pixels, pixels.reshape(6, 5, -1))


@pytest.mark.parametrize("channels", [1, 3])
def test_float_tiff_is_exact(tmp_path, channels):
    path = tmp_path / "out.tif"
    write_image(path, NOISE[..., :channels], bits="float", text={"any": "what it is"})
    assert np.array_equal(as_exemplar(path).pixels, NOISE[..., :channels])
    with tifffile.TiffFile(path) as tiff:
        assert tiff.pages[0].dtype == np.float32
        assert tiff.pages[0].description == "TexLab what it is"


def test_jpeg_is_close(tmp_path):
    ramp = np.add.outer(np.arange(32), np.arange(24)) / 54
    pixels = np.stack([ramp, 1 - ramp, ramp / 2], axis=2)
    for name in ("a.jpg", "a.JPEG"):
        write_image(tmp_path / name, pixels)
        assert np.abs(as_exemplar(tmp_path / name).pixels - pixels).max() < 0.03
        assert (tmp_path / name).read_bytes().startswith(b"\xff\xd8\xff")


ALL = ".png, .tif, .tiff, .webp, .jpg, .jpeg, .avif, .jxl, .exr"


@pytest.mark.parametrize(
    ("name", "pixels", "options", "says"),
    [
        ("a.gif", NOISE, {}, f"a.gif: images are written as {ALL}, got '.gif'."),
        ("a", NOISE, {}, f"a: images are written as {ALL}, got ''."),
        (
            "a.exr",
            NOISE,
            {},
            "a.exr: the bits of a .exr file must be float, got 8.",
        ),
        ("a.png", NOISE, {"bits": "float"}, "a.png: the bits of a .png file must be 8 or 16, got 'float'."),
        ("a.jpg", NOISE, {"bits": 16}, "a.jpg: the bits of a .jpg file must be 8, got 16."),
        ("a.tif", NOISE, {"bits": 12}, "a.tif: the bits of a .tif file must be 8 or 16 or float, got 12."),
        ("a.png", NOISE * np.nan, {}, "a.png: the image has values that are not finite, and cannot be written."),
        (
            "a.png",
            NOISE[..., :2],
            {},
            "a.png: an image to write is (H, W), (H, W, 1) or (H, W, 3) of floats, got (9, 7, 2).",
        ),
    ],
)
def test_what_cannot_be_written(tmp_path, monkeypatch, name, pixels, options, says):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ImageError) as caught:
        write_image(name, pixels, **options)
    assert str(caught.value) == says
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "pixels", [np.zeros((3, 3), np.uint8), np.zeros((0, 3)), np.zeros(3), np.zeros((2, 2, 3, 1))]
)
def test_only_images_of_floats_are_written(tmp_path, pixels):
    with pytest.raises(ImageError, match="an image to write is"):
        write_image(tmp_path / "a.png", pixels)


def test_texts_that_a_format_does_not_hold_are_a_programming_error(tmp_path):
    for name, text in (
        ("a.jpg", {"": "b"}),
        ("a.webp", {"": "b"}),
        ("a.tif", {"a": "b", "c": "d"}),
        ("a.png", {"": "b"}),
    ):
        with pytest.raises(ValueError, match="text"):
            write_image(tmp_path / name, NOISE, text=text)


# Whole or not at all


def test_a_failed_write_leaves_what_was_there(tmp_path, monkeypatch):
    path = tmp_path / "a.png"
    write_image(path, NOISE)
    before = path.read_bytes()

    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(InputError, match=r"a\.png: cannot be written \(No space left on device\)\.$"):
        write_image(path, NOISE / 2)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_places_that_cannot_be_written(tmp_path):
    with pytest.raises(InputError, match=r"cannot be written \(No such file or directory\)"):
        write_whole(tmp_path / "missing" / "a.txt", b"")
    with pytest.raises(InputError, match=r"cannot be written \(it is a folder\)"):
        write_whole(tmp_path, b"")
    with pytest.raises(InputError, match="cannot be written"):
        write_whole("nul\0l", b"")


def test_a_link_keeps_pointing_to_its_file(tmp_path):
    (tmp_path / "file").write_bytes(b"old")
    (tmp_path / "link").symlink_to(tmp_path / "file")
    write_whole(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_bytes() == b"new"


# Text chunks


@settings(deadline=None)
@given(st.text(st.characters(codec="utf-8"), max_size=60))
def test_any_text_comes_back(text):
    if "\0" in text:
        return
    data = with_text(encode_png(np.zeros((2, 2), np.uint8)), {"other": "x", "key": text})
    assert read_text(io.BytesIO(data), "key", 1000) == text
    assert read_text(io.BytesIO(data), "nothing", 1000) is None


def chunked(kind, body):
    base = encode_png(np.zeros((2, 2), np.uint8))
    chunk = struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return io.BytesIO(base[:33] + chunk + base[33:])


def test_compressed_texts_of_other_programs_are_read():
    packed = zlib.compress("wörds".encode("latin-1"))
    assert read_text(chunked(b"zTXt", b"key\0\0" + packed), "key", 1000) == "wörds"
    packed = zlib.compress("wörds λ".encode())
    assert read_text(chunked(b"iTXt", b"key\0\1\0en\0k\0" + packed), "key", 1000) == "wörds λ"


@pytest.mark.parametrize(
    ("kind", "body", "says"),
    [
        (b"tEXt", b"key\0" + bytes(2000), "longer than 1000"),
        (b"zTXt", b"key\0\0" + zlib.compress(bytes(10**7), 9)[:1000], "longer than 1000"),
        (b"zTXt", b"key\0\0" + zlib.compress(bytes(500))[:-5], "damaged"),
        (b"zTXt", b"key\0\0junk", "damaged"),
        (b"zTXt", b"key\0", "damaged"),
        (b"iTXt", b"key\0", "damaged"),
        (b"iTXt", b"key\0\0\0no end", "damaged"),
        (b"iTXt", b"key\0\0\0\0\0\xff\xfe", "damaged"),
    ],
)
def test_hostile_texts(kind, body, says):
    with pytest.raises(ValueError, match=says):
        read_text(chunked(kind, body), "key", 1000)


def test_a_changed_text_is_noticed():
    data = with_text(encode_png(np.zeros((2, 2), np.uint8)), {"key": "value"}).replace(b"value", b"vague")
    with pytest.raises(ValueError, match="damaged"):
        read_text(io.BytesIO(data), "key", 1000)
