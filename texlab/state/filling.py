"""A picture that is filled at its own resolution, and what there is to see of it: frozen values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.style.pictures import Picture
    from texlab_core.engine.job import Job
    from texlab_core.methods.efros_leung.filling import Filled
    from texlab_core.methods.efros_leung.parts import Box


@dataclass(frozen=True, eq=False)
class FillPlan:
    """What the user asked for.

    Parameters
    ----------
    token
        Tells this fill from all others, for whoever asked.
    make_job
        Makes the job, in a background thread.
    box
        What of the picture is shown while it runs, and taken from the result; None takes the whole result.
    """

    token: Any
    make_job: Callable[[], Job]
    box: Box | None


@dataclass(frozen=True, eq=False)
class FillScene:
    """What there is to see of the newest fill.

    Parameters
    ----------
    plan
        What was asked for; None when there was nothing yet.
    status
        idle, running, finished, stopped or failed.
    fraction
        Progress, 0 .. 1.
    message
        What is being done, or why it failed.
    preview
        What the plan's box looks like so far, (h, w, 3) uint8.
    found
        What came out, when it has finished.
    """

    plan: FillPlan | None = None
    status: Literal["idle", "running", "finished", "stopped", "failed"] = "idle"
    fraction: float = 0.0
    message: str = ""
    preview: Picture | None = None
    found: Filled | None = None


NO_FILL = FillScene()
