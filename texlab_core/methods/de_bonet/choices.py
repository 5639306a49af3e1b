"""The words that parameters take, and the knobs that independent bands have too."""

from __future__ import annotations

from typing import Literal

from texlab_core.engine.params import Knob

Coarsest = Literal["patches", "fit", "shift", "tile", "iid"]
ExemplarBorder = Literal["reflect", "periodic", "smooth"]
Fitting = Literal["pad", "crop"]
FilterSet = Literal["both", "first", "second", "laplacian"]
Channels = Literal["all", "scaled", "principal", "luminance"]
Normalization = Literal["variance", "level", "range", "sum", "printed"]

COARSEST_SIDE = Knob(
    help="Smallest side of the coarsest level.",
    low=1,
    high=64,
    unit="px",
    log=True,
    stage="analysis",
    group="Pyramid",
)
FITTING = Knob(
    help="How the sides of the exemplar become multiples of 2^N, N the number of halvings.",
    stage="analysis",
    choices={
        "pad": "goes on below and on the right as the border says; nothing is lost",
        "crop": "reduced to its centre",
    },
    formerly="crop",
    group="Pyramid",
)
