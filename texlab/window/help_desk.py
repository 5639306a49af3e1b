"""Help pages and what the program says of itself."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QPoint, Qt, Signal
from PySide6.QtWidgets import QWidget

from texlab.state.changes import with_method
from texlab.widgets.once import Once
from texlab.widgets.plain import message_box
from texlab.window.help_window import HelpWindow
from texlab.window.palette import CommandPalette, Entry, of_actions
from texlab_core.engine.params import describe
from texlab_core.engine.run import versions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

    from texlab.state.session import Session
    from texlab.window.main_window import MainWindow
    from texlab_core.documents.lessons import Lesson
    from texlab_core.sheets.sweep_recipes import SweepRecipe

    # Name, lesson, whether it is the user's own; then sweeps.
    Found = tuple[Sequence[tuple[str, Lesson, bool]], Sequence[SweepRecipe]]

_DIRECT = Qt.FindChildOption.FindDirectChildrenOnly


class HelpDesk(QObject):
    """Opens the help window (made when it is first wanted), the command palette and the box about the program.

    Parameters
    ----------
    window, session
        Whose commands, panels and parameters the palette finds.
    lessons
        The folder of the user's own lessons.

    ``lesson_wanted(name, own)`` when a page or the palette leads to a lesson, or to one of the user's own;
    ``tab_wanted(name, settings)`` when something in a tab is wanted.
    """

    lesson_wanted = Signal(str, bool)
    tab_wanted = Signal(str, object)

    def __init__(self, window: MainWindow, session: Session, lessons: Path) -> None:
        super().__init__(window)
        self._window = window
        self._session = session
        self._lessons = lessons
        self.help: HelpWindow | None = None
        self.read_wanted: Callable[[Callable[[], Any], Callable[[Any], None]], None] = lambda read, done: None
        self._palette: CommandPalette | None = None
        # One tab at a time, so that typing goes on.
        self._more = Once(self, 0, self._make_more)
        self._late: tuple[str, ...] = ()

    def show_help(self, page: str) -> None:
        """Open a help page."""
        if self.help is None:
            self.help = HelpWindow(self._window)
            self.help.knob_wanted.connect(self._show_knob)
            self.help.lesson_wanted.connect(lambda name: self.lesson_wanted.emit(name, False))
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
        self._late = self._window.unmade
        palette = CommandPalette(self._entries(), self._window)
        palette.destroyed.connect(self._forget_palette)
        self._palette = palette
        # Lessons and sweeps are files: they are read elsewhere, once.
        self.read_wanted(self._read, self._found)
        palette.move(self._window.mapToGlobal(QPoint((self._window.width() - palette.width()) // 2, 80)))
        palette.show()
        if self._late:
            self._more.start()

    def _make_more(self) -> None:
        """Make more of the tabs that nobody has seen; offer the settings of all of them when they are there."""
        if self._palette is None:
            return
        if self._window.make_more():
            self._more.start()
        else:
            self._palette.add(self._settings(self._late))

    def _forget_palette(self) -> None:
        self._palette = None

    def _read(self) -> Found:
        """Return the lessons there are, and the ready-made sweeps that come with the program."""
        from texlab_core.lessons.shelf import bundled, own
        from texlab_core.sheets.sweep_sources import bundled_sweeps

        shelves = (bundled(), False), (own(self._lessons)[0], True)
        lessons = [(name, each, mine) for shelf, mine in shelves for name, each in shelf.items()]
        return lessons, tuple(bundled_sweeps())

    def _found(self, found: Found) -> None:
        if self._palette is None:
            return
        lessons, sweeps = found
        self._palette.add(
            [
                *(
                    Entry(
                        "lesson",
                        each.title,
                        f"{name}, of your own" if mine else name,
                        partial(self.lesson_wanted.emit, name, mine),
                    )
                    for name, each, mine in lessons
                ),
                *(
                    Entry("sweep", each.name.replace("-", " "), each.note, partial(self._show_sweep, each))
                    for each in sweeps
                ),
            ]
        )

    def _show_sweep(self, sweep: SweepRecipe) -> None:
        """Choose a ready-made sweep in its panel, with a column of its method, a new one where there is none."""
        session = self._session
        chosen = session.selected_column
        if chosen is None or chosen.method != sweep.method:
            state = with_method(session.state, sweep.method)
            if state is not session.state:
                session.apply(state, f"column {sweep.method}")
            session.select(next(each.id for each in state.columns if each.method == sweep.method))
        self.tab_wanted.emit("sweeps", {"ready-made": sweep.name})

    def _settings(self, names: Iterable[str]) -> list[Entry]:
        """Return the controls of these panels: each leads there."""
        found = []
        for name in names:
            dock = self._window.docks[name]
            line = dock.widget().findChild(QWidget, f"{name}-controls")
            for control in () if line is None else line.findChildren(QWidget, options=_DIRECT):
                if control.accessibleName() and control.focusPolicy() != Qt.FocusPolicy.NoFocus:
                    title = f"{dock.windowTitle()}: {control.accessibleName()}"
                    run = partial(self._show_control, name, control)
                    found.append(Entry("setting", title, control.toolTip(), run))
        return found

    def _show_control(self, name: str, control: QWidget) -> None:
        self._window.raise_dock(name)
        control.setFocus()

    def _entries(self) -> list[Entry]:
        """Return what the palette finds: commands and panels, settings, parameters, presets, textures, files."""
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
        found += self._settings(each for each in window.docks if each not in self._late)
        found += [
            Entry(
                "recent file", action.text().replace("\\", "/").rpartition("/")[2], action.text(), action.trigger
            )
            for action in window.recent_menu.actions()
        ]
        gallery = window.gallery
        found += [
            Entry("texture", title, words, partial(gallery.chosen.emit, name))
            for name, title, words in gallery.textures()
        ]
        return found

    def close(self) -> None:
        """Close the help window."""
        self._more.stop()
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
