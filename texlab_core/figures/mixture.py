"""Figures of the help page of mixtures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab_core.figures import Figure
from texlab_core.figures._tools import make, page, texture, title_of
from texlab_core.sheets.contact_sheet import Tile

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage

SIDE = 112
KINDS = {
    "average": "everything in equal shares",
    "palette": "colours of the left one",
    "start": "starts from the right one",
    "scales": "coarse left, fine right",
}


def _mixed(first: str, second: str, **values: Any) -> FloatImage:
    inputs = {"second": texture(second, SIDE)}
    return make("mixture", texture(first, SIDE), SIDE, inputs=inputs, **values).image


def strip() -> NDArray[np.uint8]:
    """Show the way from one texture to another, twice."""
    tiles = []
    for first, second in (("stochastic-granite", "stochastic-lava"), ("oriented-fur", "stochastic-grass")):
        for weight in (0.0, 0.25, 0.5, 0.75, 1.0):
            tiles.append(Tile(_mixed(first, second, weight=weight), (f"weight {weight:g}",)))
    return page(tiles, 5)


def kinds() -> NDArray[np.uint8]:
    """Show pairs of textures and their mixtures of every kind."""
    tiles = []
    for first, second in (
        ("stochastic-lava", "structured-scales"),
        ("stochastic-bark", "structured-pebbles"),
        ("oriented-woodgrain", "stochastic-granite"),
    ):
        tiles += [Tile(texture(name, SIDE).pixels, (title_of(name),)) for name in (first, second)]
        tiles += [Tile(_mixed(first, second, kind=kind), (kind, said)) for kind, said in KINDS.items()]
    return page(tiles, 6)


FIGURES = (
    Figure("mixture-strip.jpg", "From one texture to another.", strip),
    Figure("mixture-kinds.jpg", "Pairs of textures, and their mixtures of every kind.", kinds),
)
