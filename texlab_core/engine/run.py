"""Jobs, random streams, and the only loop that drives a method."""

from __future__ import annotations

import hashlib
import importlib.metadata
import platform
import threading
import time
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache as memoize
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.engine.inputs import ArraysInput, DataInput, ImageInput, Input
from texlab_core.engine.params import Params, frozen_mapping
from texlab_core.engine.registry import Method, find_method
from texlab_core.engine.steps import Output, Result, Step
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.version import __version__
from texlab_core.work.threads import use_workers

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

MAX_PIXELS = 64 * 2**20
MAX_SEED = 2**31 - 1
_KINDS = {"image": ImageInput, "data": DataInput, "arrays": ArraysInput}


class Streams:
    """Random streams by name and index, a function of (seed, name, index) and of nothing else."""

    def __init__(self, seed: int) -> None:
        self.seed = seed

    def key(self, name: str, *index: int) -> int:
        """Return a 64-bit key for counter-based hashing in kernels."""
        return int.from_bytes(self._digest(name, index)[:8], "little")

    def __call__(self, name: str, *index: int) -> np.random.Generator:
        """Return a fresh generator at the start of the stream."""
        key = np.frombuffer(self._digest(name, index), dtype="<u8").astype(np.uint64)
        return np.random.Generator(np.random.Philox(key=key))

    def _digest(self, name: str, index: tuple[int, ...]) -> bytes:
        text = "/".join([str(self.seed), name, *map(str, index)])
        return hashlib.blake2b(text.encode(), digest_size=16, person=b"texlab").digest()


@dataclass(frozen=True, eq=False, kw_only=True)
class Job:
    """Everything that is needed to make a result, bit for bit.

    Parameters
    ----------
    method
        Id of a registered method.
    inputs
        The named inputs; ``exemplar`` for most methods.
    params
        The method's parameters; None takes the defaults.
    size
        Height and width of the output; None takes the exemplar's.
    seed
        0 .. 2147483647.

    Raises
    ------
    InputError
        When the method is unknown, an input is missing, or a value is out of range.
    """

    method: str
    inputs: Mapping[str, Input]
    params: Params = None  # type: ignore[assignment]  # None is replaced in __post_init__
    size: tuple[int, int] = None  # type: ignore[assignment]
    seed: int = 0

    def __post_init__(self) -> None:
        method = find_method(self.method)
        params: Params | None = self.params
        if params is None:
            params = method.params()
        if type(params) is not method.params:
            raise InputError(f"{method.title} takes {method.params.__name__}, got {type(params).__name__}.")
        object.__setattr__(self, "params", params)
        object.__setattr__(self, "inputs", frozen_mapping(self.inputs))
        _check_inputs(method, self.inputs)
        object.__setattr__(self, "size", check_size(self._default_size() if self.size is None else self.size))
        object.__setattr__(self, "seed", check_seed(self.seed))
        if method.check is not None:
            method.check(self.inputs, self.params, self.size)

    def _default_size(self) -> tuple[int, int]:
        exemplar = self.inputs.get("exemplar")
        return exemplar.size if isinstance(exemplar, ImageInput) else (256, 256)

    @property
    def analysis_key(self) -> tuple[object, ...]:
        """What the analysis depends on."""
        hashes = tuple((name, self.inputs[name].sha256) for name in sorted(self.inputs))
        return (self.method, hashes, self.params.analysis_key())


def check_seed(seed: object) -> int:
    """Return the seed; raises ``ParamError`` unless it is a whole number in 0 .. 2147483647."""
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or not 0 <= seed <= MAX_SEED:
        raise ParamError("seed", f"a whole number from 0 to {MAX_SEED}", seed)
    return int(seed)


def check_size(size: object) -> tuple[int, int]:
    """Return (height, width); raises ``ParamError`` unless both are at least 1 and it is at most 64 megapixels."""
    allowed = "height and width of at least 1 pixel and at most 64 megapixels together"
    if not isinstance(size, tuple | list) or len(size) != 2:
        raise ParamError("size", allowed, size)
    height, width = size
    for side in (height, width):
        if isinstance(side, bool) or not isinstance(side, int | np.integer) or side < 1:
            raise ParamError("size", allowed, size)
    if int(height) * int(width) > MAX_PIXELS:
        raise ParamError("size", allowed, size)
    return int(height), int(width)


def _check_inputs(method: Method, inputs: Mapping[str, Input]) -> None:
    specs = {spec.name: spec for spec in method.inputs}
    for name, given in inputs.items():
        if name not in specs:
            raise ParamError("input", f"one of {', '.join(specs)} for {method.title}", name)
        if not isinstance(given, _KINDS[specs[name].kind]):
            raise InputError(f"{name}: must be an input of kind {specs[name].kind}, got {type(given).__name__}.")
    for spec in method.inputs:
        if spec.required and spec.name not in inputs:
            raise InputError(f"{method.title} needs the input {spec.name}, and none was given.")


class AnalysisCache:
    """Models by analysis key, the most recently used ones; safe to share between threads.

    Parameters
    ----------
    capacity
        How many models are kept.
    max_bytes
        How much their arrays may take together; the newest model is kept whatever it takes.
    """

    def __init__(self, capacity: int = 16, max_bytes: int = 2**30) -> None:
        self._capacity = capacity
        self._max_bytes = max_bytes
        self._models: OrderedDict[tuple[object, ...], Any] = OrderedDict()
        self._sizes: dict[tuple[object, ...], int] = {}
        self._lock = threading.Lock()

    def get(self, key: tuple[object, ...]) -> Any | None:
        """Return the model, or None."""
        with self._lock:
            if key in self._models:
                self._models.move_to_end(key)
            return self._models.get(key)

    def put(self, key: tuple[object, ...], model: Any) -> None:
        """Keep a model, dropping those that were not used for longest."""
        size = array_bytes(model)
        with self._lock:
            self._models[key], self._sizes[key] = model, size
            self._models.move_to_end(key)
            while len(self._models) > self._capacity or (
                len(self._models) > 1 and sum(self._sizes.values()) > self._max_bytes
            ):
                del self._sizes[self._models.popitem(last=False)[0]]

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._models.clear()
            self._sizes.clear()


def array_bytes(value: object, seen: set[int] | None = None) -> int:
    """Return how many bytes the arrays in dataclasses and containers take, shared ones counted once."""
    seen = set() if seen is None else seen
    if id(value) in seen:
        return 0
    seen.add(id(value))
    if isinstance(value, np.ndarray):
        return array_bytes(value.base, seen) if isinstance(value.base, np.ndarray) else value.nbytes
    if is_dataclass(value):
        return sum(array_bytes(getattr(value, each.name, None), seen) for each in fields(value))
    if isinstance(value, Mapping):
        return sum(array_bytes(each, seen) for each in value.values())
    if isinstance(value, list | tuple | set | frozenset):
        return sum(array_bytes(each, seen) for each in value)
    return 0


def run(
    job: Job,
    on_step: Callable[[Step], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    *,
    cache: AnalysisCache | None = None,
    threads: int | None = None,
) -> Result:
    """Run a job to its end.

    Parameters
    ----------
    job
        What to do.
    on_step
        Called with every step, in this thread. Watching changes no bit of the result.
    should_stop
        Asked between steps.
    cache
        Where analyses are kept and found.
    threads
        Threads within one transform; None means two. No bit of the result depends on it.

    Returns
    -------
    Result
        The output with its job, versions and elapsed time.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    InputError
        When the input turns out to be unusable for this method.
    """
    method = find_method(job.method)
    start = time.perf_counter()
    with use_workers(threads):
        model = cache.get(job.analysis_key) if cache is not None else None
        if model is None:
            model = _drive(method.analyze(job.inputs, job.params), "analysis", on_step, should_stop)
            if cache is not None:
                cache.put(job.analysis_key, model)
        steps = method.synthesize(model, job.inputs, job.params, job.size, Streams(job.seed))
        output: Output = _drive(steps, "synthesis", on_step, should_stop)
    return Result(
        job=job,
        model=model,
        image=output.image,
        maps=output.maps,
        curves=output.curves,
        measures=output.measures,
        notes=output.notes,
        details=output.details,
        elapsed_s=time.perf_counter() - start,
        versions=versions(),
    )


def _drive(
    steps: Generator[Step, None, Any],
    phase: Literal["analysis", "synthesis"],
    on_step: Callable[[Step], None] | None,
    should_stop: Callable[[], bool] | None,
) -> Any:
    try:
        while True:
            if should_stop is not None and should_stop():
                raise Cancelled
            try:
                step = next(steps)
            except StopIteration as end:
                return end.value
            if on_step is not None:
                on_step(step if step.phase == phase else replace(step, phase=phase))
    finally:
        steps.close()


@memoize
def versions() -> Mapping[str, str]:
    """Return the versions that influence the bits of a result."""
    found = {"python": platform.python_version(), "texlab": __version__}
    for name in ("numpy", "scipy", "numba", "opencv-contrib-python-headless"):
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            found[name] = "unknown"
    return frozen_mapping(found)
