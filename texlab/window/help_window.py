"""The help window: Markdown pages of resources/help, with figures and links to the knobs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, QSize, QUrl, Signal
from PySide6.QtGui import QImage, QTextCursor, QTextDocument, QTextFormat
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)

from texlab.window.generated_help import method_page
from texlab_core.engine.registry import methods
from texlab_core.files.resources import resource

if TYPE_CHECKING:
    from PySide6.QtGui import QShowEvent

FIGURE_WIDTH = 720
LETTERS = 140
SMALLEST = QSize(1000, 720)
MARGIN = 16
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
    page_shown = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("help-page")
        self.setOpenLinks(False)
        self.document().setDocumentMargin(MARGIN)
        self.anchorClicked.connect(self._follow)
        self.page = ""

    def show_page(self, name: str) -> bool:
        """Show ``resources/help/NAME.md``, or what a method of this name declares; False when there is neither."""
        try:
            text = resource(f"help/{name}.md").read_text(encoding="utf-8")
        except (OSError, ValueError):
            if name not in methods():
                return False
            text = method_page(methods()[name])
        self.page = name
        self.setMarkdown(text)
        self._arrange()
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
                from PySide6.QtCore import Qt

                image = image.scaledToWidth(FIGURE_WIDTH, Qt.TransformationMode.SmoothTransformation)
            return image
        return super().loadResource(kind, url)

    def _follow(self, url: QUrl) -> None:
        text = url.toString()
        if text.startswith("knob:"):
            method, _, knob = text[5:].partition("/")
            self.knob_wanted.emit(method, knob)
        elif text.startswith("lesson:"):
            self.lesson_wanted.emit(text[7:])
        elif text.endswith(".md") and "/" not in text:
            self.show_page(text[:-3])
        elif text.startswith("#"):
            self.scrollToAnchor(text[1:])


class HelpWindow(QDialog):
    """The pages on the left, the page on the right."""

    knob_wanted = Signal(str, str)
    lesson_wanted = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("help-window")
        self.setWindowTitle("TexLab help")
        self.list = QListWidget()
        self.list.setObjectName("help-list")
        self.browser = HelpBrowser()
        layout = QHBoxLayout()
        layout.addWidget(self.list)
        layout.addWidget(self.browser, 1)
        outer = QVBoxLayout(self)
        outer.addLayout(layout)
        self.list.currentItemChanged.connect(lambda item, _: item and self.browser.show_page(item.data(256)))
        self.browser.knob_wanted.connect(self.knob_wanted)
        self.browser.lesson_wanted.connect(self.lesson_wanted)
        self.browser.page_shown.connect(self._mark)

    def showEvent(self, event: QShowEvent) -> None:
        """List the pages when the window is first seen."""
        super().showEvent(event)
        if self.list.count() == 0:
            for name, title in help_pages():
                item = QListWidgetItem(title)
                item.setData(256, name)
                self.list.addItem(item)

    def open_page(self, name: str) -> None:
        """Show the window with a page; the first page when there is none of that name."""
        if not self.isVisible():
            self._make_room()
        self.show()
        self.raise_()
        if not self.browser.show_page(name):
            self.browser.show_page("index")

    def _make_room(self) -> None:
        """Be wide enough for the figures, and for the longest line of code at any size of the text."""
        letter = self.fontMetrics().averageCharWidth()
        screen = self.screen().availableSize()
        self.list.setFixedWidth(28 * letter)
        text = QSize(LETTERS * letter, 3 * LETTERS * letter // 4)
        wanted = self.size().expandedTo(SMALLEST).expandedTo(text)
        self.resize(wanted.boundedTo(screen))

    def _mark(self, name: str) -> None:
        """Choose the page in the list, so that the list does not choose another one when it gets the focus."""
        for row in range(self.list.count()):
            if self.list.item(row).data(256) == name:
                with QSignalBlocker(self.list):
                    self.list.setCurrentRow(row)


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
