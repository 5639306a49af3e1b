"""Methods are found by importing every file of methods/, and by id."""

from __future__ import annotations

import ast
import importlib
import pkgutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import texlab_core.methods
from tests.core.toy import noise_method, stock
from texlab_core.engine import plugins, registry
from texlab_core.errors import ParamError
from texlab_core.measures import registry as measuring

if TYPE_CHECKING:
    from collections.abc import Callable


@pytest.fixture
def empty(monkeypatch: pytest.MonkeyPatch) -> None:
    stock(monkeypatch, registry._METHODS, alone=True)


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
    with pytest.raises(RuntimeError, match=r"^A method with the id 'toy-noise' is registered already\.$"):
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


@pytest.fixture
def packages(empty: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Return a function that installs packages, each a module with an entry point, in a folder of the test's."""
    monkeypatch.syspath_prepend(str(tmp_path))

    def install(name: str, code: str, group: str = "texlab_core.methods") -> None:
        module = name.replace("-", "_")
        (tmp_path / f"{module}.py").write_text(code, "utf-8")
        info = tmp_path / f"{module}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n", "utf-8")
        (info / "entry_points.txt").write_text(f"[{group}]\nany = {module}\n", "utf-8")
        monkeypatch.delitem(sys.modules, module, raising=False)
        importlib.invalidate_caches()

    return install


GOOD = """
from tests.core.toy import noise_method, stock
from texlab_core.engine.registry import register
register(noise_method(id="good-noise", title="Good noise"))
"""
MEASURE = """
from texlab_core.measures.registry import Measure
from texlab_core.measures.registry import register as add
words = dict(title="beside", summary="Only here.", better="lower", needs=(), form=".1f")
add(Measure(id='beside', low=0.0, high=1.0, function=lambda subject: 0.5, **words))
"""


def test_a_method_of_another_package_is_found_and_named_with_it(packages: Callable[..., None]) -> None:
    packages("texlab-good", GOOD)
    packages("texlab-other", GOOD, "texlab_core.measures")
    method = registry.find_method("good-noise")
    assert method.package == "texlab-good"
    assert method.title == "Good noise (texlab-good)"
    assert registry.failures() == ()


def test_what_is_registered_already_is_told_with_its_package(packages: Callable[..., None]) -> None:
    packages("texlab-first", GOOD)
    packages("texlab-second", GOOD)
    assert registry.find_method("good-noise").package == "texlab-first"
    (failure,) = registry.failures()
    assert failure.source.package == "texlab-second"
    assert "A method with the id 'good-noise' is registered already, by texlab-first" in failure.reason


def test_a_measure_beside_a_method_is_of_the_same_package(
    packages: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    stock(monkeypatch, measuring._MEASURES)
    packages("texlab-good", GOOD + MEASURE)
    packages("texlab-taken", MEASURE.replace("'beside'", "'cuts'"), "texlab_core.measures")
    assert measuring.find_measure("beside").package == "texlab-good"
    with pytest.raises(RuntimeError, match="'beside' is registered already, by texlab-good"):
        measuring.register(measuring.find_measure("beside"))
    # Where a test has imported ours by itself before, nobody saw whose it is.
    with pytest.raises(RuntimeError, match=r"A measure with the id 'cuts' is registered already(, by texlab)?\."):
        measuring.register(measuring.find_measure("cuts"))


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("import no_such_module", "ModuleNotFoundError: No module named 'no_such_module'"),
        ("1 / 0", "ZeroDivisionError: division by zero"),
        ("def broken(:", "SyntaxError"),
        ("import sys; sys.exit(3)", "SystemExit: 3"),
        (GOOD + "raise RuntimeError('too\\nlate')", "RuntimeError: too late"),
        (GOOD.replace("good-noise", "uncommon") + GOOD.replace("good-noise", "uncommon"), "registered already"),
        (GOOD.replace('title="Good noise"', "params=int"), "TypeError"),
    ],
    ids=["import", "error", "syntax", "exit", "late", "twice", "no-params"],
)
def test_what_is_broken_is_left_out_and_named(packages: Callable[..., None], code: str, reason: str) -> None:
    packages("texlab-broken", code)
    packages("texlab-good", GOOD)
    assert list(registry.methods()) == ["good-noise"]
    (failure,) = registry.failures()
    assert failure.source == plugins.Source("texlab-broken", "texlab_broken")
    assert reason in failure.reason
    assert failure.sentence.startswith("The methods of texlab-broken in texlab_broken are left out, since ")
    assert "\n" not in failure.sentence
    with pytest.raises(ParamError, match=r"what texlab-broken adds could not be loaded\), got 'uncommon'"):
        registry.find_method("uncommon")


def test_a_file_of_our_own_that_cannot_be_imported_is_left_out(
    empty: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "broken_one.py").write_text("import no_such_module", "utf-8")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "__init__.py").write_text("", "utf-8")
    (tmp_path / "folder" / "method_two.py").write_text("1 / 0", "utf-8")
    (tmp_path / "folder" / "method_three.py").write_text(GOOD, "utf-8")
    (tmp_path / "_parts.py").write_text("1 / 0", "utf-8")
    monkeypatch.setattr(texlab_core.methods, "__path__", [str(tmp_path)])
    assert list(registry.methods()) == ["good-noise"]
    assert registry.methods()["good-noise"].package == "texlab"
    assert [(each.source.package, each.source.module) for each in registry.failures()] == [
        ("texlab", "texlab_core.methods.broken_one"),
        ("texlab", "texlab_core.methods.folder.method_two"),
    ]
    for name in [name for name in sys.modules if name.startswith("texlab_core.methods.folder")]:
        monkeypatch.delitem(sys.modules, name)


def test_a_module_that_asks_while_it_is_imported_gets_what_there_is(packages: Callable[..., None]) -> None:
    asking = "from texlab_core.engine.registry import failures, methods\n"
    packages("texlab-good", GOOD)
    later = GOOD.replace("good-noise", "later")
    packages("texlab-later", f"{asking}found = dict(methods()), failures()\n{later}")
    assert list(registry.methods()) == ["good-noise", "later"]
    assert sys.modules["texlab_later"].found == ({"good-noise": registry.find_method("good-noise")}, ())


def test_nothing_of_ours_is_broken() -> None:
    assert registry.failures() == ()
