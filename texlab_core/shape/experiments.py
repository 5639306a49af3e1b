"""Experiments on homogeneity: what patterns on a plane tell of its orientation, tried many times, with pictures.

Reference: Forsyth and Ponce, section 11.4.1 and exercise 3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from texlab_core.shape import homogeneity, points
from texlab_core.shape.exercises import back_projected_areas
from texlab_core.shape.homogeneity import (
    orientation_of_density,
    orientation_of_marks,
    perspective_points,
    random_marks,
)
from texlab_core.shape.orientation import Orientation
from texlab_core.shape.sheets import TRUTH, landscape_picture, points_picture
from texlab_core.sheets.contact_sheet import Tile

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

Kind = Literal["orthographic", "border", "marks", "perspective", "counts"]
# Of the search among hypotheses: one tilt in so many is right by chance.
_TILTS = 12
_SETS = 6
Outcome = tuple[dict[str, Any], list[str], list[Tile]]


def experiment(kind: Kind, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    """Try one kind of evidence for the orientation of a plane.

    Parameters
    ----------
    kind
        ``orthographic``: uniformity of a Poisson pattern; ``border``: the same, with sets that touch the border;
        ``marks``: shapes of elements; ``perspective``: density under perspective; ``counts``: counts in sets.
    truth
        The orientation of the plane.
    count
        Points or marks in the picture.
    trials
        How many patterns are tried.
    rng
        Draws them.

    Returns
    -------
    numbers, lines, tiles
        JSON data; the same in words; pictures of the first pattern.
    """
    made: Outcome = _EXPERIMENTS[kind](kind, truth, count, trials, rng)
    return made


def _orthographic(kind: str, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    at_border = kind == "border"
    tilts = [Orientation(truth.slant, (truth.tilt + 180 * k / _TILTS) % 180) for k in range(_TILTS)]
    hypotheses = [*tilts, Orientation(0)] if at_border else tilts
    patterns = [points.poisson(count, truth, rng) for _ in range(trials)]
    chosen = [homogeneity.most_uniform(each, hypotheses, at_border=at_border) for each in patterns]
    along, across = (
        sum(each) for each in zip(*(homogeneity.count_ratio(p, truth.tilt) for p in patterns), strict=True)
    )
    answer: dict[str, Any] = {"chosen_true": chosen.count(0) / trials, "by_chance": 1 / len(hypotheses)}
    lines = [f"the true orientation is chosen in {100 * answer['chosen_true']:.0f} % of {trials} patterns"]
    if at_border:
        answer["chosen_frontal"] = chosen.count(_TILTS) / trials
        lines.append(f"slant 0 is chosen in {100 * answer['chosen_frontal']:.0f} %: an artefact of the border")
    else:
        lines[0] += f", and {100 / len(hypotheses):.0f} % are chance"
        answer["count_ratio"] = along / max(across, 1)
        lines.append(f"points in a rectangle along the tilt over one across it: {answer['count_ratio']:.3f}")
    tiles = []
    for name, orientation in (("slanted", truth), ("frontal control", Orientation(0))):
        pattern = patterns[0] if orientation is truth else points.poisson(count, orientation, rng)
        values, axis = homogeneity.uniformity_landscape(pattern, at_border=at_border)
        tiles.append(Tile(points_picture(pattern), (name,)))
        tiles.append(
            Tile(landscape_picture(values, axis, [(orientation, TRUTH)], (0, 1)), ("unevenness of hypotheses",))
        )
    return answer, lines, tiles


def _marks(kind: str, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    drawn = [random_marks(count, truth, rng) for _ in range(trials)]
    errors = [orientation_of_marks(tensors).error(truth) for _, tensors in drawn]
    found = orientation_of_marks(drawn[0][1])
    answer = {"mean_error": sum(errors) / trials, "found": as_json(found), "truth": as_json(truth)}
    lines = [f"mean shape of {count} marks: the normal is {answer['mean_error']:.1f}° off on average"]
    return answer, lines, [Tile(points_picture(*drawn[0]), (_words(found),))]


def _perspective(kind: str, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    drawn = [perspective_points(count, truth, rng) for _ in range(trials)]
    fits = [orientation_of_density(each) for each in drawn]
    errors = [fit.orientation.error(truth) for fit in fits]
    answer = {
        "mean_error": sum(errors) / trials,
        "at_guard": sum(fit.at_guard for fit in fits) / trials,
        "found": as_json(fits[0].orientation),
        "truth": as_json(truth),
    }
    lines = [f"density of {count} points: the normal is {answer['mean_error']:.1f}° off on average"]
    return answer, lines, [Tile(points_picture(drawn[0]), (_words(fits[0].orientation),))]


def _counts(kind: str, truth: Orientation, count: int, trials: int, rng: np.random.Generator) -> Outcome:
    makers: tuple[tuple[str, Callable[[], NDArray[np.float64]]], ...] = (
        ("Poisson, slanted", lambda: points.poisson(count, truth, rng)),
        ("regular", lambda: points.regular(count, rng)),
    )
    answer: dict[str, Any] = {"sets": _SETS * _SETS}
    lines, tiles = [], []
    for name, make in makers:
        drawn = [make() for _ in range(trials)]
        values = [points.count_in_sets(each, _SETS).p_value for each in drawn]
        uneven, even = (sum(each) / trials for each in ([p < 0.05 for p in values], [p > 0.95 for p in values]))
        answer[name.partition(",")[0].lower()] = {"uneven": uneven, "even": even}
        lines.append(
            f"{name}: p < .05 in {100 * uneven:.1f} %, p > .95 in {100 * even:.1f} % of {trials} patterns"
        )
        told = points.count_in_sets(drawn[0], _SETS)
        tiles.append(Tile(points_picture(drawn[0], sets=_SETS), (f"{name}: p {told.p_value:.2f}", told.verdict)))
    areas = back_projected_areas(_SETS, _SETS, truth, "orthographic")
    answer["area_on_plane"] = {"smallest": float(areas.min()), "largest": float(areas.max())}
    lines.append(f"each set is {areas.min():.4f} to {areas.max():.4f} of the plane: counts tell no tilt")
    return answer, lines, tiles


_EXPERIMENTS: dict[Kind, Any] = {
    "orthographic": _orthographic,
    "border": _orthographic,
    "marks": _marks,
    "perspective": _perspective,
    "counts": _counts,
}


def as_json(found: Orientation) -> dict[str, float]:
    """Return slant and tilt in degrees."""
    return {"slant": found.slant, "tilt": found.tilt}


def _words(found: Orientation) -> str:
    return f"slant {found.slant:.0f}°, tilt {found.tilt:.0f}°"
