"""Formats beside PNG, JPEG and TIFF, and what their files say of depth and colour."""

import io
import struct
from pathlib import Path

import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image

from texlab_core.errors import ImageError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.decoded import Gate
from texlab_core.images.formats.kinds import decode_open
from texlab_core.images.formats.profiles import encode_srgb
from texlab_core.images.formats.reading import read_image

CASES = Path(__file__).parents[1] / "data" / "images"
RGB = np.random.default_rng(0).integers(0, 256, (15, 22, 3), dtype=np.uint8)
RGBA = np.random.default_rng(1).integers(0, 256, (15, 22, 4), dtype=np.uint8)
GRAY = RGB[..., :1]


def deep(bits, channels=3):
    return np.random.default_rng(2).integers(0, 2**bits, (15, 22, channels), dtype=np.uint16)


def pillow(values, kind, **options):
    out = io.BytesIO()
    image = values if isinstance(values, Image.Image) else Image.fromarray(values)
    image.save(out, kind, **options)
    return out.getvalue()


def srgb_of_light(light):
    """IEC 61966-2-1, in doubles."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-12) ** (1 / 2.4) - 0.055)


def assert_reads(data, values, peak, depth=8):
    made = as_exemplar(data, alpha="ignore")
    values = values.reshape(*values.shape[:2], -1)
    assert np.array_equal(np.rint(made.pixels.astype(np.float64) * peak), values[..., : made.channels])
    assert made.depth == depth
    return made


EXACT = {
    "webp": (imagecodecs.webp_encode(RGB, lossless=True), RGB, 255, 8),
    "avif": (imagecodecs.avif_encode(RGB, level=100), RGB, 255, 8),
    "avif of 10 bits": (imagecodecs.avif_encode(deep(10), level=100, bitspersample=10), deep(10), 1023, 16),
    "avif of 12 bits": (imagecodecs.avif_encode(deep(12), level=100, bitspersample=12), deep(12), 4095, 16),
    "jpeg xl": (imagecodecs.jpegxl_encode(RGB, lossless=True), RGB, 255, 8),
    "jpeg xl, gray": (imagecodecs.jpegxl_encode(GRAY[..., 0], lossless=True), GRAY, 255, 8),
    "jpeg xl with alpha": (imagecodecs.jpegxl_encode(RGBA, lossless=True), RGBA, 255, 8),
    "jpeg 2000": (imagecodecs.jpeg2k_encode(RGB, reversible=True), RGB, 255, 8),
    "jpeg 2000, gray": (imagecodecs.jpeg2k_encode(GRAY[..., 0], reversible=True), GRAY, 255, 8),
    "jpeg 2000 of 12 bits": (
        imagecodecs.jpeg2k_encode(deep(12), reversible=True, bitspersample=12),
        deep(12),
        4095,
        16,
    ),
    "jpeg 2000 codestream": (imagecodecs.jpeg2k_encode(RGB, reversible=True, codecformat="j2k"), RGB, 255, 8),
    "jpeg without loss": (
        imagecodecs.jpeg8_encode(deep(16), lossless=True, bitspersample=16),
        deep(16),
        65535,
        16,
    ),
    "qoi": (imagecodecs.qoi_encode(RGB), RGB, 255, 8),
    "qoi with alpha": (imagecodecs.qoi_encode(RGBA), RGBA, 255, 8),
    "tga": (pillow(RGB, "TGA"), RGB, 255, 8),
    "tga in runs": (pillow(RGB, "TGA", compression="tga_rle"), RGB, 255, 8),
    "tga, gray": (pillow(GRAY[..., 0], "TGA"), GRAY, 255, 8),
    "tga of the first version": (pillow(RGB, "TGA")[:-26], RGB, 255, 8),
    "bmp": (pillow(RGB, "BMP"), RGB, 255, 8),
}


@pytest.mark.parametrize("kind", EXACT)
def test_formats_without_loss(kind):
    data, values, peak, depth = EXACT[kind]
    assert_reads(data, values, peak, depth)


@pytest.mark.parametrize("kind", EXACT)
def test_readers_do_the_same_in_either_process(kind):
    data = EXACT[kind][0]
    here = decode_open(io.BytesIO(data), Gate("a", len(data), apart=True))
    there = read_image(data, "a")
    assert np.array_equal(here.values, there.values)
    assert (here.peak, here.notes, here.depth) == (there.peak, there.notes, there.depth)


@pytest.mark.parametrize("bits", [10, 16])
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_jpeg_xl_of_light_gets_the_curve_of_srgb(bits, channels):
    values = deep(bits, channels)
    data = imagecodecs.jpegxl_encode(
        values[..., 0] if channels == 1 else values, lossless=True, bitspersample=bits
    )
    made = as_exemplar(data, alpha="ignore")
    colours = 1 if channels == 1 else 3
    right = srgb_of_light(values[..., :colours] / (2**bits - 1))
    assert np.abs(made.pixels - right).max() < 1.5 / 65535
    assert made.notes[0] == "The file's gamma of 1 was converted to that of sRGB."


def test_jpeg_xl_of_floats():
    light = np.random.default_rng(3).random((15, 22, 3)).astype(np.float32)
    made = as_exemplar(imagecodecs.jpegxl_encode(light, lossless=True))
    assert np.abs(made.pixels - srgb_of_light(light.astype(np.float64))).max() < 1e-6
    assert made.depth == "float"
    assert made.notes[0].startswith("Light up to 1 was mapped to 0 to 1 by the curve of sRGB")


def radiance(light):
    return imagecodecs.rgbe_encode(light.astype(np.float32))


def test_radiance_pictures_say_their_range():
    light = np.random.default_rng(4).random((40, 50, 3)) * 8
    light[0, 0] = 5000
    data = radiance(light)
    stored = imagecodecs.rgbe_decode(data).astype(np.float64)
    made = as_exemplar(data)
    white = np.percentile(stored, 99.5, method="higher")
    assert 7.5 < white <= 8
    right = srgb_of_light(np.clip(stored / white, 0, 1))
    assert np.abs(made.pixels - right).max() < 1e-5
    assert made.notes == (
        f"Light up to {white:.4g} was mapped to 0 to 1 by the curve of sRGB; what is brighter was clipped.",
    )
    assert made.depth == "float"
    turned = data.replace(b"-Y 40 +X 50", b"+X 40 -Y 50")
    with pytest.raises(ImageError, match="whose rows TexLab does not read"):
        as_exemplar(turned)


def test_encode_srgb_is_continuous_and_right():
    light = np.linspace(0, 1, 10_001)
    assert np.abs(encode_srgb(light) - srgb_of_light(light)).max() < 1e-6
    assert np.diff(encode_srgb(light)).min() > 0


def test_gif_takes_the_first_frame_and_says_so():
    palette = np.random.default_rng(5).integers(0, 256, (16, 3), dtype=np.uint8)
    frames = []
    for seed in range(3):
        index = np.random.default_rng(seed).integers(0, 16, (15, 22), dtype=np.uint8)
        image = Image.frombytes("P", (22, 15), index.tobytes())
        image.putpalette(palette.tobytes())
        frames.append(image)
    first = palette[np.asarray(frames[0])]
    assert assert_reads(pillow(frames[0], "GIF"), first, 255).notes == ()
    data = pillow(frames[0], "GIF", save_all=True, append_images=frames[1:], loop=0)
    assert assert_reads(data, first, 255).notes == ("The file has 3 frames; the first one was used.",)


def psd(values, *, bits=8, mode=3):
    """A Photoshop file with nothing but its flattened picture, uncompressed (Photoshop File Formats, 2019)."""
    planes = np.moveaxis(values, 2, 0)
    head = b"8BPS" + struct.pack(">H6xHIIHH", 1, planes.shape[0], values.shape[0], values.shape[1], bits, mode)
    return head + struct.pack(">III", 0, 0, 0) + struct.pack(">H", 0) + planes.tobytes()


def test_psd_gives_its_flattened_picture():
    assert assert_reads(psd(RGB), RGB, 255).notes == ("The flattened picture of the Photoshop file was used.",)
    assert assert_reads(psd(GRAY, mode=1), GRAY, 255).channels == 1
    with pytest.raises(
        ImageError, match="is a Photoshop file of 16 bits in mode 3; gray, RGB and CMYK of 8 bits are"
    ):
        as_exemplar(psd(RGB, bits=16))


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (
            b"\0\0\0\x18ftypheic" + bytes(40),
            "is a HEIC image, which TexLab does not read; save it as JPEG, PNG or AVIF",
        ),
        (b"\0\0\0\x18ftypisom" + bytes(40), "is not an image that TexLab reads"),
        (imagecodecs.jpeg2k_encode(np.zeros((9, 9), np.int16), reversible=True), "with sign; up to 4 of 16 bits"),
    ],
)
def test_what_is_named_and_not_read(data, says):
    with pytest.raises(ImageError, match=says):
        as_exemplar(data)


def test_deep_and_lossless_jpegs_are_read():
    deep12, deep16 = (as_exemplar(CASES / name) for name in ("j_gray12.jpg", "j_lossless16.jpg"))
    assert (deep12.depth, deep16.depth) == (16, 16)
    # One is the other at 12 bits, after a lossy coder.
    assert np.abs(deep12.pixels - deep16.pixels).max() < 0.02


def test_hierarchical_jpeg_is_not_supported():
    data = pillow(RGB, "JPEG").replace(b"\xff\xc0", b"\xff\xc5", 1)
    with pytest.raises(ImageError, match=r"is a JPEG of a kind \(frame 5\) that TexLab does not read"):
        as_exemplar(data)


@pytest.mark.parametrize("name", ["preview-then-page.tif", "preview-with-subifd.tif"])
def test_previews_are_no_pages(name):
    made = as_exemplar(CASES / name)
    assert np.array_equal(np.rint(made.pixels * 255), np.load(CASES / "right.npy"))
    assert made.notes == ("Previews and masks in the file were passed over.",)


def pages(*each):
    out = io.BytesIO()
    with tifffile.TiffWriter(out) as writer:
        for values, options in each:
            writer.write(values, photometric=options.pop("photometric", "minisblack"), metadata=None, **options)
    return out.getvalue()


def test_the_largest_page_is_the_picture():
    small, large = GRAY[:8, :8, 0], RGB[..., 1]
    made = as_exemplar(pages((small, {}), (large, {}), (large // 2, {})))
    assert np.array_equal(np.rint(made.pixels[..., 0] * 255), large)
    assert made.notes == ("The file has 3 pages; the largest one, number 2, was used.",)
    mask = as_exemplar(pages((small, {}), (large > 127, {"subfiletype": 4})))
    assert mask.size == (8, 8)
    alone = as_exemplar(pages((small, {"subfiletype": 1})))
    assert alone.size == (8, 8)


@pytest.mark.parametrize(
    "head",
    [
        b"\0\0\0\x18ftypcrx \0\0\0\1",
        b"FUJIFILMCCD-RAW 0201",
        b"IIRO\x08\0\0\0",
        b"IIU\0\x18\0\0\0",
        b"FOVb",
        b"\0MRM",
    ],
)
def test_raw_photographs_that_are_no_tiff_are_named_too(head):
    with pytest.raises(
        ImageError, match="is a raw photograph, which TexLab does not develop; export it as TIFF or PNG"
    ):
        as_exemplar(head + bytes(60))


def test_raw_photographs_get_one_sentence():
    data = pages((GRAY[..., 0], {"subfiletype": 1}), (deep(12)[..., 0], {"photometric": 32803}))
    with pytest.raises(ImageError, match=r"is a raw photograph \(DNG or another camera's\), which"):
        as_exemplar(data)


def test_declared_white_of_a_tiff():
    made = as_exemplar(CASES / "t_12in16_maxvalue.tif")
    stored = tifffile.imread(CASES / "t_12in16_maxvalue.tif")
    assert np.abs(made.pixels[..., 0] - stored / 4095).max() < 1e-6
    assert made.notes == ("The file declares 4095 as its largest value, which is taken for white.",)
    beyond = pages((np.uint16([[5000, 1], [2, 3]]), {"extratags": [(281, "H", 1, 4095, True)]}))
    assert as_exemplar(beyond).pixels.max() == np.float32(5000) / np.float32(65535)


@pytest.mark.parametrize("bits", [1, 4, 12])
def test_inks_of_any_depth(bits, monkeypatch):
    def packed(values, bits, **_):
        places = np.arange(bits - 1, -1, -1)
        return np.packbits(values.reshape(-1)[:, None].astype(np.uint16) >> places & 1).tobytes()

    # The oldest imagecodecs reads packed numbers and cannot write them.
    monkeypatch.setattr(imagecodecs, "packints_encode", packed)
    values = np.random.default_rng(6).integers(0, 2**bits, (16, 16, 4))
    dtype = bool if bits == 1 else np.uint8 if bits == 4 else np.uint16
    data = pages(
        (
            values.astype(dtype),
            {"photometric": "separated", "planarconfig": "contig", "bitspersample": bits},
        )
    )
    if bits == 1:
        # tifffile reads single bits in the standard's order, and writes them in another.
        with tifffile.TiffFile(io.BytesIO(data)) as file:
            start = file.pages[0].dataoffsets[0]
        values = np.unpackbits(np.frombuffer(data[start : start + 128], np.uint8)).reshape(values.shape)
    share = values / (2**bits - 1)
    right = (1 - share[..., :3]) * (1 - share[..., 3:])
    assert np.abs(as_exemplar(data).pixels - right).max() < 2 / 65535


def test_other_inks_than_cmyk():
    data = pages(
        (RGBA, {"photometric": "separated", "planarconfig": "contig", "extratags": [(332, "H", 1, 2, True)]})
    )
    with pytest.raises(ImageError, match="whose colours TexLab does not read"):
        as_exemplar(data)


@pytest.mark.parametrize("name", ["cmyk1.tif", "cmyk12.tif", "gray4_icc.tif", "gray12_icc.tif", "rgb12_adobe.tif"])
def test_odd_depths_stay_in_range(name):
    made = as_exemplar(CASES / name)
    assert made.pixels.min() >= 0
    assert made.pixels.max() <= 1
    assert made.pixels.std() > 0.05


def test_twelve_bits_are_converted_like_sixteen():
    twelve, sixteen = (tifffile.imread(CASES / f"rgb{bits}_adobe.tif") for bits in (12, 16))
    same = np.abs(twelve / 4095 - sixteen / 65535).max()
    made = [as_exemplar(CASES / f"rgb{bits}_adobe.tif").pixels for bits in (12, 16)]
    # The curve is at most 13 times as steep as the one it replaces.
    assert np.abs(made[0] - made[1]).max() < 20 * same + 1e-3


@pytest.mark.parametrize(("name", "key", "bits"), [("gray2_trns_key1", 1, 2), ("gray4_trns_key7", 7, 4)])
def test_transparent_grays_of_few_bits(name, key, bits):
    decoded = read_image(CASES / f"{name}.png", "a")
    levels = np.rint(decoded.values[..., 0] / 255 * (2**bits - 1))
    assert np.array_equal(decoded.values[..., 1] == 0, levels == key)
    assert (levels == key).any()
    assert (levels != key).any()


@pytest.mark.parametrize("name", ["rgb8_ztxt_3MB.png", "rgb8_itxt_3.6MB.png"])
def test_big_texts_do_not_matter(name):
    made = as_exemplar(CASES / name)
    assert made.size == (13, 21)
    assert made.notes == ()


def test_every_case_is_in_range_or_refused():
    """Whatever comes in, the promise of the door holds."""
    refused = []
    for file in sorted(CASES.iterdir()):
        try:
            made = as_exemplar(file)
        except ImageError:
            refused.append(file.name)
            continue
        assert np.isfinite(made.pixels).all()
        assert made.pixels.min() >= 0
        assert made.pixels.max() <= 1
        assert made.depth in (8, 16, "float")
    costly = [
        "tif_j2k_siz_100000.tif",
        "tif_jpeg2k_inner_20000.tif",
        "tif_jpegxl_inner_20000.tif",
        "webp_64MP.webp",
    ]
    assert refused == ["right.npy", *costly]
