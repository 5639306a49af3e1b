"""Figures of the help pages of MSG and of the methods it is compared with: the paper's Fig. 8 and Table 2."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab_core.engine.registry import find_method
from texlab_core.figures import Figure
from texlab_core.figures._charts import heat_table, stack
from texlab_core.figures._tools import make, page, texture, title_of
from texlab_core.measures.registry import written
from texlab_core.sheets.comparison import FIG_8, compare, plan
from texlab_core.sheets.contact_sheet import Tile

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SIDE = 256
COMPARED = ("stochastic-gravel", "quasiperiodic-towel", "manmade-ribs", "oriented-zebra", "letters-handwriting")


def comparison() -> NDArray[np.uint8]:
    """Redraw Fig. 8: originals, and four models with one phase."""
    tiles = []
    for name in COMPARED:
        side = 172 if name == "letters-handwriting" else SIDE
        exemplar = texture(name, side)
        tiles.append(Tile(exemplar.pixels, (title_of(name),)))
        for each in compare(plan(exemplar, FIG_8, seed=1, same_phase=True)):
            image = None if each.result is None else each.result.image
            tiles.append(Tile(image, tuple(written(each.measures, ["spectral-distance"]))))
    heads = ["original", *(_head(name) for name in FIG_8)]
    return page(tiles, len(heads), column_heads=heads)


def _head(method: str) -> str:
    count = make(method, texture("stochastic-gravel", 64), 64).measures["parameters"]
    title = find_method(method).title
    return f"{title}, {count:.0f} numbers" if method != "uncoded" else title


def table_2() -> NDArray[np.uint8]:
    """Redraw Table 2: rms of the sixteen channels in percent of the mean, for two textures."""
    names = ("quasiperiodic-towel", "stochastic-gravel")
    tables = []
    for name in names:
        details: Any = make("msg", texture(name, SIDE), SIDE).details
        tables.append(
            heat_table(
                details.code.rms_table(),
                ("1/32", "1/16", "1/8", "1/4"),
                ("0°", "45°", "90°", "135°"),
                corner="cycles/px",
                highest=14,
            )
        )
    return stack(tables, 2, [title_of(name) for name in names])


def equations() -> NDArray[np.uint8]:
    """Show the corrected and the printed equations, and what the measure of bandwidth does."""
    choices: dict[str, dict[str, Any]] = {
        "default": {},
        "bandwidths paper": {"bandwidths": "paper"},
        "phase sixteen": {"phase": "sixteen"},
        "equations printed": {"equations": "printed", "bandwidths": "paper"},
    }
    tiles = []
    for name in ("stochastic-gravel", "quasiperiodic-towel"):
        exemplar = texture(name, SIDE)
        tiles.append(Tile(exemplar.pixels, ("exemplar", title_of(name))))
        for caption, values in choices.items():
            tiles.append(Tile(make("msg", exemplar, SIDE, **values).image, (caption,)))
    return page(tiles, 1 + len(choices))


def any_size() -> NDArray[np.uint8]:
    """Show a wide texture made from the 69 numbers of a small one."""
    exemplar = texture("quasiperiodic-towel", 160)
    made = make("msg", exemplar, (200, 696))
    return page([Tile(exemplar.pixels, ("exemplar",)), Tile(made.image, ("made from its 69 numbers",))], 1)


FIGURES = (
    Figure("msg-fig-8.jpg", "The paper's Fig. 8: four models with one phase.", comparison),
    Figure("msg-table-2.png", "The paper's Table 2: rms of the channels.", table_2),
    Figure("msg-equations.jpg", "Corrected and printed equations.", equations),
    Figure("msg-any-size.jpg", "Any size from 69 numbers.", any_size),
)
