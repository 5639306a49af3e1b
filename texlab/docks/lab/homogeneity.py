"""The honest panel: what homogeneity does not tell about a plane, and what does."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from texlab.docks.base import Question
from texlab.docks.lab.page import LabPage, Shown, Told, looker
from texlab.style.pictures import to_picture
from texlab_core.shape import exercises, homogeneity, points
from texlab_core.shape.orientation import Orientation
from texlab_core.shape.sheets import TRUTH, landscape_picture, points_picture

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.scene import Scene

EXPERIMENTS = (
    ("1 Poisson, orthographic", "orthographic"),
    ("2 the border pitfall", "border"),
    ("3 marks", "marks"),
    ("4 perspective density", "perspective"),
    ("exercise 3: counts in sets", "counts"),
)
_TILTS, _TRIALS, _SAMPLES, _SETS = 12, 24, 21, 6


class HomogeneityPage(LabPage):
    """Shows four experiments with points on a plane, and exercise 3."""

    name = "lab-homogeneity"
    title = "Homogeneity"
    help = "Points on a plane: what their density does not tell orthographically, what marks and perspective do."

    def build(self) -> None:
        """Make the controls and the pictures."""
        self.kind = self.add_choice("kind", "Experiment", "Which experiment", EXPERIMENTS, self.ask)
        self.slant = self.add_angle("slant", "slant", "Slant of the plane", (0, 75), 50, self.ask)
        self.tilt = self.add_angle("tilt", "tilt", "Tilt of the plane", (0, 359), 60, self.ask)
        self.count = self.add_number("points", "points", "Points in the picture", (50, 2000), self.ask)
        self.count.setSingleStep(50)
        self.count.setValue(400)
        self.add_again("Other points", "Draw other points of the same kind")
        self.lay_out(4, linked=False, words=True, readout=False)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the experiment; it needs no exemplar."""
        kind, count, seed = self.kind.currentData(), self.count.value(), self.seed
        truth = Orientation(self.slant.value(), self.tilt.value())

        def compute(should_stop: Callable[[], bool]) -> Told:
            rng = np.random.default_rng(seed)
            if kind in ("orthographic", "border"):
                return poisson_panel(truth, count, rng, should_stop, at_border=kind == "border")
            return {"marks": marks_panel, "perspective": perspective_panel, "counts": counts_panel}[kind](
                truth, count, rng
            )

        return Question((kind, count, seed, truth), compute)

    def show_answer(self, answer: Told) -> None:
        """Show pictures and words."""
        self.pictures.show_pictures(answer.shown)
        self.words.setText(answer.words)


def poisson_panel(
    truth: Orientation, count: int, rng: np.random.Generator, should_stop: Callable[[], bool], *, at_border: bool
) -> Told:
    """Return a slanted and a frontal pattern beside each other, with the unevenness of every hypothesis."""
    look = looker(should_stop)
    shown = []
    for name, orientation in (("slanted plane", truth), ("frontal control", Orientation(0))):
        pattern = points.poisson(count, orientation, rng)
        values, axis = homogeneity.uniformity_landscape(pattern, _SAMPLES, at_border=at_border, look=look)
        shown.append(Shown.of(name, points_picture(pattern)))
        picture = landscape_picture(values, axis, [(orientation, TRUTH)], (0, 1))
        tip = "How uneven every hypothesis leaves the points, from even (black) to uneven; ring: the truth."
        shown.append(Shown("unevenness", to_picture(picture), tip=tip))
    hypotheses = [Orientation(truth.slant, (truth.tilt + 180 * k / _TILTS) % 180) for k in range(_TILTS)]
    if at_border:
        hypotheses.append(Orientation(0))
    patterns = [points.poisson(count, truth, rng) for _ in range(_TRIALS)]
    chosen = []
    for each in patterns:
        look()
        chosen.append(homogeneity.most_uniform(each, hypotheses, at_border=at_border))
    if at_border:
        words = (
            "Quadrats that reach beyond the picture hold fewer points: slant 0, where none does, is chosen in "
            f"{chosen.count(_TILTS)} of {_TRIALS} patterns. It looks like an answer and is an artefact."
        )
    else:
        ratios = [homogeneity.count_ratio(each, truth.tilt) for each in patterns]
        along, across = sum(each[0] for each in ratios), sum(each[1] for each in ratios)
        words = (
            f"An affine view of a Poisson process is one again. In {_TRIALS} patterns the true tilt is chosen "
            f"{chosen.count(0)} times of {_TILTS} that are tried ({_TRIALS / _TILTS:.0f} by chance); a long "
            f"rectangle holds {along / max(across, 1):.2f} times as many points along the tilt as across it."
        )
    return Told(tuple(shown), words)


def marks_panel(truth: Orientation, count: int, rng: np.random.Generator) -> Told:
    """Return ellipses on a plane, and the orientation from their mean shape."""
    places, tensors = homogeneity.random_marks(count, truth, rng)
    found = homogeneity.orientation_of_marks(tensors)
    trials = [homogeneity.random_marks(count, truth, rng)[1] for _ in range(_TRIALS)]
    mean = float(np.mean([homogeneity.orientation_of_marks(each).error(truth) for each in trials]))
    words = (
        "The mean shape of marks in random directions is a circle on the plane. Here: slant "
        f"{found.slant:.1f}°, tilt {found.tilt:.1f}° or {found.tilt + 180:.1f}°, {found.error(truth):.1f}° off; "
        f"{mean:.1f}° on average of {_TRIALS}."
    )
    return Told((Shown.of(f"{count} marks", points_picture(places, tensors)),), words)


def perspective_panel(truth: Orientation, count: int, rng: np.random.Generator) -> Told:
    """Return a perspective pattern, and the most likely orientation."""
    pattern = homogeneity.perspective_points(count, truth, rng)
    fit = homogeneity.orientation_of_density(pattern)
    error = math.degrees(math.acos(min(1.0, float(fit.orientation.normal @ truth.normal))))
    words = (
        "Seen from near (53° across), points are denser where the plane is farther: density ~ (n · p)^-3. Most "
        f"likely: slant {fit.orientation.slant:.1f}°, tilt {fit.orientation.tilt:.1f}°, {error:.1f}° off; the "
        "tilt has no ambiguity."
    )
    if fit.at_guard:
        words += " The guard before the horizon held it back."
    return Told((Shown.of(f"{count} points", points_picture(pattern)),), words)


def counts_panel(truth: Orientation, count: int, rng: np.random.Generator) -> Told:
    """Return a Poisson and a regular pattern in sets, and what their counts say."""
    shown, told = [], []
    for name, pattern in (("Poisson", points.poisson(count, truth, rng)), ("regular", points.regular(count, rng))):
        counts = points.count_in_sets(pattern, _SETS)
        shown.append(Shown.of(f"{name}: p {counts.p_value:.2f}", points_picture(pattern, sets=_SETS)))
        told.append(f"{name}: chi-square {counts.chi_square:.0f}, p {counts.p_value:.2f}, {counts.verdict}")
    area = float(exercises.back_projected_areas(_SETS, _SETS, truth, "orthographic")[0, 0])
    words = (
        "; ".join(told)
        + f". On the plane every set is {area * _SETS**2:.2f} times as large as in the picture, wherever it lies: "
        "if the density on the plane is known the count gives the slant, and nothing gives the tilt."
    )
    return Told(tuple(shown), words)
