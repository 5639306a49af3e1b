"""A plain brute force of non-parametric sampling, written from its definition and from nothing else.

One pixel at a time, every candidate, every offset; exact integers (rational limits) or, for the correlation, the
same double-precision formula from exact integer moments.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from math import inf, isinf, sqrt

import numpy as np

MASK64 = 2**64 - 1


def mixed(key: int, *counters: int) -> int:
    """Return 64 bits of the splitmix64 finalizer, chained over the counters."""
    bits = key
    for counter in counters:
        bits = (bits + (counter + 1) * 0x9E3779B97F4A7C15) & MASK64
        bits = ((bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9) & MASK64
        bits = ((bits ^ (bits >> 27)) * 0x94D049BB133111EB) & MASK64
        bits ^= bits >> 31
    return bits


def draw(key: int, row: int, column: int, count: int) -> int:
    """Return a number from 0 .. count - 1."""
    return ((mixed(key, row, column) >> 33) * count) >> 31


def belongs(shape: str, window: int, dy: int, dx: int) -> bool:
    if (dy, dx) == (0, 0):
        return False
    if shape == "disc":
        return dy * dy + dx * dx <= (window / 2) ** 2
    if shape == "cross":
        return dy == 0 or dx == 0
    if shape == "causal":
        return dy < 0 or (dy == 0 and dx < 0)
    return True


@dataclass
class Oracle:
    """Grow ``image`` (H, W, C) from what is ``known`` (H, W), comparing with ``exemplar`` (h, w, C); integers."""

    exemplar: np.ndarray
    image: np.ndarray
    known: np.ndarray
    weights: dict[tuple[int, int], int]
    shape: str = "square"
    window: int = 5
    criterion: str = "ssd"
    eps: Fraction = Fraction(1, 10)
    tau: Fraction = Fraction(0)
    limit: float = inf
    periodic: bool = False
    tiles: bool = False
    region: np.ndarray | None = None
    hole: np.ndarray | None = None
    choice_key: int = 0
    order_key: int = 0
    source: np.ndarray = field(init=False)
    matches: np.ndarray = field(init=False)
    d_min: np.ndarray = field(init=False)
    order: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        size = self.known.shape
        self.image, self.known = self.image.copy(), self.known.copy()
        self.source = np.full((*size, 2), -1)
        self.matches, self.order, self.d_min = np.zeros(size, int), np.zeros(size, int), np.zeros(size)
        reach = self.window // 2
        around = range(-reach, reach + 1)
        self.offsets = [(y, x) for y in around for x in around if belongs(self.shape, self.window, y, x)]

    def at(self, array: np.ndarray, y: int, x: int, wrap: bool) -> tuple[int, int] | None:
        height, width = array.shape[:2]
        if wrap:
            return y % height, x % width
        return (y, x) if 0 <= y < height and 0 <= x < width else None

    def known_offsets(self, y: int, x: int) -> list[tuple[int, int]]:
        places = [(o, self.at(self.known, y + o[0], x + o[1], self.tiles)) for o in self.offsets]
        return [offset for offset, place in places if place is not None and self.known[place]]

    def candidates(self, offsets: list[tuple[int, int]]) -> list[tuple[int, int]]:
        """Return the places whose windows lie inside of the exemplar and of the region, and touch no hole."""
        height, width = self.exemplar.shape[:2]
        rows, columns = np.indices((height, width))
        allowed = np.ones((height, width), bool) if self.region is None else self.region.astype(bool)

        def inside(dy: int, dx: int) -> np.ndarray:
            y, x = rows + dy, columns + dx
            return self.periodic | ((y >= 0) & (y < height) & (x >= 0) & (x < width))

        for offset in offsets:
            allowed = allowed & inside(*offset)
        for dy, dx in [*self.offsets, (0, 0)] if self.hole is not None else []:
            hole = self.hole[(rows + dy) % height, (columns + dx) % width].astype(bool)
            allowed = allowed & ~(inside(dy, dx) & hole)
        return [(y, x) for y, x in np.argwhere(allowed).tolist()]

    def search(self, y: int, x: int) -> tuple[list[tuple[int, int]], float]:
        """Return the match set in raster order, and d_min."""
        offsets = self.known_offsets(y, x)
        candidates = self.candidates(offsets)
        if not offsets:
            return candidates, 0.0
        weights = np.array([self.weights[offset] for offset in offsets])[:, None]
        places = [self.at(self.known, y + dy, x + dx, self.tiles) for dy, dx in offsets]
        target = np.array([self.image[place] for place in places]).astype(np.int64)
        height, width = self.exemplar.shape[:2]
        rows, columns = (
            np.add.outer(*axis) for axis in zip(np.array(candidates).T, np.array(offsets).T, strict=True)
        )
        windows = self.exemplar[rows % height, columns % width].astype(np.int64)
        distances = self.distances(weights, target, windows)
        return self.within(candidates, distances, int(weights.sum()) * self.image.shape[2])

    def distances(self, weights: np.ndarray, target: np.ndarray, windows: np.ndarray) -> list[float] | list[int]:
        """Return the distance of every candidate's window (offsets, C) to the target (offsets, C)."""
        if self.criterion == "sad":
            return (weights * abs(target - windows)).sum((1, 2)).tolist()
        if self.criterion != "ncc":
            return (weights * (target - windows) ** 2).sum((1, 2)).tolist()
        return [self.correlation_distance(weights, target, window) for window in windows]

    def correlation_distance(self, weights: np.ndarray, target: np.ndarray, window: np.ndarray) -> float:
        total = int(weights.sum()) * target.shape[1]
        t, e = int((weights * target).sum()), int((weights * window).sum())
        of_target = total * int((weights * target**2).sum()) - t * t
        of_window = total * int((weights * window**2).sum()) - e * e
        if of_target == 0 or of_window == 0:
            return 0.0 if of_target == of_window else inf
        together = total * int((weights * target * window).sum()) - t * e
        return max(0.0, 1.0 - float(together) / sqrt(float(of_target) * float(of_window)))

    def within(self, candidates: list[tuple[int, int]], distances: list[float], weight: int) -> tuple:
        smallest = min(distances)
        if self.criterion == "ncc":
            limit = max((1.0 + float(self.eps)) * smallest, (float(self.tau) / 255) ** 2)
            found = [place for place, d in zip(candidates, distances, strict=True) if d <= limit]
            return found, 2.0 if isinf(smallest) else smallest
        tau = self.tau if self.criterion == "sad" else self.tau**2
        limit = max((1 + self.eps) * smallest, tau * weight)
        found = [place for place, d in zip(candidates, distances, strict=True) if d <= limit]
        return found, smallest / weight

    def fill(self, y: int, x: int) -> float | None:
        """Fill a pixel and return None, or return d_min when that is beyond the error limit."""
        found, smallest = self.search(y, x)
        if smallest > self.limit:
            return smallest
        chosen = found[draw(self.choice_key, y, x, len(found))]
        self.image[y, x] = self.exemplar[chosen]
        self.source[y, x] = chosen
        self.matches[y, x] = len(found)
        self.d_min[y, x] = smallest
        self.order[y, x] = self.order.max() + 1
        self.known[y, x] = True
        return None

    def layer(self) -> list[tuple[int, int]]:
        """Return the unknown pixels that touch a known one: most known neighbours first, then by hash."""
        found = []
        for y, x in zip(*np.nonzero(~self.known), strict=True):
            places = [self.at(self.known, y + dy, x + dx, self.tiles) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
            if any(place is not None and self.known[place] for place in places):
                key = mixed(self.order_key, int(y), int(x)) >> 38
                found.append((-len(self.known_offsets(int(y), int(x))), key, (int(y), int(x))))
        return [pixel for _, _, pixel in sorted(found)]

    def run(self) -> Oracle:
        if self.shape == "causal":
            for y, x in zip(*np.nonzero(~self.known), strict=True):
                self.fill(int(y), int(x))
            return self
        while not self.known.all():
            refused = [self.fill(y, x) for y, x in self.layer()]
            if all(distance is not None for distance in refused):
                while self.limit < min(refused):
                    self.limit *= 1.1
        return self
