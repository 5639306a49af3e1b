"""A tab is made in pieces, between which the window answers, and all of them while nobody does anything."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import pytest
from PySide6.QtCore import QEvent, QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDockWidget, QMainWindow, QMenu, QWidget

from texlab.docks import dock_classes
from texlab.docks.frame import FramedDock
from texlab.docks.host import DockHost
from texlab.runs.slots import Slots
from texlab.style.theme import DARK
from texlab.widgets.pane import Pane
from texlab.window import tabs_ahead
from texlab.window.tabs_ahead import TabsAtRest

if TYPE_CHECKING:
    from collections.abc import Iterator


MANY = 10**6


class InThree(FramedDock):
    """Tells when its pieces are made."""

    name: ClassVar[str] = "three"
    title: ClassVar[str] = "Three"
    help: ClassVar[str] = ""
    told: ClassVar[list[str]] = []

    def build(self) -> Iterator[None]:
        for place in range(3):
            self.told.append(f"piece {place}")
            yield

    def question(self, scene: Any) -> None:
        return None

    def show_answer(self, answer: Any) -> None:
        pass


class Frames(QMainWindow):
    """Two tabs, one of them of the kind that is wanted, and a number of pieces that are left to make."""

    def __init__(self) -> None:
        super().__init__()
        self.frames = [QDockWidget(str(place), self) for place in range(2)]
        for frame in self.frames:
            self.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, frame)
        self.tabifyDockWidget(*self.frames)
        self.left = MANY

    def make_more(self) -> bool:
        self.left -= 1
        return self.left > 0


@pytest.fixture
def frames(qtbot: Any) -> Frames:
    window = Frames()
    qtbot.addWidget(window)
    with qtbot.waitExposed(window):
        window.show()
    return window


def tree(part: QWidget) -> list[tuple[str, str, str]]:
    """Return class, name and accessible name of every part inside."""
    parts = [part, *part.findChildren(QWidget)]
    return sorted((type(each).__name__, each.objectName(), each.accessibleName()) for each in parts)


@pytest.mark.parametrize("kind", dock_classes(), ids=lambda kind: kind.name)
def test_a_dock_in_pieces_is_the_same_dock(qtbot: Any, kind: Any) -> None:
    whole, other = kind(), kind(whole=False)
    for dock in (whole, other):
        qtbot.addWidget(dock)
    count = 1
    for _ in other.pieces():
        # What comes to every widget at any time comes to one that is half made, too.
        for event in (QEvent.Type.FontChange, QEvent.Type.PaletteChange, QEvent.Type.StyleChange):
            QApplication.sendEvent(other, QEvent(event))
        count += 1
    assert tree(other) == tree(whole)
    assert other.settings() == whole.settings()
    other.set_theme(DARK)
    assert list(other.pieces()) == []
    # Plots and panes take milliseconds each: four of them are no single piece.
    assert count > 1 or len(other.findChildren(Pane)) < 4


def test_the_window_answers_between_the_pieces(qtbot: Any, frames: Frames) -> None:
    InThree.told.clear()
    host = DockHost(InThree, Slots(1), frames)
    behind = frames.frames[1]
    host.set_frame(frames.frames[0])
    behind.raise_()
    QApplication.processEvents()
    assert not host.is_made
    timer = QTimer(frames)
    timer.timeout.connect(lambda: InThree.told.append("turn"))
    timer.start(0)
    frames.frames[0].raise_()
    qtbot.waitUntil(lambda: host.is_made)
    timer.stop()
    pieces = [place for place, each in enumerate(InThree.told) if each.startswith("piece")]
    assert [InThree.told[place] for place in pieces] == ["piece 0", "piece 1", "piece 2"]
    assert all(InThree.told[place + 1] == "turn" for place in pieces)
    assert frames.frames[0].widget() is host.dock
    host.close()


def test_whoever_asks_for_a_dock_has_it_at_once(qtbot: Any, frames: Frames) -> None:
    host = DockHost(InThree, Slots(1), frames)
    host.set_frame(frames.frames[0])
    heard: list[Any] = []
    host.made.connect(lambda dock: heard.append((dock, host.dock, host.is_made)))
    assert host.make_more()
    assert host.make_more()
    host.take_settings({})
    dock = host.dock
    assert heard == [(dock, dock, True)]
    assert frames.frames[0].widget() is dock
    assert not host.make_more()
    host.close()


@pytest.mark.parametrize("kind", dock_classes(), ids=lambda kind: kind.name)
def test_nothing_is_left_of_a_dock_that_is_half_made(qtbot: Any, frames: Frames, kind: Any) -> None:
    """Whoever closes the window between two pieces leaves no part behind."""
    pieces, left = 0, True
    before = len(QApplication.allWidgets())
    while left:
        pieces += 1
        host = DockHost(kind, Slots(1), frames)
        left = all(host.make_more() for _ in range(pieces))
        if not left:
            # Nothing is half made any more: it is its frame's.
            host.dock.deleteLater()
        host.close()
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        assert len(QApplication.allWidgets()) == before, f"after {pieces} pieces"
    assert pieces > 2


def test_tabs_are_made_at_rest_alone(qtbot: Any, frames: Frames, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tabs_ahead, "REST_MS", 0)
    idle = [False]
    rest = TabsAtRest(frames, lambda: idle[0], frames)  # type: ignore[arg-type]
    looks = [0]
    rest._look.timeout.connect(lambda: looks.__setitem__(0, looks[0] + 1))
    rest._look.setInterval(1)
    rest._next.setInterval(0)
    rest.start()
    # Something is computed.
    qtbot.waitUntil(lambda: looks[0] > 3)
    assert frames.left == MANY
    # A menu is open.
    idle[0] = True
    menu = QMenu(frames)
    menu.addAction("One")
    menu.popup(frames.mapToGlobal(QPoint(5, 5)))
    seen = looks[0]
    qtbot.waitUntil(lambda: looks[0] > seen + 3)
    assert frames.left == MANY
    menu.close()
    # Hands take the turn between two pieces.
    qtbot.waitUntil(lambda: frames.left < MANY)
    monkeypatch.setattr(tabs_ahead, "REST_MS", 10**8)
    QTest.mouseMove(frames.windowHandle(), QPoint(7, 9))
    left, seen = frames.left, looks[0]
    qtbot.waitUntil(lambda: looks[0] > seen + 3)
    assert frames.left == left
    assert rest.active
    frames.left = 3
    # The rest is made when they rest again, and then nothing looks any more.
    monkeypatch.setattr(tabs_ahead, "REST_MS", 0)
    QTest.keyClick(frames.windowHandle(), Qt.Key.Key_Shift)
    qtbot.waitUntil(lambda: not rest.active)
    assert frames.left == 0
    assert not rest._next.isActive()
