"""Maps and curves as files: exact data, a picture to look at, and tables."""

from __future__ import annotations

import contextlib
import csv
import hashlib
import io
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.inputs import ImageInput
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.whole import write_together
from texlab_core.images.formats.writing import encode_png

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Curve, Map

INDEX = "index.json"


def save_maps(
    result: Result, folder: str | os.PathLike[str], *, spare: Iterable[str | os.PathLike[str]] = ()
) -> tuple[Path, ...]:
    """Save the maps and curves of a result.

    Every map becomes NAME.npy, its exact data, and NAME.png, a picture of it: source coordinates as red (row) and
    green (column), counts and scalars in the colour map viridis from the least to the greatest value, labels in
    colours that are easy to tell apart, and black where there is nothing. Every curve becomes NAME.csv.
    ``index.json`` has titles, units and ranges.

    Parameters
    ----------
    result
        What was made.
    folder
        Made if need be.
    spare
        Files that no map may overwrite: the result's image, the exemplar.

    Returns
    -------
    tuple of Path
        The files that were written.

    Raises
    ------
    InputError
        When one cannot be written, or would overwrite a file that no earlier maps brought; then none is.
    """
    target = Path(folder)
    files = map_files(result, target, spare=spare)
    with made_folder(target):
        write_together(files, manifest=unfinished(files))
    return tuple(files)


def unfinished(files: Iterable[Path]) -> tuple[Path, bytes]:
    """Return the index of maps that are just being written, and what it holds meanwhile: no maps, only names."""
    *others, index = files
    earlier = _earlier(index.parent) | {each.name for each in others}
    data = {"maps": {}, "curves": {}, "earlier": sorted(earlier - {INDEX})}
    return index, strict_json.dumps(data).encode()


@contextlib.contextmanager
def made_folder(folder: Path) -> Iterator[None]:
    """Make a folder, with those above it; what was made is taken away again when the block fails.

    Raises
    ------
    InputError
        When it cannot be made.
    """
    made = [each for each in (folder, *folder.parents) if not each.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be made ({error.strerror}).") from error
    try:
        yield
    except BaseException:
        with contextlib.suppress(OSError):
            for each in made:
                each.rmdir()
        raise


def map_files(result: Result, folder: Path, *, spare: Iterable[str | os.PathLike[str]] = ()) -> dict[Path, bytes]:
    """Return what :func:`save_maps` writes, by path; the index is the last and has the SHA-256 of the others.

    Raises
    ------
    InputError
        When one would overwrite a spared file, or one in the folder that its index does not name.
    """
    extent = _source_extent(result)
    contents: dict[str, bytes] = {}
    index: dict[str, Any] = {"maps": {}, "curves": {}}
    for name, each in result.maps.items():
        stem = _stem(name)
        contents[f"{stem}.npy"] = _npy(each.data)
        contents[f"{stem}.png"] = encode_png(picture(each.plane, extent))
        index["maps"][name] = _describe(each, stem)
    for name, curve in result.curves.items():
        stem = _stem(name)
        contents[f"{stem}.csv"] = _csv(curve)
        index["curves"][name] = {"title": curve.title, "file": f"{stem}.csv"}
    earlier = _earlier(folder)
    index["sha256"] = {file: hashlib.sha256(data).hexdigest() for file, data in contents.items()}
    if left := sorted(file for file in earlier - {INDEX, *contents} if (folder / file).exists()):
        index["earlier"] = left
    contents[INDEX] = strict_json.dumps(index).encode()
    for file in contents:
        path = folder / file
        if any(_same_file(path, each) for each in spare):
            raise InputError(f"{path} would be overwritten by a map; choose another folder for the maps.")
        if path.exists() and file not in earlier:
            raise InputError(
                f"{path} is there already, and no earlier maps brought it; choose another folder for the maps."
            )
    return {folder / file: data for file, data in contents.items()}


def _earlier(folder: Path) -> set[str]:
    """Return the names of the files in a folder that an earlier result's maps have brought."""
    try:
        index = strict_json.load(folder / INDEX)
        maps = [file for each in index["maps"].values() for file in each["files"]]
        curves = [each["file"] for each in index["curves"].values()]
        return {INDEX, *maps, *curves, *(str(file) for file in index.get("earlier", []))}
    except (InputError, AttributeError, KeyError, TypeError):
        return set()


def _same_file(one: Path, other: str | os.PathLike[str]) -> bool:
    return os.path.realpath(one) == os.path.realpath(other)


def picture(each: Map, extent: tuple[int, int] | None = None) -> NDArray[np.uint8]:
    """Return a map as (H, W, 3) uint8.

    Parameters
    ----------
    each
        The map.
    extent
        Height and width of the exemplar, for source maps; by default the largest coordinates.
    """
    if each.kind == "source":
        return _coordinates(each.data, extent)
    if each.kind == "label":
        return _hues(each.data)
    return _viridis(each.data)


def _coordinates(data: NDArray[Any], extent: tuple[int, int] | None) -> NDArray[np.uint8]:
    known = (data >= 0).all(axis=2)
    sides = np.array(extent if extent is not None else data.reshape(-1, 2).max(axis=0) + 1)
    colours = np.full((*data.shape[:2], 3), 96, np.uint8)
    colours[..., :2] = np.rint(255 * (data / np.maximum(sides - 1, 1)).clip(0, 1))
    colours[~known] = 0
    return colours


def _hues(data: NDArray[Any]) -> NDArray[np.uint8]:
    import cv2

    # Steps of the golden angle: neighbouring labels have distant hues (OpenCV's full range is 256).
    hue = (data.astype(np.int64) * 158 % 256).astype(np.uint8)
    value = np.where(data == 0, 0, 255 - 40 * (data.astype(np.int64) // 8 % 3)).astype(np.uint8)
    rgb: NDArray[np.uint8] = cv2.cvtColor(np.dstack([hue, np.full_like(hue, 170), value]), cv2.COLOR_HSV2RGB_FULL)  # type: ignore[assignment]
    return rgb


def _viridis(data: NDArray[Any]) -> NDArray[np.uint8]:
    import cv2

    finite = np.isfinite(data)
    low, high = _range(data)
    span = (high - low) or 1.0
    level = np.where(finite, (data.astype(np.float64) - low) / span, 0).clip(0, 1)
    bgr = cv2.applyColorMap(np.rint(255 * level).astype(np.uint8), cv2.COLORMAP_VIRIDIS)
    rgb = np.ascontiguousarray(bgr[..., ::-1], dtype=np.uint8)
    rgb[~finite] = 0
    return rgb


def _range(data: NDArray[Any]) -> tuple[float, float]:
    values = data[np.isfinite(data)]
    return (float(values.min()), float(values.max())) if values.size else (0.0, 0.0)


def _source_extent(result: Result) -> tuple[int, int] | None:
    exemplar = result.job.inputs.get("exemplar")
    return exemplar.size if isinstance(exemplar, ImageInput) else None


def _describe(each: Map, stem: str) -> dict[str, Any]:
    low, high = _range(each.data)
    return {
        "title": each.title,
        "kind": each.kind,
        "unit": each.unit,
        "least": low,
        "greatest": high,
        "files": [f"{stem}.npy", f"{stem}.png"],
    }


def _npy(data: NDArray[Any]) -> bytes:
    out = io.BytesIO()
    np.save(out, data, allow_pickle=False)
    return out.getvalue()


def _csv(curve: Curve) -> bytes:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([curve.x_label or "x", curve.y_label or curve.title])
    # repr of a float is the shortest text that reads back as the same number.
    writer.writerows((repr(float(x)), repr(float(y))) for x, y in zip(curve.x, curve.y, strict=True))
    return out.getvalue().encode()


def _stem(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-") or "unnamed"
