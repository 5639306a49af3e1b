"""What the user turns and drags: one step of the history each, with drafts while it moves."""

from __future__ import annotations

import contextlib
import dataclasses
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.state.changes import rescaled
from texlab_core.engine.registry import find_method

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab.state.chosen import Sample
    from texlab.state.session import Session
    from texlab_core.engine.inputs import Crop, Input
    from texlab_core.engine.levels import Levels
    from texlab_core.engine.params import Params


class Editing(QObject):
    """Takes parameters, inputs and the exemplar's box from the hand to the session.

    ``released(column_id)`` when a drag has ended and a column's draft is to become a picture of the full size;
    None for all columns.
    """

    released = Signal(object)

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self.dragging = False
        """Whether what the session tells now is a draft of what the user means."""
        self.cropping = False
        """Whether the newest exemplar is one of a drag."""

    def params(self, column_id: int, params: Params, name: str, final: bool) -> None:
        """Take parameters from the form: drafts while a control is dragged, the full size on release."""
        with self._drag(not final):
            self._session.set_params(column_id, params, name, merge=("knob", column_id, name))
        self._settle(final, column_id)

    def inputs(self, column_id: int, inputs: tuple[tuple[str, Input], ...], text: str, final: bool = True) -> None:
        """Give a column other further inputs: drafts while something is dragged, the full size on release."""
        with self._drag(not final):
            self._session.set_inputs(column_id, inputs, text, merge=("inputs", column_id, text))
        self._settle(final, column_id)

    def crop(self, crop: Crop | None, final: bool) -> None:
        """Take another crop from the exemplar's box."""
        if (sample := self._sample) is not None:
            with self._drag(not final):
                self._session.set_sample(dataclasses.replace(sample, crop=crop), merge="crop")
            self.cropping = not final
            self._settle(final, None)

    def scale(self, scale: float, merge: object | None = None) -> None:
        """Scale the source; the crop is scaled along."""
        if (sample := self._sample) is not None and scale != sample.scale:
            self._session.set_sample(rescaled(sample, scale), merge=merge)

    def levels(self, levels: Levels | None, look_only: bool, merge: object | None = None) -> None:
        """Take other levels of the exemplar, for the methods too or for looking only."""
        if (sample := self._sample) is not None:
            look_only = look_only and levels is not None
            changed = dataclasses.replace(sample, levels=levels, look_only=look_only)
            self._session.set_sample(changed, merge=merge)

    def reset_params(self, column_id: int) -> None:
        """Give a column its method's defaults."""
        column = self._session.state.column(column_id)
        if column is not None:
            self._session.set_params(column_id, find_method(column.method).params(), "reset all")

    @property
    def _sample(self) -> Sample | None:
        return self._session.state.sample

    @contextlib.contextmanager
    def _drag(self, dragging: bool) -> Iterator[None]:
        self.dragging = dragging
        try:
            yield
        finally:
            self.dragging = False

    def _settle(self, final: bool, column_id: int | None) -> None:
        if final:
            self._session.finish_merge()
            self.released.emit(column_id)
