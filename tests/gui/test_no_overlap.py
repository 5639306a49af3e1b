"""Nothing that a layout places lies over its neighbour, in any layout of the window and in any tab."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtWidgets import QBoxLayout, QFormLayout, QGridLayout, QLayout, QWidget

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab.app.explorer import Explorer


def placed(layout: QLayout) -> Iterator[QWidget]:
    """Yield the widgets that are seen in a layout and in those within it."""
    for place in range(layout.count()):
        item = layout.itemAt(place)
        widget, inner = item.widget(), item.layout()
        if widget is not None and widget.isVisible():
            yield widget
        elif inner is not None:
            yield from placed(inner)


def overlaps(root: QWidget) -> list[str]:
    """Return pairs of neighbours that share pixels."""
    found = []
    for parent in [root, *root.findChildren(QWidget)]:
        layout = parent.layout()
        if parent.isVisible() and isinstance(layout, QBoxLayout | QGridLayout | QFormLayout):
            for one, other in itertools.combinations(placed(layout), 2):
                if one.geometry().intersects(other.geometry()):
                    names = (f"{type(each).__name__} {each.objectName()!r}" for each in (one, other))
                    found.append(f"{' and '.join(names)} in {parent.objectName()!r}")
    return found


@pytest.mark.parametrize("layout", ["explore", "tune", "teach"])
def test_nothing_lies_over_its_neighbour_in_a_layout(qtbot: Any, explorer: Explorer, layout: str) -> None:
    explorer.window.actions_by_name[f"layout-{layout}"].trigger()
    # Layouts are done when the events that ask for them are.
    qtbot.waitUntil(lambda: overlaps(explorer.window) == [])


def test_nothing_lies_over_its_neighbour_in_a_tab(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    for name, dock in window.docks.items():
        window.raise_dock(name)
        qtbot.waitUntil(lambda dock=dock: dock.isVisible() and overlaps(dock) == [])
