"""Solids and mixtures against the clock: in units, and in frames and milliseconds where a hand waits.

A unit is the CPU time of one float32 rfft2 and irfft2 of 256 x 256 in the same process.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy import fft

from texlab.runs.drafts import draft_size
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.gallery import gallery
from texlab_core.methods.solid.synthesis import Synthesis
from texlab_core.solids.rendering import SHAPES, View, render, render_wrapped
from texlab_core.transforms.luma import luma
from texlab_core.warming import Need, load

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.benchmark


def cpu(action: Callable[[], object], times: int = 1) -> float:
    """Return the least CPU time of some runs, in seconds."""
    found = []
    for _ in range(times):
        start = time.process_time()
        action()
        found.append(time.process_time() - start)
    return min(found)


def unit() -> float:
    plane = np.random.Generator(np.random.PCG64(0)).random((256, 256), dtype=np.float32)

    def many() -> None:
        for _ in range(50):
            fft.irfft2(fft.rfft2(plane), s=plane.shape)

    return cpu(many, 3) / 50


def solid(side: int, **values: Any) -> Callable[[], object]:
    exemplar = as_exemplar("gallery:structured-pebbles", scale=0.5)
    params = find_method("solid").params(**values)
    job = Job(method="solid", inputs={"exemplar": exemplar}, params=params, size=(side,) * 3)
    return lambda: run(job, threads=1)


def peak_bytes() -> int:
    with open("/proc/self/status", encoding="ascii") as file:
        (line,) = (line for line in file if line.startswith("VmHWM"))
    return int(line.split()[1]) * 1024


def reset_peak() -> int:
    with open("/proc/self/clear_refs", "w", encoding="ascii") as file:
        file.write("5")
    return peak_bytes()


def test_solids_in_units() -> None:
    load(Need("solid", 3))
    one = unit()
    found = {}
    for balance in (False, True):
        found["64^3 mixed", balance] = cpu(solid(64, kind="mixed", balance=balance)) / one
    before = reset_peak()
    for balance in (True, False):
        found["128^3 laplacian", balance] = cpu(solid(128, balance=balance)) / one
    taken = peak_bytes() - before
    print(f"unit {1e3 * one:.2f} ms", end="; ")
    for (what, balance), units in found.items():
        print(f"{what}, {'balanced' if balance else 'plain'}: {units:.0f} units", end="; ")
    print(f"peak {taken / 2**20:.0f} MB over the start")
    assert max(found["64^3 mixed", balance] for balance in (False, True)) < 15_000
    assert max(found["128^3 laplacian", balance] for balance in (False, True)) < 30_000
    assert taken < 600 * 2**20


@pytest.mark.parametrize("kind", ["laplacian", "mixed"])
@pytest.mark.parametrize("coloured", [False, True], ids=["gray", "colour"])
def test_every_band_of_the_whole_gallery_comes_nearer(
    kind: str, coloured: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At half size, 48^3, on each colour axis by itself."""
    made: list[Synthesis] = []
    finish = Synthesis.finish

    def watched(self: Synthesis) -> Any:
        made.append(self)
        return (yield from finish(self))

    monkeypatch.setattr(Synthesis, "finish", watched)
    params = find_method("solid").params(kind=kind)
    farther, worst = [], -np.inf
    for entry in gallery():
        exemplar = as_exemplar(f"gallery:{entry.name}", scale=0.5)
        if not coloured:
            exemplar = as_exemplar(luma(exemplar.pixels), name=entry.name)
        run(Job(method="solid", inputs={"exemplar": exemplar}, params=params, size=(48,) * 3))
        rises = [float((state.distances - state.first).max()) for state in made.pop().states]
        worst = max(worst, *rises)
        if max(rises) >= 0:
            farther.append(f"{entry.name} {max(rises):.4f}")
    print(f"{kind}: {len(gallery()) - len(farther)} of {len(gallery())}, worst band {worst:+.4f} from its start")
    assert farther == []


def test_steps_come_at_least_every_50_ms() -> None:
    load(Need("solid", 3))
    exemplar = as_exemplar("gallery:structured-pebbles", scale=0.5)
    moments: list[float] = []
    params = find_method("solid").params(kind="mixed", iterations=1)
    job = Job(method="solid", inputs={"exemplar": exemplar}, params=params, size=(96,) * 3)

    def watch(step: Any) -> None:
        if step.preview is not None:
            step.preview()
        moments.append(time.thread_time())

    run(job, watch, threads=1)
    longest = float(np.diff(moments).max())
    print(f"longest CPU time between two steps with a preview at 96^3: {1e3 * longest:.0f} ms")
    assert longest < 0.05


def test_frames_a_second() -> None:
    volume = np.random.Generator(np.random.PCG64(1)).random((128, 128, 128, 3), dtype=np.float32)
    image = volume[0]
    for shape in SHAPES:
        view = View(shape)
        drawn = cpu(lambda view=view: render(volume, view), 5)
        wrapped = cpu(lambda view=view: render_wrapped(image, volume.shape, view), 5)
        print(f"{shape}: {1e3 * drawn:.0f} ms, wrapped {1e3 * wrapped:.0f} ms at 400 x 400")
        assert drawn < 0.04
        assert wrapped < 0.04


def test_a_weight_is_answered_while_it_is_dragged() -> None:
    load(Need("mixture", 3))
    inputs = {
        name: as_exemplar(f"gallery:{place}")
        for name, place in (("exemplar", "stochastic-granite"), ("second", "stochastic-lava"))
    }
    cache, method = AnalysisCache(), find_method("mixture")

    def at(weight: float, size: tuple[int, ...]) -> Callable[[], object]:
        job = Job(method="mixture", inputs=inputs, params=method.params(weight=weight), size=size)
        return lambda: run(job, cache=cache, threads=1)

    at(0.5, (256, 256))()
    full = cpu(at(0.4, (256, 256)), 3)
    size = draft_size((256, 256), full) or (256, 256)
    draft = cpu(at(0.3, size), 3)
    print(f"mixture of 256 x 256: {1e3 * full:.0f} ms; its draft of {size[1]} x {size[0]}: {1e3 * draft:.0f} ms")
    assert draft < 0.15
