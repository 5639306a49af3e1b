"""What one text stands for: a file, the images of a folder or of a glob, textures of the gallery."""

from __future__ import annotations

import fnmatch
import glob
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from texlab_core.errors import InputError
from texlab_core.images.formats.kinds import READABLE_SUFFIXES
from texlab_core.images.gallery import CLASSES, PREFIX, find_entry, gallery

if TYPE_CHECKING:
    from collections.abc import Iterator

_MAGIC = re.compile(r"[*?\[]")


def sources_of(text: str, folder: Path, what: str = "inputs") -> Iterator[tuple[str, str]]:
    """Return the images that a text stands for, none read yet.

    Parameters
    ----------
    text
        A file, a folder (its images), a glob (``in/*.png``, ``**`` for folders below), ``gallery:NAME``,
        ``gallery:*`` or a class as in ``gallery:structured``.
    folder
        What relative paths are relative to.
    what
        Stands before what is wrong.

    Yields
    ------
    tuple of str
        What :func:`texlab_core.images.exemplar.as_exemplar` takes, and how the text calls it.

    Raises
    ------
    InputError
        When it stands for no image.
    """
    if text.startswith(PREFIX):
        yield from ((uri, uri) for uri in _textures(text, what))
        return
    path = folder / text
    if not text or "\0" in text:
        raise InputError(f"{what}: the name of an image is empty.")
    if path.is_dir():
        names = sorted(each.name for each in path.iterdir() if _is_image(each.name) and each.is_file())
        if not names:
            raise InputError(f"{what}: the folder {text} holds no image.")
        yield from ((str(path / name), _joined(text, name)) for name in names)
    elif _MAGIC.search(text) and not path.exists():
        names = sorted(glob.glob(text, root_dir=folder, recursive=True))
        names = [name for name in names if _is_image(name) and (folder / name).is_file()]
        if not names:
            raise InputError(f"{what}: {text} matches no image.")
        yield from ((str(folder / name), Path(name).as_posix()) for name in names)
    elif path.exists():
        yield str(path), text
    else:
        raise InputError(f"{what}: there is no file or folder {text}.")


def _joined(folder: str, name: str) -> str:
    return name if folder in ("", ".") else f"{folder.rstrip('/')}/{name}"


def _is_image(name: str) -> bool:
    return os.path.splitext(name)[1].lower() in READABLE_SUFFIXES


def _textures(uri: str, what: str) -> list[str]:
    wanted = uri.removeprefix(PREFIX)
    if wanted in CLASSES:
        found = [each.uri for each in gallery() if each.cls == wanted]
    elif _MAGIC.search(wanted):
        found = [each.uri for each in gallery() if fnmatch.fnmatchcase(each.name, wanted)]
    else:
        return [find_entry(uri).uri]
    if not found:
        raise InputError(f"{what}: {uri} matches no texture of the gallery.")
    return found
