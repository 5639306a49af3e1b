"""Keeps the session on disk while the program runs, so that a crash or a power cut loses a second at most."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from texlab.jobs import Worker
from texlab.settings import session_to_json

if TYPE_CHECKING:
    from texlab.session import Session
    from texlab.settings import Settings

REST_MS = 1000


class Autosave(QObject):
    """Writes the settings in the background, a moment after the last change of the session."""

    def __init__(self, session: Session, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._settings = settings
        self._worker = Worker("autosave", parent=self)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST_MS)
        self._rest.timeout.connect(self._save)
        session.changed.connect(lambda *_: self._rest.start())
        session.selected.connect(lambda _: self._rest.start())

    def remember(self) -> None:
        """Put the session into the settings."""
        self._settings.values["session"] = session_to_json(self._session.state, self._session.selected_id)

    def _save(self) -> None:
        if self._session.state.sample is None:
            # The first exemplar is still being read: what was saved before is worth more.
            return
        self.remember()
        text = self._settings.to_json()
        self._worker.submit(lambda task: self._settings.write(text))

    def close(self) -> None:
        """End the thread, then save for the last time."""
        self._rest.stop()
        self._worker.close()
        if self._session.state.sample is not None:
            self.remember()
        self._settings.save()
