"""Keeps the session on disk while the program runs, so that a crash or a power cut loses a second at most."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from texlab.runs.worker import Worker
from texlab.storage.kept_exemplar import file_name, forget_other_exemplars, has_no_home, keep
from texlab.storage.kept_inputs import forget_others, keep_inputs, kept_folder
from texlab.storage.paths import config_dir
from texlab.storage.sessions import folder, references, writing
from texlab.storage.settings import OLD_SESSION, session_to_json
from texlab.widgets.once import Once
from texlab_core.errors import InputError
from texlab_core.files.leftovers import sweep

if TYPE_CHECKING:
    from typing import Any

    from texlab.state.chosen import Sample, State
    from texlab.state.session import Session
    from texlab.storage.sessions import OwnSession
    from texlab.storage.settings import Settings
    from texlab_core.engine.inputs import ImageInput

log = logging.getLogger(__name__)

REST_MS = 1000


class Autosave(QObject):
    """Writes settings and session in the background, a moment after the last change of the session.

    Parameters
    ----------
    own
        The session of this window; None keeps nothing.
    """

    def __init__(
        self, session: Session, settings: Settings, own: OwnSession | None, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._session = session
        self._settings = settings
        self._own = own
        self._kept: ImageInput | None = None
        self._swept = False
        self._held: tuple[State, int] | None = None
        self._worker = Worker("autosave", parent=self)
        self._rest = Once(self, REST_MS, self._save)
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

    def to_json(self) -> dict[str, Any]:
        """Return the session as it is saved."""
        selected_id = self._session.selected_id if self._held is None else self._held[1]
        return session_to_json(self._state, selected_id)

    @property
    def busy(self) -> bool:
        """Whether the last change is not yet on the disk."""
        return self._rest.isActive() or self._worker.busy

    def _save(self) -> None:
        sample = self._state.sample
        if sample is None or self._own is None:
            # The first exemplar is still being read: what was saved before is worth more.
            return
        values, session, state = dict(self._settings.values), self.to_json(), self._state
        self._worker.submit(lambda task: self._write(values, session, sample, state), patient=True)

    def _write(self, values: dict[str, Any], session: dict[str, Any], sample: Sample, state: State) -> None:
        """Write everything, in the worker's thread."""
        assert self._own is not None
        inputs = [each for column in state.columns for _, each in column.inputs]
        # No other window takes for unneeded what this one is about to name.
        with writing() as alone:
            wanted = file_name(sample.source) if has_no_home(sample) else None
            if wanted is not None and (sample.source is not self._kept or not (config_dir() / wanted).is_file()):
                try:
                    keep(sample.source, config_dir())
                except InputError as error:
                    log.warning("The exemplar could not be kept: %s", error)
                self._kept = sample.source
            # The session on the disk never names a file that is not there, nor one with other pixels.
            keep_inputs(inputs, kept_folder())
            written = self._own.write(session)
            if written and self._own.is_first:
                values.pop(OLD_SESSION, None)
            needed = references(values.get(OLD_SESSION)) if written and alone else None
            if needed is not None:
                forget_other_exemplars(needed.exemplars, config_dir())
                forget_others(needed.inputs, kept_folder())
        self._settings.write(values)
        for place in () if self._swept else (kept_folder(), config_dir() / "presets", folder()):
            sweep(place)
        self._swept = True

    def close(self) -> None:
        """Save for the last time, in the thread, and end it; another window can have the session then."""
        self._rest.stop()
        if self._own is not None:
            values, state, sample = dict(self._settings.values), self._state, self._state.sample
            session = None if sample is None else self.to_json()
            self._worker.submit(
                lambda task: (
                    self._settings.write(values)
                    if sample is None or session is None
                    else self._write(values, session, sample, state)
                ),
                patient=True,
            )
        self._worker.finish()
        if self._own is not None:
            self._own.release()
