"""The pyramids that subbands can be looked at in."""

from __future__ import annotations

from typing import Literal

PyramidKind = Literal["steerable", "laplacian", "gaussian", "oriented", "gabor", "gabor magnitude", "filter bank"]
