"""What a column has finished so far, small enough to be kept for the whole session."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from texlab.state.scene import Past
from texlab.style.pictures import thinned

if TYPE_CHECKING:
    from collections.abc import Hashable, Mapping

    from texlab.style.pictures import Picture
    from texlab_core.engine.job import Job

SIDE = 64
MOST = 24


def past_of(job: Job, picture: Picture) -> Past:
    """Return a finished result as history keeps it."""
    inputs = tuple((name, each) for name, each in job.inputs.items() if name not in ("exemplar", "state"))
    exemplar = job.inputs["exemplar"].sha256
    return Past(job.key, exemplar, job.method, job.params, inputs, job.size, job.seed, thinned(picture, SIDE))


def remembered(history: tuple[Past, ...], past: Past) -> tuple[Past, ...]:
    """Return a history with one more result at its end; the same job is not kept twice."""
    known = next((each for each in history if each.key == past.key), None)
    newest = past if known is None else dataclasses.replace(past, measures=known.measures)
    return (*(each for each in history if each.key != past.key), newest)[-MOST:]


def measured(history: tuple[Past, ...], key: Hashable, measures: Mapping[str, float]) -> tuple[Past, ...]:
    """Return a history in which the result of a job has its numbers."""
    return tuple(dataclasses.replace(each, measures=measures) if each.key == key else each for each in history)
