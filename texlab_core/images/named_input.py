"""A named input of a method from a file or the gallery, read as its kind wants it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from texlab_core.engine.inputs import ArraysInput, DataInput, Input
from texlab_core.errors import InputError, ParamError
from texlab_core.files import strict_json
from texlab_core.files.regular import open_regular, reason
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from texlab_core.engine.inputs import Crop
    from texlab_core.engine.registry import InputSpec, Method
    from texlab_core.images.unit_range import Alpha


def spec_of(method: Method, name: str) -> InputSpec:
    """Return what a method says of an input; raises ``ParamError`` when it has none of that name."""
    specs = {spec.name: spec for spec in method.inputs}
    if name not in specs:
        raise ParamError("input", f"one of {', '.join(specs)} for {method.title}", name)
    return specs[name]


def read_input(
    place: str,
    spec: InputSpec,
    *,
    scale: float = 1.0,
    crop: Crop | None = None,
    alpha: Alpha = "background",
    background: float | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Input:
    """Read an input of a method.

    Parameters
    ----------
    place
        A file, or ``gallery:NAME`` for an image.
    spec
        What the method says of it.
    scale, crop, alpha, should_stop
        As in :func:`texlab_core.images.exemplar.as_exemplar`; an input that is no image takes neither of the first
        two.
    background
        Gray level under transparent pixels, 0 to 1; None takes what the method says.

    Raises
    ------
    InputError
        When it cannot be read, is of another kind, or is no image and is to be scaled or cropped.
    """
    if spec.kind == "image":
        level = spec.background if background is None else background
        return as_exemplar(place, scale=scale, crop=crop, alpha=alpha, background=level, should_stop=should_stop)
    if scale != 1.0 or crop is not None:
        raise InputError(f"The input {spec.name} is no image: it can be neither scaled nor cropped.")
    path = Path(place)
    if spec.kind == "arrays":
        return read_arrays(path)
    if spec.read is not None:
        return spec.read(path)
    return DataInput(strict_json.load(path, what=f"the input {spec.name}"), path.name)


def inputs_of(methods: Sequence[Method], given: Mapping[str, object]) -> dict[str, Input]:
    """Return named inputs of what Python has in its place.

    Parameters
    ----------
    methods
        Whose inputs they are; the first that knows a name says what it takes.
    given
        By name: what :func:`read_input` reads, an array for an image, a mapping of arrays or JSON data for the
        other kinds, or an input. What no method knows stays as it is.

    Raises
    ------
    InputError
        When one cannot be read or converted.
    """
    specs = {spec.name: spec for method in reversed(methods) for spec in method.inputs}
    found: dict[str, Any] = {}
    for name, each in given.items():
        spec = specs.get(name)
        found[name] = each if spec is None else _converted(each, spec)
    return found


def _converted(given: Any, spec: InputSpec) -> Any:
    if isinstance(given, Input):
        return given
    if isinstance(given, str | os.PathLike):
        return read_input(os.fspath(given), spec)
    if spec.kind == "image":
        return as_exemplar(given, background=spec.background)
    if spec.kind == "arrays":
        return ArraysInput(given, spec.name) if isinstance(given, Mapping) else given
    return DataInput(given, spec.name)


def read_arrays(path: Path) -> ArraysInput:
    """Read named arrays from an .npz file; raises ``InputError``."""
    import zipfile

    import numpy as np

    try:
        with open_regular(path) as file, np.load(file, allow_pickle=False) as held:
            return ArraysInput({name: held[name] for name in held.files}, path.name)
    except OSError as error:
        raise InputError(f"{path}: cannot be opened ({reason(error)}).") from error
    except (AttributeError, TypeError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(f"{path}: is no .npz file of arrays.") from error
