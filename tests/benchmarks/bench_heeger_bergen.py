"""Heeger-Bergen: whole runs in units of a Fourier transform, with 1 and 2 threads, and the longest step.

A unit is the CPU time of one 256 x 256 float32 rfft2 + irfft2 pair in the same process.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.benchmarks.clock import cpu, fourier_pair
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.heeger_bergen.method import HeegerBergenParams

if TYPE_CHECKING:
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.steps import Step

pytestmark = pytest.mark.benchmark

RGB = as_exemplar("gallery:structured-pebbles").pixels
GRAY = as_exemplar("gallery:stochastic-gravel").pixels


def exemplar(pixels: Any, side: int) -> ImageInput:
    """Return the texture repeated to a square of this side."""
    many = -(-side // min(pixels.shape[:2]))
    tiled = np.tile(pixels, (many, many, 1))[:side, :side]
    return as_exemplar(np.round(tiled * 255).astype(np.uint8))


def job(pixels: Any, source: int, side: int, **params: Any) -> Job:
    return Job(
        method="heeger-bergen",
        inputs={"exemplar": exemplar(pixels, source)},
        params=HeegerBergenParams(**params),
        size=(side, side),
    )


def test_whole_runs() -> None:
    unit = fourier_pair()
    print(f"\nunit: {unit * 1e3:.3f} ms of CPU time; the target for 256 -> 256 in colour is 1000 units")
    print("5 rounds, analysis cached, in units        1 thread   2 threads   wall time of 2 / of 1   analysis")
    # The most is about one and a half times what is measured; with twice as many threads no work is added.
    for name, pixels, source, side, params, most in (
        ("colour 256 -> 256, 4 x 4", RGB, 256, 256, {}, 1000),
        ("colour 256 -> 512, 4 x 4", RGB, 256, 512, {}, 5000),
        ("colour 512 -> 512, 4 x 4", RGB, 512, 512, {}, 8000),
        ("gray 256 -> 256, 4 x 4", GRAY, 256, 256, {}, 500),
        ("colour 256 -> 256, 4 x 18", RGB, 256, 256, {"orientations": 18}, 5000),
        ("colour 256 -> 256, 256 bins", RGB, 256, 256, {"matching": "bins"}, 1500),
        ("colour 256 -> 256, Laplacian", RGB, 256, 256, {"pyramid": "laplacian"}, 300),
        ("colour 256 -> 256, transport", RGB, 256, 256, {"palette": "transport"}, 1500),
    ):
        plan, cache = job(pixels, source, side, **params), AnalysisCache()
        spent, walls = [], []
        for threads in (1, 2):
            spent.append(cpu(lambda t=threads, p=plan, c=cache: run(p, cache=c, threads=t), 3) / unit)
            began = [time.perf_counter()]
            for _ in range(3):
                run(plan, cache=cache, threads=threads)
                began.append(time.perf_counter())
            walls.append(np.diff(began).min())
        analysis = cpu(lambda p=plan: run(p, threads=1), 3) / unit - spent[0]
        print(f"{name:38} {spent[0]:12.0f} {spent[1]:11.0f} {walls[1] / walls[0]:23.2f} {analysis:10.0f}")
        assert spent[0] < most
        assert spent[1] < 1.5 * spent[0]


def test_longest_step() -> None:
    unit = fourier_pair() * 1e3
    print("\nlongest time between two steps of the working thread, ms of wall time (a cancel waits as long)")
    for name, source, side, params in (
        ("colour 512 -> 512", 512, 512, {}),
        ("colour 512 -> 512, 256 bins, transport", 512, 512, {"matching": "bins", "palette": "transport"}),
        ("colour 512 -> 512, 18 orientations", 512, 512, {"orientations": 18, "iterations": 1}),
        ("colour 256 -> 2048", 256, 2048, {"iterations": 1}),
    ):
        plan = job(RGB, source, side, **params)
        for threads in (1, 2):
            moments: list[float] = []
            worked: list[float] = []

            def on_step(_: Step, moments: list[float] = moments, worked: list[float] = worked) -> None:
                moments.append(time.perf_counter())
                worked.append(time.process_time())

            # What is compiled is loaded before.
            run(job(RGB, 64, 64, **params), threads=threads)
            run(plan, on_step, threads=threads)
            gaps = np.diff(moments) * 1e3
            most = np.diff(worked).max() * 1e3 / unit
            print(
                f"{name:40} {threads} thread(s) {gaps.max():8.1f}   99 %: {np.percentile(gaps, 99):6.1f}", end=" "
            )
            print(f"{most:8.0f} units of CPU time")
            # On a free machine 400 units are a seventh of a second.
            assert most < 400
