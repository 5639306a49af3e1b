"""Opens a window, moves the real pointer in it and prints how long the answers take: see bench_thresholds.py."""

from __future__ import annotations

import ctypes
import sys
import time
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QEventLoop, QPoint, QTimer

if TYPE_CHECKING:
    from collections.abc import Callable

LEFT_BUTTON = 1
EVENTS = 120
FRAME_S = 1 / 60
ROUNDS = 3
WANTED_MS = 40


class Pointer:
    """The pointer of the X server, moved by XTest: Qt sees real events."""

    def __init__(self) -> None:
        self._x11 = ctypes.CDLL("libX11.so.6")
        self._test = ctypes.CDLL("libXtst.so.6")
        self._x11.XOpenDisplay.restype = ctypes.c_void_p
        self._display = ctypes.c_void_p(self._x11.XOpenDisplay(None))

    def move(self, place: QPoint) -> None:
        """Move to a place of the screen."""
        self._test.XTestFakeMotionEvent(self._display, -1, place.x(), place.y(), ctypes.c_ulong(0))
        self._x11.XFlush(self._display)

    def press(self, down: bool) -> None:
        """Press or release the left button."""
        self._test.XTestFakeButtonEvent(self._display, LEFT_BUTTON, int(down), ctypes.c_ulong(0))
        self._x11.XFlush(self._display)


def wait(condition: Callable[[], bool], limit_s: float = 60.0) -> None:
    """Process events until a condition holds, asked after every batch of events."""
    loop = QEventLoop()
    end = time.perf_counter() + limit_s
    # Something must wake the loop up now and then, or a missed condition would sleep for ever.
    pulse = QTimer()
    pulse.setInterval(5)
    pulse.start()
    while not condition():
        if time.perf_counter() > end:
            raise TimeoutError
        loop.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents)
    pulse.stop()


def pause(seconds: float) -> None:
    """Process events for a while."""
    end = time.perf_counter() + seconds
    wait(lambda: time.perf_counter() >= end)


def quantiles(seconds: list[float]) -> str:
    p50, p95, top = np.quantile(np.array(seconds) * 1000, (0.5, 0.95, 1.0))
    return f"median {p50:.1f} ms, p95 {p95:.1f}, most {top:.1f}  ({len(seconds)} events)"


class Watch:
    """Remembers when the pane of a column was painted, and with which parameters."""

    def __init__(self, explorer: Any, column_id: int) -> None:
        self._view = explorer.workspace.columns[column_id]
        self.painted: list[tuple[float, Any, bool]] = []
        pane = self._view.pane
        paint = type(pane).paintEvent

        def paint_event(event: Any) -> None:
            paint(pane, event)
            scene = self._view.scene
            # The result is that of the picture, also while a newer one is under way.
            if scene is not None and scene.result is not None and pane.picture is scene.picture:
                self.painted.append((time.perf_counter(), scene.result.job.params, scene.draft))

        pane.paintEvent = paint_event


def open_window(columns: int, *, solid: bool = False) -> Any:
    from texlab.app import start as app
    from texlab.storage.settings import Settings
    from texlab.style.theme import ThemeSource
    from texlab_core.engine.registry import methods

    settings, themes = Settings(), ThemeSource("dark")
    app.application()
    window = app.build(settings, themes)
    window.show()
    explorer = app.complete(window, settings, themes)
    explorer.saved = {"seed": 1, "size": [256, 256]}
    names = ["de-bonet", "heeger-bergen", "msg", "efros-leung"][:columns]
    names = ["solid"] if solid else names
    explorer.start(None, columns=[(name, methods()[name].params()) for name in names])
    if solid:
        wait(lambda: bool(explorer.session.state.columns))
        explorer.session.set_column_size(explorer.session.state.columns[0].id, (128, 128, 128))
    wait(lambda: explorer.idle)
    pause(0.5)
    return explorer


def drag(
    pointer: Pointer, explorer: Any, start: QPoint, places: list[QPoint], title: str
) -> tuple[list[float], list[float], int]:
    """Drag over places, first waiting for every answer, then 60 events a second.

    Returns
    -------
    waited, answered
        Seconds from each event to the pane that was repainted with its parameters, or with newer ones: one event
        at a time, and 60 a second.
    repaints
        How often the pane was repainted during the latter.
    """
    column_id = explorer.session.state.columns[0].id
    watch = Watch(explorer, column_id)
    params = lambda: explorer.session.state.column(column_id).params  # noqa: E731
    pointer.move(start)
    pause(0.2)
    pointer.press(True)
    pause(0.2)
    waited, drafts = [], 0
    for place in places:
        before = params()
        began = time.perf_counter()
        pointer.move(place)
        wait(lambda before=before: params() is not before, 5)
        wanted = params()
        wait(lambda wanted=wanted: bool(watch.painted) and watch.painted[-1][1] is wanted, 5)
        waited.append(watch.painted[-1][0] - began)
        drafts += watch.painted[-1][2]
        pause(0.01)
    print(f"{title}, one event at a time: {quantiles(waited)}, {drafts} drafts")

    sent: list[tuple[float, Any]] = []
    watch.painted.clear()
    for place in reversed(places[:-1]):
        began = time.perf_counter()
        before = params()
        pointer.move(place)
        wait(lambda before=before: params() is not before, 5)
        sent.append((began, params()))
        pause(max(0.0, began + FRAME_S - time.perf_counter()))
    wait(lambda: bool(watch.painted) and watch.painted[-1][1] is params(), 5)
    pointer.press(False)
    order = {id(each): place for place, (_, each) in enumerate(sent)}
    answered = [
        next(at for at, shown, _ in watch.painted if order.get(id(shown), -1) >= place) - began
        for place, (began, _) in enumerate(sent)
    ]
    print(f"{title}, 60 events a second: {quantiles(answered)}, {len(watch.painted)} repaints")
    return waited, answered, len(watch.painted)


def slider(pointer: Pointer, explorer: Any, title: str = "slider") -> tuple[list[float], list[float], int]:
    """Drag the slider of alpha left and right."""
    handle = explorer.window.parameters.form.knobs["alpha"].slider
    explorer.window.parameters.scroll_area.ensureWidgetVisible(handle)
    pause(0.2)
    start = _handle(handle)
    steps = np.tile(np.r_[1:9, 7:-9:-1, -7:1], 10)[:EVENTS]
    places = [handle.mapToGlobal(start + QPoint(int(step), 0)) for step in steps]
    return drag(pointer, explorer, handle.mapToGlobal(start), places, title)


def measures(pointer: Pointer, explorer: Any) -> None:
    """Drag the slider with and without the numbers about what is shown, in turn; prints both and their ratios."""
    from texlab.runs.column_run import Measured, MeasureRun

    def nothing(run: MeasureRun, task: Any) -> Measured:
        return Measured({}, run.image.shape[:2])

    measure = MeasureRun.__call__
    found: dict[str, list[tuple[list[float], list[float], int]]] = {"with": [], "without": []}
    for _ in range(ROUNDS):
        for how, run in (("with", measure), ("without", nothing)):
            MeasureRun.__call__ = run  # type: ignore[method-assign]
            found[how].append(slider(pointer, explorer, f"slider, {how} measures"))
            wait(lambda: explorer.idle)
            column = explorer.controller.column_scene(explorer.session.state.columns[0].id)
            assert bool(column.measures) == (how == "with"), "the numbers are not those that were asked for"
    MeasureRun.__call__ = measure  # type: ignore[method-assign]
    for place, title in enumerate(("one event at a time", "60 events a second")):
        p50, p95 = (
            {how: 1000 * np.quantile(np.concatenate([each[place] for each in rounds]), share)
             for how, rounds in found.items()}
            for share in (0.5, 0.95)
        )  # fmt: skip
        print(
            f"{title}: with measures median {p50['with']:.1f} ms, p95 {p95['with']:.1f} (wanted: {WANTED_MS}), "
            f"without {p50['without']:.1f}, {p95['without']:.1f}; ratios {p50['with'] / p50['without']:.2f}, "
            f"{p95['with'] / p95['without']:.2f}"
        )
    repaints = {how: sum(each[2] for each in rounds) for how, rounds in found.items()}
    print(f"repaints: {repaints['with']} with, {repaints['without']} without measures")


def cell(pointer: Pointer, explorer: Any) -> None:
    """Drag a cell of the threshold table up and down."""
    explorer.window.raise_dock("thresholds")
    wait(lambda: explorer.idle)
    pause(0.5)
    editor = explorer.hosts["thresholds"].dock.editor
    start = editor.cell_rect(1, 3).center().toPoint()
    steps = np.tile(np.r_[1:16, 14:-16:-1, -14:1] * 2, 4)[:EVENTS]
    places = [editor.mapToGlobal(start + QPoint(0, int(step))) for step in steps]
    drag(pointer, explorer, editor.mapToGlobal(start), places, "cell of the table")


def explain(pointer: Pointer, explorer: Any) -> None:
    """Point at pixels, one after the other, and at the end of quick moves."""
    explorer.window.raise_dock("explain")
    dock = explorer.hosts["explain"].dock
    pane = explorer.workspace.columns[explorer.session.state.columns[0].id].pane
    painted: list[tuple[float, tuple[int, int]]] = []

    def place(row: int, column: int) -> QPoint:
        return pane.viewport().mapToGlobal(pane.to_widget(row + 0.5, column + 0.5).toPoint())

    def ask(row: int, column: int) -> tuple[float, float]:
        pointer.move(place(row, column))
        began = time.perf_counter()
        probe = explorer.controller.scene().probe
        wait(lambda: explorer.controller.scene().probe != probe, 5)
        pixel = explorer.controller.scene().probe
        wait(lambda: bool(painted) and painted[-1][1] == (pixel.row, pixel.column), 5)
        return began, painted[-1][0]

    pointer.move(place(4, 4))
    pause(0.5)
    pointer.move(place(9, 9))
    wait(lambda: dock.answer is not None)
    view = next(iter(dock._views.values()))
    paint = type(view.structure).paintEvent

    def paint_event(event: Any) -> None:
        paint(view.structure, event)
        painted.append((time.perf_counter(), dock.answer[1].explanation.pixel))

    view.structure.paintEvent = paint_event
    pause(0.3)
    random = np.random.default_rng(1)
    times = []
    for row, column in random.integers(20, 230, (EVENTS, 2)):
        began, done = ask(int(row), int(column))
        times.append(done - began)
        pause(0.02)
    print(f"explain, one pixel at a time: {quantiles(times)}")
    times = []
    for row, column in random.integers(20, 200, (30, 2)):
        for step in range(20):
            pointer.move(place(int(row) + step, int(column)))
            pause(0.004)
        began, done = ask(int(row) + 24, int(column) + 3)
        times.append(done - began)
    print(f"explain, after quick moves: {quantiles(times)}")


def turn(pointer: Pointer, explorer: Any) -> None:
    """Turn the object carved from a solid of 128 x 128 x 128 voxels, drawn at 400 x 400, in a floating tab."""
    explorer.window.raise_dock("solids")
    frame = explorer.window.docks["solids"]
    dock = explorer.hosts["solids"].dock
    frame.setFloating(True)
    frame.setGeometry(20, 20, 1400, 960)
    for beside in (False, True):
        dock.beside.setChecked(beside)
        wait(lambda: explorer.idle)
        pause(0.5)
        _turn_one(pointer, dock.object, "with the wrapped one beside" if beside else "alone")


def _turn_one(pointer: Pointer, pane: Any, what: str) -> None:
    paint, painted, drawn = type(pane).paintEvent, [], []

    def paint_event(event: Any) -> None:
        paint(pane, event)
        if pane.picture is not None and (not drawn or drawn[-1] is not pane.picture):
            drawn.append(pane.picture)
            painted.append(time.perf_counter())

    pane.paintEvent = paint_event
    middle = pane.mapToGlobal(pane.rect().center())
    # To and fro, never the same place twice in a row.
    places = [middle + QPoint(step % 40 - 20, (3 * step) % 31 - 15) for step in range(2 * EVENTS)]
    pointer.move(middle)
    pause(0.2)
    pointer.press(True)
    pause(0.2)
    waited, spent = [], time.process_time()
    for place in places[:EVENTS]:
        count, began = len(painted), time.perf_counter()
        pointer.move(place)
        wait(lambda count=count: len(painted) > count, 5)
        waited.append(painted[-1] - began)
    spent = (time.process_time() - spent) / EVENTS
    side, sent, count = pane.picture.shape[0], time.perf_counter(), len(painted)
    for place in places:
        began = time.perf_counter()
        pointer.move(place)
        pause(max(0.0, began + FRAME_S / 2 - time.perf_counter()))
    rate = (len(painted) - count) / (time.perf_counter() - sent)
    pointer.press(False)
    pause(0.3)
    print(f"object {what}, {side} x {side}, one event at a time: {quantiles(waited)};", end=" ")
    print(f"{1000 * spent:.1f} ms of CPU each")
    print(f"object {what}, 120 events a second: {rate:.0f} frames a second")


def _handle(slider: Any) -> QPoint:
    from PySide6.QtWidgets import QStyle, QStyleOptionSlider

    option = QStyleOptionSlider()
    slider.initStyleOption(option)
    control, part = QStyle.ComplexControl.CC_Slider, QStyle.SubControl.SC_SliderHandle
    return slider.style().subControlRect(control, option, part, slider).center()


def main(what: str, columns: int) -> None:
    explorer = open_window(columns, solid=what == "turn")
    pointer = Pointer()
    try:
        tried = {"slider": slider, "cell": cell, "explain": explain, "turn": turn, "measures": measures}
        tried[what](pointer, explorer)
    finally:
        explorer.window.close()
        explorer.window.deleteLater()


if __name__ == "__main__":
    sys.argv[1:] = sys.argv[1:] or ["slider", "1"]
    main(sys.argv[1], int(sys.argv[2]))
