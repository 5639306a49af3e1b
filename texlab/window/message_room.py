"""Where a message may lie: over pictures and titles, never over a control."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QRect

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtWidgets import QWidget

    from texlab.columns.workspace import Workspace
    from texlab.window.big_panel import BigPanel


def room_for_messages(
    middle: QWidget, workspace: Workspace, big_panel: BigPanel, front: Callable[[], QWidget | None]
) -> QRect:
    """Return the room for messages, in the coordinates of the middle of the window.

    It begins at the upper edge of the first pictures. While a panel has the stage it lies over that panel's title,
    beside the button that leads back.

    Parameters
    ----------
    middle
        What holds the stage.
    workspace, big_panel
        The stage, and what may be in its place.
    front
        Returns the panel in front.
    """
    room = middle.rect()
    if big_panel.is_big:
        panel = front()
        if panel is not None:
            room.setBottom(panel.mapToGlobal(QPoint()).y() - middle.mapToGlobal(QPoint()).y())
        room.setRight(big_panel.button.x())
    elif workspace.grid.cells:
        room.setTop(workspace.grid.cells[0].pane.mapTo(middle, QPoint()).y())
    return room
