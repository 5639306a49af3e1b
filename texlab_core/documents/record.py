"""Results as files, and back: images that carry their recipe, maps and curves, and a summary as JSON."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.documents.beside import sidecar, write_with_recipe
from texlab_core.documents.embedding import kept_notes
from texlab_core.documents.reading import KEY, read_recipe
from texlab_core.documents.recipe import Recipe, RecipeInput, recipe_json
from texlab_core.engine.inputs import ImageInput
from texlab_core.engine.sizes import size_to_json
from texlab_core.files.strict_json import packed
from texlab_core.files.whole import write_together
from texlab_core.images.formats.maps import made_folder, map_files, save_maps, unfinished
from texlab_core.images.formats.volumes import check_volume_format, default_volume_bits, encode_volume
from texlab_core.images.formats.writing import TEXT_SUFFIXES, check_format, default_bits, encode_image

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage
    from texlab_core.images.formats.writing import Bits

__all__ = [
    "Recipe",
    "RecipeInput",
    "carried_alpha",
    "read_recipe",
    "result_bits",
    "save_maps",
    "save_result",
    "summary",
]


_DEPTHS: tuple[Bits, ...] = (8, 16, "float")


def save_result(
    result: Result,
    path: str | os.PathLike[str],
    *,
    bits: Bits | None = None,
    alpha: FloatImage | None = None,
    maps: str | os.PathLike[str] | None = None,
    spare: Iterable[str | os.PathLike[str]] = (),
    quality: int | None = None,
    measures: Mapping[str, float] | None = None,
) -> tuple[str, ...]:
    """Save a result's image, or its volume, with its recipe, and its maps: all of it or nothing.

    A PNG has the recipe as a text chunk, a TIFF as its description (a stack as ImageJ's info), a JPEG in
    application segments, a WebP in a chunk, and a .npy, AVIF or JPEG XL in a file ``.texlab.json`` beside it. The
    recipe holds every input up to 2 MB, or what was used of the exemplar up to 8 MB.

    Parameters
    ----------
    result
        What to save.
    path
        Ends in .png, .tif, .tiff, .webp, .jpg, .jpeg, .avif or .jxl; for a volume in .tif, .tiff or .npy.
    bits
        8, 16 or "float" (TIFF only) for each sample; by default the exemplar's own, as far as the format goes.
    alpha
        Transparency to save with the image, (H, W, 1): see :func:`carried_alpha`.
    maps
        Folder for the maps and curves (see :func:`save_maps`); None saves none.
    spare
        Files that no map may overwrite.
    quality
        1 to 100, for formats that can lose something; see :func:`encode_image`.
    measures
        Numbers about it by id that are known already, kept in the recipe; None takes what its method said.

    Returns
    -------
    tuple of str
        A sentence for each input that the recipe does not hold whole.

    Raises
    ------
    ImageError
        When the format is unknown or cannot hold what is asked.
    InputError
        When a file cannot be written, or a map would overwrite one that is none; then all stay as they were.
    """
    bits = result_bits(result, path) if bits is None else bits
    suffix = check_result_format(path, bits, len(result.job.size))
    held = recipe_json(result, measures)
    recipe = packed(held)
    notes = kept_notes(held["inputs"])
    made = {} if maps is None else map_files(result, Path(maps), spare=[path, sidecar(path), *spare])
    data = encode_result(result, path, bits=bits, alpha=alpha, quality=quality, recipe=recipe)
    if not holds_recipe(suffix):
        # The set has one more file, which cannot be part of that of the maps.
        write_with_recipe(path, data, recipe)
        if maps is not None:
            save_maps(result, maps)
        return notes
    if maps is None:
        write_together({Path(path): data})
        return notes
    with made_folder(Path(maps)):
        write_together({Path(path): data} | made, manifest=unfinished(made))
    return notes


def holds_recipe(path: str | os.PathLike[str]) -> bool:
    """Return whether files of this name or suffix hold their recipe; else it lies beside them."""
    return os.fspath(path).lower().endswith(TEXT_SUFFIXES)


def encode_result(
    result: Result,
    path: str | os.PathLike[str],
    *,
    bits: Bits,
    alpha: FloatImage | None = None,
    quality: int | None = None,
    recipe: str | None = None,
) -> bytes:
    """Return the bytes of a result's file: its image, or its volume.

    Parameters
    ----------
    result
        What to save.
    path, bits, alpha, quality
        As for :func:`save_result`.
    recipe
        As JSON; put inside where the format holds it.

    Raises
    ------
    ImageError
        When the format is unknown or cannot hold what is asked.
    """
    inside = recipe if holds_recipe(path) else None
    if result.volume is not None:
        return encode_volume(path, result.volume, bits=bits, info=inside)
    text = None if inside is None else {KEY: inside}
    return encode_image(path, result.image, bits=bits, text=text, alpha=alpha, quality=quality)


def result_bits(result: Result, path: str | os.PathLike[str]) -> Bits:
    """Return the depth at which a result is saved under a name unless something else is asked for.

    That is the exemplar's own, or that of an image that was filled where it is deeper; 8 bits where a result has
    none. Raises ``ImageError`` for a name without a format.
    """
    given = (result.job.inputs.get(role) for role in ("exemplar", "start"))
    depths: list[Bits] = [each.depth for each in given if isinstance(each, ImageInput)]
    depth: Bits = max(depths, key=_DEPTHS.index, default=8)
    return default_volume_bits(path, depth) if len(result.job.size) == 3 else default_bits(path, depth)


def check_result_format(path: str | os.PathLike[str], bits: Bits | None = None, dimensions: int = 2) -> str:
    """Return the suffix in lower case.

    Raises
    ------
    ImageError
        When no result of so many dimensions can be written under this name, or not with these bits.
    """
    if dimensions == 3:
        return check_volume_format(path, bits)
    return check_format(path, bits)


def carried_alpha(result: Result) -> FloatImage | None:
    """Return the exemplar's own transparency, carried to the result by its source map.

    Returns
    -------
    FloatImage or None
        (H, W, 1) float32 in [0, 1]; where a pixel has no source that of an image of the same size that was filled,
        else 1. None when no alpha was kept or the method has no source map.
    """
    exemplar, start = (result.job.inputs.get(role) for role in ("exemplar", "start"))
    own = exemplar.alpha if isinstance(exemplar, ImageInput) else None
    given = start.alpha if isinstance(start, ImageInput) else None
    found = result.maps.get("source")
    if (own is None and given is None) or found is None or found.kind != "source":
        return None
    source = found.data
    carried = np.ones((*source.shape[:2], 1), np.float32)
    if given is not None and given.shape == carried.shape:
        carried[...] = given
    rows, columns = source[..., 0], source[..., 1]
    height, width = exemplar.size if isinstance(exemplar, ImageInput) else (0, 0)
    known = (rows >= 0) & (columns >= 0) & (rows < height) & (columns < width)
    carried[known] = 1 if own is None else own[rows[known], columns[known]]
    return carried


def summary(
    result: Result, out: str | os.PathLike[str] | None, measures: Mapping[str, float] | None = None
) -> dict[str, Any]:
    """Return the object that ``texlab synth --json`` prints; numbers that are not finite are null.

    Parameters
    ----------
    result
        What was made.
    out
        Where it was saved, if it was.
    measures
        Numbers about it by id; None takes those that the method says itself.
    """
    measures = result.measures if measures is None else measures
    job = result.job
    exemplar = job.inputs.get("exemplar")
    return {
        "method": job.method,
        "parameters": job.params.to_json(),
        "size": size_to_json(job.size),
        "seed": job.seed,
        "elapsed_s": float(result.elapsed_s),
        "out": None if out is None else os.fspath(out),
        "exemplar": _exemplar(exemplar) if isinstance(exemplar, ImageInput) else None,
        "curves": {
            name: {
                "title": curve.title,
                "x_label": curve.x_label,
                "y_label": curve.y_label,
                "x": _numbers(curve.x),
                "y": _numbers(curve.y),
            }
            for name, curve in result.curves.items()
        },
        "measures": dict(zip(measures, _numbers(measures.values()), strict=True)),
    }


def _exemplar(exemplar: ImageInput) -> dict[str, Any]:
    height, width = exemplar.size
    return {"name": exemplar.name, "sha256": exemplar.sha256, "size": {"width": width, "height": height}}


def _numbers(values: Iterable[Any]) -> list[float | None]:
    return [float(value) if math.isfinite(value) else None for value in values]
