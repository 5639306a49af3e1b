"""Carries out what docks, lessons and scripts intend."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any, assert_never

from texlab.state.changes import by_hand, cell_alone, sample_of, with_cell, with_cell_column
from texlab.state.intentions import (
    AskOnce,
    CellAsColumn,
    CellInWindow,
    ChangeLesson,
    ChangeMethod,
    ChooseColumn,
    CopyLesson,
    EditField,
    EditInputs,
    EditNotes,
    EditParams,
    EditSize,
    FillHoles,
    GoToState,
    GoToStep,
    LeaveLesson,
    LightUp,
    NewLesson,
    Open,
    OpenFailure,
    OpenLesson,
    OpenTab,
    Pin,
    Point,
    RunFill,
    RunSweep,
    RunTuning,
    SaveStep,
    ShowMarks,
    ShowStage,
    StopFill,
    StopSweep,
    StopTuning,
    TakeCell,
    TakeExemplar,
    TakePicture,
    TakeStage,
    Tell,
    UndoLesson,
)
from texlab.storage.projects import write_for_window
from texlab_core.engine.registry import find_method

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab.runs.controller import Controller
    from texlab.state.intentions import Intention
    from texlab.style.pictures import Lit, Mark


class Carrier:
    """The one place that turns intentions into changes of the session and orders to the controller.

    Parameters
    ----------
    controller
        Runs and edits columns.
    choose
        Chooses a column and brings it into view.
    open_source
        Opens a path or a texture of the gallery.
    show_marks
        Outlines places in the exemplar.
    take_picture
        Takes what the dock of this name shows away as a picture: ``copy``, ``save`` or ``drag``.
    teach
        Opens, gives, changes and leaves lessons.
    open_failure
        Opens an example of the failure gallery by its name, with a column of another method beside it.
    open_tab
        Brings the tab of this name to the front and sets its controls by name.
    take_stage
        Lets the dock of this name take the whole stage, or give it back.
    light_up
        Lets pixels of the pictures light up.
    open_window
        Opens a project file in a window of its own.
    """

    def __init__(
        self,
        controller: Controller,
        choose: Callable[[int], None],
        open_source: Callable[[str], None],
        show_marks: Callable[[tuple[Mark, ...]], None],
        take_picture: Callable[[str, str], None],
        teach: Callable[[Intention], None],
        open_failure: Callable[[str, str], None],
        open_tab: Callable[[str, Mapping[str, Any]], None],
        take_stage: Callable[[str], None] = lambda _: None,
        light_up: Callable[[tuple[Lit, ...]], None] = lambda _: None,
        open_window: Callable[[str], None] = lambda _: None,
    ) -> None:
        self._controller = controller
        self._session = controller.session
        self._choose = choose
        self._open_source = open_source
        self._show_marks = show_marks
        self._take_picture = take_picture
        self._teach = teach
        self._open_failure = open_failure
        self._open_tab = open_tab
        self._take_stage = take_stage
        self._light_up = light_up
        self._open_window = open_window

    def carry_out(self, intention: Intention) -> None:
        """Do what is intended."""
        controller, session = self._controller, self._session
        match intention:
            case EditParams(column_id, params, name, final):
                controller.editing.params(column_id, params, name, final)
            case EditField(column_id, field, value, final):
                column = session.state.column(column_id)
                if column is not None:
                    controller.editing.params(column_id, column.params.replace(**{field: value}), field, final)
            case ChangeMethod(column_id, method):
                session.set_method(column_id, method, find_method(method).params())
                self._choose(column_id)
            case EditInputs(column_id, inputs, text, final):
                controller.editing.inputs(column_id, inputs, text, final)
            case EditSize(column_id, size):
                session.set_column_size(column_id, size, merge=("size", column_id))
            case FillHoles():
                self._fill(intention)
            case ChooseColumn(column_id):
                self._choose(column_id)
            case Point(column_id, row, place):
                controller.pointing.point_at(column_id, row, place)
            case Pin(column_id, row, place):
                controller.pointing.pin(column_id, row, place)
            case ShowStage(column_id, stage):
                controller.pointing.show_stage(column_id, stage)
            case TakePicture(dock, how):
                self._take_picture(dock, how)
            case ShowMarks(marks):
                self._show_marks(marks)
            case LightUp(places):
                self._light_up(places)
            case Open(source):
                self._open_source(source)
            case OpenFailure(name, beside):
                self._open_failure(name, beside)
            case GoToState(index):
                session.go_to(index)
            case EditNotes(text, final):
                session.apply(dataclasses.replace(session.state, notes=text), "notes", merge="notes")
                if final:
                    session.finish_merge("notes")
            case OpenTab(tab, settings):
                self._open_tab(tab, dict(settings))
            case Tell(sentence, problem):
                (controller.problem if problem else controller.said).emit(sentence)
            case AskOnce(name, compute, done):
                controller.once(name, lambda task: compute(task.should_stop), done)
            case RunSweep(column_id, plan):
                controller.run_sweep(column_id, plan)
            case StopSweep():
                controller.stop_sweep()
            case RunFill(plan):
                controller.run_fill(plan)
            case StopFill():
                controller.stop_fill()
            case TakeExemplar(image):
                session.set_sample(sample_of(image, None))
            case TakeStage(dock):
                self._take_stage(dock)
            case RunTuning(column_id, plan):
                controller.run_tuning(column_id, plan)
            case StopTuning():
                controller.stop_tuning()
            case OpenLesson() | GoToStep() | LeaveLesson() | SaveStep() | NewLesson():
                self._teach(intention)
            case ChangeLesson() | UndoLesson() | CopyLesson():
                self._teach(intention)
            case TakeCell():
                self._take(intention)
            case CellAsColumn(cell, after):
                state, column_id = with_cell_column(session.state, cell, after)
                session.apply(state, "column of a sweep")
                self._choose(column_id)
            case CellInWindow(cell):
                state = cell_alone(session.state, cell)
                controller.once("cell-window", lambda task: write_for_window(state), self._open_window)
            case _:
                assert_never(intention)

    def _fill(self, wanted: FillHoles) -> None:
        session, method = self._session, wanted.method
        column = next((each for each in session.state.columns if each.method == method), None)
        params = column.params if column is not None else find_method(method).params()
        self._choose(session.fill(params, wanted.inputs, wanted.size, method))

    def _take(self, wanted: TakeCell) -> None:
        cell = wanted.cell
        found = with_cell(self._session.state, cell, wanted.wanted)
        if found is None:
            title = find_method(cell.job.method).title
            self._controller.problem.emit(f"No column runs {title} any more; add one to take the parameters.")
            return
        state, column_id = found
        before, now = self._session.state.column(column_id), state.column(column_id)
        lost = 0 if before is None or before == now else by_hand(before.params)
        self._session.apply(state, f"sweep {cell.setting}" if cell.setting else "parameters of a point")
        self._choose(column_id)
        if now is not None and lost > by_hand(now.params):
            some = f"{lost} thresholds" if lost > 1 else "One threshold"
            self._controller.said.emit(f"{some} set by hand gave way to those of the cell; undo brings them back.")
