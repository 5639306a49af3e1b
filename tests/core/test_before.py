"""What earlier versions wrote still means what it meant: recipes, presets, sessions, sweeps in tests/data."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texlab_core.documents.presets import read_preset
from texlab_core.documents.record import read_recipe
from texlab_core.engine.params import describe
from texlab_core.engine.registry import find_method, methods
from texlab_core.engine.run import run
from texlab_core.images.formats.volumes import read_volume
from texlab_core.images.formats.writing import quantize
from texlab_core.sheets.sweep_sources import find_sweep

BEFORE = Path(__file__).parent.parent / "data" / "before"
RESULTS = sorted(BEFORE.glob("*.png"))
SOLIDS = sorted(BEFORE.glob("*.tif"))
PRESETS = sorted(BEFORE.glob("*.preset.json"))


@pytest.mark.parametrize("path", RESULTS, ids=[path.stem for path in RESULTS])
def test_recipes_redo_their_bits(path: Path) -> None:
    image = run(read_recipe(path).job()).image
    with Image.open(path) as kept:
        expected = np.asarray(kept).reshape(image.shape)
    np.testing.assert_array_equal(np.round(image * 255).astype(np.uint8), expected)


@pytest.mark.parametrize("path", SOLIDS, ids=[path.stem for path in SOLIDS])
def test_recipes_of_solids_redo_their_bits(path: Path) -> None:
    volume = run(read_recipe(path).job()).volume
    assert volume is not None
    np.testing.assert_array_equal(quantize(volume, 255), read_volume(path).values)


@pytest.mark.parametrize("path", PRESETS, ids=[path.name for path in PRESETS])
def test_presets_written_in_full_say_what_they_said(path: Path) -> None:
    written = json.loads(path.read_text())["parameters"]
    preset = read_preset(path)
    params = preset.params()
    for field in describe(type(params)):
        value = preset.parameters[field.name]
        assert value == written.get(field.name, field.knob.formerly)
        assert getattr(params, field.name) == field.check(value)


def test_sessions_and_sweeps_say_what_they_said() -> None:
    for column in json.loads((BEFORE / "session.json").read_text())["columns"]:
        params = find_method(column["method"]).params.from_json(column["params"])
        recipe = [read_recipe(path) for path in RESULTS if read_recipe(path).params == params]
        assert recipe, column["method"]
    sweep = find_sweep(str(BEFORE / "sweep.json"))
    assert sweep.params.to_json()["coarsest"] == "shift"
    assert sweep.params.to_json()["fitting"] == "crop"


@pytest.mark.parametrize("method", list(methods()))
def test_what_came_later_has_a_value_for_what_came_before(method: str) -> None:
    """A document that names the first parameters alone is an early one; one that names fewer is a partial one."""
    kind = methods()[method].params
    fields = describe(kind)
    first = {field.name: kind().to_json()[field.name] for field in fields if field.knob.formerly is None}
    later = {field.name: field.knob.formerly for field in fields if field.knob.formerly is not None}
    assert kind.from_json(first).to_json() == first | later
    assert kind.completed({}) == ({} if first else later)
    for field in fields:
        if field.knob.formerly is not None:
            assert field.check(field.knob.formerly) == field.knob.formerly
