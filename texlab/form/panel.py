"""The panel on the right: the parameters of the chosen column."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QScrollArea, QVBoxLayout, QWidget

from texlab.form.form import ParameterForm
from texlab.presets.bar import PresetBar
from texlab.state.intentions import EditParams
from texlab.widgets.plain import Label, set_tip

if TYPE_CHECKING:
    from texlab.state.scene import ColumnScene
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method


class ParametersView(QWidget):
    """Shows the form of the chosen column's method.

    ``intention(EditParams)``; ``help_wanted(method)``; ``dock_wanted(name)``.
    """

    intention = Signal(object)
    help_wanted = Signal(str)
    dock_wanted = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("parameters")
        self.title = Label()
        self.title.setObjectName("parameters-title")
        self.title.setProperty("role", "heading")
        self.title.setWordWrap(True)
        self.summary = Label()
        self.summary.setObjectName("parameters-summary")
        self.summary.setProperty("role", "muted")
        self.summary.setWordWrap(True)
        self.reset_button = QPushButton("Reset all")
        self.reset_button.setObjectName("reset-all")
        set_tip(self.reset_button, "Give every parameter of this column its default")
        self.help_button = QPushButton("About the method")
        self.help_button.setObjectName("method-help")
        set_tip(self.help_button, "Open the help page of this method (F1)")
        self.scroll_area = QScrollArea()
        self.scroll_area.setObjectName("parameters-scroll")
        self.scroll_area.setAccessibleName("Parameters of the chosen column")
        self.scroll_area.setWidgetResizable(True)
        self.presets = PresetBar()
        buttons = QHBoxLayout()
        buttons.addWidget(self.reset_button)
        buttons.addWidget(self.help_button)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(6, 6, 6, 6)
        layout.addWidget(self.title)
        layout.addWidget(self.summary)
        layout.addWidget(self.presets)
        layout.addWidget(self.scroll_area, 1)
        layout.addLayout(buttons)
        self.form: ParameterForm | None = None
        # What which form was handed last.
        self._context: ColumnScene | None = None
        self._told: ParameterForm | None = None
        self._column_id = 0
        self._method = ""
        self.reset_button.clicked.connect(self._reset)
        self.help_button.clicked.connect(lambda: self.help_wanted.emit(self._method))

    def show_column(self, column_id: int, method: Method | None, params: Params | None) -> None:
        """Show the form for a column; it is built anew only when the method differs."""
        if self.form is not None and column_id != self._column_id:
            self.form.settle()
        self._column_id = column_id
        self.reset_button.setEnabled(method is not None)
        self.help_button.setEnabled(method is not None)
        self.presets.setEnabled(method is not None)
        if method is None or params is None:
            self.title.setText("There is no column")
            self.summary.setText("Add one with + Column (Ctrl+T).")
            self._set_form(None)
            self._method = ""
            return
        self.title.setText(method.title)
        self.summary.setText(method.summary)
        if method.id != self._method or self.form is None:
            self._method = method.id
            self._set_form(ParameterForm(method.params))
        assert self.form is not None
        self.form.set_params(params)

    def show_scene(self, scene: ColumnScene | None) -> None:
        """Hand the column's present result to the special editors."""
        if self.form is not None and (scene is not self._context or self.form is not self._told):
            self._context, self._told = scene, self.form
            self.form.set_context(scene)

    def _set_form(self, form: ParameterForm | None) -> None:
        if self.form is not None:
            # What is typed in it would be told, as the next column's, when it is hidden.
            self.form.edited.disconnect()
        self.form = form
        old = self.scroll_area.takeWidget()
        if old is not None:
            old.deleteLater()
        # Without anything in it, the area would keep the scroll bar of what it had.
        self.scroll_area.setWidget(form or QWidget())
        if form is not None:
            form.dock_wanted.connect(self.dock_wanted)
            form.edited.connect(self._edit)

    def _edit(self, params: Params, name: str, final: bool) -> None:
        self.intention.emit(EditParams(self._column_id, params, name, final))

    def _reset(self) -> None:
        if self.form is not None:
            self._edit(type(self.form.params)(), "reset all", True)
