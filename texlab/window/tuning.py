"""A and B: the chosen column and the one it is compared with, in one pane or side by side."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSignalBlocker
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QToolButton, QWidget

from texlab.columns.comparison import Comparison, other_of
from texlab.columns.magnifier import Magnifier
from texlab.style.text_size import grow_with_text
from texlab.widgets.pair_layer import GAINS, Mode
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.short_box import ShortBox

if TYPE_CHECKING:
    from texlab.columns.column import ColumnView
    from texlab.columns.workspace import Workspace
    from texlab.state.scene import Scene
    from texlab.widgets.image_pane import ImagePane
    from texlab.window.main_window import MainWindow

MODES: tuple[Mode, ...] = ("flicker", "swipe", "difference")


class CompareBar(QWidget):
    """The ways of comparing, below the stage."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__()
        self.setObjectName("compare-bar")
        self.setAccessibleName("Comparison of A and B")
        self.words = Label()
        self.words.setObjectName("compare-words")
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
        layout.addWidget(self.words, 1)
        self.hide()


class Tuning(QObject):
    """Follows what is chosen, and compares it with what was chosen before.

    In the layout Tune (:meth:`set_active`) the stage shows exemplar, A and B alone.
    """

    def __init__(self, window: MainWindow, workspace: Workspace) -> None:
        super().__init__(window)
        self._window = window
        self._workspace = workspace
        self.comparison = Comparison(self)
        self.bar = CompareBar(window)
        self.a, self.b = 0, 0
        self._order: tuple[int, ...] = ()
        self._active = False
        self._magnifiers: dict[ImagePane, Magnifier] = {}
        self._magnifies = False
        self.bar.gain.setCurrentIndex(GAINS.index(self.comparison.gain))
        self.bar.gain.activated.connect(lambda _: self.comparison.set_gain(self.bar.gain.currentData()))
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

    def set_active(self, active: bool) -> None:
        """Show A and B alone, or all columns."""
        if self._active and not active:
            self._workspace.show_only(None)
        self._active = active
        self.bar.setVisible(active)
        self._fold()

    def show_scene(self, scene: Scene) -> None:
        """Follow the choice and the pictures."""
        order = tuple(column.id for column in scene.columns)
        if scene.selected_id not in (self.a, self.b) or {self.a, self.b} - set(order) or order != self._order:
            before = self.a if scene.selected_id != self.a else self.b
            # One of the pair stays where it is when it is chosen.
            if scene.selected_id != self.b or self.a not in order:
                self.a = scene.selected_id
                self.b = other_of(self.a, order, before) or 0
        self._order = order
        self._fold()
        pictures = {column.id: column.picture for column in scene.columns}
        view = self._workspace.columns.get(self.a)
        pane = view.pane if view is not None else None
        self.comparison.show_pair(pane, pictures.get(self.a), pictures.get(self.b))
        for name in MODES:
            self._window.actions_by_name[name].setEnabled(bool(self.b))
        self._say()

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
        titles = [views[each].method_box.label for each in (self.a, self.b) if each in views]
        if len(titles) < 2:
            self.bar.words.setText("There is one column only; duplicate it (Ctrl+D) to compare.")
            return
        shown = {
            "off": "A: {}   B: {}",
            "flicker": "B in the place of A: {1}",
            "swipe": "left of the line A: {}   right B: {}",
            "difference": "difference of A: {} and B: {}; black is equal",
        }[mode]
        self.bar.words.setText(shown.format(*titles))

    # The magnifier.

    def set_magnifies(self, on: bool) -> None:
        """Show the surroundings of the pixel under the pointer, enlarged, in all panes."""
        self._magnifies = on
        if not on:
            self._look(-1, -1)

    def _watch_column(self, view: ColumnView) -> None:
        self._watch(view.pane)

    def _watch(self, pane: ImagePane) -> None:
        self._magnifiers[pane] = Magnifier(pane)
        pane.hovered.connect(self._look)

    def _let_go(self, view: ColumnView) -> None:
        self._magnifiers.pop(view.pane, None)
        self.comparison.forget(view.pane)

    def _look(self, row: int, column: int) -> None:
        shown = self._magnifies and row >= 0
        for pane, magnifier in self._magnifiers.items():
            magnifier.look(pane.picture if shown else None, row, column)
