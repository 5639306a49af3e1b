"""Reading what the user opens: images, recipes, presets, codes, sessions."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard

from texlab.state.changes import Opened
from texlab.storage.kept_exemplar import Kept, kept_exemplar, load
from texlab.widgets.pasted import Pasted, pixels_of
from texlab_core.engine.inputs import Crop, DataInput, ImageInput
from texlab_core.images.unit_range import TRANSPARENCY

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from texlab_core.documents.presets import Preset
    from texlab_core.documents.recipe import RecipeInput
    from texlab_core.engine.levels import Levels

DOCUMENT_SUFFIX = ".json"
Source = str | bytes | Pasted | Kept
# Where a picture is too large to be kept whole, this much of it is a comfortable source.
_REDUCED_PIXELS = 16 * 2**20


@dataclass(frozen=True)
class Choice:
    """An exemplar to open: where it is, how much of it, and how its transparency is read.

    Without a scale it is taken as a fresh image is.
    """

    source: Source
    crop: Crop | None = None
    scale: float | None = None
    alpha: str = "white"
    levels: Levels | None = None
    look_only: bool = False


@dataclass(frozen=True)
class Document:
    """What a JSON file turned out to be: one of these."""

    code: DataInput | None = None
    preset: Preset | None = None


@dataclass(frozen=True, eq=False)
class Lacking:
    """A saved result whose recipe holds not all of its images.

    Parameters
    ----------
    source
        The file.
    missing
        The images, each with its role, name, size and hash.
    """

    source: str
    missing: tuple[RecipeInput, ...]


def lacking(source: Source) -> Lacking | None:
    """Return which images a saved result lacks; None when it lacks none, or is no such file; in a thread."""
    from texlab_core.documents.reading import read_recipe
    from texlab_core.errors import NoRecipeError

    if not isinstance(source, str) or source.startswith("gallery:"):
        return None
    try:
        missing = read_recipe(source).missing
    except NoRecipeError:
        return None
    images = {each.sha256: each for each in missing if each.kind == "image"}
    return Lacking(source, tuple(images.values())) if images else None


def is_document(source: Source) -> TypeGuard[str]:
    """Return whether a source is a file that goes into a column instead of being the exemplar."""
    return isinstance(source, str) and source.lower().endswith(DOCUMENT_SUFFIX)


def open_document(path: str) -> Document:
    """Read a code or a preset, by its ``format``; runs in a thread.

    Raises
    ------
    InputError
        One sentence when it is neither, or not what it says it is.
    """
    from texlab_core.documents import presets
    from texlab_core.errors import InputError
    from texlab_core.files import strict_json
    from texlab_core.methods.spectral import codefile

    file = Path(path)
    data = strict_json.load(file, what=f"the file {file.name}")
    kind = data.get("format") if isinstance(data, dict) else None
    if kind == codefile.FORMAT:
        code = codefile.code_from_json(data, what=f"the code {file.name}").code
        return Document(code=codefile.code_input(code, file.name))
    if kind != presets.FORMAT:
        raise InputError(f"{file.name} is neither a code of MSG nor a preset.")
    return Document(preset=presets.preset_from_json(data, what=f"the preset {file.name}"))


def open_source(
    source: Source,
    should_stop: Callable[[], bool] | None = None,
    alpha: str = "white",
    *,
    given: Mapping[str, str] | None = None,
) -> Opened:
    """Read an image or a saved result: a path, gallery:NAME, the bytes of a file, what was pasted or kept.

    Meant for a worker's thread.

    Images that a saved result lacks are ``given`` by their roles.

    Raises
    ------
    InputError
        One sentence when it is neither.
    """
    from texlab_core.documents.reading import read_recipe
    from texlab_core.errors import NoRecipeError

    if isinstance(source, Kept):
        return Opened(load(source), None)
    if isinstance(source, Pasted):
        return Opened(_read_image(pixels_of(source.image), source.name, should_stop, alpha), None)
    path = None if isinstance(source, bytes) or source.startswith("gallery:") else str(Path(source).absolute())
    if path is not None or isinstance(source, bytes):
        with contextlib.suppress(NoRecipeError):
            recipe = read_recipe(source)
            job = recipe.job(given=given)
            image = job.inputs.get("exemplar")
            if isinstance(image, ImageInput):
                return Opened(image, None, job, recipe.measures)
    return Opened(_read_image(source, None, should_stop, alpha), path)


def _read_image(
    source: str | bytes | NDArray[Any], name: str | None, should_stop: Callable[[], bool] | None, alpha: str
) -> ImageInput:
    from texlab_core.errors import TooLargeError
    from texlab_core.images.exemplar import as_exemplar

    use, background = TRANSPARENCY[alpha]
    read = partial(as_exemplar, source, name=name, alpha=use, background=background, should_stop=should_stop)
    try:
        return read()
    except TooLargeError as error:
        scale = (_REDUCED_PIXELS / (error.width * error.height)) ** 0.5
        return read(scale=scale)


def last_exemplar(saved: Any) -> list[Choice]:
    """Return where the exemplar of a saved session may be (nowhere when that is missing or damaged)."""
    from texlab_core.images.gallery import gallery

    sample = saved.get("sample") if isinstance(saved, dict) else None
    if not isinstance(sample, dict):
        return []
    name, path, crop, scale = (sample.get(key) for key in ("name", "path", "crop", "scale"))
    whole = isinstance(crop, list) and len(crop) == 4 and all(type(side) is int for side in crop)
    box = Crop(*crop) if isinstance(crop, list) and whole else None
    factor = float(scale) if isinstance(scale, int | float) and 0 < scale <= 1 else None
    levels = _saved_levels(sample.get("levels"))
    look_only = levels is not None and sample.get("look_only") is True
    made = partial(Choice, crop=box, scale=factor, levels=levels, look_only=look_only)
    if isinstance(path, str):
        alpha = sample.get("alpha")
        return [made(path, alpha=alpha if alpha in TRANSPARENCY else "white")]
    if name in [entry.uri for entry in gallery()]:
        return [made(str(name))]
    kept = kept_exemplar(sample)
    return [] if kept is None else [made(kept)]


def _saved_levels(data: Any) -> Levels | None:
    from texlab_core.engine.levels import Levels
    from texlab_core.errors import ParamError

    try:
        return None if data is None else Levels.from_json(data)
    except ParamError:
        return None
