"""Figures of the help page of Efros-Leung: the textbook's assignment c, and copying."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.figures import Figure
from texlab_core.figures._tools import evidence, make, page, texture, title_of
from texlab_core.sheets.contact_sheet import Tile
from texlab_core.sheets.sweep_sources import find_sweep

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage

TEXTURES = ("structured-scales", "letters-scattered", "stochastic-gravel")
WORKS = ("structured-shingle", "quasiperiodic-knit", "oriented-zebra", "structured-scales")
FAILS = ("structured-coins", "inhomogeneous-litbrick", "failure-symbols", "failure-spiral")


def series(name: str) -> NDArray[np.uint8]:
    """Draw the first knob of a ready-made sweep for its own exemplar and for some more."""
    recipe = find_sweep(name)
    if recipe.exemplar is None or recipe.size is None:
        raise ValueError(f"The sweep {name} must say for which exemplar and which size it is.")
    axis = recipe.axes[0]
    names = dict.fromkeys((recipe.exemplar.name.removeprefix("gallery:"), *TEXTURES))
    tiles = []
    for each in names:
        exemplar = texture(each, 64)
        tiles.append(Tile(exemplar.pixels, (title_of(each),)))
        for value in axis.values:
            chosen: dict[str, Any] = {**recipe.parameters, axis.name: value}
            result = make("efros-leung", exemplar, recipe.size, recipe.seed, **chosen)
            tiles.append(Tile(result.image, (f"{axis.name} {value}", evidence(result))))
    return page(tiles, 1 + len(axis.values))


def tolerance() -> NDArray[np.uint8]:
    """Draw results over maps of their sources for growing tau."""
    exemplar = texture("structured-shingle", 96)
    taus = (0.0, 3.0, 10.0, 30.0)
    made = [make("efros-leung", exemplar, 160, tau=tau) for tau in taus]
    tiles = [Tile(exemplar.pixels, ("exemplar",))]
    tiles += [Tile(each.image, (f"tau {tau:g}", evidence(each))) for tau, each in zip(taus, made, strict=True)]
    tiles += [Tile(position_colours(exemplar.size), ("colour = place",))]
    tiles += [Tile(sources(each, exemplar.size), ("where from",)) for each in made]
    return page(tiles, 1 + len(taus))


def position_colours(size: tuple[int, int]) -> FloatImage:
    """Return a colour for every place of an exemplar: red grows downwards, blue to the right."""
    rows, columns = np.mgrid[: size[0], : size[1]].astype(np.float32)
    rows, columns = rows / max(size[0] - 1, 1), columns / max(size[1] - 1, 1)
    return np.stack([rows, np.full_like(rows, 0.45), columns], axis=2)


def sources(result: Result, size: tuple[int, int]) -> FloatImage:
    """Return the map of sources in the colours of their places."""
    places = result.maps["source"].data
    known = (places >= 0).all(axis=2)
    colours: FloatImage = position_colours(size)[np.maximum(places[..., 0], 0), np.maximum(places[..., 1], 0)]
    colours[~known] = 1.0
    return colours


def works_and_fails() -> NDArray[np.uint8]:
    """Show exemplars over results, where the method works and where it cannot."""
    tiles = []
    for names in (WORKS, FAILS):
        tiles += [Tile(texture(name, 96).pixels, (title_of(name),)) for name in names]
        for name in names:
            result = make("efros-leung", texture(name, 96), 160)
            tiles.append(Tile(result.image, ("result", evidence(result))))
    return page(tiles, 4)


FIGURES = (
    Figure(
        "efros-leung-windows.jpg",
        "The textbook's Fig. 11.22: the window grows.",
        lambda: series("efros-leung-windows"),
    ),
    Figure(
        "efros-leung-shapes.jpg",
        "Assignment c: shapes of the window.",
        lambda: series("efros-leung-shapes"),
    ),
    Figure(
        "efros-leung-criteria.jpg",
        "Assignment c: matching criteria.",
        lambda: series("efros-leung-criteria"),
    ),
    Figure("efros-leung-tau.jpg", "Copying: results over maps of their sources.", tolerance),
    Figure("efros-leung-results.jpg", "Where the method works, and where it cannot.", works_and_fails),
)
