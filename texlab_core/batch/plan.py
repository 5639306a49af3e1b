"""What a batch shall do, as versioned data: exemplars x methods x seeds x sizes. A plan holds no code."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from texlab_core.batch.choices import ExemplarChoice, choices_of
from texlab_core.batch.further import Further, further_of
from texlab_core.documents.preset_store import PresetStore, find_preset
from texlab_core.engine.job import check_seed
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import check_size, default_size, size_from_text
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.regular import read_regular, reason
from texlab_core.files.resources import resource
from texlab_core.measures.registry import find_measure, measures

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab_core.engine.params import Params
    from texlab_core.images.formats.writing import Bits

FORMAT = "texlab-batch"
VERSION = 1
BUNDLED = "gallery:"
MAX_JOBS = 100_000
_MAX_LIST = 10_000
_BITS: Mapping[int, Bits] = {8: 8, 16: 16}
_KEYS = ("format", "version", "name", "note", "inputs", "methods", "presets", "seeds", "sizes", "bits", "measures")


class PlanError(InputError):
    """A plan that is malformed or cannot be followed."""


@dataclass(frozen=True)
class Variant:
    """A method with its parameters and further inputs, under a name that is unique in its plan."""

    name: str
    method: str
    params: Params
    inputs: Further = ()


@dataclass(frozen=True)
class SizeRule:
    """The size of a result: fixed, or the exemplar's sides times a factor.

    Parameters
    ----------
    text
        ``WxH``, ``WxHxD`` for solids, one number for all sides, or a factor as in ``2x``.
    """

    text: str

    def __post_init__(self) -> None:
        self.of((2, 2))

    def of(self, exemplar: tuple[int, int], dimensions: int = 2) -> tuple[int, ...]:
        """Return the size of a result of so many dimensions for an exemplar of this height and width."""
        if re.fullmatch(r"[0-9]{1,9}(?:[xX×][0-9]{1,9}){0,2}", self.text):
            sides = len(re.split("[xX×]", self.text))
            return size_from_text(self.text, dimensions if sides == 1 else sides, "sizes")
        if factor := re.fullmatch(r"([0-9]{1,4}(?:\.[0-9]{1,6})?)x", self.text):
            times = float(factor[1])
            if times > 0:
                own = default_size(exemplar, dimensions)
                return check_size(tuple(max(1, round(side * times)) for side in own), dimensions)
        raise PlanError(
            "sizes: must be width and height as in 256x192 (and depth for a solid), one number for all sides, or "
            "a factor of the exemplar's sides as in 2x, "
            f"got {strict_json.shorten(self.text)}."
        )


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A checked plan.

    Parameters
    ----------
    exemplars
        What to work on, in order; nothing of it has been read yet.
    variants
        Methods with their parameters.
    seeds, sizes
        Every exemplar and variant takes each of them.
    name, note
        For people.
    bits
        8 or 16 for each sample of the pictures.
    measures
        Ids of what is measured in each result; None measures what costs next to nothing.

    Raises
    ------
    PlanError
        When one of the lists is empty, or there are more than 100,000 jobs.
    """

    exemplars: tuple[ExemplarChoice, ...]
    variants: tuple[Variant, ...]
    seeds: tuple[int, ...] = (0,)
    sizes: tuple[SizeRule, ...] = (SizeRule("1x"),)
    name: str = "batch"
    note: str = ""
    bits: Bits = 8
    measures: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        for field in ("exemplars", "variants", "seeds", "sizes"):
            if not getattr(self, field):
                raise PlanError(f"{field}: at least one is needed.")
        if self.count > MAX_JOBS:
            raise PlanError(f"A plan has at most {MAX_JOBS} jobs, got {self.count}.")

    @property
    def count(self) -> int:
        """How many jobs there are."""
        return math.prod(len(each) for each in (self.exemplars, self.variants, self.seeds, self.sizes))

    def sample(self, count: int) -> frozenset[int]:
        """Return the places of ``count`` jobs that are spread evenly over all of them."""
        if count < 1:
            raise PlanError(f"sample: must be a whole number of at least 1, got {count}.")
        few = min(count, self.count)
        return frozenset(place * self.count // few for place in range(few))


def find_plan(source: str, *, presets: PresetStore | None = None) -> Plan:
    """Return the plan in a file (``.json`` or ``.toml``), or one that comes with the program (``gallery:NAME``).

    Raises
    ------
    PlanError
        With one sentence when it cannot be read or followed.
    """
    if source.startswith(BUNDLED):
        name = source.removeprefix(BUNDLED)
        if name not in bundled_plans():
            raise PlanError(
                f"There is no plan called {source}; there are {', '.join(map(_uri, bundled_plans()))}."
            )
        text = resource(f"batches/{name}.json").read_bytes()
        data = strict_json.loads(text, what=f"the plan {source}", error=PlanError)
        return plan_from_json(data, folder=Path(), what=f"the plan {source}", presets=presets)
    return read_plan(source, presets=presets)


def bundled_plans() -> tuple[str, ...]:
    """Return the names of the plans that come with the program."""
    return tuple(
        sorted(Path(each.name).stem for each in resource("batches").iterdir() if each.name.endswith(".json"))
    )


def _uri(name: str) -> str:
    return BUNDLED + name


def read_plan(path: str | Path, *, presets: PresetStore | None = None) -> Plan:
    """Read a plan; the paths in it are relative to its folder.

    Raises
    ------
    PlanError
        With one sentence when it cannot be read or followed.
    """
    file, what = Path(path), f"the plan {path}"
    if file.suffix.lower() not in (".json", ".toml"):
        raise PlanError(f"A plan is a .json or .toml file, or gallery:NAME, got {strict_json.shorten(str(path))}.")
    if file.suffix.lower() == ".json":
        data = strict_json.load(file, what=what, error=PlanError)
    else:
        data = _load_toml(file, what)
    plan = plan_from_json(data, folder=file.parent, what=what, presets=presets)
    return plan if isinstance(data, dict) and "name" in data else replace(plan, name=file.stem)


def _load_toml(file: Path, what: str) -> Any:
    import json
    import tomllib

    try:
        source = read_regular(file, strict_json.MAX_BYTES)
        found = tomllib.loads(source.decode("utf-8-sig"))
    except OSError as bad:
        raise PlanError(f"T{what[1:]} cannot be read ({reason(bad)}).") from bad
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as bad:
        raise PlanError(f"T{what[1:]} is not valid TOML ({str(bad).rstrip('.')}).") from bad
    try:
        # The same limits as for JSON: depth, finite numbers, no dates.
        return strict_json.loads(json.dumps(found, allow_nan=False), what=what, error=PlanError)
    except (TypeError, ValueError) as bad:
        if isinstance(bad, PlanError):
            raise
        raise PlanError(f"T{what[1:]} holds a value that no plan has ({bad}).") from bad


def plan_from_json(
    data: object, *, folder: Path, what: str = "the plan", presets: PresetStore | None = None
) -> Plan:
    """Make a plan of JSON data.

    Parameters
    ----------
    data
        An object with ``inputs``, ``methods`` or ``presets`` or both, and perhaps ``seeds`` (default ``[0]``),
        ``sizes`` (``["1x"]``), ``measures``, ``name``, ``note``, ``bits``, ``format`` and ``version``.
    folder
        What relative paths are relative to.
    what
        How messages call it.
    presets
        Where a user's own presets are; those of the program are always known.

    Raises
    ------
    PlanError
        With one sentence that says what does not fit.
    """
    try:
        return _plan(data, folder, presets)
    except InputError as bad:
        raise PlanError(f"{what[:1].upper()}{what[1:]} cannot be followed: {bad}") from bad


def _plan(data: object, folder: Path, presets: PresetStore | None) -> Plan:
    if not isinstance(data, dict):
        raise PlanError("it must be an object with inputs, methods, seeds and sizes.")
    if "format" in data or "version" in data:
        strict_json.check_document(data, "batch plan", form=FORMAT, version=VERSION, error=PlanError)
    strict_json.check_keys(data, _KEYS, PlanError)
    if "inputs" not in data:
        raise PlanError("inputs: is missing.")
    if "methods" not in data and "presets" not in data:
        raise PlanError("methods: is missing, and there are no presets either.")
    variants = [_of_method(each, folder) for each in _list(data, "methods")]
    variants += [_of_preset(each, folder, presets) for each in _list(data, "presets")]
    bits = data.get("bits", 8)
    if type(bits) is not int or bits not in _BITS:
        raise PlanError(f"bits: must be 8 or 16, got {strict_json.shorten(bits)}.")
    return Plan(
        exemplars=choices_of(_list(data, "inputs"), folder),
        variants=_named_apart(variants),
        seeds=_seeds(data.get("seeds", [0])),
        sizes=tuple(SizeRule(_size_text(each)) for each in _distinct(_list(data, "sizes", ["1x"]))),
        name=_text(data.get("name", "batch"), "name"),
        note=_text(data.get("note", ""), "note"),
        bits=_BITS[bits],
        measures=_measures(data.get("measures")),
    )


def _measures(given: object) -> tuple[str, ...] | None:
    if given in (None, "quick"):
        return None
    if given == "all":
        return tuple(each.id for each in measures().values() if not each.slow)
    if not isinstance(given, list) or not all(isinstance(each, str) for each in given):
        raise PlanError(f"measures: must be quick, all, or a list of ids, got {strict_json.shorten(given)}.")
    return tuple(find_measure(each).id for each in _distinct(given))


def _list(data: dict[str, Any], key: str, default: Sequence[object] = ()) -> list[Any]:
    found = data.get(key, default)
    if isinstance(found, str | dict):
        found = [found]
    if not isinstance(found, list | tuple) or len(found) > _MAX_LIST:
        raise PlanError(f"{key}: must be a list of at most {_MAX_LIST} entries, got {strict_json.shorten(found)}.")
    if key in data and not found:
        raise PlanError(f"{key}: at least one is needed.")
    return list(found)


def _size_text(given: object) -> str:
    """Return a size as text; one number is one for all sides."""
    number = isinstance(given, int) and not isinstance(given, bool)
    return str(given) if number else _text(given, "sizes")


def _text(given: object, key: str) -> str:
    if not isinstance(given, str) or len(given) > 4000:
        raise PlanError(f"{key}: must be a text, got {strict_json.shorten(given)}.")
    return given


def _of_method(given: object, folder: Path) -> Variant:
    entry = {"method": given} if isinstance(given, str) else given
    if not isinstance(entry, dict) or "method" not in entry:
        raise PlanError(
            'methods: must hold ids of methods, or objects as in {"method": "de-bonet", "set": {"alpha": 0.2}}, '
            f"got {strict_json.shorten(given)}."
        )
    strict_json.check_keys(entry, ("method", "set", "inputs", "name"), PlanError)
    method = find_method(entry["method"])
    settings = entry.get("set", {})
    if not isinstance(settings, dict):
        raise PlanError(f"set: must be an object, got {strict_json.shorten(settings)}.")
    inputs = further_of(entry.get("inputs", {}), method, folder)
    changed = [f"{name} {strict_json.shorten(value)}" for name, value in settings.items()]
    return Variant(_name(entry, method.id, changed, inputs), method.id, method.params.from_json(settings), inputs)


def _of_preset(given: object, folder: Path, presets: PresetStore | None) -> Variant:
    entry = {"preset": given} if isinstance(given, str) else given
    if not isinstance(entry, dict) or "preset" not in entry:
        raise PlanError(
            'presets: must hold names or objects as in {"preset": "mixture/half", "inputs": {"second": "a.png"}}, '
            f"got {strict_json.shorten(given)}."
        )
    strict_json.check_keys(entry, ("preset", "inputs", "name"), PlanError)
    name = _text(entry["preset"], "presets")
    if name.lower().endswith(".json"):
        name = str(folder / name)
    preset = find_preset(name, PresetStore(folder / ".none") if presets is None else presets)
    method = find_method(preset.method)
    inputs = further_of(entry.get("inputs", {}), method, folder)
    return Variant(
        _name(entry, f"{preset.method}/{preset.name}", [], inputs), preset.method, preset.params(), inputs
    )


def _name(entry: dict[str, Any], what: str, changed: list[str], inputs: Further) -> str:
    """Return how a variant is called: as the plan says, or after what it does."""
    if entry.get("name"):
        return _text(entry["name"], "name")
    more = [*changed, *(f"{role} {each.name}" for role, each in inputs)]
    return f"{what} ({', '.join(more)})" if more else what


def _named_apart(variants: list[Variant]) -> tuple[Variant, ...]:
    taken: dict[str, Variant] = {}
    for each in variants:
        if each.name in taken:
            raise PlanError(f"methods: {each.name} is there twice; give one of them another name.")
        taken[each.name] = each
    return tuple(taken.values())


def _seeds(given: object) -> tuple[int, ...]:
    if isinstance(given, dict):
        strict_json.check_keys(given, ("from", "count"), PlanError)
        first, count = check_seed(given.get("from", 0)), given.get("count")
        if type(count) is not int or not 1 <= count <= MAX_JOBS:
            raise PlanError(f"seeds: count must be a whole number from 1, got {strict_json.shorten(count)}.")
        check_seed(first + count - 1)
        return tuple(range(first, first + count))
    if not isinstance(given, list) or not 0 < len(given) <= _MAX_LIST:
        raise PlanError(
            'seeds: must be a list of whole numbers, or an object as in {"from": 1, "count": 5}, '
            f"got {strict_json.shorten(given)}."
        )
    return tuple(_distinct([check_seed(each) for each in given]))


def _distinct(values: list[Any]) -> list[Any]:
    return [value for place, value in enumerate(values) if value not in values[:place]]
