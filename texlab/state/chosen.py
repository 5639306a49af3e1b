"""What the user has chosen: the exemplar, the columns beside it, and all of it as one frozen state."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.engine.job import DEFAULT_SIZE
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import default_size

if TYPE_CHECKING:
    from texlab_core.engine.inputs import Crop, ImageInput, Input
    from texlab_core.engine.levels import Levels
    from texlab_core.engine.params import Params


@dataclass(frozen=True)
class Sample:
    """The exemplar as chosen: a source image, scaled first, then cropped.

    ``alpha`` is how its transparency was read: a key of
    :data:`texlab_core.images.unit_range.TRANSPARENCY`. ``levels`` come after the crop,
    for the methods too or, with ``look_only``, for what is shown.
    """

    source: ImageInput
    scale: float = 1.0
    crop: Crop | None = None
    path: str | None = None
    alpha: str = "white"
    levels: Levels | None = None
    look_only: bool = False

    @property
    def used_levels(self) -> Levels | None:
        """The levels that the methods see."""
        return None if self.look_only else self.levels

    @property
    def key(self) -> tuple[object, ...]:
        """What decides the pixels, and the transparency beside them."""
        return (self.source.sha256, self.scale, self.crop, self.alpha == "keep", self.levels, self.look_only)


@dataclass(frozen=True)
class Column:
    """One method beside the exemplar.

    Parameters
    ----------
    id
        Unique within a session, never used again.
    method
        Id of the registered method.
    params
        Its parameters.
    inputs
        Further named inputs (a mask, a code, a state); the exemplar is the session's.
    size
        Height and width of its result; None is the session's. Depth, height and width for a method of three
        dimensions; None is then a cube with the session's shorter side, at most 64.
    name
        What the user called it; "" leaves that to what differs from other columns.
    pinned
        It stands first and stays when other columns are put in the place of all.
    seed
        Its own, 0 .. 2147483647; None is the session's.
    """

    id: int
    method: str
    params: Params
    inputs: tuple[tuple[str, Input], ...] = ()
    size: tuple[int, ...] | None = None
    name: str = ""
    pinned: bool = False
    seed: int | None = None

    @property
    def work(self) -> tuple[object, ...]:
        """What decides the pixels, but for what all columns share."""
        return (self.method, self.params, self.inputs, self.size, self.seed)


@dataclass(frozen=True)
class State:
    """Everything that undo and redo bring back."""

    sample: Sample | None = None
    columns: tuple[Column, ...] = ()
    seed: int = 1
    size: tuple[int, int] = DEFAULT_SIZE
    next_id: int = 1
    notes: str = ""
    """What the user wrote about the project."""

    def column(self, column_id: int) -> Column | None:
        """Return the column with this id."""
        return next((column for column in self.columns if column.id == column_id), None)

    def size_of(self, column: Column) -> tuple[int, ...]:
        """Return the size of a column's result."""
        return column.size or default_size(self.size, find_method(column.method).dimensions)

    def seed_of(self, column: Column) -> int:
        """Return the seed of a column's result."""
        return self.seed if column.seed is None else column.seed

    def with_column(self, changed: Column) -> State:
        """Return a state in which the column with the same id is replaced."""
        columns = tuple(changed if column.id == changed.id else column for column in self.columns)
        return dataclasses.replace(self, columns=columns)
