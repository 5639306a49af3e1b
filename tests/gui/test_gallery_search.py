"""The gallery's search knows the words of the stories."""

from __future__ import annotations

from typing import Any

import pytest

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
