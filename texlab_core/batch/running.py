"""A plan from its start to its report; and jobs without a plan."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import time
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from texlab_core.batch.folder import BatchFolder
from texlab_core.batch.forecast import Forecast
from texlab_core.batch.further import load_further
from texlab_core.batch.orders import Outcome, make_order
from texlab_core.batch.parcels import Packer
from texlab_core.batch.pictures import finish, thumbnail
from texlab_core.batch.places import InProcess, Place
from texlab_core.batch.processes import Processes
from texlab_core.batch.report import write_report
from texlab_core.batch.rows import Row, Rows
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_text, size_to_json
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Iterator, Mapping

    from texlab_core.batch.choices import ExemplarChoice
    from texlab_core.batch.places import Loaded, ShouldStop
    from texlab_core.batch.plan import Plan, SizeRule, Variant
    from texlab_core.engine.inputs import ImageInput, Input
    from texlab_core.engine.result import Result


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a batch is.

    Parameters
    ----------
    done
        Jobs that are done: made now, or found from an earlier run.
    failed, total
        Jobs that failed, and all there are.
    remaining_s
        How long the rest will take, in seconds; None while that cannot be told.
    error
        When a job has just failed: which, and why.
    """

    done: int
    failed: int
    total: int
    remaining_s: float | None = None
    error: str = ""

    @property
    def fraction(self) -> float:
        """Share of the jobs that are over, 0 to 1."""
        return (self.done + self.failed) / self.total if self.total else 1.0


@dataclass(frozen=True)
class BatchResult:
    """What a batch came to.

    Parameters
    ----------
    made, found, failed
        Jobs that were run now, that were done already, and that failed.
    repeated
        Jobs that the plan asks for more than once; they were made once.
    rows
        One for each job, in the order of the plan; read from the folder when it is wanted.
    page, table
        The report's files.
    elapsed_s
        Wall time in seconds.
    """

    made: int
    found: int
    failed: int
    repeated: int
    rows: Rows
    page: str
    table: str
    elapsed_s: float


def run_batch(
    plan: Plan,
    out: str | os.PathLike[str],
    *,
    place: Place | None = None,
    sample: int | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    should_stop: ShouldStop | None = None,
) -> BatchResult:
    """Run what a plan asks for and is not done yet.

    Every job's files are written as soon as it is finished. What goes wrong with one job is listed, and the others
    go on. The same plan gives the same files whatever the place, however often it was interrupted; only
    ``times.csv`` differs.

    Parameters
    ----------
    plan
        What to do.
    out
        Folder for pictures, records and report; see :class:`texlab_core.batch.folder.BatchFolder`.
    place
        Where to run; None takes this process.
    sample
        Run only so many jobs, spread evenly over the plan.
    on_progress
        Called in this thread whenever a job is over.
    should_stop
        Asked many times a second.

    Returns
    -------
    BatchResult
        With the paths of the report.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so; what was done stays, and is found by the next run.
    InputError
        When the folder cannot be used.
    """
    place = InProcess() if place is None else place
    with BatchFolder(out) as folder:
        if isinstance(place, Processes) and place.scratch is None:
            place = Processes(place.width, folder.scratch)
        run = _Run(plan, folder, place, sample, on_progress)
        if isinstance(place, Processes) and not folder.has_records:
            place.begin(run.total)
        return run.result(should_stop)


class _Run:
    """One run of a plan."""

    def __init__(
        self,
        plan: Plan,
        folder: BatchFolder,
        place: Place,
        sample: int | None,
        on_progress: Callable[[Progress], None] | None,
    ) -> None:
        self.plan, self.folder, self.place = plan, folder, place
        # What is kept of a result is part of what it is known by.
        self.kept: dict[str, Any] = {"bits": plan.bits, "measures": plan.measures}
        self.finish = partial(finish, **self.kept)
        self.only = None if sample is None else plan.sample(sample)
        self.total = plan.count if self.only is None else len(self.only)
        self.on_progress = on_progress
        self.forecast = Forecast(self.total)
        # One row for each place in the plan; a job that is asked for twice has its first place.
        self.rows = Rows(folder.record)
        self.waiting: dict[str, tuple[int, str, dict[str, Any]]] = {}
        self.places: dict[str, int] = {}
        self.further: dict[str, Mapping[str, Input] | InputError] = {}
        self.made = self.found = self.failed = self.repeated = 0

    def result(self, should_stop: ShouldStop | None) -> BatchResult:
        start = time.monotonic()
        try:
            with contextlib.closing(self.place.run(self._orders(), should_stop)) as outcomes:
                for outcome in outcomes:
                    self._keep(outcome)
        finally:
            page, table = write_report(self.folder, self.plan, self.rows, self.total - self.repeated)
        return BatchResult(
            made=self.made,
            found=self.found,
            failed=self.failed,
            repeated=self.repeated,
            rows=self.rows,
            page=str(page),
            table=str(table),
            elapsed_s=time.monotonic() - start,
        )

    def _orders(self) -> Iterator[Loaded]:
        """Yield what is to be done, one exemplar after the other, and settle what is done or cannot work."""
        packer = Packer()
        whole: tuple[str, ImageInput] | None = None
        for number, choice in enumerate(self.plan.exemplars):
            jobs = [each for each in self._jobs_of(number) if self.only is None or each[0] in self.only]
            if not jobs:
                continue
            try:
                if whole is None or whole[0] != choice.source:
                    # Let go of the last one first: scans are large.
                    whole = None
                    whole = choice.source, choice.load_whole()
                exemplar = choice.load(whole[1])
            except InputError as error:
                self._fail_all(choice, jobs, str(error).replace(choice.source, choice.name))
                continue
            yield from self._orders_of(choice, exemplar, jobs, packer)

    def _orders_of(
        self,
        choice: ExemplarChoice,
        exemplar: ImageInput,
        jobs: list[tuple[int, Variant, int, SizeRule]],
        packer: Packer,
    ) -> Iterator[Loaded]:
        small = self.folder.keep_exemplar(exemplar.sha256)
        if small is None:
            small = self.folder.keep_exemplar(exemplar.sha256, thumbnail(exemplar.pixels))
        for place, variant, seed, rule in jobs:
            about = _about(choice, variant, seed, rule.text, exemplar) | {"exemplar_thumbnail": small}
            try:
                size = rule.of(exemplar.size, find_method(variant.method).dimensions)
                about["size"] = size_to_json(size)
                further = self._further_of(variant)
                if further:
                    about["inputs"] = {
                        role: {"name": each.name, "sha256": each.sha256} for role, each in further.items()
                    }
                job = Job(
                    method=variant.method,
                    inputs={**further, "exemplar": exemplar},
                    params=variant.params,
                    size=size,
                    seed=seed,
                )
            except InputError as error:
                self._fail(place, about, str(error))
                continue
            order, parcels = make_order(job, self.finish, packer, called=about["input"], **self.kept)
            if order.key in self.places:
                self.repeated += 1
                self.forecast.drop()
                continue
            self.places[order.key] = place
            if (record := self.folder.done(order.key)) is not None:
                self.found += 1
                self._settle(place, Row.of(record))
                self.forecast.drop()
                continue
            name = os.path.splitext(choice.name.removeprefix("gallery:"))[0]
            stem = f"{name}-{variant.name}-{size_text(size, 'x')}-{seed}"
            self.waiting[order.key] = (place, stem, about)
            yield order, parcels

    def _further_of(self, variant: Variant) -> Mapping[str, Input]:
        """Return the further inputs of a variant, read when they are first needed; raises ``InputError``."""
        found = self.further.get(variant.name)
        if found is None:
            try:
                found = load_further(variant.inputs, find_method(variant.method))
            except InputError as error:
                found = error
            self.further[variant.name] = found
        if isinstance(found, InputError):
            raise found
        return found

    def _jobs_of(self, number: int) -> Iterator[tuple[int, Variant, int, SizeRule]]:
        place = number * (self.plan.count // len(self.plan.exemplars))
        for variant in self.plan.variants:
            for size in self.plan.sizes:
                for seed in self.plan.seeds:
                    yield place, variant, seed, size
                    place += 1

    def _keep(self, outcome: Outcome) -> None:
        place, stem, about = self.waiting.pop(outcome.key)
        self.forecast.add()
        if outcome.error:
            self._fail(place, about, outcome.error, counted=True)
            return
        record = self.folder.keep(outcome.key, stem, outcome.value, about, outcome.elapsed_s)
        self.made += 1
        self._settle(place, Row.of(record))

    def _fail_all(
        self, choice: ExemplarChoice, jobs: list[tuple[int, Variant, int, SizeRule]], error: str
    ) -> None:
        """Settle every job of an exemplar that cannot be had, and say it once."""
        for place, variant, seed, size in jobs:
            self.failed += 1
            self.forecast.drop()
            self.rows.add(place, Row.failed(_about(choice, variant, seed, size.text, None), error))
        part = f" ({choice.part})" if choice.part else ""
        # An exemplar is called by its file's name alone.
        plain = error.removeprefix(f"{os.path.basename(choice.source)}: ")
        said = error if error.startswith(choice.name) else f"{choice.name}{part}: {plain}"
        self._tell(f"{said} {len(jobs)} jobs need it." if len(jobs) > 1 else said)

    def _fail(self, place: int, about: dict[str, Any], error: str, *, counted: bool = False) -> None:
        self.failed += 1
        if not counted:
            self.forecast.drop()
        row = Row.failed(about, error)
        self._settle(place, row, f"{row.title}: {error}")

    def _settle(self, place: int, row: Row, error: str = "") -> None:
        self.rows.add(place, row)
        self._tell(error)

    def _tell(self, error: str) -> None:
        if self.on_progress is not None:
            done = self.made + self.found + self.repeated
            self.on_progress(Progress(done, self.failed, self.total, self.forecast.remaining_s, error))


def _about(
    choice: ExemplarChoice, variant: Variant, seed: int, size: str, exemplar: ImageInput | None
) -> dict[str, Any]:
    """Return what a job is, as records and reports have it."""
    about: dict[str, Any] = {
        "input": choice.name,
        "part": choice.part,
        "variant": variant.name,
        "method": variant.method,
        "parameters": variant.params.to_json(),
        "seed": seed,
        "size_rule": size,
    }
    if exemplar is not None:
        height, width = exemplar.size
        about["exemplar"] = {"sha256": exemplar.sha256, "size": {"width": width, "height": height}}
    return about


def run_jobs(
    jobs: Iterable[Job],
    *,
    place: Place | None = None,
    finish: Callable[[Result], Any] | None = None,
    should_stop: ShouldStop | None = None,
) -> Generator[tuple[int, Outcome], None, None]:
    """Run jobs anywhere, and yield the outcome of each with its number, in the order of finishing.

    Parameters
    ----------
    jobs
        Taken one by one as there is room.
    place
        Where to run; None takes this process.
    finish
        A function of a module that makes of each result what is sent back; None sends the result without its
        model, maps and details.
    should_stop
        Asked many times a second.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    """
    packer = Packer()
    make = without_evidence if finish is None else finish

    def orders() -> Iterator[Loaded]:
        for number, job in enumerate(jobs):
            order, parcels = make_order(job, make, packer)
            yield dataclasses.replace(order, key=f"{number}-{order.key}"), parcels

    with contextlib.closing((InProcess() if place is None else place).run(orders(), should_stop)) as outcomes:
        for outcome in outcomes:
            number, _, key = outcome.key.partition("-")
            yield int(number), dataclasses.replace(outcome, key=key)


def without_evidence(result: Result) -> Result:
    """Return a result as it travels: picture, curves and measures."""
    return dataclasses.replace(result, model=None, maps={}, details=None, job=None)  # type: ignore[arg-type]
