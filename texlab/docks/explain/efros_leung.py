"""Efros and Leung: the window around a pixel, the places that match it best, and the one that was copied."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtWidgets import QVBoxLayout

from texlab.docks.explain.base import Explainer, ExplanationView, never
from texlab.docks.explain.patch_grid import Patch, PatchGrid
from texlab.style.numbers import number
from texlab.style.pictures import Mark, to_picture
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.inputs import exemplar_of
from texlab_core.methods.efros_leung.evidence import UNITS
from texlab_core.methods.efros_leung.explain import Explanation, Grown, explain

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.docks.explain.patch_grid import Frame
    from texlab.style.theme import Theme
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.efros_leung.windows import Matching

BEST = 12
# More marks than this tell no more, and would slow the painting down.
MOST_MARKS = 600
UNKNOWN = 0.5
# How much is left of the contrast of what was not compared.
DIMMED = np.float32(0.2)


@dataclass(frozen=True, eq=False)
class ExplainedPixel:
    """An explanation with what its view needs.

    Parameters
    ----------
    explanation, matching
        From the core: what was found, and how it was compared.
    moment
        When the pixel was filled, counted from 1, and how many pixels were filled in all.
    patches
        The window, the best matches, and the chosen one where it is not among them.
    places
        Row and column in the exemplar of every patch; None for the window.
    """

    explanation: Explanation
    matching: Matching
    moment: tuple[int, int]
    patches: tuple[Patch, ...]
    places: tuple[tuple[int, int] | None, ...]


def explain_pixel(
    result: Result, row: int, column: int, should_stop: Callable[[], bool] = never
) -> ExplainedPixel:
    """Explain a pixel of a grown result (in a background thread)."""
    grown: Grown = result.details
    found = explain(grown, row, column, best=BEST)
    matching = grown.matching
    exemplar = exemplar_of(result.job.inputs).pixels
    places = [(int(top), int(left)) for top, left in found.places]
    distances = [float(each) for each in found.distances]
    if not found.given and found.chosen is not None and found.chosen not in places:
        places.append(found.chosen)
        distances.append(found.chosen_distance)
    matches = {(int(top), int(left)) for top, left in found.match_set}
    patches = [Patch(to_picture(found.window), "the window", "window", "What was known around the pixel")]
    for rank, (place, distance) in enumerate(zip(places, distances, strict=True), 1):
        frame: Frame = "chosen" if place == found.chosen else "match" if place in matches else "other"
        kind = {"chosen": "copied", "match": "could have been copied", "other": "too far away"}[frame]
        title = f"Match {rank}, {place[1]}, {place[0]} of the exemplar: d = {number(distance)}, {kind}"
        patch = around(exemplar, place, found.weights, periodic=matching.border == "periodic")
        patches.append(Patch(to_picture(patch), f"{number(distance)}", frame, title))
    moment = int(grown.canvas.order[row, column]), int(grown.canvas.order.max())
    return ExplainedPixel(found, matching, moment, tuple(patches), (None, *places))


def around(
    exemplar: FloatImage, place: tuple[int, int], weights: NDArray[np.float32], *, periodic: bool
) -> FloatImage:
    """Return the exemplar around a place, (w, w, C) float32: what was not compared is dimmed.

    Parameters
    ----------
    exemplar
        (H, W, C) float32.
    place
        Row and column of the middle.
    weights
        (w, w) float32, above 0 where the windows were compared.
    periodic
        Whether the exemplar is repeated beyond its border; else there is mid-gray.
    """
    side = len(weights)
    rows, columns = (np.arange(middle - side // 2, middle + side // 2 + 1) for middle in place)
    height, width = exemplar.shape[:2]
    patch = exemplar[np.ix_(rows % height, columns % width)].copy()
    if not periodic:
        outside = ((rows < 0) | (rows >= height))[:, None] | ((columns < 0) | (columns >= width))
        patch[outside] = UNKNOWN
    compared = weights > 0
    # The middle was not compared, but it is what is copied.
    compared[side // 2, side // 2] = True
    dimmed: FloatImage = np.where(compared[..., None], patch, UNKNOWN + (patch - UNKNOWN) * DIMMED)
    return dimmed.astype(np.float32)


def summary(explained: ExplainedPixel) -> str:
    """Return why the pixel is what it is, in words."""
    found, matching = explained.explanation, explained.matching
    unit = UNITS[matching.criterion]
    origin = "" if found.chosen is None else f"{found.chosen[1]}, {found.chosen[0]} of the exemplar"
    if found.given:
        return f"Known from the start: {origin or 'given, and not from the exemplar'}."
    count = len(found.match_set)
    words = [f"Filled as pixel {explained.moment[0]:,} of {explained.moment[1]:,}, copied from {origin}"]
    if not np.any(found.weights > 0):
        words[0] += ", drawn from all places: nothing around it was known."
        return words[0]
    words[0] += f" at d = {number(found.chosen_distance)} {unit}".rstrip() + "."
    widened = (1 + matching.eps) * found.d_min
    rule = f"(1 + {matching.eps:g}) · d_min" if widened >= found.limit else f"tau = {matching.tau:.3g}"
    choice = "The only place" if count == 1 else f"One of {count:,} places"
    words.append(
        f"{choice} up to the limit {number(found.limit)}, which comes from {rule}; d_min = {number(found.d_min)}."
    )
    if found.earlier:
        words.append("It was filled before the settings changed: this is how it would match under these.")
    return " ".join(words)


def marks(explained: ExplainedPixel, index: int) -> tuple[Mark, ...]:
    """Return the match set, the window around the patch that is looked at, and the pixel that was copied."""
    found = explained.explanation
    picked = np.linspace(0, len(found.match_set) - 1, min(len(found.match_set), MOST_MARKS)).astype(int)
    shown = [Mark(float(row), float(column), 1.0, 1.0) for row, column in found.match_set[picked]]
    place = explained.places[index] or found.chosen
    if place is not None and not found.given:
        side = explained.matching.window
        shown.append(Mark(place[0] - side // 2, place[1] - side // 2, side, side, "window"))
    if found.chosen is not None:
        shown.append(Mark(float(found.chosen[0]), float(found.chosen[1]), 1.0, 1.0, "chosen"))
    return tuple(shown)


class EfrosLeungView(ExplanationView):
    """The window and its best matches, words below."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("explain-efros-leung")
        self._explained: ExplainedPixel | None = None
        self.grid = PatchGrid("explain-patches", "The window and its best matches")
        set_tip(
            self.grid,
            "First the window, then the places of the exemplar that match it best, with their distances. "
            "Thick frame: copied. Thin: could have been copied. Dotted: too far away. "
            "What is dimmed was not compared.",
        )
        self.grid.chosen.connect(lambda index: self._look_at(index))
        self.grid.hovered.connect(lambda index: self._look_at(index if index >= 0 else self.grid.selected))
        self.words = Label(name="explain-growth-words", wraps=True)
        self.words.setAccessibleName("Why the pixel is there")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 0, 6, 4)
        layout.setSpacing(2)
        layout.addWidget(self.grid, 1)
        layout.addWidget(self.words)
        self.setFocusProxy(self.grid)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.grid.set_theme(theme)

    def show_explanation(self, explained: ExplainedPixel) -> None:
        """Show the window of a pixel and its matches."""
        self._explained = explained
        self.grid.show_patches(explained.patches)
        self.grid.select(-1)
        self._look_at(-1)

    def empty_parts(self) -> None:
        """Empty the window, its matches and the words."""
        self.grid.show_patches(())
        self.words.setText("")

    def _look_at(self, index: int) -> None:
        explained = self._explained
        if explained is None:
            return
        known = 0 < index < len(explained.patches)
        self.words.setText(f"{explained.patches[index].title}." if known else summary(explained))
        self.marks_changed.emit(marks(explained, index if known else 0))


EXPLAINER = Explainer(
    Grown,
    explain_pixel,
    EfrosLeungView,
    "For Efros-Leung: the window with what was known when the pixel was filled, the places that match it best "
    "with their distances, and which of them was copied.",
)
