"""A method of the tests' own: quick, with every kind of knob, and known answers."""

from __future__ import annotations

import sys
import threading
import time
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Annotated, Literal

import numpy as np
import pytest

from texlab_core.engine import registry
from texlab_core.engine.inputs import ImageInput, exemplar_of, hash_arrays
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.registry import Method
from texlab_core.engine.steps import Map, Output, Step
from texlab_core.errors import InputError


@dataclass(frozen=True, kw_only=True)
class StubParams(Params):
    level: Annotated[float, Knob(help="Gray level of the result", low=0, high=4)] = 0.5
    grain: Annotated[float, Knob(help="Nothing, over decades", low=0.001, high=1000, log=True)] = 1.0
    window: Annotated[int, Knob(help="An odd number", low=3, high=41, odd=True)] = 15
    rounds: Annotated[int, Knob(help="Steps", low=1, high=500)] = 2
    border: Annotated[Literal["reflect", "wrap"], Knob(help="Rule at the border")] = "reflect"
    exact: Annotated[bool, Knob(help="Exact")] = True
    detail: Annotated[int, Knob(help="Depth of the analysis", low=0, high=9, stage="analysis")] = 0


analyses: list[int] = []
# The threads in which results were begun; the one that loads methods in advance comes by when it likes.
running: list[int] = []
WARMING = "texlab-warming"
_lock = threading.Lock()


def analyze(inputs, params):
    yield Step(0, 1, "analysis")
    with _lock:
        analyses.append(params.detail)
    return params.detail


def synthesize(model, inputs, params, size, streams):
    if threading.current_thread().name != WARMING:
        with _lock:
            running.append(threading.get_ident())
    if params.level == 3.0:
        raise InputError("level: 3 is what this stub fails at.")
    for done in range(params.rounds):
        yield Step(done, params.rounds, f"round {done + 1}")
        time.sleep(0.002)
    noise = streams("noise").random((*size, exemplar_of(inputs).channels), np.float32)
    image = np.clip(np.float32(params.level / 4) + (noise - np.float32(0.5)) * np.float32(0.1), 0, 1)
    counts = np.full(size, 7, np.int32)
    return Output(
        image=image.astype(np.float32),
        maps={"count": Map(counts, "count", "Candidates")},
        measures={"copied-share": params.level / 4, "analysis-depth": float(model)},
    )


STUB = Method(
    id="stub",
    title="Stub",
    summary="Makes gray.",
    reference="None.",
    params=StubParams,
    analyze=analyze,
    synthesize=synthesize,
)


def know(monkeypatch, methods):
    """Make the registry hold these methods and no others."""
    monkeypatch.setattr(registry._METHODS, "all", lambda: methods)


@pytest.fixture
def stub(monkeypatch):
    """Make the registry hold the stub (and what it holds anyway)."""
    know(monkeypatch, dict(registry.methods()) | {"stub": STUB})
    analyses.clear()
    running.clear()
    return STUB


class Gate:
    """Lets so many results of the stub finish, and holds those that begin later until it is opened."""

    PATIENCE_S = 180.0

    def __init__(self, monkeypatch, count):
        running.clear()
        self._opened, self._count = threading.Event(), count
        monkeypatch.setattr(sys.modules[__name__], "time", SimpleNamespace(sleep=self._nap))

    def _nap(self, _):
        here = threading.get_ident()
        # Threads are used again: the result at work is the last one that this thread has begun.
        begun = [place for place, thread in enumerate(running) if thread == here]
        if begun and begun[-1] >= self._count:
            self._opened.wait(self.PATIENCE_S)

    def open(self):
        self._opened.set()


def exemplar(height=16, width=20, channels=3):
    pixels = np.random.default_rng(1).random((height, width, channels), np.float32)
    pixels.flags.writeable = False
    return ImageInput(pixels, "noise", hash_arrays({"pixels": pixels}))
