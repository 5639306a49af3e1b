"""The gallery's search knows the words of the stories."""

from __future__ import annotations

from typing import Any

import pytest
from mouse import on_screen
from PySide6.QtCore import Qt

from texlab.window.gallery import GalleryView
from texlab_core.images.gallery import gallery


@pytest.fixture
def view(qtbot: Any) -> GalleryView:
    found = GalleryView()
    qtbot.addWidget(found)
    found.show_entries((each.uri, each.cls, each.title, each.title, " ".join(each.keywords)) for each in gallery())
    found.show()
    return found


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("coral", {"structured-coral", "structured-dotlines"}),
        ("marble", {"stochastic-marble"}),
        ("hay", {"oriented-hay", "stochastic-grass"}),
        (
            "letters",
            {"letters-page", "letters-darwin", "letters-handwriting", "letters-scattered", "failure-symbols"},
        ),
        ("butterfly", {"structured-butterfly"}),
        ("seeds elements", {"structured-seeds", "inhomogeneous-seedgradient"}),
    ],
)
def test_keywords_find_textures(qtbot: Any, view: GalleryView, words: str, wanted: set[str]) -> None:
    qtbot.keyClicks(view.search, words)
    heads = [view.tree.topLevelItem(place) for place in range(view.tree.topLevelItemCount())]
    shown = [head.child(place) for head in heads for place in range(head.childCount())]
    names = {item.data(0, 0x100).removeprefix("gallery:") for item in shown if not item.isHidden()}
    assert names == wanted
    for head in heads:
        hidden = all(head.child(place).isHidden() for place in range(head.childCount()))
        assert head.isHidden() == hidden


def test_stripes_are_many(qtbot: Any, view: GalleryView) -> None:
    qtbot.keyClicks(view.search, "stripes")
    striped = [each.uri for each in gallery() if "stripes" in each.keywords]
    assert len(striped) >= 8


def whole(view: GalleryView, item: Any) -> bool:
    """Whether nothing of an item is cut off, above or below."""
    shown, room = view.tree.visualItemRect(item), view.tree.viewport().rect()
    return room.top() <= shown.top() < shown.bottom() <= room.bottom()


def test_what_was_chosen_is_whole(qtbot: Any, view: GalleryView) -> None:
    view.resize(220, 400)
    on_screen(qtbot, view)
    tree, bar = view.tree, view.tree.verticalScrollBar()
    items = list(view._items.values())
    wanted = items[12]
    view.chosen.connect(view.mark)
    tree.scrollToItem(wanted, tree.ScrollHint.PositionAtTop)
    # Half of it lies above the upper edge, then below the lower one.
    for hint, step in ((tree.ScrollHint.PositionAtTop, 27), (tree.ScrollHint.PositionAtBottom, -27)):
        tree.clearSelection()
        tree.scrollToItem(wanted, hint)
        bar.setValue(bar.value() + step)
        cut = tree.visualItemRect(wanted).intersected(tree.viewport().rect())
        assert not whole(view, wanted)
        qtbot.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=cut.center())
        assert wanted.isSelected()
        assert whole(view, wanted)
    # From elsewhere, in a list that gets another height, and after a search.
    view.mark(view.textures()[30][0])
    assert whole(view, items[30])
    for height in (300, 500, 260):
        view.resize(220, height)
        qtbot.waitUntil(lambda: not view._late.isActive() and whole(view, items[30]))
    qtbot.keyClicks(view.search, items[30].text(0))
    assert whole(view, items[30])
    view.search.clear()
    assert whole(view, items[30])
    # Who has scrolled away stays there.
    bar.setValue(0)
    view.resize(220, 330)
    qtbot.wait(0)
    assert bar.value() == 0
