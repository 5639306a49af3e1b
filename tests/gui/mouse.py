"""The mouse on sliders and panes: whether they are on the screen, places, moves with the button down, drags."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QPoint, Qt


def handle_point(slider: Any, share: float | None = None) -> QPoint:
    """Return where the slider's handle is, or would be at a share of the range."""
    from PySide6.QtWidgets import QStyle, QStyleOptionSlider

    option = QStyleOptionSlider()
    slider.initStyleOption(option)
    if share is not None:
        option.sliderPosition = round(slider.minimum() + share * (slider.maximum() - slider.minimum()))
    rectangle = slider.style().subControlRect(
        QStyle.ComplexControl.CC_Slider, option, QStyle.SubControl.SC_SliderHandle, slider
    )
    return rectangle.center()


def on_screen(qtbot: Any, widget: Any) -> Any:
    """Wait until a widget that was shown is on the screen, and return it.

    Under X that is later than it is shown: its window moves and its layouts are done until then.
    """
    qtbot.waitUntil(lambda: is_on_screen(widget))
    return widget


def is_on_screen(widget: Any) -> bool:
    """Return whether the window of a widget is exposed, and some of the widget is to be seen in it."""
    handle = widget.window().windowHandle()
    return handle is not None and handle.isExposed() and not widget.visibleRegion().isEmpty()


def drag(qtbot: Any, widget: Any, places: list[QPoint]) -> None:
    """Press at the first place, move over the others, release at the last."""
    button = Qt.MouseButton.LeftButton
    qtbot.mousePress(widget, button, pos=places[0])
    for place in places[1:]:
        move(qtbot, widget, place)
    qtbot.mouseRelease(widget, button, pos=places[-1])


def move(qtbot: Any, widget: Any, place: QPoint) -> None:
    """Move the mouse with the left button down (QTest's own moves carry no buttons)."""
    from PySide6.QtCore import QEvent, QPointF
    from PySide6.QtGui import QMouseEvent
    from PySide6.QtWidgets import QApplication

    left = Qt.MouseButton.LeftButton
    event = QMouseEvent(
        QEvent.Type.MouseMove,
        QPointF(place),
        QPointF(widget.mapToGlobal(place)),
        Qt.MouseButton.NoButton,
        left,
        Qt.KeyboardModifier.NoModifier,
    )
    QApplication.sendEvent(widget, event)
