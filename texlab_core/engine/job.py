"""Everything that is needed to make a result, checked before work starts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.estimate import check_memory, estimate_of
from texlab_core.engine.inputs import ArraysInput, DataInput, ImageInput, Input, shorten
from texlab_core.engine.params import Params, frozen_mapping
from texlab_core.engine.registry import Method, find_method
from texlab_core.engine.sizes import MAX_PIXELS as MAX_PIXELS
from texlab_core.engine.sizes import check_size as check_size
from texlab_core.engine.sizes import default_size
from texlab_core.errors import InputError, ParamError

if TYPE_CHECKING:
    from collections.abc import Mapping

MAX_SEED = 2**31 - 1
# Of an output that nothing else decides.
DEFAULT_SIZE = (256, 256)
_KINDS = {"image": ImageInput, "data": DataInput, "arrays": ArraysInput}


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
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
        Height and width of the output; None takes the exemplar's. For methods of three dimensions depth, height
        and width; None takes a cube with the exemplar's shorter side, at most 64.
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
    size: tuple[int, ...] = None  # type: ignore[assignment]
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
        size = self._default_size(method.dimensions) if self.size is None else self.size
        object.__setattr__(self, "size", check_size(size, method.dimensions))
        object.__setattr__(self, "seed", check_seed(self.seed))
        if method.check is not None:
            method.check(self.inputs, self.params, self.size)
        check_memory(method, estimate_of(method, self.inputs, self.params, self.size), self.size)

    def _default_size(self, dimensions: int) -> tuple[int, ...]:
        exemplar = self.inputs.get("exemplar")
        return default_size(exemplar.size if isinstance(exemplar, ImageInput) else DEFAULT_SIZE, dimensions)

    @property
    def picture_size(self) -> tuple[int, int]:
        """Height and width of the picture: the output itself, or the slice that stands for a volume."""
        return self.size[-2], self.size[-1]

    @property
    def brief(self) -> str:
        """What is done, in a few words: "de-bonet on gallery:oriented-fur, 512 x 256, seed 3"."""
        exemplar = self.inputs.get("exemplar") or next(iter(self.inputs.values()), None)
        on = "" if exemplar is None else f" on {shorten(exemplar.name)}"
        return f"{self.method}{on}, {' x '.join(map(str, self.size[::-1]))}, seed {self.seed}"

    def __repr__(self) -> str:
        """Return one short line, whatever the size of the inputs."""
        return f"<Job: {self.brief}>"

    @property
    def key(self) -> tuple[object, ...]:
        """What the bits of the result depend on, on one machine and one set of library versions."""
        return job_key(self.method, self.inputs, self.params, self.size, self.seed)

    @property
    def analysis_key(self) -> tuple[object, ...]:
        """What the analysis depends on."""
        return (self.method, _hashes(self.inputs), self.params.analysis_key())


def job_key(
    method: str, inputs: Mapping[str, Input], params: Params, size: tuple[int, ...], seed: int
) -> tuple[object, ...]:
    """Return the key of a job with these parts (:attr:`Job.key`), which is neither made nor checked."""
    return (method, _hashes(inputs), params, size, seed)


def _hashes(inputs: Mapping[str, Input]) -> tuple[tuple[str, str], ...]:
    return tuple((name, inputs[name].sha256) for name in sorted(inputs))


def check_seed(seed: object) -> int:
    """Return the seed; raises ``ParamError`` unless it is a whole number in 0 .. 2147483647."""
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or not 0 <= seed <= MAX_SEED:
        raise ParamError("seed", f"a whole number from 0 to {MAX_SEED}", seed)
    return int(seed)


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
