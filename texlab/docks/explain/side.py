"""One explained column: its heading while two are compared, and the view of its kind or why there is none."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QStackedLayout, QVBoxLayout, QWidget

from texlab.widgets.plain import Label, ShortLabel

if TYPE_CHECKING:
    from texlab.docks.explain.base import Explainer, ExplanationView
    from texlab.style.pictures import Mark
    from texlab.style.theme import Theme

OWN = "explain-"


class Side(QWidget):
    """Shows what :class:`Explainer` objects return, each in its own view, which is made when it is first needed.

    ``marks_changed(marks)``, ``intention(value)`` and ``aspect_changed(aspect)`` are those of the views.

    Parameters
    ----------
    letter
        "A" or "B". The names of B's parts, and what a screen reader calls them, tell them from A's; its marks are
        dotted.
    """

    marks_changed = Signal(object)
    intention = Signal(object)
    aspect_changed = Signal(object)

    def __init__(self, letter: str) -> None:
        super().__init__()
        self.letter = letter
        self.second = letter == "B"
        self.setObjectName(f"{OWN}side-{letter.lower()}")
        self.setAccessibleName(f"Explanation, {letter}")
        self.views: dict[int, ExplanationView] = {}
        self.marks: tuple[Mark, ...] = ()
        self.heading = ShortLabel(name=f"{OWN}heading-{letter.lower()}")
        self.heading.setMargin(3)
        self.heading.hide()
        self._reason = Label(name=f"{OWN}reason-{letter.lower()}", muted=True, wraps=True)
        self._reason.setAlignment(Qt.AlignmentFlag.AlignCenter)
        pages = QWidget()
        self._pages = QStackedLayout(pages)
        self._pages.addWidget(self._reason)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.heading)
        layout.addWidget(pages, 1)

    @property
    def view(self) -> ExplanationView | None:
        """The view that is shown."""
        return next((each for each in self.views.values() if each is self._pages.currentWidget()), None)

    @property
    def reason(self) -> str | None:
        """The sentence that is shown instead of a view, or None."""
        return self._reason.text() if self._pages.currentWidget() is self._reason else None

    def set_heading(self, words: str) -> None:
        """Write this above; nothing while the column is explained alone."""
        self.heading.setText(words)
        self.heading.setVisible(bool(words))

    def show_explanation(self, explainer: Explainer, explained: Any, theme: Theme) -> None:
        """Show what ``explainer`` returned."""
        view = self.views.get(id(explainer))
        if view is None:
            view = self.views[id(explainer)] = explainer.make_view()
            view.set_theme(theme)
            view.marks_changed.connect(self._mark)
            view.intention.connect(self.intention)
            view.aspect_changed.connect(self.aspect_changed)
            if self.second:
                _call_b(view)
            self._pages.addWidget(view)
        self._forget(but=view)
        self._pages.setCurrentWidget(view)
        self.setFocusProxy(view)
        view.show_explanation(explained)

    def show_reason(self, reason: str) -> None:
        """Show why there is nothing to show, outline nothing, and let go of what was explained."""
        self._reason.setText(reason)
        self._pages.setCurrentWidget(self._reason)
        self._mark(())
        self._forget()

    def _forget(self, but: ExplanationView | None = None) -> None:
        """Let every view but this one go of what it shows."""
        for view in self.views.values():
            if view is not but:
                view.forget()

    def take_aspect(self, aspect: Any) -> None:
        """Look at the same of the explanation as the other side, where there is such a thing."""
        if (view := self.view) is not None:
            view.take_aspect(aspect)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        for view in self.views.values():
            view.set_theme(theme)

    def _mark(self, marks: tuple[Mark, ...]) -> None:
        if self.second:
            marks = tuple(dataclasses.replace(each, dotted=True) for each in marks)
        self.marks = marks
        self.marks_changed.emit(marks)


def _call_b(view: ExplanationView) -> None:
    """Tell the parts of B's view from those of A's."""
    for part in (view, *view.findChildren(QWidget)):
        if part.objectName().startswith(OWN):
            part.setObjectName(f"{OWN}b-{part.objectName().removeprefix(OWN)}")
        if part.accessibleName():
            part.setAccessibleName(f"{part.accessibleName()}, B")
