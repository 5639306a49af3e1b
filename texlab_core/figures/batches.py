"""Figures of the help page of batches."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.batch.plan import find_plan
from texlab_core.figures import Figure
from texlab_core.figures._tools import make, page
from texlab_core.sheets.contact_sheet import Tile

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

PLAN = "gallery:de-bonet-800"
SHOWN = 9


def sample() -> NDArray[np.uint8]:
    """Show exemplars of De Bonet's experiment and their textures, spread evenly over the plan."""
    plan = find_plan(PLAN)
    (variant,), (seed,), (size,) = plan.variants, plan.seeds, plan.sizes
    tiles = []
    for place in sorted(plan.sample(SHOWN)):
        choice = plan.exemplars[place]
        exemplar = choice.load()
        values = variant.params.to_json()
        result = make(variant.method, exemplar, size.of(exemplar.size), seed=seed, **values)
        tiles += [Tile(exemplar.pixels, (choice.name.partition("-")[2],)), Tile(result.image, ())]
    return page(tiles, 6)


FIGURES = (Figure("batches-de-bonet-800.jpg", "Nine of De Bonet's 800 textures and their exemplars.", sample),)
