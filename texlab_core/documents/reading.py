"""Read recipes from saved results; whatever the file holds, the answer is a checked recipe or one sentence."""

from __future__ import annotations

import io
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from texlab_core.documents.beside import MAX_BYTES, read_beside
from texlab_core.documents.embedding import MAX_DATA_DEPTH
from texlab_core.documents.recipe import VERSION, Recipe, RecipeInput, measures_from_json
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import check_seed, check_size
from texlab_core.engine.levels import Levels
from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.registry import Method, find_method
from texlab_core.engine.sizes import size_from_json
from texlab_core.errors import InputError, NoRecipeError, RecipeError
from texlab_core.files import strict_json
from texlab_core.files.regular import open_regular, read_regular, reason
from texlab_core.files.wording import sentence_case
from texlab_core.images.formats import jpeg_text, webp_text
from texlab_core.images.formats.png_text import SIGNATURE, read_text

if TYPE_CHECKING:
    from collections.abc import Mapping

KEY = "texlab"
_MAX_NAME = 4096
_MAX_VERSIONS = 64
_MAX_SIDE = 2**26
_TIFF_PREFIX = "TexLab "
_OLD_DESCRIPTION = re.compile(r'\{\s*"texlab"\s*:')
_HASH = re.compile(r"[0-9a-f]{64}")


def first_sidecar(path: str | os.PathLike[str]) -> Path:
    """Return where the first versions put the recipe of a JPEG, which holds its own by now."""
    return Path(path).with_suffix(".texlab.json")


def read_recipe(source: str | os.PathLike[str] | bytes) -> Recipe:
    """Read the recipe of a saved result.

    Parameters
    ----------
    source
        Path or bytes of a PNG, TIFF, JPEG or WebP; path of a .npy, GIF, animated WebP, or JPEG of the first
        versions with its ``.texlab.json`` beside it, or such a file itself.

    Raises
    ------
    RecipeError
        When there is none, or it is malformed, from a newer version, or for something that does not exist here.
    """
    if isinstance(source, bytes):
        return _parse(_find(io.BytesIO(source), None, "the file"), "the file")
    if not os.fspath(source):
        raise RecipeError("The name of the saved result is empty.")
    path = Path(source)
    name = path.name
    try:
        with open_regular(source) as file:
            return _parse(_find(file, path, name), name)
    except InputError:
        raise
    except IsADirectoryError:
        raise RecipeError(f"{source}: is a folder, not a saved result.") from None
    except FileNotFoundError:
        raise RecipeError(f"{source}: there is no such file.") from None
    except (OSError, ValueError) as error:
        raise RecipeError(f"{source}: cannot be opened ({reason(error)}).") from error


def recipe_text(path: str | os.PathLike[str]) -> str | None:
    """Return the recipe of a saved result as it is written there; None when the file holds none."""
    try:
        read_recipe(path)
    except NoRecipeError:
        return None
    with open_regular(path) as file:
        text = _find(file, Path(path), Path(path).name)
    return text.decode() if isinstance(text, bytes) else text


def _find(file: BinaryIO, path: Path | None, name: str) -> str | bytes:
    """Return the text of the recipe, wherever the format keeps it."""
    head = file.read(16)
    file.seek(0)
    found: str | bytes | None = None
    try:
        if head.startswith(SIGNATURE):
            found = read_text(file, KEY, MAX_BYTES)
        elif head.startswith((b"II", b"MM")):
            found = _tiff_description(file)
        elif head.startswith(jpeg_text.SIGNATURE):
            found = jpeg_text.read_text(file, KEY, MAX_BYTES)
        elif webp_text.is_webp(head):
            found = webp_text.read_text(file, KEY, MAX_BYTES)
        elif head.lstrip()[:1] == b"{":
            found = file.read(MAX_BYTES + 1)
    except ValueError as error:
        raise RecipeError(f"The recipe of {name} {error}.") from error
    if found is None and path is not None and _keeps_beside(head):
        file.seek(0)
        found = read_beside(path, file)
    if found is None and path is not None and head.startswith(jpeg_text.SIGNATURE):
        found = _beside(file, path)
    if found is None:
        raise NoRecipeError(f"{sentence_case(name)} holds no recipe; only results that TexLab saved do.")
    return found


def _keeps_beside(head: bytes) -> bool:
    """Return whether recipes lie beside files that start like this: .npy, GIF, WebP, AVIF, MP4, JPEG XL."""
    starts = (b"\x93NUMPY", b"GIF8", b"RIFF", b"\xff\x0a", b"\0\0\0\x0cJXL ")
    return head.startswith(starts) or head[4:8] == b"ftyp"


def _beside(file: BinaryIO, path: Path) -> bytes | None:
    """Return the recipe beside a JPEG of the first versions, which do not say whose it is; None without one.

    Raises
    ------
    NoRecipeError
        When what lies there is none, that of another image, or might be that of several.
    """
    beside = first_sidecar(path)
    if not beside.exists():
        return None
    refusal = (
        f"{sentence_case(path.name)} holds no recipe, and {beside.name} beside it cannot be taken for its own"
    )
    try:
        text = read_regular(beside, MAX_BYTES)
        recipe = _parse(text, beside.name)
    except (OSError, RecipeError) as error:
        raise NoRecipeError(f"{refusal}: {reason(error)}.") from error
    if recipe.size != jpeg_text.read_size(file):
        raise NoRecipeError(f"{refusal}: it makes an image of {recipe.size[1]} x {recipe.size[0]} pixels.")
    if others := _others_of(path):
        raise NoRecipeError(f"{refusal}: it may as well be that of {others[0]}.")
    return text


def _others_of(path: Path) -> list[str]:
    """Return the names of other JPEG files to which a file beside this one may belong."""
    return sorted(
        each.name
        for each in path.parent.iterdir()
        if each.stem == path.stem and each.suffix.lower() in (".jpg", ".jpeg") and not each.samefile(path)
    )


def _tiff_description(file: BinaryIO) -> str | None:
    import tifffile

    try:
        with tifffile.TiffFile(file, name="result.tif") as tiff:
            page: Any = tiff.pages[0]
            tag = page.tags.get("ImageDescription")
            if tag is None or tag.count > MAX_BYTES:
                return None
            text = tag.value
            if isinstance(text, str) and text.startswith("ImageJ="):
                text = _imagej_info(page)
    except Exception as error:
        # tifffile raises all kinds of errors on damaged files.
        raise ValueError("is damaged") from error
    if not isinstance(text, str):
        return None
    # With the word before it, or as the first versions wrote it; other programs write JSON there too.
    if text.startswith(_TIFF_PREFIX + "{"):
        return text.removeprefix(_TIFF_PREFIX)
    return text if _OLD_DESCRIPTION.match(text) else None


def _imagej_info(page: Any) -> object:
    """Return the text that goes with a stack; the description says how ImageJ takes its pages."""
    tag = page.tags.get("IJMetadata")
    if tag is None or tag.count > 2 * MAX_BYTES:
        return None
    found = tag.value
    return found.get("Info") if isinstance(found, dict) else None


def _parse(text: str | bytes, name: str) -> Recipe:
    what = f"the recipe of {name}"
    data = strict_json.loads(text, what=what, max_bytes=MAX_BYTES, max_depth=MAX_DATA_DEPTH + 8, error=RecipeError)
    try:
        return _recipe(data)
    except InputError as error:
        raise RecipeError(f"{sentence_case(what)} is not usable: {error}") from error


def _recipe(data: Any) -> Recipe:
    if not isinstance(data, dict) or "texlab" not in data:
        raise RecipeError("it is not one of TexLab.")
    if (version := data["texlab"]) != VERSION or isinstance(version, bool):
        raise RecipeError(f"it has version {version!r:.20}, and this TexLab reads version {VERSION}.")
    name = _get(data, "method", str)
    method = find_method(name)
    return Recipe(
        method=name,
        params=method.params.from_json(_get(data, "params", dict)),
        size=size_from_json(_get(data, "size", dict), method.dimensions),
        seed=check_seed(data.get("seed")),
        versions=_versions(data.get("versions", {})),
        inputs=_inputs(_get(data, "inputs", dict), method),
        measures=measures_from_json(data.get("measures", {})),
    )


def _get(data: dict[str, Any], key: str, kind: type[Any]) -> Any:
    value = data.get(key)
    if not isinstance(value, kind):
        noun = {str: "a text", dict: "an object", int: "a whole number", float: "a number"}[kind]
        raise RecipeError(f"{key} must be {noun}, got {value!r:.40}.")
    return value


def _versions(data: Any) -> Mapping[str, str]:
    usable = isinstance(data, dict) and len(data) <= _MAX_VERSIONS
    texts = [*data, *data.values()] if usable else []
    if not usable or not all(isinstance(each, str) and len(each) <= 100 and each.isprintable() for each in texts):
        raise RecipeError("versions must be a few texts by name.")
    return frozen_mapping(data)


def _inputs(data: dict[str, Any], method: Method) -> Mapping[str, RecipeInput]:
    specs = {spec.name: spec for spec in method.inputs}
    found: dict[str, RecipeInput] = {}
    for role, entry in data.items():
        if role not in specs:
            raise RecipeError(f"{method.title} takes no input {role!r:.40}, only {', '.join(specs)}.")
        if not isinstance(entry, dict):
            raise RecipeError(f"the input {role} must be an object, got {entry!r:.40}.")
        found[role] = parse_input(role, entry, specs[role].kind)
    for spec in method.inputs:
        if spec.required and spec.name not in found:
            raise RecipeError(f"the input {spec.name} is missing.")
    return frozen_mapping(found)


def parse_input(role: str, entry: dict[str, Any], kind: str) -> RecipeInput:
    """Return one input as a recipe or a project has it; raises ``RecipeError`` when it is malformed."""
    if _get(entry, "kind", str) != kind:
        raise RecipeError(f"the input {role} must be of kind {kind}, got {entry['kind']!r:.40}.")
    name, sha256 = _get(entry, "name", str), _get(entry, "sha256", str)
    if len(name) > _MAX_NAME or not name.isprintable():
        raise RecipeError(f"the name of the input {role} must be one line of at most {_MAX_NAME} characters.")
    if not _HASH.fullmatch(sha256):
        raise RecipeError(f"the sha256 of the input {role} must be 64 hexadecimal digits, got {sha256!r:.40}.")
    keys = {"image": ("source", "pixels"), "arrays": ("arrays",), "data": ("data",)}[kind]
    content = {key: entry[key] for key in keys if key in entry}
    if content and kind == "image" and "alpha" in entry:
        content["alpha"] = entry["alpha"]
    if kind != "image":
        return RecipeInput(role, kind, name, sha256, None, 1.0, None, frozen_mapping(content))
    for packed in content.values():
        if not isinstance(packed, dict):
            raise RecipeError(f"the pixels of the input {role} must be an object, got {packed!r:.40}.")
    size = _get(entry, "size", dict)
    shape = check_size((size.get("height"), size.get("width")))
    scale, crop = _scale(entry.get("scale", 1.0)), _crop(entry.get("crop"))
    depth = entry.get("depth", 8)
    if depth not in (8, 16, "float") or isinstance(depth, bool):
        raise RecipeError(f"the depth of the input {role} must be 8, 16 or float, got {depth!r:.40}.")
    taken = entry.get("taken")
    if taken is not None:
        if not isinstance(taken, dict):
            raise RecipeError(f"how the input {role} was taken must be an object, got {taken!r:.40}.")
        taken = _scale(taken.get("scale")), _crop(taken.get("crop"))
    levels = None if entry.get("levels") is None else Levels.from_json(entry["levels"])
    return RecipeInput(role, kind, name, sha256, shape, scale, crop, frozen_mapping(content), depth, taken, levels)


def _scale(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value <= 1:
        raise RecipeError(f"scale must be above 0 and at most 1, got {value!r:.40}.")
    return float(value)


def _crop(data: Any) -> Crop | None:
    if data is None:
        return None
    sides = ("top", "left", "height", "width")
    if not isinstance(data, dict) or not all(
        type(data.get(side)) is int and 0 <= data[side] <= _MAX_SIDE for side in sides
    ):
        raise RecipeError("crop must have top, left, height and width in whole pixels.")
    return Crop(*(data[side] for side in sides))
