"""What a drawing of a step is: settings that are checked, and a function that draws."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.documents.lesson_parts import LessonError
from texlab_core.files.strict_json import shorten

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from texlab_core.documents.lesson_parts import Drawing
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result

    Plane = NDArray[np.float32]
    Sheet = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Scene:
    """What a drawing can draw.

    Parameters
    ----------
    exemplar, other
        The step's exemplar and the drawing's own second picture, where there are any.
    result
        Of the chosen column, where there is one.
    pixel
        Row and column of the pixel that is asked about.
    seed
        For what is random.
    """

    exemplar: ImageInput | None = None
    other: ImageInput | None = None
    result: Result | None = None
    pixel: tuple[int, int] | None = None
    seed: int = 1

    def plane(self) -> Plane:
        """Return the luma of the exemplar, (H, W) float32."""
        from texlab_core.transforms.luma import luma

        plane: Plane = luma(self.given().pixels)
        return plane

    def given(self) -> ImageInput:
        """Return the exemplar; :func:`check` has seen to it that there is one."""
        assert self.exemplar is not None
        return self.exemplar

    def made(self) -> Result:
        """Return the chosen column's result; :func:`check` has seen to it that there is one."""
        assert self.result is not None
        return self.result

    def rng(self) -> np.random.Generator:
        """Return random numbers that follow from the seed."""
        return np.random.default_rng(self.seed)


@dataclass(frozen=True, eq=False)
class Drawn:
    """A picture, (H, W, 3) uint8, and what it says in words and numbers."""

    sheet: Sheet
    lines: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Kind:
    """One kind of drawing.

    Parameters
    ----------
    settings
        Dataclass of what can be set.
    draw
        Draws it.
    needs
        Of ``exemplar``, ``other``, ``result``, ``pixel``.
    methods
        Methods whose results it can draw; empty for any.
    """

    settings: type[Params]
    draw: Callable[[Any, Scene], Drawn]
    needs: tuple[str, ...] = ("exemplar",)
    methods: tuple[str, ...] = ()


_MODULES = ("filter_drawings", "shape_drawings", "result_drawings", "spectral_drawings")


def kinds() -> Mapping[str, Kind]:
    """Return every kind of drawing by its name."""
    found: dict[str, Kind] = {}
    for name in _MODULES:
        found |= importlib.import_module(f"texlab_core.lessons.{name}").KINDS
    return MappingProxyType(found)


def kind_of(drawing: Drawing) -> tuple[Kind, Params]:
    """Return a drawing's kind and its settings, checked.

    Raises
    ------
    LessonError
        When there is no such kind.
    ParamError
        When a setting is unknown or out of range.
    """
    known = kinds()
    if drawing.kind not in known:
        raise LessonError(f"drawing: kind must be one of {', '.join(known)}, got {shorten(drawing.kind)}.")
    kind = known[drawing.kind]
    return kind, kind.settings.from_json(kind.settings.completed(drawing.settings))


def draw(drawing: Drawing, scene: Scene) -> Drawn:
    """Draw it."""
    kind, settings = kind_of(drawing)
    return kind.draw(settings, scene)
