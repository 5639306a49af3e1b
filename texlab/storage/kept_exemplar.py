"""The exemplar of the last session when no file and no gallery has it: pasted, made here, or out of a result."""

from __future__ import annotations

import hashlib
import logging
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab.storage.arrays import compact, pack, unpack
from texlab.storage.paths import config_dir
from texlab_core.errors import InputError
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    from collections.abc import Container
    from pathlib import Path

    from texlab.state.chosen import Sample
    from texlab_core.engine.inputs import ImageInput

log = logging.getLogger(__name__)

# The first versions kept every exemplar under this name.
FIRST_NAME = "exemplar.npy"
# 64 megapixels of three floats, and the header.
MAX_BYTES = 64 * 2**20 * 12 + 2**16

_NAME = re.compile(r"exemplar-[0-9a-f]{32}\.npz")


@dataclass(frozen=True)
class Kept:
    """An exemplar kept by the program itself, and its name."""

    path: Path
    name: str


def has_no_home(sample: Sample) -> bool:
    """Return whether neither a file nor the gallery can bring this exemplar back."""
    return sample.path is None and not sample.source.name.startswith("gallery:")


def file_name(image: ImageInput) -> str:
    """Return under which name an exemplar is kept: another one has another name, so that none replaces it."""
    return f"exemplar-{hashlib.sha256(image.sha256.encode()).hexdigest()[:32]}.npz"


def kept_exemplar(sample: Any) -> Kept | None:
    """Return where the exemplar of saved settings lies; None where nothing does."""
    if not isinstance(sample, dict):
        return None
    name = sample.get("kept", FIRST_NAME)
    if name != FIRST_NAME and not (isinstance(name, str) and _NAME.fullmatch(name)):
        return None
    path = config_dir() / name
    return Kept(path, str(sample.get("name"))) if path.is_file() else None


def keep(image: ImageInput, folder: Path) -> Path:
    """Write the pixels of an exemplar, in 8 bits where these say the same, and return the file.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    path = folder / file_name(image)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be made ({error.strerror}).") from error
    write_whole(path, pack({"pixels": compact(image.pixels)}))
    return path


def forget_other_exemplars(wanted: Container[str], folder: Path) -> None:
    """Remove every kept exemplar whose name is not among these."""
    for path in folder.glob("exemplar*.np[yz]"):
        if path.name not in wanted and (path.name == FIRST_NAME or _NAME.fullmatch(path.name)):
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                log.warning("%s could not be removed: %s", path, error)


def load(kept: Kept) -> ImageInput:
    """Read what :func:`keep` has written.

    Raises
    ------
    InputError
        When it is not there any more or damaged.
    """
    from texlab_core.images.exemplar import as_exemplar

    try:
        return as_exemplar(unpack(kept.path, MAX_BYTES)["pixels"], name=kept.name)
    except (InputError, KeyError) as error:
        log.warning("The exemplar of the last session could not be read: %s", error)
        raise InputError("The exemplar of the last session could not be read.") from error
