"""How the controls of a widget stand, by name, and setting them as a user would."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractButton, QCheckBox, QComboBox, QSlider, QTabBar, QWidget

from texlab.widgets.number_box import NumberBox, WholeBox

if TYPE_CHECKING:
    from collections.abc import Mapping

Setting = bool | int | float | str
# Those of which all others may depend come first.
_KINDS: tuple[type[QWidget], ...] = (QTabBar, QComboBox, QCheckBox, WholeBox, NumberBox, QSlider)


def control_settings(widget: QWidget, prefix: str) -> dict[str, Setting]:
    """Return how the controls stand whose object names begin with ``prefix``, by the rest of their names."""
    found: dict[str, Setting] = {}
    for kind in _KINDS:
        for each in widget.findChildren(kind):
            name = each.objectName().removeprefix(prefix)
            if each.objectName().startswith(prefix) and name and each.isVisibleTo(widget) and each.isEnabled():
                value = _value(each)
                if value is not None:
                    found.setdefault(name, value)
    return found


def take_control_settings(widget: QWidget, prefix: str, wanted: Mapping[str, Any]) -> tuple[str, ...]:
    """Set controls by name, as a user would; return one clause for each that cannot be set."""
    problems = []
    left = dict(wanted)
    # A tab bar shows other controls, which may be made only then, and a list may offer others.
    for kind in (QTabBar, QWidget):
        found = {name: widget.findChild(kind, prefix + name) for name in left}
        for name, each in sorted(found.items(), key=lambda item: _order(item[1])):
            if each is None and kind is QTabBar:
                continue
            value = left.pop(name)
            if each is None or not _take(each, value):
                problems.append(f"{name} cannot be set to {value!r:.40}")
    return tuple(problems)


def _order(widget: QWidget | None) -> int:
    return next((place for place, kind in enumerate(_KINDS) if isinstance(widget, kind)), len(_KINDS))


def _value(widget: QWidget) -> Setting | None:
    """Return a control's value, where it is a text, a number, true or false."""
    if isinstance(widget, QTabBar):
        data = widget.tabData(widget.currentIndex())
        return data if isinstance(data, str) else None
    if isinstance(widget, QComboBox):
        data = widget.currentData()
        return data if isinstance(data, bool | int | float | str) else widget.currentText() or None
    if isinstance(widget, QCheckBox):
        return widget.isChecked()
    if isinstance(widget, WholeBox | NumberBox | QSlider):
        return widget.value()
    return None


def _take(widget: QWidget, value: Any) -> bool:
    """Give a control a value; return whether it has it then."""
    if isinstance(widget, QTabBar):
        index = next((place for place in range(widget.count()) if widget.tabData(place) == value), -1)
        widget.setCurrentIndex(index)
        return index >= 0
    if isinstance(widget, QComboBox):
        index = widget.findData(value)
        if index < 0 and isinstance(value, str):
            index = widget.findText(value, Qt.MatchFlag.MatchFixedString)
        if index >= 0 and index != widget.currentIndex():
            widget.setCurrentIndex(index)
            widget.activated.emit(index)
        return index >= 0
    if isinstance(widget, QAbstractButton):
        if not isinstance(value, bool) or not widget.isCheckable():
            return False
        widget.setChecked(value)
        return True
    if isinstance(widget, WholeBox | NumberBox | QSlider):
        if isinstance(value, bool | str):
            return False
        widget.setValue(value)
        return bool(abs(widget.value() - value) < 1e-9)
    return False
