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

    Installed, it is the package ``texlab_resources``; in a checkout, the folder ``resources`` beside the code.

    Raises
    ------
    FileNotFoundError
        When neither is there.
    """
    try:
        return importlib.resources.files(PACKAGE)
    except ModuleNotFoundError:
        pass
    folder = Path(__file__).resolve().parents[2] / "resources"
    if not folder.is_dir():
        raise FileNotFoundError(
            f"The program's resources are missing: neither the package {PACKAGE} nor the folder {folder} exists; "
            "please install TexLab again."
        )
    return folder


def resource(path: str) -> Traversable:
    """Return one file or folder of the resources, by its path with slashes ("gallery/SOURCES.tsv")."""
    found = resources()
    for part in path.split("/"):
        found = found / part
    return found
