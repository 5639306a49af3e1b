"""Numbers as text: one way to write them in the whole window."""

from __future__ import annotations

import math
import re

import numpy as np

_NUMBER = re.compile(r"[+-]?(\d+([.,٫]\d*)?|[.,٫]\d+)([eE][+-]?\d+)?")


def log_ticks(low: float, high: float, apart: float) -> list[tuple[float, str]]:
    """Return (log10 of the value, text) of round values between two logarithms, at least ``apart`` apart."""
    powers = range(int(np.floor(low)) - 1, int(np.ceil(high)) + 1)
    ticks: list[float] = []
    # Powers of ten first; then what still has room between them.
    for factors in ((1,), (2, 5), (3, 7)):
        for power in powers:
            for factor in factors:
                place = power + float(np.log10(factor))
                if low <= place <= high and all(abs(place - other) >= apart for other in ticks):
                    ticks.append(place)
    if len(ticks) > 1 or high <= low:
        return [(place, number(float(f"{10**place:.1g}"))) for place in sorted(ticks)]
    # Too little lies between the limits: even steps of 1, 2 or 5 instead of the round values of a logarithm.
    bottom, top = 10.0**low, 10.0**high
    least = max(top - bottom, 1e-300) / max(1, int((high - low) / apart))
    power = 10.0 ** np.floor(np.log10(least))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= least * (1 - 1e-9))
    values = [k * step for k in range(int(np.ceil(bottom / step)), int(np.floor(top / step)) + 1)]
    return [(float(np.log10(value)), number(float(f"{value:.6g}"))) for value in values]


def even_ticks(low: float, high: float, most: int) -> list[tuple[float, str]]:
    """Return (value, text) of round values between two limits in steps of 1, 2 or 5: ``most`` steps or fewer."""
    span = high - low
    if not (math.isfinite(span) and span > 0):
        return []
    power = 10.0 ** math.floor(math.log10(span / most))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= span / most * (1 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    large = max(abs(low), abs(high)) >= 1e5 or decimals > 4
    values = [k * step for k in range(first, last + 1)]
    return [(value, f"{value:.3g}" if large else f"{value + 0.0:.{decimals}f}") for value in values]


def number(value: float) -> str:
    """Return a number with four digits that matter (whole numbers with all), for tables and read-outs."""
    value = value + 0.0  # no minus before zero
    if not np.isfinite(value):
        return "none"
    if value == round(value) and abs(value) < 1e7:
        return f"{value:.0f}"
    if abs(value) >= 1e5 or abs(value) < 1e-4:
        return f"{value:.2e}"
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.4g}"


def duration(seconds: float) -> str:
    """Return how long something took: two digits that tell, in the largest unit that is not less than one."""
    if seconds < 0.0995:
        return f"{seconds * 1000:.0f} ms"
    if seconds < 9.995:
        return f"{seconds:.2f} s"
    return remaining(seconds)


def remaining(seconds: float) -> str:
    """Return how long something will take: nobody knows it better than to the second, or to half a minute."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.1f} min" if seconds < 10 * 60 else f"{seconds / 60:.0f} min"


def clock_text(seconds: int) -> str:
    """Return a time as a clock shows it: 5:09, 1:05:09."""
    minutes, rest = divmod(seconds, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def parse_number(text: str) -> float | None:
    """Return the number that a text is, or None.

    Both decimal signs are read, 0.25 and 0,25, and the digits of any script. Nothing separates thousands:
    "1.234,5" is no number, rather than one of two.
    """
    text = text.strip().replace("\u2212", "-")
    if not _NUMBER.fullmatch(text):
        return None
    value = float(re.sub("[,٫]", ".", text))
    return value if math.isfinite(value) else None


def parse_list(text: str) -> list[str]:
    """Return the items of a list of numbers as they are typed, each with a point for its decimal sign.

    Semicolons and spaces separate; a comma does too where a space follows it, where several stand without a
    space ("1,2,3"), or where points are the decimal signs. So "0,1; 0,2" and "0.1, 0.2" are both two numbers.
    """
    has_points = "." in text
    if not has_points and not re.search(r"[;\s]", text.strip()) and text.count(",") > 1:
        has_points = True
    separators = r"[;\s,]+" if has_points else r"(?:[;\s]|,(?=\s|$))+"
    items = [item for item in re.split(separators, text.strip()) if item]
    return [item.replace(",", ".").replace("٫", ".") for item in items]
