"""Presets: named parameters of one method as versioned JSON, and the folder that keeps a user's own."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from texlab_core.engine.params import describe, frozen_mapping
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.whole import write_whole
from texlab_core.files.wording import did_you_mean

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.params import Params

FORMAT = "texlab-preset"
VERSION = 1
MAX_NAME = 60
MAX_NOTE = 4000
_KEYS = ("format", "version", "name", "note", "method", "parameters", "exemplar")


class PresetError(InputError):
    """A preset that is malformed, unknown, or in the way of another one."""


@dataclass(frozen=True)
class ExemplarRef:
    """The exemplar a preset was made for: its name for people, and the SHA-256 of its pixels."""

    name: str
    sha256: str

    def __post_init__(self) -> None:
        _check_text("exemplar name", self.name, 300)
        if not re.fullmatch(r"[0-9a-f]{64}", self.sha256):
            raise PresetError("exemplar: its sha256 must be 64 hexadecimal digits.")


@dataclass(frozen=True, kw_only=True)
class Preset:
    """Some or all parameters of one method, under a name.

    Parameters
    ----------
    name
        1 .. 60 printable characters, no slashes; unique within a method, without regard to case.
    method
        Id of a registered method.
    parameters
        JSON values by the names of the method's ``Params``; those left out stay as they are.
    note
        What it is good for; free text.
    exemplar
        What it was made for.

    Raises
    ------
    InputError
        Naming what does not fit: the name, the method, or a parameter that is unknown or out of range.
    """

    name: str
    method: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    note: str = ""
    exemplar: ExemplarRef | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", check_name(self.name))
        _check_text("note", self.note, MAX_NOTE, empty=True, lines=True)
        method = find_method(self.method)
        # Building them checks every value and every combination; what was left out takes its default here.
        named = method.params.completed(self.parameters)
        complete = method.params.from_json(named).to_json()
        # Copied through text: neither the caller nor a reader can change the preset afterwards.
        given = strict_json.loads(strict_json.dumps({name: complete[name] for name in named}))
        object.__setattr__(self, "parameters", frozen_mapping(given))

    @classmethod
    def of(
        cls, name: str, method: str, params: Params, *, note: str = "", exemplar: ImageInput | None = None
    ) -> Self:
        """Make a preset of all the parameters of a job."""
        made_for = None if exemplar is None else ExemplarRef(exemplar.name, exemplar.sha256)
        return cls(name=name, method=method, parameters=params.to_json(), note=note, exemplar=made_for)

    @property
    def key(self) -> tuple[str, str]:
        """What makes it unique: the method, and the name without regard to case."""
        return self.method, self.name.casefold()

    def params(self, base: Params | None = None) -> Params:
        """Return ``base`` (the method's defaults) with this preset's values.

        Raises
        ------
        ParamError
            When a value does not go with one of ``base``.
        """
        kind = find_method(self.method).params
        if base is not None and type(base) is not kind:
            raise PresetError(f"The preset {self.name} is for {find_method(self.method).title}.")
        fields = {each.name: each for each in describe(kind)}
        values = {name: fields[name].check(value) for name, value in self.parameters.items()}
        return (kind() if base is None else base).replace(**values)

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data."""
        data: dict[str, Any] = {"format": FORMAT, "version": VERSION, "name": self.name, "note": self.note}
        data |= {"method": self.method, "parameters": dict(self.parameters)}
        if self.exemplar is not None:
            data["exemplar"] = {"name": self.exemplar.name, "sha256": self.exemplar.sha256}
        return data


def check_name(name: Any) -> str:
    """Return a preset's name with its characters composed (NFC).

    Raises
    ------
    PresetError
        When it is empty, longer than 60 characters, holds slashes or characters that cannot be seen, or starts or
        ends with a space or a full stop.
    """
    composed: str = unicodedata.normalize("NFC", name) if isinstance(name, str) else name
    _check_text("The name of a preset", composed, MAX_NAME)
    if any(sign in composed for sign in "/\\") or composed != composed.strip(" ."):
        raise PresetError(
            "The name of a preset can hold no slash (/ or \\) and neither begin nor end with a space or a full "
            f"stop; \u201c{composed}\u201d does."
        )
    return composed


def _check_text(what: str, given: Any, longest: int, *, empty: bool = False, lines: bool = False) -> None:
    seen = given.replace("\n", "").replace("\t", "") if lines and isinstance(given, str) else given
    if not isinstance(given, str) or len(given) > longest or not (given or empty) or not seen.isprintable():
        allowed = f"{'at most' if empty else '1 to'} {longest} printable characters"
        raise PresetError(f"{what} must be {allowed}, got {strict_json.shorten(given)}.")


def preset_from_json(data: object, *, what: str = "the preset") -> Preset:
    """Build a preset from JSON data.

    Raises
    ------
    PresetError
        With one sentence that starts with ``what``.
    """
    try:
        return _from_json(data)
    except InputError as bad:
        raise PresetError(f"{what[:1].upper()}{what[1:]} cannot be used: {bad}") from bad


def _from_json(given: object) -> Preset:
    data = strict_json.check_document(given, "preset", form=FORMAT, version=VERSION, error=PresetError)
    strict_json.check_keys(data, _KEYS, PresetError)
    for key in ("name", "method", "parameters"):
        if key not in data:
            raise PresetError(f"{key}: is missing.")
    if not isinstance(data["method"], str):
        raise PresetError(f"method: must be the id of a method, got {strict_json.shorten(data['method'])}.")
    if not isinstance(data["parameters"], dict):
        raise PresetError(f"parameters: must be a JSON object, got {strict_json.shorten(data['parameters'])}.")
    return Preset(
        name=data["name"],
        method=data["method"],
        parameters=data["parameters"],
        note=data.get("note", ""),
        exemplar=_exemplar_from_json(data.get("exemplar")),
    )


def _exemplar_from_json(data: object) -> ExemplarRef | None:
    if data is None:
        return None
    if not isinstance(data, dict) or set(data) != {"name", "sha256"} or not isinstance(data["sha256"], str):
        raise PresetError(f"exemplar: must hold a name and a sha256, got {strict_json.shorten(data)}.")
    return ExemplarRef(data["name"], data["sha256"])


def read_preset(source: Path | str | bytes, *, what: str | None = None) -> Preset:
    """Read a preset from a file (a ``Path``) or from its text.

    Raises
    ------
    PresetError
        With one sentence when it cannot be read, is malformed, newer or hostile.
    """
    data, name = strict_json.read(source, "the preset", what=what, error=PresetError)
    return preset_from_json(data, what=name)


def write_preset(preset: Preset, path: str | os.PathLike[str], *, replace: bool = True) -> None:
    """Write a preset under a temporary name, then rename.

    Raises
    ------
    PresetError
        When it cannot be written, its folder does not exist, or it is there and ``replace`` is false.
    """
    target = Path(path)
    if not replace and (target.exists() or target.is_symlink()):
        raise PresetError(f"The file {path} is there already.")
    if not target.parent.is_dir():
        raise PresetError(f"The folder {target.parent} does not exist.")
    try:
        write_whole(target, strict_json.dumps(preset.to_json()).encode())
    except InputError as bad:
        raise PresetError(str(bad)) from bad


def pick(presets: tuple[Preset, ...], name: str, method: str | None = None) -> Preset:
    """Return the preset with this name (``paper``) or method and name (``de-bonet/paper``).

    Parameters
    ----------
    presets
        Where to look; the first of several with the same method and name counts.
    name
        Without regard to case.
    method
        Look among this method's presets only.

    Raises
    ------
    PresetError
        When there is none, or several methods have one of this name.
    """
    before, slash, after = name.partition("/")
    if before and slash:
        method, name = before, after
    among = {each.key: each for each in reversed(presets) if method is None or each.method == method}
    folded = unicodedata.normalize("NFC", name).casefold()
    found = [each for each in among.values() if each.name.casefold() == folded]
    of_method = "" if method is None else f" of {method}"
    if len(found) > 1:
        listed = " or ".join(sorted(f"{each.method}/{each.name}" for each in found))
        raise PresetError(f"Several methods have a preset called {found[0].name}: say {listed}.")
    if not found:
        names = sorted({each.name for each in among.values()})
        hint = did_you_mean(name, names) or f"there are {', '.join(names[:12]) or 'none'}"
        raise PresetError(f"There is no preset{of_method} called {strict_json.shorten(name)} ({hint}).")
    return found[0]
