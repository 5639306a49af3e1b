"""What a result carries: maps, curves, measures, and what explains it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.late_maps import LateMaps
from texlab_core.engine.steps import Curve, Map, Output, Step
from texlab_core.measures.copying import continuous_share_steps, copied_regions_steps, largest_copy
from texlab_core.methods.de_bonet.growth import total_work
from texlab_core.methods.de_bonet.maps import candidate_map, median_candidates, source_map_steps
from texlab_core.work.tasks import through

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.de_bonet.sampling import Sampling


@dataclass(frozen=True, eq=False)
class DeBonetDetails:
    """What the views need to explain a result.

    Parameters
    ----------
    sampling
        The sampled pyramid with its analysis and thresholds.
    size
        Height and width of the result.
    region_sizes
        (areas + 1,) int64 sizes in pixels of the labels of the map ``copied``.
    """

    sampling: Sampling
    size: tuple[int, int]
    region_sizes: NDArray[np.int64]


def report_steps(
    sampling: Sampling, size: tuple[int, int], image: FloatImage, notes: tuple[str, ...]
) -> Generator[Step, None, Output]:
    """Measure how much was copied and choose the maps."""
    grid = sampling.grid
    total = total_work(grid, grid.count(0))
    step = Step(total - grid.count(0), total, "maps", preview=image.copy)

    continuity, medians = [], []
    source = np.empty((0, 0, 2), np.int32)
    for level in range(grid.depth, -1, -1):
        extent = grid.shape(level) if level else size
        source = yield from through(source_map_steps(sampling, level, extent), step)
        continuity.append((yield from through(continuous_share_steps(source), step)))
        medians.append(1.0 if level == grid.depth else median_candidates(sampling, level))
        yield step
    labels, region_sizes = yield from through(copied_regions_steps(source), step)
    levels = np.arange(grid.depth, -1, -1)
    maps = LateMaps(
        {
            "source": ("Source", lambda: Map(source, "source", "Source", "px")),
            "candidates": ("Candidates", lambda: Map(candidate_map(sampling, size), "count", "Candidates")),
            "copied": ("Copied regions", lambda: Map(labels, "label", "Copied regions")),
        }
    )
    curves = {
        "median-candidates": Curve.of(medians, "Median number of candidates", x=levels, x_label="level"),
        "continuity": Curve.of(continuity, "Neighbours with continuous source", x=levels, x_label="level"),
    }
    measures = {
        "copied-share": continuity[-1],
        "median-candidates": medians[-1],
        "largest-copy": largest_copy(region_sizes),
    }
    details = DeBonetDetails(sampling, size, region_sizes)
    yield Step(total, total, "maps", preview=image.copy)
    return Output(image=image, maps=maps, curves=curves, measures=measures, notes=notes, details=details)
