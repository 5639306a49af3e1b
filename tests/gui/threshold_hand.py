"""A hand on the threshold editor: clicks, drags and keys, with the scene that follows what it does."""

from __future__ import annotations

import dataclasses
from typing import Any

from de_bonet_scenes import finished, scene
from dock_scenes import feed, shown
from PySide6.QtCore import QPoint, Qt

from tests.gui.conftest import drag
from texlab.docks.thresholds.dock import ThresholdsDock

LEFT = Qt.MouseButton.LeftButton


class Hand:
    """A dock with the scene that follows what it does, as the window would make it follow."""

    def __init__(self, qtbot: Any, *, channels: int = 3) -> None:
        self.qtbot = qtbot
        self.dock = shown(qtbot, ThresholdsDock(), 1100, 260)
        self.column = finished(channels)
        self.edits = []
        self.dock.editor.edited.connect(self._edited)
        self.feed()

    def _edited(self, table, final):
        self.edits.append((table, final))
        self.column = dataclasses.replace(self.column, params=self.column.params.replace(thresholds=table))

    def feed(self):
        return feed(self.dock, scene(self.column))

    @property
    def editor(self):
        return self.dock.editor

    @property
    def table(self):
        return self.column.params.thresholds

    def at(self, row, column):
        editor = self.editor
        if row < 0:
            return editor.column_rect(column).center().toPoint()
        return (editor.row_rect(row) if column < 0 else editor.cell_rect(row, column)).center().toPoint()

    def drag(self, row, column, dx, dy):
        start = self.at(row, column)
        drag(self.qtbot, self.editor, [start, start + QPoint(dx // 2, dy // 2), start + QPoint(dx, dy)])

    def click(self, row, column, modifier=Qt.KeyboardModifier.NoModifier):
        self.qtbot.mouseClick(self.editor, LEFT, modifier, self.at(row, column))

    def key(self, key, modifier=Qt.KeyboardModifier.NoModifier):
        self.qtbot.keyClick(self.editor, key, modifier)

    def settle(self):
        self.qtbot.waitUntil(lambda: bool(self.edits) and self.edits[-1][1])
