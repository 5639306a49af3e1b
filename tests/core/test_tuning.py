"""Tuning: a toy method whose measures are closed forms, so that the best parameters are known."""

from __future__ import annotations

import math
import threading
from collections import Counter
from dataclasses import dataclass, replace
from functools import partial
from statistics import NormalDist
from typing import TYPE_CHECKING, Annotated

import numpy as np
import pytest

from tests.stub_method import know
from texlab_core.batch.places import InProcess
from texlab_core.batch.running import run_jobs
from texlab_core.documents.preset_store import PresetStore, find_preset
from texlab_core.documents.presets import write_preset
from texlab_core.engine import registry
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.params import Knob, Params, describe
from texlab_core.engine.registry import Method
from texlab_core.engine.run import run
from texlab_core.engine.steps import Output, Step
from texlab_core.engine.streams import Streams
from texlab_core.errors import Cancelled, InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.de_bonet.params import DeBonetParams
from texlab_core.sheets.tuning import _rounds, kind_of, tune
from texlab_core.sheets.tuning_final import FINAL, SHORT_FINAL, Final, Tried, best_at_the_end, compared, promising
from texlab_core.sheets.tuning_moves import MOST_OFTEN, Effect, Move, moves, together
from texlab_core.sheets.tuning_search import (
    SEARCH_SEEDS,
    Measured,
    best_of,
    grid_values,
    knob_rounds,
    place_of,
    value_at,
)
from texlab_core.sheets.tuning_thresholds import layout_of, threshold_rounds

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.inputs import Inputs


@dataclass(frozen=True, kw_only=True)
class HillParams(Params):
    x: Annotated[float, Knob(help="First.", low=0, high=1)] = 0.5
    y: Annotated[float, Knob(help="Second.", low=0, high=1)] = 0.1
    n: Annotated[int, Knob(help="Odd.", low=1, high=9, odd=True)] = 1
    s: Annotated[float, Knob(help="Even ratios.", low=0.01, high=100, log=True)] = 1.0
    free: Annotated[float, Knob(help="Without ends.")] = 2.0
    on: Annotated[bool, Knob(help="No number.")] = False


def kept_of(params: HillParams) -> float:
    """D: up with y, down towards x = .3."""
    return -5 + 4 * params.y + 4 * (params.x - 0.3) ** 2


def gained_of(params: HillParams) -> float:
    """V: y, and a little for a larger n."""
    return params.y / 2 + params.n / 100


def _analyze(inputs: Inputs, params: HillParams) -> Generator[Step, None, int]:
    yield Step(1, 1, "look")
    return 0


def _synthesize(model, inputs, params, size, streams):
    if params.x > 0.99:
        raise InputError("Too far.")
    yield Step(1, 1, "done")
    noise = 0.01 * float(streams("noise").random())
    return Output(
        image=np.full((*size, 1), 0.5, np.float32),
        measures={}
        if params.on
        else {"discriminability": kept_of(params) + noise, "visual-difference": gained_of(params)},
    )


@pytest.fixture
def job(monkeypatch: pytest.MonkeyPatch) -> Job:
    hill = Method(
        id="hill", title="Hill", summary="A closed form.", reference="None.", params=HillParams,
        analyze=_analyze, synthesize=_synthesize,
    )  # fmt: skip
    known = dict(registry.methods()) | {"hill": hill}
    know(monkeypatch, known)
    exemplar = as_exemplar(np.full((16, 16, 1), 0.5, np.float32))
    return Job(method="hill", inputs={"exemplar": exemplar}, size=(16, 16))


def test_it_finds_the_largest_v_within_the_limit(job: Job) -> None:
    found = tune(job, ("x", "y"), limit=-3.1, budget=300)
    # At x = .3 the limit allows y = .475 less the noise, and V = y / 2 + .01.
    assert found.kept <= -3.1
    assert found.gained == pytest.approx(0.2475, abs=0.012)
    assert found.found.x == pytest.approx(0.3, abs=0.12)
    assert found.gained > found.base_gained
    assert len(found.trials) <= 300
    assert {each.phase for each in found.trials} == {"start", "grid", "steps", "fresh seeds"}


def test_the_same_job_gives_the_same_tuning_on_any_number_of_threads(job: Job) -> None:
    one, two = (tune(job, ("x", "y", "n"), budget=90, workers=count) for count in (1, 3))
    assert one.to_json() == two.to_json()
    assert [each.index for each in one.trials] == list(range(len(one.trials)))


def test_trials_that_run_elsewhere_give_the_same_tuning(job: Job) -> None:
    here = tune(job, ("x", "y", "n"), budget=60)
    there = tune(job, ("x", "y", "n"), budget=60, elsewhere=partial(run_jobs, place=InProcess()))
    assert there.to_json() == here.to_json()


def test_the_rows_to_vary_are_known_where_no_trial_ran() -> None:
    exemplar = as_exemplar(as_exemplar("gallery:stochastic-gravel"), crop=Crop(40, 40, 32, 32))
    base = Job(method="de-bonet", inputs={"exemplar": exemplar}, size=(32, 32))
    model = run(base).model
    asked = _rounds(base, (), AnalysisCache(), None)(Measured(params=base.params, kept=-4.0, gained=0.3), -3.1)
    wanted = next(asked)
    while wanted.phase != "rows":
        wanted = asked.send([])
    changed = {len(each.to_json()["thresholds"]) for each in wanted.params}
    assert changed == {len(model.feature_names)}
    # All rows, twice if the first turn helped; it does not when nothing is answered.
    rows = 0
    while wanted.phase == "rows":
        rows += 1
        wanted = asked.send([])
    assert (rows, wanted.phase) == (model.depth, "cells")


def test_a_larger_limit_and_a_larger_budget_never_make_it_worse(job: Job) -> None:
    gains = [tune(job, ("x", "y"), limit=limit, budget=100).gained for limit in (-4.0, -3.5, -3.0, -2.5)]
    assert gains == sorted(gains)
    gains = [tune(job, ("x", "y"), limit=-3.1, budget=count).gained for count in (60, 120, 240)]
    assert gains == sorted(gains)


def test_the_limit_start_keeps_what_it_begins_with(job: Job) -> None:
    found = tune(job, ("x", "y"), limit="start", budget=120)
    assert found.limit == found.base_kept
    assert found.kept <= found.base_kept
    assert found.gained >= found.base_gained + 0.005


def test_without_a_way_into_the_limit_it_comes_as_near_as_it_can(job: Job) -> None:
    found = tune(job, ("x", "y"), limit=-9, budget=120)
    assert found.kept == min(found.kept, found.base_kept)
    assert "No setting reached -9.00." in found.sentence


def test_what_fails_is_reported_and_not_chosen(job: Job) -> None:
    found = tune(job, ("x",), limit=0, budget=60)
    assert {each.error for each in found.trials if each.params.x > 0.99} == {"Too far."}
    assert found.found.x <= 0.99
    report = found.to_json()
    assert [each["discriminability"] for each in report["trials"] if each["error"]] == [None] * SEARCH_SEEDS


def test_nothing_better_says_so_and_keeps_the_start(job: Job) -> None:
    found = tune(replace(job, params=HillParams(x=0.3)), ("s",), budget=60)
    assert dict(found.changes) == {}
    assert found.sentence.startswith(f"In {len(found.trials)} runs nothing made more that is new")


def test_every_point_is_told_once_with_its_picture(job: Job) -> None:
    told, shares = [], []
    found = tune(
        job, ("x", "y"), budget=60, on_trial=lambda trial, cell: told.append((trial, cell.result)),
        on_progress=shares.append,
    )  # fmt: skip
    assert sorted(each.index for each, _ in told) == list(range(len(found.trials)))
    assert all(result.image.shape == (16, 16, 1) for trial, result in told if not trial.error)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    fresh = [each for each in found.trials if each.phase == "fresh seeds"]
    searched = {each.seed for each in found.trials if each.phase != "fresh seeds"}
    assert job.seed in searched
    assert len(searched) == SEARCH_SEEDS
    assert {each.seed for each in fresh}.isdisjoint(searched)
    assert len({each.seed for each in fresh}) == found.fresh == SHORT_FINAL.seeds


def test_it_stops_when_asked(job: Job) -> None:
    told = []
    before = set(threading.enumerate())
    with pytest.raises(Cancelled):
        tune(job, ("x", "y"), on_trial=lambda trial, _: told.append(trial), should_stop=lambda: len(told) >= 5)
    assert len(told) == 5
    assert set(threading.enumerate()) <= before


@pytest.mark.parametrize(
    ("knobs", "more", "said"),
    [
        (("w",), {}, "must be one of x, y, n, s, free, on, seed, got 'w'."),
        (("on",), {}, "knobs: must be numbers among x, y, n, s, free, got 'on'."),
        (("seed",), {}, "knobs: must be numbers among x, y, n, s, free, got 'seed'."),
        (("x", "x"), {}, "A knob is tuned once, got x twice."),
        ((), {}, "Hill has no thresholds: say which of its numbers are to be tuned (knobs)."),
        (("x",), {"budget": 23}, "budget: must be a whole number from 24 to 5000, got 23."),
        (("x",), {"limit": math.nan}, "limit: must be a number, or start"),
    ],
)
def test_one_sentence_before_anything_runs(job: Job, knobs, more, said: str) -> None:
    with pytest.raises(InputError) as refused:
        tune(job, knobs, on_trial=lambda *_: pytest.fail("something ran"), **more)
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("start", "said"),
    [(HillParams(x=1.0), "Too far."), (HillParams(on=True), "D and V cannot be said about its result.")],
)
def test_a_start_that_cannot_be_measured_is_refused(job: Job, start: HillParams, said: str) -> None:
    with pytest.raises(InputError, match=f"What tuning begins with cannot be used: {said}"):
        tune(replace(job, params=start), ("x",))


def test_places_of_a_range_and_back() -> None:
    knobs = {each.name: each for each in describe(HillParams)}
    for name, value in (("x", 0.25), ("n", 5), ("s", 0.1), ("free", -1.0)):
        assert value_at(knobs[name], place_of(knobs[name], value)) == pytest.approx(value)
    assert value_at(knobs["s"], 0.5) == 1.0
    assert grid_values(knobs["n"], 9) == [1, 3, 5, 7, 9]
    assert (value_at(knobs["x"], -1), value_at(knobs["x"], 2)) == (0.0, 1.0)


def test_the_end_takes_no_more_runs_than_it_says(job: Job) -> None:
    found = tune(job, ("x", "y", "n"), limit=-3.1, budget=600)
    end = [each for each in found.trials if each.phase == "fresh seeds"]
    assert found.fresh == FINAL.seeds
    assert len({each.seed for each in end}) == FINAL.seeds
    assert len(end) <= FINAL.runs == 21 * 4 + 9 * 8 + 5 * 36
    by_params: dict[HillParams, int] = {}
    for each in end:
        by_params[each.params] = by_params.get(each.params, 0) + 1
    # The start and the finalists have all seeds, the others the first ones; what is found is a finalist.
    assert sorted(by_params.values(), reverse=True)[:9] == [48] * 5 + [12] * 4
    assert set(by_params.values()) == {48, 12, 4}
    assert by_params[found.found] == 48
    own = [each.kept for each in end if each.params == found.found]
    assert found.kept == pytest.approx(sum(own) / 48)


def tried(x: float, kept: tuple[float, ...], gained: tuple[float, ...]) -> Tried:
    return Tried(HillParams(x=x), kept, gained)


START = tried(0.5, (-4.2, -3.8), (0.30, 0.30))


def test_chances_are_of_paired_differences() -> None:
    # Both are better by .1 in the mean; the first by the same in every seed, the second by chance.
    steady, scattered = tried(0.1, (-4.3, -3.9), (0.31, 0.31)), tried(0.2, (-3.3, -4.9), (0.31, 0.31))
    one, two = compared([steady, scattered], START, None)
    # Differences -.1, -.1 and +.9, -1.1: variances 0 and 2, pooled 1.
    assert one.within == pytest.approx(NormalDist().cdf(0.1 / math.sqrt((0 + 1) / 2 / 2)))
    assert two.within == pytest.approx(NormalDist().cdf(0.1 / math.sqrt((2 + 1) / 2 / 2)))
    assert one.gain == pytest.approx(0.01)
    # V is larger by .01 in every seed; a thousandth is no gain.
    assert one.larger == two.larger == 1.0
    (unseen,) = compared([tried(0.3, (-4.3, -3.9), (0.3009, 0.3009))], START, None)
    assert unseen.larger == 0.0
    # That it holds again for means over other seeds is less sure: their own chance comes on top.
    again, _ = compared([steady, scattered], START, None, 4)
    assert again.within == pytest.approx(NormalDist().cdf(0.1 / math.sqrt((0 + 1) / 2 * (1 / 2 + 1 / 4))))
    # What scatters little is not blamed for those that scatter much.
    alone, _ = compared([steady, scattered], START, None, group=lambda params: params.x)
    assert alone.within == 1.0
    # Those with fewer seeds are compared with the same ones of the start.
    long = tried(0.5, (*START.kept, 9.0), (*START.gained, 9.0))
    assert compared([steady], long, None) == compared([steady], START, None)
    assert (one.sure, one.much) == (one.within, pytest.approx(one.within * 0.01))
    # Against a fixed limit it is not paired: D itself counts.
    (fixed,) = compared([steady], START, -4.0)
    assert fixed.within == pytest.approx(NormalDist().cdf(0.1 / math.sqrt(2 * 0.04 * 2 / 2 / 2)))


def test_what_is_promising_is_likely_or_gains_much() -> None:
    likely = tried(0.1, (-4.5, -4.1), (0.33, 0.32))
    much = tried(0.2, (-4.3, -3.7), (0.6, 0.55))
    hopeless = tried(0.3, (-2.0, -1.5), (0.9, 0.8))
    worse = tried(0.4, (-4.7, -4.2), (0.1, 0.12))
    broken = tried(0.6, (math.nan, -4), (0.5, 0.5))
    found = [START, hopeless, worse, much, likely, broken]
    assert [each.params.x for each in promising(found, START, None, 1)] == [0.1]
    assert {each.params.x for each in promising(found, START, None, 9)} == {0.1, 0.2, 0.3, 0.4}
    assert {each.params.x for each in promising(found, START, -4.0, 2)} == {0.1, 0.2}
    # A setting with the numbers of another one is no other one.
    assert len(promising([likely, tried(0.7, likely.kept, likely.gained)], START, None, 9)) == 1
    assert promising([broken], START, None, 3) == []
    # Of those of a kind only some go on as long as there are others.
    family = [tried(0.1 + place / 100, (-4.5 - place / 100, -4.1), (0.33, 0.32)) for place in range(4)]
    chosen = promising([*family, much, worse], START, None, 4, kind=lambda params: params.x < 0.15, alike=2)
    assert [each.params.x < 0.15 for each in chosen].count(True) == 2
    assert len(promising(family, START, None, 4, kind=lambda _: 0)) == 4


def test_settings_are_alike_that_differ_in_thresholds_only() -> None:
    base = DeBonetParams()
    assert kind_of(base) == kind_of(base.replace(alpha=0.3, beta=1.0))
    assert kind_of(base) != kind_of(base.replace(patch=0.3))
    assert kind_of(HillParams(x=0.1)) != kind_of(HillParams(x=0.2))


def test_the_end_suggests_what_is_surest_or_has_most() -> None:
    start = tried(0.5, (-4.2, -3.8) * 5, (0.30,) * 10)
    little, lucky = tried(0.1, (-4.3, -3.9) * 5, (0.33,) * 10), tried(0.2, (-5.0, -3.1) * 5, (0.5, 0.4) * 5)
    assert best_at_the_end([little, lucky], start, None) is little
    assert best_at_the_end([little, lucky], start, -4.0) is lucky
    little, lucky = tried(0.1, (-4.3, -3.9), (0.31, 0.31)), tried(0.2, (-5.0, -3.1), (0.5, 0.4))
    assert best_at_the_end([tried(0.3, (-4.0, -3.7), (0.9, 0.9))], START, None) is START
    assert best_at_the_end([tried(0.3, (-4.2, -3.8), (0.30, 0.30))], START, None) is START
    # Nothing reaches the limit: that which is nearest.
    assert best_at_the_end([little, lucky], START, -9.0) is little
    assert Final(((2, 3), (1, 5))).runs == 3 * 3 + 2 * 2
    assert Final(((2, 3), (1, 5))).seeds == 5
    # Of those that nearly surely hold again, the one with the largest V.
    least, more = tried(0.1, (-5.2, -4.8) * 5, (0.31,) * 10), tried(0.2, (-5.1, -4.7) * 5, (0.35,) * 10)
    assert best_at_the_end([least, more, lucky], tried(0.5, (-4.2, -3.8) * 5, (0.30,) * 10), None) is more


def test_ranks() -> None:
    at = [
        Measured(params=HillParams(), kept=k, gained=g)
        for k, g in ((-4, 0.2), (-2, 0.9), (-3, 0.5), (math.nan, 9))
    ]
    assert best_of(at, -2.5, at[0]) is at[2]
    assert best_of(at, -9, at[1]) is at[0]
    assert best_of([at[2]], -2.5, at[2]) is at[2]


def _drive(rounds, measure) -> list[tuple[str, Measured]]:
    tried = []
    try:
        wanted = next(rounds)
        while len(tried) < 4000:
            answer = [measure(each) for each in wanted.params]
            tried += [(wanted.phase, each) for each in answer]
            wanted = rounds.send(answer)
    except StopIteration:
        pass
    return tried


def test_thresholds_go_from_alpha_and_side_to_rows_to_cells() -> None:
    names = ("luminance/laplacian", "luminance/first-0")
    wanted = {(1, names[0]): 0.8, (1, names[1]): 0.1, (2, names[0]): 0.1, (2, names[1]): 0.1}

    def measure(params: DeBonetParams) -> Measured:
        table = params.thresholds.matrix(params.alpha, params.beta, 2, names)
        # V is how near the table is to the wanted one, D how far the side is from 2.
        far = sum(
            abs(math.log(max(float(table[k - 1, names.index(n)]), 1e-6) / t)) for (k, n), t in wanted.items()
        )
        return Measured(params=params, kept=abs(params.coarsest_side - 2) - 4.0, gained=1 / (1 + far))

    start = measure(DeBonetParams())
    tried = _drive(threshold_rounds(start, lambda _: (2, names), -3.9, Streams(3)), measure)
    phases = [phase for place, (phase, _) in enumerate(tried) if place == 0 or tried[place - 1][0] != phase]
    # From the start's layout and from the best other one.
    climbs = ["moves", "combinations", "rows"]
    assert phases == ["alpha and coarsest side", "patches", "layouts", *climbs, *climbs, "cells"]
    best = best_of([each for _, each in tried], -3.9, start)
    assert best.params.coarsest_side == 2
    assert not best.params.fit_filters
    got = best.params.thresholds.matrix(best.params.alpha, best.params.beta, 2, names)
    for (k, name), value in wanted.items():
        # Cells move by factors of four, rows by two: what is left is less than one such step.
        assert abs(math.log(float(got[k - 1, names.index(name)]) / value)) < math.log(4)
    again = _drive(threshold_rounds(start, lambda _: (2, names), -3.9, Streams(3)), measure)
    assert [each.params for _, each in again] == [each.params for _, each in tried]


def test_moves_are_the_single_changes_that_keep_the_layout() -> None:
    params = DeBonetParams(alpha=0.3, beta=1.0)
    found = moves(params, 3)
    assert {each.what for each in found} == {
        "beta", "channels", "orientations", "filters", "alpha", "row 1", "row 2", "row 3",
    }  # fmt: skip
    assert (("beta", 1.0),) not in [each.changes for each in found]
    alphas = [dict(each.changes)["alpha"] for each in found if each.what == "alpha"]
    # None twice, none beyond the slider's linear part, not the present one.
    assert alphas == [0.15, 0.225, 0.39, 0.5]
    for each in found:
        assert layout_of(params.replace(**dict(each.changes))) == layout_of(params)


def test_what_makes_d_smaller_pays_for_what_makes_v_larger() -> None:
    def row(k: int) -> Move:
        return Move(f"row {k}", row=k, factor=2.0)

    strict, loose, both, bad = row(1), row(2), Move("row 1", row=1, factor=0.5), row(3)
    effects = [
        Effect(strict, -0.3, -0.001), Effect(loose, 0.1, 0.03), Effect(both, -0.25, 0.001), Effect(bad, 0.9, -0.1),
        Effect(row(4), math.nan, 9.0),
    ]  # fmt: skip
    found = together(effects, (0.0, 0.0), -0.04, 8)
    # By addition: -.15 and +.031 goes before -.2 and +.029; the two of row 1 never go together.
    assert [frozenset(each) for each in found[:2]] == [frozenset({loose, both}), frozenset({strict, loose})]
    assert not any({strict, both} <= set(each) or row(4) in each for each in found)
    # Where what they were made from has a D that is larger by .18, only the surer one is within the limit.
    assert set(together(effects, (0.16, 0.0), 0.0, 1)[0]) == {strict, loose}
    assert together(effects[:1], (0.0, 0.0), 0.0, 8) == []
    many = [Effect(row(k), -0.01 * k, 0.001 * k) for k in range(1, 12)]
    often = Counter(each for chosen in together(many, (0.0, 0.0), 0.0, 20) for each in chosen)
    assert max(often.values()) == MOST_OFTEN


def test_a_combination_of_rows_is_found_that_no_single_row_gives() -> None:
    """D and V of the table alone: row 1 pays for row 2, and each of them alone is no gain."""
    names = ("luminance/laplacian",)

    def measure(params: DeBonetParams) -> Measured:
        if layout_of(params) != layout_of(DeBonetParams()):
            return Measured(params=params, kept=0.0, gained=0.0)
        one, two = (
            float(params.thresholds.matrix(params.alpha, params.beta, 2, names)[k, 0]) / 0.15 for k in range(2)
        )
        tight, loose = 1 - min(one, 1), math.log(two)
        return Measured(params=params, kept=-4 - tight / 2 + loose / 5, gained=0.4 - tight / 50 + loose / 20)

    start = measure(DeBonetParams())
    tried = _drive(threshold_rounds(start, lambda _: (2, names), start.kept, Streams(3)), measure)
    for phase, holds in (("moves", False), ("combinations", True)):
        better = [each for what, each in tried if what == phase and each.kept < -4 and each.gained > 0.4]
        assert bool(better) is holds, phase


def test_knobs_are_searched_to_the_top_of_a_smooth_hill() -> None:
    fields = [each for each in describe(HillParams) if each.name in ("x", "y", "s")]

    def measure(params: HillParams) -> Measured:
        return Measured(
            params=params, kept=-4.0,
            gained=-((params.x - 0.37) ** 2) - (params.y - 0.81) ** 2 - (math.log10(params.s) - 0.6) ** 2,
        )  # fmt: skip

    tried = _drive(knob_rounds(measure(HillParams()), fields, 0, Streams(0)), measure)
    best = best_of([each for _, each in tried], 0, tried[0][1]).params
    assert (best.x, best.y) == (pytest.approx(0.37, abs=0.01), pytest.approx(0.81, abs=0.01))
    assert math.log10(best.s) == pytest.approx(0.6, abs=0.04)


def test_the_preset_makes_what_was_found(job: Job, tmp_path) -> None:
    found = tune(job, ("x", "y"), limit=-3.1, budget=80)
    write_preset(found.preset("mine"), tmp_path / "mine.json")
    preset = find_preset(str(tmp_path / "mine.json"), PresetStore(tmp_path / "none"), "hill")
    assert preset.params() == found.found
    assert preset.note == f"Tuned. {found.sentence}"
    again = run(Job(method="hill", inputs=job.inputs, params=preset.params(), size=job.size, seed=job.seed))
    chosen = next(each for each in found.trials if each.params == found.found and each.seed == job.seed)
    assert again.measures["discriminability"] == chosen.kept
