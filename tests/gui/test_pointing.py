"""What is pointed at and edited, without a window: pixels that are pinned, stages, steps of the history."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from texlab.runs.editing import Editing
from texlab.runs.pointing import Pointing
from texlab.state.changes import sample_of
from texlab.state.chosen import Column, State
from texlab.state.scene import Probe
from texlab.state.session import Session
from texlab_core.engine.inputs import Crop, ImageInput
from texlab_core.engine.levels import Levels
from texlab_core.engine.registry import methods

HB = methods()["heeger-bergen"].params


@pytest.fixture
def pointing(qapp: Any) -> tuple[Pointing, list[Probe | None]]:
    made = Pointing()
    seen: list[Probe | None] = []
    made.changed.connect(lambda: seen.append(made.probe))
    return made, seen


def test_a_pinned_pixel_stays_until_it_is_let_go_of(pointing: Any) -> None:
    made, seen = pointing
    made.point_at(1, 3, 4)
    made.point_at(1, 3, 4)
    made.pin(1, 5, 6)
    made.point_at(1, 7, 8)
    made.point_at(1, -1, -1)
    assert seen == [Probe(1, 3, 4), Probe(1, 5, 6, pinned=True)]
    made.pin(1, 5, 6)
    assert made.probe is None
    made.point_at(2, 0, 1)
    made.point_at(2, -1, -1)
    assert seen[2:] == [None, Probe(2, 0, 1), None]


def test_a_stage_is_looked_at_as_long_as_its_run_keeps_it(pointing: Any) -> None:
    made, seen = pointing
    first, second = object(), object()
    column: Any = SimpleNamespace(id=1, frames=(first, second))
    assert made.stage_of(column) is None
    made.show_stage(1, second)
    assert made.stage_of(column) is second
    assert made.stage_of(SimpleNamespace(id=2, frames=(second,))) is None
    assert made.stage_of(SimpleNamespace(id=1, frames=(first,))) is None
    assert made.stage_of(None) is None
    made.show_stage(1, None)
    assert made.stage_of(column) is None
    assert len(seen) == 2


@pytest.fixture
def editing(qapp: Any) -> tuple[Session, Editing, list[Any]]:
    session = Session()
    image = ImageInput(np.zeros((32, 40, 3), np.float32), "gray", "0")
    columns = (Column(1, "heeger-bergen", HB()),)
    session.apply(State(sample_of(image, None), columns, 5, (24, 32), 2), "start")
    session.reset_history()
    made = Editing(session)
    told: list[Any] = []
    session.changed.connect(lambda before, after: told.append(made.dragging))
    made.released.connect(lambda column_id: told.append(("released", column_id)))
    return session, made, told


def test_a_drag_is_one_step_and_drafts_until_it_is_released(editing: Any) -> None:
    session, made, told = editing
    for iterations, final in ((3, False), (4, False), (4, True), (6, True)):
        made.params(1, HB(iterations=iterations), "iterations", final)
    # The same value changes nothing, but the drag is over.
    assert told == [True, True, ("released", 1), False, ("released", 1)]
    assert not made.dragging
    session.undo()
    assert session.state.columns[0].params == HB(iterations=4)
    session.undo()
    assert session.state.columns[0].params == HB()


def test_the_box_of_the_exemplar_is_dragged_like_a_knob(editing: Any) -> None:
    session, made, told = editing
    for left, final in ((1, False), (2, False), (3, True)):
        made.crop(Crop(0, left, 16, 16), final)
        assert made.cropping is not final
    assert told == [True, True, False, ("released", None)]
    session.undo()
    assert session.state.sample.crop is None


def test_levels_for_looking_only_need_levels(editing: Any) -> None:
    session, made, _ = editing
    levels = Levels(black=0.25, white=0.75)
    made.levels(levels, True)
    assert (session.state.sample.levels, session.state.sample.look_only) == (levels, True)
    made.levels(None, True)
    assert (session.state.sample.levels, session.state.sample.look_only) == (None, False)


def test_nothing_is_changed_where_there_is_nothing(editing: Any) -> None:
    session, made, told = editing
    made.scale(1.0)
    made.reset_params(9)
    session.apply(State(), "empty")
    told.clear()
    made.crop(None, True)
    made.scale(0.5)
    made.levels(None, False)
    assert told == []
