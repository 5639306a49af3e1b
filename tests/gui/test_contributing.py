"""The examples of CONTRIBUTING.md, word for word."""

from __future__ import annotations

import importlib
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import column_of, feed

import texlab.docks
import texlab_core.measures
import texlab_core.methods
from tests.core.toy import stock
from texlab.docks import dock_classes
from texlab.state.intentions import Pin
from texlab.state.scene import Scene
from texlab_core.contract.checking import check_method
from texlab_core.engine import registry
from texlab_core.measures import registry as measures_registry
from texlab_core.measures.subject import Subject

if TYPE_CHECKING:
    from collections.abc import Iterator

TEXT = (Path(__file__).resolve().parents[2] / "CONTRIBUTING.md").read_text(encoding="utf-8")


def example(after: str) -> str:
    """Return the first block of Python below a heading."""
    block = re.search(r"```python\n(.*?)```", TEXT[TEXT.index(f"## {after}") :], re.DOTALL)
    assert block is not None
    return block[1]


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Put a file beside those of a package and load it."""
    for shelf in (registry._METHODS, measures_registry._MEASURES):
        stock(monkeypatch, shelf)
    loaded: list[str] = []

    def load(package: Any, name: str, code: str) -> Any:
        (tmp_path / f"{name}.py").write_text(code, encoding="utf-8")
        monkeypatch.setattr(package, "__path__", [*package.__path__, str(tmp_path)])
        loaded.append(f"{package.__name__}.{name}")
        return importlib.import_module(loaded[-1])

    yield load
    for each in loaded:
        sys.modules.pop(each, None)


def test_the_method_keeps_every_promise(module: Any) -> None:
    module(texlab_core.methods, "rows", example("Add a method"))
    method = registry.find_method("rows")
    assert method.title == "Shuffled rows"
    broken = [f"{found.check}: {found.problem}" for found in check_method(method) if found.problem]
    assert broken == []


def test_the_measure_is_asked_like_any_other(module: Any) -> None:
    module(texlab_core.measures, "contrast", example("Add a measure"))
    exemplar = np.random.default_rng(0).random((16, 16, 1)).astype(np.float32)
    half = 0.25 + exemplar / 2
    found = measures_registry.measure_all(Subject.of_images(exemplar, half), ["contrast-left"])
    assert found == {"contrast-left": pytest.approx(0.5, abs=1e-5)}
    assert measures_registry.written(found, ["contrast-left"]) == ["contrast 50%"]
    flat = np.full((16, 16, 1), 0.5, np.float32)
    assert measures_registry.measure_all(Subject.of_images(flat, half), ["contrast-left"]) == {}


def test_the_dock_shows_and_sends_what_it_says(qtbot: Any, module: Any) -> None:
    module(texlab.docks, "extremes", example("Add a dock"))
    (made,) = (each for each in dock_classes() if each.name == "extremes")
    dock: Any = made()
    qtbot.addWidget(dock)
    column = column_of(np.linspace(0.25, 0.75, 12, dtype=np.float32).reshape(3, 4, 1))
    feed(dock, Scene(None, (column,), column.id))
    assert dock.label.text() == "0.250 to 0.750"
    with qtbot.waitSignal(dock.intention) as sent:
        dock._pin()
    assert sent.args == [Pin(column.id, 0, 0)]
