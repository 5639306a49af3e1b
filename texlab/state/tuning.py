"""What was asked of a search for parameters, and what there is to see of it: frozen values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from texlab.state.sweeps import CellsScene
from texlab_core.sheets.tuning_search import DEFAULT_BUDGET

if TYPE_CHECKING:
    from texlab_core.sheets.tuning_report import Tuning


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
    budget: int = DEFAULT_BUDGET


@dataclass(frozen=True, eq=False)
class TuningScene(CellsScene):
    """What there is to see of the newest search; its cells are the trials, with small pictures.

    Parameters
    ----------
    plan
        What the trials are of; None when there are none yet.
    found
        What came out, when it has finished.
    """

    plan: TuningPlan | None = None
    found: Tuning | None = None


NO_TUNING = TuningScene()
