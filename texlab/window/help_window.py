"""The help window: Markdown pages of resources/help, with figures and links to the knobs."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, QSize, Qt, QUrl, Signal
from PySide6.QtGui import (
    QDesktopServices,
    QImage,
    QKeySequence,
    QPalette,
    QShortcut,
    QTextCursor,
    QTextDocument,
    QTextFormat,
)
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QTextBrowser,
    QTextEdit,
    QVBoxLayout,
    QWidget,
)

from texlab.runs.errands import Errands
from texlab.widgets.plain import Label, set_tip
from texlab.window.generated_help import method_page
from texlab.window.help_search import Section, search, sections_of
from texlab_core.engine.registry import methods
from texlab_core.errors import InputError
from texlab_core.files.resources import resource
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    from PySide6.QtGui import QKeyEvent, QShowEvent

    from texlab.runs.worker import Task

FIGURE_WIDTH = 720
LETTERS = 140
SMALLEST = QSize(1000, 720)
MARGIN = 16
NAME, HEADING = Qt.ItemDataRole.UserRole, Qt.ItemDataRole.UserRole + 1
ORDER = (
    *("index", "window", "lessons", "shortcuts"),
    *("heeger-bergen", "de-bonet", "efros-leung", "msg", "mixture", "solid"),
    *("uncoded", "car", "ac-h", "tiling", "pixels", "bands"),
    *("measures", "findings", "popout", "laboratory", "shape-from-texture"),
    *("images", "export", "batches", "command-line"),
)


class HelpBrowser(QTextBrowser):
    """Shows pages and figures from the resources, wherever they are packed."""

    knob_wanted = Signal(str, str)
    lesson_wanted = Signal(str)
    report_wanted = Signal(str)
    page_shown = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("help-page")
        self.setOpenLinks(False)
        self.document().setDocumentMargin(MARGIN)
        self.anchorClicked.connect(self._follow)
        self.page = ""
        self.marked: list[QTextCursor] = []

    def show_page(self, name: str) -> bool:
        """Show ``resources/help/NAME.md``, or what a method of this name declares; False when there is neither."""
        text = page_text(name)
        if text is None:
            return False
        self.page = name
        self.setMarkdown(text)
        self._arrange()
        self.mark([])
        self.page_shown.emit(name)
        return True

    def _arrange(self) -> None:
        """Give headings room, and code an indent."""
        block = self.document().begin()
        while block.isValid():
            shape = block.blockFormat()
            if shape.headingLevel() > 0 and block.blockNumber() > 0:
                shape.setTopMargin(MARGIN)
                shape.setBottomMargin(MARGIN / 4)
            elif shape.hasProperty(QTextFormat.Property.BlockCodeFence.value):
                shape.setLeftMargin(MARGIN)
            QTextCursor(block).setBlockFormat(shape)
            block = block.next()

    def loadResource(self, kind: int, url: QUrl | str) -> object:
        """Load a figure from the resources."""
        path = url.toString() if isinstance(url, QUrl) else url
        if kind == QTextDocument.ResourceType.ImageResource.value and ".." not in path:
            try:
                image = QImage.fromData(resource(f"help/{path}").read_bytes())
            except (OSError, ValueError):
                return super().loadResource(kind, url)
            if image.width() > FIGURE_WIDTH:
                image = image.scaledToWidth(FIGURE_WIDTH, Qt.TransformationMode.SmoothTransformation)
            return image
        return super().loadResource(kind, url)

    def go_to_heading(self, heading: str) -> None:
        """Scroll to a heading of the page; to its beginning when there is none of these words."""
        block = self.document().begin()
        while block.isValid():
            if block.blockFormat().headingLevel() > 0 and block.text() == heading:
                top = self.document().documentLayout().blockBoundingRect(block).top()
                self.verticalScrollBar().setValue(int(top) - MARGIN)
                return
            block = block.next()

    def mark(self, words: list[str]) -> int:
        """Mark every place where one of these words begins a word; return how many there are."""
        found: list[QTextCursor] = []
        for word in words:
            at = self.document().find(word)
            while not at.isNull():
                before = self.document().characterAt(at.selectionStart() - 1)
                if not (word[0].isalnum() and before.isalnum()):
                    found.append(QTextCursor(at))
                at = self.document().find(word, at)
        found.sort(key=QTextCursor.selectionStart)
        self.marked = found
        self.setExtraSelections([self._selection(each) for each in found])
        return len(found)

    def _selection(self, cursor: QTextCursor) -> QTextEdit.ExtraSelection:
        made = QTextEdit.ExtraSelection()
        made.cursor = cursor
        made.format.setBackground(self.palette().brush(QPalette.ColorRole.Highlight))
        made.format.setForeground(self.palette().brush(QPalette.ColorRole.HighlightedText))
        return made

    def go_to_mark(self, step: int) -> None:
        """Go to the next place that is marked (1) or the one before (-1), round about."""
        if not self.marked:
            return
        at = self.textCursor().selectionStart() if self.textCursor().hasSelection() else -1
        places = [each.selectionStart() for each in self.marked]
        if step > 0:
            index = next((index for index, place in enumerate(places) if place > at), 0)
        else:
            index = next((index for index in reversed(range(len(places))) if places[index] < at), -1)
        self.setTextCursor(self.marked[index])
        self.ensureCursorVisible()

    def _follow(self, url: QUrl) -> None:
        text = url.toString()
        if text.startswith("knob:"):
            method, _, knob = text[5:].partition("/")
            self.knob_wanted.emit(method, knob)
        elif text.startswith("lesson:"):
            self.lesson_wanted.emit(text[7:])
        elif re.fullmatch(r"report:[\w-]+", text):
            self.report_wanted.emit(text[7:])
        elif text.endswith(".md") and "/" not in text:
            self.show_page(text[:-3])
        elif text.startswith("#"):
            self.scrollToAnchor(text[1:])


class HelpWindow(QDialog):
    """The pages on the left, under a field that searches all of them; the page on the right."""

    knob_wanted = Signal(str, str)
    lesson_wanted = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("help-window")
        self.setWindowTitle("TexLab help")
        self.field = QLineEdit()
        self.field.setObjectName("help-search")
        self.field.setAccessibleName("Search all pages")
        self.field.setPlaceholderText("Search all pages")
        self.field.setClearButtonEnabled(True)
        tip = "Words that a page must have, or their first letters. Enter opens the best page; F3 goes on"
        set_tip(self.field, tip)
        self.note = Label(name="help-found", muted=True, wraps=True)
        self.note.hide()
        self.list = QListWidget()
        self.list.setObjectName("help-list")
        self.list.setAccessibleName("Pages")
        self.list.setWordWrap(True)
        self.browser = HelpBrowser()
        self.browser.setAccessibleName("Page")
        self.errands = Errands(self)
        self.errands.failed.connect(self._say)
        self._titles: list[tuple[str, str]] = []
        self._sections: dict[str, tuple[Section, ...]] = {}
        left = QVBoxLayout()
        for widget in (self.field, self.note, self.list):
            left.addWidget(widget)
        layout = QHBoxLayout()
        layout.addLayout(left)
        layout.addWidget(self.browser, 1)
        outer = QVBoxLayout(self)
        outer.addLayout(layout)
        self.field.textChanged.connect(self._search)
        self.list.currentItemChanged.connect(self._open)
        self.browser.knob_wanted.connect(self.knob_wanted)
        self.browser.lesson_wanted.connect(self.lesson_wanted)
        self.browser.report_wanted.connect(self._open_report)
        self.browser.page_shown.connect(self._mark)
        for keys, do in (
            (QKeySequence(QKeySequence.StandardKey.Find), self._to_field),
            (QKeySequence("F3"), lambda: self.browser.go_to_mark(1)),
            (QKeySequence("Shift+F3"), lambda: self.browser.go_to_mark(-1)),
        ):
            QShortcut(keys, self).activated.connect(do)

    def showEvent(self, event: QShowEvent) -> None:
        """Read the pages when the window is first seen."""
        super().showEvent(event)
        if not self._titles and not self.errands.busy:
            self.errands.run("help", _read_pages, self._take_pages)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """In the field, Enter opens the best page, Down goes to the list, Escape empties it."""
        if self.field.hasFocus() and event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            if self.field.text().strip() and self.list.count():
                self.list.setCurrentRow(0)
                self.browser.setFocus()
        elif self.field.hasFocus() and event.key() == Qt.Key.Key_Down:
            self.list.setFocus()
            self.list.setCurrentRow(0)
        elif event.key() == Qt.Key.Key_Escape and self.field.text():
            self.field.clear()
            self.field.setFocus()
        else:
            super().keyPressEvent(event)

    def open_page(self, name: str) -> None:
        """Show the window with a page; the first page when there is none of that name."""
        if not self.isVisible():
            self._make_room()
        self.show()
        self.raise_()
        if not self.browser.show_page(name):
            self.browser.show_page("index")

    def leave(self) -> None:
        """Stop reading."""
        self.errands.close()

    def _make_room(self) -> None:
        """Be wide enough for the figures, and for the longest line of code at any size of the text."""
        letter = self.fontMetrics().averageCharWidth()
        screen = self.screen().availableSize()
        for widget in (self.field, self.note, self.list):
            widget.setFixedWidth(28 * letter)
        text = QSize(LETTERS * letter, 3 * LETTERS * letter // 4)
        wanted = self.size().expandedTo(SMALLEST).expandedTo(text)
        self.resize(wanted.boundedTo(screen))

    def _take_pages(self, pages: dict[str, tuple[Section, ...]]) -> None:
        self._sections = pages
        self._titles = [(name, sections[0].heading) for name, sections in pages.items()]
        self._search(self.field.text())

    def _search(self, typed: str) -> None:
        """List the pages that have what was typed, with the place that fits best; all pages when nothing is."""
        words = typed.split()
        with QSignalBlocker(self.list):
            self.list.clear()
            if words:
                for hit in search(self._sections, typed):
                    place = "" if hit.heading == hit.title else f"{hit.heading}: "
                    self._add(hit.page, f"{hit.title}\n{place}{hit.excerpt}", hit.heading)
            else:
                for name, title in self._titles:
                    self._add(name, title, "")
        found = self.list.count()
        missing = f"No page has “{typed.strip()}”." if self._sections else "Reading the pages…"
        self.note.setText(missing if not found else f"{found} page{'s' if found > 1 else ''}, best first")
        self.note.setVisible(bool(words))
        self.browser.mark(words)
        self._mark(self.browser.page)

    def _add(self, name: str, text: str, heading: str) -> None:
        item = QListWidgetItem(text)
        item.setData(NAME, name)
        item.setData(HEADING, heading)
        self.list.addItem(item)

    def _open(self, item: QListWidgetItem | None) -> None:
        if item is None:
            return
        self.browser.show_page(item.data(NAME))
        self.browser.mark(self.field.text().split())
        if item.data(HEADING):
            self.browser.go_to_heading(item.data(HEADING))

    def _open_report(self, name: str) -> None:
        """Open the report of a batch in the system's browser: it sorts and filters by a script."""
        self.errands.run("report", lambda task: _report_file(name), self._show_report)

    def _show_report(self, path: Path) -> None:
        if not QDesktopServices.openUrl(QUrl.fromLocalFile(str(path))):
            self._say(f"No browser was found for {path}.")

    def _say(self, sentence: str) -> None:
        self.note.setText(sentence)
        self.note.show()

    def _to_field(self) -> None:
        self.field.setFocus(Qt.FocusReason.ShortcutFocusReason)
        self.field.selectAll()

    def _mark(self, name: str) -> None:
        """Choose the page in the list, so that the list does not choose another one when it gets the focus."""
        for row in range(self.list.count()):
            if self.list.item(row).data(NAME) == name:
                with QSignalBlocker(self.list):
                    self.list.setCurrentRow(row)


def page_text(name: str) -> str | None:
    """Return the Markdown of ``help/NAME.md``, or what a method of this name declares; None if neither."""
    try:
        return resource(f"help/{name}.md").read_text(encoding="utf-8")
    except (OSError, ValueError):
        return method_page(methods()[name]) if name in methods() else None


def _report_file(name: str) -> Path:
    """Return the file of a report; a copy where the program's own lies inside an archive."""
    found = resource(f"help/reports/{name}.html")
    if not found.is_file():
        raise InputError(f"The help has no report called {name}.")
    if isinstance(found, Path):
        return found
    copy = Path(tempfile.mkdtemp(prefix="texlab-")) / f"{name}.html"
    write_whole(copy, resource(f"help/reports/{name}.html").read_bytes())
    return copy


def _read_pages(task: Task) -> dict[str, tuple[Section, ...]]:
    """Return the sections of every page, those of methods without a written page last."""
    names = [name for name, _ in help_pages()]
    names += [name for name in methods() if name not in names]
    found = {}
    for name in names:
        text = page_text(name)
        if text is not None and not task.should_stop():
            found[name] = sections_of(text)
    return found


def help_pages() -> list[tuple[str, str]]:
    """Return (name, title) of every page, in the order in which somebody new would read them."""
    found = []
    folder = resource("help")
    for entry in folder.iterdir() if folder.is_dir() else ():
        if entry.name.endswith(".md"):
            first = entry.read_text(encoding="utf-8").splitlines()[:1]
            title = first[0].lstrip("# ").strip() if first else entry.name
            found.append((entry.name[:-3], title))
    # From the window over the methods to the command line; a page that is not named here comes last.
    places = {name: place for place, name in enumerate(ORDER)}
    return sorted(found, key=lambda page: (places.get(page[0], len(places)), page[1].lower()))
