"""Drawings for the figures: curves over a logarithmic axis, tables as heat maps, drawings side by side.

Matplotlib draws them; it is needed only where the figures of the help are made (extra ``figures``).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure
    from numpy.typing import NDArray

# Okabe and Ito's colours, told apart by the colour-blind too.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
_INK, _PALE, _GRID = "#181818", "#686868", "#dedede"
_DPI = 100


@dataclass(frozen=True)
class Line:
    """A curve of a chart."""

    label: str
    x: Sequence[float]
    y: Sequence[float]


def log_chart(
    lines: Sequence[Line], *, x_label: str, y_label: str, y_range: tuple[float, float], size: tuple[int, int]
) -> NDArray[np.uint8]:
    """Draw curves over a linear x axis and a logarithmic y axis.

    Parameters
    ----------
    lines
        The curves, named in a legend in their order.
    x_label, y_label
        Under the x axis, and above the chart.
    y_range
        Lowest and highest y, both positive.
    size
        Height and width in pixels.

    Returns
    -------
    uint8 array
        (H, W, 3).
    """
    from matplotlib.ticker import MaxNLocator

    figure = _figure(size)
    axes = figure.add_subplot(yscale="log", ylim=y_range, xlabel=x_label)
    # Above the axis: along it, a long label would be cut.
    axes.set_title(y_label, loc="left", fontsize="medium")
    for line, colour in zip(lines, COLOURS, strict=False):
        axes.plot(line.x, line.y, color=colour, marker="o", markersize=4, linewidth=1.8, label=line.label)
    axes.yaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(axis="y", color=_GRID)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(colors=_PALE)
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return _pixels(figure)


def heat_table(
    values: NDArray[Any],
    rows: Sequence[str],
    columns: Sequence[str],
    *,
    corner: str,
    highest: float,
    digits: int = 1,
) -> NDArray[np.uint8]:
    """Draw a table whose cells are the darker, the larger their numbers are.

    Parameters
    ----------
    values
        (rows, columns) numbers from 0.
    rows, columns
        Heads.
    corner
        What the heads are.
    highest
        The number that is shown darkest.
    digits
        After the decimal point.

    Returns
    -------
    uint8 array
        (H, W, 3).
    """
    figure = _figure((34 * len(rows) + 60, 66 * len(columns) + 80))
    axes = figure.add_subplot(title=corner)
    axes.imshow(values, cmap="Blues", vmin=0, vmax=highest, aspect="auto")
    axes.set_xticks(range(len(columns)), columns)
    axes.set_yticks(range(len(rows)), rows)
    axes.tick_params(length=0, top=True, labeltop=True, bottom=False, labelbottom=False)
    axes.spines[:].set_visible(False)
    for row, column in np.ndindex(len(rows), len(columns)):
        ink = "white" if values[row, column] > highest / 2 else _INK
        axes.text(column, row, f"{values[row, column]:.{digits}f}", ha="center", va="center", color=ink)
    return _pixels(figure)


def stack(pictures: Sequence[NDArray[np.uint8]], columns: int, captions: Sequence[str]) -> NDArray[np.uint8]:
    """Put drawings of one size side by side, each with its caption above."""
    from matplotlib.transforms import IdentityTransform

    height, width = pictures[0].shape[:2]
    rows = math.ceil(len(pictures) / columns)
    figure = _figure((rows * (height + 26), columns * width))
    figure.set_layout_engine("none")
    for index, (picture, caption) in enumerate(zip(pictures, captions, strict=True)):
        left, top = index % columns * width, index // columns * (height + 26)
        figure.figimage(picture, left, rows * (height + 26) - top - 26 - height)
        figure.text(left + 8, rows * (height + 26) - top - 16, caption, va="center", transform=IdentityTransform())
    return _pixels(figure)


def _figure(size: tuple[int, int]) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(size[1] / _DPI, size[0] / _DPI), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _pixels(figure: Figure) -> NDArray[np.uint8]:
    figure.canvas.draw()
    return np.ascontiguousarray(np.asarray(figure.canvas.buffer_rgba())[..., :3])  # type: ignore[attr-defined]
