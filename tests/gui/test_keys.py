"""The keyboard and the screen reader: where Tab goes, what is named, which letters open what."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSlider,
    QApplication,
    QMenu,
    QProgressBar,
    QScrollBar,
    QSlider,
    QWidget,
)

import texlab
from tests.gui.conftest import ids, make_everything, on_screen, wait_idle
from texlab.window.stops import is_seen, stops

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

LETTERS = re.compile(r"[^\W\d_]{2}")
TAB = Qt.Key.Key_Tab
SHIFT = Qt.KeyboardModifier.ShiftModifier


def in_sight(widget: QWidget) -> bool:
    return widget.isVisible() and not widget.visibleRegion().isEmpty()


@pytest.mark.slow
def test_tab_goes_through_everything_that_is_seen_and_nothing_else(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    for name, host in explorer.hosts.items():
        window.raise_dock(name)
        dock = host.dock
        QApplication.processEvents()
        wait_idle(qtbot, explorer)
        window.toolbar.setFocus()
        expected = stops(window, window.tab_order())
        visited: list[QWidget] = []
        while len(visited) <= len(expected):
            qtbot.keyClick(window.focusWidget() or window, TAB)
            QApplication.processEvents()
            here = window.focusWidget()
            assert here is not None
            if visited and here is visited[0]:
                break
            # Fields that Tab is a character of would end the walk here.
            assert here not in visited, here.objectName()
            visited.append(here)
            assert in_sight(here), f"{here.objectName()} cannot be seen beside {dock.name}"
            assert window._ring.isVisible()
            assert window._ring.around is here
        assert {each.objectName() for each in visited} == {each.objectName() for each in expected}
        hidden = [other.dock for other in explorer.hosts.values() if other.is_made and other is not host]
        assert not any(other.isAncestorOf(each) for other in hidden for each in visited)
        qtbot.keyClick(window.focusWidget(), TAB, SHIFT)
        assert window.focusWidget() is visited[-1]
    buttons = {each.accessibleName() for each in visited if window.toolbar.isAncestorOf(each)}
    assert {"New seed", "Run all", "Open image"} <= buttons


def test_nobody_walks_the_chain_of_focus() -> None:
    """PySide invalidates objects that live on (actions of menus, later) when it wraps the chain."""
    folder = Path(texlab.__file__).parent
    walkers = [path for path in folder.rglob("*.py") if re.search("InFocusChain", path.read_text())]
    assert walkers == []


def test_the_ring_goes_with_the_window(qtbot: Any, explorer: Explorer) -> None:
    """Qt hands the keyboard on while a window is hidden part by part."""
    window = explorer.window
    for _ in range(7):
        qtbot.keyClick(window.focusWidget() or window, TAB)
        QApplication.processEvents()
    assert window._ring.isVisible()
    window.hide()
    QApplication.processEvents()
    assert not window._ring.isVisible()
    window.show()
    on_screen(qtbot, window)


def test_the_order_follows_the_eye(explorer: Explorer) -> None:
    window = explorer.window
    order = window.tab_order()
    found = stops(window, order)
    places = [next((k for k, part in enumerate(order) if part.isAncestorOf(each)), len(order)) for each in found]
    assert places == sorted(places)
    assert places[0] == 0


def test_tab_walks_through_the_columns_as_they_stand(explorer: Explorer) -> None:
    def columns() -> list[str]:
        found = [each.objectName() for each in stops(explorer.window, explorer.window.tab_order())]
        return [name for name in found if re.fullmatch(r"method-\d+", name)]

    first, second = ids(explorer)
    assert columns() == [f"method-{first}", f"method-{second}"]
    explorer.session.move_column(second, -1)
    explorer.presenter.show_scene(explorer.controller.scene())
    assert columns() == [f"method-{second}", f"method-{first}"]


def test_the_letters_of_every_menu_are_unique(explorer: Explorer) -> None:
    def check(menu: QMenu, name: str) -> None:
        letters = [
            action.text()[action.text().index("&") + 1].lower()
            for action in menu.actions()
            if "&" in action.text().replace("&&", "")
        ]
        twice = {letter for letter in letters if letters.count(letter) > 1}
        assert not twice, f"{name}: {', '.join(sorted(twice))}"

    make_everything(explorer)
    menus = explorer.window.findChildren(QMenu)
    assert {*explorer.window.menus.values()} < {*menus}
    for menu in menus:
        check(menu, menu.title() or menu.objectName())
    check(explorer.window.menuBar(), "menu bar")  # type: ignore[arg-type]


def test_everything_has_a_name(explorer: Explorer) -> None:
    make_everything(explorer)
    unnamed = set()
    for widget in explorer.window.findChildren(QWidget):
        of_a_list = type(widget).__name__ == "QListView" and not widget.objectName()
        if isinstance(widget, QScrollBar) or widget.objectName().startswith("qt_") or of_a_list:
            continue
        counts = isinstance(widget, QProgressBar) or (
            widget.focusPolicy() & Qt.FocusPolicy.TabFocus and widget.focusProxy() is None
        )
        text = widget.text() if isinstance(widget, QAbstractButton) else ""
        if counts and not LETTERS.search(widget.accessibleName() or text):
            unnamed.add(f"{type(widget).__name__} {widget.objectName()!r}")
    assert not unnamed, "\n".join(sorted(unnamed))


def test_cards_and_progress_say_whose_they_are(explorer: Explorer) -> None:
    view = explorer.workspace.columns[ids(explorer)[0]]
    assert view.accessibleName() == "Column Heeger-Bergen"
    assert view.pane.accessibleName() == "Result of Heeger-Bergen"
    assert view.progress.accessibleName() == "Progress of Heeger-Bergen"


def test_sliders_say_their_value_and_not_their_position(qtbot: Any, explorer: Explorer) -> None:
    form = explorer.window.parameters.form
    slider = form.knobs["iterations"].findChild(QSlider)
    assert slider.accessibleName() == "iterations: 2"
    slider.setFocus()
    qtbot.keyClick(slider, Qt.Key.Key_End)
    wait_idle(qtbot, explorer)
    value = explorer.session.selected_column.params.iterations
    assert value > 2
    assert slider.accessibleName() == f"iterations: {value}"
    for each in form.findChildren(QAbstractSlider):
        if isinstance(each, QSlider):
            assert ":" in each.accessibleName(), each.objectName()
    assert is_seen(slider)
    assert explorer.window.findChild(QAction, "action-undo").isEnabled()
