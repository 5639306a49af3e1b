"""Methods are found by importing every file of methods/, and by id."""

from __future__ import annotations

import ast
import pkgutil
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import texlab_core.methods
from tests.core.toy import noise_method
from texlab_core.engine import registry
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture
def empty(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    registry.methods()
    monkeypatch.setattr(registry, "_METHODS", {})
    registry.methods.cache_clear()
    yield
    registry.methods.cache_clear()


def test_every_file_that_registers_is_found() -> None:
    folder = Path(texlab_core.methods.__path__[0])
    registering = [path for path in folder.glob("*.py") if _registers(path)]
    assert len(registry.methods()) >= len(registering)
    modules = {each.name for each in pkgutil.iter_modules(texlab_core.methods.__path__)}
    assert {path.stem for path in registering} <= modules


def _registers(path: Path) -> bool:
    calls = [node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Call)]
    return any(isinstance(call.func, ast.Name) and call.func.id == "register" for call in calls)


def test_methods_come_in_their_order(empty: None) -> None:
    for name, order in [("c", 10), ("b", 20), ("a", 20)]:
        registry.register(noise_method(id=name, order=order))
    assert list(registry.methods()) == ["c", "a", "b"]
    with pytest.raises(TypeError):
        registry.methods()["d"] = noise_method()  # type: ignore[index]


def test_a_second_method_with_the_same_id_is_a_programming_error(empty: None) -> None:
    method = registry.register(noise_method())
    assert registry.find_method(method.id) is method
    with pytest.raises(RuntimeError, match="toy-noise"):
        registry.register(noise_method())


def test_an_unknown_method_is_refused_with_the_closest_one(empty: None) -> None:
    registry.register(noise_method())
    with pytest.raises(
        ParamError, match=r"^method: must be one of toy-noise \(did you mean toy-noise\?\), got 'toynoise'"
    ):
        registry.find_method("toynoise")
    with pytest.raises(ParamError, match=r"got 'zzz'\.$"):
        registry.find_method("zzz")
    with pytest.raises(ParamError, match=r"got \['toy-noise'\]\.$"):
        registry.find_method(["toy-noise"])  # type: ignore[arg-type]
