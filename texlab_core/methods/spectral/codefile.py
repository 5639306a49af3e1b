"""The MSG code as a file: versioned JSON, ``X.msg.json``, a few hundred numbers' worth of text."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar, cast

import numpy as np

from texlab_core.engine.inputs import DataInput
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.whole import write_whole
from texlab_core.methods.spectral.code import BANDWIDTH_AXES, BANDWIDTH_MEASURES, MsgCode, Residual
from texlab_core.methods.spectral.marginal import HISTOGRAM_KINDS, SAMPLES, Histogram16
from texlab_core.methods.spectral.tone import Colours, Tone, Vector
from texlab_core.transforms.gabor_bank import CHANNELS, OCTAVES, ORIENTATIONS

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from texlab_core.methods.spectral.choices import BandwidthAxes, BandwidthMeasure, HistogramKind

FORMAT = "texlab-msg"
VERSION = 1
SUFFIX = ".msg.json"
MAX_NAME = 300
_MAX_ENERGY = 255.0**2
_MAX_MODULUS = 1e7
_KEYS = (
    "format",
    "version",
    "exemplar",
    "energies",
    "bandwidth_measure",
    "bandwidth_axes",
    "bandwidths_u",
    "bandwidths_v",
    "residual",
    "histogram",
    "colours",
)
_OPTIONAL = ("exemplar", "bandwidth_axes", "colours")
_RESIDUAL = ("mean", "u_axis", "v_axis", "falling", "rising")
WordT = TypeVar("WordT", bound=str)


class CodeError(InputError):
    """An MSG code that is malformed, newer or hostile."""


@dataclass(frozen=True)
class CodeFile:
    """A code and the name of the exemplar it was measured on ("" when that is unknown)."""

    code: MsgCode
    exemplar: str = ""


def code_to_json(code: MsgCode, exemplar: str = "") -> dict[str, Any]:
    """Return a code as JSON data: its 69 or 113 numbers, and words that say what they are."""
    data: dict[str, Any] = {"format": FORMAT, "version": VERSION}
    if exemplar:
        data["exemplar"] = exemplar[:MAX_NAME]
    data |= {
        "energies": _table(code.energies),
        "bandwidth_measure": code.measure,
        # Left out where they are the paper's: such codes are as they always were.
        **({"bandwidth_axes": code.axes} if code.axes != "uv" else {}),
        "bandwidths_u": _table(code.bandwidths_u),
        "bandwidths_v": _table(code.bandwidths_v),
        "residual": {key: getattr(code.residual, key) for key in _RESIDUAL},
        "histogram": {"kind": code.tone.histogram.kind, "values": list(code.tone.histogram.values)},
    }
    if (colours := code.tone.colours) is not None:
        data["colours"] = {
            "mean": list(colours.mean),
            "axes": [list(axis) for axis in colours.axes],
            "curves": [list(curve) for curve in colours.curves],
        }
    return data


def code_from_json(data: object, *, what: str = "the code") -> CodeFile:
    """Build a code from JSON data.

    Raises
    ------
    CodeError
        With one sentence that starts with ``what``.
    """
    try:
        return _from_json(data)
    except CodeError as bad:
        raise CodeError(f"{what[:1].upper()}{what[1:]} cannot be used: {bad}") from None


def code_input(code: MsgCode, name: str = "code") -> DataInput:
    """Return a code as the input ``code`` of the method ``msg``."""
    return DataInput(code_to_json(code), name)


def read_code(source: Path | str | bytes, *, what: str | None = None) -> CodeFile:
    """Read a code from a file (a ``Path``) or from its text.

    Raises
    ------
    CodeError
        With one sentence when it cannot be read, is malformed, newer or hostile.
    """
    data, name = strict_json.read(source, "the code", what=what, error=CodeError)
    return code_from_json(data, what=name)


def write_code(code: MsgCode, path: str | os.PathLike[str], exemplar: str = "") -> None:
    """Write a code under a temporary name, then rename; raises ``InputError`` when that fails."""
    write_whole(path, (_layout(code_to_json(code, exemplar)) + "\n").encode())


def load_code_input(path: Path) -> DataInput:
    """Read a file as the input ``code`` of the method ``msg``, checked; raises :class:`CodeError`."""
    return code_input(read_code(path).code, path.name)


def _from_json(given: object) -> CodeFile:
    data = strict_json.check_document(given, "MSG code", form=FORMAT, version=VERSION, error=CodeError)
    _check_keys("key", data, _KEYS, _OPTIONAL)
    exemplar = data.get("exemplar", "")
    if not isinstance(exemplar, str) or len(exemplar) > MAX_NAME or not (exemplar.isprintable()):
        _refuse("exemplar", f"at most {MAX_NAME} printable characters", exemplar)
    measure = _word("bandwidth_measure", data["bandwidth_measure"], BANDWIDTH_MEASURES)
    axes = _word("bandwidth_axes", data.get("bandwidth_axes", "uv"), BANDWIDTH_AXES)
    residual = _object("residual", data["residual"], _RESIDUAL)
    limits = [(0.0, 255.0 if key == "mean" else _MAX_MODULUS) for key in _RESIDUAL]
    code = MsgCode(
        energies=_channels("energies", data["energies"], 0.0, _MAX_ENERGY),
        bandwidths_u=_channels("bandwidths_u", data["bandwidths_u"], 1e-6, 1.0),
        bandwidths_v=_channels("bandwidths_v", data["bandwidths_v"], 1e-6, 1.0),
        measure=cast("BandwidthMeasure", measure),
        residual=Residual(
            *(
                _number(f"residual.{key}", residual[key], low, high)
                for key, (low, high) in zip(_RESIDUAL, limits, strict=True)
            )
        ),
        tone=Tone(_histogram(data["histogram"]), _colours(data.get("colours"))),
        axes=cast("BandwidthAxes", axes),
    )
    return CodeFile(code, exemplar)


def _histogram(data: object) -> Histogram16:
    given = _object("histogram", data, ("kind", "values"))
    kind = cast("HistogramKind", _word("histogram.kind", given["kind"], HISTOGRAM_KINDS))
    # The odd extension of the low-passed histogram can make samples negative, masses cannot be.
    low = -2.0 if kind == "samples" else 0.0
    values = _numbers("histogram.values", given["values"], SAMPLES, low, 2.0)
    if max(values) < 1e-9:
        raise CodeError("histogram.values: must hold at least one number above 0.")
    return Histogram16(kind, values)


def _colours(data: object) -> Colours | None:
    if data is None:
        return None
    given = _object("colours", data, ("mean", "axes", "curves"))
    axes = tuple(
        cast("Vector", _numbers("colours.axes", axis, 3, -1.001, 1.001))
        for axis in _list("colours.axes", given["axes"], 3)
    )
    if np.abs(np.array(axes) @ np.array(axes).T - np.eye(3)).max() > 1e-3:
        raise CodeError("colours.axes: must be three orthogonal directions of length 1.")
    first, second = (
        _numbers("colours.curves", curve, SAMPLES, -500.0, 500.0)
        for curve in _list("colours.curves", given["curves"], 2)
    )
    mean = cast("Vector", _numbers("colours.mean", given["mean"], 3, 0.0, 255.0))
    return Colours(mean, cast("tuple[Vector, Vector, Vector]", axes), (first, second))


def _channels(name: str, data: object, low: float, high: float) -> tuple[float, ...]:
    rows = _list(name, data, OCTAVES)
    values = tuple(value for row in rows for value in _numbers(name, row, ORIENTATIONS, low, high))
    assert len(values) == CHANNELS
    return values


def _numbers(name: str, data: object, count: int, low: float, high: float) -> tuple[float, ...]:
    return tuple(_number(name, value, low, high) for value in _list(name, data, count))


def _number(name: str, value: object, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        _refuse(name, f"a number from {low:g} to {high:g}", value)
    try:
        number = float(value)
    except OverflowError:
        _refuse(name, f"a number from {low:g} to {high:g}", value)
    # NaN compares false and fails too.
    if not (math.isfinite(number) and low <= number <= high):
        _refuse(name, f"a number from {low:g} to {high:g}", value)
    return number


def _list(name: str, data: object, count: int) -> Sequence[object]:
    if not isinstance(data, list) or len(data) != count:
        _refuse(name, f"a list of {count}", data)
    return data


def _object(name: str, data: object, keys: Sequence[str]) -> Mapping[str, object]:
    if not isinstance(data, dict):
        _refuse(name, f"an object with {', '.join(keys)}", data)
    _check_keys(f"{name} key", data, keys, ())
    return data


def _word(name: str, data: object, words: Sequence[str]) -> str:
    if not isinstance(data, str) or data not in words:
        _refuse(name, f"one of {', '.join(words)}", data)
    return data


def _check_keys(name: str, data: Mapping[Any, object], known: Sequence[str], optional: Sequence[str]) -> None:
    for key in data:
        if key not in known:
            _refuse(name, f"one of {', '.join(known)}", key)
    for key in known:
        if key not in data and key not in optional:
            raise CodeError(f"{name} {key}: is missing.")


def _refuse(name: str, allowed: str, given: object) -> NoReturn:
    raise CodeError(f"{name}: must be {allowed}, got {strict_json.shorten(given)}.")


def _table(values: tuple[float, ...]) -> list[list[float]]:
    return [list(values[start : start + ORIENTATIONS]) for start in range(0, CHANNELS, ORIENTATIONS)]


def _layout(data: Any, margin: str = "") -> str:
    """Return JSON text with one row of numbers on a line."""
    inner = margin + "  "
    if isinstance(data, dict):
        lines = [f"{inner}{json.dumps(key)}: {_layout(value, inner)}" for key, value in data.items()]
        return "{\n" + ",\n".join(lines) + f"\n{margin}}}"
    if isinstance(data, list) and data and isinstance(data[0], list):
        return "[\n" + ",\n".join(f"{inner}{json.dumps(row)}" for row in data) + f"\n{margin}]"
    return json.dumps(data, ensure_ascii=False, allow_nan=False)
