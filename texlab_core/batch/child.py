"""What runs in each of several processes. Imports come late: NumPy reads the environment when it is loaded."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
from collections import OrderedDict
from multiprocessing.util import Finalize
from pathlib import Path
from typing import TYPE_CHECKING, Any

from texlab_core.work.threads import SUM_VARIABLES

if TYPE_CHECKING:
    from multiprocessing.synchronize import Event

    import numpy as np

    from texlab_core.batch.orders import Order, Outcome
    from texlab_core.batch.parcels import Parcel

SOURCES_KEPT = 2


class _Here:
    """What one of the processes keeps."""

    def __init__(self, stop: Event, folder: Path) -> None:
        from texlab_core.batch.orders import Workbench

        self.stop = stop
        self.folder = folder
        self.bench = Workbench()
        self.parcels: OrderedDict[str, Parcel] = OrderedDict()

    def parcel(self, name: str) -> Parcel:
        """Return a parcel, read from the folder unless it is one of the last."""
        import numpy as np

        if name not in self.parcels:
            with np.load(self.folder / f"{name}.npz", allow_pickle=False) as arrays:
                self.parcels[name] = {key: _sealed(arrays[key]) for key in arrays.files}
            while len(self.parcels) > SOURCES_KEPT:
                self.parcels.popitem(last=False)
        return self.parcels[name]


def _sealed(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    array.flags.writeable = False
    return array


_here: list[_Here] = []


def start(stop: Event, begun: Event, folder: str) -> None:
    """Prepare a process: Ctrl-C is for the one that started it, and it ends when that one does.

    Parameters
    ----------
    stop
        Set when what runs shall end.
    begun
        Set by the first process that comes so far.
    folder
        Where inputs lie.
    """
    begun.set()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True, name="texlab-parent").start()
        # After whatever else is done at the end.
        Finalize(None, _leave, exitpriority=-(2**31))
    # There is a process for each core already.
    os.environ.update(dict.fromkeys(SUM_VARIABLES, "1"))
    with contextlib.suppress(ImportError):
        import cv2

        cv2.setNumThreads(1)
    _here.append(_Here(stop, Path(folder)))
    # What every job needs is loaded while the first input is on its way.
    import texlab_core.batch.pictures  # noqa: F401
    from texlab_core.findings.registry import detectors
    from texlab_core.measures.registry import measures

    measures(), detectors()


def _leave() -> None:
    """End without taking the interpreter apart, which takes longer than a job and is all for nothing."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(AttributeError, OSError, ValueError):
            stream.flush()
    os._exit(0)


def be_ready() -> None:
    """Be asked for, so that the process starts."""


def _end_with(sentinel: int) -> None:
    from multiprocessing.connection import wait as wait_for

    wait_for([sentinel])
    os._exit(1)


def carry_out(order: Order) -> Outcome:
    """Run an order with what lies in the folder."""
    here = _here[-1]
    parcels = {name: here.parcel(name) for name in order.parcels}
    return here.bench.carry_out(order, parcels, here.stop.is_set)
