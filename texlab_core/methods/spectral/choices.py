"""The words that parameters of the spectral methods take."""

from __future__ import annotations

from typing import Literal

BandwidthMeasure = Literal["participation", "paper"]
BandwidthAxes = Literal["uv", "radial"]
Equations = Literal["corrected", "printed"]
PhaseChoice = Literal["one", "sixteen"]
HistogramChoice = Literal["coded", "full"]
HistogramKind = Literal["samples", "blocks"]
