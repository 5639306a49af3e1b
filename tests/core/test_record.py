"""Results as files and back: redo gives the same bits from the file alone; what is too large is named."""

import base64
import io
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from PIL import Image

from tests.core.toy import NoiseParams
from tests.core.toy_recipe import METHOD, levels, method, noise, read, recipe_data, result_of  # noqa: F401
from texlab_core.documents import embedding
from texlab_core.documents.embedding import MAX_EMBEDDED, pack_pixels, unpack_pixels
from texlab_core.documents.recipe import recipe_json
from texlab_core.documents.record import read_recipe, save_result, summary
from texlab_core.engine.inputs import ArraysInput, Crop, DataInput
from texlab_core.engine.run import run
from texlab_core.engine.steps import Curve
from texlab_core.errors import InputError, RecipeError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.writing import encode_png, write_image

# Round trips


@pytest.mark.parametrize("kind", ["8 bits", "16 bits", "floats"])
@pytest.mark.parametrize(
    "taken", [{}, {"scale": 0.5}, {"crop": Crop(3, 4, 10, 12)}, {"scale": 0.75, "crop": Crop(1, 2, 9, 8)}]
)
@pytest.mark.parametrize("channels", [1, 3])
def test_redo_from_the_file_alone_gives_the_same_bits(tmp_path, kind, taken, channels):
    values = {"8 bits": levels, "16 bits": lambda **o: levels(65535, **o), "floats": noise}[kind](
        channels=channels
    )
    exemplar = as_exemplar(values, name="wall.png", **taken)
    result = result_of(exemplar)
    save_result(result, tmp_path / "out.png", bits=16)
    recipe = read_recipe(tmp_path / "out.png")
    assert recipe.missing == ()
    job = recipe.job()
    restored = job.inputs["exemplar"]
    assert restored.pixels.tobytes() == exemplar.pixels.tobytes()
    assert restored.sha256 == exemplar.sha256
    assert (restored.name, restored.origin.scale, restored.origin.crop) == (
        "wall.png",
        exemplar.origin.scale,
        exemplar.origin.crop,
    )
    assert restored.origin.pixels.tobytes() == exemplar.origin.pixels.tobytes()
    assert (job.params, job.size, job.seed) == (result.job.params, result.job.size, result.job.seed)
    assert run(job).image.tobytes() == result.image.tobytes()


@pytest.mark.parametrize("name", ["out.png", "out.tif", "out.tiff", "out.jpg", "out.JPEG", "out.webp"])
def test_every_format_carries_its_recipe(tmp_path, name):
    result = result_of(as_exemplar("gallery:structured-pebbles"))
    save_result(result, tmp_path / name)
    again = run(read_recipe(str(tmp_path / name)).job())
    assert again.image.tobytes() == result.image.tobytes()
    assert as_exemplar(tmp_path / name).size == (9, 13)
    assert {each.name for each in tmp_path.iterdir()} == {name}


def test_the_picture_is_the_result_and_other_programs_see_the_recipe(tmp_path):
    result = result_of(as_exemplar(levels()))
    save_result(result, tmp_path / "out.png")
    picture = Image.open(io.BytesIO((tmp_path / "out.png").read_bytes()))
    assert np.array_equal(np.asarray(picture), np.rint(result.image.astype(np.float64) * 255))
    data = json.loads(picture.text["texlab"])
    assert data["texlab"] == 1
    assert data["params"] == {"rounds": 2, "spread": 0.25, "power": 1}
    assert data["size"] == {"width": 13, "height": 9}
    assert data["versions"] == dict(result.versions)
    with pytest.raises(RecipeError, match="holds no recipe"):
        read_recipe(encode_png(np.zeros((2, 2), np.uint8)))


def test_numbers_that_are_known_are_kept_with_the_recipe(tmp_path):
    result = result_of(as_exemplar(levels()))
    known = {"copied-share": 0.25, "of-another-package": -3, "not-measured": math.nan}
    save_result(result, tmp_path / "a.png", measures=known)
    assert read_recipe(tmp_path / "a.png").measures == {"copied-share": 0.25, "of-another-package": -3.0}
    # What the method says itself is known without measuring.
    save_result(result, tmp_path / "b.png")
    assert read_recipe(tmp_path / "b.png").measures == dict(result.measures) != {}
    # They decide nothing, and who knows nothing of them reads the rest.
    again, bare = (read_recipe(tmp_path / name).job() for name in ("a.png", "b.png"))
    assert again.key == bare.key == result.job.key
    data = recipe_data()
    del data["measures"]
    assert read(data).measures == {}


def test_a_recipe_also_reads_from_bytes(tmp_path):
    result = result_of(as_exemplar(levels()))
    for name in ("out.png", "out.tif", "out.jpg", "out.webp"):
        save_result(result, tmp_path / name)
        assert run(read_recipe((tmp_path / name).read_bytes()).job()).image.tobytes() == result.image.tobytes()


@settings(deadline=None)
@given(
    st.sampled_from([255, 65535, None]).flatmap(
        lambda peak: hnp.arrays(
            np.float32,
            st.tuples(st.integers(1, 6), st.integers(1, 6), st.sampled_from([1, 3])),
            elements=st.floats(0, 1, width=32)
            if peak is None
            else st.integers(0, peak).map(lambda k: float(np.float32(k) / np.float32(peak))),
        )
    )
)
def test_packing_is_lossless_to_the_bit(pixels):
    packed = json.loads(json.dumps(pack_pixels(pixels)))
    assert unpack_pixels(packed, "it").tobytes() == pixels.tobytes()


def test_the_cheapest_lossless_encoding_is_chosen():
    eight, sixteen, floats = pack_pixels(levels()), pack_pixels(levels(65535)), pack_pixels(noise())
    assert [each["encoding"] for each in (eight, sixteen, floats)] == ["png", "png", "float32"]
    assert base64.b64decode(eight["base64"])[24] == 8
    assert base64.b64decode(sixteen["base64"])[24] == 16
    # Negative zero is a bit pattern of its own, and the hash sees it.
    assert pack_pixels(np.full((2, 2, 1), -0.0, np.float32))["encoding"] == "float32"


def test_a_source_of_several_exemplars_is_packed_once(monkeypatch):
    packed = []
    real = embedding.pack_pixels
    monkeypatch.setattr(
        embedding, "pack_pixels", lambda pixels, limit: packed.append(pixels) or real(pixels, limit)
    )
    whole = as_exemplar(levels(height=24, width=20))
    crops = [as_exemplar(whole, crop=Crop(top, 0, 12, 12)) for top in (0, 5, 9)]
    entries = [embedding.embed(each) for each in crops]
    assert len(packed) == 1
    for each, crop in zip(entries, crops, strict=True):
        assert each["source"] == pack_pixels(whole.pixels)
        assert each["sha256"] == crop.sha256
    # What is done to one recipe does not show in the next.
    entries[0]["source"].clear()
    assert embedding.embed(crops[0])["source"] == entries[1]["source"]
    # Another source, and another limit, are packed anew; what is too long stays so.
    assert embedding.embed(crops[0], limit=10)["pixels"] == pack_pixels(crops[0].pixels)
    assert "source" not in embedding.embed(crops[1], limit=10)
    other = as_exemplar(levels(height=24, width=21))
    assert embedding.embed(other)["source"] == pack_pixels(other.pixels) != entries[1]["source"]
    changing = np.array(whole.pixels)
    before = embedding._SOURCES.pack(changing, 10**6)
    changing[0, 0] = 1 - changing[0, 0]
    assert embedding._SOURCES.pack(changing, 10**6) == pack_pixels(changing) != before


def test_data_and_arrays_are_embedded_too(tmp_path):
    code = DataInput({"mean": [1.5, 2, None, "λ"], "deep": [[[{}]]]}, "code.json")
    state = ArraysInput(
        {"a": np.arange(6).reshape(2, 3), "b": noise()[..., 0], "c": np.array(2.5), "d": np.zeros((0, 2), bool)},
        "a state",
    )
    mask = as_exemplar(np.rint(noise(channels=1)), name="mask")
    result = result_of(as_exemplar(levels()), inputs={"code": code, "state": state, "mask": mask})
    save_result(result, tmp_path / "out.png")
    job = read_recipe(tmp_path / "out.png").job()
    assert job.inputs["code"].data == code.data
    for name, array in state.arrays.items():
        found = job.inputs["state"].arrays[name]
        assert (found.dtype, found.shape, found.tobytes()) == (array.dtype, array.shape, array.tobytes())
    assert {name: each.sha256 for name, each in job.inputs.items()} == {
        name: each.sha256 for name, each in result.job.inputs.items()
    }


# What is too large to be embedded


@pytest.fixture(scope="module")
def photograph():
    """Pixels whose source takes more than 2 MB, lossless."""
    return levels(height=1000, width=900, seed=3)


def test_a_large_source_leaves_its_pixels(tmp_path, photograph):
    exemplar = as_exemplar(photograph, name="photo.png", scale=0.5, crop=Crop(10, 20, 64, 48))
    save_result(result_of(exemplar), tmp_path / "out.png")
    recipe = read_recipe(tmp_path / "out.png")
    assert set(recipe.inputs["exemplar"].content) == {"pixels"}
    restored = recipe.job().inputs["exemplar"]
    assert restored.sha256 == exemplar.sha256
    # The source itself serves as well, and so does the exemplar as it was used.
    for given_image in (photograph, as_exemplar(photograph), exemplar):
        assert recipe.job(given_image).inputs["exemplar"].sha256 == exemplar.sha256


def test_the_part_that_was_used_may_be_larger_and_what_is_kept_is_said(tmp_path):
    photograph = levels(height=1100, width=1000, seed=4)
    exemplar = as_exemplar(photograph, name="photo.png", crop=Crop(10, 20, 1000, 900))
    notes = save_result(result_of(exemplar), tmp_path / "out.png")
    assert notes == (
        "The file keeps the 900 x 1000 pixels that were used of photo.png, whose whole is too large for it.",
    )
    recipe = read_recipe(tmp_path / "out.png")
    assert recipe.job().inputs["exemplar"].sha256 == exemplar.sha256
    notes = save_result(result_of(as_exemplar(photograph, name="photo.png")), tmp_path / "out.png")
    assert notes == ("The exemplar photo.png is too large to be kept in the file: keep it beside.",)
    assert save_result(result_of(as_exemplar(levels())), tmp_path / "out.png") == ()


def test_what_fits_nowhere_leaves_name_and_hash(tmp_path, photograph):
    exemplar = as_exemplar(photograph, name="photo.png")
    result = result_of(exemplar)
    save_result(result, tmp_path / "out.png")
    assert (tmp_path / "out.png").stat().st_size < 10_000
    recipe = read_recipe(tmp_path / "out.png")
    assert [each.name for each in recipe.missing] == ["photo.png"]
    with pytest.raises(RecipeError) as caught:
        recipe.job()
    assert str(caught.value) == (
        f"The recipe lacks the exemplar photo.png (900 x 1000 pixels, SHA-256 {exemplar.sha256[:12]}...), which "
        "was too large to be kept in the file."
    )
    write_image(tmp_path / "photo.png", photograph)
    again = run(recipe.job(tmp_path / "photo.png"))
    assert again.image.tobytes() == result.image.tobytes()
    with pytest.raises(
        RecipeError, match=r"^array is not the image of the recipe, which is the exemplar photo\.png"
    ):
        recipe.job(photograph[:-1])
    assert recipe.job(photograph[:-1], force=True).inputs["exemplar"].size == (999, 900)


def test_a_very_large_source_is_not_encoded_to_find_that_out(monkeypatch):
    sizes = []

    def counting(values, text=None, *, srgb):
        sizes.append(values.size)
        return encode_png(values, text, srgb=srgb)

    monkeypatch.setattr("texlab_core.documents.embedding.encode_png", counting)
    assert pack_pixels(levels(height=3600, width=3600)) is None
    assert sum(sizes) < 3600 * 3600
    flat = np.zeros((3600, 3600, 3), np.float32)
    assert len(pack_pixels(flat)["base64"]) < MAX_EMBEDDED


def test_large_or_deep_data_and_arrays_leave_name_and_hash():
    deep = []
    for _ in range(60):
        deep = [deep]
    for role, given_input in (
        ("code", DataInput("x" * (MAX_EMBEDDED + 1), "large")),
        ("code", DataInput(deep, "deep")),
        ("state", ArraysInput({"a": noise(1000, 900)}, "large")),
        ("state", ArraysInput({"a": np.array(["text"])}, "of texts")),
    ):
        data = recipe_json(result_of(as_exemplar(levels()), inputs={role: given_input}))
        recipe = read(data)
        assert [each.role for each in recipe.missing] == [role]
        with pytest.raises(RecipeError, match=f"The recipe lacks the {role} {given_input.name}"):
            recipe.job()


# Exemplars from outside


def test_a_given_exemplar_replaces_the_embedded_one_only_when_it_is_the_same():
    recipe = read(recipe_data())
    other = as_exemplar(noise(), name="other.png")
    with pytest.raises(RecipeError, match=r"^other\.png is not the image of the recipe"):
        recipe.job(other)
    assert recipe.job(other, force=True).inputs["exemplar"] is other
    same = as_exemplar(levels(), name="copy.png")
    assert recipe.job(same).inputs["exemplar"] is same
    with pytest.raises(RecipeError, match="The recipe has no image called mask"):
        recipe.job(given={"mask": same})
    with pytest.raises(InputError, match="no such file"):
        recipe.job("missing.png")


def test_one_image_stands_in_for_every_missing_input_with_its_hash():
    data = recipe_data()
    data["inputs"]["mask"] = dict(data["inputs"]["exemplar"])
    for each in data["inputs"].values():
        del each["source"]
    recipe = read(data)
    assert {each.role for each in recipe.missing} == {"exemplar", "mask"}
    same = as_exemplar(levels(), name="copy.png")
    for job in (recipe.job(same), recipe.job(given={"mask": same})):
        assert job.inputs["exemplar"] is job.inputs["mask"] is same
        assert list(job.inputs) == ["exemplar", "mask"]
    forced = as_exemplar(noise(), name="other.png")
    assert recipe.job(forced, force=True).inputs["mask"] is forced


def test_a_crop_that_does_not_fit_the_given_image_is_one_sentence():
    exemplar = as_exemplar(levels(), name="wall.png", crop=Crop(5, 5, 10, 10))
    recipe = read(recipe_json(result_of(exemplar)))
    with pytest.raises(RecipeError, match="is not the image of the recipe"):
        recipe.job(noise(6, 6))


def test_params_of_other_versions():
    data = recipe_data()
    del data["params"]["rounds"]
    assert read(data).params == NoiseParams()
    data["params"]["spred"] = 0.1
    with pytest.raises(RecipeError, match=r"parameter name: must be one of .*did you mean spread"):
        read(data)
    assert read(recipe_data(news="ignored")).seed == 5


def test_other_versions_are_told():
    data = recipe_data()
    assert read(data).other_versions == {}
    today = data["versions"]["numpy"]
    data["versions"] |= {"numpy": "1.0", "abacus": "2"}
    assert read(data).other_versions == {"numpy": ("1.0", today)}


# Summary


def test_summary_is_strict_json_with_exactly_these_keys():
    exemplar = as_exemplar(levels(), name="wall.png")
    result = replace(
        result_of(exemplar),
        curves={"distance": Curve.of([1, math.nan, math.inf], "Distance", y_label="W1")},
        measures={"w1": np.float32(0.5), "none": math.nan},
    )
    data = json.loads(json.dumps(summary(result, "a/out.png"), allow_nan=False))
    assert data == {
        "method": METHOD,
        "parameters": {"rounds": 2, "spread": 0.25, "power": 1},
        "size": {"width": 13, "height": 9},
        "seed": 5,
        "elapsed_s": result.elapsed_s,
        "out": "a/out.png",
        "exemplar": {"name": "wall.png", "sha256": exemplar.sha256, "size": {"width": 20, "height": 24}},
        "curves": {
            "distance": {
                "title": "Distance",
                "x_label": "iteration",
                "y_label": "W1",
                "x": [0, 1, 2],
                "y": [1, None, None],
            }
        },
        "measures": {"w1": 0.5, "none": None},
    }
    assert summary(result, None)["out"] is None
