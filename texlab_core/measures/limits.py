"""Limits of measures and how they are known: one table, which the help and the findings read.

All come from one observer's labels of 459 results on 51 textures, 128 -> 256 pixels (score 2 and above is good),
and are recomputed by ``python -m texlab_core.measures.calibrate LABELS``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Zone = Literal["good", "unsure", "bad"]


@dataclass(frozen=True)
class Limit:
    """What the values of a measure mean.

    Parameters
    ----------
    measure
        Its id.
    good, bad
        At ``good`` and better results are good, at ``bad`` and worse they are not; ``unsure`` in between. The two
        are equal where there is one cut only.
    evidence
        What was measured, one sentence.
    """

    measure: str
    good: float
    bad: float
    evidence: str

    def zone(self, value: float) -> Zone:
        """Return what a value means."""
        sign = 1 if self.bad >= self.good else -1
        if math.isnan(value):
            return "unsure"
        if sign * value <= sign * self.good:
            return "good"
        return "bad" if sign * value >= sign * self.bad else "unsure"


LIMITS = {
    each.measure: each
    for each in (
        Limit(
            "discriminability",
            -3.4,
            -2.1,
            "Of 459 labelled results, 94% at -3.4 and below are good, 96% at -2.1 and above are not; AUC 0.952.",
        ),
        Limit(
            "cuts",
            5.0,
            9.0,
            "Medians of results without and with visible straight cuts, 204 of De Bonet's method; AUC 0.79.",
        ),
        Limit(
            "exemplar-drift",
            0.16,
            0.3,
            "36 of 51 exemplars were called homogeneous: 90% of them are below 16%, all below 31%; AUC 0.88.",
        ),
        Limit(
            "exemplar-unevenness",
            1.7,
            2.5,
            "90% of the exemplars called homogeneous are below 1.7, all below 2.1; AUC 0.65, so look yourself.",
        ),
    )
}
