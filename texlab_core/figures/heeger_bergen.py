"""Figures of the help page of Heeger-Bergen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.figures import Figure
from texlab_core.figures._charts import Line, log_chart
from texlab_core.figures._tools import PAGE_WIDTH, frames, make, page, texture, title_of
from texlab_core.sheets.contact_sheet import Tile

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

WORKS = ("stochastic-granite", "stochastic-stucco", "stochastic-lava", "quasiperiodic-canvas")
FAILS = ("oriented-woodgrain", "structured-dotlines", "quasiperiodic-brick", "letters-scattered")


def rounds() -> NDArray[np.uint8]:
    """Show noise turning into texture, round by round."""
    rows = []
    for name in ("stochastic-granite", "oriented-fur"):
        exemplar = texture(name, 160)
        kept = frames("heeger-bergen", exemplar, 160, iterations=5)
        chosen = ("noise", "iteration 1", "iteration 2", "iteration 5")
        rows += [Tile(exemplar.pixels, (title_of(name),))]
        rows += [Tile(kept[frame], (frame.replace("iteration", "round"),)) for frame in chosen]
    return page(rows, 5)


def works_and_fails() -> NDArray[np.uint8]:
    """Show exemplars over results, where the model holds and where it does not."""
    tiles = []
    for names in (WORKS, FAILS):
        made = [make("heeger-bergen", texture(name, 160), 160) for name in names]
        tiles += [Tile(texture(name, 160).pixels, (title_of(name),)) for name in names]
        tiles += [Tile(result.image, ("result",)) for result in made]
    return page(tiles, 4)


def orientations() -> NDArray[np.uint8]:
    """Show what oriented bands add: one texture with 1, 2, 4, 6 of them."""
    exemplar = texture("stochastic-stucco", 160)
    tiles = [Tile(exemplar.pixels, ("exemplar",))]
    for count in (1, 2, 4, 6):
        result = make("heeger-bergen", exemplar, 160, orientations=count)
        tiles.append(Tile(result.image, (f"orientations {count}",)))
    return page(tiles, 5)


def palette() -> NDArray[np.uint8]:
    """Show the colours that matching axis by axis invents, and the repair."""
    tiles = []
    for name in ("structured-leaves", "stochastic-lava"):
        exemplar = texture(name, 160)
        tiles.append(Tile(exemplar.pixels, (title_of(name),)))
        tiles.append(Tile(make("heeger-bergen", exemplar, 160).image, ("palette off",)))
        tiles.append(Tile(make("heeger-bergen", exemplar, 160, palette="transport").image, ("palette transport",)))
    return page(tiles, 3)


def convergence() -> NDArray[np.uint8]:
    """Show the mean distance of the bands, round by round."""
    lines = []
    for name in ("stochastic-gravel", "oriented-fur", "quasiperiodic-brick", "letters-darwin"):
        curve = make("heeger-bergen", texture(name, 128), 128, iterations=20).curves["mean-distance"]
        lines.append(Line(title_of(name), curve.x.tolist(), curve.y.tolist()))
    return log_chart(
        lines,
        x_label="rounds",
        y_label="mean distance of the bands before matching (W1 / standard deviation)",
        y_range=(0.01, 2.0),
        size=(340, PAGE_WIDTH),
    )


FIGURES = (
    Figure("heeger-bergen-rounds.jpg", "Noise turns into texture.", rounds),
    Figure("heeger-bergen-results.jpg", "Where the model holds, and where it does not.", works_and_fails),
    Figure("heeger-bergen-orientations.jpg", "One texture with 1, 2, 4 and 6 orientations.", orientations),
    Figure("heeger-bergen-palette.jpg", "Invented colours, and the palette repaired.", palette),
    Figure("heeger-bergen-convergence.png", "Distance of the bands by round.", convergence),
)
