"""Numbers as a code holds them: 7 significant digits, so that a file says what was measured, bit for bit."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


def keep_digits(values: Iterable[float]) -> tuple[float, ...]:
    """Return numbers rounded to 7 significant digits, about the precision of float32."""
    return tuple(float(f"{float(value):.7g}") for value in values)
