"""Every format, written by other programs' encoders and read back with known values."""

import io
import os
import struct
import zlib

import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image, ImageCms, ImageOps

from texlab_core.errors import ImageError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats import png as png_files

GRAY8 = np.random.default_rng(0).integers(0, 256, (7, 9), dtype=np.uint8)
RGB8 = np.random.default_rng(1).integers(0, 256, (7, 9, 3), dtype=np.uint8)
GRAY16 = np.random.default_rng(2).integers(0, 65536, (7, 9), dtype=np.uint16)
SRGB = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
RGB16 = np.random.default_rng(3).integers(0, 65536, (7, 9, 3), dtype=np.uint16)


def pillow(image, kind, **options):
    out = io.BytesIO()
    image = Image.fromarray(image) if isinstance(image, np.ndarray) else image
    image.save(out, kind, **options)
    return out.getvalue()


def tiff(array, **options):
    out = io.BytesIO()
    tifffile.imwrite(out, array, metadata=None, **options)
    return out.getvalue()


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(width, height, depth, colour_type, rows, extra=b""):
    header = struct.pack(">IIBBBBB", width, height, depth, colour_type, 0, 0, 0)
    body = zlib.compress(b"".join(b"\0" + row for row in rows))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def assert_reads(data, expected, peak):
    """Check that the file has these integers over this maximum."""
    made = as_exemplar(data)
    expected = expected.reshape(*expected.shape[:2], -1)
    assert made.pixels.shape == expected.shape
    assert np.array_equal(np.rint(made.pixels.astype(np.float64) * peak), expected)
    return made


@pytest.mark.parametrize("array", [GRAY8, RGB8], ids=["gray", "colour"])
@pytest.mark.parametrize("kind", ["PNG", "BMP", "TIFF", "PPM", "WEBP"])
def test_eight_bits(array, kind):
    options = {"lossless": True, "exact": True} if kind == "WEBP" else {}
    if kind == "WEBP" and array.ndim == 2:
        made = as_exemplar(pillow(array, kind, **options))
        assert made.channels == 1
    made = assert_reads(pillow(array, kind, **options), array, 255)
    assert made.name == "image"


@pytest.mark.parametrize("array", [GRAY16, RGB16], ids=["gray", "colour"])
def test_sixteen_bit_png_keeps_every_bit(array):
    assert_reads(imagecodecs.png_encode(array), array, 65535)


@pytest.mark.parametrize("channels", [2, 4])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_png_with_alpha(channels, dtype):
    peak = np.iinfo(dtype).max
    array = np.random.default_rng(4).integers(0, peak, (7, 9, channels), dtype=dtype, endpoint=True)
    made = as_exemplar(imagecodecs.png_encode(array), background=0.0)
    assert np.abs(made.pixels - array[..., :-1] / peak * (array[..., -1:] / peak)).max() < 1e-6
    assert made.notes == ("Transparent pixels were laid over black.",)


@pytest.mark.parametrize("depth", [1, 2, 4])
def test_png_of_few_bits(depth):
    per_byte = 8 // depth
    values = np.random.default_rng(5).integers(0, 2**depth, (5, 8), dtype=np.uint8)
    shifts = depth * np.arange(per_byte - 1, -1, -1)
    packed = (values.reshape(5, -1, per_byte) << shifts).sum(axis=2).astype(np.uint8)
    assert_reads(png(8, 5, depth, 0, [row.tobytes() for row in packed]), values, 2**depth - 1)


def test_palette_png():
    palette = np.random.default_rng(6).integers(0, 256, (7, 3), dtype=np.uint8)
    index = np.random.default_rng(7).integers(0, 7, (5, 6), dtype=np.uint8)
    rows = [row.tobytes() for row in index]
    assert_reads(png(6, 5, 8, 3, rows, chunk(b"PLTE", palette.tobytes())), palette[index], 255)
    alpha = np.array([0, 255, 128], np.uint8)
    made = as_exemplar(png(6, 5, 8, 3, rows, chunk(b"PLTE", palette.tobytes()) + chunk(b"tRNS", alpha.tobytes())))
    share = np.concatenate([alpha, np.full(4, 255)])[index][..., None] / 255
    assert np.abs(made.pixels - (palette[index] / 255 * share + 1 - share)).max() < 1e-6


@pytest.mark.parametrize("depth", [8, 16])
def test_png_with_a_transparent_colour(depth):
    gray = np.array([[0, 5], [5, 9]], np.uint8 if depth == 8 else ">u2")
    made = as_exemplar(png(2, 2, depth, 0, [row.tobytes() for row in gray], chunk(b"tRNS", struct.pack(">H", 5))))
    peak = 2**depth - 1
    assert np.allclose(made.pixels[..., 0], [[0, 1], [1, 9 / peak]], atol=1e-7)


def test_jpeg_gray_and_colour():
    smooth = np.add.outer(np.arange(32), np.arange(40)).astype(np.uint8) * 3
    made = as_exemplar(pillow(smooth, "JPEG", quality=98))
    assert made.channels == 1
    assert np.abs(made.pixels[..., 0] - smooth / 255).max() < 0.02
    colours = np.stack([smooth, 255 - smooth, smooth // 2], axis=2)
    made = as_exemplar(pillow(colours, "JPEG", quality=98, subsampling=0))
    assert np.abs(made.pixels - colours / 255).max() < 0.03


def test_cmyk_jpeg_is_converted_and_it_says_so():
    inks = np.zeros((16, 16, 4), np.uint8)
    inks[:8, :, 0], inks[8:, :, 1] = 255, 255
    made = as_exemplar(pillow(Image.frombytes("CMYK", (16, 16), inks.tobytes()), "JPEG", quality=100))
    assert np.allclose(made.pixels[0, 0], [0, 1, 1], atol=0.02)
    assert np.allclose(made.pixels[-1, 0], [1, 0, 1], atol=0.02)
    assert made.notes == ("The four inks were converted to RGB without a colour profile.",)


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("kind", ["PNG", "WEBP", "TIFF", "JPEG"])
def test_exif_orientation(orientation, kind):
    image = Image.fromarray(np.repeat(np.repeat(RGB8, 8, 0), 8, 1))
    exif = Image.Exif()
    exif[0x0112] = orientation
    options = (
        {"lossless": True} if kind == "WEBP" else {"quality": 100, "subsampling": 0} if kind == "JPEG" else {}
    )
    if kind == "TIFF":
        options["tiffinfo"] = {0x0112: orientation}
    else:
        options["exif"] = exif
    data = pillow(image, kind, **options)
    upright = np.asarray(ImageOps.exif_transpose(Image.open(io.BytesIO(data))))
    assert_reads(data, upright, 255)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.uint32])
@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("planar", [False, True])
def test_tiff_integers(dtype, channels, planar):
    peak = np.iinfo(dtype).max
    array = np.random.default_rng(8).integers(0, peak, (7, 9, channels), dtype=dtype, endpoint=True)
    kind = {"photometric": "rgb" if channels == 3 else "minisblack"}
    if planar and channels == 3:
        data = tiff(np.moveaxis(array, 2, 0), planarconfig="separate", **kind)
    else:
        data = tiff(array if channels == 3 else array[..., 0], tile=(16, 16) if planar else None, **kind)
    made = as_exemplar(data)
    assert np.array_equal(made.pixels, (array / peak).astype(np.float32))


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_tiff_floats_in_and_out_of_range(dtype):
    array = np.random.default_rng(9).random((7, 9, 3)).astype(dtype)
    made = as_exemplar(tiff(array, photometric="rgb", compression="zlib"))
    assert np.array_equal(made.pixels, array.astype(np.float32))
    wide = array[..., 0] * 4 - 1
    made = as_exemplar(tiff(wide, photometric="minisblack"))
    assert np.allclose(made.pixels[..., 0], (wide - wide.min()) / (wide.max() - wide.min()), atol=2e-3)
    assert "were mapped to 0 to 1" in made.notes[0]


def test_tiff_with_fewer_strips_than_its_height_is_damaged():
    data = bytearray(tiff(GRAY8, photometric="minisblack"))
    with tifffile.TiffFile(io.BytesIO(bytes(data))) as file:
        tag = file.pages[0].tags["ImageLength"]
        data[tag.valueoffset : tag.valueoffset + 2] = (1000).to_bytes(2, "little")
    with pytest.raises(ImageError, match="strips or tiles expected, 1 found"):
        as_exemplar(bytes(data))


def test_tiff_that_decodes_to_too_many_bytes_is_refused(monkeypatch):
    data = tiff(np.zeros((8, 8, 16)), photometric="minisblack", planarconfig="contig", compression="zlib")
    assert as_exemplar(data).channels == 1
    monkeypatch.setattr("texlab_core.images.formats.tiff._MAX_BYTES", 8 * 8 * 16 * 8 - 1)
    with pytest.raises(ImageError, match=r"has 16 channels of float64 in 8 x 8 pixels; at most 0 GB are decoded"):
        as_exemplar(data)


def test_tiff_signed_integers_are_mapped_from_their_range():
    made = as_exemplar(tiff(np.array([[-100, 0], [100, 300]], np.int16), photometric="minisblack"))
    assert np.array_equal(made.pixels[..., 0], np.float32([[0, 0.25], [0.5, 1]]))


def test_tiff_alpha_premultiplied_or_not():
    array = np.full((4, 4, 4), 64, np.uint8)
    array[..., 3] = 128
    array[0, 0, 1] = 32
    for kind, colour in (("unassalpha", 64 / 255 * 128 / 255), ("assocalpha", 64 / 255)):
        made = as_exemplar(tiff(array, photometric="rgb", extrasamples=[kind]), background=1.0)
        assert np.allclose(made.pixels[1, 1], colour + 1 - 128 / 255, atol=1e-6)
    gray = as_exemplar(
        tiff(array[..., 2:], photometric="minisblack", planarconfig="contig", extrasamples=["unassalpha"])
    )
    assert gray.channels == 1
    assert np.allclose(gray.pixels, 64 / 255 * 128 / 255 + 1 - 128 / 255, atol=1e-6)


def test_tiff_extra_channels_are_dropped_and_it_says_so():
    array = np.random.default_rng(9).integers(0, 256, (7, 9, 5), dtype=np.uint8)
    options = {"photometric": "rgb", "planarconfig": "contig", "extrasamples": ["unspecified", "unspecified"]}
    made = assert_reads(tiff(array, **options), array[..., :3], 255)
    assert made.notes == ("Channels that are neither colour nor alpha were dropped.",)


def test_tiff_white_is_zero_bilevel_and_palette():
    assert_reads(tiff(GRAY8, photometric="miniswhite"), 255 - GRAY8, 255)
    assert_reads(tiff(GRAY8 > 127, photometric="minisblack"), (GRAY8 > 127).astype(np.uint8), 1)
    table = np.random.default_rng(10).integers(0, 256, (256, 3), dtype=np.uint8)
    for factor in (257, 256):
        data = tiff(GRAY8, photometric="palette", colormap=(table.T.astype(np.uint16) * factor))
        assert_reads(data, table[GRAY8], 255)
    deep = np.random.default_rng(11).integers(0, 65536, (3, 256), dtype=np.uint16)
    assert_reads(tiff(GRAY8, photometric="palette", colormap=deep), deep.T[GRAY8], 65535)


def test_tiff_cmyk():
    inks = np.zeros((4, 4, 4), np.uint8)
    inks[0, 0] = [255, 0, 0, 0]
    inks[1, 1] = [0, 0, 0, 255]
    made = as_exemplar(tiff(inks, photometric="separated"))
    assert made.pixels[0, 0].tolist() == [0, 1, 1]
    assert made.pixels[1, 1].tolist() == [0, 0, 0]
    assert made.pixels[2, 2].tolist() == [1, 1, 1]


def test_tiff_of_floats_with_a_profile_keeps_its_values_and_cmyk_is_refused():
    array = np.random.default_rng(9).random((7, 9, 3)).astype(np.float32)
    made = as_exemplar(tiff(array, photometric="rgb", iccprofile=imagecodecs.cms_profile("adobergb")))
    assert np.array_equal(made.pixels, array)
    assert made.notes == ("The colour profile was ignored, because it is applied to integers without sign only.",)
    with pytest.raises(ImageError, match=r"is a CMYK TIFF of float32; integers without sign are read\.$"):
        as_exemplar(tiff(np.zeros((4, 4, 4), np.float32), photometric="separated"))


def test_cmyk_profile_of_another_kind_is_ignored():
    inks = Image.frombytes("CMYK", (4, 4), bytes(64))
    made = as_exemplar(pillow(inks, "TIFF", icc_profile=SRGB))
    assert (made.pixels == 1).all()
    assert len(made.notes) == 3
    assert made.notes[0] == "The colour profile is for rgb images and was ignored."


def test_several_pages_and_frames_use_the_first_and_say_so():
    stack = np.stack([GRAY8, 255 - GRAY8, GRAY8 // 2])
    made = assert_reads(tiff(stack, photometric="minisblack"), GRAY8, 255)
    assert made.notes == ("The file has 3 pages; the first one was used.",)
    frames = [Image.fromarray(RGB8), Image.fromarray(255 - RGB8)]
    for kind, options in (("PNG", {}), ("WEBP", {"lossless": True})):
        made = assert_reads(pillow(frames[0], kind, save_all=True, append_images=frames[1:], **options), RGB8, 255)
        assert made.notes == ("The file has 2 frames; the first one was used.",)


@pytest.mark.parametrize(
    ("text", "values", "peak"),
    [
        (b"P1\n# a comment\n4 2\n1 0 1 0\n0101", [[0, 1, 0, 1], [1, 0, 1, 0]], 1),
        (b"P2 3 2 7\n0 1 2 # three\n 5 6 7\n", [[0, 1, 2], [5, 6, 7]], 7),
        (b"P2 2 2 1000 0 1 999 1000", [[0, 1], [999, 1000]], 1000),
        (b"P3\n2 2\n255\n1 2 3 4 5 6 7 8 9 10 11 12", [[[1, 2, 3], [4, 5, 6]], [[7, 8, 9], [10, 11, 12]]], 255),
        (b"P4 9 2\n\x80\x80\x00\x00", [[0, 1, 1, 1, 1, 1, 1, 1, 0], [1] * 9], 1),
        (b"P5\n2 2\n# why not\n100\n\x00\x01\x63\x64", [[0, 1], [99, 100]], 100),
        (b"P5 2 2 4095\n\x00\x00\x00\x01\x0f\xfe\x0f\xff", [[0, 1], [4094, 4095]], 4095),
    ],
)
def test_portable_formats_by_hand(text, values, peak):
    assert_reads(text, np.array(values), peak)


def test_sixteen_bit_ppm():
    assert_reads(b"P6 9 7 65535\n" + RGB16.astype(">u2").tobytes(), RGB16, 65535)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (b"P5 2 2 100\n\x00\x01\x63\x65", "values go from 0 to 101, and must be from 0 to 100"),
        (b"P2 2 2 9 0 -1 2 3", "truncated or damaged (what is no whole number from 0"),
        (b"P2 2 2 9 0 1 2", "truncated or damaged (4 values expected, 3 found)"),
        (b"P2 2 2 9 0 1 x 2", "truncated or damaged"),
        (b"P5 2 2 255\n\x00", "truncated or damaged (4 bytes expected, 1 found)"),
        (b"P5 2 2 70000\n" + bytes(8), "maximum of the image must be from 1 to 65535, got 70000"),
        (b"P5 2 2 0\n" + bytes(4), "maximum of the image must be from 1 to 65535, got 0"),
        (b"P5 0 2 255\n", "the image is empty (0 x 2 pixels)"),
        (b"P6 99999 99999 255\n", "the image has 99999 x 99999 pixels; at most 64 megapixels are read"),
        (b"P5 two 2 255\n", "the header of the image is damaged"),
    ],
)
def test_damaged_portable_files(text, says):
    with pytest.raises(ImageError) as caught:
        as_exemplar(text, name="a.pgm")
    assert says in str(caught.value)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_wide_gamut_profile_is_converted(dtype):
    peak = np.iinfo(dtype).max
    profile = imagecodecs.cms_profile("adobergb")
    array = np.full((4, 4, 3), peak // 2, dtype)
    array[0, 0] = [0.6 * peak, 0.4 * peak, 0.4 * peak]
    data = tiff(array, photometric="rgb", iccprofile=profile)
    made = as_exemplar(data)
    # Adobe RGB has gamma 2.2 and a wider gamut: closed form of the pair of transforms.
    linear = (array[0, 0] / peak) ** 2.19921875
    adobe_to_xyz = np.array(
        [[0.57667, 0.18556, 0.18823], [0.29734, 0.62736, 0.07529], [0.02703, 0.07069, 0.99134]]
    )
    xyz_to_srgb = np.array(
        [[3.24045, -1.53714, -0.49853], [-0.96927, 1.87601, 0.04156], [0.05564, -0.20403, 1.05723]]
    )
    rgb = xyz_to_srgb @ adobe_to_xyz @ linear
    expected = 1.055 * rgb ** (1 / 2.4) - 0.055
    assert np.allclose(made.pixels[0, 0], expected, atol=0.012)
    assert made.notes == ("Colours were converted to sRGB by the image's profile.",)


def test_srgb_profile_changes_no_value():
    for kind in ("PNG", "JPEG", "WEBP", "TIFF"):
        options = {"lossless": True} if kind == "WEBP" else {}
        bare = as_exemplar(pillow(RGB8, kind, **options))
        profiled = as_exemplar(pillow(RGB8, kind, icc_profile=SRGB, **options))
        assert profiled.sha256 == bare.sha256
        assert profiled.notes == ()


def test_gray_profile_is_converted_to_one_channel():
    linear = imagecodecs.cms_profile("gray", gamma=1.0)
    made = as_exemplar(pillow(np.full((3, 3), 51, np.uint8), "PNG", icc_profile=linear))
    assert made.channels == 1
    assert made.pixels[0, 0, 0] == pytest.approx(1.055 * 0.2 ** (1 / 2.4) - 0.055, abs=0.01)


def test_profile_keeps_alpha():
    array = np.dstack([RGB8, GRAY8])
    made = as_exemplar(pillow(array, "PNG", icc_profile=imagecodecs.cms_profile("adobergb")), background=0.0)
    assert len(made.notes) == 2
    assert (made.pixels.max(axis=2) <= GRAY8 / 255 + 1e-6).all()


@pytest.mark.parametrize(
    ("profile", "note"),
    [
        (b"junk" * 50, "The colour profile is of an unknown kind and was ignored."),
        (SRGB[:200], "The colour profile is damaged and was ignored."),
        (imagecodecs.cms_profile("gray", gamma=1.0), "The colour profile is for gray images and was ignored."),
    ],
)
def test_broken_profile_is_noted_and_ignored(profile, note):
    made = assert_reads(pillow(RGB8, "PNG", icc_profile=profile), RGB8, 255)
    assert made.notes == (note,)


# What is refused


def whole_files():
    return {
        "a.png": pillow(RGB8, "PNG"),
        "deep.png": imagecodecs.png_encode(RGB16),
        "a.jpg": pillow(RGB8, "JPEG"),
        "a.webp": pillow(RGB8, "WEBP"),
        "a.bmp": pillow(RGB8, "BMP"),
        "a.tif": tiff(RGB8, photometric="rgb"),
        "packed.tif": tiff(RGB8, photometric="rgb", compression="zlib"),
        "a.ppm": pillow(RGB8, "PPM"),
    }


@pytest.mark.parametrize("name", whole_files())
@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_truncated_files_get_one_sentence(name, share):
    data = whole_files()[name]
    with pytest.raises(ImageError) as caught:
        as_exemplar(data[: int(len(data) * share)], name=name)
    sentence = str(caught.value)
    assert sentence.startswith(f"{name}: ")
    assert "\n" not in sentence
    assert sentence.endswith(".")


@pytest.mark.parametrize("name", whole_files())
def test_flipped_bytes_never_escape_as_other_errors(name):
    data = whole_files()[name]
    rng = np.random.default_rng(12)
    refused = 0
    for _ in range(60):
        broken = bytearray(data)
        for place in rng.integers(4, len(data), 3):
            broken[place] = rng.integers(256)
        try:
            made = as_exemplar(bytes(broken), name=name)
        except ImageError:
            refused += 1
        else:
            assert np.isfinite(made.pixels).all()
    assert refused > 0


def huge_headers():
    side = 70000
    jpeg = bytearray(whole_files()["a.jpg"])
    place = jpeg.index(b"\xff\xc0") + 5
    jpeg[place : place + 4] = struct.pack(">HH", 60000, 60000)
    bmp = bytearray(whole_files()["a.bmp"])
    bmp[18:26] = struct.pack("<ii", side, side)
    lossless = b"\x2f" + struct.pack("<I", (16383 << 14) | 16383) + bytes(40)
    webp = b"WEBPVP8L" + struct.pack("<I", len(lossless)) + lossless
    return {
        "a.png": png(side, side, 8, 2, [b""]),
        "a.jpg": bytes(jpeg),
        "a.bmp": bytes(bmp),
        "a.webp": b"RIFF" + struct.pack("<I", len(webp)) + webp,
        "a.tif": tiff(np.broadcast_to(np.uint8(0), (1, 70000)), photometric="minisblack").replace(
            struct.pack("<HHII", 257, 4, 1, 1), struct.pack("<HHII", 257, 4, 1, side)
        ),
        "a.pgm": b"P5 70000 70000 255\n",
    }


@pytest.mark.parametrize("name", huge_headers())
def test_sizes_are_refused_from_the_header(name):
    with pytest.raises(ImageError, match="at most 64 megapixels are read"):
        as_exemplar(huge_headers()[name], name=name)


def test_pillow_keeps_its_own_limit():
    before = Image.MAX_IMAGE_PIXELS
    as_exemplar(whole_files()["a.png"])
    assert before == Image.MAX_IMAGE_PIXELS


def test_tiff_tiles_far_larger_than_the_image_are_refused():
    data = tiff(GRAY8, photometric="minisblack", tile=(16, 16))
    for tag in (322, 323):
        data = data.replace(struct.pack("<HHIH", tag, 3, 1, 16), struct.pack("<HHIH", tag, 3, 1, 65520))
        data = data.replace(struct.pack("<HHII", tag, 4, 1, 16), struct.pack("<HHII", tag, 4, 1, 65520))
    with pytest.raises(ImageError, match="tiles that are too large"):
        as_exemplar(data)


def test_tiff_that_is_no_picture():
    volume = tiff(np.zeros((4, 16, 16), np.uint8), photometric="minisblack", volumetric=True, tile=(16, 16, 16))
    with pytest.raises(ImageError, match="TIFF volume or stack"):
        as_exemplar(volume)
    with pytest.raises(ImageError, match="numbers TexLab does not read"):
        as_exemplar(tiff(np.zeros((4, 4), np.complex64), photometric="minisblack"))
    with pytest.raises(ImageError, match="colours TexLab does not read"):
        as_exemplar(tiff(RGB8, photometric="cielab"))


@pytest.mark.parametrize(
    "data", [b"GIF88a" + bytes(50), b"hello, this is text", b"\0" * 100, b"P9 1 1 1", b"RIFFxxxxWAVE"]
)
def test_what_is_no_known_image(data):
    with pytest.raises(
        ImageError, match=r"^image: is not an image that TexLab reads \(PNG, JPEG, TIFF, WebP, AVIF"
    ):
        as_exemplar(data)


def test_paths(tmp_path):
    file = tmp_path / "wall.png"
    file.write_bytes(pillow(RGB8, "PNG"))
    for source in (file, str(file)):
        made = assert_reads(source, RGB8, 255)
        assert made.name == "wall.png"
    assert as_exemplar(file, name="my wall").name == "my wall"
    sideways = tmp_path / "wrong suffix.jpg"
    sideways.write_bytes(file.read_bytes())
    assert_reads(sideways, RGB8, 255)


def test_paths_that_cannot_be_read(tmp_path, monkeypatch):
    def says(source):
        with pytest.raises(ImageError) as caught:
            as_exemplar(source)
        return str(caught.value)

    missing = tmp_path / "missing.png"
    assert says(missing) == f"{missing}: there is no such file."
    folder = tmp_path / "folder"
    folder.mkdir()
    assert says(folder) == f"{folder}: is a folder, not an image, and there are no pictures in it."
    for name in ("c.png", "a.jpg", "b.TIF", "notes.txt", "d.hdr"):
        (folder / name).touch()
    assert says(folder) == f"{folder}: is a folder, not an image; its pictures: a.jpg, b.TIF, c.png and 1 more."
    assert says("nul\0l.png").startswith("nul\0l.png: cannot be opened (")
    empty = tmp_path / "empty.png"
    empty.write_bytes(b"")
    assert says(empty) == f"{empty}: the file is empty."
    below = empty / "a.png"
    assert says(below) == f"{below}: cannot be opened (Not a directory)."

    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("builtins.open", refuse)
    assert says(empty) == f"{empty}: cannot be opened (Permission denied)."


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_is_not_waited_for(tmp_path):
    pipe = tmp_path / "pipe.png"
    os.mkfifo(pipe)
    with pytest.raises(ImageError, match="is not a regular file"):
        as_exemplar(pipe)


def test_running_out_of_memory_is_one_sentence(monkeypatch):
    def exhausted(*_):
        raise MemoryError

    monkeypatch.setattr(png_files, "_parts", exhausted)
    with pytest.raises(ImageError, match=r"^image: there is not enough memory to read it\.$"):
        as_exemplar(whole_files()["a.png"])
