"""Project files: an exemplar, columns with their inputs and results, presets and notes, in one archive.

A project is a zip archive: ``project.json`` says what there is, ``inputs/`` holds the inputs, each once, and
``results/`` the pictures of finished columns, ``history/`` small ones of what a column showed before. It needs
nothing beside it, so that it can be moved and given away. Where a part of a large picture is used, that
part is there too: columns can be shown, and run, before the picture has been unpacked.
"""

from __future__ import annotations

import base64
import dataclasses
import functools
import hashlib
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from texlab_core.documents.embedding import embed
from texlab_core.documents.project_history import MOST, encode_thumbnails, past_to_json
from texlab_core.documents.recipe import known_measures
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import versions
from texlab_core.engine.sizes import size_to_json
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.archive import pack_archive
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    from texlab_core.documents.presets import Preset
    from texlab_core.documents.project_history import ProjectPast
    from texlab_core.engine.inputs import Crop, ImageInput, Input
    from texlab_core.engine.levels import Levels
    from texlab_core.engine.params import Params

FORMAT = "texlab-project"
# Version 1 lacks the part of the exemplar that is used, 2 earlier results; the least that is needed is written.
VERSION = 3
SUFFIX = ".texlab"
MAX_BYTES = 2**30
MAX_FILES = 512
MAX_PRESETS = 128
MAX_NOTE = 100_000
# A picture with fewer pixels is unpacked at once.
LARGE = 2**20
# Of one input, before it goes into the archive.
MAX_INPUT = 256 * 2**20
INPUT_NAME = "inputs/{}.json"
PICTURES = ("source", "pixels", "alpha")


class ProjectError(InputError):
    """A project that is malformed, damaged, or made by a newer version."""


@dataclass(frozen=True, eq=False)
class ProjectColumn:
    """One column.

    Parameters
    ----------
    method, params
        What it runs.
    inputs
        Further inputs by role; the exemplar is the project's.
    size
        Its own, or None for the project's.
    title
        Its name, "" for the method's.
    result
        The picture of its finished result as a PNG file, b"" for none.
    seed
        Its own, or None for the project's.
    pinned
        Whether it is kept in front.
    measures
        Numbers about the result by the ids of their measures.
    history
        Its earlier results, the newest last; the newest 24 are kept.
    """

    method: str
    params: Params
    inputs: Mapping[str, Input] = field(default_factory=dict)
    size: tuple[int, ...] | None = None
    title: str = ""
    result: bytes = b""
    seed: int | None = None
    pinned: bool = False
    measures: Mapping[str, float] = field(default_factory=dict)
    history: Sequence[ProjectPast] = ()


@dataclass(frozen=True, eq=False)
class Project:
    """What a project file holds.

    Parameters
    ----------
    exemplar
        The source image; scale and crop say what is used of it.
    scale, crop
        Scaled first, then cropped.
    levels
        Of what is used of the exemplar; None changes nothing.
    seed, size
        Of the columns that have none of their own.
    columns
        From left to right.
    chosen
        Place of the chosen column.
    presets
        Those of the methods in use.
    notes
        Free text.
    layout
        "explore", "teach" or "tune"; "" for whatever is there.
    unknown_pasts
        How many earlier results of the file were left out, as their methods or parameters are not known here.
    """

    exemplar: ImageInput | None
    columns: Sequence[ProjectColumn]
    scale: float = 1.0
    crop: Crop | None = None
    seed: int = 0
    size: tuple[int, int] = (256, 256)
    chosen: int = 0
    presets: Sequence[Preset] = ()
    notes: str = ""
    layout: str = ""
    levels: Levels | None = None
    unknown_pasts: int = 0

    @property
    def used_exemplar(self) -> ImageInput | None:
        """What is used of the exemplar, as methods get it."""
        from texlab_core.images.exemplar import as_exemplar

        if self.exemplar is None:
            return None
        return as_exemplar(self.exemplar, scale=self.scale, crop=self.crop, levels=self.levels)

    def job(self, place: int) -> Job:
        """Return the job of a column; raises ``InputError`` when it cannot work."""
        from texlab_core.engine.sizes import default_size

        column = self.columns[place]
        inputs = dict(column.inputs)
        method = find_method(column.method)
        if any(spec.name == "exemplar" for spec in method.inputs) and (used := self.used_exemplar) is not None:
            inputs["exemplar"] = used
        size = column.size or default_size(self.size, method.dimensions)
        seed = self.seed if column.seed is None else column.seed
        return Job(method=column.method, inputs=inputs, params=column.params, size=size, seed=seed)


def save_project(path: str | os.PathLike[str], project: Project) -> None:
    """Write a project file, whole or not at all.

    Raises
    ------
    ProjectError
        When an input is too large to be kept.
    InputError
        When it cannot be written.
    """
    write_whole(path, encode_project(project))


def encode_project(project: Project) -> bytes:
    """Return the bytes of a project file; the same project gives the same bytes.

    Raises
    ------
    ProjectError
        When an input is too large to be kept.
    """
    inputs: dict[str, bytes] = {}

    # Earlier results mostly have the inputs of their columns.
    encoded = functools.cache(_encode_input)

    def put(given: Input) -> str:
        name, files = encoded(given)
        inputs.update(files)
        return name

    results = {f"results/{place}.png": each.result for place, each in enumerate(project.columns) if each.result}
    crop, used = project.crop, _used_part(project)
    data: dict[str, Any] = {
        "format": FORMAT,
        "version": 1 if used is None else 2,
        "versions": dict(versions()),
        "exemplar": None if project.exemplar is None else put(project.exemplar),
        "scale": project.scale,
        "crop": None if crop is None else [crop.top, crop.left, crop.height, crop.width],
        "seed": project.seed,
        "size": size_to_json(project.size),
        "columns": [
            {
                "title": column.title,
                "method": column.method,
                "parameters": column.params.to_json(),
                "inputs": {role: put(each) for role, each in column.inputs.items()},
                "size": None if column.size is None else size_to_json(column.size),
                "seed": column.seed,
                "pinned": column.pinned,
                "measures": known_measures(column.measures),
                "result": bool(column.result),
            }
            for column in project.columns
        ],
        "chosen": project.chosen,
        "presets": [each.to_json() for each in project.presets],
        "notes": project.notes,
        "layout": project.layout,
    } | ({} if project.levels is None else {"levels": project.levels.to_json()})
    if used is not None:
        data["used"] = put(used)
    _check_room(inputs, results)
    for place, column in enumerate(project.columns):
        if entries := _add_history(place, column.history, encoded, inputs, results):
            data["columns"][place]["history"] = entries
            data["version"] = VERSION
    return pack_archive({"project.json": strict_json.dumps(data).encode(), **results, **inputs})


def _used_part(project: Project) -> ImageInput | None:
    """Return the part of a large exemplar that is used, before its levels; None where all of it is."""
    from texlab_core.images.exemplar import as_exemplar

    whole = project.exemplar
    if whole is None or math.prod(whole.size) < LARGE or (project.scale == 1.0 and project.crop is None):
        return None
    part = as_exemplar(whole, scale=project.scale, crop=project.crop)
    # It is a picture of its own here, whatever it was taken from.
    return dataclasses.replace(part, origin=None, notes=())


def _add_history(
    place: int,
    history: Sequence[ProjectPast],
    encoded: Callable[[Input], tuple[str, dict[str, bytes]]],
    inputs: dict[str, bytes],
    results: dict[str, bytes],
) -> list[dict[str, Any]]:
    """Add the earlier results of a column as far as there is room, the newest first, and return them as JSON."""
    entries: list[dict[str, Any]] = []
    newest = history[-MOST:]
    for past in reversed(newest):
        more: dict[str, bytes] = {}
        try:
            entry = past_to_json(past, lambda given: encoded(given)[0])
            for given in past.inputs.values():
                more |= encoded(given)[1]
            _check_room(inputs | more, results, {"pictures": b""})
        except ProjectError:
            break
        inputs |= more
        entries.insert(0, entry)
    if entries:
        sheet = {f"history/{place}.png": encode_thumbnails(newest[-len(entries) :])}
        try:
            _check_room(inputs, results | sheet)
        except ProjectError:
            return []
        results |= sheet
    return entries


def _check_room(*parts: Mapping[str, bytes]) -> None:
    count, size = (sum(map(len, parts)), sum(len(data) for part in parts for data in part.values()))
    if count >= MAX_FILES or size > MAX_BYTES // 2:
        raise ProjectError(
            f"The project would have {count + 1} files of {size / 2**20:.0f} MB together; at most {MAX_FILES} "
            f"files of {MAX_BYTES // 2**21} MB are kept."
        )


def _encode_input(given: Input) -> tuple[str, dict[str, bytes]]:
    """Return an input's name, a hash of what it is and how it was taken, and its files."""
    entry = embed(given, limit=MAX_INPUT, used=MAX_INPUT)
    if not any(key in entry for key in (*PICTURES, "arrays", "data")):
        raise ProjectError(f"The input {given.name} is too large to be kept in a project.")
    pictures = {}
    for key in PICTURES:
        if key in entry and entry[key]["encoding"] == "png":
            pictures[key] = base64.b64decode(entry[key]["base64"])
            entry[key] = {"encoding": "png"}
    text = strict_json.packed(entry).encode()
    digest = hashlib.sha256(text)
    for picture in pictures.values():
        digest.update(picture)
    name = digest.hexdigest()
    files = {f"inputs/{name}-{key}.png": picture for key, picture in pictures.items()}
    return name, {INPUT_NAME.format(name): text} | files
