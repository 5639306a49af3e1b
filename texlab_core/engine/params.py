"""Parameters declared once: range, unit and help drive the form, the command line, presets and checks."""

from __future__ import annotations

import copyreg
import dataclasses
import inspect
import json
import math
import numbers
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    Literal,
    Protocol,
    Self,
    TypeVar,
    get_args,
    get_origin,
    get_type_hints,
    runtime_checkable,
)
from weakref import WeakKeyDictionary

from texlab_core.errors import ParamError
from texlab_core.files.wording import did_you_mean

if TYPE_CHECKING:
    from collections.abc import Mapping

Stage = Literal["analysis", "synthesis"]
Kind = Literal["int", "float", "bool", "choice", "value"]


@runtime_checkable
class ParamValue(Protocol):
    """A structured parameter (a threshold table, say): immutable, hashable, and made of JSON.

    The form chooses its editor by this type, never by the name of the parameter. A class method ``example()``
    that returns another value than the default lets the checks of ``texlab_core.contract`` try the parameter.
    """

    @classmethod
    def from_json(cls, data: object) -> Self:
        """Build from JSON data; raises ``ValueError`` with one sentence when it does not fit."""
        ...

    def to_json(self) -> object:
        """Return JSON data from which ``from_json`` makes an equal value."""
        ...


@dataclass(frozen=True)
class Knob:
    """What a parameter is, for the form, the command line and the checks.

    Parameters
    ----------
    help
        One sentence: what it does.
    low, high
        Inclusive range of a number.
    unit
        Unit shown after the number.
    label
        Name shown in the form; by default the field's name with spaces.
    step
        Step of the number box and of the arrow keys; by default chosen from the range.
    linear_to
        The slider is linear from ``low`` to here and logarithmic from here to ``high``.
    log
        The slider is logarithmic over the whole range (``low`` > 0).
    odd
        Only odd numbers (window sizes).
    stage
        ``analysis`` when a change makes a new analysis necessary.
    choices
        For a ``Literal``: one short explanation for each choice.
    source
        Where it stands in the paper ("De Bonet 1997, eq. 13").
    group
        Heading under which the form puts it.
    when
        Field name and the values of that field for which this one has an effect.
    formerly
        For a parameter that came later: what documents mean that were written in full before there was one. None
        for a parameter that has been there from the beginning.
    """

    help: str
    low: float | None = None
    high: float | None = None
    unit: str = ""
    label: str = ""
    step: float | None = None
    linear_to: float | None = None
    log: bool = False
    odd: bool = False
    stage: Stage = "synthesis"
    choices: Mapping[str, str] = field(default_factory=dict)
    source: str = ""
    group: str = ""
    when: tuple[str, tuple[object, ...]] | None = None
    formerly: bool | int | float | str | None = None


@dataclass(frozen=True)
class Field:
    """One parameter as ``describe`` reports it."""

    name: str
    kind: Kind
    type: type[Any]
    default: Any
    knob: Knob
    choices: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """The name to show."""
        return self.knob.label or self.name.replace("_", " ")

    @property
    def allowed(self) -> str:
        """What is accepted, in words."""
        low, high = self.knob.low, self.knob.high
        if self.kind == "bool":
            return "true or false"
        if self.kind == "choice":
            return "one of " + ", ".join(self.choices)
        if self.kind == "value":
            return f"a {self.type.__name__}"
        noun = ("an odd whole number" if self.knob.odd else "a whole number") if self.kind == "int" else "a number"
        if low is not None and high is not None:
            return f"{noun} from {low:.10g} to {high:.10g}"
        if low is not None:
            return f"{noun} of at least {low:.10g}"
        if high is not None:
            return f"{noun} of at most {high:.10g}"
        return noun

    def check(self, given: object) -> Any:
        """Return ``given`` as this field stores it.

        Raises
        ------
        ParamError
            When it is of another kind, out of range, not finite, or no known choice.
        """
        if self.kind == "bool":
            # numpy's own is called bool or, before version 2, bool_.
            if isinstance(given, bool) or type(given).__name__ in ("bool", "bool_"):
                return bool(given)
            raise ParamError(self.name, self.allowed, given)
        if self.kind == "choice":
            if isinstance(given, str) and given in self.choices:
                return given
            raise ParamError(self.name, self.allowed, given)
        if self.kind == "value":
            return self._check_value(given)
        return self._check_number(given)

    def _check_value(self, given: object) -> Any:
        if isinstance(given, self.type):
            return given
        try:
            return self.type.from_json(given)
        except ParamError:
            raise
        except (ValueError, TypeError, KeyError, RecursionError) as error:
            reason = str(error).rstrip(".")
            raise ParamError(self.name, f"{self.allowed} ({reason})", given) from error

    def _check_number(self, given: object) -> int | float:
        if isinstance(given, bool) or not isinstance(given, numbers.Real):
            raise ParamError(self.name, self.allowed, given)
        try:
            value = float(given)
        except OverflowError:
            raise ParamError(self.name, self.allowed, given) from None
        low = -math.inf if self.knob.low is None else self.knob.low
        high = math.inf if self.knob.high is None else self.knob.high
        # NaN compares false with everything and so fails here too.
        if not (math.isfinite(value) and low <= value <= high):
            raise ParamError(self.name, self.allowed, given)
        if self.kind == "float":
            return value
        if value != int(value) or (self.knob.odd and int(value) % 2 == 0):
            raise ParamError(self.name, self.allowed, given)
        return int(value)

    def parse(self, text: str) -> Any:
        """Return the value that ``text`` (from the command line) stands for."""
        text = text.strip()
        if self.kind == "choice":
            return self.check(text)
        if self.kind == "bool":
            words = {"true": True, "yes": True, "on": True, "1": True}
            words |= {"false": False, "no": False, "off": False, "0": False}
            return self.check(words.get(text.lower(), text))
        if self.kind == "value":
            try:
                return self.check(json.loads(text))
            except (json.JSONDecodeError, RecursionError):
                raise ParamError(self.name, f"{self.allowed} written as JSON", text) from None
        try:
            return self.check(int(text))
        except ValueError as error:
            if isinstance(error, ParamError):
                raise
        try:
            return self.check(float(text))
        except ValueError as error:
            if isinstance(error, ParamError):
                raise
            raise ParamError(self.name, self.allowed, text) from None


@dataclass(frozen=True, kw_only=True)
class Params:
    """Base of every method's parameters: a frozen dataclass that checks itself.

    Every field is written ``name: Annotated[type, Knob(...)] = default`` with a type of int, float, bool,
    ``Literal[...]`` of strings, or a :class:`ParamValue`.

    Raises
    ------
    ParamError
        On construction, naming the field, what is allowed and what was given.
    """

    def __post_init__(self) -> None:
        for each in describe(type(self)):
            object.__setattr__(self, each.name, each.check(getattr(self, each.name)))
        self.check()

    def check(self) -> None:
        """Check what involves several fields; subclasses raise :class:`ParamError`."""

    def replace(self, **changes: object) -> Self:
        """Return a copy with some fields changed (unknown names raise :class:`ParamError`)."""
        _reject_unknown(type(self), changes)
        return dataclasses.replace(self, **changes)

    def to_json(self) -> dict[str, Any]:
        """Return every field as JSON data."""
        values: dict[str, Any] = {}
        for each in describe(type(self)):
            value = getattr(self, each.name)
            values[each.name] = value.to_json() if each.kind == "value" else value
        return values

    @classmethod
    def from_json(cls, data: Mapping[str, object]) -> Self:
        """Build from JSON data; fields that are left out take their defaults, see :meth:`completed`."""
        return cls(**cls.completed(data))

    @classmethod
    def completed(cls, data: Mapping[str, object]) -> dict[str, Any]:
        """Return JSON data with the values that a document of an earlier version stands for.

        A document that names every parameter that has been there from the beginning was written in full: what it
        lacks did not exist yet, and has the value of :attr:`Knob.formerly`. A document that names some of them
        leaves the others to the defaults, and is returned as it is.

        Raises
        ------
        ParamError
            When a name is unknown.
        """
        _reject_unknown(cls, data)
        fields = describe(cls)
        values: dict[str, Any] = dict(data)
        if all(each.name in values for each in fields if each.knob.formerly is None):
            for each in fields:
                if each.knob.formerly is not None:
                    values.setdefault(each.name, each.knob.formerly)
        return values

    @classmethod
    def parse(cls, settings: Mapping[str, str], base: Self | None = None) -> Self:
        """Build from ``name=value`` texts of the command line, on top of ``base``."""
        _reject_unknown(cls, settings)
        fields = {each.name: each for each in describe(cls)}
        changes = {name: fields[name].parse(text) for name, text in settings.items()}
        return (cls() if base is None else base).replace(**changes)

    def analysis_key(self) -> tuple[tuple[str, object], ...]:
        """Return the fields that the analysis depends on, as a cache key."""
        return tuple(
            (each.name, getattr(self, each.name)) for each in describe(type(self)) if each.knob.stage == "analysis"
        )


ParamsT = TypeVar("ParamsT", bound=Params)


def describe(params: type[Params]) -> tuple[Field, ...]:
    """Describe every parameter of a ``Params`` class, in the order of its declaration.

    Raises
    ------
    TypeError
        When a field has no ``Knob``, no default, or a type that no form could show, or when the class lacks its
        decorator (programming errors).
    """
    if (known := _DESCRIBED.get(params)) is not None:
        return known
    if inspect.get_annotations(params) and "__dataclass_fields__" not in vars(params):
        raise TypeError(
            f"{params.__name__} must be decorated with @dataclass(frozen=True, kw_only=True): without it, its "
            "parameters do not exist."
        )
    hints = get_type_hints(params, include_extras=True)
    fields = []
    for each in dataclasses.fields(params):
        hint = hints[each.name]
        knobs = [extra for extra in get_args(hint)[1:] if isinstance(extra, Knob)]
        if get_origin(hint) is not Annotated or len(knobs) != 1:
            raise TypeError(f"{params.__name__}.{each.name} must be Annotated[type, Knob(...)].")
        if each.default is not dataclasses.MISSING:
            default = each.default
        elif each.default_factory is not dataclasses.MISSING:
            default = each.default_factory()
        else:
            raise TypeError(f"{params.__name__}.{each.name} must have a default.")
        fields.append(_field(params, each.name, get_args(hint)[0], default, knobs[0]))
    return _DESCRIBED.setdefault(params, tuple(fields))


_DESCRIBED: WeakKeyDictionary[type[Params], tuple[Field, ...]] = WeakKeyDictionary()


def _field(params: type[Params], name: str, hint: Any, default: Any, knob: Knob) -> Field:
    if hint in (int, float, bool):
        return Field(name, hint.__name__, hint, default, knob)
    if get_origin(hint) is Literal:
        return Field(name, "choice", str, default, knob, choices=get_args(hint))
    if isinstance(hint, type) and issubclass(hint, ParamValue):
        return Field(name, "value", hint, default, knob)
    raise TypeError(f"{params.__name__}.{name} has a type that cannot be shown: {hint!r}.")


def _reject_unknown(params: type[Params], names: Mapping[str, object]) -> None:
    known = [each.name for each in describe(params)]
    for name in names:
        if name not in known:
            close = did_you_mean(name, known)
            hint = f" ({close})" if close else ""
            listed = ", ".join(known) if known else "nothing, this method has no parameters"
            raise ParamError("parameter name", f"one of {listed}{hint}", name)


def frozen_mapping(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a read-only copy of a mapping, which can be pickled."""
    return MappingProxyType(dict(data))


def _pickled(frozen: MappingProxyType[str, Any]) -> tuple[Any, ...]:
    return frozen_mapping, (dict(frozen),)


# Results travel between processes.
copyreg.pickle(MappingProxyType, _pickled)
