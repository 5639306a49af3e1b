"""Teach: large text, few pictures, one tab, panels over the pictures, and a glass to draw on."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QKeySequence

from texlab.columns.arrangement import LEAST_PICTURE
from texlab.state.lesson_scene import NO_LESSON
from texlab.style.text_size import next_zoom
from texlab.widgets.once import Once
from texlab.window.chalk import Chalk
from texlab.window.layouts import HEIGHTS, SIDES
from texlab.window.lesson_desk import tab_of
from texlab.window.notes_window import NotesWindow
from texlab.window.overlay import Overlay

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab.columns.workspace import Workspace
    from texlab.docks.base import Dock
    from texlab.docks.host import DockHost
    from texlab.state.lesson_scene import LessonScene
    from texlab.state.session import Session
    from texlab.window.main_window import MainWindow
    from texlab_core.documents.lessons import LessonStep

EXEMPLAR = 0
# The presenter stands nearer than the first row.
NOTES_FACTOR = 1.2
# As many columns of a step stand beside the exemplar as have room for so many letters each.
LETTERS = 18
# The exemplar stands beside a column where there is room for so many pictures.
LEAST_BESIDE = 2
# Pixels for seams and borders.
SLACK = 12
# Pictures stand beside a tab where their sides are at least this part of the window's height.
PICTURE = 0.2
# In Teach the window may be smaller than its parts would like: they give way, and it never grows by itself.
LEAST = 320, 240
# Tabs that show the exemplar too, and the part of the height for a tab beside the exemplar alone.
SHOW_ALL = ("lab", "lessons")
SHARE_WITHOUT_COLUMNS = 0.6
ON_GLASS = ("ink", "halo", "spotlight")


class TeachMode(QObject):
    """Carries out the commands of teaching; what it hides comes back with another layout."""

    def __init__(
        self, window: MainWindow, workspace: Workspace, session: Session, hosts: Mapping[str, DockHost]
    ) -> None:
        super().__init__(window)
        self._hosts = hosts
        self._window = window
        self._workspace = workspace
        self._session = session
        self.chalk = Chalk(window)
        self.overlays = {
            name: Overlay(window.docks[name], window, at_right=name == "parameters") for name in SIDES
        }
        self.notes = NotesWindow(window.actions_by_name, window, NOTES_FACTOR * window.layouts.usual_points)
        self._kept: set[int] = set()
        self._hidden: set[int] = set()
        self._chosen = 0
        self._lesson = NO_LESSON
        self._folded = True
        self._share = HEIGHTS["teach"]
        # Whether the step's tab stands alone, and its share of the height; and whether both are to be found anew.
        self._given = False, 0.0
        self._is_new = self._by_hand = False
        self._settling = Once(self, 0, self._settle_room)
        self._was_full = self._was_on = False
        layouts, actions = window.layouts, window.actions_by_name
        layouts.leaving, layouts.changed = self._close_overlays, self.show_layout
        layouts.resized = self._follow_size
        actions["text-larger"].setShortcuts([QKeySequence("Ctrl++"), QKeySequence("Ctrl+=")])
        for name, call in (
            ("text-larger", lambda: self._set_zoom(next_zoom(layouts.zoom, 1))),
            ("text-smaller", lambda: self._set_zoom(next_zoom(layouts.zoom, -1))),
            ("text-usual", lambda: self._set_zoom(1.0)),
            ("next-tab", partial(self.step_tab, 1)),
            ("previous-tab", partial(self.step_tab, -1)),
            ("overlay-gallery", partial(self.toggle_side, "gallery")),
            ("overlay-parameters", partial(self.toggle_side, "parameters")),
            ("tab-controls", self.toggle_controls),
            ("beside", self.toggle_beside),
            ("ink-undo", self.chalk.undo),
            ("ink-clear", self.chalk.clear),
            *((f"sight-{place}", partial(self.toggle_place, place)) for place in range(10)),
        ):
            actions[name].triggered.connect(lambda _=False, call=call: call())
        actions["full-screen"].triggered.connect(self.set_full_screen)
        actions["tab-alone"].toggled.connect(self.set_tab_alone)
        actions["tab-alone"].triggered.connect(self._take_over)
        actions["notes"].triggered.connect(self.notes.set_open)
        actions["ink"].toggled.connect(self.chalk.set_drawing)
        actions["halo"].toggled.connect(self.chalk.set_halo)
        actions["spotlight"].toggled.connect(self.chalk.set_spotlight)
        # It comes with every change, and also when only another column is chosen.
        session.selected.connect(lambda _: self._show_columns())
        session.changed.connect(lambda *_: self._show_columns())
        for host in hosts.values():
            host.made.connect(self._take_in)
            if host.is_made:
                host.dock.needs_room.connect(self._settle_soon)
        self.show_layout()

    @property
    def on(self) -> bool:
        """Whether the layout is Teach."""
        return self._window.layouts.current == "teach"

    def close(self) -> None:
        """Follow the pointer no more, and give borrowed panels back."""
        self._close_overlays()
        self.chalk.put_away()
        self.notes.close()
        self.notes.deleteLater()

    def show_layout(self) -> None:
        """Show only what belongs to the layout."""
        window = self._window
        window.setMinimumSize(*(LEAST if self.on else (0, 0)))
        window.toolbar.setVisible(not self.on)
        window.statusBar().setVisible(not self.on)
        self._workspace.exemplar.set_quiet(self.on)
        self._fold()
        if not self.on:
            window.actions_by_name["tab-alone"].setChecked(False)
            for name in ON_GLASS:
                window.actions_by_name[name].setChecked(False)
            self.chalk.put_away()
            self._kept.clear()
            self._hidden.clear()
            if self._was_on:
                self._workspace.show_only(None)
                self.notes.set_open(False)
        elif not self._was_on and self.notes.other_screen() is not None:
            self.notes.set_open(True)
        entered = self.on and not self._was_on
        self._was_on = self.on
        if entered and self._lesson.step is not None:
            self._window.show_dock(tab_of(self._lesson.step))
        if self.on and self._lesson.step is not None:
            self._make_room(self._lesson.step)
        elif self.on and window.actions_by_name["tab-alone"].isChecked():
            # The layout that was asked for again has pictures.
            window.actions_by_name["tab-alone"].setChecked(False)
        self._show_columns()

    # Lessons.

    def show_lesson(self, lesson: LessonScene) -> None:
        """Let a step that is new have the room that it needs: its columns side by side, its tab."""
        self.notes.show_lesson(lesson)
        before, self._lesson = self._lesson, lesson
        step = lesson.step
        if not self.on or step is before.step:
            return
        if step is not None:
            self._make_room(step)
        elif before.step is not None:
            self._kept.clear()
            self._window.actions_by_name["tab-alone"].setChecked(False)
            self._window.layouts.share_height(HEIGHTS["teach"])
        self._show_columns()

    def _make_room(self, step: LessonStep) -> None:
        """Give tab and pictures of a step their room, as if nothing had been given before."""
        columns = [column.id for column in self._session.state.columns]
        self._hidden.clear()
        # Beside larger words pictures would be small: there are fewer of them.
        letters = LETTERS * max(1.0, self._window.layouts.zoom)
        room = int(self._window.width() / (letters * self._window.fontMetrics().averageCharWidth()))
        self._kept = set(readable(columns, step.chosen, room - 1))
        if columns and room < LEAST_BESIDE:
            # A picture that has to be scrolled into sight is not seen; the exemplar is one key away.
            self._hidden.add(EXEMPLAR)
        self._show_columns()
        self._by_hand = False
        self._give_room(*self._room_of(step))
        # What has just got another size or another text says what it needs a moment later.
        self._is_new = True
        self._settling.start()

    def _room_of(self, step: LessonStep) -> tuple[bool, float]:
        """Return whether the tab of a step stands alone, and its share of the window's height."""
        columns, height = self._session.state.columns, self._window.height()
        # Experiments and drawings show the exemplar themselves, where there is one.
        if not columns and (step.exemplar is None or tab_of(step) in SHOW_ALL):
            return True, 1.0
        left, needed = self._height_beside_pictures(), self._height_of(tab_of(step))
        # Where large words leave no room for both, the tab comes first: the pictures are one key away.
        if needed > left:
            return True, 1.0
        usual = HEIGHTS["teach"] if columns else SHARE_WITHOUT_COLUMNS
        return False, max(min(usual, left / height), needed / height)

    def _give_room(self, alone: bool, share: float) -> None:
        self._given = alone, share
        self._window.actions_by_name["tab-alone"].setChecked(alone)
        # The sentence has other lines than the one before.
        self._window.settle_middle()
        self._window.layouts.share_height(share)

    def _settle_room(self) -> None:
        """Give a tab that needs more by now its room; what is given stays, or room would go back and forth."""
        step = self._lesson.step
        if not self.on or step is None or self._by_hand or self._window.front_dock() != tab_of(step):
            return
        wanted = self._room_of(step)
        if not self._is_new:
            wanted = wanted[0] or self._given[0], max(wanted[1], self._given[1])
        self._is_new = False
        if wanted != self._given:
            self._give_room(*wanted)

    def _take_over(self) -> None:
        """Leave room to the user, who has asked for another one."""
        self._by_hand = True

    def _follow_size(self) -> None:
        """Give a step its room in a window of another size."""
        if self.on and self._lesson.step is not None and not self._by_hand:
            self._make_room(self._lesson.step)

    def _take_in(self, dock: Dock) -> None:
        self._fold_one(dock)
        dock.needs_room.connect(self._settle_soon)

    def _settle_soon(self) -> None:
        """Look again when a tab asks for other room: answers come late."""
        if self.on and self._lesson.step is not None:
            self._settling.start()

    def _height_beside_pictures(self) -> int:
        """Return what sentence and pictures leave of the window's height."""
        window = self._window
        bar, menu = window.lesson_bar, window.menuBar()
        more = max(0, round(PICTURE * window.height()) - LEAST_PICTURE)
        taken = bar.minimumSizeHint().height() + self._workspace.grid.least_height(window.width()) + more
        return window.height() - SLACK - taken - (menu.height() if menu.isVisible() else 0)

    def _height_of(self, name: str) -> int:
        """Return the height of a tab with its title, below which it scrolls."""
        frame, host = self._window.docks.get(name), self._hosts.get(name)
        if frame is None or host is None or not host.is_made:
            return 0
        title = frame.minimumSizeHint().height() - host.dock.minimumSizeHint().height()
        return max(title, 0) + host.dock.least_height(self._window.width())

    def _set_zoom(self, zoom: float) -> None:
        self._window.layouts.set_zoom(zoom)
        if self.on and self._lesson.step is not None:
            self._make_room(self._lesson.step)

    # Columns.

    def toggle_beside(self) -> None:
        """Keep the chosen column in sight when another one is chosen, or not."""
        self._kept ^= {self._session.selected_id}
        self._show_columns()

    def toggle_place(self, place: int) -> None:
        """Show or hide the column at a place, 1, 2, ...; 0 is the exemplar."""
        columns = self._session.state.columns
        if not self.on or place > len(columns):
            return
        wanted = columns[place - 1].id if place else EXEMPLAR
        if wanted == EXEMPLAR:
            self._hidden ^= {EXEMPLAR}
        elif wanted in self._shown():
            self._kept -= {wanted}
            self._hidden |= {wanted}
        else:
            self._kept |= {wanted}
            self._hidden -= {wanted}
        self._show_columns()

    def _shown(self) -> tuple[int, ...]:
        chosen = self._session.selected_id
        known = (column.id for column in self._session.state.columns)
        return tuple(each for each in known if each not in self._hidden and (each == chosen or each in self._kept))

    def _show_columns(self) -> None:
        chosen = self._session.selected_id
        if chosen != self._chosen:
            # Who chooses a column wants to see it.
            self._hidden.discard(chosen)
            self._chosen = chosen
        self._window.actions_by_name["beside"].setChecked(chosen in self._kept)
        if self.on:
            self._workspace.show_only(self._shown(), exemplar=EXEMPLAR not in self._hidden)

    # Tabs and panels.

    def step_tab(self, by: int) -> None:
        """Go to the next tab, or the one before."""
        names = [name for name in self._window.docks if name not in SIDES]
        # One that has just come is seen when it is painted.
        shown = [name for name in names if self._window.docks[name].isVisible()]
        front = self._window.front_dock() or (shown[0] if shown else "")
        place = names.index(front) if front else -1 if by > 0 else 0
        if names:
            self._window.raise_dock(names[(place + by) % len(names)])

    def toggle_side(self, name: str) -> None:
        """Show the gallery or the parameters, over the pictures when teaching, or take them away."""
        if self.on:
            self.overlays[name].set_open(not self.overlays[name].is_open)
        else:
            dock = self._window.docks[name]
            dock.setVisible(not dock.isVisible())

    def _close_overlays(self) -> None:
        for overlay in self.overlays.values():
            overlay.set_open(False)

    def toggle_controls(self) -> None:
        """Show the controls of the tabs, or their pictures alone."""
        self._folded = not self._folded
        self._fold()

    def _fold(self) -> None:
        for host in self._hosts.values():
            if host.is_made:
                self._fold_one(host.dock)

    def _fold_one(self, dock: Dock) -> None:
        dock.fold_controls(self.on and self._folded)

    def set_tab_alone(self, alone: bool) -> None:
        """Give the open tab the room of the pictures too, or take it back."""
        layouts, front = self._window.layouts, self._window.docks.get(self._window.front_dock())
        if alone:
            self._window.strip.set_open(True)
            usual = HEIGHTS.get(layouts.current, HEIGHTS["explore"])
            self._share = front.height() / self._window.height() if front is not None else usual
        self._workspace.setVisible(not alone)
        # Nobody keeps room for what is hidden.
        self._window.settle_middle()
        if self._window.strip.is_open:
            layouts.share_height(1.0 if alone else self._share)

    # The screen.

    def set_full_screen(self, full: bool) -> None:
        """Use the whole screen, without menus; afterwards the window is as it was."""
        self._window.menuBar().setVisible(not full)
        if full:
            self._was_full = self._window.isMaximized()
            self._window.showFullScreen()
        elif self._was_full:
            self._window.showMaximized()
        else:
            self._window.showNormal()


def readable(columns: Sequence[int], chosen: int, most: int) -> list[int]:
    """Return the columns that stand side by side: all that there is room for, with the chosen one among them.

    Parameters
    ----------
    columns
        Ids of all columns of a step.
    chosen
        Place of the chosen one.
    most
        How many have room; one always has.
    """
    most = max(most, 1)
    first = min(max(0, chosen + 1 - most), max(0, len(columns) - most))
    return list(columns[first : first + most])
