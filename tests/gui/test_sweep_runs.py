"""Sweeps at work: cells as the core makes them, started, stopped and replaced."""

from __future__ import annotations

import os
import threading

import numpy as np
import pytest
from PySide6.QtCore import Qt
from sweep_bench import LEFT, PATIENCE_MS, choose, complete, enter, make_bench, set_range, start  # noqa: F401

from tests.stub_method import Gate, StubParams, exemplar, running, stub  # noqa: F401
from texlab.state.chosen import Column
from texlab_core.engine.run import run

pytestmark = pytest.mark.usefixtures("stub")


def test_every_cell_is_what_the_core_makes(qtbot, bench):
    here = bench()
    dock = here.dock
    set_range(qtbot, dock.panel.across, "level", "0", "2", "3")
    choose(qtbot, dock.panel.down.knob, "border")
    choose(qtbot, dock.panel.side_box, "64 x 64")
    complete(qtbot, dock)
    assert dock.heading.text() == "Stub: level across, border down · noise, 64 x 64, seed 5"
    assert dock.sheet.canvas.columns == 3
    assert [dock.cells[k].cell.label for k in (0, 5)] == [
        "level 0, border reflect, V 0.68, copied 0%, candidates 7",
        "level 2, border wrap, V 0.68, copied 50%, candidates 7",
    ]
    for index, shown in dock.cells.items():
        job = dock.sweep.jobs[index]
        assert job.params == StubParams(level=(0, 1, 2)[index % 3], border=("reflect", "wrap")[index // 3])
        alone = run(job).image
        assert np.array_equal(shown.cell.result.image, alone)
        assert shown.picture.shape == (64, 64, 3)
    assert dock.status.text().startswith("6 of 6")
    assert dock.save_button.isEnabled()
    assert not dock.stop_button.isEnabled()
    # Nothing of the session has changed.
    assert here.session.undo_text is None


def test_the_size_of_the_columns(qtbot, bench):
    dock = bench().dock
    choose(qtbot, dock.panel.side_box, "as the columns")
    complete(qtbot, dock)
    assert dock.sweep.base.size == (24, 32)
    size = dock.sheet.canvas.picture_size
    assert size.width() * 3 == pytest.approx(size.height() * 4, abs=3)


def sweep_threads():
    return [each.name for each in threading.enumerate() if each.name.startswith("sweep")]


def test_the_sheet_fills_while_it_runs_and_stops_at_once(qtbot, bench, monkeypatch):
    # The first three cells finish; those after them wait for as long as the test likes.
    here = bench(Column(1, "stub", StubParams(rounds=100)))
    dock = here.dock
    set_range(qtbot, dock.panel.across, "seed", "1", "40", "40")
    gate = Gate(monkeypatch, 3)
    start(qtbot, dock)
    qtbot.waitUntil(dock.stop_button.isEnabled)
    assert dock.progress.isVisible()
    qtbot.waitUntil(lambda: len(dock.cells) == 3, timeout=PATIENCE_MS)
    assert dock.sheet.canvas.describe(39) == "seed 40: not finished yet"
    qtbot.waitUntil(lambda: "left" in dock.status.text(), timeout=PATIENCE_MS)
    qtbot.mouseClick(dock.stop_button, LEFT)
    qtbot.waitUntil(lambda: "stopped" in dock.status.text())
    gate.open()
    qtbot.waitUntil(lambda: not dock.running, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not sweep_threads(), timeout=PATIENCE_MS)
    # Nothing begins any more: what is counted stays so.
    begun = len(running)
    assert len(dock.cells) == 3 <= begun < 40
    assert not dock.progress.isVisible()
    qtbot.waitUntil(lambda: not dock.stop_button.isEnabled())
    # What is there can be used, and another sweep can be started.
    assert dock.save_button.isEnabled()
    enter(qtbot, dock.panel.across.count, "2")
    complete(qtbot, dock)
    assert len(running) == begun + 2


def test_keys_start_and_stop(qtbot, bench):
    dock = bench(Column(1, "stub", StubParams(rounds=200))).dock
    dock.panel.across.knob.setFocus()
    qtbot.keyClick(dock.panel.across.knob, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: dock.running)
    qtbot.keyClick(dock.panel.across.knob, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: not dock.running, timeout=PATIENCE_MS)
    assert "stopped" in dock.status.text()


def test_a_second_start_replaces_the_first(qtbot, bench):
    dock = bench(Column(1, "stub", StubParams(rounds=200))).dock
    start(qtbot, dock)
    qtbot.waitUntil(lambda: dock.running)
    first = dock.sweep
    choose(qtbot, dock.panel.across.knob, "border")
    start(qtbot, dock)
    qtbot.waitUntil(lambda: dock.sweep is not first)
    qtbot.waitUntil(lambda: not dock.running, timeout=PATIENCE_MS)
    assert [dock.cells[k].cell.values["border"] for k in (0, 1)] == ["reflect", "wrap"]


def test_cells_wait_for_the_places_of_the_columns(qtbot, bench):
    here = bench()
    slots = here.controller.slots
    count = max(1, os.cpu_count() or 1)
    assert all(slots.acquire(lambda: False) for _ in range(count))
    running.clear()
    start(qtbot, here.dock)
    qtbot.waitUntil(lambda: here.dock.running)
    # A cell stands before the places.
    qtbot.waitUntil(lambda: bool(slots._waiting))
    assert running == []
    slots.release()
    qtbot.waitUntil(lambda: not here.dock.running, timeout=PATIENCE_MS)
    assert len(running) == 6
    # A sweep that waits can be stopped as well.
    assert slots.acquire(lambda: False)
    start(qtbot, here.dock)
    qtbot.waitUntil(lambda: here.dock.running)
    here.dock.stop()
    qtbot.waitUntil(lambda: not here.dock.running, timeout=PATIENCE_MS)
    for _ in range(count):
        slots.release()


def test_closing_joins_a_sweep_that_runs(qtbot, bench):
    here = bench(Column(1, "stub", StubParams(rounds=500)))
    start(qtbot, here.dock)
    qtbot.waitUntil(lambda: here.dock.running)
    here.host.close()
    here.controller.close()
    assert not [each for each in threading.enumerate() if each.name.startswith(("sweep", "texlab-sweep"))]


def test_without_an_exemplar_nothing_starts(qtbot, bench):
    here = bench()
    here.controller._preparation.prepared = None
    start(qtbot, here.dock)
    qtbot.waitUntil(lambda: here.dock.panel.error.text() == "There is no exemplar yet.")
