"""How fine structure depends on coarse structure: child against parent, exemplar against result.

Heeger and Bergen's method matches every band alone, "made without asking the others"; the textbook calls that the
independence assumption. Here the joint histogram of the magnitudes of a band (child) and of the band one octave
below (parent) is taken, each magnitude replaced by its rank, so that only their dependence is left.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.measures.registry import Measure, register
from texlab_core.stats.dependence import Pair, difference, rank_histograms

if TYPE_CHECKING:
    from texlab_core.measures.subject import Subject

PAIR = Pair()


def dependence_difference(subject: Subject) -> float | None:
    """Return the total variation (0 .. 1) between the joint histograms, mean over the orientations."""
    if min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < PAIR.smallest:
        return None
    own = subject.prepared("child and parent", lambda pixels, look: rank_histograms(pixels, PAIR, look))
    other = subject.once("child and parent", lambda: rank_histograms(subject.image, PAIR, subject.look))
    return difference(own, other)


register(
    Measure(
        id="dependence-difference",
        title="dependence",
        summary="How differently fine details depend on coarse ones: total variation between the joint histograms "
        "of a band's magnitudes and its parent's, by rank. 0 for the exemplar itself; what matching every band "
        "alone loses.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=dependence_difference,
        form=".3f",
        reference="D. A. Forsyth and J. Ponce, Computer Vision, section 11.3.2; D. J. Heeger and J. R. Bergen, "
        "SIGGRAPH 1995, section 6",
        order=62,
    )
)
