"""The palette: type a few letters, press Enter; it finds whatever has a name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import QDialog, QLineEdit, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from texlab.widgets.plain import set_tip
from texlab.window.commands import plain
from texlab.window.fuzzy import fit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from PySide6.QtGui import QAction

# More than this nobody reads; another letter narrows it down.
MOST = 60


@dataclass(frozen=True)
class Entry:
    """Something that can be found.

    Parameters
    ----------
    kind
        "" for commands; else what it is ("texture").
    name, help, keys
        Its name, explanation, and the keys that do the same.
    run
        Does it.
    """

    kind: str
    name: str
    help: str
    run: Callable[[], object]
    keys: str = ""

    @property
    def text(self) -> str:
        """What the list shows."""
        name = f"{self.name}  ({self.kind})" if self.kind else self.name
        return f"{name}    {self.keys}" if self.keys else name


def best_first(entries: Iterable[Entry], typed: str) -> list[Entry]:
    """Return the entries that fit what was typed, the best first; commands go before what fits as well."""
    found = []
    for place, entry in enumerate(entries):
        value = fit(typed, entry.name, f"{entry.kind} {entry.help}")
        if value is not None:
            found.append((-value, bool(entry.kind), place, entry))
    return [entry for *_, entry in sorted(found, key=lambda each: each[:3])]


def of_actions(actions: Iterable[QAction]) -> list[Entry]:
    """Return the enabled commands."""
    return [
        Entry(
            "",
            plain(action.text()),
            action.statusTip(),
            action.trigger,
            action.shortcut().toString(QKeySequence.SequenceFormat.NativeText),
        )
        for action in actions
        if action.isEnabled() and action.text()
    ]


class CommandPalette(QDialog):
    """Lists what fits the words typed, the best first."""

    def __init__(self, entries: Sequence[Entry], parent: QWidget | None = None) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("command-palette")
        self.setAccessibleName("Command palette")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._entries = entries
        self._shown: list[Entry] = []
        self.field = QLineEdit()
        self.field.setObjectName("palette-field")
        self.field.setPlaceholderText("Type a command, panel, setting, texture, preset, sweep, lesson or file")
        self.field.setAccessibleName("Command")
        self.list = QListWidget()
        self.list.setObjectName("palette-list")
        self.list.setAccessibleName("What fits the words")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 6, 6, 6)
        layout.addWidget(self.field)
        layout.addWidget(self.list)
        self.resize(460, 340)
        self.field.textChanged.connect(self._fill)
        self.field.installEventFilter(self)
        self.list.itemActivated.connect(self._run)
        self.list.itemClicked.connect(self._run)
        self._fill("")
        self.field.setFocus()

    def add(self, entries: Sequence[Entry]) -> None:
        """Find these too, which were not there at first; what was chosen with the arrow keys stays chosen."""
        self._entries = [*self._entries, *entries]
        row = self.list.currentRow()
        chosen = self._shown[row] if 0 < row < len(self._shown) else None
        self._fill(self.field.text())
        if chosen is not None:
            self.list.setCurrentRow(next((at for at, each in enumerate(self._shown) if each is chosen), 0))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Move the choice with the arrow keys while typing."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}.get(Qt.Key(event.key()))
            if step is not None and self.list.count():
                self.list.setCurrentRow((self.list.currentRow() + step) % self.list.count())
                return True
            if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.list.currentItem():
                self._run(self.list.currentItem())
                return True
        return super().eventFilter(watched, event)

    def _fill(self, text: str) -> None:
        self._shown = best_first(self._entries, text)[: MOST if text.strip() else None]
        self.list.clear()
        for place, entry in enumerate(self._shown):
            item = QListWidgetItem(entry.text)
            set_tip(item, entry.help)
            item.setData(Qt.ItemDataRole.UserRole, place)
            self.list.addItem(item)
        if self.list.count():
            self.list.setCurrentRow(0)
        else:
            nothing = QListWidgetItem(f"Nothing has \u201c{text.strip()}\u201d in its name or explanation.")
            nothing.setFlags(Qt.ItemFlag.NoItemFlags)
            self.list.addItem(nothing)

    def _run(self, item: QListWidgetItem) -> None:
        place = item.data(Qt.ItemDataRole.UserRole)
        if place is None:
            return
        entry = self._shown[place]
        self.close()
        entry.run()
