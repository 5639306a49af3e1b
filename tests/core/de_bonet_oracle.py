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


def flat(pyramids: Pyramids, level: int) -> tuple[np.ndarray, ...]:
    """Return the levels from ``level`` on one after the other, as compiled loops read them fastest.

    Returns
    -------
    tuple
        Features (sum of h w, J), first row and width of each level; source rows (sum of H W,), first and width
        of each level; thresholds.
    """
    tables, sources = pyramids.features[level:], pyramids.sources[level:]
    features = np.concatenate([table.reshape(-1, table.shape[2]) for table in tables])
    starts = np.cumsum([0] + [table.shape[0] * table.shape[1] for table in tables[:-1]])
    widths = np.array([table.shape[1] for table in tables])
    rows = [
        start + source[..., 0].astype(np.int64) * width + source[..., 1]
        for start, width, source in zip(starts, widths, sources, strict=True)
    ]
    out_starts = np.cumsum([0] + [row.size for row in rows[:-1]])
    out_widths = np.array([row.shape[1] for row in rows])
    thresholds = np.ascontiguousarray(pyramids.thresholds[level:])
    return (
        features,
        starts,
        widths,
        np.concatenate([row.ravel() for row in rows]),
        out_starts,
        out_widths,
        thresholds,
    )


def candidate_sets(pyramids: Pyramids, level: int, parity: bool) -> np.ndarray:
    """Return for every location of a level (raster order) which exemplar locations are candidates, (Q, P) bool."""
    return _sets(flat(pyramids, level), pyramids.sources[level].shape, pyramids.features[level].shape, parity)


@numba.njit(cache=False)
def _is_candidate(pyramids, y_out, x_out, y, x):
    features, starts, widths, sources, out_starts, out_widths, thresholds = pyramids
    for v in range(starts.size - 1, 0, -1):
        here = starts[v] + (y >> v) * widths[v] + (x >> v)
        there = sources[out_starts[v] + (y_out >> v) * out_widths[v] + (x_out >> v)]
        for j in range(thresholds.shape[1]):
            difference = features[here, j] - features[there, j]
            if difference * difference > thresholds[v, j]:
                return False
    return True


@numba.njit(cache=False)
def _sets(pyramids, output, exemplar, parity):
    rows, columns = output[0], output[1]
    height, width = exemplar[0], exemplar[1]
    found = np.zeros((rows * columns, height * width), np.bool_)
    for y_out in range(rows):
        for x_out in range(columns):
            for y in range(height):
                for x in range(width):
                    if parity and ((y ^ y_out) & 1 or (x ^ x_out) & 1):
                        continue
                    if _is_candidate(pyramids, y_out, x_out, y, x):
                        found[y_out * columns + x_out, y * width + x] = True
    return found


@numba.njit(cache=False)
def sample_some(pyramids, exemplar, chosen, draws):
    """Do the innermost loops for some locations of the first level given, as the pseudo-code does; returns a sum.

    ``chosen`` (n, 2) rows and columns of the output, ``draws`` (n,) uniform numbers.
    """
    height, width = exemplar[0], exemplar[1]
    candidates = np.empty(height * width, np.int64)
    total = 0
    for n in range(chosen.shape[0]):
        count = 0
        for y in range(height):
            for x in range(width):
                if _is_candidate(pyramids, chosen[n, 0], chosen[n, 1], y, x):
                    candidates[count] = y * width + x
                    count += 1
        total += candidates[int(draws[n] * count)]
    return total
