"""The exemplars of a plan: files, folders, globs, lists, textures of the gallery, and crops of each."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab_core.engine.inputs import Crop
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.regular import read_regular
from texlab_core.images.exemplar import as_exemplar, scaled_size
from texlab_core.images.sources import sources_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from texlab_core.engine.inputs import ImageInput

MAX_EXEMPLARS = 100_000
MAX_LIST_BYTES = 16 * 2**20
_KEYS = ("from", "list", "scale", "scales", "crops")


@dataclass(frozen=True, slots=True)
class Grid:
    """One of the crops of a size that are spread evenly from edge to edge, row by row.

    Parameters
    ----------
    height, width
        Of the crop.
    rows, columns
        How many there are down and across.
    index
        Which one.
    """

    height: int
    width: int
    rows: int
    columns: int
    index: int

    def crop(self, height: int, width: int, name: str) -> Crop:
        """Return the crop of an image of this height and width; raises ``InputError`` when it is too small."""
        if self.height > height or self.width > width:
            raise InputError(
                f"{name}: crops of {self.width} x {self.height} pixels do not fit into its {width} x {height}."
            )
        row, column = divmod(self.index, self.columns)
        top = _spread(height - self.height, row, self.rows)
        return Crop(top, _spread(width - self.width, column, self.columns), self.height, self.width)


def _spread(room: int, place: int, count: int) -> int:
    return room // 2 if count == 1 else room * place // (count - 1)


@dataclass(frozen=True, slots=True)
class ExemplarChoice:
    """One exemplar of a plan, not read yet.

    Parameters
    ----------
    source
        Path of a file, or ``gallery:NAME``.
    name
        How the plan calls it, for people and reports.
    scale
        Factor of both sides, before the crop.
    crop
        Which part of it.
    """

    source: str
    name: str
    scale: float = 1.0
    crop: Crop | Grid | None = None

    def load(self, whole: ImageInput | None = None) -> ImageInput:
        """Read it; ``whole`` is what :meth:`load_whole` returned, when several are taken from one source.

        Raises
        ------
        InputError
            When it cannot be read, or the crop lies outside.
        """
        image = self.load_whole() if whole is None else whole
        if self.scale == 1.0 and self.crop is None:
            return image
        crop = self.crop
        if isinstance(crop, Grid):
            crop = crop.crop(*scaled_size(*image.size, self.scale), self.name)
        return as_exemplar(image, crop=crop, scale=self.scale)

    def load_whole(self) -> ImageInput:
        """Read the whole source; raises ``InputError`` when that is not possible."""
        return as_exemplar(self.source)

    @property
    def part(self) -> str:
        """Scale and crop in words: "scale 0.5, crop 2 of 8"; empty for all of it."""
        parts = [] if self.scale == 1.0 else [f"scale {self.scale:g}"]
        if isinstance(self.crop, Grid):
            parts.append(f"crop {self.crop.index + 1} of {self.crop.rows * self.crop.columns}")
        elif self.crop is not None:
            crop = self.crop
            parts.append(f"crop {crop.width}x{crop.height}+{crop.left}+{crop.top}")
        return ", ".join(parts)


def choices_of(entries: list[Any], folder: Path) -> tuple[ExemplarChoice, ...]:
    """Return the exemplars that the ``inputs`` of a plan stand for, each once, in their order.

    Parameters
    ----------
    entries
        Texts - a file, a folder (its images), a glob (``in/*.png``, ``**`` for folders below), ``gallery:NAME``,
        ``gallery:*`` or a class as in ``gallery:structured`` - or objects: ``{"from": one or several of these,
        "list": a text file with one of these on each line, "scale": 0.5 or "scales": [1, 0.5], "crops":
        ["128x128+0+0", ...] or {"size": "128x128", "grid": "4x2"}}``.
    folder
        What relative paths are relative to.

    Raises
    ------
    InputError
        When an entry has another form, or stands for no image.
    """
    found: dict[ExemplarChoice, None] = {}
    for entry in entries:
        for choice in _choices(entry, folder):
            found[choice] = None
            if len(found) > MAX_EXEMPLARS:
                raise InputError(f"inputs: at most {MAX_EXEMPLARS} exemplars.")
    return tuple(found)


def _choices(entry: Any, folder: Path) -> Iterator[ExemplarChoice]:
    if isinstance(entry, str):
        yield from (ExemplarChoice(source, name) for source, name in sources_of(entry, folder))
        return
    if not isinstance(entry, dict) or not ("from" in entry or "list" in entry):
        raise InputError(
            'inputs: must hold names of images, globs or gallery:NAME, or objects as in {"from": "in/*.png", '
            f'"scale": 0.5}}, got {strict_json.shorten(entry)}.'
        )
    strict_json.check_keys(entry, _KEYS)
    texts = _texts(entry.get("from", []), "from")
    if "list" in entry:
        texts += _lines(_texts(entry["list"], "list"), folder)
    crops = _crops(entry.get("crops"))
    scales = _scales(entry)
    for text in texts:
        for source, name in sources_of(text, folder):
            for scale in scales:
                yield from (ExemplarChoice(source, name, scale, crop) for crop in crops)


def _texts(given: object, key: str) -> list[str]:
    found = [given] if isinstance(given, str) else given
    if not isinstance(found, list) or not all(isinstance(each, str) for each in found):
        raise InputError(f"{key}: must be a name or a list of names, got {strict_json.shorten(given)}.")
    return list(found)


def _lines(files: list[str], folder: Path) -> list[str]:
    found: list[str] = []
    for file in files:
        try:
            text = read_regular(folder / file, MAX_LIST_BYTES)
            found += [line.strip() for line in text.decode("utf-8-sig").splitlines() if line.strip()]
        except (OSError, ValueError) as bad:
            if isinstance(bad, InputError):
                raise
            reason = getattr(bad, "strerror", None) or "it is not UTF-8 text"
            raise InputError(f"list: {file} cannot be read ({reason}).") from bad
    return found


def _scales(entry: dict[str, Any]) -> list[float]:
    if "scale" in entry and "scales" in entry:
        raise InputError("scales: give either one scale or several, not both.")
    given = entry.get("scales", [entry.get("scale", 1.0)])
    if not isinstance(given, list) or not given:
        raise InputError(f"scales: must be a list of numbers, got {strict_json.shorten(given)}.")
    return [scale_of(each) for each in given]


def scale_of(given: object) -> float:
    """Return the factor by which an image is reduced; raises ``InputError``."""
    if not isinstance(given, int | float) or isinstance(given, bool) or not 0 < given <= 1:
        raise InputError(f"scales: must be above 0 and at most 1, got {strict_json.shorten(given)}.")
    return float(given)


def _crops(given: object) -> list[Crop | Grid | None]:
    if given is None:
        return [None]
    if isinstance(given, dict):
        strict_json.check_keys(given, ("size", "grid"))
        width, height = _pair(given.get("size"), "size")
        columns, rows = _pair(given.get("grid", "1x1"), "grid")
        if columns * rows > MAX_EXEMPLARS:
            raise InputError(f"crops: at most {MAX_EXEMPLARS} of one image, got {columns} x {rows}.")
        return [Grid(height, width, rows, columns, index) for index in range(rows * columns)]
    texts = _texts(given, "crops")
    if not texts:
        raise InputError("crops: at least one is needed.")
    return [crop_of(text) for text in texts]


def crop_of(text: object) -> Crop:
    """Return the rectangle from ``WxH+X+Y``; raises ``InputError``."""
    pattern = r"([0-9]{1,9})[xX×]([0-9]{1,9})\+([0-9]{1,9})\+([0-9]{1,9})"
    found = re.fullmatch(pattern, text) if isinstance(text, str) else None
    if found is None:
        raise InputError(
            'crops: must be width, height, left and top as in 256x192+10+20, or an object as in {"size": '
            f'"128x128", "grid": "4x2"}}, got {strict_json.shorten(text)}.'
        )
    width, height, left, top = (int(each) for each in found.groups())
    return Crop(top, left, height, width)


def _pair(text: object, key: str) -> tuple[int, int]:
    pattern = r"([1-9][0-9]{0,5})(?:[xX×]([1-9][0-9]{0,5}))?"
    found = re.fullmatch(pattern, text) if isinstance(text, str) else None
    if found is None:
        raise InputError(
            f"crops: {key} must be two numbers as in 128x96, or one for both, got {strict_json.shorten(text)}."
        )
    return int(found[1]), int(found[2] or found[1])
