"""Why some results cannot be explained pixel by pixel."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab.state.scene import ColumnScene

# Methods that choose pixel by pixel, or keep what every band adds.
EXPLAINED = ("de-bonet", "efros-leung", "heeger-bergen")


def without_words(column: ColumnScene) -> str:
    """Return why a finished column cannot say where one of its pixels comes from."""
    if column.method not in EXPLAINED:
        return f"{column.title} cannot tell why a single pixel is there: it does not choose pixels one by one."
    holes = {name for name, _ in column.inputs} & {"mask", "blend", "start"}
    if holes and bool(getattr(column.params, "reach", False)):
        return (
            f"{column.title} filled this picture part by part, and what its pixels were chosen from was not kept. "
            "Smaller pictures are filled in one piece, and can be explained."
        )
    return f"What the pixels of {column.title} were chosen from was not kept; run the column again (F5) to see it."
