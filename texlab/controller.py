"""Owns the workers, and applies the differences between two sessions to them and to the views."""

from __future__ import annotations

import contextlib
import dataclasses
import logging
import math
import os
import time
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer, Signal

from texlab.column_run import ColumnRun, Drafted, DraftRun, Finished, Loading, Progress, Waits, with_exemplar
from texlab.jobs import Request, Slots, Worker
from texlab.pictures import to_picture
from texlab.resolve import difference, draft_size
from texlab.scene import ColumnScene, Mark, Picture, Probe, Scene
from texlab_core.inputs import ArraysInput
from texlab_core.registry import find_method
from texlab_core.run import AnalysisCache, Job
from texlab_core.warming import Need, Warmth, every_need

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab.session import Column, Sample, Session, State
    from texlab.theme import ThemeSource
    from texlab_core.inputs import Crop, ImageInput, Input
    from texlab_core.params import Params

log = logging.getLogger(__name__)


@dataclasses.dataclass(eq=False)
class _Runtime:
    """What the controller keeps of one column."""

    worker: Worker
    scene: ColumnScene
    seconds: float | None = None
    started_at: float = 0.0
    drafted: bool = False
    live: bool = False
    run: ColumnRun | None = None
    kept: Callable[[], Mapping[str, Any]] | None = None


@dataclasses.dataclass(frozen=True, eq=False)
class Prepared:
    """The exemplar as the methods get it, and its scaled source as it is shown."""

    exemplar: ImageInput
    source_picture: Picture
    source_scaled: ImageInput


class Controller(QObject):
    """Runs columns when the session changes and tells the window what to show.

    ``scene_changed(scene)`` after every change; ``exemplar_ready(prepared)`` when another exemplar is in use;
    ``problem(sentence)`` for what the user should know and ``said(sentence)`` for good news;
    ``open_wanted(source)`` when a dock wants a file or a texture of the gallery opened.
    """

    scene_changed = Signal(object)
    exemplar_ready = Signal(object)
    problem = Signal(str)
    said = Signal(str)
    all_idle = Signal()
    marks_changed = Signal(object)
    open_wanted = Signal(object)

    def __init__(self, session: Session, themes: ThemeSource, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self._themes = themes
        self._slots = Slots(max(1, os.cpu_count() or 1))
        self._cache = AnalysisCache()
        self._warmth = Warmth()
        self._runtimes: dict[int, _Runtime] = {}
        self._prepared: Prepared | None = None
        self._dragging = False
        self._cropping = False
        self._preparing = False
        self._probe: Probe | None = None
        self._once_workers: set[Worker] = set()
        self._leaving: list[Worker] = []
        self._exemplar_worker = Worker("exemplar", parent=self)
        self._exemplar_worker.finished.connect(self._exemplar_prepared)
        self._exemplar_worker.failed.connect(self._exemplar_failed)
        self._warming = Worker("warming", parent=self)
        self._warming.submit(lambda task: self._warmth.serve())
        self._refresh = QTimer(self)
        self._refresh.setSingleShot(True)
        self._refresh.setInterval(0)
        self._refresh.timeout.connect(self._announce)
        self.all_idle.connect(self._load_the_rest)
        session.changed.connect(self._session_changed)
        session.selected.connect(lambda _: self._refresh.start())
        themes.changed.connect(lambda _: self._refresh.start())

    # What there is to show.

    @property
    def exemplar(self) -> ImageInput | None:
        """The exemplar in use (the session's, once it is prepared)."""
        return self._prepared.exemplar if self._prepared is not None else None

    @property
    def prepared(self) -> Prepared | None:
        """The exemplar with its scaled source."""
        return self._prepared

    def scene(self) -> Scene:
        """Return the frozen picture of now."""
        columns = tuple(
            self._runtimes[column.id].scene for column in self.session.state.columns if column.id in self._runtimes
        )
        return Scene(self._themes.theme, self.exemplar, columns, self.session.selected_id, self._probe)

    def column_scene(self, column_id: int) -> ColumnScene | None:
        """Return what one column shows."""
        runtime = self._runtimes.get(column_id)
        return runtime.scene if runtime is not None else None

    @property
    def slots(self) -> Slots:
        """The places that everything that computes shares: as many as there are cores."""
        return self._slots

    @property
    def warmth(self) -> Warmth:
        """What is loaded, for everybody who runs methods."""
        return self._warmth

    @property
    def busy(self) -> bool:
        """Whether any column waits or runs, or the exemplar is being prepared."""
        running = any(each.live or each.scene.status in ("waiting", "running") for each in self._runtimes.values())
        return running or self._preparing or bool(self._once_workers)

    # What the user does.

    def edit_params(self, column_id: int, params: Params, name: str, final: bool) -> None:
        """Take parameters from the form: drafts while a control is dragged, the full size on release."""
        with self._drag(not final):
            self.session.set_params(column_id, params, name, merge=("knob", column_id, name))
        self._settle(final, (column_id,))

    def edit_inputs(
        self, column_id: int, inputs: tuple[tuple[str, Input], ...], text: str, final: bool = True
    ) -> None:
        """Give a column other further inputs: drafts while something is dragged, the full size on release."""
        with self._drag(not final):
            self.session.set_inputs(column_id, inputs, text, merge=("inputs", column_id, text))
        self._settle(final, (column_id,))

    def edit_crop(self, crop: Crop | None, final: bool) -> None:
        """Take another crop from the exemplar's box."""
        sample = self.session.state.sample
        if sample is not None:
            with self._drag(not final):
                self.session.set_sample(dataclasses.replace(sample, crop=crop), merge="crop")
            self._cropping = not final
            # An exemplar that is still being prepared starts the columns at full size when it comes.
            self._settle(final, () if self._preparing else tuple(self._runtimes))

    def edit_scale(self, scale: float, merge: object | None = None) -> None:
        """Scale the source; the crop is scaled along."""
        sample = self.session.state.sample
        if sample is None or scale == sample.scale:
            return
        self.session.set_sample(rescaled(sample, scale), merge=merge)

    @contextlib.contextmanager
    def _drag(self, dragging: bool) -> Any:
        self._dragging = dragging
        try:
            yield
        finally:
            self._dragging = False

    def _settle(self, final: bool, columns: tuple[int, ...]) -> None:
        if not final:
            return
        self.session.finish_merge()
        for column_id in columns:
            runtime = self._runtimes.get(column_id)
            if runtime is not None and runtime.drafted:
                self.run_column(column_id)

    def point_at(self, column_id: int, row: int, column: int) -> None:
        """Ask about the pixel under the pointer, unless another one is pinned."""
        if self._probe is not None and self._probe.pinned:
            return
        self._set_probe(Probe(column_id, row, column) if row >= 0 else None)

    def pin(self, column_id: int, row: int, column: int) -> None:
        """Keep asking about a pixel; the same pixel again lets go of it."""
        wanted = Probe(column_id, row, column, pinned=True)
        self._set_probe(None if self._probe == wanted or row < 0 else wanted)

    def _set_probe(self, probe: Probe | None) -> None:
        if probe != self._probe:
            self._probe = probe
            self._refresh.start()

    def show_marks(self, marks: tuple[Mark, ...]) -> None:
        """Outline places in the exemplar."""
        self.marks_changed.emit(marks)

    def reset_params(self, column_id: int) -> None:
        """Give a column its method's defaults."""
        column = self.session.state.column(column_id)
        if column is not None:
            self.session.set_params(column_id, find_method(column.method).params(), "reset all")

    def run_column(self, column_id: int) -> None:
        """Run a column at full size."""
        self._start(column_id, draft=False)

    def go_on(self, column_id: int) -> None:
        """Go on from where a column was stopped or had finished, also at a larger size."""
        runtime = self._runtimes.get(column_id)
        if runtime is not None and runtime.kept is not None:
            self._start(column_id, draft=False, state=runtime.kept)

    def run_all(self) -> None:
        """Run every column."""
        for column in self.session.state.columns:
            self.run_column(column.id)

    def stop_column(self, column_id: int) -> None:
        """Stop a column; the others go on."""
        runtime = self._runtimes.get(column_id)
        if runtime is not None and runtime.scene.status in ("waiting", "running"):
            if runtime.run is not None and runtime.run.state is not None:
                runtime.kept = runtime.run.state
            runtime.worker.cancel()

    def stop_all(self) -> None:
        """Stop every column."""
        for column_id in list(self._runtimes):
            self.stop_column(column_id)

    def once(
        self,
        name: str,
        request: Request,
        done: Callable[[Any], None] | None = None,
        failed: Callable[[], None] | None = None,
    ) -> None:
        """Do something once in the background (open, save); a failure becomes one sentence, then ``failed()``."""
        worker = Worker(name, parent=self)
        self._once_workers.add(worker)

        def end() -> None:
            if worker in self._once_workers:
                self._once_workers.discard(worker)
                worker.close()
                worker.deleteLater()
                if not self.busy:
                    self.all_idle.emit()

        if done is not None:
            worker.finished.connect(done)
        worker.failed.connect(self.problem)
        if failed is not None:
            worker.failed.connect(lambda _: failed())
        worker.idle.connect(end)
        worker.submit(request)

    def _workers(self) -> list[Worker]:
        columns = [runtime.worker for runtime in self._runtimes.values()]
        return [*columns, *self._leaving, self._exemplar_worker, self._warming, *self._once_workers]

    def leave(self) -> None:
        """Ask every thread to end, without waiting."""
        self._refresh.stop()
        self._warmth.close()
        for worker in self._workers():
            worker.leave()

    def close(self) -> None:
        """Stop and join every thread; they end side by side."""
        self.leave()
        for worker in self._workers():
            worker.close()
        self._runtimes.clear()
        self._once_workers.clear()
        self._leaving.clear()

    # The session has changed.

    def _session_changed(self, before: State, after: State) -> None:
        changes = difference(before, after)
        for column_id in changes.removed:
            self._let_go(self._runtimes.pop(column_id).worker)
        for column_id in changes.added:
            self._add_runtime(column_id)
        if changes.sample or changes.added:
            self._wish(after)
        if changes.sample:
            self._prepare(after.sample)
        elif self._prepared is not None:
            for column_id in changes.run:
                self._start(column_id, draft=self._dragging)
        self._refresh.start()

    def _let_go(self, worker: Worker) -> None:
        """End a worker without waiting: the window must not stand still while its column comes to a stop."""
        worker.leave()
        for ended in [each for each in self._leaving if each.ended]:
            self._leaving.remove(ended)
            ended.deleteLater()
        self._leaving.append(worker)

    def _add_runtime(self, column_id: int) -> None:
        column = self._column(column_id)
        worker = Worker(f"column-{column_id}", self._slots, self)
        method = find_method(column.method)
        scene = ColumnScene(column_id, method.id, method.title, column.params, inputs=column.inputs)
        runtime = _Runtime(worker, scene)
        self._runtimes[column_id] = runtime
        worker.started.connect(lambda _: self._run_started(column_id))
        worker.progressed.connect(partial(self._run_progressed, column_id))
        worker.finished.connect(partial(self._run_finished, column_id))
        worker.failed.connect(partial(self._run_failed, column_id))
        worker.cancelled.connect(lambda: self._run_cancelled(column_id))

    def _column(self, column_id: int) -> Column:
        column = self.session.state.column(column_id)
        assert column is not None
        return column

    def _prepare(self, sample: Sample | None) -> None:
        self._cropping = self._dragging
        for column_id, runtime in self._runtimes.items():
            # While the box is dragged, the drafts on their way are still worth seeing.
            if not self._cropping:
                runtime.worker.cancel()
                self._set(column_id, status="idle" if sample is None else "waiting", message="", result=None)
        self._preparing = sample is not None
        if sample is None:
            self._exemplar_worker.cancel()
            self._prepared = None
            return
        before = self._prepared
        self._exemplar_worker.submit(lambda task: prepare(sample, before), patient=self._cropping)

    def _exemplar_prepared(self, prepared: Prepared) -> None:
        self._prepared = prepared
        self._preparing = self._exemplar_worker.behind
        self.exemplar_ready.emit(prepared)
        if self._cropping or not self._preparing:
            for column in self.session.state.columns:
                self._start(column.id, draft=self._cropping)
        self._refresh.start()

    def _exemplar_failed(self, sentence: str) -> None:
        self._preparing = False
        # Nothing may run on the exemplar from before.
        self._prepared = None
        self.problem.emit(sentence)
        for column_id in self._runtimes:
            self._set(column_id, status="failed", message=sentence, result=None, draft=False)

    def _start(self, column_id: int, *, draft: bool, state: Callable[[], Mapping[str, Any]] | None = None) -> None:
        runtime = self._runtimes.get(column_id)
        if runtime is None or self._prepared is None or (self._preparing and not draft):
            return
        column = self._column(column_id)
        session = self.session.state
        exemplar = self._prepared.exemplar
        method = find_method(column.method)
        full = column.size or session.size
        # What is filled keeps its size: a smaller start image would be another job.
        size = draft_size(full, runtime.seconds) if draft and column.size is None else None
        own_draft = size is not None and method.draft is not None
        # Within a drag every picture is finished, or none would be while the events come faster than they.
        patient, runtime.drafted = draft and runtime.drafted, draft
        # Where pictures come as fast as events, the column stays as it is until the next one is there.
        runtime.live = draft and size is None and runtime.scene.status == "finished"

        def make_job() -> Job:
            inputs = with_exemplar(exemplar, column.inputs)
            if state is not None:
                inputs["state"] = ArraysInput(state(), "state")
            return Job(
                method=column.method,
                inputs=inputs,
                params=column.params,
                size=full if own_draft or size is None else size,
                seed=session.seed,
            )

        changes: dict[str, Any] = {"method": method.id, "title": method.title}
        changes |= {"params": column.params, "inputs": column.inputs}
        if not runtime.live:
            changes |= {
                "status": "waiting",
                "message": "",
                "fraction": 0.0,
                "result": runtime.scene.result if draft else None,
                "frames": runtime.scene.frames if draft else (),
                "metrics": {},
                "draft": size is not None,
                "elapsed_s": 0.0,
            }
        self._set(column_id, **changes)
        loading = Loading(self._warmth, Need(method.id, exemplar.channels))
        if own_draft:
            runtime.worker.submit(DraftRun(make_job), patient=patient, first=loading)
        else:
            runtime.run = ColumnRun(make_job, self._cache, draft=draft)
            runtime.worker.submit(runtime.run, patient=patient, first=loading)

    # The workers report.

    def _set(self, column_id: int, **changes: Any) -> None:
        runtime = self._runtimes.get(column_id)
        if runtime is not None:
            changes["resumable"] = runtime.kept is not None
            runtime.scene = dataclasses.replace(runtime.scene, **changes)
            self._refresh.start()

    def _run_started(self, column_id: int) -> None:
        runtime = self._runtimes[column_id]
        runtime.started_at = time.perf_counter()
        if not runtime.live:
            self._set(column_id, status="running", message="")

    def _run_progressed(self, column_id: int, report: Progress | Waits) -> None:
        if isinstance(report, Waits):
            self._set(column_id, message=report.reason)
            return
        changes: dict[str, Any] = {
            "fraction": report.fraction,
            "message": report.message,
            "metrics": report.metrics,
            "frames": report.frames,
            "elapsed_s": report.elapsed_s,
        }
        if report.picture is not None:
            changes |= {"picture": report.picture, "image": report.image}
        self._set(column_id, **changes)

    def _run_finished(self, column_id: int, end: Finished | Drafted) -> None:
        runtime = self._runtimes[column_id]
        behind = runtime.worker.behind
        status = "waiting" if behind and not runtime.live else "finished"
        runtime.live = runtime.live and behind
        if isinstance(end, Drafted):
            shown = {"picture": end.picture, "image": end.image, "result": None, "draft": True}
            self._set(column_id, status=status, message="", **shown)
            return
        # A draft tells as well how long the full size would take: the time grows with the area.
        drawn = end.result.image.shape[0] * end.result.image.shape[1]
        runtime.seconds = end.result.elapsed_s * max(1.0, math.prod(self.session.state.size) / drawn)
        if not end.draft:
            runtime.kept = runtime.run.state if runtime.run is not None else None
        changes: dict[str, Any] = {
            "status": status,
            "message": "",
            "fraction": 1.0,
            "picture": end.picture,
            "image": end.result.image,
            "draft": end.draft and drawn < math.prod(self.session.state.size),
            "elapsed_s": end.result.elapsed_s,
            "result": end.result,
            "metrics": end.metrics,
        }
        if not end.draft:
            changes["frames"] = end.frames
        self._set(column_id, **changes)

    def _run_failed(self, column_id: int, sentence: str) -> None:
        self._runtimes[column_id].live = False
        self._set(column_id, status="failed", message=sentence, result=None, draft=False, picture=None, image=None)

    def _run_cancelled(self, column_id: int) -> None:
        self._runtimes[column_id].live = False
        self._set(column_id, status="cancelled", message="", draft=False)

    def _wish(self, state: State) -> None:
        """Begin to load what the columns are about to need, in their order; most exemplars are coloured."""
        channels = state.sample.source.channels if state.sample is not None else 3
        self._warmth.wish(Need(column.method, channels) for column in state.columns)

    def _load_the_rest(self) -> None:
        """Load what no column needs, once all of them have what they need."""
        if self._prepared is not None:
            self.all_idle.disconnect(self._load_the_rest)
            self._warmth.wish(every_need())

    def _announce(self) -> None:
        self.scene_changed.emit(self.scene())
        if not self.busy:
            self.all_idle.emit()


def prepare(sample: Sample, before: Prepared | None) -> Prepared:
    """Scale and crop a sample (in a worker's thread); the scaled source is taken over when it is the same."""
    from texlab_core.images import as_exemplar

    scaled = as_exemplar(sample.source, scale=sample.scale) if sample.scale != 1.0 else sample.source
    if before is not None and before.source_scaled.sha256 == scaled.sha256:
        picture = before.source_picture
    else:
        picture = to_picture(scaled.pixels)
    exemplar = scaled
    if sample.crop is not None:
        exemplar = as_exemplar(sample.source, scale=sample.scale, crop=sample.crop)
    return Prepared(exemplar, picture, scaled)


def rescaled(sample: Sample, scale: float) -> Sample:
    """Return the sample at another scale with its crop over the same part of the picture."""
    from texlab_core.images import scaled_size
    from texlab_core.inputs import Crop

    crop = sample.crop
    if crop is not None:
        factor = scale / sample.scale
        height, width = scaled_size(*sample.source.size, scale)
        rows = min(max(round(crop.height * factor), 2), height)
        columns = min(max(round(crop.width * factor), 2), width)
        top = min(round(crop.top * factor), height - rows)
        left = min(round(crop.left * factor), width - columns)
        crop = Crop(top, left, rows, columns)
    return dataclasses.replace(sample, scale=scale, crop=crop)
