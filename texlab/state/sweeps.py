"""What was asked of a sweep, and what there is to see of it: frozen values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from texlab.style.pictures import Picture
    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Cell, Sweep, Vary


@dataclass(frozen=True)
class Textures:
    """Many textures that one preset is held against.

    Parameters
    ----------
    texts
        Files, folders, ``gallery:NAME``, or a class of the gallery as in ``gallery:structured``; none is read yet.
    """

    texts: tuple[str, ...]


@dataclass(frozen=True)
class SweepPlan:
    """What the user asked for.

    Parameters
    ----------
    axes
        One or two; beside textures, none or one.
    side
        Height and width of the cells in pixels; None takes the size of the columns.
    params
        What all cells share but for what is varied; None takes the column's.
    name, note
        Of the ready-made sweep that it is; they are written into the sheet.
    textures
        What runs across instead of a knob; None stays with the exemplar of the columns.
    """

    axes: tuple[Vary, ...]
    side: int | None = None
    params: Params | None = None
    name: str = "sweep"
    note: str = ""
    textures: Textures | None = None


@dataclass(frozen=True, eq=False)
class ShownCell:
    """A finished cell with what is painted, (H, W, 3) uint8; None when it failed."""

    cell: Cell
    picture: Picture | None


@dataclass(frozen=True, eq=False)
class CellsScene:
    """What there is to see of many cells that are made one after the other, those of a sweep or of a search.

    Parameters
    ----------
    number
        Counts what was started; 0 when there is nothing yet.
    problem
        Why what was asked for last could not be started or failed; "" when it was.
    column_id
        The column that it was started for.
    status
        idle, running, finished, stopped or failed.
    cells
        Those that have finished, in the order of finishing.
    fraction
        Share done, 0 .. 1.
    """

    number: int = 0
    problem: str = ""
    column_id: int = 0
    status: Literal["idle", "running", "finished", "stopped", "failed"] = "idle"
    cells: tuple[ShownCell, ...] = ()
    fraction: float = 0.0

    @property
    def running(self) -> bool:
        """Whether cells are being made."""
        return self.status == "running"


@dataclass(frozen=True, eq=False)
class SweepScene(CellsScene):
    """What there is to see of the newest sweep.

    Parameters
    ----------
    asked
        What was asked for last, also when it could not be started.
    plan, sweep
        What the cells are of; None when there are none yet. Over many textures the sweep comes when they are read.
    seconds
        Wall time since the start, at the newest report.
    left_out
        What is said of textures that have no place in the grid.
    """

    asked: SweepPlan | None = None
    plan: SweepPlan | None = None
    sweep: Sweep | None = None
    seconds: float = 0.0
    left_out: str = ""


NO_SWEEP = SweepScene()
