"""Opening, dropping, pasting and saving: what is read and written in the background."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING

from texlab.columns.status import figures
from texlab.state.changes import (
    Opened,
    fitting,
    fresh_ids,
    restored,
    sample_of,
    with_code,
    with_crop_of,
    with_method,
)
from texlab.state.chosen import Sample
from texlab.storage.projects import OpenedProject, is_handed_on, is_project, open_project
from texlab.storage.reading import (
    Choice,
    Document,
    Lacking,
    is_document,
    lacking,
    open_document,
    open_source,
)
from texlab.window.save_kinds import saved_words
from texlab_core.engine.inputs import ImageInput

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.state.session import Session
    from texlab.storage.reading import Source
    from texlab.storage.settings import Settings
    from texlab_core.documents.presets import Preset
    from texlab_core.engine.result import Result
    from texlab_core.images.formats.writing import Bits


class Opener:
    """Opens and saves through the controller's background workers.

    Presets go to ``import_preset(preset)``, pictures that were opened together to ``show_several(sources)``.
    """

    def __init__(
        self,
        session: Session,
        controller: Controller,
        settings: Settings,
        import_preset: Callable[[Preset], None],
        show_several: Callable[[Sequence[Source]], None],
    ) -> None:
        self._session = session
        self._controller = controller
        self._settings = settings
        self._import_preset = import_preset
        self._show_several = show_several
        self.layout_wanted: Callable[[str], None] = lambda _: None
        self.locate_wanted: Callable[[Lacking], None] = lambda _: None
        self._newest = 0
        self._read: tuple[ImageInput, Choice] | None = None

    def open_all(self, sources: Sequence[Source]) -> None:
        """Open what came together: every code and preset, and of several pictures the first that can be read."""
        for source in sources:
            if is_document(source) or is_project(source):
                self.open(source)
        pictures = [source for source in sources if not is_document(source) and not is_project(source)]
        if len(pictures) > 1:
            self._show_several(pictures)
            self._controller.said.emit(
                f"{len(pictures)} pictures were opened; under the gallery is a strip to choose from."
            )
        if pictures:
            self.open_first_of([Choice(source) for source in pictures])

    def open(self, source: Source) -> None:
        """Open a path, gallery:NAME, the bytes of a file or what was pasted; the newest of several images wins."""
        if isinstance(source, str) and is_project(source):
            self.open_project(source)
        elif is_document(source):
            self._open_document(source)
        else:
            self.open_first_of([Choice(source)])

    def open_first_of(self, choices: Sequence[Choice]) -> None:
        """Open the first of these images that can be read; what is wrong with the others is said."""
        choice, others = choices[0], choices[1:]
        self._newest += 1
        number = self._newest

        def work(task: Task) -> Opened | Lacking:
            return lacking(choice.source) or open_source(choice.source, task.should_stop, choice.alpha)

        def done(opened: Opened | Lacking) -> None:
            if number != self._newest:
                return
            if isinstance(opened, Lacking):
                self.locate_wanted(opened)
            else:
                self._take(opened, choice)

        def failed() -> None:
            if others and number == self._newest:
                self.open_first_of(others)

        self._controller.once("open", work, done, failed)

    def open_failure(self, name: str, beside: str = "") -> None:
        """Open an example of the failure gallery: its exemplar, method, parameters, size and seed.

        A column of the method ``beside`` is added when there is none.
        """
        self._newest += 1
        number = self._newest

        def work(task: Task) -> Opened:
            from texlab_core.findings.failures import find_example

            example = find_example(name)
            job = example.job(should_stop=task.should_stop)
            image = job.inputs["exemplar"]
            assert isinstance(image, ImageInput)
            return Opened(image, None, job)

        def done(opened: Opened) -> None:
            from texlab_core.findings.failures import find_example

            if number != self._newest:
                return
            self._restore(opened, f"failure {name}", beside)
            example = find_example(name)
            self._controller.said.emit(f"{example.title}: {example.look}")

        self._controller.once("open-failure", work, done)

    def _restore(self, opened: Opened, text: str, beside: str = "") -> None:
        first = self._session.state.sample is None
        state, column_id = restored(self._session.state, opened)
        if beside:
            state = with_method(state, beside)
        self._session.apply(state, text)
        self._session.select(column_id)
        self._forget_start(first)

    def open_located(self, source: str, given: Mapping[str, str]) -> None:
        """Open a saved result with the images that it lacks, by role."""
        self._newest += 1
        number = self._newest

        def done(opened: Opened) -> None:
            if number == self._newest:
                self._take(opened, Choice(source))

        self._controller.once("open", lambda task: open_source(source, task.should_stop, given=given), done)

    def open_project(self, path: str, otherwise: Sequence[Choice] = ()) -> None:
        """Open a project file, or the first of these images when it cannot be read."""
        # An image that is still being read comes too late.
        self._newest += 1
        number = self._newest

        parts: list[Sample] = []

        def show(opened: OpenedProject) -> None:
            if number != self._newest:
                return
            first = self._session.state.sample is None
            self._session.apply(fresh_ids(opened.state, self._session.state.next_id), f"project {Path(path).name}")
            columns = self._session.state.columns
            if columns:
                self._session.select(columns[max(opened.selected - 1, 0)].id)
            for place, picture in opened.pictures.items():
                self._controller.show_stored(columns[place - 1].id, picture, opened.measures[place])
            for place, history in opened.histories.items():
                self._controller.remember(columns[place - 1].id, history)
            self._forget_start(first)

        def show_first(opened: OpenedProject) -> None:
            show(opened)
            if number == self._newest and opened.state.sample is not None:
                parts.append(opened.state.sample)

        def done(opened: OpenedProject) -> None:
            whole = opened.state.sample
            if parts and whole is not None:
                # Also where something else was opened meanwhile: undo leads back to it.
                self._session.replace_sample(parts[0], whole)
            else:
                show(opened)
            if number != self._newest:
                return
            if not is_handed_on(path):
                self._settings.add_recent(path)
            if opened.layout:
                self.layout_wanted(opened.layout)
            self._controller.said.emit(" ".join(opened.notes))

        def failed() -> None:
            if otherwise and number == self._newest:
                self.open_first_of(otherwise)

        self._controller.once(
            "open-project", lambda task: open_project(path, task.progress), done, failed, show_first
        )

    def _open_document(self, path: str) -> None:
        def work(task: Task) -> Document:
            return open_document(path)

        self._controller.once("open-document", work, self._take_document)

    def _take_document(self, document: Document) -> None:
        if document.preset is not None:
            self._import_preset(document.preset)
        if document.code is None:
            return
        state, column_id = with_code(self._session.state, document.code, self._session.selected_id)
        self._session.apply(state, f"code {document.code.name}")
        self._session.select(column_id)
        self._controller.said.emit(f"MSG works from the code {document.code.name}, not from the exemplar.")

    def _take(self, opened: Opened, choice: Choice) -> None:
        first = self._session.state.sample is None
        if opened.job is not None:
            self._controller.ask_first()
            self._restore(opened, "restore a result")
            told = ", ".join(each.text for each in figures(opened.measures))
            saved_with = f" It was saved with {told}." if told else ""
            self._controller.said.emit(
                f"The saved result's exemplar, parameters, size and seed were restored.{saved_with}"
            )
            return
        if opened.path is not None:
            self._settings.add_recent(opened.path)
        sample = dataclasses.replace(
            sample_of(opened.image, opened.path),
            alpha=choice.alpha,
            levels=choice.levels,
            look_only=choice.look_only,
        )
        self._read = opened.image, choice
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

    def read_transparency(self, alpha: str) -> None:
        """Read the exemplar again with its transparency used in another way; scale and crop stay."""
        sample = self._session.state.sample
        source = self._source_of(sample)
        if sample is None or source is None:
            return
        self._newest += 1
        number = self._newest

        def done(opened: Opened) -> None:
            if number == self._newest and self._session.state.sample is sample:
                changed = dataclasses.replace(sample, source=sample_of(opened.image, None).source, alpha=alpha)
                self._read = changed.source, Choice(source)
                self._session.set_sample(changed)

        self._controller.once("open", lambda task: open_source(source, task.should_stop, alpha), done)

    def _source_of(self, sample: Sample | None) -> Source | None:
        if sample is None or sample.path is not None:
            return None if sample is None else sample.path
        # What was pasted is still there while it is the exemplar.
        same = self._read is not None and self._read[0] is sample.source
        return self._read[1].source if same and self._read is not None else None

    def use_as_exemplar(self, result: Result) -> None:
        """Make a result the exemplar."""

        def work(task: Task) -> ImageInput:
            from texlab_core.images.exemplar import as_exemplar

            image = as_exemplar(result.image, name=f"{result.job.method} result")
            before = result.job.inputs.get("exemplar")
            return dataclasses.replace(image, depth=getattr(before, "depth", 8))

        self._controller.once("use", work, lambda image: self._session.set_sample(Sample(image)))

    def save(
        self,
        result: Result,
        path: str,
        bits: Bits | None = None,
        measures: Mapping[str, float] | None = None,
    ) -> None:
        """Save a result with recipe and numbers, at the exemplar's own depth unless another one is given."""
        exemplar = self._controller.exemplar

        def work(task: Task) -> str:
            return save_as(with_exemplar(result, exemplar), path, bits, measures)

        self._controller.once("save", work, self._controller.said.emit)


def with_exemplar(result: Result, exemplar: ImageInput | None) -> Result:
    """Return the result with the exemplar in use, where that has the same pixels.

    A finished result is found again by the pixels it was made of; depth and transparency are those of today.
    """
    job = result.job
    made_of = job.inputs.get("exemplar")
    if exemplar is None or made_of is None or made_of.sha256 != exemplar.sha256:
        return result
    return dataclasses.replace(result, job=dataclasses.replace(job, inputs={**job.inputs, "exemplar": exemplar}))


def save_as(result: Result, path: str, bits: Bits | None, measures: Mapping[str, float] | None = None) -> str:
    """Save a result (in a worker's thread), and return what there is to say of it."""
    from texlab_core.documents.record import carried_alpha, result_bits, save_result
    from texlab_core.images.formats.writing import can_hold_alpha

    wanted = result_bits(result, path) if bits is None else bits
    flat = result.volume is None and can_hold_alpha(path)
    alpha = carried_alpha(result) if flat else None
    notes = save_result(result, path, bits=wanted, alpha=alpha, measures=measures)
    exemplar = result.job.inputs.get("exemplar")
    has_alpha = getattr(exemplar, "alpha", None) is not None
    fate = "carried" if alpha is not None else "lost" if has_alpha else "none"
    said = saved_words(Path(path), wanted, getattr(exemplar, "depth", wanted), fate)
    return " ".join((said, *notes))
