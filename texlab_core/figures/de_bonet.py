"""Figures of the help pages of De Bonet and of the baselines: the paper's Figs. 2, 3, 4, 11 and 12, and more."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab_core.figures import Figure
from texlab_core.figures._tools import evidence, make, page, picture, texture, title_of
from texlab_core.measures.registry import written
from texlab_core.sheets.contact_sheet import Tile
from texlab_core.sheets.sweep_running import run_sweep
from texlab_core.sheets.sweep_sources import find_sweep

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

ALPHAS = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3)
WORKS = ("stochastic-grass", "structured-shingle", "quasiperiodic-canvas", "stochastic-rock")
FAILS = ("letters-scattered", "structured-coins", "failure-mirror", "failure-sizegradient")


def baselines() -> NDArray[np.uint8]:
    """Redraw Figs. 2, 3 and 4: what happens without conditioning, beside what happens with it."""
    tiles = []
    for name in ("stochastic-gravel", "structured-scales"):
        exemplar = texture(name, 96)
        tiles.append(Tile(exemplar.pixels, ("exemplar", title_of(name))))
        captions = {
            "tiling": "tiling (Fig. 2)",
            "pixels": "independent pixels (Fig. 3)",
            "bands": "independent bands (Fig. 4)",
            "de-bonet": "De Bonet",
        }
        for method, caption in captions.items():
            tiles.append(Tile(make(method, exemplar, 192).image, (caption,)))
    return page(tiles, 5)


def series(name: str) -> NDArray[np.uint8]:
    """Draw the exemplar and the cells of a ready-made sweep of one knob."""
    sweep = find_sweep(name).sweep()
    exemplar = sweep.base.inputs["exemplar"]
    tiles = [
        Tile(
            picture(cell), (cell.setting, ", ".join(written(cell.measures, ["copied-share", "median-candidates"])))
        )
        for cell in run_sweep(sweep)
    ]
    original = Tile(exemplar.pixels, ("exemplar", title_of(exemplar.name)))  # type: ignore[union-attr]  # an image
    return page([original, *tiles[:3], Tile(None), *tiles[3:]], 4)


def alpha_beta() -> NDArray[np.uint8]:
    """Draw alpha across and beta down."""
    sweep = find_sweep("de-bonet-alpha-beta").sweep()
    tiles = [Tile(picture(cell), tuple(written(cell.measures, ["copied-share"]))) for cell in run_sweep(sweep)]
    heads = [[f"{axis.name} {value:g}" for value in axis.values] for axis in sweep.axes]
    return page(tiles, len(heads[0]), column_heads=heads[0], row_heads=heads[1])


def features() -> NDArray[np.uint8]:
    """Show what the parent structures have to hold: Laplacian bands alone, first, second, both derivatives."""
    tiles = []
    for name in ("quasiperiodic-knit", "oriented-fur"):
        exemplar = texture(name, 96)
        tiles.append(Tile(exemplar.pixels, ("exemplar", title_of(name))))
        for filters in ("laplacian", "first", "second", "both"):
            result = make("de-bonet", exemplar, 192, filters=filters, alpha=0.3)
            tiles.append(Tile(result.image, (f"filters {filters}", evidence(result))))
    return page(tiles, 5)


def coarsest() -> NDArray[np.uint8]:
    """Show how the coarsest level is laid out: as in the paper, at random, and so that it continues itself."""
    exemplar = texture("structured-shingle", 96)
    tiles = [Tile(exemplar.pixels, ("exemplar",))]
    layouts: dict[str, dict[str, Any]] = {
        "tile, 1 pixel": {"coarsest": "tile", "coarsest_side": 1, "fit_filters": False},
        "shift": {"coarsest": "shift"},
        "iid": {"coarsest": "iid"},
        "fit, border smooth": {"coarsest": "fit", "border": "smooth"},
        "patches": {"coarsest": "patches"},
    }
    for caption, values in layouts.items():
        result = make("de-bonet", exemplar, 240, **values)
        tiles.append(Tile(result.image, (caption, evidence(result))))
    return page(tiles, 3)


def literal_sum() -> NDArray[np.uint8]:
    """Show eq. 10 with the five choices of Z."""
    exemplar = texture("stochastic-gravel", 96)
    tiles = [Tile(exemplar.pixels, ("exemplar",))]
    for choice in ("variance", "level", "range", "sum", "printed"):
        result = make("de-bonet", exemplar, 192, normalization=choice)
        tiles.append(Tile(result.image, (f"normalization {choice}", evidence(result))))
    return page(tiles, 3)


def works_and_fails() -> NDArray[np.uint8]:
    """Show exemplars over results, where the method works and where it cannot."""
    tiles = []
    for names in (WORKS, FAILS):
        tiles += [Tile(texture(name, 128).pixels, (title_of(name),)) for name in names]
        for name in names:
            result = make("de-bonet", texture(name, 128), 256, alpha=0.2)
            tiles.append(Tile(result.image, ("result", evidence(result))))
    return page(tiles, 4)


FIGURES = (
    Figure("de-bonet-figs-2-3-4.jpg", "The paper's Figs. 2, 3 and 4.", baselines),
    Figure(
        "de-bonet-fig-11.jpg", "The paper's Fig. 11: alpha from 0.05 to 0.30.", lambda: series("de-bonet-fig-11")
    ),
    Figure("de-bonet-fig-12.jpg", "The paper's Fig. 12: the same with beta 1.", lambda: series("de-bonet-fig-12")),
    Figure("de-bonet-alpha-beta.jpg", "alpha across, beta down.", alpha_beta),
    Figure("de-bonet-features.jpg", "What the parent structures have to hold.", features),
    Figure("de-bonet-coarsest.jpg", "How the coarsest level is laid out.", coarsest),
    Figure("de-bonet-normalization.jpg", "Eq. 10 with five choices of Z.", literal_sum),
    Figure("de-bonet-results.jpg", "Where the method works, and where it cannot.", works_and_fails),
)
