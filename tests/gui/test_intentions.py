"""Intentions without a window: every one is a frozen value and is carried out by the carrier."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
import pytest
from bench import Bench, begin

from texlab.state import intentions
from texlab.state.chosen import Column
from texlab.state.intentions import (
    AskOnce,
    CellAsColumn,
    ChangeMethod,
    ChooseColumn,
    EditField,
    EditInputs,
    EditNotes,
    EditParams,
    FillHoles,
    GoToState,
    Intention,
    Open,
    OpenFailure,
    OpenTab,
    Pin,
    Point,
    RunSweep,
    ShowMarks,
    ShowStage,
    StopSweep,
    TakeCell,
    TakePicture,
    Tell,
)
from texlab.state.scene import Frame
from texlab.state.sweeps import SweepPlan
from texlab_core.engine.inputs import DataInput, ImageInput, hash_arrays
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.methods.de_bonet.thresholds import ThresholdTable
from texlab_core.sheets.sweep import Cell, Vary

if TYPE_CHECKING:
    from texlab.state.session import Session

HB, EL = methods()["heeger-bergen"], methods()["efros-leung"]


class Recorder:
    """A controller that only notes what it is ordered to do."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.orders: list[tuple[Any, ...]] = []
        self.said = SimpleNamespace(emit=lambda text: self.orders.append(("said", text)))
        self.problem = SimpleNamespace(emit=lambda text: self.orders.append(("problem", text)))

    def once(self, name: str, request: Any, done: Any) -> None:
        done(request(SimpleNamespace(should_stop=lambda: "asked")))
        self.orders.append(("once", name))

    @property
    def editing(self) -> Any:
        return Part("edit", self.orders)

    @property
    def pointing(self) -> Any:
        return Part("point", self.orders)

    def __getattr__(self, name: str) -> Any:
        return lambda *args: self.orders.append((name, *args))


class Part:
    """Notes what is asked of a part of the controller."""

    def __init__(self, part: str, orders: list[tuple[Any, ...]]) -> None:
        self.part = part
        self.orders = orders

    def __getattr__(self, name: str) -> Any:
        return lambda *args: self.orders.append((f"{self.part}.{name}", *args))


class OrderBench(Bench):
    """A bench whose controller only notes its orders."""

    def __init__(self) -> None:
        super().__init__(Recorder)
        begin(self.session, Column(1, "heeger-bergen", HB.params()), Column(2, "msg", methods()["msg"].params()))

    def do(self, intention: Intention) -> list[tuple[Any, ...]]:
        self.carrier.carry_out(intention)
        return self.controller.orders


@pytest.fixture
def bench(qapp: Any) -> OrderBench:
    return OrderBench()


def mask() -> ImageInput:
    pixels = np.ones((4, 4, 1), np.float32)
    return ImageInput(pixels, "mask", hash_arrays({"pixels": pixels}))


def cell_of(method: str, params: Any, values: dict[str, Any], seed: int = 9) -> Cell:
    exemplar = ImageInput(np.zeros((32, 32, 3), np.float32), "gray", "0")
    job = Job(method=method, inputs={"exemplar": exemplar}, params=params, size=(8, 8), seed=seed)
    return Cell(index=0, job=job, values=values)


def test_every_intention_is_a_frozen_value() -> None:
    known = set(get_args(Intention))
    declared = {each for each in vars(intentions).values() if dataclasses.is_dataclass(each)}
    assert known == declared
    for each in known:
        assert each.__dataclass_params__.frozen, each
        assert each.__doc__.endswith(".") or "Parameters" in each.__doc__


def test_a_run_of_words_is_one_step_of_the_history(bench: OrderBench) -> None:
    for text, final in (("a", False), ("ab", False), ("abc", True), ("abcd", False)):
        bench.do(EditNotes(text, final))
    assert bench.session.state.notes == "abcd"
    bench.session.undo()
    assert bench.session.state.notes == "abc"
    bench.session.undo()
    assert bench.session.state.notes == ""


def test_edits_reach_the_controller_as_they_are(bench: OrderBench) -> None:
    params = HB.params(iterations=3)
    bench.do(EditParams(1, params, "iterations", final=False))
    code = (("code", DataInput({}, "code", "0")),)
    bench.do(EditInputs(2, code, "code"))
    assert bench.controller.orders == [
        ("edit.params", 1, params, "iterations", False),
        ("edit.inputs", 2, code, "code", True),
    ]


def test_a_field_is_set_in_what_the_column_has_by_then(bench: OrderBench) -> None:
    bench.session.set_params(1, HB.params(scales=2), "scales")
    assert bench.do(EditField(1, "iterations", 7)) == [
        ("edit.params", 1, HB.params(scales=2, iterations=7), "iterations", True)
    ]
    # The column has gone while the hand was still moving.
    assert len(bench.do(EditField(99, "iterations", 7))) == 1


def test_a_column_gets_another_method_with_its_defaults(bench: OrderBench) -> None:
    bench.do(ChangeMethod(2, "efros-leung"))
    changed = bench.session.state.column(2)
    assert (changed.method, changed.params) == ("efros-leung", EL.params())  # type: ignore[union-attr]
    assert bench.asked["choose"] == [2]
    assert bench.session.undo_text == "method efros-leung"


def test_pixels_and_marks(bench: OrderBench) -> None:
    bench.do(Point(1, 3, 4))
    bench.do(Pin(1, 5, 6))
    assert bench.controller.orders == [("point.point_at", 1, 3, 4), ("point.pin", 1, 5, 6)]
    marks: Any = ("here",)
    bench.do(ShowMarks(marks))
    assert bench.asked["show_marks"] == [marks]


def test_stages_and_pictures_of_tabs(bench: OrderBench) -> None:
    frame = Frame("noise", np.zeros((4, 4, 3), np.uint8))
    bench.do(ShowStage(1, frame))
    bench.do(ShowStage(1, None))
    bench.do(TakePicture("pyramid", "drag"))
    assert bench.controller.orders == [("point.show_stage", 1, frame), ("point.show_stage", 1, None)]
    assert bench.asked["take_picture"] == [("pyramid", "drag")]


def test_opening_telling_and_choosing(bench: OrderBench) -> None:
    bench.do(Open("gallery:oriented-zebra"))
    bench.do(ChooseColumn(2))
    bench.do(OpenFailure("coral", "de-bonet"))
    bench.do(OpenTab("histograms", (("log", True),)))
    assert bench.asked["open_failure"] == [("coral", "de-bonet")]
    assert bench.asked["open_tab"] == [("histograms", {"log": True})]
    bench.session.set_seed(8)
    bench.do(GoToState(0))
    assert (bench.session.state.seed, bench.session.redo_text) == (5, "seed 8")
    bench.do(GoToState(7))
    assert bench.session.state.seed == 5
    bench.do(Tell("Good."))
    bench.do(Tell("Bad.", problem=True))
    assert bench.asked["open_source"] == ["gallery:oriented-zebra"]
    assert bench.asked["choose"] == [2]
    assert bench.controller.orders == [("said", "Good."), ("problem", "Bad.")]


def test_what_is_asked_once_is_told_to_who_asked(bench: OrderBench) -> None:
    answers: list[Any] = []
    assert bench.do(AskOnce("mask", lambda should_stop: should_stop(), answers.append)) == [("once", "mask")]
    assert answers == ["asked"]


def test_sweeps_are_run_and_stopped(bench: OrderBench) -> None:
    plan = SweepPlan((Vary("iterations", (1, 2)),), 64)
    bench.do(RunSweep(1, plan))
    bench.do(StopSweep())
    assert bench.controller.orders == [("run_sweep", 1, plan), ("stop_sweep",)]


def test_holes_are_filled_in_a_column_of_their_own_then_in_the_same(bench: OrderBench) -> None:
    inputs = (("mask", mask()),)
    bench.do(FillHoles("efros-leung", inputs, (8, 9)))
    column = bench.session.state.columns[-1]
    assert (column.method, column.params, column.inputs, column.size) == (
        "efros-leung",
        EL.params(),
        inputs,
        (8, 9),
    )
    bench.session.set_params(column.id, EL.params(window=5), "window")
    bench.do(FillHoles("efros-leung", inputs, None))
    assert bench.session.state.columns[-1] == Column(column.id, "efros-leung", EL.params(window=5), inputs, None)
    assert bench.asked["choose"] == [column.id, column.id]


def test_a_cell_becomes_a_column(bench: OrderBench) -> None:
    params = HB.params(iterations=4)
    bench.do(CellAsColumn(cell_of("heeger-bergen", params, {"iterations": 4}), 1))
    columns = bench.session.state.columns
    assert [each.id for each in columns] == [1, 3, 2]
    assert (columns[1].params, columns[1].seed) == (params, 9)
    assert columns[0].params == HB.params()
    assert bench.asked["choose"] == [3]
    assert bench.session.undo_text == "column of a sweep"


def test_thresholds_set_by_hand_do_not_go_in_silence(bench: OrderBench) -> None:
    method = methods()["de-bonet"]
    by_hand = method.params(
        thresholds=ThresholdTable((((1, "luminance/laplacian"), 0.5), ((2, "luminance/laplacian"), 0.4)))
    )
    bench.session.set_method(1, "de-bonet", by_hand)
    bench.do(TakeCell(cell_of("de-bonet", method.params(alpha=0.4), {"alpha": 0.4}), (1,)))
    said = [("said", "2 thresholds set by hand gave way to those of the cell; undo brings them back.")]
    assert bench.controller.orders == said
    # Nothing to lose is nothing to say.
    bench.do(TakeCell(cell_of("de-bonet", method.params(alpha=0.2), {"alpha": 0.2}), (1,)))
    assert bench.controller.orders == said


def test_a_cell_is_taken_by_the_column_that_is_wanted(bench: OrderBench) -> None:
    taken = HB.params(iterations=4)
    bench.session.add_column("heeger-bergen", HB.params())
    bench.do(TakeCell(cell_of("heeger-bergen", taken, {"iterations": 4}), (3, 1)))
    assert [column.params == taken for column in bench.session.state.columns] == [False, False, True]
    assert (bench.session.state.seed, bench.asked["choose"]) == (5, [3])
    bench.do(TakeCell(cell_of("heeger-bergen", HB.params(), {"seed": 9}), (2,)))
    assert bench.session.state.column(1).params == HB.params()
    assert bench.session.state.seed == 9


def test_a_cell_that_no_column_can_take_is_said(bench: OrderBench) -> None:
    before = bench.session.state
    bench.do(TakeCell(cell_of("efros-leung", EL.params(), {"window": 5}), (1,)))
    assert bench.session.state is before
    assert bench.controller.orders == [
        ("problem", f"No column runs {EL.title} any more; add one to take the parameters.")
    ]
