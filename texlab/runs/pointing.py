"""What is looked at beside the results: a pixel, and a stage of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.state.scene import Probe

if TYPE_CHECKING:
    from texlab.state.scene import ColumnScene, Frame


class Pointing(QObject):
    """Keeps the pixel that is asked about, and the stage that the tabs look at; ``changed()`` for another one."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.probe: Probe | None = None
        """The pixel that is asked about."""
        self._stage: tuple[int, Frame] | None = None

    def point_at(self, column_id: int, row: int, column: int) -> None:
        """Ask about the pixel under the pointer, unless another one is pinned."""
        if self.probe is None or not self.probe.pinned:
            self.ask_about(Probe(column_id, row, column) if row >= 0 else None)

    def pin(self, column_id: int, row: int, column: int) -> None:
        """Keep asking about a pixel; the same pixel again lets go of it."""
        wanted = Probe(column_id, row, column, pinned=True)
        self.ask_about(None if self.probe == wanted or row < 0 else wanted)

    def ask_about(self, probe: Probe | None) -> None:
        """Ask about this pixel, or about none, whatever was asked about before."""
        if probe != self.probe:
            self.probe = probe
            self.changed.emit()

    def show_stage(self, column_id: int, stage: Frame | None) -> None:
        """Let the tabs look at a stage of a column's run; None goes back to the result."""
        self._stage = None if stage is None else (column_id, stage)
        self.changed.emit()

    def stage_of(self, column: ColumnScene | None) -> Frame | None:
        """Return the stage chosen in a column, as long as its run keeps it."""
        if self._stage is None or column is None or self._stage[0] != column.id:
            return None
        return next((frame for frame in column.frames if frame is self._stage[1]), None)
