"""Volumes in files: TIFF stacks with their axes, arrays, recipes in them, pictures and animations of them."""

from __future__ import annotations

import io
import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import tifffile
from PIL import Image

from texlab_core.contract.cases import check_sentence, texture
from texlab_core.documents.beside import sidecar
from texlab_core.documents.reading import read_recipe, recipe_text
from texlab_core.documents.record import check_result_format, save_maps, save_result, summary
from texlab_core.engine.job import Job
from texlab_core.engine.result import Result
from texlab_core.engine.run import run
from texlab_core.engine.steps import Map, Output
from texlab_core.errors import Cancelled, ImageError, InputError, RecipeError
from texlab_core.images.formats.animations import encode_animation
from texlab_core.images.formats.volumes import encode_volume, read_volume, volume_of
from texlab_core.solids.pictures import CUTS, Turn, Walk, cross_of, middle, panel, slice_at
from texlab_core.solids.rendering import View, render
from texlab_core.solids.shots import Shot, check_shot, frames, save_shot

if TYPE_CHECKING:
    from pathlib import Path

    from texlab_core.images.formats.writing import Bits


def volume(*shape: int) -> np.ndarray:
    return np.random.Generator(np.random.PCG64(len(shape))).random(shape, dtype=np.float32)


@pytest.fixture(scope="module")
def result() -> Result:
    return run(Job(method="solid", inputs={"exemplar": texture(20, 24)}, size=(5, 8, 12), seed=3))


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("depth", [1, 5])
@pytest.mark.parametrize(("bits", "error"), [(8, 0.5 / 255), (16, 0.5 / 65535), ("float", 0)])
def test_stacks_come_back_with_the_axes_of_imagej(
    tmp_path: Path, channels: int, depth: int, bits: Bits, error: float
) -> None:
    given, path = volume(depth, 6, 7, channels), tmp_path / "a.tif"
    path.write_bytes(encode_volume(path, given, bits=bits, info="é 漢"))
    assert np.abs(volume_of(read_volume(path)) - given).max() <= error + 1e-7
    with tifffile.TiffFile(path) as tiff:
        # The reader follows ImageJ's own description of its hyperstacks.
        assert tiff.is_imagej
        found = tiff.imagej_metadata
        assert found is not None
        assert found["Info"] == "é 漢"
        assert found.get("slices", 1) == depth
        separate = channels == 3 and bits != 8
        assert found.get("channels", 1) == (3 if separate else 1)
        assert tiff.series[0].axes == ("Z" if depth > 1 else "") + (
            "CYX" if separate else "YX" + "S" * (channels == 3)
        )
        assert len(tiff.pages) == depth * (3 if separate else 1)


def test_arrays_come_back(tmp_path: Path) -> None:
    given, path = volume(4, 5, 6, 3), tmp_path / "a.npy"
    path.write_bytes(encode_volume(path, given))
    np.testing.assert_array_equal(np.load(path), given)
    np.testing.assert_array_equal(volume_of(read_volume(path)), given)


@pytest.mark.parametrize(("name", "bits"), [("a.tif", 8), ("a.tiff", 16), ("a.tif", "float"), ("a.npy", None)])
def test_a_saved_solid_is_made_again_from_its_file(result: Result, tmp_path: Path, name: str, bits: Any) -> None:
    path = tmp_path / name
    save_result(result, path, bits=bits)
    assert sidecar(path).is_file() == (path.suffix == ".npy")
    recipe = read_recipe(path)
    assert recipe.size == (5, 8, 12)
    again = run(recipe.job())
    np.testing.assert_array_equal(again.volume, result.volume)
    assert json.loads(recipe_text(path) or "")["size"] == {"width": 12, "height": 8, "depth": 5}
    assert summary(again, path)["size"] == {"width": 12, "height": 8, "depth": 5}
    assert list(tmp_path.glob(".texlab*")) == []


def test_what_cannot_be_written_or_read_gets_one_sentence(result: Result, tmp_path: Path) -> None:
    (tmp_path / "no.tif").write_bytes(b"II*\0 this is no TIFF")
    (tmp_path / "no.npy").write_bytes(b"\x93NUMPY nor this an array")
    np.save(tmp_path / "flat.npy", np.zeros((4, 4)))
    np.save(tmp_path / "objects.npy", np.array([{}], dtype=object), allow_pickle=True)
    tifffile.imwrite(
        tmp_path / "time.tif", np.zeros((2, 3, 4, 5), np.uint8), imagej=True, metadata={"axes": "TZYX"}
    )
    np.save(tmp_path / "wild.npy", np.full((2, 2, 2, 1), 7, np.float32))
    good = volume(2, 3, 4, 1)
    for make, words in (
        (lambda: save_result(result, tmp_path / "a.png"), "solids are written as .tif, .tiff, .npy, got '.png'"),
        (lambda: save_result(result, ""), "empty"),
        (lambda: save_result(result, tmp_path / "a.npy", bits=8), "must be float"),
        (lambda: encode_volume("a.tif", good[..., 0]), "a solid to write is"),
        (lambda: encode_volume("a.tif", good * np.nan), "not finite"),
        (lambda: read_volume(tmp_path / "missing.tif"), "cannot be opened"),
        *(
            (lambda name=name: read_volume(tmp_path / name), "is no solid that TexLab saved")
            for name in ("no.tif", "no.npy", "flat.npy", "objects.npy", "time.tif")
        ),
        (lambda: volume_of(read_volume(tmp_path / "wild.npy")), "values from 0 to 1"),
    ):
        with pytest.raises(ImageError, match=words) as caught:
            make()
        check_sentence(str(caught.value), "the refusal")
    assert check_result_format("a.tif", None, 3) == ".tif"
    assert recipe_text(tmp_path / "flat.npy") is None


@pytest.mark.parametrize("size", [{"width": 4, "height": 4}, {"width": 4, "height": 4, "depth": 0}, {"depth": 3}])
def test_a_recipe_without_its_three_sides_is_refused(result: Result, tmp_path: Path, size: dict[str, int]) -> None:
    save_result(result, tmp_path / "a.npy")
    recipe = json.loads(sidecar(tmp_path / "a.npy").read_text()) | {"size": size}
    with pytest.raises(RecipeError, match="size: must be"):
        read_recipe(json.dumps(recipe).encode())


def test_an_output_of_a_volume_shows_its_middle_slice() -> None:
    given = volume(5, 3, 4, 1)
    output = Output(volume=given)
    np.testing.assert_array_equal(output.image, given[2])
    assert not np.shares_memory(output.image, given)
    with pytest.raises(TypeError, match="an image or a volume"):
        Output()


def test_maps_of_a_volume_are_saved_whole_and_shown_in_the_middle(result: Result, tmp_path: Path) -> None:
    source = np.zeros((5, 8, 12, 2), np.int32)
    source[2, 3, 4] = (19, 23)
    count = np.arange(5 * 8 * 12).reshape(5, 8, 12)
    maps = {"source": Map(source, "source", "Source"), "count": Map(count, "count", "Count")}
    changed = Result(**{**{name: getattr(result, name) for name in result.__dataclass_fields__}, "maps": maps})
    save_maps(changed, tmp_path)
    np.testing.assert_array_equal(np.load(tmp_path / "count.npy"), count)
    np.testing.assert_array_equal(maps["count"].plane.data, count[2])
    assert maps["source"].plane.data.shape == (8, 12, 2)
    flat = Map(count[0], "count", "Count")
    assert flat.plane is flat
    with Image.open(tmp_path / "source.png") as picture:
        assert picture.size == (12, 8)
        assert picture.getpixel((4, 3)) == (255, 255, 96)


def test_slices_cut_where_they_say() -> None:
    given = volume(4, 5, 6, 1)
    place = (1, 2, 3)
    for cut in CUTS:
        row, column = cross_of(cut, place)
        assert slice_at(given, cut, place)[row, column, 0] == given[place][0]
    assert slice_at(given, "yz", place).shape == (5, 4, 1)
    assert middle(given.shape) == (2, 2, 3)


def test_the_panel_shows_three_linked_slices_and_the_object() -> None:
    given = volume(40, 50, 60, 3)
    drawn = panel(given, View("sphere"), (10, 20, 30))
    # Magnified five times; the gap is 6 wide.
    assert drawn.shape == (50 * 5 + 6 + 40 * 5, 60 * 5 + 6 + 40 * 5, 3)
    expected = np.rint(given[10, 7, 9] * 255)
    np.testing.assert_array_equal(drawn[7 * 5, 9 * 5], expected)
    np.testing.assert_array_equal(drawn[20 * 5 + 2, 4], (255, 176, 32))
    np.testing.assert_array_equal(drawn[-200:, -200:], render(given, View("sphere"), (200, 200), smooth=True))


@pytest.mark.parametrize("name", ["a.png", "a.apng", "a.gif", "a.webp"])
@pytest.mark.parametrize("motion", [Turn(4), Walk("yz")], ids=str)
def test_animations_have_all_frames_and_the_recipe(
    result: Result, tmp_path: Path, name: str, motion: Turn | Walk
) -> None:
    save_result(result, tmp_path / "a.tif")
    recipe, path, shot = recipe_text(tmp_path / "a.tif"), tmp_path / name, Shot(motion=motion, side=32, rate=10)
    assert result.volume is not None
    save_shot(path, result.volume, shot, recipe=recipe)
    with Image.open(path) as picture:
        assert picture.n_frames == (4 if isinstance(motion, Turn) else 12)
        assert picture.info.get("loop") == 0
        picture.seek(1)
        picture.load()
        assert picture.info["duration"] == 100
        shown = np.asarray(picture.convert("RGB")).astype(int)
    wanted = list(frames(result.volume, shot))[1].astype(int)
    assert np.abs(shown - wanted).mean() < {".png": 1e-9, ".apng": 1e-9}.get(path.suffix, 12)
    np.testing.assert_array_equal(run(read_recipe(path).job()).volume, result.volume)


def test_a_picture_beside_the_wrapped_exemplar(result: Result, tmp_path: Path) -> None:
    assert result.volume is not None
    save_shot(tmp_path / "a.png", result.volume, Shot("both", side=48), exemplar=texture(20, 24).pixels)
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (48 + 6 + 48, 48)
    with pytest.raises(InputError, match="exemplar is needed"):
        save_shot(tmp_path / "b.png", result.volume, Shot("both", side=48))


def test_shots_that_cannot_be_get_one_sentence(result: Result) -> None:
    assert result.volume is not None
    for make, words in (
        (lambda: Shot("nothing"), "show: must be"),  # type: ignore[arg-type]
        (lambda: Shot(side=3), "side: must be"),
        (lambda: Shot("slices", motion=Turn()), "not an animation"),
        (lambda: Turn(1), "frames: must be"),
        (lambda: Walk("zx"), "cut: must be"),  # type: ignore[arg-type]
        (lambda: check_shot("a.gif", Shot()), "is written as .png"),
        (lambda: check_shot("a.mp4", Shot(motion=Turn())), "animations are written as"),
        (lambda: check_shot("a.gif", Shot(motion=Turn(), rate=0)), "rate: must be"),
        (
            lambda: list(frames(result.volume, Shot("slices", place=(0, 8, 0)))),
            "must lie in the solid of 12 x 8 x 5",
        ),
    ):
        with pytest.raises(InputError, match=words) as caught:
            make()
        check_sentence(str(caught.value), "the refusal")
    with pytest.raises(ValueError, match="at least one frame"):
        encode_animation("a.gif", [])
    with pytest.raises(ValueError, match="takes no text"):
        encode_animation("a.gif", [np.zeros((2, 2, 3), np.uint8)], text={"a": "b"})


def test_an_animation_can_be_stopped(result: Result) -> None:
    asked = iter(range(100))

    def look() -> None:
        if next(asked) > 3:
            raise Cancelled

    assert result.volume is not None
    shot = Shot(motion=Turn(30), side=32)
    with pytest.raises(Cancelled):
        encode_animation("a.gif", frames(result.volume, shot, look=look), look=look)


def test_the_stack_is_what_pillow_reads_too(tmp_path: Path) -> None:
    given = volume(3, 4, 5, 3)
    with Image.open(io.BytesIO(encode_volume("a.tif", given))) as picture:
        picture.seek(2)
        np.testing.assert_array_equal(np.asarray(picture), np.rint(given[2] * 255))
