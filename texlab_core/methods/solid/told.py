"""What only the synthesis of a solid can say of it: the registry's measures see its middle slice."""

from __future__ import annotations

from texlab_core.measures.registry import Measure, register

_PAPER = "D. J. Heeger and J. R. Bergen, SIGGRAPH 1995, section 3"


def _distance(id: str, title: str, summary: str, order: int) -> Measure:
    return register(
        Measure(
            id=id,
            title=title,
            summary=summary,
            low=0.0,
            high=1e4,
            better="lower",
            needs=("method",),
            form=".3f",
            reference=_PAPER,
            order=order,
        )
    )


VOXELS = _distance(
    "w1-voxels",
    "W1 voxels",
    "How far the histograms of the whole solid's channels are from the exemplar's (Wasserstein-1 in standard "
    "deviations of the exemplar); 0 for equal histograms.",
    62,
)
BANDS = _distance(
    "w1-solid-bands",
    "W1 solid",
    "How far the histograms of the solid's own Laplacian bands are from the exemplar's (Wasserstein-1 in standard "
    "deviations of the exemplar's band, mean over bands and colour axes).",
    63,
)
SLICES = {
    cut: _distance(
        f"w1-slices-{cut}",
        f"W1 {cut}",
        f"How far the {cut} slices are from the exemplar, seen as pictures of their own: Wasserstein-1 of their "
        "Laplacian bands in standard deviations, mean over bands and colour axes; alike for all three cuts.",
        64 + place,
    )
    for place, cut in enumerate(("xy", "xz", "yz"))
}
MEASURES = (VOXELS.id, BANDS.id, *(each.id for each in SLICES.values()))
