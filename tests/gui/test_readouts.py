"""The value under the pointer: it hides no data, and it is that of what is shown now."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import column_of, feed, noise, scene_of
from PySide6.QtCore import QPoint, QRect
from PySide6.QtWidgets import QApplication

from tests.gui.conftest import wait_idle
from texlab.docks.bands.comparison import compare
from texlab.docks.bands.comparison_view import HistogramPlot
from texlab.docks.bands.histograms import HistogramsDock
from texlab.docks.frame import FramedDock
from texlab.docks.steps import StepsDock
from texlab.state.scene import Frame
from texlab.style.pictures import to_picture

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

LONG = "result, level 2, waves along 135°, 1024, 1024: -0.01836, exemplar 0.0173, candidates 1234"


def place(widget: Any, root: Any) -> QRect:
    return QRect(widget.mapTo(root, QPoint()), widget.size())


@pytest.mark.slow
def test_no_readout_hides_what_it_is_about_nor_outlives_it(qtbot: Any, explorer: Explorer) -> None:
    window = explorer.window
    seen = []
    for name in window.docks:
        window.raise_dock(name)
        wait_idle(qtbot, explorer)
        content = window.docks[name].widget()
        docks = [each for each in [content, *content.findChildren(FramedDock)] if isinstance(each, FramedDock)]
        for dock in docks:
            readout = dock._readout
            if readout is None or not dock.isVisible():
                continue
            seen.append(dock.name)
            # As they are when there is something to read.
            dock.controls.show()
            dock.show_body()
            for folded in (False, True) if dock.folds else (False,):
                dock.fold_controls(folded)
                QApplication.processEvents()
                readout.setText(LONG)
                told, body = place(readout, dock), place(dock.body.parentWidget(), dock)
                assert readout.isVisible()
                assert not told.intersects(body), f"{dock.name}, folded {folded}: {told} over {body}"
                assert dock.rect().contains(told), f"{dock.name}, folded {folded}: {told} in {dock.rect()}"
                assert readout.height() > readout.fontMetrics().height()
            dock.fold_controls(False)
            # What is said of an answer goes with it.
            if dock.answer is not None:
                readout.setText("from before")
                dock.present(dock.answer)
                assert not readout.isVisible(), dock.name
            readout.setText("from before")
            dock.present_nothing("")
            assert not readout.isVisible(), dock.name
    assert {"pyramid", "histograms", "spectrum", "gabor", "code", "convergence", "maps", "steps"} <= {*seen}


def test_a_stage_that_is_chosen_tells_its_own_value(qtbot: Any) -> None:
    dock = StepsDock()
    qtbot.addWidget(dock)
    dock.show()
    images = [noise(12, 16, seed=k) for k in range(3)]
    frames = tuple(Frame(f"iteration {k}", to_picture(image)) for k, image in enumerate(images))
    feed(dock, scene_of(column_of(images[-1], frames=frames)))
    dock.pane.hovered.emit(3, 5)
    for k in (0, 2, 1):
        dock.slider.setValue(k)
        expected = " ".join(f"{value / 255:.3f}" for value in frames[k].picture[3, 5])
        assert dock.readout.text() == f"5, 3   RGB {expected}"
    dock.pane.hovered.emit(-1, -1)
    assert not dock.readout.isVisible()


@pytest.mark.parametrize("at", [0.2, 0.5, 0.83])
def test_a_cumulative_histogram_tells_the_share_below(at: float) -> None:
    values, other = (np.random.default_rng(k).beta(2, 3 + k, 4000) for k in (1, 2))
    shown = compare("luma", values, other, limits=(0.0, 1.0))
    edge = shown.edges[np.argmin(np.abs(shown.edges - at))]
    said = HistogramPlot.describe(shown, edge + 1e-9, cumulated=True)
    below, below_other = (float(np.mean(each < edge)) for each in (values, other))
    assert said == f"below {edge:.4g}: exemplar {below:.3%}, result {below_other:.3%}"
    # That of the bin alone is another number.
    assert HistogramPlot.describe(shown, edge + 1e-9) != said


def test_the_switch_renews_what_is_said(qtbot: Any) -> None:
    dock = HistogramsDock()
    qtbot.addWidget(dock)
    dock.show()
    exemplar = noise(32, 32)
    feed(dock, scene_of(column_of(noise(32, 32, seed=2)), exemplar=exemplar))
    dock.readout.tell(partial(dock._value_words, 0, 0.5))
    assert dock.readout.text().startswith("0.5: ")
    dock.cumulated.setChecked(True)
    assert dock.readout.text().startswith("below 0.5: ")
