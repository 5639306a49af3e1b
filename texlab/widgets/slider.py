"""A slider that tells screen readers what it sets, not where its handle stands."""

from __future__ import annotations

import inspect
import weakref
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSlider

from texlab.widgets.calm_wheel import CalmWheel

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtWidgets import QAbstractSlider, QWidget


class Slider(CalmWheel, QSlider):
    """A horizontal slider whose accessible name ends with its value: "iterations: 5".

    Parameters
    ----------
    title
        What it sets.
    says
        Returns the value at a position, as people say it, with its unit; a method does not keep its object alive.
    parent
        The parent widget.
    """

    def __init__(self, title: str, says: Callable[[int], str], parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.keep_wheel_calm()
        self.title = title
        # Who owns a slider would otherwise own itself, and live on when it is let go.
        self._says = weakref.WeakMethod(says) if inspect.ismethod(says) else lambda: says
        self.tell()

    def sliderChange(self, change: QAbstractSlider.SliderChange) -> None:
        """Tell the value whenever position or range change, also while signals are blocked."""
        super().sliderChange(change)
        self.tell()

    def tell(self) -> None:
        """Put the value into the accessible name; for values that change while the position stays."""
        says = self._says()
        said = f"{self.title}: {'' if says is None else says(self.value())}"
        if said != self.accessibleName():
            self.setAccessibleName(said)
