"""Project files of the window: its session with pictures, and back."""

from __future__ import annotations

import contextlib
import dataclasses
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from texlab.state.chosen import Column, Sample, State
from texlab.state.scene import Past
from texlab.storage.paths import config_dir
from texlab_core.documents.preset_store import PresetStore
from texlab_core.documents.presets import PresetError
from texlab_core.documents.project import MAX_PRESETS, SUFFIX, Project, ProjectColumn, save_project
from texlab_core.documents.project_history import ProjectPast
from texlab_core.documents.project_reading import read_project
from texlab_core.engine.job import job_key
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError
from texlab_core.sheets.export_names import safe_part

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from texlab.style.pictures import Picture
    from texlab_core.engine.inputs import ImageInput, Input
    from texlab_core.engine.steps import FloatImage

# Of the folder of a project that one window leaves for another.
HANDED_ON = "texlab-window-"

AnyInput = TypeVar("AnyInput", bound="Input")

__all__ = [
    "SUFFIX",
    "OpenedProject",
    "is_handed_on",
    "is_project",
    "is_whole_session",
    "open_project",
    "project_of",
    "take_away",
    "write_for_window",
]


@dataclass(frozen=True, eq=False)
class OpenedProject:
    """What a project file turned out to be.

    Parameters
    ----------
    state
        The session in which its columns run; ids count from 1.
    selected
        Id of the chosen column.
    pictures
        Of finished results, by id, (H, W, 3) uint8.
    measures
        What was known of them: numbers by the id of their measure, by id of the column.
    histories
        Earlier results, by id of the column.
    layout
        "explore", "teach", "tune" or "".
    notes
        What there is to say about it, one sentence each.
    """

    state: State
    selected: int
    pictures: Mapping[int, Picture]
    measures: Mapping[int, Mapping[str, float]]
    histories: Mapping[int, tuple[Past, ...]]
    layout: str
    notes: tuple[str, ...] = ()


def is_project(source: object) -> bool:
    """Return whether a source is a project file, by its name."""
    return isinstance(source, str) and source.lower().endswith(SUFFIX)


def is_whole_session(source: str | None) -> bool:
    """Return whether a start with this source replaces columns and notes: a project that is there."""
    return source is not None and is_project(source) and Path(source).is_file()


def project_of(
    state: State,
    selected: int,
    images: Mapping[int, FloatImage],
    layout: str,
    *,
    measures: Mapping[int, Mapping[str, float]] | None = None,
    histories: Mapping[int, Sequence[Past]] | None = None,
    for_student: bool = False,
) -> Project:
    """Return the session as a project; runs in a thread.

    Parameters
    ----------
    state, selected
        The session.
    images
        Finished results by column id, (H, W, C) float32.
    layout
        Name of the layout.
    measures
        Numbers about these results by id of the measure, by column id.
    histories
        Earlier results of the exemplar in use, by column id.
    for_student
        Names of files lose their folders, so that nothing tells of this computer.
    """
    from texlab_core.images.formats.writing import encode_image

    places = [column.id for column in state.columns]
    sample = state.sample
    store = PresetStore(config_dir() / "presets")
    used = dict.fromkeys(column.method for column in state.columns)
    columns = tuple(
        ProjectColumn(
            method=column.method,
            params=column.params,
            inputs=dict(column.inputs),
            size=column.size,
            title=column.name,
            result=encode_image("a.png", images[column.id]) if column.id in images else b"",
            seed=column.seed,
            pinned=column.pinned,
            measures=(measures or {}).get(column.id, {}),
            history=tuple(_put_past(each) for each in (histories or {}).get(column.id, ())),
        )
        for column in state.columns
    )
    project = Project(
        exemplar=None if sample is None else _source(sample),
        columns=columns,
        scale=1.0 if sample is None else sample.scale,
        crop=None if sample is None else sample.crop,
        levels=None if sample is None else sample.used_levels,
        seed=state.seed,
        size=state.size,
        chosen=places.index(selected) if selected in places else 0,
        presets=tuple(each for method in used for each in store.presets(method))[:MAX_PRESETS],
        notes=state.notes,
        layout=layout,
    )
    return _without_folders(project) if for_student else project


def _put_past(past: Past) -> ProjectPast:
    inputs = dict(past.inputs)
    return ProjectPast(
        past.method, past.params, past.size, past.seed, past.thumbnail, inputs=inputs, measures=past.measures
    )


def _take_past(past: ProjectPast, exemplar: ImageInput) -> Past:
    inputs = dict(past.inputs)
    key = job_key(past.method, {"exemplar": exemplar, **inputs}, past.params, past.size, past.seed)
    return Past(
        key,
        exemplar.sha256,
        past.method,
        past.params,
        tuple(inputs.items()),
        past.size,
        past.seed,
        past.thumbnail,
        past.measures,
    )


def _source(sample: Sample) -> ImageInput:
    """Return the source of a sample under a hash of its own pixels."""
    from texlab_core.images.exemplar import take

    source = sample.source
    origin = source.origin
    return take(
        source.pixels,
        source.name,
        notes=source.notes,
        depth=source.depth,
        alpha=source.alpha,
        taken=None if origin is None else origin.taken,
    )


def _without_folders(project: Project) -> Project:
    columns = [
        dataclasses.replace(
            column,
            inputs=_all_without_folder(column.inputs),
            history=[
                dataclasses.replace(past, inputs=_all_without_folder(past.inputs)) for past in column.history
            ],
        )
        for column in project.columns
    ]
    exemplar = project.exemplar
    named = None if exemplar is None else _without_folder(exemplar, "exemplar")
    return dataclasses.replace(project, exemplar=named, columns=columns)


def _all_without_folder(inputs: Mapping[str, Input]) -> dict[str, Input]:
    return {role: _without_folder(each, role) for role, each in inputs.items()}


def _without_folder(given: AnyInput, otherwise: str) -> AnyInput:
    if given.name.startswith("gallery:"):
        return given
    return dataclasses.replace(given, name=given.name.replace("\\", "/").rpartition("/")[2] or otherwise)


def open_project(path: str, first: Callable[[OpenedProject], None] | None = None) -> OpenedProject:
    """Read a project file, and keep those of its presets that are not there yet; runs in a thread.

    Parameters
    ----------
    path
        The file.
    first
        Called with what can be shown before a large exemplar is unpacked: its sample is the part in use alone.

    Raises
    ------
    InputError
        One sentence when it is none, or damaged.
    """
    try:
        project = read_project(path, None if first is None else lambda part: first(_opened(path, part, ())))
    except InputError as error:
        raise InputError(str(error).replace(path, _called(path))) from error
    finally:
        if is_handed_on(path):
            take_away(path)
    return _opened(path, project, _keep_presets(project))


def write_for_window(state: State) -> str:
    """Write a session for a window that is about to be opened, which removes it; return where it is."""
    name = "cell" if state.sample is None else Path(state.sample.source.name.removeprefix("gallery:")).stem
    path = Path(tempfile.mkdtemp(prefix=HANDED_ON)) / f"{safe_part(name)}{SUFFIX}"
    try:
        save_project(path, project_of(state, 1, {}, ""))
    except BaseException as error:
        take_away(str(path))
        if isinstance(error, InputError):
            raise InputError(str(error).replace(str(path), _called(str(path)))) from error
        raise
    return str(path)


def is_handed_on(path: str) -> bool:
    """Return whether a project file was written by :func:`write_for_window`."""
    folder = Path(path).parent
    return folder.name.startswith(HANDED_ON) and folder.parent == Path(tempfile.gettempdir())


def _called(path: str) -> str:
    """Return what to call a project file: the folder of one that was handed on tells nobody anything."""
    return Path(path).stem if is_handed_on(path) else path


def take_away(path: str) -> None:
    """Remove what :func:`write_for_window` wrote, with its folder."""
    with contextlib.suppress(OSError):
        Path(path).unlink(missing_ok=True)
        Path(path).parent.rmdir()


def _opened(path: str, project: Project, kept: Sequence[str]) -> OpenedProject:
    from texlab_core.images.formats.reading import read_image

    sample = None
    if project.exemplar is not None:
        sample = Sample(project.exemplar, project.scale, project.crop, levels=project.levels)
    columns, pictures, measures, histories = [], {}, {}, {}
    used = project.used_exemplar if any(each.history for each in project.columns) else None
    for number, each in enumerate(project.columns, 1):
        inputs = tuple(each.inputs.items())
        columns.append(
            Column(number, each.method, each.params, inputs, each.size, each.title, each.pinned, each.seed)
        )
        if each.history and used is not None:
            histories[number] = tuple(_take_past(past, used) for past in each.history)
        if each.result:
            measures[number] = each.measures
            values = read_image(each.result, f"the result of column {number}").values[..., :3]
            pictures[number] = values.repeat(3, axis=2) if values.shape[2] == 1 else values
    size = project.size
    state = State(sample, tuple(columns), project.seed, size, len(columns) + 1, project.notes)
    names = ", ".join(dict.fromkeys(find_method(each.method).title for each in project.columns))
    count = "1 column" if len(columns) == 1 else f"{len(columns)} columns"
    said = [f"Opened {_called(path)}: {count} ({names})."]
    if unknown := project.unknown_pasts:
        many = "1 earlier result is" if unknown == 1 else f"{unknown} earlier results are"
        said.append(f"{many} left out, whose methods or parameters are not known here.")
    if kept:
        said.append(f"New presets: {', '.join(kept)}.")
    return OpenedProject(
        state, project.chosen + 1 if columns else 0, pictures, measures, histories, project.layout, tuple(said)
    )


def _keep_presets(project: Project) -> list[str]:
    store = PresetStore(config_dir() / "presets")
    there = {preset.key for preset in store.presets()}
    kept = []
    for preset in project.presets:
        if preset.key not in there:
            try:
                store.save(preset, replace=False)
            except PresetError:
                continue
            kept.append(preset.name)
    return kept
