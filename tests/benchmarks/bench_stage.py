"""What the window pays for a step of panning and zooming five linked pictures, and for a flicker of A and B.

CPU time of that thread for handling the event and repainting everything that it changes; a busy machine does not
make it longer. At 20 ms there are 50 repaints a second; a frame of the screen takes 16.7 ms.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.benchmarks.bench_window import window

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.benchmark

COLUMNS = 5
STEPS = 60
WANTED_MS = {"pan": 20.0, "zoom": 20.0, "flicker": 16.7}


def spent(step: Callable[[int], None], times: int) -> str:
    """Return what a step and the repaints after it cost the calling thread."""
    from PySide6.QtWidgets import QApplication

    values = []
    for number in range(times):
        began = time.thread_time()
        step(number)
        QApplication.sendPostedEvents()
        QApplication.processEvents()
        values.append(1000 * (time.thread_time() - began))
    p50, p95, most = np.quantile(values, (0.5, 0.95, 1.0))
    return f"median {p50:.1f} ms, p95 {p95:.1f}, most {most:.1f}"


@pytest.mark.parametrize("size", [256, 1024])
@pytest.mark.parametrize("room", [(1280, 800), (1920, 1080), (3840, 2160)])
def test_five_linked_pictures(qtbot: Any, tmp_path: Any, size: int, room: tuple[int, int]) -> None:
    from PySide6.QtCore import QPoint, QPointF, Qt
    from PySide6.QtGui import QWheelEvent
    from PySide6.QtTest import QTest
    from PySide6.QtWidgets import QApplication

    from tests.gui.mouse import move

    columns = [("pixels", {})] * COLUMNS
    with window(qtbot, tmp_path, columns, size, "gallery:stochastic-bark") as explorer:
        explorer.window.resize(*room)
        qtbot.waitUntil(lambda: explorer.idle, timeout=120_000)
        explorer.workspace.set_linked(True)
        panes = [view.pane for view in explorer.workspace.columns.values()]
        pane = panes[0]
        middle = pane.viewport().rect().center()

        def wheel(number: int) -> None:
            turn = QPoint(0, 120 if number % 20 < 10 else -120)
            here = QPointF(middle)
            event = QWheelEvent(
                here,
                QPointF(pane.viewport().mapToGlobal(middle)),
                QPoint(),
                turn,
                Qt.MouseButton.NoButton,
                Qt.KeyboardModifier.NoModifier,
                Qt.ScrollPhase.NoScrollPhase,
                False,
            )
            QApplication.sendEvent(pane.viewport(), event)

        print(f"\n{COLUMNS} pictures of {size} x {size} in {room[0]} x {room[1]}")
        before = pane.view_rect()
        print(f"  zoom     {spent(wheel, STEPS)}; wanted below {WANTED_MS['zoom']}")
        # The panes did move, all of them alike.
        for _ in range(3):
            wheel(0)
        assert all(abs(each.shown_scale - pane.shown_scale) < 1e-9 for each in panes)
        assert pane.view_rect() != before
        QTest.mousePress(pane.viewport(), Qt.MouseButton.LeftButton, pos=middle)
        centre = panes[-1].view_rect().center()
        print(
            f"  pan      {spent(lambda n: move(qtbot, pane.viewport(), middle + QPoint(n + 1, n // 2)), STEPS)}; "
            f"wanted below {WANTED_MS['pan']}"
        )
        assert panes[-1].view_rect().center() != centre
        QTest.mouseRelease(pane.viewport(), Qt.MouseButton.LeftButton, pos=middle)
        comparison, flicker = explorer.tuning.comparison, explorer.window.actions_by_name["flicker"]
        print(f"  flicker  {spent(lambda _: flicker.trigger(), STEPS)}; wanted below {WANTED_MS['flicker']}")
        flicker.trigger()
        # A picture that is there already takes the place of the other: nothing is computed.
        assert np.shares_memory(comparison.layer, explorer.workspace.columns[explorer.tuning.b].pane.picture)
        assert not comparison._worker._started
