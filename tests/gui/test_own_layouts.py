"""Layouts of one's own: what is kept, what is refused, and the way back; with real events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import Qt

from texlab.window.own_layouts import (
    KEPT,
    MAX_LAYOUTS,
    MAX_NAME,
    LayoutsDialog,
    OwnLayout,
    layout_from_json,
    name_problem,
)

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

LEFT = Qt.MouseButton.LeftButton
LAYOUT = OwnLayout("tune", b"\0state", "spectrum", False, {"spectrum": {"log": True, "scale": 3}})


def test_it_comes_back_from_the_settings() -> None:
    assert layout_from_json(LAYOUT.to_json()) == LAYOUT


@pytest.mark.parametrize(
    "change",
    [
        {"base": "other"},
        {"base": None},
        {"state": "no base64 !"},
        {"state": 3},
        {"state": "A" * 2**17},
        {"front": None},
        {"open": 1},
    ],
)
def test_what_is_damaged_is_left_out(change: dict[str, Any]) -> None:
    assert layout_from_json(LAYOUT.to_json() | change) is None
    assert layout_from_json([]) is None


def test_controls_that_are_none_are_left_out() -> None:
    damaged = LAYOUT.to_json() | {"controls": {"spectrum": {"log": [], "scale": 3}, "maps": 5}}
    found = layout_from_json(damaged)
    assert found is not None
    assert found.controls == {"spectrum": {"scale": 3}}


@pytest.mark.parametrize("name", ["mine", "  mine ", "a" * MAX_NAME, "<b>", "A & B"])
def test_names_that_can_be_taken(name: str) -> None:
    assert not name_problem(name, ())


@pytest.mark.parametrize("name", ["", "  ", "a" * (MAX_NAME + 1), "a\nb", "Explore", "tune"])
def test_names_that_are_refused(name: str) -> None:
    problem = name_problem(name, ())
    assert problem.endswith(".")


def test_a_shelf_that_is_full() -> None:
    full = [str(number) for number in range(MAX_LAYOUTS)]
    assert "delete one" in name_problem("one more", full)
    assert not name_problem("7", full)


def dialog(explorer: Explorer) -> LayoutsDialog:
    explorer.window.actions_by_name["own-layouts"].trigger()
    found = explorer.window.findChild(LayoutsDialog, "layouts-dialog")
    assert isinstance(found, LayoutsDialog)
    return found


def texts(made: LayoutsDialog) -> list[str]:
    return [made.list.item(row).text() for row in range(made.list.count())]


def test_panels_tabs_and_controls_come_back(explorer: Explorer, qtbot: Any) -> None:
    window = explorer.window
    window.actions_by_name["layout-explore"].trigger()
    window.docks["maps"].close()
    window.docks["gallery"].close()
    window.raise_dock("histograms")
    histograms = explorer.hosts["histograms"].dock
    qtbot.waitUntil(lambda: not histograms.visibleRegion().isEmpty())
    controls = histograms.settings()
    log = next(name for name, value in controls.items() if value is False)
    histograms.take_settings({log: True})
    box = dialog(explorer)
    qtbot.keyClicks(box.name, "My <b> & you")
    qtbot.keyClick(box.name, Qt.Key.Key_Return)
    assert texts(box) == ["My <b> & you"]
    qtbot.mouseClick(box.done_button, LEFT)
    # Everything is different now.
    window.actions_by_name["layout-tune"].trigger()
    histograms.take_settings({log: False})
    window.raise_dock("maps")
    assert not window.docks["maps"].isHidden()
    # The menu of the toolbar's button brings it back.
    action = next(each for each in window.toolbar.layout_menu.actions() if "My" in each.text())
    assert action.text() == "Layout My <b> && you"
    action.trigger()
    assert window.docks["maps"].isHidden()
    assert window.docks["gallery"].isHidden()
    assert histograms.settings()[log] is True
    qtbot.waitUntil(lambda: not histograms.visibleRegion().isEmpty())
    assert explorer.settings.text("layout") == "explore"


def test_a_deleted_one_can_be_brought_back(explorer: Explorer, qtbot: Any) -> None:
    explorer.own_layouts.keep("one")
    explorer.own_layouts.keep("two")
    box = dialog(explorer)
    box.list.setCurrentRow(0)
    qtbot.mouseClick(box.delete, LEFT)
    assert texts(box) == ["two"]
    assert "deleted" in box.message.text()
    assert [each for each in explorer.window.actions_by_name if each.startswith("own-layout-")] == ["own-layout-0"]
    qtbot.mouseClick(box.back, LEFT)
    assert sorted(texts(box)) == ["one", "two"]
    assert not box.back.isEnabled()
    qtbot.keyClicks(box.name, "Explore")
    assert not box.keep.isEnabled()
    assert "layout of the program" in box.message.text()
    qtbot.keyClick(box.name, Qt.Key.Key_Return)
    assert sorted(texts(box)) == ["one", "two"]
    qtbot.mouseClick(box.done_button, LEFT)


def test_damaged_settings_offer_what_is_whole(explorer: Explorer) -> None:
    own = explorer.own_layouts
    own.keep("whole")
    explorer.settings.values[KEPT]["broken"] = {"base": "explore"}
    assert list(own.layouts) == ["whole"]
    explorer.settings.values[KEPT] = "nonsense"
    assert own.layouts == {}
    own.take("whole")
