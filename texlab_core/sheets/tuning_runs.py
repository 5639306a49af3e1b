"""The runs of a search for parameters: each is made once, as far as the budget reaches."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from itertools import takewhile
from typing import TYPE_CHECKING, Any

from texlab_core.engine.params import frozen_mapping
from texlab_core.errors import InputError
from texlab_core.sheets.tuning_final import Tried
from texlab_core.sheets.tuning_report import GAINED, KEPT, Trial
from texlab_core.sheets.tuning_search import SEARCH_SEEDS, Measured

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from texlab_core.engine.job import Job
    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Cell


@dataclass(frozen=True, eq=False)
class _Round:
    """Jobs of one round, as the runner of sweeps takes them."""

    jobs: tuple[Job, ...]

    def values(self, index: int) -> Mapping[str, Any]:
        return frozen_mapping({"trial": index})


@dataclass
class Runs:
    """What a search has tried so far, and how much of its budget is left."""

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
