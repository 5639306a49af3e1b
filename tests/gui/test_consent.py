"""What waits for the word of the user, what is exported while a control moves, what the status bar says of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from dock_scenes import column_of, image_input, noise

from texlab.runs.column_run import job_of
from texlab.runs.consent import Consent
from texlab.state.changes import sample_of
from texlab.state.chosen import Column, State
from texlab.window.export_desk import column_items
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
    assert "F5 runs it" in consent.question(column, EXEMPLAR, (256, 256, 256))
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
        (("palette",), ""),
    ):
        bar.show_errands(names)
        assert (bar.errand.text(), bar.errand_bar.isHidden()) == (said, not said)
