"""Why a pixel is what it is: one file for each kind of result, found by :func:`explainer_for`."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from texlab.docks.explain.base import Explainer


@cache
def explainers() -> tuple[Explainer, ...]:
    """Import every file of this package and return what its ``EXPLAINER`` is."""
    modules = [importlib.import_module(f"{__name__}.{each.name}") for each in pkgutil.iter_modules(__path__)]
    return tuple(module.EXPLAINER for module in modules if hasattr(module, "EXPLAINER"))


def explainer_for(details: Any) -> Explainer | None:
    """Return what explains results with these details, by their type."""
    return next((each for each in explainers() if isinstance(details, each.details)), None)
