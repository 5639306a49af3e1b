"""The 69 numbers of an MSG code as cells that can be shown, dragged and typed. No Qt."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab_core.methods.spectral.code import MsgCode, Residual
from texlab_core.methods.spectral.digits import keep_digits
from texlab_core.methods.spectral.marginal import SAMPLES, Histogram16
from texlab_core.transforms.gabor_bank import CHANNELS, ORIENTATIONS, WIDTHS, channel_name

if TYPE_CHECKING:
    from numpy.typing import NDArray

Group = Literal["energy", "u", "v", "residual", "histogram"]
RESIDUAL = tuple(each.name for each in fields(Residual))
SIZES: dict[Group, int] = {
    "energy": CHANNELS,
    "u": CHANNELS,
    "v": CHANNELS,
    "residual": len(RESIDUAL),
    "histogram": SAMPLES,
}
COLUMNS: dict[Group, int] = {"energy": ORIENTATIONS, "u": ORIENTATIONS, "v": ORIENTATIONS, "residual": 1}
# What a file of a code may hold.
MAX_RMS, MAX_MODULUS, MIN_BANDWIDTH, MAX_BANDWIDTH, MAX_SAMPLE = 255.0, 1e7, 1e-6, 1.0, 2.0
# Gray levels for which one number of the histogram stands.
LEVELS = {"samples": 17, "blocks": 16}
# From zero a value is dragged up from this share of the largest of its group.
_FIRST = 0.02
_PLACES = {
    "mean": "mean gray level",
    "u_axis": "modulus, horizontal waves",
    "v_axis": "modulus, vertical waves",
    "falling": "modulus, falling waves",
    "rising": "modulus, rising waves",
}


@dataclass(frozen=True)
class Number:
    """One of the 69 numbers: its group and its place in it."""

    group: Group
    place: int


def values(code: MsgCode, group: Group) -> NDArray[np.float64]:
    """Return the numbers of a group in the unit in which they are shown.

    Energies as rms in per cent of the mean (Table 2 of the paper); bandwidths in per cent of the filter's width,
    of which white noise has 71; the residual in gray levels; the histogram in per cent of the pixels.
    """
    if group == "energy":
        return np.asarray(100 * np.sqrt(np.array(code.energies)) / _mean(code))
    if group == "u":
        return np.asarray(100 * np.array(code.bandwidths_u) / WIDTHS)
    if group == "v":
        return np.asarray(100 * np.array(code.bandwidths_v) / WIDTHS)
    if group == "residual":
        return np.array([getattr(code.residual, name) for name in RESIDUAL])
    histogram = code.tone.histogram
    return np.array(histogram.values) * _histogram_factor(histogram)


def value(code: MsgCode, number: Number) -> float:
    """Return one number in the unit in which it is shown."""
    return float(values(code, number.group)[number.place])


def limits(code: MsgCode, number: Number) -> tuple[float, float]:
    """Return the range of a number in the unit in which it is shown."""
    if number.group == "energy":
        return 0.0, 100 * MAX_RMS / _mean(code)
    if number.group in ("u", "v"):
        width = float(WIDTHS[number.place])
        return 100 * MIN_BANDWIDTH / width, 100 * MAX_BANDWIDTH / width
    if number.group == "residual":
        return 0.0, 255.0 if RESIDUAL[number.place] == "mean" else MAX_MODULUS
    histogram = code.tone.histogram
    factor = _histogram_factor(histogram)
    # The coding can make samples negative, by hand they cannot be.
    return min(0.0, histogram.values[number.place] * factor), MAX_SAMPLE * factor


def with_value(code: MsgCode, number: Number, wanted: float) -> MsgCode:
    """Return a code with one number changed, as near to ``wanted`` as its range allows.

    A histogram keeps at least one number above zero: without any it says nothing.
    """
    low, high = limits(code, number)
    wanted = min(max(wanted, low), high) if np.isfinite(wanted) else value(code, number)
    place = number.place
    if number.group == "energy":
        energies = _changed(code.energies, place, min((wanted * _mean(code) / 100) ** 2, MAX_RMS**2))
        return replace(code, energies=energies)
    if number.group == "u":
        return replace(code, bandwidths_u=_changed(code.bandwidths_u, place, _bandwidth(wanted, place)))
    if number.group == "v":
        return replace(code, bandwidths_v=_changed(code.bandwidths_v, place, _bandwidth(wanted, place)))
    if number.group == "residual":
        (kept,) = keep_digits([wanted])
        return replace(code, residual=replace(code.residual, **{RESIDUAL[place]: kept}))
    histogram = code.tone.histogram
    changed = _changed(histogram.values, place, min(wanted / _histogram_factor(histogram), MAX_SAMPLE))
    if max(changed) < 1e-6:
        return code
    return replace(code, tone=replace(code.tone, histogram=replace(histogram, values=changed)))


def dragged(code: MsgCode, number: Number, steps: float) -> float:
    """Return what a number becomes when it is dragged up by so many steps.

    A step is a tenth of an octave; for the mean gray level, which may be near zero, 2 levels.
    """
    start = value(code, number)
    if number.group == "residual" and RESIDUAL[number.place] == "mean":
        return start + 2 * steps
    if start <= 0 < steps:
        start = _FIRST * float(values(code, number.group).max()) or 1.0
    return start * float(2.0 ** (0.1 * steps))


def differs(code: MsgCode, other: MsgCode | None, group: Group) -> NDArray[np.bool_]:
    """Return which numbers of a group are not as in another code; none without one."""
    if other is None:
        return np.zeros(SIZES[group], bool)
    if group == "histogram" and code.tone.histogram.kind != other.tone.histogram.kind:
        return np.ones(SAMPLES, bool)
    here, there = (np.array(_stored(each, group)) for each in (code, other))
    return np.asarray(here != there)


def title(number: Number) -> str:
    """Return the name of a number."""
    if number.group == "energy":
        return f"energy {channel_name(number.place)}"
    if number.group in ("u", "v"):
        return f"bandwidth {number.group} {channel_name(number.place)}"
    if number.group == "residual":
        return f"residual, {_PLACES[RESIDUAL[number.place]]}"
    return f"histogram {number.place + 1}"


def unit(number: Number) -> str:
    """Return the unit in which a number is shown."""
    if number.group == "energy":
        return "% of mean"
    if number.group == "histogram":
        return "% of pixels"
    return "" if number.group == "residual" else "% of filter"


def _stored(code: MsgCode, group: Group) -> tuple[float, ...]:
    if group == "residual":
        return tuple(getattr(code.residual, name) for name in RESIDUAL)
    return {
        "energy": code.energies,
        "u": code.bandwidths_u,
        "v": code.bandwidths_v,
        "histogram": code.tone.histogram.values,
    }[group]


def _mean(code: MsgCode) -> float:
    # A picture darker than a gray level would have endless percentages.
    return max(code.residual.mean, 1.0)


def _bandwidth(per_cent: float, place: int) -> float:
    return min(max(per_cent / 100 * float(WIDTHS[place]), MIN_BANDWIDTH), MAX_BANDWIDTH)


def _histogram_factor(histogram: Histogram16) -> float:
    return 100.0 * (LEVELS["samples"] if histogram.kind == "samples" else 1)


def _changed(numbers: tuple[float, ...], place: int, wanted: float) -> tuple[float, ...]:
    (kept,) = keep_digits([wanted])
    return (*numbers[:place], kept, *numbers[place + 1 :])
