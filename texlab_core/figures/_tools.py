"""What the figures share: exemplars from the gallery, results, and sheets as wide as a help page."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.sheets.contact_sheet import Tile, contact_sheet

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage
    from texlab_core.sheets.sweep import Cell

PAGE_WIDTH = 712
_GAP = 8


@functools.lru_cache(maxsize=64)
def texture(name: str, side: int = 128, top: int = 0, left: int = 0) -> ImageInput:
    """Return a square part of a gallery texture."""
    return as_exemplar(f"gallery:{name}", crop=Crop(top=top, left=left, height=side, width=side))


def title_of(name: str) -> str:
    """Return what a caption calls a gallery texture: its name without the class."""
    return name.partition("-")[2]


def make(
    method: str,
    exemplar: ImageInput,
    size: int | tuple[int, ...] = 128,
    seed: int = 1,
    inputs: Mapping[str, ImageInput] | None = None,
    **values: Any,
) -> Result:
    """Run a method with some of its parameters."""
    chosen = find_method(method)
    shape = (size,) * chosen.dimensions if isinstance(size, int) else size
    params = chosen.params.from_json(values)
    given = {"exemplar": exemplar, **(inputs or {})}
    return run(Job(method=method, inputs=given, params=params, size=shape, seed=seed))


def frames(method: str, exemplar: ImageInput, size: int, seed: int = 1, **values: Any) -> dict[str, FloatImage]:
    """Run a method and return the stages it keeps for the scrubber, by name."""
    kept: dict[str, FloatImage] = {}

    def keep(step: Any) -> None:
        if step.frame is not None and step.preview is not None:
            kept[step.frame] = step.preview().copy()

    params = find_method(method).params.from_json(values)
    run(Job(method=method, inputs={"exemplar": exemplar}, params=params, size=(size, size), seed=seed), keep)
    return kept


def evidence(result: Result) -> str:
    """Return the share of copied neighbours as a caption."""
    from texlab_core.measures.registry import find_measure, written
    from texlab_core.measures.subject import Subject

    copied = find_measure("copied-share").of(Subject.of_result(result))
    return "" if copied is None else written({"copied-share": copied}, ["copied-share"])[0]


def picture(cell: Cell) -> FloatImage | None:
    """Return the picture of a sweep's cell, if there is one."""
    return None if cell.result is None else cell.result.image


def page(
    tiles: Sequence[Tile],
    columns: int,
    *,
    column_heads: Sequence[str] = (),
    row_heads: Sequence[str] = (),
    title: Sequence[str] = (),
) -> NDArray[np.uint8]:
    """Draw a sheet about as wide as a help page."""
    margin = max((8 * len(text) for text in row_heads), default=0)
    largest = (PAGE_WIDTH - margin - _GAP) // columns - _GAP
    return contact_sheet(
        tiles, columns, title=title, column_heads=column_heads, row_heads=row_heads, largest=largest
    )
