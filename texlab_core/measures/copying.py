"""How much of a result was copied, from a source map: continuous neighbours, connected areas, repeated sources."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import InputError
from texlab_core.measures.registry import Measure, register
from texlab_core.work.tasks import finish, row_bounds

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.measures.subject import Subject

_PIXELS_AT_ONCE = 2**18


def continuous_share(source_map: NDArray[np.int32]) -> float:
    """Share of neighbouring pixels whose sources are neighbours in the same way.

    Parameters
    ----------
    source_map
        (H, W, 2) int32, row and column in the exemplar of every pixel; a negative row means that it has none.

    Returns
    -------
    float
        0 .. 1, over all horizontal and vertical neighbours that both have a source; 1 for a verbatim copy and
        for a single pixel, 0 where no pixel has a source.

    Reference: the measure of copying behind De Bonet 1997, figs. 11 and 12 (how much was rearranged).
    """
    return finish(continuous_share_steps(source_map))


def continuous_share_steps(source_map: NDArray[np.int32]) -> Generator[float, None, float]:
    """Do what :func:`continuous_share` does in parts of a few milliseconds, yielding the share done (0 .. 1)."""
    from texlab_core.kernels.regions import count_continuous

    source = _checked(source_map)
    height, width = source.shape[:2]
    pairs = count = filled = 0
    for first, last in row_bounds((height, width), _PIXELS_AT_ONCE):
        there = source[first : last + 1, :, 0] >= 0
        own = there[: last - first]
        filled += int(np.count_nonzero(own))
        pairs += int(np.count_nonzero(own[:, 1:] & own[:, :-1]) + np.count_nonzero(there[1:] & there[:-1]))
        count += count_continuous(source, first, last)
        yield last / height
    return count / pairs if pairs else float(filled > 0)


def copied_regions(source_map: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Label the connected areas (4-neighbours) that were copied with one offset.

    Parameters
    ----------
    source_map
        (H, W, 2) int32, row and column in the exemplar of every pixel; a negative row means that it has none.

    Returns
    -------
    labels
        (H, W) int32: 1 is the largest area, then by falling size, areas of equal size in raster order; 0 is a
        pixel that continues none of its neighbours.
    sizes
        (areas + 1,) int64: ``sizes[label]`` in pixels; ``sizes[0]`` counts the pixels that continue none.
    """
    return finish(copied_regions_steps(source_map))


def copied_regions_steps(
    source_map: NDArray[np.int32],
) -> Generator[float, None, tuple[NDArray[np.int32], NDArray[np.int64]]]:
    """Do what :func:`copied_regions` does in parts of a few milliseconds, yielding the share done (0 .. 1)."""
    from texlab_core.kernels.regions import count_roots, join_rows, write_labels

    source = _checked(source_map)
    height, width = source.shape[:2]
    blocks = row_bounds((height, width), _PIXELS_AT_ONCE)
    parent = np.empty(height * width, np.int32)
    for done, (first, last) in enumerate(blocks):
        join_rows(source, parent, first, last)
        yield (done + 1) / (3 * len(blocks))
    counts = np.zeros(height * width, np.int32)
    for done, (first, last) in enumerate(blocks):
        count_roots(parent, counts, first * width, last * width)
        yield (done + 1 + len(blocks)) / (3 * len(blocks))
    found = []
    for first, last in blocks:
        found.append(first * width + np.flatnonzero(counts[first * width : last * width] > 1))
        yield 2 / 3
    roots = np.concatenate(found)
    yield 2 / 3
    roots = roots[np.argsort(-counts[roots], kind="stable")]
    yield 2 / 3
    rank = np.zeros(height * width, np.int32)
    rank[roots] = np.arange(1, roots.size + 1, dtype=np.int32)
    yield 2 / 3
    labels = np.empty(height * width, np.int32)
    for done, (first, last) in enumerate(blocks):
        write_labels(parent, rank, labels, first * width, last * width)
        yield (done + 1 + 2 * len(blocks)) / (3 * len(blocks))
    single = height * width - int(counts[roots].sum())
    return labels.reshape(height, width), np.concatenate(([single], counts[roots])).astype(np.int64)


def largest_copy(sizes: NDArray[np.int64], filled: int | None = None) -> float:
    """Return the largest copied piece as a share of the pixels that have a source.

    Parameters
    ----------
    sizes
        Of :func:`copied_regions`.
    filled
        How many pixels have a source; None when all have one.
    """
    total = int(sizes.sum()) if filled is None else filled
    return float(sizes[1]) / total if sizes.size > 1 else 1.0 / total if total else 0.0


def source_repetition(source_map: NDArray[np.int32]) -> float | None:
    """Return how often a pixel of the exemplar that was used was used on average, at least 1; None without any."""
    rows, columns = source_map[:, :, 0], source_map[:, :, 1]
    there = rows >= 0
    if not there.any():
        return None
    used = np.zeros((int(rows.max()) + 1, int(columns.max()) + 1), bool)
    used[rows[there], columns[there]] = True
    return int(np.count_nonzero(there)) / int(np.count_nonzero(used))


def _checked(source_map: NDArray[np.int32]) -> NDArray[np.int32]:
    if source_map.ndim != 3 or source_map.shape[2] != 2:
        raise InputError(f"source map: must have the shape (H, W, 2), got {source_map.shape}.")
    return np.ascontiguousarray(source_map, dtype=np.int32)


def _regions(subject: Subject) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    assert subject.source is not None
    return finish(copied_regions_steps(subject.source), subject.look)


def _share(subject: Subject) -> float | None:
    source = subject.source
    return None if source is None or not _filled(source) else finish(continuous_share_steps(source), subject.look)


def _largest(subject: Subject) -> float | None:
    source = subject.source
    if source is None or not _filled(source):
        return None
    _, sizes = subject.once("copied regions", lambda: _regions(subject))
    return largest_copy(sizes, _filled(source))


def _areas(subject: Subject) -> float | None:
    source = subject.source
    if source is None or not _filled(source):
        return None
    labels, sizes = subject.once("copied regions", lambda: _regions(subject))
    alone = int(np.count_nonzero((labels == 0) & (source[:, :, 0] >= 0)))
    return _filled(source) / (sizes.size - 1 + alone)


def _repetition(subject: Subject) -> float | None:
    return None if subject.source is None else source_repetition(subject.source)


def _filled(source: NDArray[np.int32]) -> int:
    return int(np.count_nonzero(source[:, :, 0] >= 0))


register(
    Measure(
        id="copied-share",
        title="copied",
        summary="Share of neighbouring pixels that are neighbours in the exemplar too: 100% for a verbatim copy, "
        "near 0% for pixels at random. It does not see that large pieces were laid down side by side: see tiled.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("source",),
        function=_share,
        form=".0%",
        reference="J. S. De Bonet, SIGGRAPH 1997, figs. 11 and 12",
        live=True,
        order=35,
    )
)
register(
    Measure(
        id="largest-copy",
        title="largest piece",
        summary="The largest connected area that was copied in one piece, as a share of all that was copied.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("source",),
        function=_largest,
        form=".0%",
        live=True,
        order=36,
    )
)
register(
    Measure(
        id="mean-copy",
        title="mean piece",
        summary="Pixels of a connected area that was copied in one piece, on average; 1 where no two neighbours "
        "belong together.",
        low=1.0,
        high=2.0**26,
        better="lower",
        needs=("source",),
        function=_areas,
        unit="px",
        form=",.3g",
        order=37,
    )
)
register(
    Measure(
        id="source-repetition",
        title="source repeated",
        summary="How often a pixel of the exemplar that was used at all was used, on average. Well above the "
        "ratio of the two areas, the same few places were copied again and again: growing garbage.",
        low=1.0,
        high=2.0**26,
        better="lower",
        needs=("source",),
        function=_repetition,
        form=".1f",
        order=38,
    )
)
