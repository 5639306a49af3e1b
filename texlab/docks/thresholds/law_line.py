"""The law above the table: its two knobs, and what it says for every level."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QWidget

from texlab.docks.thresholds.table import cell_text, law_of
from texlab.form.form import tooltip
from texlab.form.knobs import NumberKnob
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.params import describe
from texlab_core.methods.de_bonet.params import DeBonetParams
from texlab_core.methods.de_bonet.thresholds import threshold_law

if TYPE_CHECKING:
    from PySide6.QtGui import QResizeEvent

    from texlab_core.engine.params import Params

SIGNS = {"alpha": "α", "beta": "β"}
LAW = "T = α / k^β"


class LawLine(QWidget):
    """Edits alpha and beta of T = alpha / k^beta; ``edited(name, value, final)``."""

    edited = Signal(str, object, bool)

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAccessibleName("Law of the thresholds")
        self.knobs: dict[str, NumberKnob] = {}
        self._said: tuple[str, ...] = ("",)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        for field in describe(DeBonetParams):
            if field.name not in SIGNS:
                continue
            knob = self.knobs[field.name] = NumberKnob(field)
            # Not a setting of the tab: what is kept of those must not move parameters.
            knob.slider.setObjectName(f"{name}_{field.name}-slider")
            knob.box.setObjectName(f"{name}_{field.name}")
            for part in (knob.slider, knob.box):
                set_tip(part, tooltip(field))
            knob.edited.connect(lambda value, final, key=field.name: self.edited.emit(key, value, final))
            layout.addWidget(Label(SIGNS[field.name]))
            layout.addWidget(knob, 1)
        self.words = Label(name=f"{name}_words")
        # A deep pyramid must not widen the window; the tip has all of it.
        self.words.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        layout.addWidget(self.words, 2)

    def show_law(self, params: Params, depth: int) -> None:
        """Show the law of a column, whose table has so many rows; hidden where parameters have none."""
        self.setVisible(all(hasattr(params, name) for name in self.knobs))
        for name, knob in self.knobs.items():
            value: Any = getattr(params, name, None)
            if value is not None:
                knob.set_value(value)
        said = law_words(*law_of(params), depth)
        # From all of it to the law alone: no word is cut.
        self._said = (said, said.partition(":")[0].removesuffix(" at every k"), LAW, "")
        self._fit()
        set_tip(self.words, f"{said} (k = 1 is the coarsest level; De Bonet 1997, eq. 13)")

    def _fit(self) -> None:
        metrics, room = self.words.fontMetrics(), self.words.width()
        self.words.setText(next((each for each in self._said if metrics.horizontalAdvance(each) <= room), ""))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Say as much of the law as there is room for."""
        super().resizeEvent(event)
        self._fit()

    def settle(self) -> None:
        """Emit what has not been emitted as final yet."""
        for knob in self.knobs.values():
            knob.settle()


def law_words(alpha: float, beta: float, depth: int) -> str:
    """Return the law with its numbers: ``T = α / k^β = 0.3 / k^1: 0.3, 0.15, 0.1``."""
    law = f"{LAW} = {cell_text(alpha)} / k^{cell_text(beta)}"
    values = [cell_text(float(each)) for each in threshold_law(alpha, beta, depth)]
    return f"{law} at every k" if len(set(values)) == 1 else f"{law}: {', '.join(values)}"
