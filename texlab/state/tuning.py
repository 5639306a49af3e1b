"""What was asked of a search for parameters, and what there is to see of it: frozen values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from texlab.state.sweeps import ShownCell
    from texlab_core.sheets.tuning import Tuning


@dataclass(frozen=True)
class TuningPlan:
    """What the user asked for.

    Parameters
    ----------
    limit
        Largest D that is allowed; "start" for that of the column's parameters.
    knobs
        Numbers to vary; none for De Bonet's thresholds.
    budget
        Most runs.
    """

    limit: float | Literal["start"]
    knobs: tuple[str, ...] = ()
    budget: int = 480


@dataclass(frozen=True, eq=False)
class TuningScene:
    """What there is to see of the newest search.

    Parameters
    ----------
    number
        Counts the searches that were started; 0 when there is none yet.
    problem
        Why what was asked for last could not be started, or failed.
    plan
        What the trials are of; None when there are none yet.
    column_id
        The column that it was started for.
    status
        idle, running, finished, stopped or failed.
    trials
        Those that have finished, in the order of finishing, with small pictures.
    fraction
        Share of the budget that is used, 0 .. 1.
    found
        What came out, when it has finished.
    """

    number: int = 0
    problem: str = ""
    plan: TuningPlan | None = None
    column_id: int = 0
    status: Literal["idle", "running", "finished", "stopped", "failed"] = "idle"
    trials: tuple[ShownCell, ...] = ()
    fraction: float = 0.0
    found: Tuning | None = None

    @property
    def running(self) -> bool:
        """Whether it searches."""
        return self.status == "running"


NO_TUNING = TuningScene()
