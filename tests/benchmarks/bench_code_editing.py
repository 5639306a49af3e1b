"""How fast the texture follows when an energy of an MSG code is dragged. Prints figures, judges nothing."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, QTimer
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication

from tests.benchmarks.bench_window import window
from tests.benchmarks.clock import fourier_pair
from texlab_core.warming import every_need

if TYPE_CHECKING:
    from texlab.docks.spectral.code import CodeDock

pytestmark = pytest.mark.benchmark

SECONDS = 3.0


@pytest.mark.parametrize(
    ("texture", "size"), [("manmade-ribs", 256), ("structured-pebbles", 256), ("manmade-ribs", 512)]
)
def test_dragging_an_energy(qtbot: Any, tmp_path: Any, texture: str, size: int) -> None:
    with window(qtbot, tmp_path, [("msg", {})], size, f"gallery:{texture}") as explorer:
        warm = explorer.controller.warmth.is_warm
        qtbot.waitUntil(lambda: explorer.idle and all(map(warm, every_need())), timeout=60_000)
        panel = explorer.window.docks["code"]
        panel.raise_()
        dock: CodeDock = explorer.hosts["code"].dock
        qtbot.waitUntil(lambda: dock.answer is not None and explorer.idle, timeout=60_000)
        (column,) = explorer.session.state.columns
        explorer.controller.run_column(column.id)
        qtbot.waitUntil(lambda: explorer.idle, timeout=60_000)
        painted: list[float] = []
        pane = explorer.workspace.columns[column.id].pane
        shown = [pane.picture]

        def look() -> None:
            if pane.picture is not shown[0]:
                shown[0] = pane.picture
                painted.append(time.perf_counter())

        pane.painted.connect(look)
        grid = dock.grids["energy"]
        start = grid.cell_rect(1, 1).center()
        sent = [0]

        def move() -> None:
            sent[0] += 1
            offset = QPointF(0, 40 * np.sin(sent[0] / 15))
            send(grid, QEvent.Type.MouseMove, start + offset)

        timer = QTimer()
        timer.setInterval(8)
        timer.timeout.connect(move)
        qtbot.mousePress(grid, Qt.MouseButton.LeftButton, pos=start.toPoint())
        began, spent = time.perf_counter(), time.process_time()
        timer.start()
        qtbot.waitUntil(lambda: time.perf_counter() - began > SECONDS, timeout=60_000)
        timer.stop()
        spent = time.process_time() - spent
        within = [at for at in painted if at - began <= SECONDS]
        released = time.perf_counter()
        qtbot.mouseRelease(grid, Qt.MouseButton.LeftButton, pos=start.toPoint() + QPoint(0, 3))
        qtbot.waitUntil(lambda: explorer.idle, timeout=60_000)
        last = time.perf_counter() - released
    gaps = 1000 * np.diff(within)
    print(
        f"\n{texture} at {size}: {len(within) / SECONDS:.0f} repaints/s of {sent[0] / SECONDS:.0f} events/s, "
        f"gaps median {np.median(gaps):.0f} ms, most {gaps.max():.0f}; "
        f"final picture {1000 * last:.0f} ms after release; "
        f"{spent / len(within) / fourier_pair():.0f} Fourier pairs at 256 of CPU time a repaint"
    )


def send(widget: Any, kind: QEvent.Type, place: QPointF) -> None:
    """Send a move with the left button down."""
    left, plain = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    where = QPointF(widget.mapToGlobal(place.toPoint()))
    QApplication.sendEvent(widget, QMouseEvent(kind, place, where, Qt.MouseButton.NoButton, left, plain))
