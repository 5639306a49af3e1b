"""Numbers to colours: maps, subbands and their scales as (H, W, 3) uint8. NumPy only, no Qt.

The diverging and the sequential table can be read by the colour-blind (lightness alone orders them).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.transforms.luma import LUMA

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from texlab_core.engine.steps import Map

DIVERGING = ((33, 102, 172), (146, 197, 222), (247, 247, 247), (244, 165, 130), (178, 24, 43))
SEQUENTIAL = ((13, 8, 80), (84, 2, 163), (156, 23, 158), (219, 92, 104), (248, 149, 64), (240, 249, 33))
NOTHING = (128, 128, 128)
SOURCE_CORNERS = (((160, 205, 255), (255, 245, 150)), ((0, 20, 120), (110, 80, 0)))
GOLDEN = 0.6180339887498949
KEY_SIDE = 256

Scaling = Literal["linear", "log"]


def ink_on(red: int, green: int, blue: int) -> str:
    """Return the colour of words on a colour (0 .. 255 each): black on light ones, white on dark ones."""
    return "#000000" if float(np.dot(LUMA, (red, green, blue))) > 140 else "#ffffff"


@dataclass(frozen=True)
class Scale:
    """How numbers lie on a colour bar: from ``low`` to ``high``, linearly or by log(1 + value)."""

    low: float
    high: float
    scaling: Scaling = "linear"

    def place(self, values: ArrayLike) -> NDArray[np.float32]:
        """Return where values lie on the bar, 0 at its low end and 1 at its high end (NaN stays NaN)."""
        data = np.asarray(values, dtype=np.float32)
        low, high = np.float32(self.low), np.float32(self.high)
        if self.scaling == "log":
            data, low, high = np.log1p(np.maximum(data, 0)), np.log1p(low), np.log1p(high)
        span = high - low
        return np.clip((data - low) / span, 0, 1) if span > 0 else np.where(np.isnan(data), data, np.float32(0))

    def value(self, place: float) -> float:
        """Return the number at a place of the bar."""
        if self.scaling == "log":
            low, high = np.log1p(self.low), np.log1p(self.high)
            return float(np.expm1(low + place * (high - low)))
        return self.low + place * (self.high - self.low)

    def ticks(self) -> list[tuple[float, float]]:
        """Return (place, value) of both ends and of round numbers between them that keep clear of the ends."""
        if self.scaling == "log":
            rounds = [float(10**power) for power in range(19) if self.low < 10**power < self.high]
        else:
            step = _round_step((self.high - self.low) / 4)
            first = np.ceil(self.low / step) if step else 0
            rounds = [float(k * step) for k in np.arange(first, first + 12) if k * step < self.high]
        places = [(float(self.place(value)), value) for value in rounds]
        inner = [each for each in places if 0.08 < each[0] < 0.92]
        return [(0.0, self.low), *inner, (1.0, self.high)] if self.high > self.low else [(0.0, self.low)]


def _round_step(step: float) -> float:
    """Return the nearest of 1, 2, 5 times a power of ten that is not below ``step``."""
    if not step > 0:
        return 0.0
    power = 10.0 ** np.floor(np.log10(step))
    return float(next(factor * power for factor in (1, 2, 5, 10) if factor * power >= step * (1 - 1e-9)))


def lookup_table(stops: tuple[tuple[int, int, int], ...], size: int = 256) -> NDArray[np.uint8]:
    """Return ``size`` colours interpolated between the stops, (size, 3) uint8."""
    places = np.linspace(0, len(stops) - 1, size)
    table = np.stack([np.interp(places, range(len(stops)), channel) for channel in zip(*stops, strict=True)], 1)
    return np.round(table).astype(np.uint8)


def paint(places: NDArray[np.float32], table: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the colours at places 0 .. 1 of a table; NaN becomes mid-gray.

    Parameters
    ----------
    places
        Any shape (...).
    table
        (size, 3) uint8.

    Returns
    -------
    ndarray
        (..., 3) uint8.
    """
    missing = np.isnan(places)
    any_missing = bool(missing.any())
    known = np.where(missing, np.float32(0), places) if any_missing else places
    index = (known * np.float32(len(table) - 1) + np.float32(0.5)).astype(np.intp)
    colours: NDArray[np.uint8] = table[index]
    if any_missing:
        colours[missing] = NOTHING
    return colours


def diverging(values: NDArray[Any], limit: float) -> NDArray[np.uint8]:
    """Colour values symmetrically around zero: blue at ``-limit``, white at 0, red at ``limit``."""
    return paint(Scale(-limit, limit).place(values), DIVERGING_TABLE)


def gray(values: NDArray[Any], low: float = 0.0, high: float = 1.0) -> NDArray[np.uint8]:
    """Colour values from black at ``low`` to white at ``high``."""
    return paint(Scale(low, high).place(values), GRAY_TABLE)


def map_scale(shown: Map) -> Scale | None:
    """Return the colour bar of a map; None for sources and labels, which have none."""
    if shown.kind == "count":
        return Scale(float(shown.data.min(initial=0)), float(max(shown.data.max(initial=0), 1)), "log")
    if shown.kind == "scalar":
        known = shown.data[np.isfinite(shown.data)]
        return Scale(float(known.min()), float(known.max())) if known.size else Scale(0.0, 1.0)
    return None


def map_table(shown: Map) -> NDArray[np.uint8]:
    """Return the colours of a map's bar, (256, 3) uint8."""
    return COUNT_TABLE if shown.kind == "count" else SEQUENTIAL_TABLE


def colour_map(shown: Map, extent: tuple[int, int] | None = None) -> NDArray[np.uint8]:
    """Return a map as a picture.

    Parameters
    ----------
    shown
        Source coordinates become lightness (the row) and blue to yellow (the column); counts logarithmic colours;
        labels distinct ones (0 is gray); scalars sequential ones.
    extent
        Height and width of the exemplar, for source coordinates; taken from the map when left out.

    Returns
    -------
    ndarray
        (H, W, 3) uint8.
    """
    if shown.kind == "source":
        return source_colours(shown.data, extent or source_extent(shown.data))
    if shown.kind == "label":
        return label_colours(shown.data)
    scale = map_scale(shown)
    assert scale is not None
    return paint(scale.place(shown.data), map_table(shown))


def source_extent(source: NDArray[np.int32]) -> tuple[int, int]:
    """Return the smallest height and width that hold every source coordinate."""
    rows, columns = (int(source[..., axis].max(initial=0)) + 1 for axis in (0, 1))
    return rows, columns


def source_key(height: int, width: int) -> NDArray[np.uint8]:
    """Return the colour of every place of the exemplar, (height, width, 3) uint8.

    Dark below and light above, blue on the left and yellow on the right: what the colour-blind see too. Places
    farther apart than 40 % of a side differ by more than 20 in Lab, for all three kinds of sight.
    """
    down = ((np.arange(height, dtype=np.float32) + 0.5) / height)[:, None, None]
    across = ((np.arange(width, dtype=np.float32) + 0.5) / width)[None, :, None]
    corners = np.array(SOURCE_CORNERS, np.float32)
    above = corners[0, 0] + across * (corners[0, 1] - corners[0, 0])
    below = corners[1, 0] + across * (corners[1, 1] - corners[1, 0])
    colours: NDArray[np.uint8] = np.round(above + down * (below - above)).astype(np.uint8)
    return colours


def source_colours(source: NDArray[np.int32], extent: tuple[int, int]) -> NDArray[np.uint8]:
    """Colour source coordinates by :func:`source_key`; negative ones (no source) become mid-gray.

    Parameters
    ----------
    source
        (H, W, 2) int32, row and column in the exemplar.
    extent
        The exemplar's height and width.
    """
    height, width = extent
    key = source_key(min(height, KEY_SIDE), min(width, KEY_SIDE))
    rows = np.clip(source[..., 0], 0, height - 1).astype(np.int64) * key.shape[0] // height
    columns = np.clip(source[..., 1], 0, width - 1).astype(np.int64) * key.shape[1] // width
    colours: NDArray[np.uint8] = key[rows, columns]
    colours[(source < 0).any(axis=-1)] = NOTHING
    return colours


def label_colours(labels: NDArray[np.integer[Any]]) -> NDArray[np.uint8]:
    """Give every label a colour of its own, neighbours in number far apart; 0 (none) is mid-gray."""
    highest = max(int(labels.max(initial=0)), 0)
    colours = label_table(highest + 1)[np.clip(labels, 0, highest)]
    return np.ascontiguousarray(colours)


def label_table(size: int) -> NDArray[np.uint8]:
    """Return the colours of the labels 0 .. size - 1, (size, 3) uint8."""
    index = np.arange(size, dtype=np.float32)
    # Steps of the golden section never come close to an earlier hue; three tones tell close hues apart.
    hue = index * np.float32(GOLDEN) % 1
    tone = np.arange(size) % 3
    saturation = np.array([0.75, 0.45, 0.9], np.float32)[tone]
    brightness = np.array([0.9, 1.0, 0.6], np.float32)[tone]
    table = hue_saturation_value(hue, saturation, brightness)
    table[0] = NOTHING
    return table


def label_sizes(labels: NDArray[np.integer[Any]], most: int = 12) -> list[tuple[int, int]]:
    """Return (label, pixels) of the largest regions, the largest first; label 0 is no region."""
    counts = np.bincount(np.maximum(labels, 0).ravel())
    counts[0] = 0
    order = np.argsort(-counts, kind="stable")[:most]
    return [(int(label), int(counts[label])) for label in order if counts[label] > 0]


def hue_saturation_value(hue: NDArray[Any], saturation: NDArray[Any], value: NDArray[Any]) -> NDArray[np.uint8]:
    """Return RGB, (..., 3) uint8, of hue, saturation and value, 0 .. 1 each and of shapes that broadcast."""
    # Channel n of HSV: V - V S max(0, min(k, 4 - k, 1)) with k = (n + 6 H) mod 6 and n = 5, 3, 1.
    k = (np.array([5, 3, 1], np.float32) + hue[..., None] * np.float32(6)) % 6
    part = np.clip(np.minimum(k, 4 - k), 0, 1)
    rgb = value[..., None] * (1 - saturation[..., None] * part)
    colours: NDArray[np.uint8] = np.round(rgb * 255).astype(np.uint8)
    return colours


def mark_edges(picture: NDArray[np.uint8], labels: NDArray[np.integer[Any]]) -> NDArray[np.uint8]:
    """Darken the pixels at which a region ends, so that regions of like colours stay apart."""
    edge = np.zeros(labels.shape, dtype=bool)
    edge[:-1] |= labels[:-1] != labels[1:]
    edge[:, :-1] |= labels[:, :-1] != labels[:, 1:]
    marked = picture.copy()
    marked[edge] //= 3
    return marked


DIVERGING_TABLE = lookup_table(DIVERGING)
SEQUENTIAL_TABLE = lookup_table(SEQUENTIAL)
COUNT_TABLE = lookup_table(
    ((8, 12, 40), (20, 60, 110), (20, 120, 130), (70, 180, 110), (200, 225, 80), (255, 255, 220))
)
GRAY_TABLE = lookup_table(((0, 0, 0), (255, 255, 255)))
# From the colour of an empty field to the strongest one, by theme: a single hue, whose lightness tells the number.
HISTOGRAM_TABLES = {
    "light": lookup_table(((250, 250, 248), (172, 205, 228), (58, 134, 186), (0, 78, 134), (0, 34, 70))),
    "dark": lookup_table(((26, 28, 31), (32, 66, 92), (38, 120, 168), (98, 188, 236), (226, 244, 253))),
}
# Weak enough for numbers on every colour, and for marks over them.
QUIET_TABLES = {
    "light": lookup_table(((255, 255, 255), (222, 233, 240), (170, 203, 224))),
    "dark": lookup_table(((40, 43, 48), (44, 64, 80), (52, 92, 120))),
}
