"""The pseudo-code SynthesizePyramid of De Bonet 1997, compiled and otherwise as printed."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

# One feature table (h, w, J) for each level, finest first; level 0 is never looked at.
Tables = tuple[np.ndarray, ...]


@dataclass
class Pyramids:
    """Everything in raster order, as nested loops want it."""

    features: list[np.ndarray]  # per level (h, w, J) float32
    sources: list[np.ndarray]  # per level (H, W, 2) int32
    thresholds: np.ndarray  # (levels, J) float32, by level


def rasters(sampling) -> Pyramids:
    """Undo the quadtree order of a sampling by its coordinates."""
    analysis, grid = sampling.analysis, sampling.grid
    features, sources = [], []
    for level, each in enumerate(analysis.levels):
        table = np.zeros((*analysis.grid.shape(level), len(analysis.features)), np.float32)
        if level:
            table[each.coordinates[:, 0], each.coordinates[:, 1]] = each.features
        features.append(table)
        places = grid.coordinates(level)
        source = np.full((*grid.shape(level), 2), -1, np.int32)
        source[places[:, 0], places[:, 1]] = each.coordinates[sampling.sources[level]]
        sources.append(source)
    thresholds = np.zeros((len(features), len(analysis.features)), np.float32)
    for level in range(1, len(features)):
        thresholds[level] = sampling.row(level)
    return Pyramids(features, sources, thresholds)


def candidate_sets(pyramids: Pyramids, level: int, parity: bool) -> np.ndarray:
    """Return for every location of a level (raster order) which exemplar locations are candidates, (Q, P) bool."""
    top = len(pyramids.features) - 1
    features = numba.typed.List(pyramids.features[level : top + 1])
    sources = numba.typed.List(pyramids.sources[level : top + 1])
    return _sets(features, sources, np.ascontiguousarray(pyramids.thresholds[level : top + 1]), parity)


@numba.njit(cache=False)
def _is_candidate(features, sources, thresholds, y_out, x_out, y, x):
    for v in range(len(features) - 1, 0, -1):
        there = sources[v][y_out >> v, x_out >> v]
        table = features[v]
        for j in range(thresholds.shape[1]):
            difference = table[y >> v, x >> v, j] - table[there[0], there[1], j]
            if difference * difference > thresholds[v, j]:
                return False
    return True


@numba.njit(cache=False)
def _sets(features, sources, thresholds, parity):
    rows, columns = sources[0].shape[:2]
    height, width = features[0].shape[:2]
    found = np.zeros((rows * columns, height * width), np.bool_)
    for y_out in range(rows):
        for x_out in range(columns):
            for y in range(height):
                for x in range(width):
                    if parity and ((y ^ y_out) & 1 or (x ^ x_out) & 1):
                        continue
                    if _is_candidate(features, sources, thresholds, y_out, x_out, y, x):
                        found[y_out * columns + x_out, y * width + x] = True
    return found


@numba.njit(cache=False)
def sample_some(features, sources, thresholds, chosen, draws):
    """Do the innermost loops for some locations of the first level given, as the pseudo-code does; returns a sum.

    ``chosen`` (n, 2) rows and columns of the output, ``draws`` (n,) uniform numbers.
    """
    height, width = features[0].shape[:2]
    candidates = np.empty(height * width, np.int64)
    total = 0
    for n in range(chosen.shape[0]):
        count = 0
        for y in range(height):
            for x in range(width):
                if _is_candidate(features, sources, thresholds, chosen[n, 0], chosen[n, 1], y, x):
                    candidates[count] = y * width + x
                    count += 1
        total += candidates[int(draws[n] * count)]
    return total
