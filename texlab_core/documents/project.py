"""Project files: an exemplar, columns with their inputs and results, presets and notes, in one archive.

A project is a zip archive: ``project.json`` says what there is, ``inputs/`` holds the inputs, each once, and
``results/`` the pictures of finished columns. It needs nothing beside it, so that it can be moved and given away.
Where a part of a large picture is used, that part is there too: columns can be shown, and run, before the picture
has been unpacked.
"""

from __future__ import annotations

import base64
import dataclasses
import hashlib
import math
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from texlab_core.documents.embedding import MAX_DATA_DEPTH, embed
from texlab_core.documents.presets import preset_from_json
from texlab_core.documents.reading import parse_input
from texlab_core.documents.recipe import known_measures, measures_from_json
from texlab_core.engine.inputs import Crop, ImageInput, Input
from texlab_core.engine.job import Job, check_seed, check_size
from texlab_core.engine.levels import Levels
from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import versions
from texlab_core.engine.sizes import size_from_json, size_to_json
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.archive import pack_archive, read_archive
from texlab_core.files.whole import write_whole
from texlab_core.files.wording import printable

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    from texlab_core.documents.presets import Preset
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method

FORMAT = "texlab-project"
# Version 1 lacks the part of the exemplar that is used, and is what is written where it is not wanted.
VERSION = 2
SUFFIX = ".texlab"
MAX_BYTES = 2**30
MAX_FILES = 512
MAX_COLUMNS = 64
MAX_PRESETS = 128
MAX_NOTE = 100_000
_MAX_TITLE = 200
# A picture with fewer pixels is unpacked at once.
LARGE = 2**20
# Of one input, before it goes into the archive.
_MAX_INPUT = 256 * 2**20
_LAYOUTS = ("", "explore", "teach", "tune")
_INPUT = "inputs/{}.json"
_NAMES = re.compile(
    r"project\.json|inputs/[0-9a-f]{64}\.json|inputs/[0-9a-f]{64}-(?:source|pixels|alpha)\.png|results/\d{1,3}\.png"
)
_KEYS = ("format", "version", "versions", "exemplar", "scale", "crop", "seed", "size", "columns", "chosen",
         "presets", "notes", "layout", "levels", "used")  # fmt: skip
_COLUMN_KEYS = ("title", "method", "parameters", "inputs", "size", "seed", "pinned", "result", "measures")
_PIXELS = ("source", "pixels", "alpha")


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

    def job(self, place: int) -> Job:
        """Return the job of a column; raises ``InputError`` when it cannot work."""
        from texlab_core.engine.sizes import default_size
        from texlab_core.images.exemplar import as_exemplar

        column = self.columns[place]
        inputs = dict(column.inputs)
        method = find_method(column.method)
        if self.exemplar is not None and any(spec.name == "exemplar" for spec in method.inputs):
            inputs["exemplar"] = as_exemplar(self.exemplar, scale=self.scale, crop=self.crop, levels=self.levels)
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
    results = {f"results/{place}.png": each.result for place, each in enumerate(project.columns) if each.result}
    crop = project.crop
    data = {
        "format": FORMAT,
        "version": VERSION if (used := _used_part(project)) is not None else 1,
        "versions": dict(versions()),
        "exemplar": None if project.exemplar is None else _put(project.exemplar, inputs),
        "scale": project.scale,
        "crop": None if crop is None else [crop.top, crop.left, crop.height, crop.width],
        "seed": project.seed,
        "size": size_to_json(project.size),
        "columns": [
            {
                "title": column.title,
                "method": column.method,
                "parameters": column.params.to_json(),
                "inputs": {role: _put(each, inputs) for role, each in column.inputs.items()},
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
        data["used"] = _put(used, inputs)
    _check_room(inputs, results)
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


def _check_room(*parts: Mapping[str, bytes]) -> None:
    count, size = (sum(map(len, parts)), sum(len(data) for part in parts for data in part.values()))
    if count >= MAX_FILES or size > MAX_BYTES // 2:
        raise ProjectError(
            f"The project would have {count + 1} files of {size / 2**20:.0f} MB together; at most {MAX_FILES} "
            f"files of {MAX_BYTES // 2**21} MB are kept."
        )


def _put(given: Input, files: dict[str, bytes]) -> str:
    """Add an input to the files and return its name there, a hash of what it is and how it was taken."""
    entry = embed(given, limit=_MAX_INPUT, used=_MAX_INPUT)
    if not any(key in entry for key in (*_PIXELS, "arrays", "data")):
        raise ProjectError(f"The input {given.name} is too large to be kept in a project.")
    pictures = {}
    for key in _PIXELS:
        if key in entry and entry[key]["encoding"] == "png":
            pictures[key] = base64.b64decode(entry[key]["base64"])
            entry[key] = {"encoding": "png"}
    text = strict_json.packed(entry).encode()
    digest = hashlib.sha256(text)
    for picture in pictures.values():
        digest.update(picture)
    name = digest.hexdigest()
    files[_INPUT.format(name)] = text
    files.update({f"inputs/{name}-{key}.png": picture for key, picture in pictures.items()})
    return name


def read_project(path: str | os.PathLike[str], first: Callable[[Project], None] | None = None) -> Project:
    """Read a project file; whatever it holds, the answer is a checked project or one sentence.

    Parameters
    ----------
    path
        The file.
    first
        Called, before a large exemplar is unpacked, with the project whose exemplar is the part in use, at scale 1
        and without a crop: its columns work on the very same pixels. Not called where there is no such part.

    Raises
    ------
    ProjectError
        When it is no project, damaged, from a newer version, or for something that does not exist here.
    """
    files = read_archive(path, _NAMES, max_files=MAX_FILES, max_bytes=MAX_BYTES, error=ProjectError)
    what = f"the project {printable(str(path))}"
    if "project.json" not in files:
        raise ProjectError(f"{what[4:].capitalize()} lacks its project.json.")
    data = strict_json.loads(files["project.json"], what=what, max_bytes=2**24, error=ProjectError)
    try:
        checked = strict_json.check_document(data, "project", form=FORMAT, version=VERSION, error=ProjectError)
        strict_json.check_keys(checked, _KEYS, ProjectError)
        reader = _Reader(files)
        if first is not None and checked.get("used") is not None:
            first(reader.project(checked | {"exemplar": checked["used"], "scale": 1.0, "crop": None}))
        made = reader.project(checked)
        reader.check_used(checked, made)
        return made
    except InputError as error:
        raise ProjectError(f"T{what[1:]} cannot be used: {error}") from error


class _Reader:
    """Makes a project of what was in the archive; each input is unpacked once."""

    def __init__(self, files: Mapping[str, bytes]) -> None:
        self._files = files
        self._found: dict[tuple[str, str], Input] = {}

    def project(self, data: dict[str, Any]) -> Project:
        columns = _list(data, "columns", MAX_COLUMNS)
        exemplar = data.get("exemplar")
        image = None if exemplar is None else self._input(exemplar, "exemplar", "image")
        assert image is None or isinstance(image, ImageInput)
        scale = data.get("scale")
        if isinstance(scale, bool) or not isinstance(scale, int | float) or not 0 < scale <= 1:
            raise ProjectError(f"scale: must be above 0 and at most 1, got {strict_json.shorten(scale)}.")
        size = size_from_json(data.get("size"), 2)
        chosen = data.get("chosen")
        if type(chosen) is not int or not 0 <= chosen <= max(0, len(columns) - 1):
            raise ProjectError(f"chosen: must be the place of a column, got {strict_json.shorten(chosen)}.")
        if data.get("layout") not in _LAYOUTS:
            raise ProjectError(f"layout: must be one of {', '.join(_LAYOUTS[1:])}.")
        made = Project(
            exemplar=image,
            columns=tuple(self._column(each, place) for place, each in enumerate(columns)),
            scale=float(scale),
            crop=_crop(data.get("crop")),
            seed=check_seed(data.get("seed")),
            size=(size[0], size[1]),
            chosen=chosen,
            presets=tuple(preset_from_json(each, what="a preset") for each in _list(data, "presets", MAX_PRESETS)),
            notes=_text(data, "notes", MAX_NOTE),
            layout=str(data["layout"]),
            levels=None if data.get("levels") is None else Levels.from_json(data["levels"]),
        )
        _check_crop(made)
        return made

    def check_used(self, data: dict[str, Any], whole: Project) -> None:
        """Raise ``ProjectError`` when the part of the exemplar that is used is another one."""
        from texlab_core.images.exemplar import as_exemplar

        if data.get("used") is None:
            return
        part = self._input(data["used"], "used", "image")
        exemplar = whole.exemplar
        if exemplar is None or as_exemplar(exemplar, scale=whole.scale, crop=whole.crop).sha256 != part.sha256:
            raise ProjectError("used: is not the part of the exemplar that is used.")

    def _column(self, data: Any, place: int) -> ProjectColumn:
        if not isinstance(data, dict):
            raise ProjectError(f"columns: must be objects, got {strict_json.shorten(data)}.")
        strict_json.check_keys(data, _COLUMN_KEYS, ProjectError)
        method = find_method(_text(data, "method", _MAX_TITLE))
        parameters, inputs = data.get("parameters"), data.get("inputs")
        if not isinstance(parameters, dict) or not isinstance(inputs, dict):
            raise ProjectError("parameters and inputs of a column must be objects.")
        size, seed = data.get("size"), data.get("seed")
        result, pinned = data.get("result"), data.get("pinned", False)
        for key, value in (("result", result), ("pinned", pinned)):
            if not isinstance(value, bool):
                raise ProjectError(f"{key}: must be true or false, got {strict_json.shorten(value)}.")
        picture = self._files.get(f"results/{place}.png", b"") if result else b""
        if result and not picture.startswith(b"\x89PNG"):
            raise ProjectError(f"the result of column {place + 1} is missing.")
        return ProjectColumn(
            method=method.id,
            params=method.params.from_json(parameters),
            inputs=frozen_mapping(self._inputs(inputs, method)),
            size=None if size is None else check_size(size_from_json(size, method.dimensions), method.dimensions),
            title=printable(_text(data, "title", _MAX_TITLE)),
            result=picture,
            seed=None if seed is None else check_seed(seed),
            pinned=pinned,
            measures=measures_from_json(data.get("measures", {})),
        )

    def _inputs(self, data: dict[str, Any], method: Method) -> dict[str, Input]:
        specs = {spec.name: spec for spec in method.inputs}
        for role in data:
            if role not in specs or role == "exemplar":
                raise ProjectError(f"{method.title} takes no input {strict_json.shorten(role)} in a project.")
        return {role: self._input(name, role, specs[role].kind) for role, name in data.items()}

    def _input(self, name: Any, role: str, kind: str) -> Input:
        text = self._files.get(_INPUT.format(name)) if isinstance(name, str) else None
        if text is None:
            raise ProjectError(f"the input {role} is missing.")
        if (name, kind) not in self._found:
            entry = strict_json.loads(
                text, what=f"the input {role}", max_bytes=2 * _MAX_INPUT, max_depth=MAX_DATA_DEPTH + 8
            )
            if not isinstance(entry, dict):
                raise ProjectError(f"the input {role} must be an object.")
            for key in _PIXELS:
                held = entry.get(key)
                if isinstance(held, dict) and held.get("encoding") == "png":
                    picture = self._files.get(f"inputs/{name}-{key}.png", b"")
                    entry[key] = {"encoding": "png", "bytes": picture}
            self._found[name, kind] = parse_input(role, entry, kind).restore()
        return self._found[name, kind]


def _list(data: dict[str, Any], key: str, most: int) -> list[Any]:
    value = data.get(key)
    if not isinstance(value, list) or len(value) > most:
        raise ProjectError(f"{key}: must be a list of at most {most}.")
    return value


def _text(data: dict[str, Any], key: str, most: int) -> str:
    value = data.get(key)
    if not isinstance(value, str) or len(value) > most:
        raise ProjectError(f"{key}: must be a text of at most {most} characters.")
    return value


def _crop(data: Any) -> Crop | None:
    if data is None:
        return None
    sides_ok = isinstance(data, list) and len(data) == 4
    if not sides_ok or not all(type(side) is int and 0 <= side <= 2**26 for side in data):
        raise ProjectError("crop: must be four whole numbers: top, left, height and width.")
    return Crop(*data)


def _check_crop(project: Project) -> None:
    """Raise ``ImageError`` when scale and crop do not go with the exemplar."""
    if project.exemplar is not None:
        from texlab_core.images.exemplar import as_exemplar

        as_exemplar(project.exemplar, scale=project.scale, crop=project.crop)
