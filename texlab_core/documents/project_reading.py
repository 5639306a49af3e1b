"""Reads project files; whatever they hold, the answer is a checked project or one sentence."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from texlab_core.documents.embedding import MAX_DATA_DEPTH
from texlab_core.documents.presets import preset_from_json
from texlab_core.documents.project import (
    FORMAT,
    INPUT_NAME,
    MAX_BYTES,
    MAX_FILES,
    MAX_INPUT,
    MAX_NOTE,
    MAX_PRESETS,
    PICTURES,
    VERSION,
    Project,
    ProjectColumn,
    ProjectError,
)
from texlab_core.documents.project_history import history_from_json
from texlab_core.documents.reading import parse_input
from texlab_core.documents.recipe import measures_from_json
from texlab_core.engine.inputs import Crop, ImageInput, Input
from texlab_core.engine.job import check_seed, check_size
from texlab_core.engine.levels import Levels
from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_from_json
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.archive import read_archive
from texlab_core.files.wording import printable, sentence_case

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping

    from texlab_core.engine.registry import Method

MAX_COLUMNS = 64
_MAX_TITLE = 200
_LAYOUTS = ("", "explore", "teach", "tune")
_NAMES = re.compile(
    r"project\.json|inputs/[0-9a-f]{64}\.json|inputs/[0-9a-f]{64}-(?:source|pixels|alpha)\.png"
    r"|(?:results|history)/\d{1,3}\.png"
)
_KEYS = ("format", "version", "versions", "exemplar", "scale", "crop", "seed", "size", "columns", "chosen",
         "presets", "notes", "layout", "levels", "used")  # fmt: skip
_COLUMN_KEYS = ("title", "method", "parameters", "inputs", "size", "seed", "pinned", "result", "measures",
                "history")  # fmt: skip


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
        raise ProjectError(f"{sentence_case(what[4:])} lacks its project.json.")
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
        taken = tuple(self._column(each, place) for place, each in enumerate(columns))
        made = Project(
            exemplar=image,
            columns=taken,
            unknown_pasts=sum(
                len(data.get("history", ())) - len(column.history)
                for data, column in zip(columns, taken, strict=True)
            ),
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
            history=history_from_json(
                data.get("history", []), self._files.get(f"history/{place}.png", b""), self._inputs
            ),
        )

    def _inputs(self, data: dict[str, Any], method: Method) -> dict[str, Input]:
        specs = {spec.name: spec for spec in method.inputs}
        for role in data:
            if role not in specs or role == "exemplar":
                raise ProjectError(f"{method.title} takes no input {strict_json.shorten(role)} in a project.")
        return {role: self._input(name, role, specs[role].kind) for role, name in data.items()}

    def _input(self, name: Any, role: str, kind: str) -> Input:
        text = self._files.get(INPUT_NAME.format(name)) if isinstance(name, str) else None
        if text is None:
            raise ProjectError(f"the input {role} is missing.")
        if (name, kind) not in self._found:
            entry = strict_json.loads(
                text, what=f"the input {role}", max_bytes=2 * MAX_INPUT, max_depth=MAX_DATA_DEPTH + 8
            )
            if not isinstance(entry, dict):
                raise ProjectError(f"the input {role} must be an object.")
            for key in PICTURES:
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
