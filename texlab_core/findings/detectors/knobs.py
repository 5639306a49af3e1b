"""Thresholds that are out of range for this exemplar."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.findings.finding import Remedy, Where
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.methods.efros_leung.params import EfrosLeungParams
from texlab_core.methods.efros_leung.windows import effective_tau

if TYPE_CHECKING:
    from texlab_core.engine.steps import FloatImage

# α where 47 of 51 labelled results are noisy, and where 47 of 51 are copies.
ALPHA_HIGH, ALPHA_LOW = 0.6, 0.05
# Share of the exemplar's spread that τ may be: 15 of 50 gray levels is worse on every texture tried.
TAU_SHARE = 0.25
TAU_GOOD = 0.08


def _alpha(case: Case) -> Seen | None:
    alpha = case.knob("alpha")
    if not isinstance(alpha, float | int) or case.knob("normalization") != "variance":
        return None
    counts = case.value("median-candidates")
    choice = (
        "" if counts is None else f"; half of the pixels had {case.text('median-candidates')} candidates and more"
    )
    where = Where("parameters", f"α = {alpha:g}")
    if alpha >= ALPHA_HIGH:
        return Seen(
            f"α = {alpha:g} is large: at 0.6 labelled results were noisy for 47 of 51 exemplars{choice}.",
            where,
            Remedy("Set α to 0.15, the paper's.", {"alpha": 0.15}),
        )
    if 0 <= alpha <= ALPHA_LOW:
        return Seen(
            f"α = {alpha:g} is small: at 0.05 labelled results were copies for 47 of 51 exemplars{choice}.",
            where,
            Remedy("Set α to 0.15, the paper's.", {"alpha": 0.15}),
        )
    return None


def _tau(case: Case) -> Seen | None:
    params = case.params
    if not isinstance(params, EfrosLeungParams) or case.subject.exemplar is None or params.criterion == "ncc":
        return None
    spread = _spread(case.subject.pixels)
    tau = effective_tau(params.tau, params.tau_scale, params.criterion, case.subject.pixels)
    where = Where("parameters", f"τ = {params.tau:g}")
    if params.tau == 0:
        return Seen(
            "τ = 0: once a window is found exactly nothing else matches, and the exemplar is laid down verbatim.",
            where,
            Remedy("Set τ to 3 gray levels.", {"tau": 3.0}),
        )
    if spread <= 0 or tau <= TAU_SHARE * spread:
        return None
    words = (
        f"τ of {tau:.3g} gray levels is large for an exemplar whose values spread by {spread:.3g}: it gives noise."
    )
    if params.tau_scale == "absolute":
        return Seen(words, where, Remedy("Let τ follow the exemplar's contrast.", {"tau_scale": "relative"}))
    good = max(0.5, float(f"{params.tau * TAU_GOOD * spread / tau:.2g}"))
    return Seen(words, where, Remedy(f"Set τ to {good:g} gray levels.", {"tau": good}))


def _spread(pixels: FloatImage) -> float:
    """Return the standard deviation in gray levels, root mean square over the channels."""
    return 255 * float(np.sqrt(pixels.reshape(-1, pixels.shape[2]).var(axis=0, dtype=np.float64).mean()))


register(
    Detector(
        id="alpha-range",
        title="α out of range",
        summary="The threshold is far from what gives new texture without noise.",
        measures=("median-candidates",),
        see=_alpha,
        why={
            "": "Thresholds decide between copying and noise (De Bonet 1997, figs. 11 and 12).",
        },
        methods=("de-bonet",),
        order=80,
    )
)
register(
    Detector(
        id="tau-range",
        title="τ out of range",
        summary="The threshold does not fit the exemplar's contrast.",
        measures=("exact-share",),
        see=_tau,
        why={
            "": "Whatever differs by less than τ matches: with 0 only copies do, with a good part of the contrast "
            "everything does (Forsyth and Ponce, section 11.3.4).",
        },
        methods=("efros-leung",),
        order=82,
    )
)
