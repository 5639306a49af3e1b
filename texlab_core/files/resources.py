"""Find what the program ships beside its code: gallery, presets, icons, help."""

from __future__ import annotations

import functools
import importlib.resources
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

PACKAGE = "texlab_resources"


@functools.cache
def resources() -> Traversable:
    """Return the folder of resources; it may lie inside a zip archive, so read it, never open it by its path.

    In a checkout it is the folder ``resources`` beside the code, so that an edit is seen at once, even where a
    copy is installed; installed, it is the package ``texlab_resources``.

    Raises
    ------
    FileNotFoundError
        When neither is there.
    """
    folder = Path(__file__).resolve().parents[2] / "resources"
    # Beside an installed package, a folder of this name would be somebody else's.
    if (folder / "gallery" / "SOURCES.tsv").is_file():
        return folder
    try:
        return importlib.resources.files(PACKAGE)
    except ModuleNotFoundError:
        raise FileNotFoundError(
            f"The program's resources are missing: neither the package {PACKAGE} nor the folder {folder} exists; "
            "please install TexLab again."
        ) from None


def resource(path: str) -> Traversable:
    """Return one file or folder of the resources, by its path with slashes ("gallery/SOURCES.tsv")."""
    found = resources()
    for part in path.split("/"):
        found = found / part
    return found
