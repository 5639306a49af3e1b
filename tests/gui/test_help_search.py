"""Full-text search of the help: what is found, in which order, and how it is shown, with real keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from PySide6.QtCore import Qt

from texlab.window.help_search import EXCERPT, search, sections_of
from texlab.window.help_window import HelpWindow, help_pages
from texlab_core.files.resources import resource

if TYPE_CHECKING:
    from collections.abc import Iterator

PAGE = """# Pyramids

Bands of a *steerable* [pyramid](x.md), `scales` of them.

## Two orientations

![a figure of bands](figures/a.png)

| one | two |
| --- | --- |
| 2\\*3 | snake_case |

```python
# not a heading
a_b = 1
```
"""
PAGES = {
    "a": sections_of("# First\n\nGrain and grain and grain of wood.\n\n## Bark\n\nNothing."),
    "b": sections_of("# Grain\n\nOf stone."),
    "c": sections_of("# Third\n\nEngrained stone."),
    "d": sections_of("# Fourth\n\n## Grain of sand\n\nA stone, and a histogram."),
}


# Pure.


def test_markup_is_no_text() -> None:
    first, second = sections_of(PAGE)
    assert (first.heading, first.text) == ("Pyramids", "Bands of a steerable pyramid, scales of them.")
    assert second.heading == "Two orientations"
    assert second.text == "a figure of bands one two 2*3 snake_case # not a heading a_b = 1"
    (commented,) = sections_of("<!-- numbers -->\n\nSeven.\n\n<!-- end of numbers -->")
    assert commented.text == "Seven."


@pytest.mark.parametrize(
    ("typed", "pages"),
    [
        ("grain", ["b", "d", "a"]),
        ("GRA", ["b", "d", "a"]),
        ("grain stone", ["b", "d"]),
        ("hist", ["d"]),
        ("ograms", []),
        ("grain nowhere", []),
        ("", []),
        ("  ", []),
        ("stone", ["b", "c", "d"]),
        (".", ["a", "b", "c", "d"]),
        ("(", []),
    ],
)
def test_every_word_is_found_at_its_start_and_titles_come_first(typed: str, pages: list[str]) -> None:
    found = [hit.page for hit in search(PAGES, typed)]
    assert sorted(found) == sorted(pages) if typed == "." else found == pages


def test_the_section_with_all_words_is_shown() -> None:
    page = sections_of("# A\n\nbands bands bands\n\n## B\n\n" + "x " * 200 + "bands of noise " + "y " * 200)
    (hit,) = search({"p": page}, "noise bands")
    assert hit.heading == "B"
    assert "bands of noise" in hit.excerpt
    assert hit.excerpt.startswith("… ")
    assert hit.excerpt.endswith(" …")
    assert len(hit.excerpt) <= EXCERPT + 4


def test_every_word_of_every_page_finds_the_page() -> None:
    pages = {
        name: sections_of(resource(f"help/{name}.md").read_text(encoding="utf-8")) for name, _ in help_pages()
    }
    assert len(pages) > 15
    for name, sections in pages.items():
        assert sections[0].heading == dict(help_pages())[name]
        for section in sections:
            assert "](" not in section.text, (name, section.heading)
            for word in set(section.text.split()[::97]):
                assert name in {hit.page for hit in search(pages, word)}, (name, word)


# The window.


@pytest.fixture
def window(qtbot: Any) -> Iterator[HelpWindow]:
    made = HelpWindow()
    qtbot.addWidget(made, before_close_func=HelpWindow.leave)
    made.open_page("index")
    qtbot.waitUntil(lambda: made.list.count() > 0)
    return made


def pages_of(window: HelpWindow) -> list[str]:
    return [window.list.item(row).data(Qt.ItemDataRole.UserRole) for row in range(window.list.count())]


def test_typed_words_list_the_pages_and_enter_opens_the_best(window: HelpWindow, qtbot: Any) -> None:
    everything = pages_of(window)
    qtbot.keyClick(window.browser, Qt.Key.Key_F, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(window.field.hasFocus)
    qtbot.keyClicks(window.field, "bonet threshold")
    assert pages_of(window)[0] == "de-bonet"
    assert 0 < window.list.count() < len(everything)
    assert window.note.text() == f"{window.list.count()} pages, best first"
    assert window.browser.page == "index"
    qtbot.keyClick(window.field, Qt.Key.Key_Return)
    assert window.browser.page == "de-bonet"
    marked = [each.selectedText().lower() for each in window.browser.marked]
    assert set(marked) == {"bonet", "threshold"}
    assert len(window.browser.extraSelections()) == len(marked)
    bar = window.browser.verticalScrollBar()
    before = bar.value()
    for _ in range(len(marked)):
        qtbot.keyClick(window.browser, Qt.Key.Key_F3)
    assert window.browser.textCursor().selectionStart() == window.browser.marked[-1].selectionStart()
    assert bar.value() != before
    qtbot.keyClick(window.browser, Qt.Key.Key_F3, Qt.KeyboardModifier.ShiftModifier)
    assert window.browser.textCursor().selectionStart() == window.browser.marked[-2].selectionStart()


def test_what_no_page_has_is_said_and_escape_lists_all_again(window: HelpWindow, qtbot: Any) -> None:
    everything = pages_of(window)
    window.field.setFocus()
    qtbot.keyClicks(window.field, "<b>zebrafish")
    assert window.list.count() == 0
    assert window.note.text() == "No page has “<b>zebrafish”."
    assert window.note.textFormat() == Qt.TextFormat.PlainText
    qtbot.keyClick(window.field, Qt.Key.Key_Escape)
    assert window.isVisible()
    assert pages_of(window) == everything
    assert not window.note.isVisible()
    assert not window.browser.extraSelections()
    qtbot.keyClick(window.field, Qt.Key.Key_Escape)
    assert not window.isVisible()


def test_the_arrow_keys_walk_the_pages_that_were_found(window: HelpWindow, qtbot: Any) -> None:
    window.field.setFocus()
    qtbot.keyClicks(window.field, "histogram")
    second = pages_of(window)[1]
    qtbot.keyClick(window.field, Qt.Key.Key_Down)
    qtbot.keyClick(window.list, Qt.Key.Key_Down)
    assert window.browser.page == second
    assert window.browser.marked


def test_a_method_without_a_written_page_is_found(qtbot: Any, stub: Any) -> None:
    made = HelpWindow()
    qtbot.addWidget(made, before_close_func=HelpWindow.leave)
    made.open_page("index")
    qtbot.waitUntil(lambda: "stub" in pages_of(made))
