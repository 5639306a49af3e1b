"""Every knob does something, and says truly whether the analysis depends on it."""

from __future__ import annotations

import contextlib
import itertools
import math
from collections import OrderedDict
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.contract.cases import job, promise, texture
from texlab_core.contract.declarations import others, settings
from texlab_core.contract.runs import promise_same_bits
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.params import describe
from texlab_core.engine.run import model_of, run
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab_core.engine.job import Job
    from texlab_core.engine.params import Field, Params
    from texlab_core.engine.registry import Method
    from texlab_core.engine.result import Result

# Pairs of jobs that differ in one knob, for which a kept analysis is compared with a new one.
COMPARED = 4
# Results in memory at a time; jobs that come again do so soon.
KEPT = 64


def check_living_knobs(method: Method) -> None:
    """Have no dead knob: another value of each changes some bit of a result."""
    kept = Kept()
    for field in describe(method.params):
        tried = field.kind != "value" or likely(field)
        promise(tried, f"{field.name}: give {field.type.__name__} a class method example() for another value.")
        promise(
            any(_differ(kept, one, other) for one, other in pairs(method, field)),
            f"The knob {field.name} of {method.id} is dead: no value changed any bit of a result. Use it, remove "
            "it, or say with Knob(when=...) under which other value it has an effect.",
        )


class Kept:
    """Results by job, the latest ones; that equal jobs give equal bits is promised elsewhere."""

    def __init__(self) -> None:
        self._results: OrderedDict[tuple[object, ...], Result | None] = OrderedDict()

    def __call__(self, job: Job) -> Result | None:
        """Return the result of a job, or None where the method refuses it."""
        if job.key not in self._results:
            try:
                self._results[job.key] = run(job)
            except InputError:
                self._results[job.key] = None
            if len(self._results) > KEPT:
                self._results.popitem(last=False)
        return self._results[job.key]


def _differ(kept: Kept, one: Job, other: Job) -> bool:
    """Whether two jobs give other pictures, measures or maps; not where one is refused."""
    first = kept(one)
    second = None if first is None else kept(other)
    return first is not None and second is not None and not same(first, second)


def check_cached_analysis(method: Method) -> None:
    """Give the knobs that the analysis depends on the stage "analysis", so that it is kept only for them."""
    exemplar = texture(20, 24)
    cache = AnalysisCache(capacity=1000)
    kept = Kept()
    for params in settings(method):
        try:
            tried = job(method, exemplar, params=params, size=(14, 18))
        except InputError:
            continue
        fresh = kept(tried)
        if fresh is None:
            continue
        promise_same_bits(
            fresh,
            run(tried, cache=cache),
            f"with the analysis of other parameters ({params}): one of them needs stage='analysis'",
        )
    for field in describe(method.params):
        compared = 0
        for one, other in pairs(method, field):
            cache = AnalysisCache()
            fresh = kept(other)
            if fresh is None:
                continue
            try:
                model_of(one, cache=cache)
            except InputError:
                continue
            cached = run(other, cache=cache)
            compared += 1
            when = f"with {field.name} = {getattr(other.params, field.name)!r} and the analysis of another value"
            promise_same_bits(fresh, cached, f"{when}: the knob needs stage='analysis'")
            if compared >= COMPARED:
                break
        promise(compared, f"{field.name}: no other value of it could be tried.")


def likely(field: Field) -> list[Any]:
    """Return values of a knob that differ from its default, the ones likeliest to show first."""
    low, high = field.knob.low, field.knob.high
    if field.kind not in ("int", "float") or low is None or high is None:
        return others(field)
    candidates = [2 * field.default + 1, field.default / 2, low, min(high, low + 1), high]
    if field.kind == "int":
        candidates = [math.floor(value) | 1 if field.knob.odd else math.floor(value) for value in candidates]
    return list(dict.fromkeys(value for value in candidates if low <= value <= high and value != field.default))


def bases(method: Method, field: Field) -> Iterator[Params]:
    """Yield parameters under which the knob may have an effect: ``when`` holds; then with another knob changed."""
    fields = {each.name: each for each in describe(method.params)}
    changes: dict[str, Any] = {}
    each = field
    while each.knob.when is not None:
        name, values = each.knob.when
        if method.params().to_json()[name] not in values:
            changes[name] = values[0]
        each = fields[name]
    first = method.params().replace(**changes)
    yield first
    for name in (name for name in fields if name != field.name and name not in changes):
        for value in likely(fields[name]):
            with contextlib.suppress(InputError):
                yield first.replace(**{name: value})


def situations(method: Method) -> Iterator[dict[str, Any]]:
    """Yield jobs in which a knob may show: outputs of other sizes, gray, and with an optional picture given."""
    for exemplar in (texture(24, 32), texture(40, 33, 1)):
        for size in (exemplar.size, (40, 56)):
            yield {"exemplar": exemplar, "size": size}
        for spec in method.inputs:
            if spec.kind == "image" and not spec.required:
                given = {"exemplar": exemplar, spec.name: texture(*exemplar.size, exemplar.channels)}
                yield {"exemplar": exemplar, "size": (40, 56), "inputs": given}


def pairs(method: Method, field: Field) -> Iterator[tuple[Job, Job]]:
    """Yield jobs that differ in one knob only; what cannot work is left out."""
    for base, value, situation in itertools.product(bases(method, field), likely(field), situations(method)):
        with contextlib.suppress(InputError):
            changed = base.replace(**{field.name: value})
            one, other = (job(method, params=params, seed=2, **situation) for params in (base, changed))
            yield one, other


def same(one: Result, other: Result) -> bool:
    """Return whether two results agree in picture, measures and maps."""
    if one.image.tobytes() != other.image.tobytes() or one.measures != other.measures:
        return False
    return one.maps.keys() == other.maps.keys() and all(
        np.array_equal(one.maps[name].data, other.maps[name].data) for name in one.maps
    )
