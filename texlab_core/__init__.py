"""Example-based texture synthesis: arrays in, arrays out, no Qt.

>>> import texlab_core
>>> result = texlab_core.synthesize("gallery:structured-pebbles", size=(256, 256), seed=1)  # doctest: +SKIP

Names are imported when they are first used, so that importing the package costs next to nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from texlab_core.version import __version__ as __version__

if TYPE_CHECKING:
    from texlab_core.api import available_methods, compare, sweep, synthesize
    from texlab_core.documents.record import read_recipe, save_result
    from texlab_core.engine.cache import AnalysisCache
    from texlab_core.engine.inputs import ArraysInput, Crop, DataInput, ImageInput, exemplar_of
    from texlab_core.engine.job import Job
    from texlab_core.engine.params import Knob, Params, describe
    from texlab_core.engine.registry import InputSpec, Method, find_method, register
    from texlab_core.engine.result import Result
    from texlab_core.engine.run import run
    from texlab_core.engine.steps import Curve, Map, Output, Step
    from texlab_core.engine.streams import Streams
    from texlab_core.errors import Cancelled, ImageError, InputError, ParamError, RecipeError
    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.progress import progress_bar
    from texlab_core.series import Series

_HOMES = {
    "api": ("available_methods", "compare", "sweep", "synthesize"),
    "documents.record": ("read_recipe", "save_result"),
    "engine.cache": ("AnalysisCache",),
    "engine.inputs": ("ArraysInput", "Crop", "DataInput", "ImageInput", "exemplar_of"),
    "engine.job": ("Job",),
    "engine.params": ("Knob", "Params", "describe"),
    "engine.registry": ("InputSpec", "Method", "find_method", "register"),
    "engine.result": ("Result",),
    "engine.run": ("run",),
    "engine.steps": ("Curve", "Map", "Output", "Step"),
    "engine.streams": ("Streams",),
    "errors": ("Cancelled", "ImageError", "InputError", "ParamError", "RecipeError"),
    "images.exemplar": ("as_exemplar",),
    "progress": ("progress_bar",),
    "series": ("Series",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "AnalysisCache",
    "ArraysInput",
    "Cancelled",
    "Crop",
    "Curve",
    "DataInput",
    "ImageError",
    "ImageInput",
    "InputError",
    "InputSpec",
    "Job",
    "Knob",
    "Map",
    "Method",
    "Output",
    "ParamError",
    "Params",
    "RecipeError",
    "Result",
    "Series",
    "Step",
    "Streams",
    "as_exemplar",
    "available_methods",
    "compare",
    "describe",
    "exemplar_of",
    "find_method",
    "progress_bar",
    "read_recipe",
    "register",
    "run",
    "save_result",
    "sweep",
    "synthesize",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOME_OF[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
