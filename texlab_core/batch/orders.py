"""A job that can travel, and what comes back from it."""

from __future__ import annotations

import hashlib
import json
import logging
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab_core.batch.parcels import Packer, Parcel, Slip, Unpacked
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run, versions
from texlab_core.errors import Cancelled, InputError
from texlab_core.work.threads import sums_in_one_thread

if TYPE_CHECKING:
    from texlab_core.engine.result import Result

Finish = Callable[["Result"], Any]
log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Order:
    """One job in pieces that can be pickled.

    Parameters
    ----------
    key
        Tells it from every other one: the SHA-256 of everything that its result depends on, versions of the
        libraries included, and of what else :func:`make_order` was given.
    method, params, size, seed
        Of the job; the parameters as JSON data.
    slips
        Its inputs by role.
    versions
        Of the libraries where it was made. A place with others refuses it: the bits could differ.
    finish
        A function of a module (or a ``partial`` of one) that makes of the result what is sent back.
    """

    key: str
    method: str
    params: Mapping[str, Any]
    size: tuple[int, ...]
    seed: int
    slips: Mapping[str, Slip]
    versions: Mapping[str, str]
    finish: Finish

    @property
    def parcels(self) -> tuple[str, ...]:
        """The hashes of the parcels it needs."""
        return tuple(sorted({slip.parcel for slip in self.slips.values() if slip.parcel}))

    @property
    def subject(self) -> str:
        """What most of the work is about: the hash of the exemplar, of all inputs where there is none."""
        slip = self.slips.get("exemplar")
        return " ".join(sorted(each.sha256 for each in self.slips.values())) if slip is None else slip.sha256


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of an order.

    Parameters
    ----------
    key
        Of the order.
    value
        What ``finish`` returned; None when it failed.
    error
        Why it failed, one sentence; empty when it did not.
    elapsed_s
        Wall time in seconds where it was carried out.
    """

    key: str
    value: Any = None
    error: str = ""
    elapsed_s: float = 0.0


def _hash(job: Job, slips: Mapping[str, Slip], more: Mapping[str, object]) -> str:
    inputs = {}
    for role, slip in slips.items():
        crop = slip.crop and [slip.crop.top, slip.crop.left, slip.crop.height, slip.crop.width]
        inputs[role] = [slip.name, slip.sha256, slip.scale, crop]
    content = {
        "method": job.method,
        "params": job.params.to_json(),
        "size": list(job.size),
        "seed": job.seed,
        "inputs": inputs,
        "versions": dict(versions()),
        "more": dict(more),
    }
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def make_order(
    job: Job, finish: Finish, packer: Packer | None = None, **more: object
) -> tuple[Order, Mapping[str, Parcel]]:
    """Return a job as an order, and the parcels it needs.

    Parameters
    ----------
    job
        The job.
    finish
        See :class:`Order`.
    packer
        Shared by jobs whose inputs share a source.
    **more
        What else its key shall depend on, as JSON data: how many bits are saved, say.
    """
    slips, parcels = (Packer() if packer is None else packer).pack(job.inputs)
    order = Order(
        key=_hash(job, slips, more),
        method=job.method,
        params=job.params.to_json(),
        size=job.size,
        seed=job.seed,
        slips=slips,
        versions=dict(versions()),
        finish=finish,
    )
    return order, parcels


class Workbench:
    """What one process keeps between orders: unpacked inputs and analyses, of the last few exemplars only."""

    def __init__(self, *, models: int = 4, max_bytes: int = 2**28) -> None:
        self.cache = AnalysisCache(models, max_bytes)
        self._unpacked = Unpacked()
        self._lock = threading.Lock()

    def carry_out(
        self,
        order: Order,
        parcels: Mapping[str, Parcel],
        should_stop: Callable[[], bool] | None = None,
        *,
        threads: int | None = 1,
    ) -> Outcome:
        """Run an order; whatever goes wrong becomes a sentence.

        Raises
        ------
        Cancelled
            When ``should_stop`` said so.
        """
        start = time.perf_counter()
        try:
            _check_versions(order)
            method = find_method(order.method)
            # Every place takes sums in the same order.
            with sums_in_one_thread():
                with self._lock:
                    inputs = {role: self._unpacked.get(slip, parcels) for role, slip in order.slips.items()}
                job = Job(
                    method=order.method,
                    inputs=inputs,
                    params=method.params.from_json(order.params),
                    size=order.size,
                    seed=order.seed,
                )
                result = run(job, should_stop=should_stop, cache=self.cache, threads=threads)
                finished = order.finish(result)
            return Outcome(order.key, finished, elapsed_s=time.perf_counter() - start)
        except Cancelled:
            raise
        except InputError as error:
            sentence = str(error)
        except MemoryError:
            sentence = "There is not enough memory for this; try a smaller size."
        except Exception as error:
            log.exception("A job of a batch failed")
            sentence = f"Something unexpected happened ({type(error).__name__}: {' '.join(str(error).split())})."
        return Outcome(order.key, error=sentence, elapsed_s=time.perf_counter() - start)


def _check_versions(order: Order) -> None:
    here = versions()
    for name, sent in order.versions.items():
        if here.get(name) != sent:
            raise InputError(
                f"The place where this should run has {name} {here.get(name, 'missing')}, and the batch was "
                f"started with {sent}; with different versions the bits could differ."
            )
