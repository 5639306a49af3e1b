"""The status bar: what is under the pointer, what is opened or saved, zoom, columns at work, memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QProgressBar, QStatusBar

from texlab.widgets.plain import Label, set_tip

if TYPE_CHECKING:
    from collections.abc import Iterable

    from PySide6.QtWidgets import QWidget

# What takes long enough to be seen, by the names of the errands.
ERRANDS = {
    "open": "opening",
    "open-document": "opening",
    "session": "opening",
    "save": "saving",
    "sheet": "saving",
    "save-code": "saving",
    "copy": "copying",
    "fill": "filling",
    "cell-window": "opening",
}


class StatusBar(QStatusBar):
    """Says in one line what goes on."""

    def __init__(self) -> None:
        super().__init__()
        self.setAccessibleName("Status")
        self.pixel = Label(name="status-pixel")
        self.pixel.setContentsMargins(6, 0, 0, 0)
        self.errand = Label(name="status-errand")
        self.errand_bar = QProgressBar()
        self.errand_bar.setObjectName("status-errand-progress")
        self.errand_bar.setAccessibleName("Opening or saving")
        self.errand_bar.setRange(0, 0)
        self.errand_bar.setFixedWidth(60)
        self.jobs = Label(name="status-jobs", muted=True)
        self.memory = Label(name="status-memory", muted=True)
        set_tip(self.memory, "Memory used by the program")
        self.addWidget(self.pixel, 1)
        for each in (self.errand, self.errand_bar, self.jobs, self.memory):
            self.addPermanentWidget(each)
        self.show_errands(())

    def show_errands(self, names: Iterable[str]) -> None:
        """Show that something is being opened, copied or saved."""
        words = list(dict.fromkeys(ERRANDS[name] for name in names if name in ERRANDS))
        self.errand.setText(f"{' and '.join(words).capitalize()} ..." if words else "")
        self.errand_bar.setVisible(bool(words))

    def add_zoom(self, label: str, box: QWidget) -> None:
        """Show a box with a word before it."""
        word = Label(label, muted=True)
        self.insertPermanentWidget(1, word)
        self.insertPermanentWidget(2, box)
