"""Tuning: the parameters that make the most that is new while the texture still looks the same.

A search is a generator of rounds: it yields which parameters to try and is sent what came of them, so that what it
decides depends on the numbers alone, never on the clock or on how many run side by side. Its budget is counted in
runs for the same reason: the same job gives the same preset.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from functools import partial
from itertools import takewhile
from typing import TYPE_CHECKING, Any, Literal

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import MAX_SEED, Job
from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.run import model_of
from texlab_core.engine.streams import Streams
from texlab_core.errors import InputError, ParamError
from texlab_core.measures.registry import find_measure, measure_all
from texlab_core.measures.subject import PreparedCache
from texlab_core.sheets.sweep_running import run_sweep, run_sweep_elsewhere
from texlab_core.sheets.tuning_final import FINAL, FINAL_FROM, SHORT_FINAL, Tried, best_at_the_end, promising
from texlab_core.sheets.tuning_search import DEFAULT_BUDGET, SEARCH_SEEDS, Measured, knob_rounds
from texlab_core.sheets.tuning_thresholds import MOST_SEEDS, layout_of, threshold_rounds

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Mapping, Sequence

    from texlab_core.documents.presets import Preset
    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Cell
    from texlab_core.sheets.sweep_running import Elsewhere, Places
    from texlab_core.sheets.tuning_final import Final
    from texlab_core.sheets.tuning_search import Rounds

KEPT = "discriminability"
GAINED = "visual-difference"
DEFAULT_LIMIT = -3.1
MAX_BUDGET = 5000

Limit = float | Literal["start"]


@dataclass(frozen=True, kw_only=True)
class Trial(Measured):
    """One finished run of a search.

    Parameters
    ----------
    index
        Place in the order of asking.
    phase
        Part of the search that asked for it: "start", "alpha and coarsest side", "layouts", "fresh seeds".
    seed
        Of its random numbers.
    kept, gained
        The two numbers (D and V); NaN when it failed.
    error
        Why it failed, one sentence.
    """

    index: int
    phase: str
    seed: int
    error: str = ""


@dataclass(frozen=True, kw_only=True)
class Tuning:
    """What a search found, and everything that it tried.

    Parameters
    ----------
    base
        The job that it began with.
    limit
        D was to be no larger.
    trials
        All runs, in the order of asking; the first is ``base``.
    found
        The suggested parameters; those of ``base`` where nothing better holds on seeds that the search never saw.
    kept, gained
        Means of D and V of ``found`` over those seeds, and the same of ``base``.
    fresh
        Number of those seeds.
    """

    base: Job
    limit: float
    trials: tuple[Trial, ...]
    found: Params
    kept: float
    gained: float
    base_kept: float
    base_gained: float
    budget: int
    fresh: int
    knobs: tuple[str, ...] = ()

    @property
    def changes(self) -> Mapping[str, Any]:
        """The parameters that differ from those of the base, by name."""
        before = self.base.params
        return frozen_mapping(
            {name: value for name, value in self.found.to_json().items() if value != before.to_json()[name]}
        )

    @property
    def sentence(self) -> str:
        """What was found, in one or two sentences."""
        kept, gained = find_measure(KEPT), find_measure(GAINED)
        runs = f"{len(self.trials)} runs"
        if not self.changes:
            return (
                f"In {runs} nothing made more that is new with {kept.title} at most {kept.text(self.limit)} than"
                f" what it began with ({kept.title} {kept.text(self.base_kept)},"
                f" {gained.title} {gained.text(self.base_gained)})."
            )
        held = "" if self.kept <= self.limit else f" No setting reached {kept.text(self.limit)}."
        return (
            f"{gained.title} {gained.text(self.gained)} instead of {gained.text(self.base_gained)}, {kept.title}"
            f" {kept.text(self.kept)} instead of {kept.text(self.base_kept)}: means over {self.fresh} seeds that"
            f" the search never saw, after {runs}.{held}"
        )

    def preset(self, name: str) -> Preset:
        """Return the suggestion as a preset of all parameters; raises ``PresetError`` for a name that is none."""
        from texlab_core.documents.presets import Preset
        from texlab_core.engine.inputs import ImageInput

        exemplar = self.base.inputs.get("exemplar")
        return Preset.of(
            name,
            self.base.method,
            self.found,
            note=f"Tuned. {self.sentence}",
            exemplar=exemplar if isinstance(exemplar, ImageInput) else None,
        )

    def to_json(self) -> dict[str, Any]:
        """Return the report: what was asked, tried and found."""
        before = self.base.params.to_json()

        def differing(params: Params) -> dict[str, Any]:
            return {name: value for name, value in params.to_json().items() if value != before[name]}

        return {
            "method": self.base.method,
            "limit": self.limit,
            "budget": self.budget,
            "knobs": list(self.knobs),
            "runs": len(self.trials),
            "sentence": self.sentence,
            "start": {KEPT: _number(self.base_kept), GAINED: _number(self.base_gained), "parameters": before},
            "found": {
                KEPT: _number(self.kept),
                GAINED: _number(self.gained),
                "changes": dict(self.changes),
                "parameters": self.found.to_json(),
            },
            "trials": [
                {
                    "phase": each.phase,
                    "seed": each.seed,
                    "changes": differing(each.params),
                    KEPT: _number(each.kept),
                    GAINED: _number(each.gained),
                    "error": each.error or None,
                }
                for each in self.trials
            ],
        }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


@dataclass(frozen=True, eq=False)
class _Round:
    """Jobs of one round, as the runner of sweeps takes them."""

    jobs: tuple[Job, ...]

    def values(self, index: int) -> Mapping[str, Any]:
        return frozen_mapping({"trial": index})


@dataclass
class _Search:
    """One search under way: what was tried so far, and how much of the budget is left."""

    base: Job
    budget: int
    on_trial: Callable[[Trial, Cell | None], None] | None
    on_progress: Callable[[float], None] | None
    run: Callable[..., tuple[Cell, ...]]
    trials: list[Trial] = field(default_factory=list)
    known: dict[tuple[Params, int], Trial] = field(default_factory=dict)
    found: list[Measured] = field(default_factory=list)
    seeds: tuple[int, ...] = ()

    def try_all(self, phase: str, asked: Sequence[tuple[Params, int]], reserve: int) -> None:
        """Run what was not run before, as far as the budget reaches."""
        new = [each for place, each in enumerate(asked) if each not in asked[:place] and each not in self.known]
        room = max(0, self.budget - reserve - len(self.trials))
        jobs: list[Job] = []
        for params, seed in new[:room]:
            try:
                jobs.append(dataclasses.replace(self.base, params=params, seed=seed))
            except InputError as bad:
                self._keep(
                    Trial(
                        index=len(self.trials),
                        phase=phase,
                        seed=seed,
                        params=params,
                        kept=math.nan,
                        gained=math.nan,
                        error=str(bad),
                    )
                )
        if jobs:
            self._run(phase, jobs)

    def means(self, phase: str, params: Sequence[Params], seeds: Sequence[int], reserve: int) -> list[Measured]:
        """Try parameters with several seeds; return the means of those that are known with every seed."""
        self.try_all(phase, [(each, seed) for each in params for seed in seeds], reserve)
        found = []
        for each in params:
            known = [self.known[each, seed] for seed in seeds if (each, seed) in self.known]
            if len(known) == len(seeds):
                kept = sum(trial.kept for trial in known) / len(known)
                gained = sum(trial.gained for trial in known) / len(known)
                found.append(Measured(params=each, kept=kept, gained=gained))
        self.found += found
        return found

    def tried_so_far(self, params: Params) -> Tried:
        """Return what is known of parameters with the seeds of the search, the first ones that are all known."""
        known = list(takewhile(lambda seed: (params, seed) in self.known, self.seeds))
        return self.tried(params, known or self.seeds[:SEARCH_SEEDS])

    def tried(self, params: Params, seeds: Sequence[int]) -> Tried:
        """Return what is known of parameters with several seeds; NaN where the budget did not reach."""
        known = [self.known.get((params, seed)) for seed in seeds]
        return Tried(
            params,
            tuple(math.nan if each is None else each.kept for each in known),
            tuple(math.nan if each is None else each.gained for each in known),
        )

    def _keep(self, trial: Trial) -> None:
        self.trials.append(trial)
        self.known[trial.params, trial.seed] = trial

    def _run(self, phase: str, jobs: list[Job]) -> None:
        first = len(self.trials)

        def trial_of(cell: Cell) -> Trial:
            values = cell.measures
            return Trial(
                index=first + cell.index,
                phase=phase,
                seed=cell.job.seed,
                params=cell.job.params,
                kept=values.get(KEPT, math.nan),
                gained=values.get(GAINED, math.nan),
                error=cell.error,
            )

        def tell(cell: Cell) -> None:
            if self.on_trial is not None:
                self.on_trial(trial_of(cell), cell)

        def share(fraction: float) -> None:
            if self.on_progress is not None:
                self.on_progress(min(1.0, (first + fraction * len(jobs)) / self.budget))

        cells = self.run(_Round(tuple(jobs)), tell, on_progress=share)
        for cell in cells:
            self._keep(trial_of(cell))


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
    search = _Search(base, budget, on_trial, on_progress, run)
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
    from texlab_core.methods.de_bonet.method import DeBonetParams
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
    search: _Search,
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
