"""Keeps the session on disk while the program runs, so that a crash or a power cut loses a second at most."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from texlab.runs.worker import Worker
from texlab.storage.kept_exemplar import file_name, forget_other_exemplars, has_no_home, keep
from texlab.storage.kept_inputs import forget_others, keep_inputs, kept_folder
from texlab.storage.paths import config_dir
from texlab.storage.settings import session_to_json
from texlab_core.errors import InputError
from texlab_core.files.leftovers import sweep

if TYPE_CHECKING:
    from texlab.state.session import Sample, Session, State
    from texlab.storage.settings import Settings
    from texlab_core.engine.inputs import ImageInput

log = logging.getLogger(__name__)

REST_MS = 1000


class Autosave(QObject):
    """Writes the settings in the background, a moment after the last change of the session."""

    def __init__(self, session: Session, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._settings = settings
        self._kept: ImageInput | None = None
        self._swept = False
        self._held: tuple[State, int] | None = None
        self._worker = Worker("autosave", parent=self)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST_MS)
        self._rest.timeout.connect(self._save)
        session.changed.connect(lambda *_: self._rest.start())
        session.selected.connect(lambda _: self._rest.start())

    def hold(self, state: State, selected_id: int) -> None:
        """Save this instead of the session, which is a lesson's for a while."""
        self._held = state, selected_id

    def release(self) -> None:
        """Save the session again."""
        self._held = None

    @property
    def _state(self) -> State:
        """What is saved."""
        return self._session.state if self._held is None else self._held[0]

    def remember(self) -> None:
        """Put the session into the settings."""
        selected_id = self._session.selected_id if self._held is None else self._held[1]
        self._settings.values["session"] = session_to_json(self._state, selected_id)

    @property
    def busy(self) -> bool:
        """Whether the last change is not yet on the disk."""
        return self._rest.isActive() or self._worker.busy

    def _save(self) -> None:
        sample = self._state.sample
        if sample is None:
            # The first exemplar is still being read: what was saved before is worth more.
            return
        self.remember()
        text, state = self._settings.to_json(), self._state
        self._worker.submit(lambda task: self._write(text, sample, state), patient=True)

    def _write(self, text: str, sample: Sample, state: State) -> None:
        """Write everything, in the worker's thread."""
        wanted = file_name(sample.source) if has_no_home(sample) else None
        if wanted is not None and sample.source is not self._kept:
            try:
                keep(sample.source, config_dir())
            except InputError as error:
                log.warning("The exemplar could not be kept: %s", error)
            self._kept = sample.source
        inputs = [each for column in state.columns for _, each in column.inputs]
        # The settings on the disk never name a file that is not there, nor one with other pixels.
        keep_inputs(inputs, kept_folder())
        if self._settings.write(text):
            forget_other_exemplars(wanted, config_dir())
            forget_others(inputs, kept_folder())
        for folder in () if self._swept else (kept_folder(), config_dir() / "presets"):
            sweep(folder)
        self._swept = True

    def close(self) -> None:
        """Save for the last time, in the thread, and end it."""
        self._rest.stop()
        state = self._state
        sample = state.sample
        if sample is not None:
            self.remember()
        text = self._settings.to_json()
        self._worker.submit(
            lambda task: self._settings.write(text) if sample is None else self._write(text, sample, state),
            patient=True,
        )
        self._worker.finish()
