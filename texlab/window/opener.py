"""Opening, dropping, pasting and saving: what is read and written in the background."""

from __future__ import annotations

import contextlib
import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from texlab.state.session import Column, Sample, Session, State
from texlab.storage.kept_exemplar import Kept, kept_path, load
from texlab_core.engine.inputs import Crop, DataInput, ImageInput

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.storage.settings import Settings
    from texlab_core.engine.run import Job
    from texlab_core.engine.steps import Result

COMFORTABLE_SIDE = 256
SMALLEST_SIDE = 2
DOCUMENT_SUFFIX = ".json"
IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".bmp", ".pgm", ".ppm", ".pnm")


@dataclass(frozen=True, eq=False)
class Opened:
    """What a file turned out to be: an image, or a saved result with the job that made it."""

    image: ImageInput
    path: str | None
    job: Job | None = None


@dataclass(frozen=True)
class Choice:
    """An exemplar to open: where it is, and how much of it; without a scale it is taken as a fresh image is."""

    source: str | bytes | Kept
    crop: Crop | None = None
    scale: float | None = None


@dataclass(frozen=True)
class Document:
    """What a JSON file turned out to be: a code, or else a preset."""

    path: str
    code: DataInput | None = None


def is_document(source: str | bytes) -> bool:
    """Return whether a source is a file that goes into a column instead of being the exemplar."""
    return isinstance(source, str) and source.lower().endswith(DOCUMENT_SUFFIX)


def open_document(path: str) -> Document:
    """Read a code or recognize a preset by its ``format``; runs in a thread.

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
        return Document(path, codefile.code_input(code, file.name))
    if kind != presets.FORMAT:
        raise InputError(f"{file.name} is neither a code of MSG nor a preset.")
    return Document(path)


def open_source(source: str | bytes | Kept) -> Opened:
    """Read an image or a saved result (a path, gallery:NAME, the bytes of a file, or what was kept); in a thread.

    Raises
    ------
    InputError
        One sentence when it is neither.
    """
    from texlab_core.documents.reading import read_recipe
    from texlab_core.errors import NoRecipeError
    from texlab_core.images.exemplar import as_exemplar

    if isinstance(source, Kept):
        return Opened(load(source), None)
    path = None if isinstance(source, bytes) or source.startswith("gallery:") else str(Path(source).absolute())
    if path is not None or isinstance(source, bytes):
        with contextlib.suppress(NoRecipeError):
            job = read_recipe(source).job()
            image = job.inputs.get("exemplar")
            if isinstance(image, ImageInput):
                return Opened(image, None, job)
    return Opened(as_exemplar(source), path)


def sample_of(image: ImageInput, path: str | None) -> Sample:
    """Return the sample for an image: a photograph is scaled to a comfortable size at first."""
    sample = sample_as_used(image, path)
    side = max(image.size)
    if sample.source is not image or side <= COMFORTABLE_SIDE:
        return sample
    return dataclasses.replace(sample, scale=round(COMFORTABLE_SIDE / side, 3))


def sample_as_used(image: ImageInput, path: str | None = None) -> Sample:
    """Return the sample whose exemplar is this image, pixel by pixel."""
    if image.origin is not None and (image.origin.scale != 1.0 or image.origin.crop is not None):
        whole = ImageInput(image.origin.pixels, image.name, image.sha256 + ":source", None, image.notes)
        return Sample(whole, image.origin.scale, image.origin.crop, path)
    return Sample(image, 1.0, None, path)


def fitting(sample: Sample) -> Sample:
    """Return the sample, without its crop and scale where the file has become too small for them."""
    from texlab_core.images.exemplar import scaled_size

    height, width = scaled_size(*sample.source.size, sample.scale)
    if min(height, width) < SMALLEST_SIDE:
        return dataclasses.replace(sample, scale=1.0, crop=None)
    crop = sample.crop
    if crop is None or (
        min(crop.top, crop.left) >= 0
        and min(crop.height, crop.width) >= SMALLEST_SIDE
        and crop.top + crop.height <= height
        and crop.left + crop.width <= width
    ):
        return sample
    return dataclasses.replace(sample, crop=None)


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
    if isinstance(path, str):
        return [Choice(path, box, factor)]
    if name in [entry.uri for entry in gallery()]:
        return [Choice(str(name), box, factor)]
    return [Choice(Kept(kept_path(), str(name)), box, factor)] if kept_path().is_file() else []


def with_crop_of(sample: Sample, before: Sample | None) -> Sample:
    """Keep the crop from one texture of the gallery to the next, so that they can be compared."""
    if before is None or before.crop is None or before.scale != sample.scale:
        return sample
    crop, (height, width) = before.crop, sample.source.size
    both = all(each.source.name.startswith("gallery:") for each in (before, sample))
    fits = crop.top + crop.height <= height and crop.left + crop.width <= width
    return dataclasses.replace(sample, crop=crop) if both and fits else sample


def restored(state: State, opened: Opened) -> tuple[State, int]:
    """Return the state in which a saved result's job runs, and the id of its column.

    The first column with the same method takes the parameters; without one, a column is added.
    """
    job = opened.job
    assert job is not None
    extra = tuple((name, value) for name, value in job.inputs.items() if name != "exemplar")
    state = dataclasses.replace(state, sample=sample_as_used(opened.image), seed=job.seed, size=job.size)
    for column in state.columns:
        if column.method == job.method:
            changed = dataclasses.replace(column, params=job.params, inputs=extra, size=None)
            return state.with_column(changed), column.id
    added = Column(state.next_id, job.method, job.params, extra)
    return dataclasses.replace(state, columns=(*state.columns, added), next_id=state.next_id + 1), added.id


def with_code(state: State, code: DataInput, chosen: int) -> tuple[State, int]:
    """Return the state in which MSG works from a code, and the id of its column.

    The chosen column takes it, or the first one of MSG; without one, a column is added.
    """
    from texlab_core.engine.registry import find_method

    inputs = (("code", code),)
    for column in sorted(state.columns, key=lambda column: column.id != chosen):
        if column.method == "msg":
            return state.with_column(dataclasses.replace(column, inputs=inputs)), column.id
    added = Column(state.next_id, "msg", find_method("msg").params(), inputs)
    return dataclasses.replace(state, columns=(*state.columns, added), next_id=state.next_id + 1), added.id


class Opener:
    """Opens and saves through the controller's background workers; presets go to ``import_preset(path)``."""

    def __init__(
        self,
        session: Session,
        controller: Controller,
        settings: Settings,
        import_preset: Callable[[str], None],
    ) -> None:
        self._session = session
        self._controller = controller
        self._settings = settings
        self._import_preset = import_preset
        self._newest = 0

    def open(self, source: str | bytes) -> None:
        """Open a path, gallery:NAME or the bytes of a file; the newest of several images wins."""
        if isinstance(source, str) and is_document(source):
            self._open_document(source)
        else:
            self.open_first_of([Choice(source)])

    def open_first_of(self, choices: Sequence[Choice]) -> None:
        """Open the first of these images that can be read; what is wrong with the others is said."""
        choice, others = choices[0], choices[1:]
        self._newest += 1
        number = self._newest

        def work(task: Task) -> Opened:
            return open_source(choice.source)

        def done(opened: Opened) -> None:
            if number == self._newest:
                self._take(opened, choice)

        def failed() -> None:
            if others and number == self._newest:
                self.open_first_of(others)

        self._controller.once("open", work, done, failed)

    def _open_document(self, path: str) -> None:
        def work(task: Task) -> Document:
            return open_document(path)

        self._controller.once("open-document", work, self._take_document)

    def _take_document(self, document: Document) -> None:
        if document.code is None:
            self._import_preset(document.path)
            return
        state, column_id = with_code(self._session.state, document.code, self._session.selected_id)
        self._session.apply(state, f"code {document.code.name}")
        self._session.select(column_id)
        self._controller.said.emit(f"MSG works from the code {document.code.name}, not from the exemplar.")

    def _take(self, opened: Opened, choice: Choice) -> None:
        first = self._session.state.sample is None
        if opened.job is not None:
            state, column_id = restored(self._session.state, opened)
            self._session.apply(state, "restore a result")
            self._session.select(column_id)
            self._forget_start(first)
            self._controller.said.emit("The saved result's exemplar, parameters, size and seed were restored.")
            return
        if opened.path is not None:
            self._settings.add_recent(opened.path)
        sample = sample_of(opened.image, opened.path)
        if choice.scale is not None:
            sample = fitting(dataclasses.replace(sample, scale=choice.scale, crop=choice.crop))
        else:
            sample = with_crop_of(sample, self._session.state.sample)
        self._session.set_sample(sample)
        self._forget_start(first)
        if opened.image.notes:
            self._controller.said.emit(" ".join(opened.image.notes))

    def _forget_start(self, first: bool) -> None:
        if first:
            # Nobody wants to undo to an empty window.
            self._session.reset_history()

    def use_as_exemplar(self, result: Result) -> None:
        """Make a result the exemplar."""

        def work(task: Task) -> ImageInput:
            from texlab_core.images.exemplar import as_exemplar

            return as_exemplar(result.image, name=f"{result.job.method} result")

        self._controller.once("use", work, lambda image: self._session.set_sample(Sample(image)))

    def save(self, result: Result, path: str) -> None:
        """Save a result with its recipe."""

        def work(task: Task) -> str:
            from texlab_core.documents.record import save_result

            save_result(result, path)
            return path

        def done(saved: Any) -> None:
            self._controller.said.emit(f"Saved {saved} with its recipe.")

        self._controller.once("save", work, done)
