"""The parts of a lesson's step, each read from JSON and checked."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, Self, TypeVar

from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import check_seed
from texlab_core.engine.levels import Levels
from texlab_core.engine.params import describe, frozen_mapping
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_from_json, size_to_json
from texlab_core.errors import InputError
from texlab_core.files.strict_json import check_keys, dumps, loads, shorten
from texlab_core.images.unit_range import TRANSPARENCY

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab_core.engine.params import Params

    PartT = TypeVar("PartT")

_MAX_SIDE = 2**16
_WORD = re.compile(r"[a-z0-9][a-z0-9-]{0,39}")
MAX_VALUES = 12
COLUMN_TITLE = 80
Setting = bool | int | float | str


class LessonError(InputError):
    """A lesson that is malformed, unknown, or asks for what cannot be done."""


class Fields:
    """The keys of one JSON object, read one by one; every refusal is one clause that names the key."""

    def __init__(self, data: object, known: tuple[str, ...]) -> None:
        if not isinstance(data, dict):
            raise LessonError(f"must be a JSON object with {', '.join(known)}, got {shorten(data)}.")
        check_keys(data, known, LessonError)
        self.data: dict[str, Any] = data

    def text(self, key: str, longest: int, *, needed: bool = False, lines: bool = False) -> str:
        """Return a text; an absent one is empty unless it is needed."""
        given = self.data.get(key, "")
        seen = given.replace("\n", "") if lines and isinstance(given, str) else given
        if not isinstance(given, str) or len(given) > longest or not seen.isprintable() or (needed and not given):
            allowed = f"{'1 to' if needed else 'at most'} {longest} printable characters"
            raise LessonError(f"{key}: must be {allowed}, got {shorten(self.data.get(key))}.")
        return given

    def texts(self, key: str) -> tuple[str, ...]:
        """Return a list of texts."""
        given = self.data.get(key, [])
        if not isinstance(given, list) or len(given) > 40 or not all(isinstance(each, str) for each in given):
            raise LessonError(f"{key}: must be a list of at most 40 texts, got {shorten(given)}.")
        return tuple(given)

    def items(self, key: str, low: int, high: int) -> list[Any]:
        """Return a list of ``low`` to ``high`` things."""
        given = self.data.get(key, [])
        if not isinstance(given, list) or not low <= len(given) <= high:
            got = f"{len(given)}" if isinstance(given, list) else shorten(given)
            raise LessonError(f"{key}: must be a list of {low} to {high}, got {got}.")
        return given

    def parts(self, key: str, low: int, high: int, read: Callable[[Any], PartT]) -> tuple[PartT, ...]:
        """Return what ``read`` makes of each of a list; its refusals name the key and the place from 1."""
        made = []
        for place, each in enumerate(self.items(key, low, high), 1):
            try:
                made.append(read(each))
            except InputError as bad:
                raise LessonError(f"{key}, number {place}: {bad}") from bad
        return tuple(made)

    def whole(self, key: str, default: int | None, low: int, high: int) -> int:
        """Return a whole number; without a default it is needed."""
        given = self.data.get(key, default)
        if type(given) is not int or not low <= given <= high:
            raise LessonError(f"{key}: must be a whole number from {low} to {high}, got {shorten(given)}.")
        return given

    def number(self, key: str, default: float | None, low: float, high: float) -> float:
        """Return a number; without a default it is needed."""
        given = self.data.get(key, default)
        if isinstance(given, bool) or not isinstance(given, int | float) or not low <= given <= high:
            raise LessonError(f"{key}: must be a number from {low:g} to {high:g}, got {shorten(given)}.")
        return float(given)

    def switch(self, key: str) -> bool:
        """Return true or false; absent is false."""
        given = self.data.get(key, False)
        if not isinstance(given, bool):
            raise LessonError(f"{key}: must be true or false, got {shorten(given)}.")
        return given

    def word(self, key: str) -> str:
        """Return an identifier."""
        given = self.data.get(key)
        if not isinstance(given, str) or not _WORD.fullmatch(given):
            raise LessonError(f"{key}: must be a name of lower-case letters, got {shorten(given)}.")
        return given

    def part(self, key: str, read: Callable[[Any], PartT]) -> PartT | None:
        """Return what ``read`` makes of a key, None when it is absent; its refusals name the key."""
        if key not in self.data:
            return None
        try:
            return read(self.data[key])
        except InputError as bad:
            raise LessonError(f"{key}: {bad}") from bad

    def settings(self, key: str) -> Mapping[str, Setting]:
        """Return settings: texts, numbers, true or false, by name."""
        given = self.data.get(key, {})
        if not isinstance(given, dict) or len(given) > 20:
            raise LessonError(f"{key}: must be an object of at most 20 settings, got {shorten(given)}.")
        for name, value in given.items():
            if not isinstance(value, bool | int | float | str) or (isinstance(value, str) and len(value) > 200):
                raise LessonError(
                    f"{key}: {name} must be a short text, a number, true or false, got {shorten(value)}."
                )
        return frozen_mapping(given)


@dataclass(frozen=True)
class Taken:
    """A picture and what is used of it.

    Parameters
    ----------
    source
        ``gallery:NAME``, or a file beside the lesson or below it.
    crop, scale
        Scaled first, then cropped.
    levels
        Of what is used; None changes nothing.
    alpha
        How transparency is read: a key of :data:`texlab_core.images.unit_range.TRANSPARENCY`.
    """

    source: str
    crop: Crop | None = None
    scale: float = 1.0
    levels: Levels | None = None
    alpha: str = "white"

    @property
    def is_plain(self) -> bool:
        """Whether versions of the format before levels and transparency can say it."""
        return self.levels is None and self.alpha == "white"

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Read it; a text alone is the whole picture."""
        known = ("source", "crop", "scale", "levels", "alpha")
        fields = Fields({"source": data} if isinstance(data, str) else data, known)
        source = fields.text("source", 300, needed=True)
        if source.startswith("gallery:"):
            from texlab_core.images.gallery import find_entry

            find_entry(source)
        else:
            _check_inside(source)
        alpha = fields.data.get("alpha", "white")
        if not isinstance(alpha, str) or alpha not in TRANSPARENCY:
            raise LessonError(f"alpha: must be one of {', '.join(TRANSPARENCY)}, got {shorten(alpha)}.")
        scale = fields.number("scale", 1.0, 0.001, 1.0)
        return cls(source, fields.part("crop", _crop), scale, fields.part("levels", Levels.from_json), alpha)

    def to_json(self) -> dict[str, Any] | str:
        """Return it as JSON data."""
        if self.crop is None and self.scale == 1 and self.is_plain:
            return self.source
        data: dict[str, Any] = {"source": self.source}
        if self.crop is not None:
            sides = ("top", "left", "height", "width")
            data["crop"] = {side: getattr(self.crop, side) for side in sides}
        if self.scale != 1:
            data["scale"] = self.scale
        if self.levels is not None:
            data["levels"] = self.levels.to_json()
        return data if self.alpha == "white" else {**data, "alpha": self.alpha}


def _check_inside(source: str) -> None:
    """Refuse a name that does not lie beside the lesson or below it, on any system."""
    path = PurePosixPath(source)
    if path.is_absolute() or ".." in path.parts or "\\" in source or ":" in source:
        raise LessonError(
            f"source: must be gallery:NAME or a file beside the lesson or below it, got {shorten(source)}."
        )


def _crop(data: object) -> Crop:
    fields = Fields(data, ("top", "left", "height", "width"))
    top, left = fields.whole("top", 0, 0, _MAX_SIDE), fields.whole("left", 0, 0, _MAX_SIDE)
    return Crop(top, left, fields.whole("height", None, 2, _MAX_SIDE), fields.whole("width", None, 2, _MAX_SIDE))


@dataclass(frozen=True)
class StepColumn:
    """One column of a step.

    Parameters
    ----------
    method
        Id of a registered method.
    parameters
        JSON values by name; those left out take their defaults.
    inputs
        Further pictures by name (the second exemplar of a mixture).
    size
        Its own size; None takes the step's.
    title
        Above its picture; empty takes the method's.
    seed
        Its own; None takes the step's.
    """

    method: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    inputs: Mapping[str, Taken] = field(default_factory=dict)
    size: tuple[int, ...] | None = None
    title: str = ""
    seed: int | None = None

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Read it; the method checks its parameters."""
        fields = Fields(data, ("method", "parameters", "inputs", "size", "title", "seed"))
        name = fields.data.get("method")
        if not isinstance(name, str):
            raise LessonError(f"columns: method must be the id of a method, got {shorten(name)}.")
        method = find_method(name)
        given = fields.data.get("parameters", {})
        if not isinstance(given, dict):
            raise LessonError(f"parameters: must be a JSON object, got {shorten(given)}.")
        complete = method.params.from_json(method.params.completed(given)).to_json()
        kept = loads(dumps({key: complete[key] for key in given}))
        inputs = fields.data.get("inputs", {})
        specs = {spec.name: spec for spec in method.inputs}
        if not isinstance(inputs, dict):
            raise LessonError(f"inputs: must be a JSON object, got {shorten(inputs)}.")
        taken = {}
        for key, each in inputs.items():
            if key not in specs or key == "exemplar" or specs[key].kind != "image":
                others = [spec.name for spec in method.inputs if spec.name != "exemplar" and spec.kind == "image"]
                allowed = f"one of {', '.join(others)}" if others else "none"
                raise LessonError(f"inputs: {method.title} takes {allowed} here, got {shorten(key)}.")
            taken[key] = Taken.from_json(each)
        for spec in method.inputs:
            if spec.required and spec.name not in ("exemplar", *taken):
                raise LessonError(f"inputs: {method.title} needs {spec.name}, and there is none.")
        size = fields.part("size", lambda each: size_from_json(each, method.dimensions))
        seed = check_seed(fields.data["seed"]) if "seed" in fields.data else None
        return cls(
            name, frozen_mapping(kept), frozen_mapping(taken), size, fields.text("title", COLUMN_TITLE), seed
        )

    def params(self) -> Params:
        """Return all its parameters."""
        kind = find_method(self.method).params
        return kind.from_json(kind.completed(self.parameters))

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data."""
        data: dict[str, Any] = {"method": self.method}
        if self.parameters:
            data["parameters"] = dict(self.parameters)
        if self.inputs:
            data["inputs"] = {key: each.to_json() for key, each in self.inputs.items()}
        if self.size is not None:
            data["size"] = size_to_json(self.size)
        if self.title:
            data["title"] = self.title
        return data if self.seed is None else {**data, "seed": self.seed}


@dataclass(frozen=True)
class Series:
    """One parameter of one column at several values."""

    column: int
    parameter: str
    values: tuple[Setting, ...]

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Read it; :meth:`check` holds it against its column."""
        fields = Fields(data, ("column", "parameter", "values"))
        values = tuple(fields.items("values", 2, MAX_VALUES))
        if not all(isinstance(value, bool | int | float | str) for value in values):
            raise LessonError(f"values: must be texts, numbers, true or false, got {shorten(values)}.")
        return cls(fields.whole("column", 0, 0, 7), fields.text("parameter", 60, needed=True), values)

    def check(self, column: StepColumn) -> None:
        """Refuse a parameter or a value that the column's method does not take."""
        names = [each.name for each in describe(find_method(column.method).params)]
        if self.parameter not in names:
            raise LessonError(f"series: {column.method} has no parameter {shorten(self.parameter)}.")
        for value in self.values:
            self.at(column, value)

    def at(self, column: StepColumn, value: Setting) -> StepColumn:
        """Return the column with one of the values."""
        return StepColumn.from_json(
            {**column.to_json(), "parameters": {**column.parameters, self.parameter: value}}
        )

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data."""
        return {"column": self.column, "parameter": self.parameter, "values": list(self.values)}


@dataclass(frozen=True)
class Drawing:
    """A picture of the laboratory; who draws it checks kind and settings."""

    kind: str
    settings: Mapping[str, Setting] = field(default_factory=dict)
    other: Taken | None = None

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Read it."""
        fields = Fields(data, ("kind", "settings", "other"))
        return cls(fields.word("kind"), fields.settings("settings"), fields.part("other", Taken.from_json))

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data."""
        data: dict[str, Any] = {"kind": self.kind}
        if self.settings:
            data["settings"] = dict(self.settings)
        return data if self.other is None else {**data, "other": self.other.to_json()}


@dataclass(frozen=True)
class Tab:
    """A tab of the window, and how its controls stand; the window checks both."""

    name: str
    settings: Mapping[str, Setting] = field(default_factory=dict)

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Read it; a text alone is a name."""
        fields = Fields({"name": data} if isinstance(data, str) else data, ("name", "settings"))
        return cls(fields.word("name"), fields.settings("settings"))

    def to_json(self) -> dict[str, Any] | str:
        """Return it as JSON data."""
        return {"name": self.name, "settings": dict(self.settings)} if self.settings else self.name


@dataclass(frozen=True)
class Place:
    """A pixel of a column's result."""

    column: int
    row: int
    x: int

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Read it."""
        fields = Fields(data, ("column", "x", "y"))
        row, x = fields.whole("y", None, 0, _MAX_SIDE), fields.whole("x", None, 0, _MAX_SIDE)
        return cls(fields.whole("column", 0, 0, 7), row, x)

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data."""
        return {"column": self.column, "x": self.x, "y": self.row}


@dataclass(frozen=True)
class Shown:
    """How the pictures are shown: screen pixels per pixel (None fits them), its middle, repeated 2 x 2 or not."""

    zoom: float | None = None
    x: float = 0.0
    y: float = 0.0
    tile: bool = False

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Read it."""
        fields = Fields(data, ("zoom", "x", "y", "tile"))
        zoom = fields.number("zoom", None, 0.05, 64) if "zoom" in fields.data else None
        x, y = fields.number("x", 0.0, 0, _MAX_SIDE), fields.number("y", 0.0, 0, _MAX_SIDE)
        return cls(zoom, x, y, fields.switch("tile"))

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data."""
        data: dict[str, Any] = {} if self.zoom is None else {"zoom": self.zoom, "x": self.x, "y": self.y}
        return {**data, "tile": True} if self.tile else data
