"""Every figure and table with a number of the four papers: the step that redraws it, or why there is none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.documents.lessons import PAPERS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab_core.documents.lessons import Lesson


@dataclass(frozen=True)
class FigureEntry:
    """One figure or table.

    Parameters
    ----------
    paper
        A key of ``PAPERS``.
    number
        "11.15", "table 1".
    shows
        What it shows, in a few words.
    steps
        Name of a lesson and number of a step from 1, for each step that redraws it.
    reason
        Why no step does; "" when one does.
    """

    paper: str
    number: str
    shows: str
    steps: tuple[tuple[str, int], ...] = ()
    reason: str = ""

    @property
    def title(self) -> str:
        """Paper and number for people."""
        kind = "" if self.number.startswith("table") else "Fig. "
        return f"{PAPERS[self.paper]}, {kind}{self.number.replace('table', 'Table')}"


_DIAGRAM = (
    "A diagram of boxes and arrows, without pictures; the lesson goes through its boxes one after the other."
)
_SHOWN: Mapping[str, tuple[tuple[str, str], ...]] = {
    "de-bonet": (
        ("1", "a texture as input"),
        ("2", "simple repetition"),
        ("3", "pixels drawn independently"),
        ("4", "every band drawn independently"),
        ("5", "what is wanted: random and alike"),
        ("6", "regions that may change places, by resolution"),
        ("7", "several places are candidates"),
        ("8", "the parent structure of a pixel"),
        ("9", "from the analysis pyramid to the synthesis pyramid"),
        ("10", "results"),
        ("11", "thresholds from 0.05 to 0.3, the same at all levels"),
        ("12", "thresholds that are stricter at fine levels"),
        ("13", "man-made and natural textures"),
        ("14", "a texture beyond histogram matching"),
    ),
    "heeger-bergen": (
        ("1", "system diagram of the steerable pyramid"),
        ("2", "sample, noise, synthetic texture"),
        ("3", "successes"),
        ("4", "more successes"),
        ("5", "mixtures: the colours of one, the pattern of another"),
        ("6", "inhomogeneous and homogeneous input"),
        ("7", "failures: wood grain and coral"),
        ("8", "more failures: hay and marble"),
    ),
    "msg": (
        ("1", "block diagram of analysis and synthesis"),
        ("2", "the Gabor filters in the frequency plane"),
        ("3", "block diagram of the method"),
        ("4", "the low-pass residual and its five regions"),
        ("5", "the histogram, low-passed"),
        ("6", "block diagram of the comparison"),
        ("7", "samples of the autocorrelation, neighbours of a pixel"),
        ("8", "originals and four models"),
        ("table 1", "what the 69 numbers are"),
        ("table 2", "rms of the channels of two textures"),
    ),
    "forsyth-ponce": (
        ("11.1", "stylized elements, as shown to human subjects"),
        ("11.2", "photographs of foliage and water"),
        ("11.3", "eight filters: two spots, six bars"),
        ("11.4", "their answers at a fine scale"),
        ("11.5", "their answers at a coarser scale"),
        ("11.6", "a representation by smoothed energies"),
        ("11.7", "a Laplacian pyramid"),
        ("11.8", "annuli and wedges of the frequency plane"),
        ("11.9", "Gabor kernels"),
        ("11.10", "Gabor kernels at a finer scale"),
        ("11.11", "a zebra's stripes and one Gabor filter"),
        ("11.12", "an oriented pyramid"),
        ("11.13", "analysis of the oriented pyramid"),
        ("11.14", "synthesis from the oriented pyramid"),
        ("11.15", "histogram equalization of two images"),
        ("11.16", "successes of histogram equalization"),
        ("11.17", "failures of histogram equalization"),
        ("11.18", "parent structure"),
        ("11.19", "results of De Bonet's algorithm"),
        ("11.20", "coral by both algorithms"),
        ("11.21", "results of Efros and Leung's algorithm"),
        ("11.22", "windows from small to large"),
        ("11.23", "shape seen from texture"),
        ("11.24", "slant, tilt, and a circle seen as an ellipse"),
        ("11.25", "texture at one point and at another"),
    ),
}
# What no step redraws, and why.
_REASONS: Mapping[tuple[str, str], str] = {
    ("heeger-bergen", "1"): _DIAGRAM,
    ("msg", "1"): _DIAGRAM,
    ("msg", "3"): _DIAGRAM,
    ("msg", "6"): _DIAGRAM,
    ("forsyth-ponce", "11.1"): "Stimuli of an experiment with human subjects; the program makes no such patterns.",
    ("forsyth-ponce", "11.2"): "Photographs that are not the program's to show; nothing is computed in them.",
}


def figure_index(lessons: Mapping[str, Lesson]) -> tuple[FigureEntry, ...]:
    """Return every figure and table, paper by paper, with the steps of these lessons that redraw it."""
    steps: dict[str, list[tuple[str, int]]] = {}
    for name, lesson in lessons.items():
        for number, step in enumerate(lesson.steps, 1):
            for figure in step.figures:
                steps.setdefault(figure, []).append((name, number))
    return tuple(
        FigureEntry(
            paper,
            number,
            shows,
            tuple(steps.get(f"{paper} {number}", ())),
            _REASONS.get((paper, number), ""),
        )
        for paper, entries in _SHOWN.items()
        for number, shows in entries
    )


def numbers(paper: str) -> tuple[str, ...]:
    """Return the numbers of a paper's figures and tables."""
    return tuple(number for number, _ in _SHOWN.get(paper, ()))
