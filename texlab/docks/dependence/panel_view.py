"""One picture and its histogram side by side, each pointing into the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout

from texlab.docks.dependence.joint_view import JointView
from texlab.widgets.headed import Headed
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.status_line import StatusLine

if TYPE_CHECKING:
    from texlab.docks.dependence.panels import Panel
    from texlab.style.theme import Theme
    from texlab.widgets.view_link import ViewLink

TIP = (
    "Mutual information of the magnitudes: how many bits, of at most 3, the one tells of the other. Dependence: "
    "how far apart the joint histograms of exemplar and result are, 0 to 1; 0 for the exemplar itself."
)


# A longer title gives way to an ellipsis: histogram and picture need the room.
LINES = 2


class PanelView(Headed):
    """Shows a panel; ``pinned(column, row, column of the picture)`` when a pixel is clicked."""

    pinned = Signal(int, int, int)

    def __init__(self, name: str, label: str, link: ViewLink) -> None:
        self.title = StatusLine(lines=LINES)
        self.joint = JointView(f"{name}-histogram", f"Histogram of the {label}")
        self.pane = PicturePane(f"{name}-picture", f"Pixels of the {label} in the chosen cells", link)
        super().__init__(self.title, self.joint, self.pane)
        self.panel: Panel | None = None
        self.title.setObjectName(f"{name}-title")
        self.title.setProperty("role", None)
        self.pane.hovered.connect(self._point)
        self.pane.clicked.connect(self._pin)
        line = QHBoxLayout()
        line.setSpacing(4)
        line.addWidget(self.joint, 1)
        line.addWidget(self.pane, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(1)
        layout.addWidget(self.title)
        layout.addLayout(line, 1)
        self._kept: tuple[tuple[int, int], ...] = ()

    def show_panel(self, panel: Panel | None, *, conditional: bool, curves: bool) -> None:
        """Show a panel, or hide."""
        before, self.panel = self.panel, panel
        self.setVisible(panel is not None)
        self.joint.show_found(None if panel is None else panel.found, conditional=conditional, curves=curves)
        if panel is None:
            self.pane.set_picture(None)
            return
        self.title.show_parts([panel.words()], [TIP])
        if before is None or before.picture is not panel.picture:
            self.pane.set_picture(panel.picture)

    def keep_marked(self, pixel: tuple[int, int] | None) -> None:
        """Mark the cells of a pixel that is pointed at elsewhere, while none is pointed at here."""
        panel = self.panel
        self._kept = panel.found.cells(*pixel) if panel is not None and pixel is not None else ()
        self.joint.mark(self._kept)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.joint.set_theme(theme)
        self.pane.set_theme(theme)

    def _point(self, row: int, column: int) -> None:
        found = self.panel.found.cells(row, column) if self.panel is not None and row >= 0 else ()
        self.joint.mark(found or self._kept)

    def _pin(self, row: int, column: int) -> None:
        if self.panel is not None and self.panel.column_id and row >= 0:
            self.pinned.emit(self.panel.column_id, row, column)
