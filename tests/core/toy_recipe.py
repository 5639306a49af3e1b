"""A small method with inputs of every kind, its results and its recipes, for the tests of files."""

import json

import numpy as np
import pytest

from tests.core.toy import NoiseParams, noise_method, stock
from texlab_core.documents.recipe import recipe_json
from texlab_core.documents.record import read_recipe
from texlab_core.engine import registry
from texlab_core.engine.job import Job
from texlab_core.engine.registry import EXEMPLAR, InputSpec
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.png_text import with_text
from texlab_core.images.formats.writing import encode_png

METHOD = "toy-recipe"
INPUTS = (
    EXEMPLAR,
    InputSpec("mask", "Where.", required=False),
    InputSpec("code", "Numbers.", kind="data", required=False),
    InputSpec("state", "Arrays.", kind="arrays", required=False),
)


@pytest.fixture(autouse=True, scope="module")
def method():
    """Register a small method for this module."""
    with pytest.MonkeyPatch.context() as monkeypatch:
        stock(monkeypatch, registry._METHODS, noise_method(id=METHOD, title="Toy recipe", inputs=INPUTS))
        yield


def noise(height=24, width=20, channels=3, seed=0):
    """Floats that no integer format holds."""
    return np.random.default_rng(seed).random((height, width, channels)).astype(np.float32)


def levels(peak=255, **options):
    return (np.rint(noise(**options).astype(np.float64) * peak) / peak).astype(np.float32)


def result_of(exemplar, **changes):
    given = {"exemplar": exemplar} | changes.pop("inputs", {})
    fields = {"method": METHOD, "inputs": given, "params": NoiseParams(rounds=2), "size": (9, 13), "seed": 5}
    return run(Job(**(fields | changes)))


def recipe_data(**changes):
    """Return the recipe of a small result as JSON data, with changes."""
    data = json.loads(json.dumps(recipe_json(result_of(as_exemplar(levels(), name="wall.png")))))
    return data | changes


def read(data):
    text = data if isinstance(data, str) else json.dumps(data)
    return read_recipe(with_text(encode_png(np.zeros((2, 2), np.uint8)), {"texlab": text}))
