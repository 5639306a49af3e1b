"""Every file of ``methods/`` registers, and mistakes in a declaration are said at once."""

from __future__ import annotations

import importlib
import pkgutil
from dataclasses import dataclass
from typing import Annotated

import pytest

import texlab_core.methods
from texlab_core.engine.params import Knob, Params, describe
from texlab_core.engine.registry import failures, methods


def declaring_modules() -> list[str]:
    names = []
    for each in pkgutil.iter_modules(texlab_core.methods.__path__, "texlab_core.methods."):
        if not each.ispkg:
            names.append(each.name)
            continue
        inside = pkgutil.iter_modules(importlib.import_module(each.name).__path__, f"{each.name}.")
        found = [inner.name for inner in inside if inner.name.rpartition(".")[2].split("_")[0] == "method"]
        assert found, f"{each.name} has no method.py (or method_*.py): nothing in it can register a method."
        names += found
    return names


@pytest.mark.parametrize("name", declaring_modules())
def test_the_file_registers_a_method(name: str) -> None:
    homes = {method.synthesize.__module__ for method in methods().values()}
    # One that could not be loaded says why itself.
    broken = [each.sentence for each in failures() if f"{name}.".startswith(f"{each.source.module}.")]
    assert not broken, " ".join(broken)
    assert name in homes, f"{name} registers no method: call engine.registry.register(Method(...)) in it."


def test_params_without_their_decorator_are_refused() -> None:
    class Forgotten(Params):
        rounds: Annotated[int, Knob("Rounds.", 1, 5)] = 2

    with pytest.raises(
        TypeError, match=r"^Forgotten must be decorated with @dataclass\(frozen=True, kw_only=True\)"
    ):
        describe(Forgotten)
    with pytest.raises(TypeError, match="must be decorated"):
        Forgotten()


def test_params_that_could_change_are_refused() -> None:
    with pytest.raises(TypeError, match="non-frozen"):

        @dataclass
        class Loose(Params):
            rounds: Annotated[int, Knob("Rounds.", 1, 5)] = 2


def test_params_that_add_nothing_need_no_decorator() -> None:
    class Plain(Params):
        pass

    assert describe(Plain) == ()
