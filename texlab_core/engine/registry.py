"""The synthesis methods: every file of ``methods/``, and every ``method*.py`` of its folders, registers itself."""

from __future__ import annotations

import importlib.util
import pkgutil
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from texlab_core.engine.params import describe
from texlab_core.engine.plugins import OWN_PACKAGE, Failure, Shelf, Source, own_modules
from texlab_core.engine.steps import FloatImage, Output, Step

if TYPE_CHECKING:
    from pathlib import Path

    from texlab_core.engine.inputs import DataInput
    from texlab_core.engine.params import Params

Steps = Generator[Step, None, Any]


@dataclass(frozen=True, slots=True)
class InputSpec:
    """One named input that a method takes."""

    name: str
    help: str
    kind: Literal["image", "data", "arrays"] = "image"
    required: bool = True
    background: float = 1.0
    """Gray level under the transparent pixels of an image: what is transparent in a mask is not marked."""
    texture: bool = False
    """Whether it is a texture like the exemplar, of any size: a large one is reduced when it is opened."""
    read: Callable[[Path], DataInput] | None = None
    """Reads a file of the kind ``data``; without it any JSON file is taken."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """What a run is expected to take: seconds on one core, and bytes beyond what the program holds already.

    None where nobody can say how long.
    """

    seconds: float | None
    nbytes: int


EXEMPLAR = InputSpec("exemplar", "The texture to make more of.")


@dataclass(frozen=True, kw_only=True)
class Method:
    """A synthesis method.

    Parameters
    ----------
    id
        Lower-case words with hyphens; used on the command line and in recipes.
    title
        For people.
    summary
        One sentence: what it does.
    reference
        The paper.
    params
        Its ``Params`` class.
    analyze
        ``analyze(inputs, params)``: generator of Steps that returns the model. Deterministic; it depends on
        the inputs and on the parameters of stage ``analysis`` only.
    synthesize
        ``synthesize(model, inputs, params, size, streams)``: generator of Steps that returns an ``Output``.
    fails_on
        What it is known to fail on, one phrase each.
    inputs
        The named inputs.
    check
        ``check(inputs, params, size)`` raises ``InputError`` for combinations that cannot work.
    draft
        ``draft(inputs, params, size, seed)`` returns within about 100 ms a picture, possibly smaller than
        ``size``, that shows what the parameters do; no result, and none to keep. None where smaller jobs serve.
    rehearsals
        Parameters with which a tiny run needs compiled code that a run with the defaults does not.
    questions
        ``question(result)`` with a ``Result``: what tabs ask with compiled code of its own; asked of a tiny one.
    order
        Place in lists and in the first columns of the window.
    measures
        Ids of the registered measures that its outputs carry.
    random
        False when no bit of the result depends on the seed.
    dimensions
        2 when it makes images of (height, width), 3 when it makes volumes of (depth, height, width).
    estimate
        ``estimate(inputs, params, size)`` foretells what a run takes, for methods that may take long or much.
    bytes_per_pixel
        Peak memory of a run for each pixel of exemplar and output, where there is no ``estimate``.
    package
        Who declares it; filled in when it is found.
    """

    id: str
    title: str
    summary: str
    reference: str
    params: type[Params]
    analyze: Callable[..., Steps]
    synthesize: Callable[..., Generator[Step, None, Output]]
    fails_on: tuple[str, ...] = ()
    inputs: tuple[InputSpec, ...] = (EXEMPLAR,)
    check: Callable[..., None] | None = None
    draft: Callable[..., FloatImage] | None = None
    rehearsals: tuple[Params, ...] = ()
    questions: tuple[Callable[[Any], object], ...] = ()
    order: int = 100
    measures: tuple[str, ...] = ()
    random: bool = True
    dimensions: Literal[2, 3] = 2
    estimate: Callable[..., Estimate] | None = None
    bytes_per_pixel: int = 64
    package: str = OWN_PACKAGE


def _own() -> Iterator[Source]:
    package = "texlab_core.methods"
    for source in own_modules(package):
        spec = importlib.util.find_spec(source.module)
        if spec is None or spec.submodule_search_locations is None:
            yield source
            continue
        for inner in pkgutil.iter_modules(spec.submodule_search_locations):
            if inner.name.split("_")[0] == "method":
                yield Source(source.package, f"{source.module}.{inner.name}")


def _accepted(method: Method, package: str) -> Method:
    """Return a method with its package, which stands in its title too; raises ``TypeError`` for unusable knobs."""
    describe(method.params)
    method.params()
    if package == OWN_PACKAGE:
        return method
    return replace(method, title=f"{method.title} ({package})", package=package)


_METHODS = Shelf("method", _own, _accepted, warn=False)


def register(method: Method) -> Method:
    """Add a method; a second one with the same id is a programming error."""
    return _METHODS.add(method)


def methods() -> Mapping[str, Method]:
    """Return every registered method by id, in their order; imports what declares them once.

    These are the files and folders of ``methods/``, then the modules that other installed packages name as entry
    points of the group ``texlab_core.methods``. What cannot be used is left out; :func:`failures` says why.
    """
    return _METHODS.all()


def failures() -> tuple[Failure, ...]:
    """Return what could not be used, of our own and of other packages."""
    return _METHODS.failures()


def find_method(name: str) -> Method:
    """Return the method with this id.

    Raises
    ------
    ParamError
        When there is none; the message lists the ids.
    """
    return _METHODS.find(name)
