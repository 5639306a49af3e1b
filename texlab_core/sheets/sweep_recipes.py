"""Sweeps as versioned JSON."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from texlab_core.documents.recipe import known_measures, measures_from_json
from texlab_core.engine.inputs import Crop, ImageInput, exemplar_of
from texlab_core.engine.job import Job, check_seed
from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_from_json, size_to_json
from texlab_core.errors import InputError, RecipeError
from texlab_core.files import strict_json
from texlab_core.sheets.sweep import MAX_CELLS, Sweep, Vary, check_knob, spread
from texlab_core.sheets.texture_grid import TextureGrid, texture_grid

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab_core.engine.inputs import Input
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method
    from texlab_core.sheets.sweep import Cell
    from texlab_core.sheets.texture_grid import LeftOut

FORMAT = "texlab-sweep"
# Version 1 has no textures, and is what is written where there are none.
VERSION = 2
TEXT_KEY = "texlab-sweep"
_KEYS = (
    "format",
    "version",
    "name",
    "note",
    "method",
    "parameters",
    "vary",
    "size",
    "seed",
    "exemplar",
    "inputs",
    "measures",
    "textures",
    "versions",
)
_Data = dict[str, Any]


@dataclass(frozen=True)
class ExemplarChoice:
    """Which exemplar a sweep was made for.

    Parameters
    ----------
    name
        "gallery:NAME", or the name of a file.
    scale, crop
        How it was taken from its source.
    sha256
        Hash of its pixels, where that is known.
    """

    name: str
    scale: float = 1.0
    crop: Crop | None = None
    sha256: str = ""

    @classmethod
    def of(cls, exemplar: ImageInput) -> ExemplarChoice:
        """Describe an exemplar."""
        origin = exemplar.origin
        if origin is None:
            return cls(exemplar.name, sha256=exemplar.sha256)
        return cls(exemplar.name, origin.scale, origin.crop, exemplar.sha256)

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data, without what it does not say."""
        return {key: value for key, value in dataclasses.asdict(self).items() if value not in (None, "")}

    def load(self) -> ImageInput:
        """Return the exemplar; raises ``InputError`` when it cannot be read, or has another hash."""
        from texlab_core.images.exemplar import as_exemplar

        found = as_exemplar(self.name, scale=self.scale, crop=self.crop)
        if self.sha256 not in ("", found.sha256):
            raise RecipeError(f"{self.name} is not the image that the sweep was made with; name the one to use.")
        return found


@dataclass(frozen=True, kw_only=True)
class SweepRecipe:
    """A sweep without its exemplar's pixels.

    Parameters
    ----------
    name
        For lists and for ``--recipe``.
    method
        Id of a registered method.
    axes
        One or two knobs and their values; none or one beside textures.
    parameters
        JSON values of the knobs that differ from the defaults in every cell.
    note
        What it shows.
    size
        Height and width (or depth, height and width) of the cells; None takes the exemplar's.
    seed
        Of every cell, unless it is varied.
    exemplar
        What it was made for; None leaves the choice to the user.
    inputs
        The further images of the method by their names.
    measures
        Of a sheet: numbers about each cell's result by the ids of their measures, row by row; nothing for a cell
        that failed or was not run. Empty for a sweep that is still to be run.
    textures
        What runs across in a grid over many textures, which has no more than one knob down; empty for a sweep of
        one exemplar.
    """

    name: str
    method: str
    axes: tuple[Vary, ...] = ()
    parameters: Mapping[str, Any] = field(default_factory=dict)
    note: str = ""
    size: tuple[int, ...] | None = None
    seed: int = 0
    exemplar: ExemplarChoice | None = None
    inputs: Mapping[str, ExemplarChoice] = field(default_factory=dict)
    measures: tuple[Mapping[str, float], ...] = ()
    textures: tuple[ExemplarChoice, ...] = ()

    @property
    def params(self) -> Params:
        """The parameters that all cells share, but for the varied ones."""
        return find_method(self.method).params.from_json(self.parameters)

    def sweep(self, exemplar: ImageInput | None = None, given: Mapping[str, Input] | None = None) -> Sweep:
        """Return the sweep over an exemplar (its own when None); inputs that are given stand in for its own.

        Raises
        ------
        InputError
            When there is no exemplar, or the method cannot work with it.
        """
        if exemplar is None and self.textures:
            return self.grid(tuple(each.load() for each in self.textures), given)[0]
        if exemplar is None:
            if self.exemplar is None:
                raise RecipeError(f"The sweep {self.name} does not say for which exemplar; name one.")
            exemplar = self.exemplar.load()
        if not self.axes:
            raise RecipeError(f"The sweep {self.name} varies nothing but the texture.")
        size: Any = self.size
        inputs = {**self._further(given), "exemplar": exemplar}
        return Sweep(
            Job(method=self.method, inputs=inputs, params=self.params, size=size, seed=self.seed), self.axes
        )

    def grid(
        self, textures: Sequence[ImageInput], given: Mapping[str, Input] | None = None
    ) -> tuple[TextureGrid, LeftOut]:
        """Return the grid over these textures, and those that have no place in it; raises ``InputError``."""
        if len(self.axes) > 1:
            raise RecipeError("A grid over textures varies at most one knob, which stands down.")
        return texture_grid(
            textures,
            self.method,
            self.params,
            size=self.size,
            seed=self.seed,
            inputs=self._further(given),
            down=self.axes[0] if self.axes else None,
        )

    def _further(self, given: Mapping[str, Input] | None) -> dict[str, Input]:
        own = {name: choice for name, choice in self.inputs.items() if name not in (given or {})}
        return {name: choice.load() for name, choice in own.items()} | dict(given or {})

    @classmethod
    def of(cls, sweep: Sweep, name: str, note: str = "", cells: Sequence[Cell] = ()) -> SweepRecipe:
        """Describe a sweep, with the numbers about the cells that are given."""
        base = sweep.base
        known = {cell.index: known_measures(cell.measures) for cell in cells if cell.measures}
        textures = sweep.textures if isinstance(sweep, TextureGrid) else ()
        return cls(
            name=name,
            method=base.method,
            axes=sweep.axes[1:] if textures else sweep.axes,
            parameters=base.params.to_json(),
            note=note,
            size=base.size,
            seed=base.seed,
            exemplar=None if textures else ExemplarChoice.of(exemplar_of(base.inputs)),
            textures=tuple(map(ExemplarChoice.of, textures)),
            inputs=frozen_mapping(
                {
                    role: ExemplarChoice.of(each)
                    for role, each in base.inputs.items()
                    if role != "exemplar" and isinstance(each, ImageInput)
                }
            ),
            measures=tuple(frozen_mapping(known.get(index, {})) for index in range(len(sweep.jobs)))
            if known
            else (),
        )

    def to_json(self) -> _Data:
        """Return it as JSON data."""
        version = VERSION if self.textures else 1
        data: _Data = {"format": FORMAT, "version": version, "name": self.name, "note": self.note}
        data |= {"method": self.method, "parameters": dict(self.parameters)}
        data["vary"] = [
            {"name": axis.name, "values": [_plain(each) for each in axis.values]} for axis in self.axes
        ]
        if self.size is not None:
            data["size"] = size_to_json(self.size)
        data["seed"] = self.seed
        if self.exemplar is not None:
            data["exemplar"] = self.exemplar.to_json()
        if self.inputs:
            data["inputs"] = {role: choice.to_json() for role, choice in self.inputs.items()}
        if self.measures:
            data["measures"] = [dict(numbers) for numbers in self.measures]
        if self.textures:
            data["textures"] = [choice.to_json() for choice in self.textures]
        return data


def _plain(value: Any) -> Any:
    return value if isinstance(value, bool | int | float | str) else value.to_json()


def sweep_recipe_from_json(data: object, *, what: str = "the sweep") -> SweepRecipe:
    """Build a recipe from JSON data.

    An axis is ``{"name", "values": [...]}`` or ``{"name", "from", "to", "count", "log": false}``.

    Raises
    ------
    RecipeError
        With one sentence that starts with ``what``.
    """
    try:
        return _from_json(data)
    except InputError as bad:
        raise RecipeError(f"{what[:1].upper()}{what[1:]} cannot be used: {bad}") from bad


def _from_json(given: object) -> SweepRecipe:
    data = strict_json.check_document(given, "sweep", form=FORMAT, version=VERSION, error=RecipeError)
    strict_json.check_keys(data, _KEYS, RecipeError)
    method = find_method(_typed(data, "method", str))
    parameters = _typed(data, "parameters", dict, {})
    named = method.params.completed(parameters)
    complete = method.params.from_json(named).to_json()
    vary, textures = _typed(data, "vary", list), _typed(data, "textures", list, [])
    if textures and len(vary) > 1:
        raise RecipeError(f"vary: must hold at most one knob beside textures, got {len(vary)}.")
    if not textures and not 1 <= len(vary) <= 2:
        raise RecipeError(f"vary: must hold one or two knobs, got {len(vary)}.")
    axes = tuple(_axis(each, method.params) for each in vary)
    cells = max(len(textures), 1) * math.prod(len(axis.values) for axis in axes)
    if len(textures) > MAX_CELLS:
        raise RecipeError(f"textures: must hold at most {MAX_CELLS}, got {len(textures)}.")
    return SweepRecipe(
        name=_text(data, "name", 80),
        method=method.id,
        axes=axes,
        parameters=frozen_mapping({name: complete[name] for name in named}),
        note=_text(data, "note", 4000, ""),
        size=None if data.get("size") is None else size_from_json(data["size"], method.dimensions),
        seed=check_seed(data.get("seed", 0)),
        exemplar=_exemplar(data.get("exemplar")),
        inputs=_inputs(data.get("inputs", {}), method),
        measures=_measures(_typed(data, "measures", list, []), cells),
        textures=tuple(_choice(each, "textures") for each in textures),
    )


def _typed(data: _Data, key: str, kind: type[Any], default: Any = None) -> Any:
    value = data.get(key, default)
    if not isinstance(value, kind):
        noun = {"str": "text", "dict": "a JSON object", "list": "a list"}[kind.__name__]
        raise RecipeError(f"{key}: must be {noun}, got {strict_json.shorten(value)}.")
    return value


def _text(data: _Data, key: str, longest: int, default: str | None = None) -> str:
    value: str = _typed(data, key, str, default)
    if len(value) > longest or not value.replace("\n", "").isprintable():
        raise RecipeError(
            f"{key}: must be at most {longest} printable characters, got {strict_json.shorten(value)}."
        )
    return value


def _axis(data: object, params: type[Params]) -> Vary:
    if not isinstance(data, dict):
        raise RecipeError(f"vary: must hold JSON objects, got {strict_json.shorten(data)}.")
    name = _typed(data, "name", str)
    if set(data) == {"name", "values"}:
        return Vary.of(name, data["values"], params)
    if not {"from", "to", "count"} <= set(data) <= {"name", "from", "to", "count", "log"}:
        raise RecipeError(f"vary: {name} must have either values or from, to, count and log.")
    if not isinstance(log := data.get("log", False), bool):
        raise RecipeError(f"vary: log must be true or false, got {strict_json.shorten(log)}.")
    knob = check_knob(name, params, number=True)
    return Vary(name, spread(knob, knob.check(data["from"]), knob.check(data["to"]), data["count"], log=log))


def _inputs(data: object, method: Method) -> Mapping[str, ExemplarChoice]:
    images = {spec.name for spec in method.inputs if spec.kind == "image"} - {"exemplar"}
    if not isinstance(data, dict) or not set(data) <= images:
        named = f"may name {', '.join(sorted(images))}" if images else "has no place here"
        raise RecipeError(f"inputs: {named} for {method.title}, got {strict_json.shorten(data)}.")
    return frozen_mapping({role: _choice(each, role) for role, each in data.items()})


def _measures(data: list[Any], cells: int) -> tuple[Mapping[str, float], ...]:
    if len(data) not in (0, cells):
        raise RecipeError(f"measures: must hold the numbers of {cells} cells, got {len(data)}.")
    return tuple(measures_from_json(each) for each in data)


def _exemplar(data: object) -> ExemplarChoice | None:
    return None if data is None else _choice(data, "exemplar")


def _choice(data: object, role: str) -> ExemplarChoice:
    if not isinstance(data, dict) or not {"name"} <= set(data) <= {"name", "scale", "crop", "sha256"}:
        raise RecipeError(f"{role}: must hold a name, got {strict_json.shorten(data)}.")
    scale = data.get("scale", 1.0)
    if isinstance(scale, bool) or not isinstance(scale, int | float) or not 0 < scale <= 1:
        raise RecipeError(
            f"{role}: scale must be a number above 0 and at most 1, got {strict_json.shorten(scale)}."
        )
    sha256 = _text(data, "sha256", 64, "")
    return ExemplarChoice(_text(data, "name", 4096), float(scale), _crop(data.get("crop"), role), sha256)


def _crop(data: object, role: str) -> Crop | None:
    if data is None:
        return None
    keys = [each.name for each in dataclasses.fields(Crop)]
    if not isinstance(data, dict) or set(data) != set(keys) or any(type(data[key]) is not int for key in keys):
        raise RecipeError(f"{role}: crop must hold {', '.join(keys)}, got {strict_json.shorten(data)}.")
    return Crop(**data)
