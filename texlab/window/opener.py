"""Opening, dropping, pasting and saving: what is read and written in the background."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from texlab.state.changes import Opened, fitting, restored, sample_of, with_code, with_crop_of
from texlab.state.session import Sample, Session
from texlab.storage.reading import Choice, Document, is_document, open_document, open_source
from texlab_core.engine.inputs import ImageInput

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.storage.settings import Settings
    from texlab_core.documents.presets import Preset
    from texlab_core.engine.result import Result


class Opener:
    """Opens and saves through the controller's background workers; presets go to ``import_preset(preset)``."""

    def __init__(
        self,
        session: Session,
        controller: Controller,
        settings: Settings,
        import_preset: Callable[[Preset], None],
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
            return open_source(choice.source, task.should_stop)

        def done(opened: Opened) -> None:
            if number == self._newest:
                self._take(opened, choice)

        def failed() -> None:
            if others and number == self._newest:
                self.open_first_of(others)

        self._controller.once("open", work, done, failed)

    def open_failure(self, name: str) -> None:
        """Open an example of the failure gallery: its exemplar, method, parameters, size and seed."""
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
            self._restore(opened, f"failure {name}")
            example = find_example(name)
            self._controller.said.emit(f"{example.title}: {example.look}")

        self._controller.once("open-failure", work, done)

    def _restore(self, opened: Opened, text: str) -> None:
        first = self._session.state.sample is None
        state, column_id = restored(self._session.state, opened)
        self._session.apply(state, text)
        self._session.select(column_id)
        self._forget_start(first)

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

            image = as_exemplar(result.image, name=f"{result.job.method} result")
            before = result.job.inputs.get("exemplar")
            return dataclasses.replace(image, depth=getattr(before, "depth", 8))

        self._controller.once("use", work, lambda image: self._session.set_sample(Sample(image)))

    def save(self, result: Result, path: str) -> None:
        """Save a result with its recipe."""

        def work(task: Task) -> tuple[str, ...]:
            from texlab_core.documents.record import save_result

            return save_result(result, path)

        def done(notes: tuple[str, ...]) -> None:
            self._controller.said.emit(" ".join((f"Saved {path} with its recipe.", *notes)))

        self._controller.once("save", work, done)
