"""The panel on the right: the parameters of the chosen column."""

from __future__ import annotations

from functools import partial
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
        self.setAccessibleName("Parameters")
        self.title = Label(name="parameters-title")
        self.title.setProperty("role", "heading")
        self.title.setWordWrap(True)
        self.summary = Label(name="parameters-summary", muted=True, wraps=True)
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
        # One form a method, of which one is seen: making it costs more than a frame.
        self._forms: dict[str, ParameterForm] = {}
        pages = QWidget()
        self._pages = QVBoxLayout(pages)
        self._pages.setContentsMargins(0, 0, 0, 0)
        self.scroll_area.setWidget(pages)
        self.form: ParameterForm | None = None
        # What which form was handed last.
        self._context: ColumnScene | None = None
        self._told: ParameterForm | None = None
        self._column_id = 0
        self._method = ""
        self.reset_button.clicked.connect(self._reset)
        self.help_button.clicked.connect(lambda: self.help_wanted.emit(self._method))

    def show_column(self, column_id: int, method: Method | None, params: Params | None) -> None:
        """Show the form for a column; the first time for a method its knobs come a few at a time."""
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
        # Its lines have their room before anything is painted.
        self._lay_out()
        form = self._forms.get(method.id)
        if form is None or not isinstance(params, type(form.params)):
            form = self._make_form(method)
        self._method = method.id
        form.set_params(params)
        self._set_form(form)

    def show_scene(self, scene: ColumnScene | None) -> None:
        """Hand the column's present result to the special editors."""
        if self.form is not None and (scene is not self._context or self.form is not self._told):
            self._context, self._told = scene, self.form
            self.form.set_context(scene)

    def _make_form(self, method: Method) -> ParameterForm:
        form = ParameterForm(method.params, in_pieces=True)
        form.hide()
        form.dock_wanted.connect(self.dock_wanted)
        form.edited.connect(partial(self._edit, form))
        self._pages.addWidget(form)
        old = self._forms.get(method.id)
        if old is not None:
            old.deleteLater()
        self._forms[method.id] = form
        return form

    def _lay_out(self) -> None:
        layout = self.layout()
        if layout is not None:
            layout.activate()

    def _set_form(self, form: ParameterForm | None) -> None:
        old, self.form = self.form, form
        if old is form:
            return
        if old is not None:
            # The results that its editors show beside their values are not held behind the scenes.
            old.set_context(None)
            old.hide()
        self._told = None
        if form is not None:
            form.show()
        self.scroll_area.verticalScrollBar().setValue(0)

    def _edit(self, form: ParameterForm, params: Params, name: str, final: bool) -> None:
        # What is typed in a form is told once more when it is hidden: that would be another column's.
        if form is self.form:
            self.intention.emit(EditParams(self._column_id, params, name, final))

    def _reset(self) -> None:
        if self.form is not None:
            self._edit(self.form, type(self.form.params)(), "reset all", True)
