"""What an explanation of a pixel is made of: something computed elsewhere, and a view that shows it.

A file of this package that explains a kind of result ends with ``EXPLAINER = Explainer(...)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.style.theme import Theme
    from texlab_core.engine.result import Result


def never() -> bool:
    """Do not stop."""
    return False


class ExplanationView(QWidget):
    """Shows explanations of one kind.

    ``marks_changed(marks)``: the places of the exemplar to outline, a tuple of ``Mark``.
    ``intention(value)``: what the user wants to be done, a value of :mod:`texlab.state.intentions`.
    ``aspect_changed(aspect)``: the user looks at another part of the explanation; another view beside it may
    follow with :meth:`take_aspect`.
    """

    marks_changed = Signal(object)
    intention = Signal(object)
    aspect_changed = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._explained: Any = None

    def show_explanation(self, explained: Any) -> None:
        """Show what ``Explainer.explain`` returned, and tell which places to outline."""
        raise NotImplementedError

    def forget(self) -> None:
        """Let go of what was explained: it may hold all that a result was made with."""
        if self._explained is not None:
            self._explained = None
            self.empty_parts()

    def empty_parts(self) -> None:
        """Empty what shows the explanation, without telling anyone; how the user looks at it stays."""
        raise NotImplementedError

    def take_aspect(self, aspect: Any) -> None:
        """Look at the part of the explanation that the same kind of view beside it looks at."""

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""


@dataclass(frozen=True)
class Explainer:
    """One way to explain pixels.

    Parameters
    ----------
    details
        Type of the ``details`` of the results that it can explain.
    explain
        Given a result, a row and a column of its image, and a function that says whether nobody waits for the
        answer any more, returns what the view shows; raises ``Cancelled`` when that function says so. It is called
        in a background thread and answers within some milliseconds, but for the first pixel of a result.
    make_view
        Makes the view, once.
    help
        What the view shows, for the dock's help.
    """

    details: type
    explain: Callable[[Result, int, int, Callable[[], bool]], Any]
    make_view: Callable[[], ExplanationView]
    help: str = ""
