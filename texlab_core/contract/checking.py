"""Every check on every method of a package."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.contract import declarations, knobs, runs
from texlab_core.contract.cases import Broken
from texlab_core.engine.registry import failures, methods
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from texlab_core.engine.registry import Method


def checks() -> Mapping[str, Callable[[Method], None]]:
    """Return every check by its name, declarations first."""
    return {
        name.removeprefix("check_").replace("_", "-"): check
        for module in (declarations, knobs, runs)
        for name, check in vars(module).items()
        if name.startswith("check_") and inspect.isfunction(check) and check.__module__ == module.__name__
    }


@dataclass(frozen=True, slots=True)
class Finding:
    """What one check found.

    Parameters
    ----------
    method, check
        Ids.
    promise
        What is promised.
    problem
        How it is broken; empty when it is kept.
    """

    method: str
    check: str
    promise: str
    problem: str = ""


def check_method(method: Method) -> Iterator[Finding]:
    """Run every check on a method; whatever it raises becomes a finding."""
    for name, check in checks().items():
        promise = inspect.getdoc(check) or ""
        try:
            check(method)
        except Broken as broken:
            yield Finding(method.id, name, promise, f"{broken}{_notes(broken)}")
        except InputError as error:
            yield Finding(method.id, name, promise, f"refuses the job of this check: {error}{_notes(error)}")
        except Exception as error:
            reason = " ".join(str(error).split())
            yield Finding(method.id, name, promise, f"raises {type(error).__name__}: {reason}{_notes(error)}")
        else:
            yield Finding(method.id, name, promise)


def _notes(error: Exception) -> str:
    notes = getattr(error, "__notes__", ())
    return f" ({'; '.join(notes)})" if notes else ""


def methods_of(package: str) -> tuple[Method, ...]:
    """Return the methods that a package adds; its name as pip knows it, in any spelling.

    Raises
    ------
    InputError
        When it adds none, or could not be loaded.
    """
    wanted = _plain(package)
    found = tuple(each for each in methods().values() if _plain(each.package) == wanted)
    broken = [each for each in failures() if _plain(each.source.package) == wanted]
    if broken:
        raise InputError(" ".join(each.sentence for each in broken))
    if not found:
        known = sorted({each.package for each in methods().values()})
        raise InputError(f"No installed package {package} adds a method; these do: {', '.join(known)}.")
    return found


def _plain(name: str) -> str:
    return name.lower().replace("_", "-").replace(".", "-")
