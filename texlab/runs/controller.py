"""Takes what the user does to the session, and the differences between two sessions to the columns."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from texlab.runs.column_runner import ColumnRunner, Shared
from texlab.runs.consent import Consent
from texlab.runs.editing import Editing
from texlab.runs.errands import Errands
from texlab.runs.exemplar import Preparation, Prepared
from texlab.runs.fill_runner import FillRunner
from texlab.runs.pointing import Pointing
from texlab.runs.slots import Slots
from texlab.runs.sweep_runner import SweepRunner
from texlab.runs.tuning_runner import TuningRunner
from texlab.runs.worker import Request, Worker
from texlab.state.difference import difference
from texlab.state.lesson_scene import NO_LESSON
from texlab.state.scene import ColumnScene, Scene
from texlab.widgets.once import Once
from texlab_core.engine.cache import AnalysisCache
from texlab_core.warming import Need, Warmth, every_need

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab.state.chosen import Sample, State
    from texlab.state.filling import FillPlan
    from texlab.state.lesson_scene import LessonScene
    from texlab.state.scene import Past
    from texlab.state.session import Session
    from texlab.state.sweeps import SweepPlan
    from texlab.state.tuning import TuningPlan
    from texlab.style.pictures import Picture
    from texlab_core.engine.inputs import ImageInput

# What the analyses of earlier exemplars and parameters may take together.
ANALYSES_BYTES = 256 * 2**20


class Controller(QObject):
    """Runs columns when the session changes and tells the window what to show.

    ``scene_changed(scene)`` after every change; ``exemplar_ready(prepared)`` when another exemplar is in use;
    ``errands_changed(names)`` when opening, saving and the like begin or end;
    ``problem(sentence)`` for what the user should know and ``said(sentence)`` for good news.
    """

    scene_changed = Signal(object)
    exemplar_ready = Signal(object)
    problem = Signal(str)
    said = Signal(str)
    all_idle = Signal()
    errands_changed = Signal(object)

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self._shared = Shared(
            Slots(max(1, os.cpu_count() or 1)), AnalysisCache(max_bytes=ANALYSES_BYTES), Warmth()
        )
        self._runners: dict[int, ColumnRunner] = {}
        self._leaving: list[ColumnRunner] = []
        self.editing = Editing(session, self)
        self.editing.released.connect(self._released)
        self.pointing = Pointing(self)
        self._consent = Consent()
        self._lesson = NO_LESSON
        self._preparation = Preparation(self)
        self._preparation.ready.connect(self._exemplar_prepared)
        self._preparation.failed.connect(self._exemplar_failed)
        self._errands = Errands(self)
        self._errands.failed.connect(self.problem)
        self._errands.idle.connect(self._errands_ended)
        self._errands.changed.connect(lambda: self.errands_changed.emit(self._errands.names))
        self._warming = Worker("warming", parent=self)
        self._warming.submit(lambda task: self.warmth.serve())
        self._writer = Worker("results", parent=self)
        self._refresh = Once(self, 0, self._announce)
        self.pointing.changed.connect(self._refresh.start)
        self._sweeps = SweepRunner(self.slots, self.warmth, self)
        self._sweeps.changed.connect(self._refresh.start)
        self._tuning = TuningRunner(self.slots, self.warmth, self)
        self._tuning.changed.connect(self._refresh.start)
        self._opened: tuple[str, ...] = ()
        self._compared: tuple[int, ...] = ()
        self._fills = FillRunner(self.slots, self.warmth, self)
        self._fills.changed.connect(self._refresh.start)
        self.all_idle.connect(self._load_the_rest)
        session.changed.connect(self._session_changed)
        session.selected.connect(lambda _: self._refresh.start())
        session.history_changed.connect(self._refresh.start)

    # What there is to show.

    @property
    def exemplar(self) -> ImageInput | None:
        """The exemplar in use (the session's, once it is prepared)."""
        return self.prepared.exemplar if self.prepared is not None else None

    @property
    def prepared(self) -> Prepared | None:
        """The exemplar with its scaled source."""
        return self._preparation.prepared

    def scene(self) -> Scene:
        """Return the frozen picture of now."""
        columns = tuple(
            self._runners[column.id].scene for column in self.session.state.columns if column.id in self._runners
        )
        return Scene(
            self.exemplar,
            columns,
            self.session.selected_id,
            self.pointing.probe,
            self._sweeps.scene,
            self.session.state.seed,
            self._tuning.scene,
            self._shared.points.points,
            self.pointing.stage_of(self.column_scene(self.session.selected_id)),
            self._lesson,
            self._source(),
            self._fills.scene,
            self.session.history,
            self._opened,
            self._compared,
            self.session.state.notes,
        )

    def tell_compared(self, pair: tuple[int, ...]) -> None:
        """Show the docks which two columns are compared; none when that is over."""
        if pair != self._compared:
            self._compared = pair
            self._refresh.start()

    def tell_opened(self, paths: tuple[str, ...]) -> None:
        """Show the docks which files are open; the newest first."""
        if paths != self._opened:
            self._opened = paths
            self._refresh.start()

    def _source(self) -> ImageInput | None:
        """Return the whole picture of the exemplar in use."""
        sample = self.session.state.sample
        return None if sample is None or self.prepared is None else sample.source

    def column_scene(self, column_id: int) -> ColumnScene | None:
        """Return what one column shows."""
        runner = self._runners.get(column_id)
        return runner.scene if runner is not None else None

    @property
    def shared(self) -> Shared:
        """What everything that computes shares: analyses, what is loaded, finished results."""
        return self._shared

    @property
    def slots(self) -> Slots:
        """The places that everything that computes shares: as many as there are cores."""
        return self._shared.slots

    @property
    def warmth(self) -> Warmth:
        """What is loaded, for everybody who runs methods."""
        return self._shared.warmth

    @property
    def busy(self) -> bool:
        """Whether any column waits or runs, or the exemplar is being prepared."""
        running = any(runner.busy for runner in self._runners.values())
        return running or self._preparation.busy or self._errands.busy or self._fills.busy

    @property
    def preparing(self) -> bool:
        """Whether another exemplar is on its way."""
        return self._preparation.busy

    @property
    def measuring(self) -> bool:
        """Whether the numbers about any column's picture are still to come."""
        return any(runner.measuring for runner in self._runners.values())

    # What the user does.

    def show_stored(self, column_id: int, picture: Picture, measures: Mapping[str, float]) -> None:
        """Show an earlier result of a column with its numbers, until that of the present run comes."""
        if (runner := self._runners.get(column_id)) is not None:
            runner.show_stored(picture, measures)

    def remember(self, column_id: int, history: tuple[Past, ...]) -> None:
        """Give a column earlier results to go back to, before those that it has."""
        if (runner := self._runners.get(column_id)) is not None:
            runner.remember(history)

    def show_lesson(self, lesson: LessonScene) -> None:
        """Tell everybody about the lesson that is given."""
        self._lesson = lesson
        self._refresh.start()

    def ask_first(self) -> None:
        """Let large jobs wait for the user, until they ask for one: what comes next is from a file."""
        self._consent.ask_first()

    def run_column(self, column_id: int) -> None:
        """Run a column at full size, however large."""
        self._allow(column_id)
        self._start(column_id, alone=True, asked=True)

    def go_on(self, column_id: int) -> None:
        """Go on from where a column was stopped or had finished, also at a larger size."""
        runner = self._runners.get(column_id)
        if runner is not None and runner.resumable:
            self._allow(column_id)
            self._start(column_id, go_on=True, alone=True)

    def run_all(self) -> None:
        """Run every column, however large."""
        for column in self.session.state.columns:
            self._allow(column.id)
            self._start(column.id, asked=True)

    def stop_column(self, column_id: int) -> None:
        """Stop a column; the others go on."""
        runner = self._runners.get(column_id)
        if runner is not None:
            runner.stop()

    def stop_all(self) -> None:
        """Stop every column."""
        for runner in list(self._runners.values()):
            runner.stop()

    def run_sweep(self, column_id: int, plan: SweepPlan) -> None:
        """Run a sweep of a column's method instead of one that runs."""
        self._sweeps.start(plan, self.session.state, column_id, self.exemplar)

    def stop_sweep(self) -> None:
        """Stop the sweep; the finished cells stay."""
        self._sweeps.stop()

    def run_tuning(self, column_id: int, plan: TuningPlan) -> None:
        """Search for parameters of a column's method instead of a search that runs."""
        self._tuning.start(plan, self.session.state, column_id, self.exemplar)

    def stop_tuning(self) -> None:
        """Stop the search; its points stay."""
        self._tuning.stop()

    def run_fill(self, plan: FillPlan) -> None:
        """Fill a whole picture instead of one that is being filled."""
        self._fills.start(plan)

    def stop_fill(self) -> None:
        """Stop the fill; the picture stays as it was."""
        self._fills.stop()

    def once(
        self,
        name: str,
        request: Request,
        done: Callable[[Any], None] | None = None,
        failed: Callable[[], None] | None = None,
        progressed: Callable[[Any], None] | None = None,
    ) -> None:
        """Do something once in the background (open, save); a failure becomes one sentence, then ``failed()``."""
        self._errands.run(name, request, done, failed, progressed)

    # The end.

    def leave(self) -> None:
        """Ask every thread to end, without waiting."""
        self._refresh.stop()
        self.warmth.close()
        for each in self._threads():
            each.leave()

    def close(self) -> None:
        """Stop and join every thread; they end side by side."""
        self.leave()
        for each in self._threads():
            # What is being compiled cannot be stopped at once: the thread ends by itself, and nobody waits for it.
            if each is not self._warming:
                each.close()
        self._runners.clear()
        self._leaving.clear()
        self._write_results()
        self._writer.finish()

    def _threads(
        self,
    ) -> list[ColumnRunner | Preparation | SweepRunner | TuningRunner | FillRunner | Worker | Errands]:
        others = (self._preparation, self._sweeps, self._tuning, self._fills, self._warming, self._errands)
        return [*self._runners.values(), *self._leaving, *others]

    # The session has changed.

    def _session_changed(self, before: State, after: State) -> None:
        changes = difference(before, after)
        for column_id in changes.removed:
            self._consent.forget(column_id)
            self._let_go(self._runners.pop(column_id))
        for column_id in changes.added:
            self._add_runner(column_id)
        for column in after.columns:
            self._runners[column.id].label(column)
        if changes.sample or changes.added:
            self._wish(after)
        if changes.sample:
            self._prepare(after.sample)
        elif self.prepared is not None:
            for column_id in changes.run:
                self._start(column_id, draft=self.editing.dragging, alone=len(changes.run) == 1)
        self._refresh.start()

    def _released(self, column_id: int | None) -> None:
        """Make what was drafted at full size, in one column or in all of them."""
        columns = tuple(self._runners) if column_id is None else (column_id,)
        if column_id is None and self._preparation.busy:
            # An exemplar that is still being prepared starts the columns at full size when it comes.
            return
        for each in columns:
            runner = self._runners.get(each)
            if runner is not None and runner.drafted:
                self._start(each, alone=len(columns) == 1)

    def _let_go(self, runner: ColumnRunner) -> None:
        """End a column without waiting: the window must not stand still while it comes to a stop."""
        runner.leave()
        # It waits here until another column goes.
        runner.forget()
        for ended in [each for each in self._leaving if each.ended]:
            self._leaving.remove(ended)
            ended.deleteLater()
        self._leaving.append(runner)

    def _add_runner(self, column_id: int) -> None:
        column = self.session.state.column(column_id)
        assert column is not None
        runner = ColumnRunner(column, self._shared, self)
        runner.changed.connect(lambda: self._refresh.start())
        self._runners[column_id] = runner

    def _prepare(self, sample: Sample | None) -> None:
        self.editing.cropping = self.editing.dragging
        # While the box is dragged, the drafts on their way are still worth seeing.
        if not self.editing.cropping:
            for runner in self._runners.values():
                runner.await_exemplar(coming=sample is not None)
        self._preparation.take(sample, patient=self.editing.cropping)

    def _exemplar_prepared(self, prepared: Prepared) -> None:
        self.exemplar_ready.emit(prepared)
        if self.editing.cropping or not self._preparation.busy:
            for column in self.session.state.columns:
                self._start(column.id, draft=self.editing.cropping)
        self._refresh.start()

    def _exemplar_failed(self, sentence: str) -> None:
        self.problem.emit(sentence)
        for runner in self._runners.values():
            runner.fail(sentence)

    def _start(
        self,
        column_id: int,
        *,
        draft: bool = False,
        go_on: bool = False,
        alone: bool = False,
        asked: bool = False,
    ) -> None:
        runner = self._runners.get(column_id)
        column = self.session.state.column(column_id)
        exemplar = self.exemplar
        if runner is None or column is None or exemplar is None or (self._preparation.busy and not draft):
            return
        size = self.session.state.size_of(column)
        large = "" if draft else self._consent.question(column, exemplar, size)
        if large and not runner.has_finished(column, self.session.state, exemplar):
            runner.hold(column, size, large)
            return
        runner.start(column, self.session.state, exemplar, draft=draft, go_on=go_on, alone=alone, asked=asked)

    def _allow(self, column_id: int) -> None:
        """Let a column start however large: the user has asked for it."""
        column = self.session.state.column(column_id)
        if column is not None:
            self._consent.give(column, self.exemplar, self.session.state.size_of(column))

    # Loading.

    def _wish(self, state: State) -> None:
        """Begin to load what the columns are about to need, in their order; most exemplars are coloured."""
        channels = state.sample.source.channels if state.sample is not None else 3
        self.warmth.wish(Need(column.method, channels) for column in state.columns)

    def _load_the_rest(self) -> None:
        """Load what no column needs, once all of them have what they need."""
        if self.prepared is not None:
            self.all_idle.disconnect(self._load_the_rest)
            self.warmth.wish(every_need())

    # Telling.

    def _errands_ended(self) -> None:
        if not self.busy:
            self.all_idle.emit()

    def _write_results(self) -> None:
        """Take to the disk what has been finished and measured."""
        kept = self._shared.kept
        if kept.unwritten:
            self._writer.submit(lambda task: kept.write(), patient=True)

    def _announce(self) -> None:
        self._write_results()
        self.scene_changed.emit(self.scene())
        if not self.busy:
            self.all_idle.emit()
