"""Panes that show the same: what one of them costs when it gets another size, and which tabs are asked."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mouse import on_screen
from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow, QVBoxLayout, QWidget

from texlab.docks import host
from texlab.docks.host import is_seen
from texlab.widgets.image_pane import ImagePane
from texlab.widgets.plane_pane import PlaneLink, PlanePane
from texlab.widgets.view_link import ViewLink


def rects(pane: Any) -> tuple[float, ...]:
    shown = pane.view_rect()
    return shown.x(), shown.y(), shown.width(), shown.height()


@pytest.mark.parametrize("zoomed", [False, True])
@pytest.mark.parametrize("plane", [False, True])
def test_a_pane_of_another_size_moves_no_other(
    qtbot: Any, monkeypatch: pytest.MonkeyPatch, plane: bool, zoomed: bool
) -> None:
    link: Any = PlaneLink() if plane else ViewLink()
    room = QWidget()
    qtbot.addWidget(room)
    room.resize(900, 200)
    panes: list[Any] = [PlanePane(str(n), "plane", link) if plane else ImagePane(link) for n in range(4)]
    picture = np.zeros((40, 60, 3), np.uint8)
    for place, pane in enumerate(panes):
        pane.setParent(room)
        pane.setGeometry(220 * place, 0, 120, 90)
        if plane:
            pane.show_picture(picture, QRectF(0, 0, 60, 40))
        else:
            pane.set_picture(picture)
    room.show()
    on_screen(qtbot, room)
    if not plane:
        link.set_extent(40, 60)
    link.fit()
    if zoomed:
        panes[0].view.setRange(QRectF(10, 10, 20, 20), padding=0)
        link.moved(panes[0])
    shown: list[Any] = []
    kind = type(panes[0])
    show = kind.show_rect

    def noted(self: Any, where: QRectF) -> None:
        shown.append(self)
        show(self, where)

    monkeypatch.setattr(kind, "show_rect", noted)
    before = [rects(each) for each in panes[1:]]
    panes[0].resize(200, 140)
    qtbot.wait(0)
    assert {panes.index(each) for each in shown} <= {0}
    assert [rects(each) for each in panes[1:]] == before
    # It shows what the others show: where nobody zoomed, everything; else their centre.
    one, other = panes[0].view_rect(), panes[1].view_rect()
    assert one.center().x() == pytest.approx(other.center().x(), abs=1)
    assert one.center().y() == pytest.approx(other.center().y(), abs=1)
    for pane in panes:
        pane.detach()


def test_tabs_behind_the_front_one_are_not_searched(qtbot: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    window = QMainWindow()
    qtbot.addWidget(window)
    window.setCentralWidget(QWidget())
    frames, bodies = [], []
    for name in ("one", "two"):
        frame, body, inner = QDockWidget(name), QWidget(), QWidget()
        # All of the body lies under a part of its own.
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        inner.setAutoFillBackground(True)
        layout.addWidget(inner)
        inner.setMinimumSize(200, 80)
        frame.setWidget(body)
        window.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, frame)
        frames.append(frame)
        bodies.append(body)
    window.tabifyDockWidget(*frames)
    window.resize(500, 400)
    window.show()
    on_screen(qtbot, window)
    searched: list[QWidget] = []
    shows = host._shows
    monkeypatch.setattr(host, "_shows", lambda part: searched.append(part) or shows(part))
    for front in (1, 0):
        frames[front].raise_()
        qtbot.waitUntil(lambda front=front: is_seen(bodies[front]))
        searched.clear()
        assert bodies[1 - front].isVisible()
        assert not is_seen(bodies[1 - front])
        assert searched == []
