"""A and B: the chosen column and the one it is compared with, in one pane or side by side."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSignalBlocker, Signal
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QToolButton, QWidget

from texlab.columns.comparison import Comparison, other_of
from texlab.columns.magnifier import Magnifier
from texlab.style.text_size import grow_with_text
from texlab.widgets.pair_layer import GAINS, Mode
from texlab.widgets.plain import Label, ShortLabel, set_tip
from texlab.widgets.short_box import ShortBox

if TYPE_CHECKING:
    from texlab.columns.column import ColumnView
    from texlab.columns.workspace import Workspace
    from texlab.state.scene import Scene
    from texlab.style.pictures import Picture
    from texlab.widgets.image_pane import ImagePane
    from texlab.window.main_window import MainWindow

MODES: tuple[Mode, ...] = ("flicker", "swipe", "difference")


class CompareBar(QWidget):
    """The ways of comparing, below the stage."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__()
        self.setObjectName("compare-bar")
        self.setAccessibleName("Comparison of A and B")
        self.words = ShortLabel(name="compare-words")
        self.other = ShortBox()
        self.other.setObjectName("compare-other")
        self.other.setAccessibleName("B, what A is compared with")
        set_tip(self.other, "The column that A, the chosen one, is compared with")
        self.copy = QToolButton()
        self.copy.setObjectName("compare-copy")
        self.copy.clicked.connect(window.actions_by_name["duplicate"].trigger)
        self.copy.setText("Copy of A")
        self.copy.setAutoRaise(True)
        self.copy.setAccessibleName("Copy of A")
        set_tip(self.copy, "A becomes B, and a copy of it A: change the copy and compare (Ctrl+D)")
        self.gain = ShortBox()
        self.gain.setObjectName("compare-gain")
        self.gain.setAccessibleName("Gain of the difference")
        grow_with_text(self.gain, 70, self.gain.setFixedWidth)
        # A layout gives no room of their own to boxes that may shrink to nothing.
        self.gain.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        set_tip(self.gain, "The difference is multiplied by this before it is shown")
        for gain in GAINS:
            self.gain.addItem(f"× {gain}", gain)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(6, 0, 6, 2)
        for name in (*MODES, "magnifier"):
            button = QToolButton()
            button.setObjectName(f"compare-{name}")
            action = window.actions_by_name[name]
            action.setIconText(name.capitalize())
            button.setDefaultAction(action)
            button.setAutoRaise(True)
            layout.addWidget(button)
            if name == "difference":
                layout.addWidget(self.gain)
        layout.addWidget(self.words, 3)
        layout.addWidget(Label("B"))
        layout.addWidget(self.other, 2)
        layout.addWidget(self.copy)
        self.hide()


class Tuning(QObject):
    """Follows what is chosen, and compares it with what was chosen before.

    In the layout Tune (:meth:`set_active`) the stage shows exemplar, A and B alone; ``compared(pair)`` tells their
    ids then, and an empty tuple otherwise.
    """

    compared = Signal(object)

    def __init__(self, window: MainWindow, workspace: Workspace) -> None:
        super().__init__(window)
        self._window = window
        self._workspace = workspace
        self.comparison = Comparison(self)
        self.bar = CompareBar(window)
        self.a, self.b = 0, 0
        self._order: tuple[int, ...] = ()
        self._chosen, self._before = 0, 0
        self._offered: tuple[tuple[int, str], ...] = ()
        self._active = False
        self._pictures: dict[int, Picture | None] = {}
        self._magnifiers: dict[ImagePane, Magnifier] = {}
        self._magnifies = False
        self.bar.gain.setCurrentIndex(GAINS.index(self.comparison.gain))
        self.bar.gain.activated.connect(lambda _: self.comparison.set_gain(self.bar.gain.currentData()))
        self.bar.other.activated.connect(lambda _: self._compare_with(self.bar.other.currentData()))
        self.comparison.changed.connect(self._say)
        for mode in MODES:
            window.actions_by_name[mode].triggered.connect(partial(self._compare, mode))
        window.actions_by_name["magnifier"].toggled.connect(self.set_magnifies)
        workspace.column_made.connect(self._watch_column)
        workspace.column_gone.connect(self._let_go)
        self._watch(workspace.exemplar.pane)

    @property
    def active(self) -> bool:
        """Whether the other columns are folded away."""
        return self._active

    def set_active(self, active: bool, chosen: int = 0) -> None:
        """Show A and B alone, or all columns; ``chosen``, when it is one of the two, is A."""
        if self._active and not active:
            self._workspace.show_only(None)
        if chosen:
            self._note_choice(chosen)
        if active and chosen and chosen == self.b:
            self.a, self.b = self.b, self.a
        self._active = active
        self.bar.setVisible(active)
        self._workspace.set_close(active)
        self._fold()
        self._show_pair()

    def show_scene(self, scene: Scene) -> None:
        """Follow the choice and the pictures."""
        order = tuple(column.id for column in scene.columns)
        self._note_choice(scene.selected_id)
        if scene.selected_id not in (self.a, self.b) or {self.a, self.b} - set(order) or order != self._order:
            # A copy is compared with what it was copied from, and that was chosen then.
            before = self.b if scene.selected_id == self.a else self._before
            # One of the pair stays where it is when it is chosen.
            if scene.selected_id != self.b or self.a not in order:
                self.a = scene.selected_id
                self.b = other_of(self.a, order, before) or 0
        self._order = order
        self._pictures = {column.id: column.picture for column in scene.columns}
        self._fold()
        self._show_pair()

    def _note_choice(self, chosen: int) -> None:
        if chosen != self._chosen:
            self._before, self._chosen = self._chosen, chosen

    def _show_pair(self) -> None:
        view = self._workspace.columns.get(self.a)
        pane = view.pane if view is not None else None
        self.comparison.show_pair(pane, self._pictures.get(self.a), self._pictures.get(self.b))
        for name in MODES:
            self._window.actions_by_name[name].setEnabled(bool(self.b))
        for each, column in self._workspace.columns.items():
            column.set_badge("" if not self._active else "A" if each == self.a else "B" if each == self.b else "")
        self.compared.emit((self.a, self.b) if self._active and self.a and self.b else ())
        self._say()

    def _compare_with(self, column_id: int) -> None:
        self.b = column_id
        self._fold()
        self._show_pair()

    def close(self) -> None:
        """Stop and join the thread."""
        self.comparison.close()

    def _fold(self) -> None:
        if self._active:
            pair = tuple(each for each in self._order if each in (self.a, self.b))
            self._workspace.show_only(pair or None)

    def _compare(self, mode: Mode, _: bool = False) -> None:
        self.comparison.set_mode(mode)

    def _say(self) -> None:
        mode = self.comparison.mode
        for name in MODES:
            action = self._window.actions_by_name[name]
            with QSignalBlocker(action):
                action.setChecked(name == mode)
        views = self._workspace.columns
        offered = tuple((each, views[each].method_box.label) for each in self._order if each in views)
        others = tuple(each for each in offered if each[0] != self.a)
        if others != self._offered:
            self._offered = others
            self.bar.other.clear()
            for each, title in others:
                self.bar.other.addItem(title, each)
        self.bar.other.setCurrentIndex(self.bar.other.findData(self.b))
        self.bar.other.setEnabled(bool(others))
        title = dict(offered).get(self.a, "")
        words = {
            "off": f"A {title}",
            "flicker": "B is seen in the place of A",
            "swipe": f"left of the line A {title}, right of it B",
            "difference": f"difference of A {title} and B; black is equal",
        }[mode]
        self.bar.words.setText(words if others else "There is one column only; compare it with a copy.")

    # The magnifier.

    def set_magnifies(self, on: bool) -> None:
        """Show the surroundings of the pixel under the pointer, enlarged, in all panes."""
        self._magnifies = on
        if not on:
            self._look(self._workspace.exemplar.pane, -1, -1)

    def _watch_column(self, view: ColumnView) -> None:
        self._watch(view.pane)

    def _watch(self, pane: ImagePane) -> None:
        self._magnifiers[pane] = Magnifier(pane)
        pane.hovered.connect(partial(self._look, pane))

    def _let_go(self, view: ColumnView) -> None:
        self._magnifiers.pop(view.pane, None)
        self.comparison.forget(view.pane)

    def _look(self, source: ImagePane, row: int, column: int) -> None:
        shown = self._magnifies and row >= 0
        exemplar, crop = self._workspace.exemplar.pane, self._workspace.exemplar.crop
        corner = (crop.top, crop.left) if crop is not None else (0, 0)
        for pane, magnifier in self._magnifiers.items():
            # Results are as the part of the exemplar that is used.
            sign = (pane is exemplar) - (source is exemplar)
            place = row + sign * corner[0], column + sign * corner[1]
            magnifier.look(pane.picture if shown else None, *place)
