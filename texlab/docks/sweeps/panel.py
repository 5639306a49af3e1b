"""What a sweep is to be: one or two axes, the other parameters, the size of the cells; or a ready-made one."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QGridLayout, QScrollArea, QSizePolicy, QWidget

from texlab.docks.sweeps.axis import AxisChoice, AxisEditor
from texlab.state.sweeps import SweepPlan
from texlab.style.text_size import grow_with_text
from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.plain import Label, set_tip, tip_text
from texlab_core.errors import InputError
from texlab_core.sheets.sweep import show

if TYPE_CHECKING:
    from texlab_core.engine.registry import Method
    from texlab_core.sheets.sweep_recipes import SweepRecipe

SIDES = (64, 96, 128, 192, 256)
USUAL_SIDE = 128
WIDTH = 252
_LABEL = 46


class SweepPanel(QScrollArea):
    """Chooses what is varied, and what all cells share.

    Parameters
    ----------
    name
        Prefix of the object names.
    """

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(f"{name}-panel")
        self.setAccessibleName("What the sweep varies")
        self._method = ""
        self._choices: dict[str, tuple[AxisChoice, AxisChoice]] = {}
        self._recipes: tuple[SweepRecipe, ...] = ()
        self._recipe: SweepRecipe | None = None
        # Name of a ready-made sweep that is to be chosen as soon as it is offered.
        self._wanted = ""
        self.ready_box, self.base_box, self.side_box = ChoiceBox(), ChoiceBox(), ChoiceBox()
        for side in SIDES:
            self.side_box.addItem(f"{side} x {side}", side)
        self.side_box.addItem("as the columns", None)
        self.side_box.setCurrentIndex(SIDES.index(USUAL_SIDE))
        self.across = AxisEditor(f"{name}-across", "Across", optional=False, has_textures=True)
        self.down = AxisEditor(f"{name}-down", "Down", optional=True)
        self.error = Label(name=f"{name}-error")
        self.error.setProperty("role", "error")
        self.error.setWordWrap(True)
        self.error.hide()
        inside = QWidget()
        layout = QGridLayout(inside)
        layout.setContentsMargins(0, 0, 6, 0)
        layout.setSpacing(4)
        tip = "Ready-made sweeps of this method, the papers' figures among them"
        self._add(layout, 0, "Sweep", self.ready_box, f"{name}-ready", tip)
        layout.addWidget(self.across, 1, 0, 1, 2)
        layout.addWidget(self.down, 2, 0, 1, 2)
        tip = "What all cells share: the parameters that are not varied"
        self._add(layout, 3, "Others", self.base_box, f"{name}-base", tip)
        self._add(layout, 4, "Cells", self.side_box, f"{name}-side", "Height and width of every result, in pixels")
        layout.addWidget(self.error, 5, 0, 1, 2)
        layout.setRowStretch(6, 1)
        layout.setColumnStretch(1, 1)
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        grow_with_text(self, WIDTH, self.setFixedWidth)
        self.setWidget(inside)
        self.ready_box.activated.connect(lambda _: self._sweep_chosen())
        for axis in (self.across, self.down):
            axis.changed.connect(self._axis_changed)

    def _add(self, layout: QGridLayout, row: int, text: str, box: QComboBox, name: str, tip: str) -> None:
        label = Label(text)
        label.setBuddy(box)
        label.setMinimumWidth(_LABEL)
        box.setObjectName(name)
        box.setAccessibleName(text)
        set_tip(box, tip)
        box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        layout.addWidget(label, row, 0)
        layout.addWidget(box, row, 1)

    def show_method(self, method: Method) -> None:
        """Offer a method's knobs; what was chosen for it before comes back."""
        if method.id == self._method:
            return
        if self._method:
            self._choices[self._method] = (self.across.choice, self.down.choice)
        self._method = method.id
        across, down = self._choices.get(method.id, (None, None))
        self.across.show_method(method.params, across)
        self.down.show_method(method.params, down)
        self.show_sweeps(())
        self.tell("")

    @property
    def method(self) -> str:
        """Id of the method whose knobs are offered, "" before the first."""
        return self._method

    def show_sweeps(self, recipes: tuple[SweepRecipe, ...]) -> None:
        """Offer the method's ready-made sweeps; none is chosen."""
        self._recipes, self._recipe = recipes, None
        self.ready_box.clear()
        self.ready_box.addItem("own choice" if recipes else "none for this method")
        for place, recipe in enumerate(recipes):
            self.ready_box.addItem(recipe.name.removeprefix(f"{self._method}-").replace("-", " "))
            self.ready_box.setItemData(place + 1, tip_text(recipe.note), Qt.ItemDataRole.ToolTipRole)
        self.ready_box.setEnabled(bool(recipes))
        self._offer_base()
        if self._wanted:
            self.choose_ready(self._wanted)

    def choose_ready(self, name: str) -> None:
        """Choose a ready-made sweep by its name, now or when it is offered."""
        names = [recipe.name for recipe in self._recipes]
        self._wanted = "" if name in names else name
        if name in names:
            self.ready_box.setCurrentIndex(names.index(name) + 1)
            self._choose_sweep()

    def _sweep_chosen(self) -> None:
        self._wanted = ""
        self._choose_sweep()

    @property
    def chosen_sweep(self) -> SweepRecipe | None:
        """The ready-made sweep that is shown as it is."""
        place = self.ready_box.currentIndex() - 1
        return self._recipes[place] if 0 <= place < len(self._recipes) else None

    def plan(self) -> SweepPlan:
        """Return what was asked for; raises ``InputError`` when it makes no sense."""
        axes = tuple(axis for axis in (self.across.vary(), self.down.vary()) if axis is not None)
        shared = self.side_box.currentData(), self.base_box.currentData()
        plan = SweepPlan(axes, *shared, textures=self.across.textures)
        recipe = self.chosen_sweep
        return plan if recipe is None else dataclasses.replace(plan, name=recipe.name, note=recipe.note)

    def tell_of(self, plan: SweepPlan | None, sentence: str) -> None:
        """Show what is wrong with a plan, as long as it is still the one that is shown."""
        try:
            mine = self.plan()
        except InputError:
            return
        if sentence and plan == mine:
            self.tell(sentence)

    def tell(self, sentence: str) -> None:
        """Show why nothing can be started; "" takes it away."""
        self.error.setText(sentence)
        self.error.setVisible(bool(sentence))
        if sentence:
            self.ensureWidgetVisible(self.error)

    def _choose_sweep(self) -> None:
        recipe = self.chosen_sweep
        # The editors tell of every change; these are not the user's.
        self._recipe = None
        if recipe is not None:
            self.across.show_vary(recipe.axes[0])
            if len(recipe.axes) > 1:
                self.down.show_vary(recipe.axes[1])
            else:
                self.down.choose_knob("")
            if recipe.size is not None and recipe.size[0] in SIDES:
                self.side_box.setCurrentIndex(SIDES.index(recipe.size[0]))
        self._recipe = recipe
        self._offer_base()

    def _offer_base(self) -> None:
        items: list[tuple[str, Any]] = [("as in the column", None)]
        if self._recipe is not None:
            given = self._recipe.parameters.items()
            values = ", ".join(f"{name.replace('_', ' ')} {show(value)}" for name, value in given)
            items.append((f"defaults, {values}" if values else "defaults", self._recipe.params))
        self.base_box.clear()
        for text, params in items:
            self.base_box.addItem(text, params)
        self.base_box.setEnabled(len(items) > 1)
        self.base_box.setCurrentIndex(len(items) - 1)

    def _axis_changed(self) -> None:
        self.tell("")
        if self._recipe is not None:
            # The values are the user's own from here on; the recipe's other parameters stay on offer.
            self.ready_box.setCurrentIndex(0)
