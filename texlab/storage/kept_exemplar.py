"""The exemplar of the last session when no file and no gallery has it: pasted, made here, or out of a result."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab.storage.paths import config_dir
from texlab_core.errors import InputError
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from texlab.state.session import Sample
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.steps import FloatImage

FILE_NAME = "exemplar.npy"


@dataclass(frozen=True)
class Kept:
    """An exemplar kept by the program itself, and its name."""

    path: Path
    name: str


def kept_path() -> Path:
    """Return where the exemplar is kept (it may not exist)."""
    return config_dir() / FILE_NAME


def has_no_home(sample: Sample) -> bool:
    """Return whether neither a file nor the gallery can bring this exemplar back."""
    return sample.path is None and not sample.source.name.startswith("gallery:")


def keep(image: ImageInput, path: Path) -> None:
    """Write the pixels of an exemplar, in 8 bits where these say the same.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    data = io.BytesIO()
    np.save(data, compact(image.pixels), allow_pickle=False)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path.parent}: cannot be made ({error.strerror}).") from error
    write_whole(path, data.getvalue())


def compact(pixels: FloatImage) -> FloatImage | NDArray[np.uint8]:
    """Return pixels in 8 bits where these say the same, else as they are."""
    levels = np.rint(pixels * 255).astype(np.uint8)
    return levels if np.array_equal((levels / np.float32(255)).astype(np.float32), pixels) else pixels


def load(kept: Kept) -> ImageInput:
    """Read what :func:`keep` has written.

    Raises
    ------
    InputError
        When it is not there any more or damaged.
    """
    from texlab_core.images.exemplar import as_exemplar

    try:
        pixels = np.load(kept.path, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise InputError("The exemplar of the last session could not be read.") from error
    return as_exemplar(pixels, name=kept.name)
