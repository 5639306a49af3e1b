"""Diagnosis of a picture, from this program or another one: measures and findings against its exemplar."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from texlab_core.documents.reading import read_recipe
from texlab_core.engine.inputs import ImageInput
from texlab_core.errors import InputError, NoRecipeError, RecipeError
from texlab_core.findings.finding import counted
from texlab_core.findings.registry import examine, find_all
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import Subject, stopping

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping

    from texlab_core.documents.recipe import Recipe
    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result
    from texlab_core.findings.finding import Finding


@dataclass(frozen=True, kw_only=True)
class Diagnosis:
    """What is to be said of a picture.

    Parameters
    ----------
    exemplar
        What it was compared with.
    method, params
        How it was made; empty and None for a picture of which that is not known.
    measures
        Numbers by id.
    findings
        What is wrong, certain things first.
    unexamined
        Why something was not looked for, one sentence; empty where everything was.
    """

    exemplar: ImageInput
    method: str
    params: Params | None
    measures: Mapping[str, float]
    findings: tuple[Finding, ...]
    unexamined: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return everything as JSON data."""
        sure, hints = counted(self.findings)
        height, width = self.exemplar.size
        return {
            "exemplar": {
                "name": self.exemplar.name,
                "sha256": self.exemplar.sha256,
                "size": {"width": width, "height": height},
            },
            "method": self.method or None,
            "parameters": None if self.params is None else self.params.to_json(),
            "measures": {name: value if math.isfinite(value) else None for name, value in self.measures.items()},
            "findings": [each.to_json() for each in self.findings],
            "counts": {"findings": sure, "look_at": hints},
            "unexamined": self.unexamined or None,
        }


def diagnose(
    picture: str | os.PathLike[str],
    exemplar: str | os.PathLike[str] | ImageInput | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Diagnosis:
    """Measure a picture against its exemplar and say what is wrong.

    Parameters
    ----------
    picture
        A file. With a recipe inside method and parameters are known.
    exemplar
        A file or ``gallery:NAME``; None takes the one that the recipe holds.
    should_stop
        Asked every few milliseconds; True stops.

    Raises
    ------
    InputError
        When a file cannot be read, holds a solid, or has no exemplar inside and none is given.
    Cancelled
        When ``should_stop`` said so.
    """
    recipe = _recipe(picture, needed=exemplar is None)
    if recipe is not None and len(recipe.size) == 3:
        raise InputError(f"{picture} holds a solid; a picture is needed, such as a slice of it that was exported.")
    look = stopping(should_stop or (lambda: False))
    against = _held(picture, recipe) if exemplar is None else as_exemplar(exemplar, should_stop=should_stop)
    look()
    shown = as_exemplar(picture, should_stop=should_stop)
    method, params = ("", None) if recipe is None else (recipe.method, recipe.params)
    subject = Subject(image=shown.pixels, exemplar=against, method=method, look=look)
    measured, examined = measure_all(subject), examine(subject, params)
    return Diagnosis(
        exemplar=against,
        method=method,
        params=params,
        measures=measured,
        findings=examined.findings,
        unexamined=examined.why,
    )


def findings_of(result: Result, subject: Subject | None = None) -> tuple[Finding, ...]:
    """Return what is wrong with a result; nothing for a volume, of which no labels are known.

    Parameters
    ----------
    result
        What a job made.
    subject
        Made of the result, with what was measured of it already; None makes one.
    """
    if result.volume is not None:
        return ()
    return find_all(Subject.of_result(result) if subject is None else subject, result.job.params)


def _recipe(picture: str | os.PathLike[str], *, needed: bool) -> Recipe | None:
    """Return the recipe inside a picture; None where it has none, or a damaged one that is not needed."""
    try:
        return read_recipe(picture)
    except NoRecipeError:
        return None
    except RecipeError:
        if needed:
            raise
        return None


def _held(picture: str | os.PathLike[str], recipe: Recipe | None) -> ImageInput:
    """Return the exemplar that a result carries."""
    held = None if recipe is None else recipe.inputs.get("exemplar")
    if held is None or not held.is_embedded:
        raise InputError(f"{picture} does not hold its exemplar; name it: texlab diagnose IMAGE {picture}.")
    found = held.restore()
    if not isinstance(found, ImageInput):
        raise InputError(f"{picture} was not made from an image; name one: texlab diagnose IMAGE {picture}.")
    return replace(found, name=held.name)
