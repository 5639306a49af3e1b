"""Small files that would take minutes or gigabytes: refused by their headers, or decoded where it can be ended."""

import io
import os
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image

from texlab_core.errors import Cancelled, ImageError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats import apart, decoded, headers, jpeg
from texlab_core.images.formats.decoded import Gate, HeavyError
from texlab_core.images.formats.reading import read_image

CASES = Path(__file__).parents[1] / "data" / "images"
RGB = np.random.default_rng(0).integers(0, 256, (48, 40, 3), dtype=np.uint8)
FLAT = np.zeros((64, 80, 3), np.uint8)
NEVER_LIGHT = 0


def tiff_around(stream, compression, shape=(16, 16, 3)):
    """A TIFF of one strip that holds this stream, whatever is in it."""
    out = io.BytesIO()
    colours = "ycbcr" if compression == "jpeg" else "rgb"
    options = {"photometric": colours, "metadata": None, "rowsperstrip": shape[0]}
    tifffile.imwrite(out, iter([stream]), shape=shape, dtype=np.uint8, compression=compression, **options)
    return out.getvalue()


ENCODERS = {
    "jpeg2000": lambda values: imagecodecs.jpeg2k_encode(values, reversible=True),
    "jpegxl": lambda values: imagecodecs.jpegxl_encode(values, lossless=True),
    "webp": lambda values: imagecodecs.webp_encode(values, lossless=True),
    "png": imagecodecs.png_encode,
    "jpeg": lambda values: imagecodecs.jpeg8_encode(values, level=95),
}
HEADERS = {
    "jpeg2000": headers.jpeg2000_header,
    "jpegxl": headers.jpegxl_header,
    "webp": headers.webp_header,
    "png": headers.png_header,
    "jpeg": headers.jpeg_header,
}


@pytest.mark.parametrize("size", [(1, 1), (8, 8), (17, 300), (256, 256), (1000, 3), (600, 450)])
@pytest.mark.parametrize("kind", ENCODERS)
def test_headers_state_the_size_that_the_encoder_was_given(kind, size):
    header = HEADERS[kind](ENCODERS[kind](np.zeros((*size, 3), np.uint8)))
    assert (header.height, header.width) == size


@pytest.mark.parametrize("size", [(16, 16), (17, 300), (600, 450)])
def test_avif_and_qoi_headers(size):
    values = np.zeros((*size, 3), np.uint8)
    header = headers.avif_header(imagecodecs.avif_encode(values))
    assert (header.height, header.width) == size
    header = headers.qoi_header(imagecodecs.qoi_encode(values))
    assert (header.height, header.width) == size


@pytest.mark.parametrize("bits", [8, 10, 12, 16])
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_depth_of_jpeg_xl(bits, channels):
    values = np.zeros((17, 30, channels), np.uint8 if bits == 8 else np.uint16)
    stream = imagecodecs.jpegxl_encode(values[..., 0] if channels == 1 else values, bitspersample=bits)
    assert headers.jpegxl_header(stream).bits == bits


@pytest.mark.parametrize("kind", HEADERS)
def test_headers_that_are_cut_off(kind):
    stream = ENCODERS[kind](FLAT)
    for length in (0, 1, 4, 10):
        with pytest.raises((ValueError, struct.error)):
            HEADERS[kind](stream[:length])


def test_boxes_without_an_end():
    assert list(headers.boxes(b"\0\0\0\0abcdrest")) == [(b"abcd", b"rest")]
    assert list(headers.boxes(b"\0\0\0\x02abcdrest")) == []
    assert list(headers.boxes(b"\0\0\0\x01abcd" + struct.pack(">Q", 18) + b"xy")) == [(b"abcd", b"xy")]
    assert list(headers.boxes(b"abc")) == []


@pytest.mark.parametrize("kind", ENCODERS)
def test_a_tiff_with_another_size_inside_is_refused_before_decoding(kind, monkeypatch):
    stream = ENCODERS[kind](FLAT)
    smooth = np.add.outer(np.arange(16), 2 * np.arange(16))[..., None].astype(np.uint8) * np.uint8([1, 3, 5])
    right = as_exemplar(tiff_around(ENCODERS[kind](smooth), kind))
    assert np.abs(np.rint(right.pixels * 255) - smooth).mean() < (6 if kind == "jpeg" else 1e-6)
    monkeypatch.setattr(tifffile.TiffPage, "asarray", lambda *_, **__: pytest.fail("was decoded"))
    with pytest.raises(ImageError, match=r"is a TIFF whose parts of 16 x 16 pixels hold 80 x 64 pixels\.$"):
        as_exemplar(tiff_around(stream, kind))


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("tif_j2k_siz_100000.tif", "hold 100000 x 100000 pixels"),
        ("tif_jpeg2k_inner_20000.tif", "hold 20000 x 20000 pixels"),
        ("tif_jpegxl_inner_20000.tif", "hold 20000 x 20000 pixels"),
        ("webp_64MP.webp", "8192 x 8192 pixels in a file of 2628 bytes hold nothing but flat areas"),
    ],
)
def test_costly_files(name, says, monkeypatch):
    monkeypatch.setattr(subprocess, "Popen", lambda *_, **__: pytest.fail("was decoded"))
    with pytest.raises(ImageError, match=says):
        as_exemplar(CASES / name)


def gif_of_many_blocks(count):
    out = io.BytesIO()
    Image.fromarray(RGB[..., 0]).save(out, "GIF")
    data = out.getvalue()
    return data[:-1] + b"!\xfe" + b"\x01a" * count + b"\0" + data[-1:]


def test_blocks_of_a_gif_are_not_counted_without_end(monkeypatch):
    assert "frames" not in "".join(as_exemplar(gif_of_many_blocks(100)).notes)
    monkeypatch.setattr("texlab_core.images.formats.older._MAX_GIF_BLOCKS", 50)
    assert "The file has 1 frames or more; the first one was used." in as_exemplar(gif_of_many_blocks(100)).notes


def test_chunks_of_a_png_are_not_counted_without_end(monkeypatch):
    data = small_png()
    many = data[:33] + chunk(b"teXt", b"") * 100 + data[33:]
    assert as_exemplar(many).size == (48, 40)
    monkeypatch.setattr("texlab_core.images.formats.png._MAX_CHUNKS", 50)
    with pytest.raises(ImageError, match="it has no image data"):
        as_exemplar(many)


def test_pages_of_a_tiff_are_not_looked_at_without_end(monkeypatch):
    out = io.BytesIO()
    with tifffile.TiffWriter(out) as writer:
        for side in range(4, 24):
            writer.write(np.full((side, side), side, np.uint8), photometric="minisblack", metadata=None)
    assert as_exemplar(out.getvalue()).size == (23, 23)
    monkeypatch.setattr("texlab_core.images.formats.tiff_pages._MAX_ENTRIES", 100)
    assert as_exemplar(out.getvalue()).size[0] < 15


def test_parts_that_lie_on_each_other_are_refused():
    data = bytearray(tiff_around(bytes(768), None))
    with tifffile.TiffFile(io.BytesIO(bytes(data))) as tiff:
        place = tiff.pages[0].tags["StripByteCounts"]
    data[place.valueoffset : place.valueoffset + 4] = struct.pack("<I", 2**30)
    with pytest.raises(ImageError, match="is a TIFF whose parts are larger than the file that holds them"):
        as_exemplar(bytes(data))


def test_compressions_without_a_known_header_are_refused():
    data = tiff_around(imagecodecs.jpegxr_encode(RGB[:16, :16]), "jpegxr")
    with pytest.raises(ImageError, match=r"is a TIFF compressed by JPEGXR\w*, which TexLab does not read"):
        as_exemplar(data)


@pytest.mark.parametrize("kind", ["zlib", "lzw", "zstd", "lzma", "packbits"])
def test_streams_that_go_on_give_no_more_than_their_place(kind):
    encode = {"lzw": imagecodecs.lzw_encode, "packbits": imagecodecs.packbits_encode}.get(kind)
    encode = encode or getattr(imagecodecs, f"{kind}_encode")
    try:
        size = as_exemplar(tiff_around(encode(bytes(range(200)) * 50_000), kind)).size
    except ImageError:
        # Some decoders refuse what is left over.
        size = None
    assert size in (None, (16, 16))


def progressive(scans):
    """A progressive JPEG whose last scan comes again and again."""
    out = io.BytesIO()
    Image.fromarray(RGB).save(out, "JPEG", progressive=True, quality=90)
    data = out.getvalue()
    last = data.rindex(b"\xff\xda")
    return data[:-2] + data[last:-2] * (scans - headers.jpeg_header(data).scans) + b"\xff\xd9"


def test_scans_are_counted_and_limited():
    assert headers.jpeg_header(progressive(30)).scans == 30
    assert as_exemplar(progressive(jpeg.MAX_SCANS)).size == (48, 40)
    with pytest.raises(ImageError, match="is a JPEG of 65 scans over 40 x 48 pixels; at most 64 scans, and"):
        as_exemplar(progressive(jpeg.MAX_SCANS + 1))
    with pytest.raises(ImageError, match="is a JPEG of 200 scans over 40 x 48"):
        as_exemplar(tiff_around(progressive(200), "jpeg", (48, 40, 3)))
    jpeg.check_scans(10, 8192, 8192, "a")
    with pytest.raises(ImageError, match="1024 megapixels in all of them"):
        jpeg.check_scans(20, 8192, 8192, "a")


def test_markers_without_end_are_no_jpeg():
    with pytest.raises(ImageError, match="more than 20000 markers"):
        as_exemplar(b"\xff\xd8\xff\xe0\0\x04ab" + b"\xff\xfe\0\x02" * 30_000)


def numbers_by_hand(text):
    lines = [line.split("#")[0] for line in text.decode().splitlines()]
    return [int(word) for word in " ".join(lines).split()]


@pytest.mark.parametrize("block", [7, 50, 2**20])
def test_plain_numbers_are_read_in_blocks(block, monkeypatch):
    monkeypatch.setattr("texlab_core.images.formats.pnm._BLOCK", block)
    rng = np.random.default_rng(1)
    words = [str(each) for each in rng.integers(0, 1001, 60)]
    words[3], words[40] = "0007", "00000999"
    spaces = rng.choice([" ", "\n", "\t ", "\r\n", " # 12 13\n", "\n#\n"], 60)
    body = "".join(word + space for word, space in zip(words, spaces, strict=True)).encode()
    made = read_image(b"P2 10 6 1000\n" + body, "a")
    assert made.values.ravel().tolist() == numbers_by_hand(body)
    bits = rng.integers(0, 2, 60)
    text = b"".join(b"%d" % bit + (b" # 1\n" if index % 11 == 0 else b"") for index, bit in enumerate(bits))
    assert (1 - read_image(b"P1 10 6\n" + text, "a").values.ravel()).tolist() == bits.tolist()


@pytest.mark.parametrize("text", [b"P2 2 2 9 1 2 3 1234567890", b"P2 2 2 9 1 2 3 4.5", b"P1 2 2 0 1 2 0"])
def test_plain_text_that_is_no_number(text):
    with pytest.raises(ImageError, match="truncated or damaged"):
        as_exemplar(text)


def test_a_plain_file_shorter_than_its_picture_is_not_begun():
    with pytest.raises(ImageError, match="12000000 bytes expected, 3 found"):
        as_exemplar(b"P3 2000 2000 255\n1 2")


def test_a_long_comment_in_the_header():
    made = as_exemplar(CASES / "n_longcomment.pgm")
    assert made.size == (13, 21)
    with pytest.raises(ImageError, match="header of the image is damaged"):
        as_exemplar(b"P5 #" + b"x" * 3_000_000)


# What is decoded in a process of its own.


@pytest.fixture
def always_apart(monkeypatch):
    monkeypatch.setattr(decoded, "LIGHT_PIXELS", NEVER_LIGHT)


SAVED = {
    "PNG": {},
    "JPEG": {"quality": 97},
    "WEBP": {"lossless": True},
    "TIFF": {},
    "BMP": {},
    "GIF": {},
    "TGA": {},
}


@pytest.mark.parametrize("kind", SAVED)
def test_another_process_decodes_the_same(kind, monkeypatch, tmp_path):
    out = io.BytesIO()
    Image.fromarray(RGB).save(out, kind, **SAVED[kind])
    here = as_exemplar(out.getvalue())
    monkeypatch.setattr(decoded, "LIGHT_PIXELS", NEVER_LIGHT)
    path = tmp_path / "a.bin"
    path.write_bytes(out.getvalue())
    there = as_exemplar(path)
    assert (there.sha256, there.notes, there.depth) == (here.sha256, here.notes, here.depth)
    if kind == "PNG":
        assert as_exemplar(out.getvalue()).sha256 == here.sha256


def test_another_process_refuses_in_the_same_words(always_apart, tmp_path):
    path = tmp_path / "a.png"
    out = io.BytesIO()
    Image.fromarray(RGB).save(out, "PNG")
    path.write_bytes(out.getvalue()[:-30])
    with pytest.raises(ImageError, match=r"a\.png: the image is truncated or damaged \("):
        as_exemplar(path)


def children():
    own = str(os.getpid())
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if fields[1] == own and fields[0] != "Z":
            found.append(stat.parent.name)
    return found


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
def test_a_cancel_ends_the_process_at_once(always_apart, monkeypatch):
    # A decoder that would go on for an hour.
    sleeper = "import time; time.sleep(3600) #{module}"
    monkeypatch.setattr(apart, "_START", sleeper)
    before = children()
    asked = []

    def stop():
        asked.append(True)
        return len(asked) > 3

    with pytest.raises(Cancelled):
        as_exemplar(small_png(), should_stop=stop)
    assert len(asked) == 4
    assert children() == before


def small_png():
    out = io.BytesIO()
    Image.fromarray(RGB).save(out, "PNG")
    return out.getvalue()


def test_time_is_limited(monkeypatch):
    monkeypatch.setattr(apart, "_START", "import time; time.sleep(3600) #{module}")
    with open(CASES / "ell.png", "rb") as file, pytest.raises(ImageError, match=r"took more than 0 s to decode"):
        apart.decode_apart(file, Gate("a", 1), HeavyError(2**30, 0.0))


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory differ")
def test_memory_is_limited():
    # 96 megabytes of pixels, with room for the libraries alone.
    data = imagecodecs.png_encode(np.full((4000, 8000, 3), 7, np.uint8), level=1)
    with open_temporary(data) as file, pytest.raises(ImageError) as caught:
        apart.decode_apart(file, Gate("a", len(data)), HeavyError(160 * 2**20, 60.0))
    assert "memory" in str(caught.value) or "to decode" in str(caught.value)


def open_temporary(data):
    import tempfile

    file = tempfile.TemporaryFile()  # noqa: SIM115
    file.write(data)
    file.flush()
    return file


@pytest.mark.skipif(os.name != "posix", reason="processes have no parent elsewhere")
def test_the_process_ends_with_its_parent(tmp_path):
    job = {"memory": 2**32, "seconds": 3600.0, "parent": 1}
    code = f"from texlab_core.images.formats.apart import _confine; import time; _confine({job}); time.sleep(3600)"
    ended = subprocess.run([sys.executable, "-c", code], timeout=60, check=False, cwd=Path(__file__).parents[2])
    assert ended.returncode == 1


def test_a_frozen_program_decodes_where_it_is(always_apart, monkeypatch):
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    monkeypatch.setattr(subprocess, "Popen", lambda *_, **__: pytest.fail("was started"))
    assert as_exemplar(small_png()).size == (48, 40)


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


ADAM7 = ((0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1))


def deep_png(values, *, interlaced=False, beyond=b"", before=b""):
    raw = b""
    for top, left, down, right in ADAM7 if interlaced else ((0, 0, 1, 1),):
        for row in values[top::down, left::right]:
            raw += b"\0" + row.astype(">u2").tobytes() if row.size else b""
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[values.shape[2]]
    head = struct.pack(">IIBBBBB", values.shape[1], values.shape[0], 16, kind, 0, 0, interlaced)
    body = chunk(b"IHDR", head) + before + chunk(b"IDAT", zlib.compress(raw) + beyond) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + body


ODD = {
    "interlaced": {"interlaced": True},
    "data after the end": {"beyond": b"abcdef"},
    "a palette of half a colour": {"before": chunk(b"PLTE", b"abcd")},
    "two transparent colours": {"before": chunk(b"tRNS", b"\0\1\0\2\0\3") * 2},
    "a transparent colour of the wrong length": {"before": chunk(b"tRNS", b"\0")},
}


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("size", [(9, 11), (1, 7), (3, 2)])
def test_libraries_are_not_heard(odd, size, capfd):
    values = np.random.default_rng(0).integers(0, 65536, (*size, 3), dtype=np.uint16)
    read = read_image(deep_png(values, **ODD[odd]), "a")
    assert np.array_equal(read.values[..., :3], values)
    assert capfd.readouterr().err == ""


def test_deep_png_that_ends_too_early():
    values = np.random.default_rng(0).integers(0, 65536, (9, 11, 3), dtype=np.uint16)
    whole = deep_png(values)
    cut = whole.replace(struct.pack(">II", 11, 9), struct.pack(">II", 11, 99))
    cut = cut[:29] + struct.pack(">I", zlib.crc32(cut[12:29])) + cut[33:]
    with pytest.raises(ImageError, match="6633 bytes of pixels expected, 603 found"):
        as_exemplar(cut)
