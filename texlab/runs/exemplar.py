"""The exemplar as the methods get it: scaled and cropped in the background."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.runs.worker import Worker
from texlab.style.pictures import to_picture

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from texlab.state.chosen import Sample
    from texlab.style.pictures import Picture
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.levels import Levels


@dataclasses.dataclass(frozen=True, eq=False)
class Prepared:
    """The exemplar as the methods get it, and its scaled source as it is shown."""

    exemplar: ImageInput
    source_picture: Picture
    source_scaled: ImageInput
    levels: Levels | None = None
    """Those of the picture that is shown."""
    histogram: NDArray[np.float64] | None = None
    """Of what is used, before its levels; see :func:`histogram_of`."""
    auto: Levels | None = None
    """Levels that use the whole range."""


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
    from texlab_core.engine.levels import Levels, histogram_of
    from texlab_core.images.exemplar import as_exemplar

    scaled = as_exemplar(sample.source, scale=sample.scale) if sample.scale != 1.0 else sample.source
    same = before is not None and before.source_scaled.sha256 == scaled.sha256
    if before is not None and same and before.levels == sample.levels:
        picture = before.source_picture
    else:
        picture = to_picture(scaled.pixels if sample.levels is None else sample.levels.applied(scaled.pixels))
    plain = scaled
    if sample.crop is not None:
        plain = as_exemplar(sample.source, scale=sample.scale, crop=sample.crop)
    exemplar = plain
    if sample.used_levels is not None:
        exemplar = as_exemplar(sample.source, scale=sample.scale, crop=sample.crop, levels=sample.used_levels)
    histogram, auto = histogram_of(plain.pixels), Levels.auto(plain.pixels)
    return Prepared(exemplar, picture, scaled, sample.levels, histogram, auto)
