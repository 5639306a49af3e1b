"""The further inputs of a method in a plan: a second texture, a mask, a code, a state; each read once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab_core.batch.choices import crop_of, scale_of
from texlab_core.engine.inputs import ArraysInput, DataInput, ImageInput, Input
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.images.gallery import PREFIX, find_entry
from texlab_core.images.named_input import read_input, spec_of

if TYPE_CHECKING:
    from pathlib import Path

    from texlab_core.engine.inputs import Crop
    from texlab_core.engine.registry import InputSpec, Method


@dataclass(frozen=True, slots=True)
class InputChoice:
    """One further input, not read yet.

    Parameters
    ----------
    role
        Its name in the method.
    source
        Path of a file, or ``gallery:NAME``.
    name
        How the plan calls it.
    scale, crop
        What is taken of an image.
    """

    role: str
    source: str
    name: str
    scale: float = 1.0
    crop: Crop | None = None

    def load(self, spec: InputSpec) -> Input:
        """Read it; raises ``InputError``."""
        try:
            return read_input(self.source, spec, scale=self.scale, crop=self.crop)
        except InputError as bad:
            raise InputError(str(bad).replace(self.source, self.name)) from bad


Further = tuple[tuple[str, InputChoice | Input], ...]


def further_of(given: object, method: Method, folder: Path) -> Further:
    """Return the further inputs of a method as a plan names them.

    Parameters
    ----------
    given
        By name: a file, ``gallery:NAME``, an object as in ``{"from": "wall.jpg", "scale": 0.5, "crop":
        "128x128+0+0"}``, or (from Python) an input that was read already.
    method
        Whose they are.
    folder
        What relative paths are relative to.

    Raises
    ------
    InputError
        When the method has no such input, needs one that is not named, or a file is not there.
    """
    if not isinstance(given, dict):
        raise InputError(
            'inputs: must be an object as in {"second": "gallery:stochastic-rock"} for a method, '
            f"got {strict_json.shorten(given)}."
        )
    found = tuple((role, _choice(role, each, method, folder)) for role, each in given.items())
    for spec in method.inputs:
        if spec.required and spec.name != "exemplar" and spec.name not in given:
            raise InputError(
                f'{method.title} needs the input {spec.name}: {{"method": "{method.id}", "inputs": '
                f'{{"{spec.name}": "FILE"}}}}.'
            )
    return found


def _choice(role: str, given: Any, method: Method, folder: Path) -> InputChoice | Input:
    if role == "exemplar":
        raise InputError("inputs: the exemplars stand in the plan's own inputs, not in those of a method.")
    spec_of(method, role)
    if isinstance(given, ImageInput | DataInput | ArraysInput):
        return given
    entry = {"from": given} if isinstance(given, str) else given
    if not isinstance(entry, dict) or not isinstance(entry.get("from"), str) or not entry["from"]:
        raise InputError(
            f'inputs: {role} must be a file, gallery:NAME or an object as in {{"from": "a.jpg", "scale": 0.5}}, '
            f"got {strict_json.shorten(given)}."
        )
    strict_json.check_keys(entry, ("from", "scale", "crop"))
    name: str = entry["from"]
    if name.startswith(PREFIX):
        source = find_entry(name).uri
    elif "\0" not in name and (folder / name).is_file():
        source = str(folder / name)
    else:
        raise InputError(f"inputs: there is no file {strict_json.shorten(name)} for {role}.")
    crop = None if entry.get("crop") is None else crop_of(entry["crop"])
    return InputChoice(role, source, name, scale_of(entry.get("scale", 1.0)), crop)


def load_further(inputs: Further, method: Method) -> dict[str, Input]:
    """Return the inputs by role, read; raises ``InputError``."""
    return {
        role: each.load(spec_of(method, role)) if isinstance(each, InputChoice) else each for role, each in inputs
    }
