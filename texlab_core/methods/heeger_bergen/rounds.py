"""One round of match-texture: take a plane apart, match every subband, put it together, match the pixels.

The plane is taken as periodic, so that the result tiles. All generators yield the number of samples that they have
matched or transformed since the last time.

Reference: Heeger and Bergen 1995, section 2.3; Forsyth and Ponce, algorithm 11.4.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from texlab_core.methods.heeger_bergen.analysis import (
    Around,
    PlaneModel,
    Pyramid,
    Target,
    band_keys,
    expansion,
)
from texlab_core.stats import histogram
from texlab_core.transforms import fourier, laplacian
from texlab_core.transforms.filters import level_size
from texlab_core.transforms.steerable import BandKey, Transform

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from texlab_core.transforms.filters import Size
    from texlab_core.transforms.steerable import Spectrum
    from texlab_core.work.tasks import Crew, Task

Plane = NDArray[np.float32]
Matching = Literal["exact", "bins"]

# Samples that are worth a task of their own.
BATCH = 2**15


@dataclass(frozen=True, slots=True)
class Plan:
    """The pyramid of a synthesis, how its subbands are matched, and how a Laplacian one wraps around."""

    pyramid: Pyramid
    levels: int
    orientations: int
    matching: Matching = "exact"
    around: Around = "spread"

    @property
    def keys(self) -> tuple[BandKey, ...]:
        """Places of the subbands, from fine to coarse."""
        return band_keys(self.pyramid, self.levels, self.orientations)


def match(values: Plane, target: Target, matching: Matching, key: int) -> Task[float]:
    """Match an array in place; return its W1 distance before, divided by the target's spread.

    Parameters
    ----------
    values
        float32, C-contiguous; overwritten.
    target
        The distribution wanted.
    matching
        ``exact`` by rank, or ``bins`` through the paper's tables.
    key
        For the random order of equal values.
    """
    ranked = values if matching == "exact" else values.copy()
    distance = yield from histogram.match_ranks_in_place(ranked, target.sample, key)
    if matching == "bins":
        yield from histogram.match_tables_in_place(values, histogram.tables(target.sample))
    return distance / target.spread if target.spread > 0 else 0.0


def match_round(
    plane: Plane, model: PlaneModel, plan: Plan, tie_key: Callable[[int], int], team: Crew
) -> Task[tuple[Plane, NDArray[np.float64]]]:
    """Do one round.

    Parameters
    ----------
    plane
        (H, W) float32.
    model
        Targets of the exemplar's plane.
    plan
        How.
    tie_key
        Gives a key for each place in the order of ``plan.keys``, and one more for the pixels.
    team
        Works on the subbands side by side.

    Returns
    -------
    plane
        (H, W) float32.
    distances
        (bands,) float64: W1 / sd of every subband before it was matched.
    """
    take_apart = _steerable_round if plan.pyramid == "steerable" else _laplacian_round
    plane, distances = yield from take_apart(plane, model, plan, tie_key, team)
    yield from match(plane, model.pixels, plan.matching, tie_key(len(plan.keys)))
    return plane, distances


def measure(plane: Plane, model: PlaneModel, plan: Plan, team: Crew) -> Task[NDArray[np.float64]]:
    """Return the distance W1 / sd of every subband of a plane, (bands,) float64."""
    distances: list[float] = []
    if plan.pyramid == "steerable":
        transform = Transform.of(plane, plan.levels, plan.orientations)
        spectrum = yield from fourier.rfft2(plane)
        tasks = (_measure_band(transform, spectrum, keys, model) for keys in _batches(plan.keys, transform.size))

        def accept(batch: list[float]) -> tuple[()]:
            distances.extend(batch)
            return ()

        yield from team.in_order(tasks, accept)
    else:
        for key, band in zip(plan.keys, _laplacian_bands(plane, plan), strict=True):
            distances.append((yield from match(band, model.bands[key], "exact", 0)))
    return np.array(distances)


def _steerable_round(
    plane: Plane, model: PlaneModel, plan: Plan, tie_key: Callable[[int], int], team: Crew
) -> Task[tuple[Plane, NDArray[np.float64]]]:
    transform = Transform.of(plane, plan.levels, plan.orientations)
    spectrum = yield from fourier.rfft2(plane)
    total, distances = transform.empty_sum(), []

    def accept(batch: list[tuple[BandKey, Spectrum, float]]) -> Task[None]:
        for key, part, distance in batch:
            distances.append(distance)
            yield from transform.add_task(total, key, part)

    places = {key: index for index, key in enumerate(plan.keys)}
    tasks = (
        _match_bands(transform, spectrum, keys, model, plan, lambda key: tie_key(places[key]))
        for keys in _batches(plan.keys, transform.size)
    )
    yield from team.in_order(tasks, accept)
    plane = yield from fourier.irfft2(total, transform.size)
    return plane, np.array(distances)


def _match_bands(
    transform: Transform,
    spectrum: Spectrum,
    keys: Sequence[BandKey],
    model: PlaneModel,
    plan: Plan,
    tie_key: Callable[[BandKey], int],
) -> Task[list[tuple[BandKey, Spectrum, float]]]:
    """Take some subbands from the spectrum, match them, and filter them again."""
    done = []
    for key in keys:
        band = yield from transform.band_task(spectrum, key)
        distance = yield from match(band, model.bands[key], plan.matching, tie_key(key))
        part = yield from transform.filtered_task(key, band)
        done.append((key, part, distance))
    return done


def _measure_band(
    transform: Transform, spectrum: Spectrum, keys: Sequence[BandKey], model: PlaneModel
) -> Task[list[float]]:
    distances = []
    for key in keys:
        band = yield from transform.band_task(spectrum, key)
        distances.append((yield from match(band, model.bands[key], "exact", 0)))
    return distances


def _batches(keys: Sequence[BandKey], size: Size) -> list[list[BandKey]]:
    """Put small subbands together, so that a thread has something to do for each task it gets."""
    batches: list[list[BandKey]] = []
    room = 0
    for key in keys:
        height, width = level_size(size, key.level)
        if room <= 0:
            batches.append([])
            room = BATCH
        batches[-1].append(key)
        room -= height * width
    return batches


def _laplacian_round(
    plane: Plane, model: PlaneModel, plan: Plan, tie_key: Callable[[int], int], team: Crew
) -> Task[tuple[Plane, NDArray[np.float64]]]:
    distances: list[float] = []
    bands = _laplacian_bands(plane, plan)
    yield plane.size
    tasks = (
        match(band, model.bands[key], plan.matching, tie_key(index))
        for index, (key, band) in enumerate(zip(plan.keys, bands, strict=True))
    )

    def accept(distance: float) -> tuple[()]:
        distances.append(distance)
        return ()

    yield from team.in_order(tasks, accept)
    collapsed = laplacian.collapse(bands, plan.around, expansion(plan.pyramid))
    yield plane.size
    return np.ascontiguousarray(collapsed), np.array(distances)


def _laplacian_bands(plane: Plane, plan: Plan) -> list[Plane]:
    bands = laplacian.build(plane, plan.levels, plan.around, expansion(plan.pyramid))
    return [np.ascontiguousarray(band) for band in bands[:-1]] + [bands[-1].copy()]
