"""The further inputs of columns, kept with the session: masks, start images and states in files, codes as text."""

from __future__ import annotations

import logging
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab.storage.arrays import compact, pack, unpack
from texlab.storage.paths import config_dir
from texlab_core.engine.inputs import ArraysInput, DataInput, ImageInput, hash_arrays
from texlab_core.errors import InputError
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    from collections.abc import Container, Iterable
    from pathlib import Path

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Input

log = logging.getLogger(__name__)

FOLDER = "inputs"
SUFFIX = ".npz"
MAX_BYTES = 2**26

_HASH = re.compile(r"[0-9a-f]{64}")


def kept_folder() -> Path:
    """Return where the files are kept (it may not exist); each is named by the hash of its arrays."""
    return config_dir() / FOLDER


def input_to_json(given: Input) -> dict[str, Any]:
    """Return what the settings hold of an input: a document itself, of arrays their name and hash."""
    if isinstance(given, DataInput):
        return {"name": given.name, "data": given.data}
    return {"name": given.name, "sha256": given.sha256}


def keep_inputs(inputs: Iterable[Input], folder: Path) -> None:
    """Write the arrays of these inputs that are not there yet, up to :data:`MAX_BYTES` together.

    What could not be kept is logged: the session itself is worth more.
    """
    room = MAX_BYTES
    for sha256, given in {each.sha256: each for each in inputs if not isinstance(each, DataInput)}.items():
        path = folder / f"{sha256}{SUFFIX}"
        try:
            data = b"" if path.is_file() else _packed(given)
            size = len(data) or path.stat().st_size
            if size > room:
                log.warning("The input %s is too large to be kept with the session.", given.name)
                continue
            room -= size
            if data:
                folder.mkdir(parents=True, exist_ok=True)
                write_whole(path, data)
        except (OSError, InputError) as error:
            log.warning("The input %s could not be kept: %s", given.name, error)


def forget_others(wanted: Container[str], folder: Path) -> None:
    """Remove the files of all inputs whose hash is not among these."""
    for path in folder.glob(f"*{SUFFIX}"):
        if path.stem not in wanted and _HASH.fullmatch(path.stem):
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                log.warning("%s could not be removed: %s", path, error)


def load_input(saved: Any, kind: str, folder: Path) -> Input:
    """Return the input that :func:`input_to_json` and :func:`keep_inputs` have written.

    Parameters
    ----------
    saved
        What the settings hold of it.
    kind
        ``image``, ``data`` or ``arrays``: what the method takes there.
    folder
        Where the files are.

    Raises
    ------
    InputError
        When it is not there any more, damaged, or another thing.
    """
    name = saved.get("name") if isinstance(saved, dict) else None
    if not isinstance(name, str):
        raise InputError("It has no name.")
    if kind == "data":
        try:
            return DataInput(saved["data"], name)
        except (KeyError, TypeError, ValueError, RecursionError) as error:
            raise InputError(f"{name} is no document.") from error
    sha256 = saved.get("sha256")
    if not isinstance(sha256, str) or not _HASH.fullmatch(sha256):
        raise InputError(f"{name} has no hash.")
    try:
        arrays = unpack(folder / f"{sha256}{SUFFIX}", MAX_BYTES)
        given = ArraysInput(arrays, name) if kind == "arrays" else _image(arrays, name)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{name} cannot be read ({error}).") from error
    if given.sha256 != sha256:
        raise InputError(f"{name} is not what was kept.")
    return given


def _packed(given: ImageInput | ArraysInput) -> bytes:
    return pack({"pixels": compact(given.pixels)} if isinstance(given, ImageInput) else given.arrays)


def _image(arrays: dict[str, NDArray[Any]], name: str) -> ImageInput:
    pixels = arrays["pixels"]
    if pixels.ndim != 3 or pixels.shape[2] not in (1, 3):
        raise ValueError("it is no image")
    if pixels.dtype == np.uint8:
        pixels = (pixels / np.float32(255)).astype(np.float32)
    pixels = np.ascontiguousarray(pixels, np.float32)
    pixels.flags.writeable = False
    return ImageInput(pixels, name, hash_arrays({"pixels": pixels}))
