"""How much choice the method had: the median number of candidates of a pixel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.registry import Measure, register

if TYPE_CHECKING:
    from texlab_core.measures.subject import Subject


def _median(subject: Subject) -> float | None:
    counts = subject.first_map("count")
    return None if counts is None or counts.size == 0 else float(np.median(counts))


register(
    Measure(
        id="median-candidates",
        title="candidates",
        summary="Median number of places in the exemplar that a pixel could have been copied from: 1 leaves no "
        "choice, so that the exemplar is laid down verbatim.",
        low=0.0,
        high=2.0**26,
        better="neither",
        needs=("counts",),
        function=_median,
        form=",.4g",
        reference="J. S. De Bonet, SIGGRAPH 1997, section 3.2",
        live=True,
        order=70,
    )
)
