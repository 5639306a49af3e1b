"""What waits for the word of the user, what leaves the window, and what is said of it: each part by itself."""

from __future__ import annotations

import io
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from dock_scenes import column_of, image_input, noise
from PIL import Image
from PySide6.QtGui import QGuiApplication

from texlab.runs.column_run import job_of
from texlab.runs.consent import Consent
from texlab.state.changes import sample_of
from texlab.state.chosen import Column, State
from texlab.window.exchange import Exchange
from texlab.window.export_desk import column_items
from texlab.window.popout_setup import PopoutRequest, PopoutSetup
from texlab.window.status_bar import StatusBar
from texlab_core.engine.registry import Estimate, methods

GIGABYTE = 2**30
EXEMPLAR = image_input(noise(16, 16))


@pytest.mark.parametrize(
    ("seconds", "nbytes", "starts"),
    [
        (600.0, GIGABYTE, True),
        (500.0, GIGABYTE // 2, True),
        (601.0, GIGABYTE, False),
        (599.0, GIGABYTE + 1, False),
    ],
)
def test_what_was_asked_for_covers_no_more_time_and_no_more_memory(
    monkeypatch: pytest.MonkeyPatch, seconds: float, nbytes: int, starts: bool
) -> None:
    column = Column(1, "solid", methods()["solid"].params())
    expected = [Estimate(600.0, GIGABYTE)]
    monkeypatch.setattr("texlab.runs.consent._expected", lambda *_: expected[0])
    consent = Consent()
    assert "F5 runs it:" in consent.question(column, EXEMPLAR, (256, 256, 256))
    consent.give(column, EXEMPLAR, (256, 256, 256))
    expected[0] = Estimate(seconds, nbytes)
    assert (consent.question(column, EXEMPLAR, (256, 256, 256)) == "") is starts
    # Another column with the same id is another question.
    consent.forget(1)
    assert consent.question(column, EXEMPLAR, (256, 256, 256))


@pytest.mark.parametrize("stale", [False, True])
def test_a_result_of_what_was_there_before_is_not_exported(stale: bool) -> None:
    params = methods()["heeger-bergen"].params()
    column = Column(1, "heeger-bergen", params.replace(iterations=2) if stale else params)
    state = State(sample_of(EXEMPLAR, None), (column,), 5, (16, 16), 2)
    then = job_of(Column(1, "heeger-bergen", params), state, EXEMPLAR)
    scene: Any = column_of(np.zeros((16, 16, 3), np.float32), method="heeger-bergen", params=params)
    object.__setattr__(scene.result, "job", then)
    controller: Any = SimpleNamespace(
        session=SimpleNamespace(state=state),
        exemplar=EXEMPLAR,
        scene=lambda: SimpleNamespace(columns=(scene,)),
        column_scene=lambda column_id: scene,
    )
    (item,) = column_items(controller, (1,))
    assert item.job.params == column.params
    assert (item.result is None) is stale


def test_the_status_bar_says_once_what_goes_on(qtbot: Any) -> None:
    bar = StatusBar()
    qtbot.addWidget(bar)
    for names, said in (
        ((), ""),
        (("save",), "Saving ..."),
        (("open", "session", "save", "sheet"), "Opening and saving ..."),
        (("cell-window",), "Opening ..."),
        (("palette",), ""),
    ):
        bar.show_errands(names)
        assert (bar.errand.text(), bar.errand_bar.isHidden()) == (said, not said)


def test_the_fields_of_a_pop_out_test_are_what_is_asked(qtbot: Any) -> None:
    setup = PopoutSetup()
    qtbot.addWidget(setup)
    setup.set_columns([(4, "1. Tiling"), (7, "2. De Bonet")], 11)
    setup.repeats.setValue(3)
    setup.feather.setValue(5)
    setup.share.setCurrentIndex(1)
    with qtbot.waitSignal(setup.asked) as asked:
        setup.start_button.click()
    assert asked.args == [PopoutRequest((4, 7), 3, 1 / 3, 5, 11)]
    with qtbot.waitSignal(setup.asked) as asked:
        setup.figures_button.click()
    assert asked.args == [PopoutRequest((4, 7), 3, 1 / 3, 5, 11, figures=True)]


def test_a_picture_is_copied_as_it_is_seen(qtbot: Any) -> None:
    picture = np.random.default_rng(3).integers(0, 256, (5, 7, 3), np.uint8)
    told: list[str] = []
    controller: Any = SimpleNamespace(
        column_scene=lambda column_id: SimpleNamespace(picture=picture),
        once=lambda name, work, done: done(work(None)),
        said=SimpleNamespace(emit=told.append),
    )
    nothing: Any = SimpleNamespace()
    exchange = Exchange(nothing, nothing, controller, nothing)
    exchange.copy(1)
    data = QGuiApplication.clipboard().mimeData().data("image/png").data()
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(bytes(data)))), picture)
    assert told == ["Copied 7 x 5 pixels."]
