"""What only the spectral methods can say of their results: the numbers they keep, and what they had to give up."""

from __future__ import annotations

from texlab_core.measures.registry import Measure, register

PARAMETERS = register(
    Measure(
        id="parameters",
        title="numbers",
        summary="How many numbers the method keeps of the exemplar; those that keep the exemplar itself say none.",
        low=1.0,
        high=2.0**32,
        better="lower",
        needs=("method",),
        form=".0f",
        reference="R. Navarro and J. Portilla, EUSIPCO 1996",
        order=5,
    )
)
LARGEST_POLE = register(
    Measure(
        id="largest-pole",
        title="largest pole",
        summary="The largest pole of the autoregressive model; from 1 on its recursion does not die out and the "
        "model is only usable through its spectrum.",
        low=0.0,
        high=1e6,
        better="lower",
        needs=("method",),
        form=".3f",
        order=71,
    )
)
NEGATIVE_POWER = register(
    Measure(
        id="negative-power",
        title="power clipped",
        summary="Share of the spectrum of the sampled autocorrelation that was negative, which no picture can "
        "have, and was set to 0.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("method",),
        form=".1%",
        order=72,
    )
)
ENERGY_ERROR = register(
    Measure(
        id="energy-error",
        title="code missed",
        summary="By how much the energies of the channels miss the code where the equations would need negative "
        "ones, as a share of the code's.",
        low=0.0,
        high=1e6,
        better="lower",
        needs=("method",),
        form=".1%",
        reference="R. Navarro and J. Portilla, EUSIPCO 1996, eq. 5",
        order=73,
    )
)
