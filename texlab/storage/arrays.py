"""Arrays in files of the program's own; whatever such a file holds by now, the answer is arrays or one error."""

from __future__ import annotations

import io
import zipfile
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.errors import InputError
from texlab_core.files.regular import open_regular

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage

_PLAIN = b"\x93NUMPY"


def pack(arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """Return the content of a file with these arrays; damage to it is found by its check sums."""
    data = io.BytesIO()
    np.savez(data, **arrays)  # type: ignore[arg-type]  # names are the caller's
    return data.getvalue()


def unpack(path: Path, max_bytes: int) -> dict[str, NDArray[Any]]:
    """Return what :func:`pack` made, or the one array of a plain ``.npy`` file under the name ``pixels``.

    Raises
    ------
    InputError
        When it is not there, no regular file, damaged, or would take more than ``max_bytes``.
    """
    try:
        with open_regular(path) as file:
            if file.read(len(_PLAIN)) == _PLAIN:
                file.seek(0)
                return {"pixels": _plain(file, max_bytes)}
            with zipfile.ZipFile(file) as packed:
                if sum(member.file_size for member in packed.infolist()) > max_bytes:
                    raise ValueError("it is too large")
            file.seek(0)
            with np.load(file, allow_pickle=False) as loaded:
                return {name: loaded[name] for name in loaded.files}
    except Exception as error:
        # Damaged files raise all kinds of errors in what reads them.
        why = getattr(error, "strerror", None) or str(error) or type(error).__name__
        raise InputError(f"{path.name}: cannot be read ({' '.join(str(why).split())[:120]}).") from error


def _plain(file: Any, max_bytes: int) -> NDArray[Any]:
    version = np.lib.format.read_magic(file)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, dtype = read(file)
    # Counted in Python's own numbers, which do not overflow.
    count = dtype.itemsize
    for side in shape:
        count *= side
    if count > max_bytes:
        raise ValueError("it is too large")
    file.seek(0)
    return np.lib.format.read_array(file, allow_pickle=False)


def compact(pixels: FloatImage) -> FloatImage | NDArray[np.uint8]:
    """Return pixels in 8 bits where these say the same, else as they are."""
    levels = np.rint(pixels * 255).astype(np.uint8)
    return levels if np.array_equal((levels / np.float32(255)).astype(np.float32), pixels) else pixels
