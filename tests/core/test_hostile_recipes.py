"""Hostile and damaged files are refused in one sentence, and do nothing."""

import base64
import re
import zlib
from dataclasses import replace

import numpy as np
import pytest

from tests.core.toy import stock
from tests.core.toy_recipe import METHOD, levels, method, noise, read, recipe_data, result_of  # noqa: F401
from texlab_core.documents.recipe import recipe_json
from texlab_core.documents.record import read_recipe, save_result
from texlab_core.engine import registry
from texlab_core.engine.inputs import ArraysInput, DataInput
from texlab_core.errors import InputError, RecipeError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.writing import encode_png, write_image


def entry(**changes):
    data = recipe_data()
    data["inputs"]["exemplar"] |= changes
    return data


HOSTILE = {
    "not JSON": "{",
    "a list": "[]",
    "someone else's": '{"a": 1}',
    "deep": '{"texlab": 1, "a": ' + "[" * 100_000 + "]" * 100_000 + "}",
    "NaN": '{"texlab": 1, "seed": NaN}',
    "a huge number": '{"texlab": 1, "seed": ' + "9" * 10_000 + "}",
    "a repeated key": '{"texlab": 1, "texlab": 1}',
    "a newer version": {"texlab": 2},
    "a version that is true": {"texlab": True},
    "no method": {"texlab": 1},
    "an unknown method": lambda: recipe_data(method="magic"),
    "a method of another type": lambda: recipe_data(method=["toy-recipe"]),
    "params of another type": lambda: recipe_data(params=[1]),
    "params out of range": lambda: recipe_data(params={"rounds": 10**9}),
    "a param of another type": lambda: recipe_data(params={"rounds": "many"}),
    "size of another type": lambda: recipe_data(size=[3, 4]),
    "no size": lambda: recipe_data(size={}),
    "a huge size": lambda: recipe_data(size={"width": 10**9, "height": 10**9}),
    "a size of floats": lambda: recipe_data(size={"width": 3.5, "height": 2}),
    "a seed out of range": lambda: recipe_data(seed=-1),
    "a seed of another type": lambda: recipe_data(seed="5"),
    "versions of another type": lambda: recipe_data(versions=["numpy"]),
    "versions of numbers": lambda: recipe_data(versions={"numpy": 2}),
    "versions that clear the screen": lambda: recipe_data(versions={"numpy": "\x1b[2J"}),
    "a library that clears the screen": lambda: recipe_data(versions={"\x1b[2J": "1"}),
    "measures without names": lambda: recipe_data(measures=[1.0]),
    "measures that are no numbers": lambda: recipe_data(measures={"d": "low"}),
    "measures that are true": lambda: recipe_data(measures={"d": True}),
    "a measure that clears the screen": lambda: recipe_data(measures={"\x1b[2J": 1.0}),
    "a measure with a long name": lambda: recipe_data(measures={"d" * 81: 1.0}),
    "too many measures": lambda: recipe_data(measures={str(number): 1.0 for number in range(257)}),
    "inputs of another type": lambda: recipe_data(inputs=[]),
    "no inputs": lambda: recipe_data(inputs={}),
    "an unknown input": lambda: recipe_data(inputs={"start": {}}),
    "an input of another type": lambda: recipe_data(inputs={"exemplar": 3}),
    "an input of another kind": lambda: entry(kind="data"),
    "a name of another type": lambda: entry(name=3),
    "a name of two lines": lambda: entry(name="a\nb"),
    "a huge name": lambda: entry(name="a" * 10_000),
    "no hash": lambda: entry(sha256="abc"),
    "input size of another type": lambda: entry(size={"width": "3"}),
    "a scale of another type": lambda: entry(scale="1"),
    "a scale out of range": lambda: entry(scale=0),
    "a crop of another type": lambda: entry(crop=[0, 0, 3, 3]),
    "a crop of floats": lambda: entry(crop={"top": 0.5, "left": 0, "height": 3, "width": 3}),
    "pixels of another type": lambda: entry(source="abc"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_malformed_recipes_are_refused_in_one_sentence(name):
    data = HOSTILE[name]
    with pytest.raises(RecipeError) as caught:
        read(data() if callable(data) else data)
    sentence = str(caught.value)
    assert sentence.startswith("The recipe of the file")
    assert sentence.endswith(".")
    assert "\n" not in sentence
    assert len(sentence) < 400


def png64(values):
    return base64.b64encode(encode_png(values)).decode()


def packed(raw):
    return base64.b64encode(zlib.compress(raw, 9)).decode()


BOMB = bytes(2**26)
CONTENT = {
    "no base64": {"encoding": "png", "base64": "***"},
    "base64 of another type": {"encoding": "png", "base64": [1]},
    "no content": {},
    "an unknown encoding": {"encoding": "pickle", "base64": ""},
    "not a PNG": {"encoding": "png", "base64": base64.b64encode(b"BM" + bytes(99)).decode()},
    "a damaged PNG": {"encoding": "png", "base64": png64(np.zeros((9, 9), np.uint8))[:60]},
    "another image": {"encoding": "png", "base64": png64(np.zeros((9, 9), np.uint8))},
    "an image with alpha": {"encoding": "png", "base64": png64(np.full((9, 9, 4), 7, np.uint8))},
    "no shape": {"encoding": "float32", "base64": packed(bytes(12))},
    "a shape of another type": {"encoding": "float32", "base64": packed(bytes(12)), "shape": "1x1x3"},
    "a shape of floats": {"encoding": "float32", "base64": packed(bytes(12)), "shape": [1.0, 1, 3]},
    "a negative shape": {"encoding": "float32", "base64": packed(bytes(12)), "shape": [-1, -1, 3]},
    "too few axes": {"encoding": "float32", "base64": packed(bytes(12)), "shape": [3]},
    "too many axes": {"encoding": "float32", "base64": packed(bytes(4)), "shape": [1] * 100},
    "too few values": {"encoding": "float32", "base64": packed(bytes(12)), "shape": [2, 2, 1]},
    "too many values": {"encoding": "float32", "base64": packed(bytes(20)), "shape": [2, 2, 1]},
    "a zip bomb": {"encoding": "float32", "base64": packed(BOMB), "shape": [2, 2, 1]},
    "a huge shape": {"encoding": "float32", "base64": packed(BOMB), "shape": [2**20, 2**20, 3]},
    "damaged values": {"encoding": "float32", "base64": "AAAA", "shape": [1, 1, 1]},
    "NaN": {"encoding": "float32", "base64": packed(np.full(4, np.nan, "<f4").tobytes()), "shape": [2, 2, 1]},
    "out of range": {"encoding": "float32", "base64": packed(np.full(4, 2, "<f4").tobytes()), "shape": [2, 2, 1]},
    "a single pixel": {"encoding": "float32", "base64": packed(bytes(4)), "shape": [1, 1, 1]},
}


@pytest.mark.parametrize("name", CONTENT)
@pytest.mark.parametrize("key", ["source", "pixels"])
def test_malformed_images_are_refused_in_one_sentence(name, key):
    data = recipe_data()
    del data["inputs"]["exemplar"]["source"]
    data["inputs"]["exemplar"][key] = CONTENT[name]
    recipe = read(data)
    with pytest.raises(RecipeError, match=r"^The recipe's input wall\.png") as caught:
        recipe.job()
    assert str(caught.value).endswith(".")
    assert len(str(caught.value)) < 400


ARRAYS = {
    "a list": [],
    "of another type": {"a": 3},
    "of objects": {"a": {"dtype": "|O", "shape": [1], "base64": packed(bytes(8))}},
    "of texts": {"a": {"dtype": "<U1", "shape": [1], "base64": packed(bytes(4))}},
    "of records": {"a": {"dtype": "f4,f4", "shape": [1], "base64": packed(bytes(8))}},
    "of nonsense": {"a": {"dtype": "zz", "shape": [1], "base64": packed(bytes(8))}},
    "of no type": {"a": {"dtype": None, "shape": [1], "base64": packed(bytes(8))}},
    "a bomb": {"a": {"dtype": "|u1", "shape": [10], "base64": packed(BOMB)}},
    "many bombs": {str(i): {"dtype": "|u1", "shape": [2**26], "base64": packed(BOMB)} for i in range(5)},
    "changed": {"a": {"dtype": "|u1", "shape": [1], "base64": packed(bytes(1))}},
}


@pytest.mark.parametrize("name", ARRAYS)
def test_malformed_arrays_are_refused_in_one_sentence(name):
    state = ArraysInput({"a": np.arange(3)}, "a state")
    data = recipe_json(result_of(as_exemplar(levels(), name="wall.png"), inputs={"state": state}))
    data["inputs"]["state"]["arrays"] = ARRAYS[name]
    recipe = read(data)
    with pytest.raises(RecipeError, match=r"^The recipe's input a state .*\.$"):
        recipe.job()


def test_changed_data_is_noticed_and_force_takes_it():
    code = DataInput([1, 2, 3], "code")
    data = recipe_json(result_of(as_exemplar(levels()), inputs={"code": code}))
    data["inputs"]["code"]["data"] = [1, 2, 4]
    recipe = read(data)
    with pytest.raises(RecipeError, match=r"input code is not the one that was used \(another hash\)"):
        recipe.job()
    assert recipe.job(force=True).inputs["code"].data == [1, 2, 4]


def test_what_the_method_itself_refuses_is_one_sentence(monkeypatch):
    def check(inputs, params, size):
        raise InputError("Toy recipe wants another exemplar.")

    recipe = read(recipe_data())
    strict = replace(registry.find_method(METHOD), check=check)
    stock(monkeypatch, registry._METHODS, strict)
    with pytest.raises(RecipeError, match=r"^The recipe cannot be followed: Toy recipe wants another exemplar\.$"):
        recipe.job()


def test_files_without_recipe(tmp_path):
    write_image(tmp_path / "plain.png", noise())
    write_image(tmp_path / "plain.tif", noise())
    write_image(tmp_path / "described.tif", noise(), text={"": "a holiday"})
    write_image(tmp_path / "plain.jpg", noise())
    (tmp_path / "text.txt").write_text("hello")
    (tmp_path / "empty.png").write_bytes(b"")
    for file in sorted(tmp_path.iterdir()):
        with pytest.raises(
            RecipeError, match="(?i)^" + re.escape(file.name) + " holds no recipe; only results that"
        ):
            read_recipe(file)
    with pytest.raises(RecipeError, match="there is no such file"):
        read_recipe(tmp_path / "missing.png")
    with pytest.raises(RecipeError, match="is a folder, not a saved result"):
        read_recipe(tmp_path)
    with pytest.raises(RecipeError):
        read_recipe("nul\0l")


def test_damaged_files_are_one_sentence(tmp_path):
    result = result_of(as_exemplar(levels()))
    for name in ("out.png", "out.tif", "out.jpg", "out.webp"):
        save_result(result, tmp_path / name)
        whole = (tmp_path / name).read_bytes()
        for share in (0.1, 0.5):
            with pytest.raises(RecipeError) as caught:
                read_recipe(whole[: int(share * len(whole))])
            assert str(caught.value).endswith(".")


def test_a_file_that_cannot_be_opened(tmp_path, monkeypatch):
    write_image(tmp_path / "out.png", noise())

    def refuse(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("os.open", refuse)
    with pytest.raises(RecipeError, match=r"out\.png: cannot be opened \(Permission denied\)\.$"):
        read_recipe(tmp_path / "out.png")
    monkeypatch.undo()
    with pytest.raises(RecipeError, match=r"^The recipe of the file is damaged\.$"):
        read_recipe(b"II*\0" + bytes(3))


def test_reading_never_unpickles(monkeypatch):
    import pickle

    def never(*_, **__):
        raise AssertionError

    monkeypatch.setattr(pickle, "loads", never)
    monkeypatch.setattr(pickle, "load", never)
    assert read(recipe_data()).job().size == (9, 13)


def test_saving_checks_the_format_before_it_writes(tmp_path):
    result = result_of(as_exemplar(levels()))
    with pytest.raises(InputError, match=r"images are written as \.png"):
        save_result(result, tmp_path / "out.gif")
    with pytest.raises(InputError, match=r"the bits of a \.jpg file must be 8"):
        save_result(result, tmp_path / "out.jpg", bits=16)
    assert not list(tmp_path.iterdir())
    save_result(result, tmp_path / "out.tif", bits="float")
    assert np.array_equal(as_exemplar(tmp_path / "out.tif").pixels, result.image)
