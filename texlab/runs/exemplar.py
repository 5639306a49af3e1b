"""The exemplar as the methods get it: scaled and cropped in the background."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.runs.worker import Worker
from texlab.style.pictures import to_picture

if TYPE_CHECKING:
    from texlab.state.session import Sample
    from texlab.style.pictures import Picture
    from texlab_core.engine.inputs import ImageInput


@dataclasses.dataclass(frozen=True, eq=False)
class Prepared:
    """The exemplar as the methods get it, and its scaled source as it is shown."""

    exemplar: ImageInput
    source_picture: Picture
    source_scaled: ImageInput


class Preparation(QObject):
    """Prepares the newest sample: ``ready(prepared)`` or ``failed(sentence)``."""

    ready = Signal(object)
    failed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.prepared: Prepared | None = None
        """What was prepared last, while there is a sample."""
        self.busy = False
        """Whether a newer sample is on its way."""
        self._worker = Worker("exemplar", parent=self)
        self._worker.finished.connect(self._finished)
        self._worker.failed.connect(self._failed)

    def take(self, sample: Sample | None, *, patient: bool = False) -> None:
        """Prepare another sample; patiently, what is on its way still arrives."""
        self.busy = sample is not None
        if sample is None:
            self._worker.cancel()
            self.prepared = None
            return
        before = self.prepared
        self._worker.submit(lambda task: prepare(sample, before), patient=patient)

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        self._worker.leave()

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        self._worker.close()

    def _finished(self, prepared: Prepared) -> None:
        self.prepared = prepared
        self.busy = self._worker.behind
        self.ready.emit(prepared)

    def _failed(self, sentence: str) -> None:
        self.busy = False
        # Nothing may run on the exemplar from before.
        self.prepared = None
        self.failed.emit(sentence)


def prepare(sample: Sample, before: Prepared | None) -> Prepared:
    """Scale and crop a sample (in a worker's thread); the scaled source is taken over when it is the same."""
    from texlab_core.images.exemplar import as_exemplar

    scaled = as_exemplar(sample.source, scale=sample.scale) if sample.scale != 1.0 else sample.source
    if before is not None and before.source_scaled.sha256 == scaled.sha256:
        picture = before.source_picture
    else:
        picture = to_picture(scaled.pixels)
    exemplar = scaled
    if sample.crop is not None:
        exemplar = as_exemplar(sample.source, scale=sample.scale, crop=sample.crop)
    return Prepared(exemplar, picture, scaled)
