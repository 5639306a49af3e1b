"""Levels: what becomes black and white in a picture, and how the grays between them lie."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage

LEAST_SPAN = 1 / 65535
GAMMAS = (0.1, 10.0)
BINS = 256
CLIPPED = 0.001
"""Share of the values beyond each end of automatic levels."""
_MOST_SAMPLED = 2**20
ALLOWED = "black, white and gamma as in 0.1,0.8,1.2 (0 <= black < white <= 1, gamma 0.1 to 10), or auto"


@dataclass(frozen=True, slots=True)
class Levels:
    """``((x - black) / (white - black)) ^ (1 / gamma)``, clipped to [0, 1].

    Parameters
    ----------
    black, white
        Values that become 0 and 1; 0 <= black < white <= 1.
    gamma
        Above 1 the middle becomes brighter; 0.1 .. 10.

    Raises
    ------
    ParamError
        When a number is out of range.
    """

    black: float = 0.0
    white: float = 1.0
    gamma: float = 1.0

    def __post_init__(self) -> None:
        numbers = (self.black, self.white, self.gamma)
        real = all(isinstance(each, int | float) and not isinstance(each, bool) for each in numbers)
        good = (
            real
            and all(map(math.isfinite, numbers))
            and self.black >= 0
            and self.white <= 1
            and self.white - self.black >= LEAST_SPAN
            and GAMMAS[0] <= self.gamma <= GAMMAS[1]
        )
        if not good:
            raise ParamError("levels", ALLOWED, ",".join(str(each)[:20] for each in numbers))
        for name in ("black", "white", "gamma"):
            object.__setattr__(self, name, float(getattr(self, name)))

    @property
    def plain(self) -> bool:
        """Whether they change nothing."""
        return (self.black, self.white, self.gamma) == (0.0, 1.0, 1.0)

    def applied(self, pixels: FloatImage) -> FloatImage:
        """Return a picture, float32 in [0, 1], with these levels; itself when they change nothing."""
        if self.plain:
            return pixels
        made = np.subtract(pixels, np.float32(self.black), dtype=np.float32)
        made *= np.float32(1 / (self.white - self.black))
        np.clip(made, 0, 1, out=made)
        if self.gamma != 1:
            np.power(made, np.float32(1 / self.gamma), out=made)
        return made

    def table(self) -> NDArray[np.uint8]:
        """Return what becomes of each of 256 gray levels, (256,) uint8: for showing alone."""
        grays = np.arange(256, dtype=np.float32) / np.float32(255)
        return np.rint(self.applied(grays) * 255).astype(np.uint8)

    @property
    def text(self) -> str:
        """As the command line takes them."""
        return ",".join(f"{each:.6g}" for each in (self.black, self.white, self.gamma))

    @property
    def words(self) -> str:
        """For people: "black 0.1, white 0.8, gamma 1.2"."""
        return f"black {self.black:.4g}, white {self.white:.4g}, gamma {self.gamma:.4g}"

    def to_json(self) -> list[float]:
        """Return the three numbers."""
        return [self.black, self.white, self.gamma]

    @classmethod
    def from_json(cls, data: Any) -> Levels:
        """Return levels from :meth:`to_json`; raises ``ParamError``."""
        if not isinstance(data, list) or len(data) != 3:
            raise ParamError("levels", ALLOWED, str(data)[:40])
        return cls(*data)

    @classmethod
    def parse(cls, text: str) -> Levels | None:
        """Return levels from ``B,W,G``, or None for ``auto``; raises ``ParamError``."""
        if text.strip().lower() == "auto":
            return None
        try:
            black, white, gamma = (float(part) for part in text.split(","))
        except ValueError:
            raise ParamError("levels", ALLOWED, text) from None
        return cls(black, white, gamma)

    @classmethod
    def auto(cls, pixels: FloatImage) -> Levels:
        """Return levels that use the whole range: 0.1 % of the values go beyond each end.

        Parameters
        ----------
        pixels
            (H, W, C) float32 in [0, 1]; of a constant picture nothing is changed.
        """
        sample = _sample(pixels)
        low, high = (float(each) for each in np.quantile(sample, [CLIPPED, 1 - CLIPPED]))
        # Written short, so that they can be read and typed.
        black, white = math.floor(low * 1e4) / 1e4, min(1.0, math.ceil(high * 1e4) / 1e4)
        return cls(black, white) if white - black >= 10 * LEAST_SPAN and high > low else cls()


def histogram_of(pixels: FloatImage) -> NDArray[np.float64]:
    """Return the shares of values by channel, (C, 256) float64: rows sum to 1. Of at most a million pixels."""
    sample = _sample(pixels)
    counts = [np.histogram(sample[:, channel], BINS, (0, 1))[0] for channel in range(sample.shape[1])]
    return np.array(counts, np.float64) / len(sample)


def _sample(pixels: FloatImage) -> FloatImage:
    flat = pixels.reshape(-1, pixels.shape[2])
    return flat[:: 1 + len(flat) // _MOST_SAMPLED]
