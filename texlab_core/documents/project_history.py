"""The earlier results of a column in a project file: what makes each again, and one picture of all, small.

The pictures lie below each other in one file for each column, so that a long history is no long list of files.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.documents.recipe import known_measures, measures_from_json
from texlab_core.engine.job import check_seed, check_size
from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_from_json, size_to_json
from texlab_core.errors import InputError
from texlab_core.files import strict_json

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Input
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method

MOST = 24
SIDE = 64
_KEYS = ("method", "parameters", "inputs", "size", "seed", "measures", "thumbnail")


@dataclass(frozen=True, eq=False)
class ProjectPast:
    """An earlier result of the project's exemplar.

    Parameters
    ----------
    method, params, inputs, size, seed
        What it was made with, besides the exemplar.
    thumbnail
        (h, w, 3) uint8, at most 64 pixels wide and high.
    measures
        Numbers about the result by the ids of their measures.
    """

    method: str
    params: Params
    size: tuple[int, ...]
    seed: int
    thumbnail: NDArray[np.uint8]
    inputs: Mapping[str, Input] = field(default_factory=dict)
    measures: Mapping[str, float] = field(default_factory=dict)


def past_to_json(past: ProjectPast, name_of: Callable[[Input], str]) -> dict[str, Any]:
    """Return one of them as JSON; ``name_of`` returns the name of an input in the project."""
    return {
        "method": past.method,
        "parameters": past.params.to_json(),
        "inputs": {role: name_of(each) for role, each in past.inputs.items()},
        "size": size_to_json(past.size),
        "seed": past.seed,
        "measures": known_measures(past.measures),
        "thumbnail": list(past.thumbnail.shape[:2]),
    }


def encode_thumbnails(history: Sequence[ProjectPast]) -> bytes:
    """Return their small pictures below each other, as a PNG file."""
    from texlab_core.images.formats.writing import encode_png

    sheet = np.zeros((sum(len(past.thumbnail) for past in history), SIDE, 3), np.uint8)
    top = 0
    for past in history:
        height, width = past.thumbnail.shape[:2]
        sheet[top : top + height, :width] = past.thumbnail
        top += height
    return encode_png(sheet)


def history_from_json(
    data: Any, sheet: bytes, inputs_of: Callable[[dict[str, Any], Method], dict[str, Input]]
) -> tuple[ProjectPast, ...]:
    """Return the earlier results of a column, checked; without those that are of another program's methods.

    What a plug-in or another version made, whose method or parameters are not known here, is left out.

    Parameters
    ----------
    data
        A list of what :func:`past_to_json` returned, from a file.
    sheet
        What :func:`encode_thumbnails` returned; b"" when it is missing.
    inputs_of
        Returns the inputs of a method from their names in the project.

    Raises
    ------
    InputError
        One sentence when anything is malformed.
    """
    from texlab_core.images.formats.reading import read_image

    if not isinstance(data, list) or len(data) > MOST:
        raise InputError(f"history: must be a list of at most {MOST}.")
    if not data:
        return ()
    sizes = [_thumbnail_size(each) for each in data]
    if not sheet.startswith(b"\x89PNG"):
        raise InputError("the pictures of a history are missing.")
    values = read_image(sheet, "the pictures of a history").values
    if values.ndim == 3 and values.shape[2] == 1:
        values = values.repeat(3, axis=2)
    wanted = (sum(height for height, _ in sizes), SIDE, 3)
    if values.shape != wanted or values.dtype != np.uint8:
        raise InputError("the pictures of a history do not have their sizes.")
    found, top = [], 0
    for each, (height, width) in zip(data, sizes, strict=True):
        past = _past(each, np.ascontiguousarray(values[top : top + height, :width]), inputs_of)
        if past is not None:
            found.append(past)
        top += height
    return tuple(found)


def _thumbnail_size(data: Any) -> tuple[int, int]:
    if not isinstance(data, dict):
        raise InputError(f"history: must have objects, got {strict_json.shorten(data)}.")
    strict_json.check_keys(data, _KEYS, InputError)
    size = data.get("thumbnail")
    if not (isinstance(size, list) and len(size) == 2 and all(type(s) is int and 1 <= s <= SIDE for s in size)):
        raise InputError(f"thumbnail: must be two whole numbers of 1 to {SIDE}, got {strict_json.shorten(size)}.")
    return size[0], size[1]


def _past(
    data: dict[str, Any],
    thumbnail: NDArray[np.uint8],
    inputs_of: Callable[[dict[str, Any], Method], dict[str, Input]],
) -> ProjectPast | None:
    parameters, inputs, method = data.get("parameters"), data.get("inputs"), data.get("method")
    if not isinstance(method, str) or not isinstance(parameters, dict) or not isinstance(inputs, dict):
        raise InputError("history: method must be a name, parameters and inputs objects.")
    known = _known(method)
    # Also what is left out must be well formed, as far as that can be told.
    given = data.get("size")
    solid = isinstance(given, dict) and "depth" in given
    dimensions = known.dimensions if known is not None else 3 if solid else 2
    size = check_size(size_from_json(given, dimensions), dimensions)
    seed, measures = check_seed(data.get("seed")), measures_from_json(data.get("measures", {}))
    if known is None:
        return None
    made_of = frozen_mapping(inputs_of(inputs, known))
    try:
        params = known.params.from_json(parameters)
    except InputError:
        return None
    return ProjectPast(known.id, params, size, seed, thumbnail, made_of, measures)


def _known(method: str) -> Method | None:
    try:
        return find_method(method)
    except InputError:
        return None
