"""Files for other programs, and back: TIFFs that all of them read, depth, transparency, names, large pictures."""

import io
import struct
import zlib
from pathlib import Path

import cv2
import imagecodecs
import numpy as np
import pytest
import tifffile
from PIL import Image

from texlab_core.documents.record import carried_alpha, read_recipe, result_bits, save_maps, save_result
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import ImageError, NoRecipeError, TooLargeError
from texlab_core.images import exemplar as door
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats import decoded, jpeg, webp_text
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.tiff_reducing import _starts
from texlab_core.images.formats.writing import default_bits, encode_image, named_with_suffix, write_image
from texlab_core.images.reducing import area_weights

CASES = Path(__file__).parents[1] / "data" / "images"
NOISE = np.random.default_rng(0).random((24, 20, 3)).astype(np.float32)
ALPHA = np.random.default_rng(1).random((24, 20, 1)).astype(np.float32)


def made_of(exemplar, method="pixels"):
    return run(Job(method=method, inputs={"exemplar": exemplar}, size=(24, 20), seed=1))


# TIFF.


def readers():
    """Each program that is installed, as a function from path to array; None for what it does not do."""
    found = {
        "tifffile": tifffile.imread,
        "OpenCV": lambda path: cv2.imread(str(path), cv2.IMREAD_UNCHANGED)[..., ::-1],
        "Pillow": lambda path: np.asarray(Image.open(path)),
        "TexLab": lambda path: read_image(path, "a").values,
    }
    try:
        import imageio.v3

        found["imageio"] = imageio.v3.imread
    except ImportError:
        pass
    try:
        import skimage.io

        found["scikit-image"] = skimage.io.imread
    except ImportError:
        pass
    return found


@pytest.mark.parametrize("bits", [8, 16, "float"])
@pytest.mark.parametrize("name", readers())
def test_results_in_tiff_open_everywhere(name, bits, tmp_path):
    path = tmp_path / "result.tif"
    # Pillow knows floats in one channel only.
    exemplar = as_exemplar(NOISE[..., :1] if name == "Pillow" and bits == "float" else NOISE)
    result = made_of(exemplar)
    save_result(result, path, bits=bits)
    values = readers()[name](path)
    right = result.image if bits == "float" else np.rint(result.image.astype(np.float64) * (2**bits - 1))
    if name == "Pillow" and bits == 16:
        # It keeps the higher byte.
        right = right // 256
    assert np.array_equal(values.reshape(right.shape), right)
    assert read_recipe(path).seed == 1


def test_maps_open_everywhere(tmp_path):
    result = made_of(as_exemplar(NOISE))
    for path in save_maps(result, tmp_path / "maps"):
        if path.suffix == ".png":
            for name, read in readers().items():
                if name not in ("tifffile", "OpenCV"):
                    assert read(path).shape[:2] == (24, 20)
        if path.suffix == ".npy":
            assert np.load(path).shape[:2] == (24, 20)


def test_the_description_does_not_look_like_one_of_tifffile(tmp_path):
    path = tmp_path / "a.tif"
    save_result(made_of(as_exemplar(NOISE)), path)
    with tifffile.TiffFile(path) as tiff:
        assert not tiff.is_shaped
        assert tiff.pages[0].description.startswith('TexLab {"texlab":1,')


def test_results_of_the_first_version_are_still_read():
    assert read_recipe(CASES / "el.tif").method == "efros-leung"


def test_descriptions_of_other_programs_are_no_recipes(tmp_path):
    with pytest.raises(NoRecipeError):
        read_recipe(CASES / "plain_tifffile.tif")
    assert as_exemplar(CASES / "plain_tifffile.tif").size == (32, 32)
    for text in ('{"shape": [3, 4]}', '{"Texlab": 1}', "TexLab makes textures", "{"):
        path = tmp_path / "a.tif"
        tifffile.imwrite(path, np.zeros((4, 4), np.uint8), description=text, metadata=None)
        with pytest.raises(NoRecipeError):
            read_recipe(path)


# Texts that another program has compressed.


def compressed_texts(png):
    """What ImageMagick does to a file: every text chunk compressed."""
    parts, position = [png[:8]], 8
    while position < len(png):
        (length,) = struct.unpack_from(">I", png, position)
        kind, body = png[position + 4 : position + 8], png[position + 8 : position + 8 + length]
        position += 12 + length
        if kind == b"tEXt":
            key, _, text = body.partition(b"\0")
            kind, body = b"zTXt", key + b"\0\0" + zlib.compress(text)
        parts.append(struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)))
    return b"".join(parts)


def test_a_result_with_compressed_text_can_be_opened_and_redone(tmp_path):
    # An exemplar that makes a recipe of more than a megabyte, which is where decoders used to stop.
    exemplar = as_exemplar(np.random.default_rng(2).integers(0, 256, (800, 600, 3), dtype=np.uint8))
    result = run(Job(method="pixels", inputs={"exemplar": exemplar}, size=(16, 16), seed=3))
    path = tmp_path / "a.png"
    save_result(result, path)
    path.write_bytes(compressed_texts(path.read_bytes()))
    assert b"zTXt" in path.read_bytes()
    recipe = read_recipe(path)
    assert len(str(recipe.inputs["exemplar"].content)) > 2**20
    again = run(recipe.job())
    assert np.array_equal(again.image, result.image)
    assert np.array_equal(read_image(path, "a").values, np.rint(255 * result.image.astype(np.float64)))


# Depth.

DEPTHS = {
    8: np.random.default_rng(3).integers(0, 256, (24, 20, 3), dtype=np.uint8),
    16: np.random.default_rng(3).integers(0, 65536, (24, 20, 3), dtype=np.uint16),
    "float": NOISE,
}


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize(
    ("name", "most"), [("a.png", 16), ("a.tif", "float"), ("a.TIFF", "float"), ("a.jpg", 8), ("a.webp", 8)]
)
def test_results_are_saved_as_deep_as_their_exemplar(depth, name, most, tmp_path):
    exemplar = as_exemplar(DEPTHS[depth])
    assert exemplar.depth == depth
    result = made_of(exemplar)
    order = (8, 16, "float")
    right = order[min(order.index(depth), order.index(most))]
    assert result_bits(result, name) == default_bits(name, depth) == right
    save_result(result, tmp_path / name)
    assert as_exemplar(tmp_path / name).depth == right
    # A recipe keeps it.
    assert read_recipe(tmp_path / name).job().inputs["exemplar"].depth == depth


def test_saved_png_says_srgb():
    data = encode_image("a.png", NOISE)
    place = data.index(b"sRGB")
    assert data[place - 4 : place + 5] == b"\0\0\0\x01sRGB\0"
    assert place < data.index(b"IDAT")
    assert Image.open(io.BytesIO(data)).info["srgb"] == 0


def test_webp_is_without_loss_and_holds_its_recipe(tmp_path):
    path = tmp_path / "a.webp"
    result = made_of(as_exemplar(DEPTHS[8]))
    save_result(result, path)
    stored = np.asarray(Image.open(path))
    assert np.array_equal(stored, np.rint(255 * result.image.astype(np.float64)))
    assert read_recipe(path).seed == 1
    assert read_recipe(path.read_bytes()).seed == 1
    assert [each.name for each in tmp_path.iterdir()] == ["a.webp"]
    for channels in (1, 2, 3, 4):
        values = np.random.default_rng(channels).integers(0, 256, (7, 5, channels)).astype(np.uint8)
        floats = values / np.float32(255)
        alpha = floats[..., -1] if channels % 2 == 0 else None
        colours = floats[..., : channels - 1 + channels % 2]
        texts = {"key": "x" * 101, "other": "Wände"}
        data = encode_image("a.webp", colours, text=texts, alpha=alpha)
        # Other programs read it as ever: Pillow and OpenCV.
        shown = np.asarray(Image.open(io.BytesIO(data)))
        assert np.array_equal(shown[..., 0], values[..., 0])
        assert shown.shape[2] == 4 - channels % 2
        assert channels % 2 or np.array_equal(shown[..., 3], values[..., -1])
        assert cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED).shape[:2] == (7, 5)
        assert as_exemplar(data).size == (7, 5)
        for key, text in texts.items():
            assert webp_text.read_text(io.BytesIO(data), key, 200) == text.encode()
        assert webp_text.read_text(io.BytesIO(data), "none", 200) is None
        with pytest.raises(ValueError, match="is longer than 100 bytes"):
            webp_text.read_text(io.BytesIO(data), "key", 100)
        with pytest.raises(ValueError, match="is damaged"):
            webp_text.read_text(io.BytesIO(data[:-3]), "other", 200)
    gray = encode_image("a.webp", NOISE[..., 0])
    assert np.array_equal(as_exemplar(gray).pixels, as_exemplar(encode_image("a.png", NOISE[..., 0])).pixels)
    with pytest.raises(ImageError, match="a WebP file has at most 16383 pixels in a side, got 16384 x 2"):
        encode_image("a.webp", np.zeros((2, 16384)))


@pytest.mark.parametrize(
    ("given", "suffix", "right"),
    [
        ("name.v2", ".png", "name.v2.png"),
        ("name", ".tif", "name.tif"),
        ("name.PNG", ".tif", "name.PNG"),
        ("a.b/name.jpeg", ".png", "a.b/name.jpeg"),
        ("v1.5", ".webp", "v1.5.webp"),
    ],
)
def test_names_keep_what_follows_a_dot(given, suffix, right):
    assert named_with_suffix(given, suffix) == Path(right)


# Transparency.


@pytest.mark.parametrize("name", ["a.png", "b.tif", "c.webp"])
@pytest.mark.parametrize("channels", [1, 3])
def test_alpha_is_written(name, channels, tmp_path):
    write_image(tmp_path / name, NOISE[..., :channels], alpha=ALPHA)
    made = as_exemplar(tmp_path / name, alpha="keep")
    assert made.channels == channels
    assert np.array_equal(np.rint(255 * made.pixels), np.rint(255 * NOISE[..., :channels].astype(np.float64)))
    assert np.array_equal(np.rint(255 * made.alpha), np.rint(255 * ALPHA.astype(np.float64)))


@pytest.mark.parametrize(
    ("name", "alpha", "says"),
    [
        ("a.jpg", ALPHA, "a.jpg: a JPEG file holds no transparency; choose PNG, TIFF or WebP."),
        ("a.png", ALPHA[1:], "a.png: the transparency must be as large as the image, got (23, 20, 1)."),
        (
            "a.png",
            ALPHA * np.nan,
            "a.png: the transparency has values that are not finite, and cannot be written.",
        ),
    ],
)
def test_alpha_that_cannot_be_written(name, alpha, says):
    with pytest.raises(ImageError) as caught:
        encode_image(name, NOISE, alpha=alpha)
    assert str(caught.value) == says


@pytest.mark.parametrize("method", ["pixels", "tiling"])
def test_alpha_follows_the_source_map(method, tmp_path):
    exemplar = as_exemplar(np.dstack([NOISE, ALPHA]), alpha="keep")
    result = made_of(exemplar, method)
    source = result.maps["source"].data
    right = ALPHA[source[..., 0], source[..., 1]]
    assert np.array_equal(carried_alpha(result), right)
    # Where colour comes from, transparency comes from.
    assert np.array_equal(result.image, NOISE[source[..., 0], source[..., 1]])
    save_result(result, tmp_path / "a.tif", alpha=carried_alpha(result))
    stored = as_exemplar(tmp_path / "a.tif", alpha="keep")
    assert np.array_equal(stored.alpha, right)
    again = run(read_recipe(tmp_path / "a.tif").job())
    assert np.array_equal(carried_alpha(again), right)


def test_alpha_needs_places_and_alpha():
    assert carried_alpha(made_of(as_exemplar(NOISE))) is None
    kept = as_exemplar(np.dstack([NOISE, ALPHA]), alpha="keep")
    assert carried_alpha(made_of(kept, "heeger-bergen")) is None


def test_recipes_find_the_image_whatever_was_done_with_its_transparency(tmp_path):
    path = tmp_path / "a.png"
    write_image(path, NOISE, alpha=ALPHA)
    for reading in ({}, {"alpha": "ignore"}, {"alpha": "keep"}, {"background": 0.0}):
        exemplar = as_exemplar(path, **reading)
        out = tmp_path / "out.png"
        save_result(made_of(exemplar), out)
        assert read_recipe(out).job(path).inputs["exemplar"].sha256 == exemplar.sha256


@pytest.mark.parametrize(
    "values", [NOISE * 40 - 3, np.dstack([np.full((24, 20, 3), 0.3), np.full((24, 20), 254 / 255)])]
)
def test_recipes_of_the_first_version_find_what_is_read_otherwise_today(values, tmp_path):
    path = tmp_path / "a.tif"
    tifffile.imwrite(path, values.astype(np.float32), photometric="rgb", metadata=None)
    stored = values.astype(np.float32)
    if values.shape[2] == 3:
        low, high = (float(each) for each in (stored.min(), stored.max()))
        then = np.clip((stored.astype(np.float64) / 2 - low / 2) / (high / 2 - low / 2), 0, 1).astype(np.float32)
    else:
        alpha = stored[..., 3:]
        then = (stored[..., :3] * alpha + (1 - alpha)).clip(0, 1)
    exemplar = as_exemplar(then)
    assert as_exemplar(path).sha256 != exemplar.sha256
    out = tmp_path / "out.png"
    save_result(made_of(exemplar), out)
    assert read_recipe(out).job(path).inputs["exemplar"].sha256 == exemplar.sha256


# Pictures that are too large to be kept whole.


@pytest.mark.parametrize(("length", "target"), [(10, 10), (10, 3), (7, 5), (100, 1), (9, 9), (12, 4), (5, 4)])
def test_area_weights_by_hand(length, target):
    fine = 1000
    weights = area_weights(length, target).toarray()
    signal = np.random.default_rng(length).random(length)
    # The mean of each new pixel over a fine grid.
    places = (np.arange(target * fine) + 0.5) / (target * fine) * length
    right = signal[places.astype(int)].reshape(target, fine).mean(axis=1)
    assert np.abs(weights.sum(axis=1) - 1).max() < 1e-12
    assert np.abs(weights @ signal - right).max() < 2e-3


@pytest.fixture
def small_limits(monkeypatch):
    """All limits of pixels, much lower."""
    monkeypatch.setattr(decoded, "MAX_PIXELS", 1000)
    monkeypatch.setattr(door, "MAX_PIXELS", 1000)
    monkeypatch.setattr(decoded, "MAX_REDUCED", 8000)
    monkeypatch.setattr(jpeg, "MAX_REDUCED", 8000)
    monkeypatch.setattr("texlab_core.images.formats.tiff_reducing.MAX_REDUCED", 8000)
    monkeypatch.setattr("texlab_core.images.unit_range._ROWS_BYTES", 3000)


LARGE = np.random.default_rng(5).integers(0, 256, (60, 80, 4), dtype=np.uint8)


@pytest.mark.parametrize("scale", [0.4, 0.25, 0.37])
@pytest.mark.parametrize("crop", [None, Crop(2, 3, 10, 12)])
@pytest.mark.parametrize("alpha", ["background", "ignore", "keep"])
def test_a_reduced_reading_is_the_area_mean(scale, crop, alpha, monkeypatch, request):
    data = imagecodecs.png_encode(LARGE)
    right = as_exemplar(data, scale=scale, crop=crop, alpha=alpha)
    request.getfixturevalue("small_limits")
    with pytest.raises(TooLargeError, match="a scale or a crop makes a larger one fit"):
        as_exemplar(data)
    made = as_exemplar(data, scale=scale, crop=crop, alpha=alpha)
    assert made.size == right.size
    assert np.abs(made.pixels - right.pixels).max() < 2e-6
    if alpha == "keep":
        assert np.abs(made.alpha - right.alpha).max() < 2e-6
    assert made.origin.taken == (scale, crop)
    assert "is too large to be kept whole" in made.notes[-1]


def test_a_crop_of_a_large_picture_is_exact(small_limits, tmp_path):
    path = tmp_path / "large.png"
    path.write_bytes(imagecodecs.png_encode(np.ascontiguousarray(LARGE[..., :3])))
    made = as_exemplar(path, crop=Crop(30, 40, 20, 24))
    assert np.array_equal(np.rint(255 * made.pixels), LARGE[30:50, 40:64, :3])
    with pytest.raises(ImageError, match="the crop must lie inside the scaled image of 80 x 60 pixels"):
        as_exemplar(path, crop=Crop(50, 40, 20, 24))
    with pytest.raises(ImageError, match="at most 0 megapixels are read"):
        as_exemplar(path, crop=Crop(0, 0, 50, 50))
    # The recipe knows how it was read.
    save_result(made_of(made), tmp_path / "out.png")
    recipe = read_recipe(tmp_path / "out.png")
    assert recipe.inputs["exemplar"].taken == (1.0, Crop(30, 40, 20, 24))
    assert recipe.job(path).inputs["exemplar"].sha256 == made.sha256
    assert recipe.job().inputs["exemplar"].sha256 == made.sha256


def test_pictures_beyond_all_limits(small_limits):
    with pytest.raises(
        ImageError, match="the image has 100 x 100 pixels; at most 0 megapixels are scaled down or crop"
    ):
        as_exemplar(imagecodecs.png_encode(np.zeros((100, 100), np.uint8)), scale=0.1)


def test_jpeg_comes_down_in_its_decoder(small_limits):
    rows, columns = np.mgrid[:160, :200]
    smooth = np.stack([rows, columns, 255 - rows], axis=2).astype(np.uint8)
    out = io.BytesIO()
    Image.fromarray(smooth).save(out, "JPEG", quality=97, subsampling=0)
    made = as_exemplar(out.getvalue(), scale=0.1)
    right = smooth.reshape(16, 10, 20, 10, 3).mean(axis=(1, 3)) / 255
    assert made.size == (16, 20)
    assert np.abs(made.pixels - right).max() < 0.02
    with pytest.raises(ImageError, match="are scaled down or cropped"):
        as_exemplar(out.getvalue(), scale=0.6)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize(
    "options", [{"tile": (32, 48)}, {"rowsperstrip": 7}, {"tile": (16, 16), "compression": "zlib"}]
)
@pytest.mark.parametrize("photometric", ["rgb", "minisblack", "miniswhite"])
def test_tiff_comes_down_part_by_part(dtype, options, photometric, small_limits):
    peak = np.iinfo(dtype).max
    channels = 3 if photometric == "rgb" else 1
    values = np.random.default_rng(7).integers(0, peak, (160, 200, channels), dtype=dtype, endpoint=True)
    out = io.BytesIO()
    stored = values if channels == 3 else values[..., 0]
    tifffile.imwrite(out, stored, photometric=photometric, metadata=None, **options)
    made = as_exemplar(out.getvalue(), scale=0.1)
    right = values.reshape(16, 10, 20, 10, channels).mean(axis=(1, 3)) / peak
    assert made.size == (16, 20)
    # Halves of the picture are averaged in integers of 16 bits.
    assert np.abs(made.pixels - (1 - right if photometric == "miniswhite" else right)).max() < 2e-5
    assert made.depth == (8 if dtype == np.uint8 else 16)
    turned = io.BytesIO()
    tifffile.imwrite(turned, stored, photometric=photometric, metadata=None, extratags=[(274, "H", 1, 6, True)])
    assert as_exemplar(turned.getvalue(), scale=0.1).size == (20, 16)
    with pytest.raises(ImageError, match="are scaled down or cropped"):
        as_exemplar(out.getvalue(), scale=0.6)


@pytest.mark.parametrize(("first", "count", "factor"), [(0, 7, 3), (5, 9, 4), (8, 4, 4), (3, 2, 5)])
def test_block_starts_by_hand(first, count, factor):
    blocks = (first + np.arange(count)) // factor
    right = [index for index in range(count) if index == 0 or blocks[index] != blocks[index - 1]]
    assert _starts(first, count, factor).tolist() == right


def test_what_is_used_of_a_picture_is_said():
    made = as_exemplar(np.random.default_rng(6).random((60, 80)), scale=0.25)
    said = "The picture of 80 x 60 pixels is used at 25 %, as 20 x 15 pixels."
    assert made.notes == (said,)
    again = as_exemplar(made, scale=0.5)
    assert again.notes == ("The picture of 80 x 60 pixels is used at 50 %, as 40 x 30 pixels.",)
    assert as_exemplar(again, scale=1.0, crop=Crop(0, 0, 9, 9)).notes == ()
