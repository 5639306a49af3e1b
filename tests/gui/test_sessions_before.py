"""Sessions that the version before wrote open as what they were."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from texlab.storage.settings import columns_from_json, seed_and_size
from texlab_core.engine.params import describe
from texlab_core.engine.registry import methods

BEFORE = Path(__file__).parents[1] / "data" / "before"
SESSIONS = sorted(BEFORE.glob("session*.json"))


@pytest.mark.parametrize("path", SESSIONS, ids=[path.stem for path in SESSIONS])
def test_columns_have_their_values_and_later_knobs_those_of_then(path: Path) -> None:
    saved = json.loads(path.read_text())
    said: list[str] = []
    columns = columns_from_json(saved, said.append)
    assert said == []
    assert len(columns) == len(saved["columns"])
    for written, (method, params, inputs, size, name, pinned, seed) in zip(saved["columns"], columns, strict=True):
        assert method == written["method"]
        now = params.to_json()
        for field in describe(type(params)):
            then: Any = written["params"].get(field.name, field.knob.formerly)
            assert now[field.name] == then, field.name
        assert inputs == ()
        assert size == (tuple(written["size"]) if "size" in written else None)
        assert (name, pinned, seed) == ("", False, None)
    assert seed_and_size(saved) == (saved["seed"], tuple(saved["size"]))


def test_there_are_several() -> None:
    assert len(SESSIONS) >= 3
    found = {column["method"] for path in SESSIONS for column in json.loads(path.read_text())["columns"]}
    assert found >= set(methods()) - {"solid", "mixture", "pixels"}
