"""A result: an output together with the job that made it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab_core.engine.steps import Output

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab_core.engine.job import Job


@dataclass(frozen=True, eq=False, kw_only=True)
class Result(Output):
    """An output together with the job that made it.

    Parameters
    ----------
    job
        Everything that is needed to make the same bits again.
    model
        The analysis that was synthesized from.
    elapsed_s
        Wall time in seconds, analysis (unless cached) and synthesis.
    versions
        Versions of the program and of the libraries that influence the bits.
    """

    job: Job
    model: Any
    elapsed_s: float
    versions: Mapping[str, str]
