"""Tuning: the parameters that make the most that is new while the texture still looks the same.

A search is a generator of rounds: it yields which parameters to try and is sent what came of them, so that what it
decides depends on the numbers alone, never on the clock or on how many run side by side. Its budget is counted in
runs for the same reason: the same job gives the same preset.
"""

from __future__ import annotations

import dataclasses
import math
from functools import partial
from typing import TYPE_CHECKING, Literal

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import MAX_SEED, Job
from texlab_core.engine.run import model_of
from texlab_core.engine.streams import Streams
from texlab_core.errors import InputError, ParamError
from texlab_core.measures.registry import find_measure, measure_all
from texlab_core.measures.subject import PreparedCache
from texlab_core.sheets.sweep_running import run_sweep, run_sweep_elsewhere
from texlab_core.sheets.tuning_final import FINAL, FINAL_FROM, SHORT_FINAL, Tried, best_at_the_end, promising
from texlab_core.sheets.tuning_report import GAINED, KEPT, Trial, Tuning
from texlab_core.sheets.tuning_runs import Runs
from texlab_core.sheets.tuning_search import DEFAULT_BUDGET, SEARCH_SEEDS, Measured, knob_rounds
from texlab_core.sheets.tuning_thresholds import MOST_SEEDS, layout_of, threshold_rounds

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Sequence

    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Cell
    from texlab_core.sheets.sweep_running import Elsewhere, Places
    from texlab_core.sheets.tuning_final import Final
    from texlab_core.sheets.tuning_search import Rounds

DEFAULT_LIMIT = -3.1
MAX_BUDGET = 5000

Limit = float | Literal["start"]


def tune(
    base: Job,
    knobs: Sequence[str] = (),
    *,
    limit: Limit = DEFAULT_LIMIT,
    budget: int = DEFAULT_BUDGET,
    on_trial: Callable[[Trial, Cell | None], None] | None = None,
    on_progress: Callable[[float], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    cache: AnalysisCache | None = None,
    prepared: PreparedCache | None = None,
    workers: int | None = None,
    places: Places | None = None,
    elsewhere: Elsewhere | None = None,
) -> Tuning:
    """Look for the parameters with the largest V whose D is no larger than a limit.

    Parameters
    ----------
    base
        Where to begin; its other parameters, size and seed stay.
    knobs
        Numeric parameters to vary. None for De Bonet: alpha and the coarsest side, then the rows of the threshold
        table, then its single cells.
    limit
        Largest D that is allowed; "start" for that of ``base``.
    budget
        Number of runs, 24 .. 5000; at 128 -> 256 two cores make about thirty a second. No more are made, and fewer
        when nothing is left to try.
    on_trial
        Called in this thread with every finished run (and its cell with the picture), in the order of finishing.
    on_progress
        Called in this thread with the share of the budget that is used, 0 .. 1.
    should_stop
        Asked in this thread about a hundred times a second.
    cache, prepared
        Where analyses, and the exemplar's part of the measures, are kept and found.
    workers, places
        As in :func:`texlab_core.sheets.sweep_running.run_sweep`. The result does not depend on them.
    elsewhere
        Runs the trials in other processes or on a cluster, round by round; None runs them in threads of this one.

    Returns
    -------
    Tuning
        Never worse than ``base`` on the fresh seeds: with D at most the limit, no smaller V.

    Raises
    ------
    InputError
        When a knob is unknown or no number, the limit or budget is out of range, or the base cannot be measured.
    Cancelled
        When ``should_stop`` said so; every thread has ended then.
    """
    if type(budget) is not int or not 24 <= budget <= MAX_BUDGET:
        raise ParamError("budget", f"a whole number from 24 to {MAX_BUDGET}", budget)
    if limit != "start" and (not isinstance(limit, int | float) or not math.isfinite(limit)):
        raise ParamError("limit", "a number, or start for that of the parameters it begins with", limit)
    cache = AnalysisCache() if cache is None else cache
    run: Callable[..., tuple[Cell, ...]]
    if elsewhere is None:
        run = partial(
            run_sweep,
            should_stop=should_stop,
            cache=cache,
            prepared=PreparedCache() if prepared is None else prepared,
            measure=partial(measure_all, ids=(KEPT, GAINED)),
            workers=workers,
            places=places,
        )
    else:
        run = partial(run_sweep_elsewhere, should_stop=should_stop, elsewhere=elsewhere, ids=(KEPT, GAINED))
    search = Runs(base, budget, on_trial, on_progress, run)
    final = FINAL if budget >= FINAL_FROM else SHORT_FINAL
    # Checked before anything runs.
    rounds = _rounds(base, knobs, cache, should_stop)
    seeds = _seeds(base)
    search.seeds = tuple(seeds[:MOST_SEEDS])
    start = search.means("start", [base.params], search.seeds[:SEARCH_SEEDS], 0)[0]
    if not start.usable:
        title = find_measure(KEPT).title
        why = (
            search.trials[0].error or f"{title} and {find_measure(GAINED).title} cannot be said about its result."
        )
        raise InputError(f"What tuning begins with cannot be used: {why}")
    allowed = start.kept if limit == "start" else float(limit)
    asked = rounds(start, allowed)
    try:
        wanted = next(asked)
        while len(search.trials) < budget - final.runs:
            seeds_wanted = search.seeds[: wanted.seeds]
            wanted = asked.send(search.means(wanted.phase, wanted.params, seeds_wanted, final.runs))
    except StopIteration:
        pass
    finally:
        asked.close()
    return _decide(search, base.params, limit, seeds[MOST_SEEDS:], final, tuple(knobs))


def _seeds(base: Job) -> list[int]:
    """Return the seeds of the search, the job's own first, then the fresh ones; all differ."""
    count = MOST_SEEDS - 1 + FINAL.seeds
    drawn = Streams(base.seed)("tuning seeds").choice(MAX_SEED - 1, count, replace=False)
    # Those from the job's own on are moved up by one.
    return [base.seed, *(int(each) + (each >= base.seed) for each in drawn)]


def _rounds(
    base: Job, knobs: Sequence[str], cache: AnalysisCache, should_stop: Callable[[], bool] | None
) -> Callable[[Measured, float], Rounds]:
    from texlab_core.engine.params import describe
    from texlab_core.engine.registry import find_method
    from texlab_core.methods.de_bonet.params import DeBonetParams
    from texlab_core.sheets.sweep import check_knob

    method = find_method(base.method)
    streams = Streams(base.seed)
    if knobs:
        fields = []
        for name in knobs:
            knob = check_knob(name, method.params)
            if knob.name == "seed" or knob.kind not in ("int", "float"):
                numeric = [each.name for each in describe(method.params) if each.kind in ("int", "float")]
                raise ParamError("knobs", f"numbers among {', '.join(numeric) or 'none'}", name)
            if knob in fields:
                raise InputError(f"A knob is tuned once, got {name} twice.")
            fields.append(knob)
        return lambda start, limit: knob_rounds(start, fields, limit, streams)
    if issubclass(method.params, DeBonetParams):

        def shape_of(params: Params) -> tuple[int, tuple[str, ...]]:
            # Kept since the trial ran, unless it was dropped, or ran elsewhere.
            model = model_of(dataclasses.replace(base, params=params), None, should_stop, cache=cache)
            return model.depth, tuple(model.feature_names)

        return lambda start, limit: threshold_rounds(start, shape_of, limit, streams)
    raise InputError(f"{method.title} has no thresholds: say which of its numbers are to be tuned (knobs).")


def kind_of(params: Params) -> Hashable:
    """Return what is left of a setting without its thresholds: what differs in them only is nearly the same."""
    own = {"alpha", "beta", "thresholds"}
    return tuple(value for name, value in vars(params).items() if name not in own)


def _cut(found: Tried, count: int) -> Tried:
    """Return what came of the first seeds."""
    return Tried(found.params, found.kept[:count], found.gained[:count])


def _decide(
    search: Runs,
    start: Params,
    limit: Limit,
    seeds: list[int],
    final: Final,
    knobs: tuple[str, ...],
) -> Tuning:
    """Measure the most promising ones and the start again, on seeds that the search never saw, and choose."""
    bound = None if limit == "start" else float(limit)
    own_layout = layout_of(start)

    def group(params: Params) -> Hashable:
        return layout_of(params) == own_layout

    choose = partial(promising, limit=bound, kind=kind_of, group=group)
    base = search.tried_so_far(start)
    own = [search.tried_so_far(each) for each in dict.fromkeys(each.params for each in search.found)]
    chosen = choose([_cut(each, len(base.kept)) for each in own], base, count=final.stages[0][0])
    for (_, count), (most, _) in zip(final.stages, (*final.stages[1:], final.stages[-1]), strict=True):
        search.means("fresh seeds", [start, *(each.params for each in chosen)], seeds[:count], 0)
        base = search.tried(start, seeds[:count])
        chosen = choose([search.tried(each.params, seeds[:count]) for each in chosen], base, count=most)
    best = best_at_the_end(chosen, base, bound, group)
    if search.on_progress is not None:
        search.on_progress(1.0)
    return Tuning(
        base=search.base,
        limit=base.means.kept if bound is None else bound,
        trials=tuple(search.trials),
        found=best.params,
        kept=best.means.kept,
        gained=best.means.gained,
        base_kept=base.means.kept,
        base_gained=base.means.gained,
        budget=search.budget,
        fresh=final.seeds,
        knobs=knobs,
    )
