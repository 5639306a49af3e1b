"""Export: any selection, names by a pattern, depth by the exemplar, sets whole or not at all, animations."""

from __future__ import annotations

import io
import json
import os
import re
from pathlib import Path

import cv2
import imagecodecs
import numpy as np
import pytest
from PIL import Image

from texlab_core.documents.record import read_recipe
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, ImageError, InputError, ParamError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.modern import jxl_distance
from texlab_core.images.formats.movies import encode_movie
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.writing import encode_image
from texlab_core.sheets.export import Export, Item, export_tiles, planned, run_export, run_items, selection
from texlab_core.sheets.export_animation import (
    Animation,
    animation_of,
    check_animation_target,
    draw_frames,
    write_animation,
)
from texlab_core.sheets.export_names import Named, file_stems, parse_seeds, parse_sizes, safe_part
from texlab_core.sheets.figure import Figure, figure_page

RANDOM = np.random.default_rng(5)
DEEP = RANDOM.integers(0, 65536, (48, 40, 3), np.uint16)


def job(method="tiling", size=(32, 24), seed=3, pixels=None, name="wall v2.final.png"):
    exemplar = as_exemplar(DEEP[:32, :32] if pixels is None else pixels, name=name)
    return Job(method=method, inputs={"exemplar": exemplar}, size=size, seed=seed)


# Names and selections.


def test_seeds_and_sizes_are_read():
    assert parse_seeds("3") == (3,)
    assert parse_seeds(" 1..4, 9,2 ") == parse_seeds("1-4,9") == parse_seeds("1 \u2013 4, 9") == (1, 2, 3, 4, 9)
    assert parse_sizes("64x48, 32X32,64x48") == ((48, 64), (32, 32))
    assert parse_sizes("64x48x8", 3) == ((8, 48, 64),)
    # One number is a square, or a cube.
    assert parse_sizes("64, 48 x 32") == ((64, 64), (32, 48))
    assert parse_sizes("16", 3) == ((16, 16, 16),)
    for wrong in ("", "a", "4..1", "4-1", "1..", "1-", "-1", "0..1000", "2147483648", "1,,2"):
        with pytest.raises(ParamError, match="seeds: must be whole numbers"):
            parse_seeds(wrong)
    for wrong in ("", "-64", "64x", "0x4", "64x48x8"):
        with pytest.raises(ParamError, match=f"sizes: must be width and height as in 256x192.*got '{wrong}'"):
            parse_sizes(wrong)
    with pytest.raises(ParamError, match="sizes: must be at most 64 sizes"):
        parse_sizes(",".join(f"{side}x9" for side in range(1, 70)))


def test_a_pattern_names_the_files():
    named = [Named(job(seed=seed), "De Bonet: α/k") for seed in (1, 12)]
    stems = file_stems("{name}_{method}_{size}_{width}x{height}_{seed}_{index}_{title}", named)
    assert stems == (
        "wall v2.final_tiling_24x32_24x32_1_1_De Bonet- α-k",
        "wall v2.final_tiling_24x32_24x32_12_2_De Bonet- α-k",
    )
    assert file_stems("{index}", named * 6)[:2] == ("01", "02")


@pytest.mark.parametrize(
    "pattern", ["", " ", "{nmae}", "{seed!r}", "{seed:9999}", "{", "{}", "a/b", "..\\a", "a" * 201]
)
def test_a_pattern_that_cannot_be_is_refused(pattern):
    with pytest.raises(ParamError, match="name: must be"):
        file_stems(pattern, [Named(job(), "t")])


@pytest.mark.parametrize(
    ("pattern", "others", "missing"),
    [
        ("{name}", {"seed": 4}, "{seed} or {index}"),
        ("{seed}", {"size": (16, 16)}, "{size} or {index}"),
        ("{seed}", {"method": "pixels"}, "{method} or {index}"),
        ("{seed}", {}, "{index}"),
    ],
)
def test_two_files_with_one_name_are_refused_and_what_to_add_is_said(pattern, others, missing):
    with pytest.raises(InputError, match=f"add {re.escape(missing)}"):
        file_stems(pattern, [Named(job(), "t"), Named(job(**others), "t")])


@pytest.mark.parametrize(
    "name",
    [
        "../../etc/passwd",
        "C:\\x\\y",
        "a\0b\nc",
        "con",
        "...",
        "   ",
        "x" * 400,
        "{seed}",
        "\u202egnp.exe",
        "草" * 90,
    ],
)
def test_names_from_outside_stay_in_the_folder(tmp_path, name):
    (path,) = planned(Export(tmp_path), [Item(job(name=name))])
    assert path.parent == tmp_path
    assert len(path.name.encode()) < 255
    assert path.name.isprintable()
    assert not set(path.name) & set('\\/:*?"<>|')
    assert safe_part(name)


def test_every_seed_and_size_of_every_job_is_selected():
    first = run(job())
    items = selection([Item(first.job, "A", first), Item(job("pixels"), "B")], (3, 4), ((32, 24), (16, 16)))
    assert [(each.title, each.job.size, each.job.seed) for each in items] == [
        (title, size, seed) for title in "AB" for size in ((32, 24), (16, 16)) for seed in (3, 4)
    ]
    assert [each.result is not None for each in items] == [True] + [False] * 7
    with pytest.raises(InputError, match="at most 1000 files"):
        selection([Item(job())] * 2, tuple(range(600)))


# Files.


def test_a_16_bit_exemplar_gives_16_bit_files(tmp_path):
    (path,) = run_export(Export(tmp_path), [Item(job())])
    found = read_image(path, "a")
    assert found.peak == 65535
    assert len(np.unique(found.values)) > 256
    np.testing.assert_array_equal(found.values, np.rint(run(job()).image.astype(np.float64) * 65535))
    (path,) = run_export(Export(tmp_path, bits=8), [Item(job())])
    assert read_image(path, "a").peak == 255


@pytest.mark.parametrize("suffix", [".png", ".tif", ".webp", ".jpg", ".avif", ".jxl"])
@pytest.mark.parametrize("recipe", ["inside", "beside", "none"])
def test_every_format_has_its_recipe_where_it_was_asked_for(tmp_path, suffix, recipe):
    (path,) = run_export(Export(tmp_path, suffix=suffix, recipe=recipe), [Item(job())])
    beside = Path(f"{path}.texlab.json")
    assert beside.exists() == (recipe == "beside" or (recipe == "inside" and suffix in (".avif", ".jxl")))
    if recipe == "none":
        with pytest.raises(InputError, match="holds no recipe"):
            read_recipe(path)
        return
    if recipe == "beside" and suffix in (".png", ".tif", ".jpg"):
        path = beside
    again = read_recipe(path).job()
    assert (again.seed, again.size, again.method) == (3, (32, 24), "tiling")
    assert again.inputs["exemplar"].sha256 == job().inputs["exemplar"].sha256


LOSSLESS = {".webp": imagecodecs.webp_decode, ".avif": imagecodecs.avif_decode, ".jxl": imagecodecs.jpegxl_decode}


@pytest.mark.parametrize("suffix", LOSSLESS)
@pytest.mark.parametrize("channels", [1, 3])
def test_without_a_quality_nothing_is_lost(suffix, channels):
    values = RANDOM.integers(0, 256, (30, 34, channels), np.uint8)
    found = LOSSLESS[suffix](encode_image(f"a{suffix}", values / np.float32(255)))
    found = found.reshape(30, 34, -1)[..., :channels]
    np.testing.assert_array_equal(found, values)


@pytest.mark.parametrize("suffix", [*LOSSLESS, ".jpg"])
def test_a_lower_quality_is_smaller_and_farther(suffix):
    ramp = np.add.outer(np.arange(96), np.arange(80)) / 174
    pixels = np.stack([ramp, 1 - ramp, ramp**2], axis=2) + 0.1 * RANDOM.random((96, 80, 3))
    pixels = np.clip(pixels, 0, 1).astype(np.float32)
    sizes, errors = [], []
    for quality in (95, 40):
        data = encode_image(f"a{suffix}", pixels, quality=quality)
        found = read_image(data, f"a{suffix}").values / 255
        sizes.append(len(data))
        errors.append(float(np.abs(found - pixels).mean()))
    assert sizes[1] < sizes[0]
    assert errors[0] < errors[1] < 0.1


def test_deep_and_float_jpeg_xl_is_exact():
    data = encode_image("a.jxl", DEEP / 65535, bits=16)
    np.testing.assert_array_equal(imagecodecs.jpegxl_decode(data), DEEP)
    floats = RANDOM.random((9, 8, 3)).astype(np.float32)
    np.testing.assert_array_equal(imagecodecs.jpegxl_decode(encode_image("a.jxl", floats, bits="float")), floats)


def test_a_distance_falls_with_the_quality():
    distances = [jxl_distance(quality) for quality in range(1, 101)]
    assert distances == sorted(distances, reverse=True)
    assert distances[0] == pytest.approx(15)
    assert distances[-1] == pytest.approx(0.1)
    assert jxl_distance(29) - jxl_distance(30) < 0.4


def test_a_missing_codec_is_one_sentence(monkeypatch):
    monkeypatch.setattr(imagecodecs.AVIF, "available", False)
    with pytest.raises(ImageError, match=r"^a\.avif: the installed imagecodecs has no codec for AVIF; choose PNG"):
        encode_image("a.avif", np.zeros((4, 4, 3), np.float32))


def test_transparency_comes_along(tmp_path):
    pixels = RANDOM.integers(0, 256, (16, 16, 4), np.uint8)
    inputs = {"exemplar": as_exemplar(pixels, alpha="keep", name="a")}
    made = Job(method="tiling", inputs=inputs, size=(16, 16), seed=0)
    for suffix in (".png", ".avif", ".jxl", ".webp"):
        (path,) = run_export(Export(tmp_path, suffix=suffix), [Item(made)])
        assert read_image(path, "a").values.shape[2] == 4


def test_what_cannot_be_exported_is_refused_before_anything_is_made(tmp_path):
    for wrong, said in (
        ({"suffix": ".gif"}, "images are written as"),
        ({"suffix": "png"}, "ending of a format"),
        ({"bits": "float"}, "must be 8 or 16"),
        ({"quality": 90}, "loses nothing"),
        ({"suffix": ".jpg", "quality": 0}, "from 1 to 100"),
        ({"recipe": "there"}, "inside, beside, none"),
    ):
        with pytest.raises(InputError, match=said):
            Export(tmp_path, **wrong)
    with pytest.raises(InputError, match="nothing to export"):
        planned(Export(tmp_path), [])
    (tmp_path / "wall v2.final-tiling-24x32-seed3.png").mkdir()
    with pytest.raises(InputError, match="is a folder"):
        planned(Export(tmp_path), [Item(job())])
    (tmp_path / "wall v2.final-tiling-24x32-seed3.tif.texlab.json").write_text("mine")
    with pytest.raises(InputError, match="holds no recipe"):
        planned(Export(tmp_path, suffix=".tif", recipe="beside"), [Item(job())])


# Sets.


def test_a_set_that_is_stopped_or_fails_leaves_the_folder_as_it_was(tmp_path):
    items = selection([Item(job())], (1, 2, 3))
    export = Export(tmp_path / "made")
    shares: list[float] = []
    with pytest.raises(Cancelled):
        run_export(export, items, on_progress=shares.append, should_stop=lambda: bool(shares and shares[-1] > 0.5))
    assert shares == sorted(shares)
    assert list(tmp_path.iterdir()) == []
    paths = run_export(export, items)
    before = {path: path.read_bytes() for path in (tmp_path / "made").iterdir()}
    paths[1].chmod(0o400)
    if os.geteuid():
        with pytest.raises(InputError, match="write-protected"):
            run_export(export, [Item(each.job) for each in selection(items, sizes=((16, 16),))], paths)
    paths[2].unlink()
    paths[2].mkdir()
    with pytest.raises(InputError, match="folder"):
        run_export(export, items, paths)
    assert {path: path.read_bytes() for path in paths[:2]} == {path: before[path] for path in paths[:2]}


def test_a_file_that_is_replaced_and_its_recipe_beside_belong_together(tmp_path):
    export = Export(tmp_path, "{name}", suffix=".jxl")
    (path,) = run_export(export, [Item(job("pixels", seed=1))])
    old, old_beside = path.read_bytes(), Path(f"{path}.texlab.json").read_bytes()
    run_export(export, [Item(job("pixels", seed=2))])
    assert read_recipe(path).seed == 2
    held = json.loads(Path(f"{path}.texlab.json").read_bytes())
    assert held["before"] == json.loads(old_beside)
    # Killed between the two: the old file is there with the new recipe beside it.
    path.write_bytes(old)
    assert read_recipe(path).seed == 1


def test_results_that_are_there_are_not_made_again(tmp_path, monkeypatch):
    result = run(job())
    monkeypatch.setattr("texlab_core.sheets.export.run", None)
    assert run_items([Item(result.job, "", result)]) == (result,)
    run_export(Export(tmp_path), [Item(result.job, "", result)])


def test_a_figure_of_a_selection_says_what_is_not_at_its_default():
    params = Job(method="heeger-bergen", inputs=job().inputs).params.replace(iterations=2)
    made = Job(method="heeger-bergen", inputs=job().inputs, params=params, size=(32, 32), seed=7)
    items = [Item(made, "Mine"), Item(job())]
    tiles = export_tiles(zip(items, run_items(items), strict=True))
    assert tiles[0].caption == ("Mine", "32 x 32, seed 7", "iterations 2")
    assert tiles[1].caption == ("Tiling", "24 x 32, seed 3")
    assert len(figure_page(tiles, Figure()).words) > 5


# Animations.


def frames_in(data):
    with Image.open(io.BytesIO(data)) as movie:
        found = []
        for index in range(movie.n_frames):
            movie.seek(index)
            found.append(np.asarray(movie.convert("RGB")))
        return found, movie.info.get("loop"), movie.info.get("duration")


@pytest.mark.parametrize("suffix", [".webp", ".gif", ".apng", ".png"])
def test_an_animation_has_its_frames_and_goes_on_for_ever(tmp_path, suffix):
    animation = animation_of("iterations=1:5:5", job("heeger-bergen", (24, 30)), rate=8)
    shares: list[float] = []
    drawn, result = draw_frames(job("heeger-bergen", (24, 30)), animation, on_progress=shares.append)
    assert shares == sorted(shares)
    assert len({each.tobytes() for each in drawn}) == 5
    (path,) = write_animation(tmp_path / f"a{suffix}", drawn, result, rate=8)
    found, loop, duration = frames_in(path.read_bytes())
    assert len(found) == 5
    assert loop == 0
    assert duration in (120, 125)
    if suffix in (".png", ".apng"):
        np.testing.assert_array_equal(np.stack(found), np.stack(drawn))
    assert read_recipe(path).params.iterations == 5


def test_a_drag_shows_each_value_and_can_go_back():
    made = job("heeger-bergen", (24, 24))
    drawn, _ = draw_frames(made, animation_of("seed=1:4:4", made, back=True))
    assert len(drawn) == 6
    for frame, seed in zip(drawn, (1, 2, 3, 4, 3, 2), strict=True):
        wanted = run(Job(method="heeger-bergen", inputs=made.inputs, size=(24, 24), seed=seed)).image
        np.testing.assert_array_equal(frame, (wanted * 255 + 0.5).astype(np.uint8))


@pytest.mark.parametrize("method", ["heeger-bergen", "efros-leung", "de-bonet", "tiling"])
@pytest.mark.parametrize("count", [2, 7])
def test_a_growth_has_as_many_frames_as_asked_for_and_ends_with_the_result(method, count):
    made = job(method, (24, 20))
    drawn, result = draw_frames(made, Animation("growth", count))
    assert len(drawn) == count
    assert {each.shape for each in drawn} == {(24, 20, 3)}
    np.testing.assert_array_equal(drawn[-1], (result.image * 255 + 0.5).astype(np.uint8))
    np.testing.assert_array_equal(result.image, run(made).image)


def test_the_stages_are_those_that_the_method_names():
    made = job("heeger-bergen", (24, 24))
    named: list[str] = []
    run(made, lambda step: named.append(step.frame) if step.frame else None)
    drawn, _ = draw_frames(made, Animation("iterations"))
    assert len(drawn) == len(named) + 1 > 5


def test_frames_as_files_are_one_set(tmp_path):
    made = job("heeger-bergen", (24, 24))
    drawn, result = draw_frames(made, Animation("iterations"))
    paths = write_animation(tmp_path / "frames", drawn, result)
    assert [path.name for path in paths] == [f"frame-{number:04}.png" for number in range(1, len(drawn) + 1)]
    for path, frame in zip(paths, drawn, strict=True):
        np.testing.assert_array_equal(read_image(path, "a").values, frame)
    assert read_recipe(paths[-1]).method == "heeger-bergen"
    (tmp_path / "other" / "frame-0002.png").mkdir(parents=True)
    with pytest.raises(InputError):
        write_animation(tmp_path / "other", drawn, result)
    assert [each.name for each in (tmp_path / "other").iterdir()] == ["frame-0002.png"]


def test_an_mp4_has_its_frames(tmp_path):
    drawn = [np.full((33, 47, 3), (40 * index, 120, 250 - 40 * index), np.uint8) for index in range(6)]
    path = tmp_path / "a.mp4"
    path.write_bytes(encode_movie(path, drawn, rate=10))
    movie = cv2.VideoCapture(str(path))
    assert movie.get(cv2.CAP_PROP_FPS) == pytest.approx(10)
    found = []
    while (shown := movie.read())[0]:
        found.append(shown[1][:33, :47, ::-1])
    movie.release()
    assert len(found) == 6
    assert np.abs(np.stack(found).astype(int) - np.stack(drawn)).mean() < 6


def test_no_encoder_for_mp4_is_one_sentence(monkeypatch):
    class Closed:
        fourcc = staticmethod(cv2.VideoWriter.fourcc)

        def __init__(self, *_):
            pass

        def isOpened(self):
            return False

        def release(self):
            pass

    monkeypatch.setattr(cv2, "VideoWriter", Closed)
    with pytest.raises(ImageError, match=r"^No encoder for MP4 is found here; choose \.webp"):
        encode_movie("a.mp4", [np.zeros((8, 8, 3), np.uint8)])


def test_animations_that_cannot_be_are_refused(tmp_path):
    for text, said in (
        ("grow", "growth, iterations or"),
        ("nothing=1:2:3", "must be one of"),
        ("seed=1:2:0", "count"),
    ):
        with pytest.raises(ParamError, match=said):
            animation_of(text, job())
    for frames in (1, 721, True):
        with pytest.raises(ParamError, match="frames"):
            Animation("growth", frames)
    with pytest.raises(InputError, match="more than 2 GB"):
        draw_frames(job(size=(2048, 2048)), Animation("growth", 720))
    (tmp_path / "file").write_text("")
    for name, said in (
        ("a.avi", r"animations are written as .*\.mp4, or as PNG files in a folder"),
        ("none/a.gif", "does not exist"),
        ("none/frames", "does not exist"),
        ("file", "is a file"),
    ):
        with pytest.raises(InputError, match=said):
            check_animation_target(tmp_path / name, Animation())
    with pytest.raises(InputError, match="empty"):
        check_animation_target("", Animation())
    with pytest.raises(ImageError, match="rate"):
        check_animation_target(tmp_path / "a.mp4", Animation(rate=99))
    with pytest.raises(Cancelled):
        draw_frames(job(), Animation("growth"), should_stop=lambda: True)
    with pytest.raises(Cancelled):
        write_animation(tmp_path / "b.gif", [np.zeros((8, 8, 3), np.uint8)] * 2, None, should_stop=lambda: True)
    assert not (tmp_path / "b.gif").exists()
