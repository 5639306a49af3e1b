"""The parameter panel: widgets made from ``describe()``, one row per knob."""

from __future__ import annotations

import math
import time
from collections import deque
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QTimer, Signal
from PySide6.QtWidgets import (
    QGridLayout,
    QToolButton,
    QWidget,
)

from texlab.form.knobs import ChoiceKnob, KnobWidget, NumberKnob, SwitchKnob, editor_of
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.params import describe
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from texlab_core.engine.params import Field, Params

# Of a frame's sixteen milliseconds, with room for laying out and painting what was made.
PIECE_S = 0.004


def tooltip(field: Field) -> str:
    """Return what a knob does, its range and default, and where it stands in the paper."""
    knob = field.knob
    lines = [field.label, knob.help]
    lines += [f"{choice}: {knob.choices.get(choice, '')}" for choice in field.choices]
    if field.kind in ("int", "float"):
        unit = f" {knob.unit}" if knob.unit else ""
        lines.append(f"{field.allowed}{unit}; default {field.default}")
    elif field.kind != "value":
        lines.append(f"Default: {field.default}")
    if knob.source:
        lines.append(knob.source)
    return "\n".join(lines)


class ParameterForm(QWidget):
    """All knobs of one method.

    Parameters
    ----------
    params_class
        Whose knobs.
    in_pieces
        Whether the knobs come a few at a time from the event loop: all of them are more than a frame takes.

    ``edited(params, name, final)``: checked parameters in which the knob ``name`` was changed.
    ``refused(sentence)``: a combination that the parameters do not accept.
    """

    edited = Signal(object, str, bool)
    refused = Signal(str)
    dock_wanted = Signal(str)

    def __init__(
        self, params_class: type[Params], parent: QWidget | None = None, *, in_pieces: bool = False
    ) -> None:
        super().__init__(parent)
        self.setObjectName("parameter-form")
        self.setAccessibleName("Parameters of the chosen column")
        self._params = params_class()
        self._context: Any = None
        self.fields = {field.name: field for field in describe(params_class)}
        self._coming = deque(self.fields.values())
        self._group = ""
        self._knobs: dict[str, KnobWidget] = {}
        self._labels: dict[str, Label] = {}
        self._resets: dict[str, QToolButton] = {}
        self._error_rows: dict[str, int] = {}
        self._row = 0
        # Rows come a few at a time; until its own has come it belongs here, too.
        self._error = Label(parent=self)
        self._error.setObjectName("form-error")
        self._error.setProperty("role", "error")
        self._error.setWordWrap(True)
        self._error.hide()
        self._layout = QGridLayout(self)
        self._layout.setContentsMargins(8, 4, 8, 8)
        self._layout.setVerticalSpacing(3)
        self._layout.setColumnStretch(0, 1)
        if not self.fields:
            self._layout.addWidget(Label("This method has no parameters."), 0, 0)
        self._growth = QTimer(self)
        self._growth.timeout.connect(lambda: self._grow())
        if in_pieces:
            self._growth.start()
        else:
            self.complete()

    @property
    def knobs(self) -> dict[str, KnobWidget]:
        """The knobs by the names of their parameters, every one of them."""
        self.complete()
        return self._knobs

    def complete(self) -> None:
        """Make the knobs that are still to come."""
        self._grow(math.inf)

    def _grow(self, seconds: float = PIECE_S) -> None:
        end = time.perf_counter() + seconds
        while self._coming and time.perf_counter() < end:
            self._next()
        if not self._coming:
            self._growth.stop()

    def _next(self) -> None:
        field = self._coming.popleft()
        if field.knob.group and field.knob.group != self._group:
            self._group = field.knob.group
            heading = Label(self._group)
            heading.setProperty("role", "heading")
            heading.setContentsMargins(0, 8, 0, 0)
            self._layout.addWidget(heading, self._row, 0, 1, 2)
            self._row += 1
        self._add(field)
        if not self._coming:
            self._layout.addWidget(self._error, self._row, 0, 1, 2)
            self._layout.setRowStretch(self._row + 1, 1)

    @property
    def params(self) -> Params:
        """The parameters shown."""
        return self._params

    def set_params(self, params: Params) -> None:
        """Show parameters without emitting anything."""
        self._params = params
        self._error.hide()
        for name, knob in self._knobs.items():
            knob.set_value(getattr(params, name))
            self._update_state(name)

    def settle(self) -> None:
        """End what goes on, before another column is shown: it is emitted as final."""
        for knob in self._knobs.values():
            knob.settle()

    def set_context(self, context: Any) -> None:
        """Hand the chosen column's scene to the special editors."""
        self._context = context
        for knob in self._knobs.values():
            knob.set_context(context)

    def _make_knob(self, field: Field) -> KnobWidget | None:
        if field.kind in ("int", "float"):
            return NumberKnob(field, self)
        if field.kind == "choice":
            return ChoiceKnob(field, self)
        if field.kind == "bool":
            return SwitchKnob(field, self)
        editor = editor_of(field.type)
        return editor(field, self) if editor is not None else None

    def _add(self, field: Field) -> None:
        knob = self._make_knob(field)
        if knob is None:
            return
        knob.setObjectName(f"knob-{field.name}")
        set_tip(knob, tooltip(field))
        label = Label(field.label)
        set_tip(label, tooltip(field))
        label.setBuddy(knob)
        reset = QToolButton()
        reset.setObjectName(f"reset-{field.name}")
        reset.setText("↺")
        reset.setAutoRaise(True)
        set_tip(reset, f"Reset {field.label} to its default")
        reset.setAccessibleName(f"Reset {field.label}")
        # A knob must not move when it leaves its default.
        policy = reset.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        reset.setSizePolicy(policy)
        reset.clicked.connect(lambda: self._edit(field.name, field.default, True))
        row = self._row
        if field.kind == "bool":
            line = QWidget()
            inner = QGridLayout(line)
            inner.setContentsMargins(0, 0, 0, 0)
            inner.addWidget(knob, 0, 0)
            inner.addWidget(label, 0, 1)
            inner.setColumnStretch(1, 1)
            self._layout.addWidget(line, row, 0)
            self._layout.addWidget(reset, row, 1)
        else:
            self._layout.addWidget(label, row, 0)
            self._layout.addWidget(reset, row, 1)
            self._layout.addWidget(knob, row + 1, 0, 1, 2)
        self._error_rows[field.name] = row + 2
        self._row = row + 3
        self._knobs[field.name] = knob
        self._labels[field.name] = label
        self._resets[field.name] = reset
        knob.set_value(getattr(self._params, field.name))
        knob.set_context(self._context)
        self._update_state(field.name)
        knob.edited.connect(lambda value, final: self._edit(field.name, value, final))
        knob.dock_wanted.connect(self.dock_wanted)

    def _edit(self, name: str, value: Any, final: bool) -> None:
        try:
            params = self._params.replace(**{name: value})
        except ParamError as error:
            self._show_error(name, str(error))
            self.refused.emit(str(error))
            self._knobs[name].set_value(getattr(self._params, name))
            return
        if params != self._params:
            # What was refused while dragging stays to be read after the release.
            self._error.hide()
        self._params = params
        if final:
            self._knobs[name].set_value(getattr(params, name))
        for each in self._knobs:
            self._update_state(each)
        self.edited.emit(params, name, final)

    def _show_error(self, name: str, sentence: str) -> None:
        """Say below its knob why a value was refused."""
        self._layout.removeWidget(self._error)
        self._layout.addWidget(self._error, self._error_rows[name], 0, 1, 2)
        self._error.setText(sentence)
        self._error.show()

    def _update_state(self, name: str) -> None:
        field = self.fields[name]
        when = field.knob.when
        useful = when is None or getattr(self._params, when[0]) in when[1]
        self._knobs[name].setEnabled(useful)
        self._labels[name].setEnabled(useful)
        self._resets[name].setVisible(getattr(self._params, name) != field.default)
