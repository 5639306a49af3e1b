"""A column at work: its thread, what it shows, and where it can go on."""

from __future__ import annotations

import dataclasses
import math
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from texlab.runs.column_run import (
    BROKEN,
    ColumnRun,
    Drafted,
    DraftRun,
    Finished,
    Loading,
    Measured,
    MeasureRun,
    Progress,
    Stored,
    Waits,
    job_of,
    key_of,
)
from texlab.runs.drafts import draft_size
from texlab.runs.kept_points import KeptPoints
from texlab.runs.kept_results import KeptResults
from texlab.runs.measurer import Measurer
from texlab.runs.past import measured, past_of, remembered
from texlab.runs.slots import Rank, Slots
from texlab.runs.worker import Worker
from texlab.state.scene import ColumnScene
from texlab_core.engine.registry import find_method
from texlab_core.measures.subject import PreparedCache
from texlab_core.warming import Need, Warmth

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab.runs.column_run import Keep
    from texlab.state.chosen import Column, State
    from texlab.state.scene import Past
    from texlab.style.pictures import Picture
    from texlab_core.engine.cache import AnalysisCache
    from texlab_core.engine.inputs import ImageInput


@dataclasses.dataclass(frozen=True, eq=False)
class Shared:
    """What all columns share: places, analyses, what is loaded, measured parts of exemplars, what has finished."""

    slots: Slots
    cache: AnalysisCache
    warmth: Warmth
    prepared: PreparedCache = dataclasses.field(default_factory=PreparedCache)
    kept: KeptResults = dataclasses.field(default_factory=KeptResults)
    points: KeptPoints = dataclasses.field(default_factory=KeptPoints)


class ColumnRunner(QObject):
    """Runs one column, the newest job instead of any other, and keeps what it shows; ``changed()`` tells of it."""

    changed = Signal()

    def __init__(self, column: Column, shared: Shared, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._shared = shared
        method = find_method(column.method)
        self.scene = ColumnScene(column.id, method.id, method.title, column.params, inputs=column.inputs)
        self.label(column)
        self.seconds: float | None = None
        """What the full size takes, as far as that is known."""
        self.drafted = False
        """Whether the newest job is a draft."""
        self._full: tuple[int, ...] = (1, 1)  # of the newest job, as the session has it
        # Where pictures come as fast as events, the column stays as it is until the next one is there.
        self._live = False
        self._run: ColumnRun | None = None
        self._kept: Keep | None = None
        self._exemplar: ImageInput | None = None
        # Method and exemplar of the newest job.
        self._origin: tuple[str, str] | None = None
        self.worker = Worker(f"column-{column.id}", shared.slots, self)
        self.worker.started.connect(lambda _: self._started())
        self.worker.progressed.connect(self._progressed)
        self.worker.finished.connect(self._finished)
        self.worker.failed.connect(self._failed)
        self.worker.cancelled.connect(self._cancelled)
        self.measurer = Measurer(f"measures-{column.id}", shared.slots, self)
        self.measurer.told.connect(self._show_measures)
        self.measurer.came.connect(self._measures_came)
        self.measurer.failed.connect(lambda: self._show(unexamined=BROKEN))

    def show_stored(self, picture: Picture, measures: Mapping[str, float]) -> None:
        """Show the picture of an earlier result with its numbers until there is another one."""
        if self.scene.picture is None:
            size = (picture.shape[0], picture.shape[1]) if measures else None
            self._show(picture=picture, measures=measures, measured_size=size)

    def remember(self, history: tuple[Past, ...]) -> None:
        """Put earlier results before those of the history."""
        for past in self.scene.history:
            history = remembered(history, past)
        self._show(history=history)

    @property
    def running(self) -> bool:
        """Whether a job waits or runs, and can be stopped."""
        return self.scene.status in ("waiting", "running")

    @property
    def busy(self) -> bool:
        """Whether a picture is on its way, also one for which the column does not show that it runs."""
        return self._live or self.running

    @property
    def resumable(self) -> bool:
        """Whether there is a place to go on from."""
        return self._kept is not None

    @property
    def measuring(self) -> bool:
        """Whether the numbers about the picture are still to come."""
        return self.measurer.busy

    # What it is asked for.

    def start(
        self,
        column: Column,
        state: State,
        exemplar: ImageInput,
        *,
        draft: bool = False,
        go_on: bool = False,
        alone: bool = False,
        asked: bool = False,
    ) -> None:
        """Run the column's job of this state: as a draft, or going on from where it came to an end.

        What is asked of this column ``alone`` goes before what all of them have to do. When the user has ``asked``
        for a run, a result from the disk is made again: what explains it is not there.
        """
        method = find_method(column.method)
        full = state.size_of(column)
        self._full = full
        origin = method.id, exemplar.sha256
        if origin != self._origin:
            # Where another method stood, or the same on another exemplar, is no place to go on from.
            self._origin, self._kept = origin, None
        # What is filled keeps its size: a smaller start image would be another job.
        smaller = draft and (column.size is None or method.dimensions == 3)
        size = draft_size(full, self.seconds) if smaller else None
        own_draft = size is not None and method.draft is not None
        # Within a drag every picture is finished, or none would be while the events come faster than they.
        patient, self.drafted = draft and self.drafted, draft
        self._exemplar = exemplar
        if not (draft and self.measurer.overdue):
            self.measurer.stop()
        self._live = draft and size is None and self.scene.status == "finished"
        self._announce(column, small=size is not None)
        make_job = partial(
            job_of,
            column,
            state,
            exemplar,
            size=None if own_draft else size,
            kept=self._kept if go_on else None,
        )
        kept = None if draft or go_on else self._shared.kept.get(key_of(column, state, exemplar))
        if kept is not None and not (asked and kept.stored):
            # The same job has the same bits: what was finished is shown, before anything else takes a place.
            self._run = None
            self.worker.submit(lambda task: kept, rank=Rank.DRAFT)
            return
        loading = Loading(self._shared.warmth, Need(method.id, exemplar.channels))
        rank = Rank.DRAFT if draft else Rank.CHANGED if alone else Rank.REST
        if own_draft:
            self._run = None
            self.worker.submit(DraftRun(make_job), patient=patient, first=loading, rank=rank)
        else:
            self._run = ColumnRun(make_job, self._shared.cache, draft=draft)
            look = not (draft or go_on or asked)
            first = Stored(make_job, self._shared.kept.read, loading) if look else loading
            self.worker.submit(self._run, patient=patient, first=first, rank=rank)

    def _announce(self, column: Column, *, small: bool) -> None:
        changes: dict[str, Any] = {
            "method": column.method,
            "title": find_method(column.method).title,
            "params": column.params,
            "inputs": column.inputs,
            "size": self._full,
        }
        if not self._live:
            changes |= {
                "status": "waiting",
                "message": "",
                "fraction": 0.0,
                "result": self.scene.result if self.drafted else None,
                "frames": self.scene.frames if self.drafted else (),
                "metrics": {},
                "measures": self.scene.measures if self.drafted else {},
                "findings": None,
                "unexamined": "",
                "draft": small,
                "elapsed_s": 0.0,
            }
        self._show(**changes)

    def label(self, column: Column) -> None:
        """Show what decides no pixels: name, pin, whose seed it is."""
        labels = {"name": column.name, "pinned": column.pinned, "seed": column.seed}
        if any(getattr(self.scene, name) != value for name, value in labels.items()):
            self.scene = dataclasses.replace(self.scene, **labels)  # type: ignore[arg-type]
            self.changed.emit()

    def stop(self) -> None:
        """Stop; it can go on from there where the method knows how."""
        if self.running:
            if self._run is not None and self._run.state is not None:
                self._kept = self._run.state
            self.worker.cancel()

    def await_exemplar(self, coming: bool) -> None:
        """Stop because of another exemplar; the column waits for it, or is idle when there is none."""
        self.worker.cancel()
        self.measurer.stop()
        self._show(status="waiting" if coming else "idle", message="", result=None)

    def has_finished(self, column: Column, state: State, exemplar: ImageInput) -> bool:
        """Return whether the result of this very job is still there."""
        return self._shared.kept.get(key_of(column, state, exemplar)) is not None

    def hold(self, column: Column, size: tuple[int, ...], sentence: str) -> None:
        """Take a column's settings, and say what its run would take; it starts when the user asks for it."""
        self.worker.cancel()
        self.measurer.stop()
        self._full = size
        self._announce(column, small=False)
        self._show(status="idle", message=sentence, result=None, draft=False)

    def fail(self, sentence: str) -> None:
        """Say why there is nothing to run."""
        self._show(status="failed", message=sentence, result=None, draft=False)

    # Its end.

    @property
    def ended(self) -> bool:
        """Whether the thread has ended."""
        return self.worker.ended and self.measurer.ended

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        self.worker.leave()
        self.measurer.leave()

    def forget(self) -> None:
        """Let go of the result, its run, and where it could go on: the column is shown no more."""
        self._run = self._kept = self._exemplar = None
        self.measurer.forget()
        gone = self.scene
        self.scene = ColumnScene(gone.id, gone.method, gone.title, gone.params)

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        self.worker.close()
        self.measurer.close()

    # The worker reports.

    def _show(self, **changes: Any) -> None:
        self.scene = dataclasses.replace(self.scene, resumable=self.resumable, **changes)
        self.changed.emit()

    def _started(self) -> None:
        if not self._live:
            self._show(status="running", message="")

    def _progressed(self, report: Progress | Waits) -> None:
        if isinstance(report, Waits):
            self._show(message=report.reason)
            return
        changes: dict[str, Any] = {
            "fraction": report.fraction,
            "message": report.message,
            "metrics": report.metrics,
            "frames": report.frames,
            "elapsed_s": report.elapsed_s,
        }
        if report.picture is not None:
            changes |= {"picture": report.picture, "image": report.image, "filled": report.filled}
        self._show(**changes)

    def _finished(self, end: Finished | Drafted) -> None:
        if not self.worker.behind:
            # What it made is in the end that it came to.
            self._run = None
        self._came(end)
        if self._known(end) is not None:
            # The same bits have the same numbers.
            self.measurer.stop()
            self._shared.points.note(self.scene)
            return
        if self._exemplar is None or (self.worker.behind and not self.measurer.overdue):
            return
        result, image = (None, end.image) if isinstance(end, Drafted) else (end.result, end.result.image)
        quick = self.scene.draft or self.drafted
        run = MeasureRun(image, self._exemplar, result, self._shared.prepared, quick)
        self.measurer.measure(run, dragged=self.drafted)

    # Numbers about the picture.

    def _known(self, end: Finished | Drafted) -> Measured | None:
        """Return the numbers of a finished result that was measured before."""
        if isinstance(end, Drafted) or end.draft:
            return None
        return self._shared.kept.measured(end.result.job.key)

    def _measures_came(self, end: Measured) -> None:
        run = self.measurer.present
        if run is not None and run.result is not None and not run.draft:
            self._shared.kept.note(run.result.job.key, end)
        history = self.scene.history
        if not self.scene.draft and self.scene.result is not None:
            history = measured(history, self.scene.result.job.key, end.measures)
        self._show_measures(end, findings=end.findings, unexamined=end.unexamined, history=history)

    def _show_measures(self, found: Measured, **more: Any) -> None:
        # While a control is dragged they may be about the picture before: shown, but kept of none.
        run = self.measurer.present
        same = run is not None and run.image is self.scene.image
        self._show(measures=found.measures, measured_size=found.size, **(more if same else {}))
        if same:
            self._shared.points.note(self.scene)

    def _came(self, end: Finished | Drafted) -> None:
        behind = self.worker.behind
        status = "waiting" if behind and not self._live else "finished"
        self._live = self._live and behind
        if isinstance(end, Drafted):
            shown = {"picture": end.picture, "image": end.image, "filled": None, "result": None, "draft": True}
            self._show(status=status, message="", findings=None, unexamined="", **shown)
            return
        # A draft tells as well how long the full size would take: the time grows with the number of samples.
        drawn = math.prod(end.result.job.size)
        self.seconds = end.result.elapsed_s * max(1.0, math.prod(self._full) / drawn)
        if not end.draft:
            self._kept = getattr(end.result.details, "state", None)
            self._shared.kept.put(end.result.job.key, end)
        changes: dict[str, Any] = {
            "status": status,
            "message": "",
            "fraction": 1.0,
            "picture": end.picture,
            "image": end.result.image,
            "filled": None,
            "draft": end.draft and drawn < math.prod(self._full),
            "elapsed_s": end.result.elapsed_s,
            "result": end.result,
            "stored": end.stored,
            "metrics": end.metrics,
            "findings": None,
            "unexamined": "",
        }
        if not end.draft:
            changes |= {"frames": end.frames, "measures": {}}
            history = remembered(self.scene.history, past_of(end.result.job, end.picture))
            if (known := self._known(end)) is not None:
                changes |= {"measures": known.measures, "measured_size": known.size}
                changes |= {"findings": known.findings, "unexamined": known.unexamined}
                history = measured(history, end.result.job.key, known.measures)
            changes["history"] = history
        self._show(**changes)

    def _failed(self, sentence: str) -> None:
        self._live = False
        self._show(status="failed", message=sentence, result=None, draft=False, picture=None, image=None)

    def _cancelled(self) -> None:
        self._live = False
        self._show(status="cancelled", message="", draft=False)
