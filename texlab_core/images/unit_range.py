"""Stored values become gray or RGB in [0, 1]: what integers and floats mean, and what becomes of transparency."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.errors import Cancelled, ImageError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.images.formats.decoded import Decoded

Alpha = Literal["background", "ignore", "keep"]
ALPHA: tuple[Alpha, ...] = ("background", "ignore", "keep")
# What one may choose: the use, and the background over which transparent pixels are laid.
TRANSPARENCY: dict[str, tuple[Alpha, float]] = {
    "white": ("background", 1.0),
    "black": ("background", 0.0),
    "ignore": ("ignore", 1.0),
    "keep": ("keep", 1.0),
}
_IGNORED = "The alpha channel was ignored."
_KEPT = "The alpha channel was kept aside, and the colours used as they are."
_LAID = "Transparent pixels were laid over "
FLOAT_PEAKS = (1, 255, 65535)
_ROWS_BYTES = 2**24
_MOST_SAMPLED = 2**20
_INSIDE = 0.99
# Sharpening and resizing go somewhat beyond black and white.
_OVERSHOOT = 0.05
_LOW, _HIGH = 0.5, 99.5
_LEAST_SHARE = 0.25
# One level of 255 below opaque: what programs leave behind when they blend.
_OPAQUE = 254 / 255 - 1e-6


@dataclass(frozen=True, slots=True)
class Range:
    """The values that become 0 and 1."""

    low: float
    high: float

    def applied(self, values: NDArray[Any]) -> FloatImage:
        """Return the values in [0, 1] as float32."""
        if (self.low, self.high) == (0, 1):
            # Adding zero makes negative zeros positive; they would change the hash.
            unit: FloatImage = np.clip(values, 0, 1).astype(np.float32) + np.float32(0)
            return unit
        # Halves keep the span of the largest floats finite.
        span = self.high / 2 - self.low / 2
        if span == 0:
            return np.full(values.shape, 0.5, np.float32)
        mapped = (values.astype(np.float64) / 2 - self.low / 2) / span
        return np.clip(mapped, 0, 1).astype(np.float32)


class UnitRange:
    """A decoded image, band by band, in [0, 1].

    Floats from 0 to 1 are used as they are. Other floats, and integers with sign, are read as 0 to P for the first
    P of 1, 255 and 65535 such that 99 % of the values lie in [0, P] or at most P / 20 outside, and the 99.5
    percentile is at least P / 4; what lies outside [0, P] is clipped. Where there is none, the 0.5 and 99.5
    percentiles become 0 and 1. Percentiles are of at most a million values, evenly spaced. A note says what was
    done.

    Parameters
    ----------
    decoded
        As a reader returned it.
    name
        For messages.
    background
        Gray level under transparent pixels, 0 to 1.
    alpha
        "background": transparent pixels are laid over it. "ignore": colours are used as stored. "keep": so are
        they, and alpha comes beside them. An alpha of at least 254 of 255 everywhere is none.
    first_rules
        Those of the first version, which old recipes need: floats beyond 0 to 1 are mapped from the least to the
        greatest, and only an alpha of 1 everywhere is none.

    Raises
    ------
    ImageError
        When values are not finite, or integers exceed their peak.
    """

    def __init__(
        self, decoded: Decoded, name: str, background: float, alpha: Alpha, *, first_rules: bool = False
    ) -> None:
        self._first_rules = first_rules
        self._values = decoded.values
        self._peak = decoded.peak
        self._premultiplied = decoded.premultiplied
        self._background = np.float32(background)
        self.notes = list(decoded.notes)
        self._colours = self._values.shape[2] - (self._values.shape[2] in (2, 4))
        if self._peak is None:
            self._range = self._range_of_floats(name)
        else:
            self._range = Range(0, self._peak)
            if (largest := int(self._values.max())) > self._peak:
                raise ImageError(f"{name}: has the value {largest}, and at most {self._peak} was expected.")
        self._alpha = self._use_of_alpha(alpha)

    @property
    def has_alpha(self) -> bool:
        """Whether alpha comes beside the colours."""
        return self._alpha == "keep"

    @property
    def channels(self) -> int:
        """Of the colours: 1 or 3."""
        return int(self._colours)

    def bands(
        self, should_stop: Callable[[], bool] | None = None
    ) -> Iterator[tuple[int, FloatImage, FloatImage | None]]:
        """Yield the first row, colours (rows, W, C) and alpha (rows, W, 1) or None, from top to bottom.

        Raises
        ------
        Cancelled
            When ``should_stop`` says so between two bands.
        """
        height, width, samples = self._values.shape
        rows = max(1, _ROWS_BYTES // (width * samples * 4))
        for top in range(0, height, rows):
            if should_stop is not None and should_stop():
                raise Cancelled
            yield top, *self._band(self._values[top : top + rows])

    def _band(self, values: NDArray[Any]) -> tuple[FloatImage, FloatImage | None]:
        colours = self._in_range(values[..., : self._colours])
        if self._alpha is None:
            return colours, None
        opacity = self._in_range(values[..., self._colours :], alpha=True)
        if self._alpha == "background":
            laid = colours if self._premultiplied else colours * opacity
            laid = laid + (1 - opacity) * self._background
            return laid.clip(0, 1), None
        if self._premultiplied:
            colours = (colours / np.maximum(opacity, np.float32(1e-6))).clip(0, 1)
        return colours, opacity if self._alpha == "keep" else None

    def _in_range(self, values: NDArray[Any], *, alpha: bool = False) -> FloatImage:
        if self._peak is None:
            chosen = self._range
            # Alpha has the scale of the colours only where that is one of the usual ones.
            if alpha and (chosen.low != 0 or chosen.high not in FLOAT_PEAKS or float(values.max()) <= 1):
                chosen = Range(0, 1)
            return chosen.applied(values)
        if self._peak <= 65535:
            # Both are exact in float32, so that k / peak is rounded once.
            pixels: FloatImage = np.divide(values, np.float32(self._peak), dtype=np.float32)
            return pixels
        return (values.astype(np.float64) / self._peak).astype(np.float32)

    def _range_of_floats(self, name: str) -> Range:
        colours, alpha = self._values[..., : self._colours], self._values[..., self._colours :]
        low, high = float(colours.min()), float(colours.max())
        if not (math.isfinite(low) and math.isfinite(high)):
            count = int(colours.size - np.count_nonzero(np.isfinite(colours)))
            raise ImageError(f"{name}: {count} of {colours.size} values are not finite (NaN or infinite).")
        if not np.isfinite(alpha).all():
            raise ImageError(f"{name}: the alpha channel has values that are not finite.")
        if low >= 0 and high <= 1:
            return Range(0, 1)
        if self._first_rules:
            return Range(low, high)
        flat = colours.reshape(-1)
        # Halves and whole numbers of few bits could not hold the limits.
        sample = flat[:: 1 + flat.size // _MOST_SAMPLED].astype(np.float64)
        # The nearest values that occur: interpolation would overflow between the largest floats.
        least = float(np.percentile(sample, _LOW, method="lower"))
        most = float(np.percentile(sample, _HIGH, method="higher"))
        for peak in FLOAT_PEAKS:
            inside = np.count_nonzero((sample >= -_OVERSHOOT * peak) & (sample <= (1 + _OVERSHOOT) * peak))
            if inside >= _INSIDE * sample.size and most >= _LEAST_SHARE * peak:
                outside = int(np.count_nonzero((colours < 0) | (colours > peak)))
                said = f"Values from {low:g} to {high:g} were read as 0 to {peak}"
                self.notes.append(f"{said}; {outside} outside were clipped." if outside else f"{said}.")
                return Range(0, peak)
        if least == most:
            share = "All" if low == high else "Nearly all"
            self.notes.append(f"{share} values are {least:g}, outside 0 to 1, and were set to 0.5.")
        elif (least, most) == (low, high):
            self.notes.append(f"Values from {low:g} to {high:g} were mapped to 0 to 1.")
        else:
            self.notes.append(
                f"Values from {low:g} to {high:g}: those from {least:g} to {most:g} (0.5 and 99.5 percentiles) "
                "were mapped to 0 to 1, and the others clipped."
            )
        return Range(least, most)

    def _use_of_alpha(self, alpha: Alpha) -> Alpha | None:
        if self._values.shape[2] == self._colours:
            return None
        least = float(self._in_range(self._values[..., self._colours :].min(keepdims=True), alpha=True).min())
        if least >= (1 if self._first_rules else _OPAQUE):
            nearly = "" if least == 1 else " (at least 254 of 255)"
            self.notes.append(f"The alpha channel is opaque everywhere{nearly} and was dropped.")
            return None
        if alpha == "ignore":
            self.notes.append(_IGNORED)
        elif alpha == "keep":
            self.notes.append(_KEPT)
        else:
            shown = {0.0: "black", 1.0: "white"}.get(float(self._background), f"gray {self._background:g}")
            self.notes.append(f"{_LAID}{shown}.")
        return alpha


def use_of_alpha(notes: Iterable[str]) -> Alpha | None:
    """Return what became of a picture's transparency, by what was said of it; None where there was none."""
    for note in notes:
        if note == _IGNORED:
            return "ignore"
        if note == _KEPT:
            return "keep"
        if note.startswith(_LAID):
            return "background"
    return None
