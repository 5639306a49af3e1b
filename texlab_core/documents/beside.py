"""Recipes in files beside what they made, for formats that hold no text: each says which file it belongs to."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from texlab_core.errors import InputError, NoRecipeError
from texlab_core.files import strict_json
from texlab_core.files.whole import write_together

if TYPE_CHECKING:
    import os

MAX_BYTES = 32 * 2**20
MAX_DEPTH = 40

_OF, _BEFORE = "sha256", "before"
_BLOCK = 2**20


def sidecar(path: str | os.PathLike[str]) -> Path:
    """Return where the recipe of a file lies: under its whole name, so that no two files share one."""
    given = Path(path)
    return given.with_name(given.name + ".texlab.json")


def write_with_recipe(path: str | os.PathLike[str], data: bytes, recipe: str) -> None:
    """Write a file and its recipe beside it.

    While the file is replaced, the recipe beside it says what belongs to the old and what to the new one: whenever
    the program ends, the file that is there has its own.

    Raises
    ------
    InputError
        When one of them cannot be written, or something else than a recipe lies there; then both stay as they
        were.
    """
    digest = hashlib.sha256(data).hexdigest()
    beside, meanwhile = sidecar(path), sidecar_bytes(path, recipe, digest)
    new = _packed(json.loads(recipe) | {_OF: digest})
    write_together({Path(path): data, beside: new}, manifest=(beside, meanwhile))


def check_beside(path: str | os.PathLike[str]) -> Path:
    """Return where the recipe of a file goes; raises ``InputError`` when something else lies there."""
    beside = sidecar(path)
    if (beside.exists() or beside.is_symlink()) and _load(beside) is None:
        raise InputError(f"{beside} is there already and holds no recipe; choose another name for the file.")
    return beside


def sidecar_bytes(path: str | os.PathLike[str], recipe: str, digest: str) -> bytes:
    """Return what lies beside a file, for sets of files.

    Parameters
    ----------
    path
        The file; the recipe of one that it replaces is kept in the new one, so that either has its own.
    recipe
        As JSON.
    digest
        SHA-256 of the file's new content.
    """
    new = json.loads(recipe) | {_OF: digest}
    beside = check_beside(path)
    if beside.exists() and (old := _load(beside)) is not None:
        new |= {_BEFORE: {key: value for key, value in old.items() if key != _BEFORE}}
    return _packed(new)


def read_beside(path: Path, file: BinaryIO) -> str | None:
    """Return the recipe beside a file, as JSON; None when nothing lies there.

    Parameters
    ----------
    path, file
        The file, by its name and open from its start.

    Raises
    ------
    NoRecipeError
        When what lies there is no recipe, or that of another file.
    """
    beside = sidecar(path)
    if not beside.exists():
        return None
    found = _load(beside)
    if found is None:
        raise NoRecipeError(f"{path.name} holds no recipe, and {beside.name} beside it is none.")
    digest = hashlib.sha256()
    while block := file.read(_BLOCK):
        digest.update(block)
    for each in (found, found.get(_BEFORE)):
        if isinstance(each, dict) and each.get(_OF) == digest.hexdigest():
            return _packed({key: value for key, value in each.items() if key not in (_OF, _BEFORE)}).decode()
    raise NoRecipeError(f"{path.name} holds no recipe, and {beside.name} beside it is that of another file.")


def _load(beside: Path) -> dict[str, Any] | None:
    try:
        found = strict_json.load(beside, max_bytes=MAX_BYTES, max_depth=MAX_DEPTH)
    except InputError:
        return None
    return found if isinstance(found, dict) and "texlab" in found else None


def _packed(recipe: dict[str, Any]) -> bytes:
    return strict_json.packed(recipe).encode()
