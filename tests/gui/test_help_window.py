"""The help window: the page that was asked for, its links, and that pages and program agree."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from mouse import on_screen
from PySide6.QtCore import QUrl
from PySide6.QtGui import QTextDocument

from texlab.docks import dock_classes
from texlab.window import help_window
from texlab.window.commands import COMMANDS
from texlab.window.help_window import ORDER, HelpWindow, help_pages
from texlab_core.files.resources import resource


@pytest.fixture
def window(qtbot):
    made = HelpWindow()
    qtbot.addWidget(made, before_close_func=HelpWindow.leave)
    return made


def text_of(page):
    return resource(f"help/{page}.md").read_text(encoding="utf-8")


def test_the_page_that_was_asked_for_is_shown_at_once_and_stays(window, qtbot):
    window.open_page("de-bonet")
    on_screen(qtbot, window)
    window.list.setFocus()
    qtbot.wait(60)
    assert window.browser.page == "de-bonet"
    assert window.list.currentItem().data(256) == "de-bonet"
    assert "multiresolution" in window.browser.toPlainText().lower()


def test_an_unknown_page_is_the_index(window):
    window.open_page("no-such-page")
    assert window.browser.page == "index"


@pytest.mark.parametrize("page", [name for name, _ in help_pages()])
def test_every_page_shows_with_all_its_figures(window, page, qtbot):
    window.open_page(page)
    assert window.browser.page == page
    assert len(window.browser.toPlainText()) > 200
    # Nothing is wider than the page; on a small screen the window is as wide as there is room.
    bar, screen = window.browser.horizontalScrollBar(), window.screen().availableSize().width()
    qtbot.waitUntil(lambda: bar.maximum() == 0 or window.width() >= screen)
    for part in text_of(page).split("](figures/")[1:]:
        url = QUrl(f"figures/{part.partition(')')[0]}")
        image = window.browser.loadResource(QTextDocument.ResourceType.ImageResource.value, url)
        assert image.width() > 100


def test_links_lead_to_pages_and_to_knobs(window, qtbot):
    window.open_page("index")
    qtbot.waitUntil(lambda: window.list.count() > 0)
    window.browser.anchorClicked.emit(QUrl("msg.md"))
    assert window.browser.page == "msg"
    assert window.list.currentItem().data(256) == "msg"
    with qtbot.waitSignal(window.knob_wanted) as wanted:
        window.browser.anchorClicked.emit(QUrl("knob:de-bonet/alpha"))
    assert wanted.args == ["de-bonet", "alpha"]


def test_links_to_lessons_open_them(window, qtbot):
    with qtbot.waitSignal(window.lesson_wanted) as wanted:
        window.browser.anchorClicked.emit(QUrl("lesson:heeger-bergen"))
    assert wanted.args == ["heeger-bergen"]


@pytest.mark.parametrize("packed", [False, True], ids=["in a folder", "in an archive"])
def test_links_to_reports_open_them_in_the_browser(window, qtbot, monkeypatch, tmp_path, packed):
    opened = []
    monkeypatch.setattr(help_window.QDesktopServices, "openUrl", lambda url: opened.append(url) or len(opened) > 1)
    own = resource("help/reports/de-bonet-800.html")
    if packed:
        archive = tmp_path / "program.zip"
        with zipfile.ZipFile(archive, "w") as file:
            file.write(own, "de-bonet-800.html")
        monkeypatch.setattr(help_window, "resource", lambda path: zipfile.Path(archive, path.rpartition("/")[2]))
        monkeypatch.setattr(help_window.tempfile, "mkdtemp", lambda prefix: str(tmp_path))
    window.browser.anchorClicked.emit(QUrl("report:de-bonet-800"))
    qtbot.waitUntil(lambda: len(opened) == 1)
    path = Path(opened[0].toLocalFile())
    assert path.read_bytes() == own.read_bytes()
    # The first time there was no browser.
    assert window.note.text() == f"No browser was found for {path}."
    window.browser.anchorClicked.emit(QUrl("report:de-bonet-800"))
    qtbot.waitUntil(lambda: len(opened) == 2)


def test_a_report_that_is_missing_is_said(window, qtbot, monkeypatch):
    opened = []
    monkeypatch.setattr(help_window.QDesktopServices, "openUrl", lambda url: opened.append(url) or True)
    window.browser.anchorClicked.emit(QUrl("report:../window"))
    assert not window.errands.busy
    window.browser.anchorClicked.emit(QUrl("report:no-such"))
    qtbot.waitUntil(lambda: "no-such" in window.note.text() and not window.errands.busy)
    assert not opened


def test_every_page_has_a_place_in_the_list():
    names = [name for name, _ in help_pages()]
    assert names == [name for name in ORDER if name in names]


def test_all_keys_of_the_window_are_listed():
    text = text_of("shortcuts")
    missing = [command.keys for command in COMMANDS if command.keys and command.keys not in text]
    assert not missing


def test_all_tabs_are_explained():
    text = text_of("window")
    missing = [dock.title for dock in dock_classes() if f"**{dock.title}.**" not in text]
    assert not missing


@pytest.mark.parametrize("larger", [1, 1.35])
def test_figures_and_code_are_not_cut_at_any_size_of_the_text(window, qtbot, larger):
    window.hide()
    font = window.font()
    font.setPointSizeF(larger * font.pointSizeF())
    window.setFont(font)
    window.open_page("de-bonet")
    qtbot.waitUntil(lambda: window.list.count() > 0)
    bar = window.browser.horizontalScrollBar()
    screen = window.screen().availableSize().width()
    qtbot.waitUntil(lambda: bar.maximum() == 0 or window.width() >= screen)
