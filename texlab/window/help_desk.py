"""Help pages and what the program says of itself."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint, Signal

from texlab.widgets.plain import message_box
from texlab.window.help_window import HelpWindow
from texlab.window.palette import CommandPalette, Entry, of_actions
from texlab_core.engine.params import describe
from texlab_core.engine.run import versions

if TYPE_CHECKING:
    from texlab.state.session import Session
    from texlab.window.main_window import MainWindow


class HelpDesk(QObject):
    """Opens the help window (made when it is first wanted), the command palette and the box about the program.

    ``lesson_wanted(name)`` when a page leads to a lesson.
    """

    lesson_wanted = Signal(str)

    def __init__(self, window: MainWindow, session: Session) -> None:
        super().__init__(window)
        self._window = window
        self._session = session
        self.help: HelpWindow | None = None

    def show_help(self, page: str) -> None:
        """Open a help page."""
        if self.help is None:
            self.help = HelpWindow(self._window)
            self.help.knob_wanted.connect(self._show_knob)
            self.help.lesson_wanted.connect(self.lesson_wanted)
        self.help.open_page(page)

    def show_about(self) -> None:
        """Say what this is."""
        found = versions()
        listed = ", ".join(f"{name} {number}" for name, number in found.items() if name != "texlab")
        words = "MIT licence; the textures of the gallery have their own."
        box = message_box(
            self._window,
            "About TexLab",
            f"TexLab {found['texlab']}\nExplorer of example-based texture synthesis.",
            f"{words}\n\n{listed}",
        )
        box.setObjectName("about")
        box.open()

    def show_palette(self) -> None:
        """Open the command palette."""
        palette = CommandPalette(self._entries(), self._window)
        palette.move(self._window.mapToGlobal(QPoint((self._window.width() - palette.width()) // 2, 80)))
        palette.show()

    def _entries(self) -> list[Entry]:
        """Return what the palette finds: commands and panels, parameters, presets, textures."""
        window, column = self._window, self._session.selected_column
        found = of_actions(window.actions_by_name.values())
        if column is not None:
            for field in describe(type(column.params)):
                run = partial(self._show_knob, column.method, field.name)
                found.append(Entry("parameter", field.label, field.knob.help, run))
        bar = window.parameters.presets
        found += [
            Entry("preset", preset.name, preset.note, partial(bar.chosen.emit, preset)) for preset in bar.presets
        ]
        gallery = window.gallery
        found += [
            Entry("texture", title, words, partial(gallery.chosen.emit, name))
            for name, title, words in gallery.textures()
        ]
        return found

    def close(self) -> None:
        """Close the help window."""
        if self.help is not None:
            self.help.leave()
            self.help.close()

    def _show_knob(self, method: str, knob: str) -> None:
        for column in self._session.state.columns:
            if column.method == method:
                self._session.select(column.id)
                form = self._window.parameters.form
                if form is not None and knob in form.knobs:
                    widget = form.knobs[knob]
                    self._window.parameters.scroll_area.ensureWidgetVisible(widget)
                    widget.setFocus()
                self._window.activateWindow()
                return
