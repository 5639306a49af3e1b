"""Marks, arrows, handles and the buttons of panels are as large as the text, and as usual beside usual text."""

from __future__ import annotations

from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QDockWidget,
    QMainWindow,
    QRadioButton,
    QStyle,
    QStyleOptionButton,
    QStyleOptionSlider,
    QStyleOptionSpinBox,
)

from texlab.style.theme import DARK, LIGHT, Theme, apply_theme, set_text_size
from texlab.widgets.number_box import NumberBox, WholeBox
from texlab.widgets.plain import Label
from texlab.widgets.slider import Slider
from texlab.widgets.title_bar import TitleBar, grow_title

Sub, Control, Element = QStyle.SubControl, QStyle.ComplexControl, QStyle.SubElement


def sizes(*widgets: Any) -> dict[str, float]:
    """The least side of what is hit with the mouse in each widget, in heights of its capitals."""
    found = {}
    for widget in widgets:
        widget.resize(widget.sizeHint())
        style, option = widget.style(), QStyleOptionButton()
        if isinstance(widget, QCheckBox | QRadioButton):
            widget.initStyleOption(option)
            is_check = isinstance(widget, QCheckBox)
            element = Element.SE_CheckBoxIndicator if is_check else Element.SE_RadioButtonIndicator
            area = style.subElementRect(element, option, widget)
        elif isinstance(widget, Slider):
            slider = QStyleOptionSlider()
            widget.initStyleOption(slider)
            area = style.subControlRect(Control.CC_Slider, slider, Sub.SC_SliderHandle, widget)
            area = area & widget.rect()
        else:
            box = QStyleOptionSpinBox()
            widget.initStyleOption(box)
            up, down = (
                style.subControlRect(Control.CC_SpinBox, box, part, widget)
                for part in (Sub.SC_SpinBoxUp, Sub.SC_SpinBoxDown)
            )
            area = up | down
        found[type(widget).__name__] = min(area.width(), area.height()) / widget.fontMetrics().capHeight()
    return found


def with_panel(qtbot: Any) -> tuple[QMainWindow, QDockWidget]:
    """A window, and a panel in it whose title grows with the text."""
    window = QMainWindow()
    qtbot.addWidget(window)
    dock = QDockWidget("Pyramid", window)
    dock.setWidget(Label("inside"))
    grow_title(dock)
    window.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, dock)
    return window, dock


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_what_is_hit_is_as_large_as_the_text(qtbot: Any, qapp: Any, theme: Theme) -> None:
    window, dock = with_panel(qtbot)
    parts = [QCheckBox("check"), QRadioButton("radio"), NumberBox(), WholeBox(), Slider("slider", str)]
    for part in parts:
        qtbot.addWidget(part)
        part.show()
    window.show()
    before = qapp.font().pointSizeF()
    apply_theme(qapp, theme)
    usual = sizes(*parts)
    assert dock.titleBarWidget() is None
    try:
        for points in (20.0, 60.0):
            set_text_size(qapp, points, theme)
            qtbot.waitUntil(lambda: dock.titleBarWidget() is not None)
            for name, size in sizes(*parts).items():
                assert size >= 1.0, (name, points)
            bar = dock.titleBarWidget()
            assert isinstance(bar, TitleBar)
            QApplication.processEvents()
            for button in (bar.float_button, bar.close_button):
                assert min(button.width(), button.height()) >= 1.0 * window.fontMetrics().capHeight()
    finally:
        set_text_size(qapp, before, LIGHT)
        apply_theme(qapp, LIGHT)
    qtbot.waitUntil(lambda: dock.titleBarWidget() is None)
    assert sizes(*parts) == pytest.approx(usual)


def test_the_larger_title_lets_a_panel_float_and_closes_it(qtbot: Any, qapp: Any) -> None:
    window, dock = with_panel(qtbot)
    window.show()
    before = qapp.font().pointSizeF()
    try:
        set_text_size(qapp, 30.0, LIGHT)
        qtbot.waitUntil(lambda: dock.titleBarWidget() is not None)
        bar = dock.titleBarWidget()
        assert isinstance(bar, TitleBar)
        for floats in (True, False):
            bar.float_button.click()
            assert dock.isFloating() == floats
        dock.setWindowTitle("Pyramid, level 2")
        assert bar.title.text() == "Pyramid, level 2"
        bar.close_button.click()
        assert not dock.isVisible()
    finally:
        set_text_size(qapp, before, LIGHT)
