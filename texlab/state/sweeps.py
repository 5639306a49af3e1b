"""What was asked of a sweep, and what there is to see of it: frozen values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from texlab.style.pictures import Picture
    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Cell, Sweep, Vary


@dataclass(frozen=True)
class SweepPlan:
    """What the user asked for.

    Parameters
    ----------
    axes
        One or two.
    side
        Height and width of the cells in pixels; None takes the size of the columns.
    params
        What all cells share but for what is varied; None takes the column's.
    name, note
        Of the ready-made sweep that it is; they are written into the sheet.
    """

    axes: tuple[Vary, ...]
    side: int | None = None
    params: Params | None = None
    name: str = "sweep"
    note: str = ""


@dataclass(frozen=True, eq=False)
class ShownCell:
    """A finished cell with what is painted, (H, W, 3) uint8; None when it failed."""

    cell: Cell
    picture: Picture | None


@dataclass(frozen=True, eq=False)
class SweepScene:
    """What there is to see of the newest sweep.

    Parameters
    ----------
    number
        Counts the sweeps that were started; 0 when there is none yet.
    asked
        What was asked for last, also when it could not be started.
    problem
        Why what was asked for last could not be started or failed; "" when it was.
    plan, sweep
        What the cells are of; None when there are none yet.
    column_id
        The column that it was started for.
    status
        idle, running, finished, stopped or failed.
    cells
        Those that have finished, in the order of finishing.
    fraction
        Share done, 0 .. 1.
    seconds
        Wall time since the start, at the newest report.
    """

    number: int = 0
    asked: SweepPlan | None = None
    problem: str = ""
    plan: SweepPlan | None = None
    sweep: Sweep | None = None
    column_id: int = 0
    status: Literal["idle", "running", "finished", "stopped", "failed"] = "idle"
    cells: tuple[ShownCell, ...] = ()
    fraction: float = 0.0
    seconds: float = 0.0

    @property
    def running(self) -> bool:
        """Whether cells are being made."""
        return self.status == "running"


NO_SWEEP = SweepScene()
