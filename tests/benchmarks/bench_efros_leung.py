"""Efros-Leung: CPU time times a yardstick's rate, worst cases, drafts, waiting between steps.

The yardstick is a compiled loop that adds squared int32 differences for 1024 candidates: a subtraction, a
multiplication and an addition each, in operations per second in the same process. CPU time times this rate is how
many of its operations would have taken as long.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.benchmarks.clock import fourier_pair
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled
from texlab_core.images.exemplar import as_exemplar
from texlab_core.kernels.jit import njit
from texlab_core.methods.efros_leung.draft import draft
from texlab_core.methods.efros_leung.params import EfrosLeungParams
from texlab_core.methods.efros_leung.windows import Matching

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.steps import Step

pytestmark = pytest.mark.benchmark


@njit
def yardstick(entries: NDArray[np.int32], values: NDArray[np.int32], sums: NDArray[np.int32], times: int) -> None:
    for number in range(times):
        value, start = values[number & 255], number & 63
        for lane in range(1024):
            difference = value - entries[start + lane]
            sums[lane] += difference * difference


def yardstick_rate() -> float:
    """Return operations per second: the best of several, over several places in memory."""
    random = np.random.default_rng(0)
    best, times = np.inf, 50_000
    for _ in range(7):
        entries, values = (random.integers(0, 256, n).astype(np.int32) for n in (1200, 256))
        sums = np.zeros(1024, np.int32)
        yardstick(entries, values, sums, 10)
        begin = time.thread_time()
        yardstick(entries, values, sums, times)
        best = min(best, time.thread_time() - begin)
    return 3 * 1024 * times / best


def exemplar(name: str, side: int, gray: bool) -> ImageInput:
    if name in ("white", "checkerboard"):
        pixels = np.ones((side, side, 1 if gray else 3), np.float32)
        if name == "white":
            pixels[side // 3 : side // 2, side // 4 : side // 2] = 0.3
        else:
            pixels *= (np.indices((side, side)).sum(0) // 4 % 2)[..., None]
        return as_exemplar(pixels * np.linspace(1, 0.8, pixels.shape[2], dtype=np.float32))
    taken = as_exemplar(f"gallery:{name}", crop=Crop(0, 0, side, side))
    return as_exemplar(taken.pixels.mean(axis=2)) if gray else taken


def grow(source: ImageInput, size: int, **params: object) -> tuple[float, float]:
    """Return CPU seconds of the synthesis (two runs, the better one), and its longest time between two steps."""
    settings = EfrosLeungParams().replace(**params)
    job = Job(method="efros-leung", inputs={"exemplar": source}, params=settings, size=(size, size))
    cache = AnalysisCache()
    run(Job(method="efros-leung", inputs=job.inputs, params=settings, size=(8, 8)), cache=cache)
    spent, longest = [], []
    for _ in range(2):
        moments = [time.thread_time()]
        run(job, lambda step, moments=moments: moments.append(time.thread_time()), cache=cache)
        spent.append(time.thread_time() - moments[0])
        longest.append(float(np.diff(moments).max()))
    return min(spent), min(longest)


def test_cpu_time_in_operations() -> None:
    rate = yardstick_rate()
    print(f"\nyardstick {rate / 1e9:.0f} billion operations a second")
    print(f"{'exemplar -> size, window':44} {'ms':>7} {'us/pixel':>9} {'billion':>9} {'longest step ms':>16}")
    textures = (
        "quasiperiodic-brick",
        "stochastic-bark",
        "structured-pebbles",
        "stochastic-gravel",
        "letters-darwin",
    )
    cases = [(name, 128, 256, True, {"tau": 0.0}) for name in textures]
    cases += [(name, 64, 128, True, {"tau": 0.0, "window": 11}) for name in textures]
    cases += [("structured-pebbles", 128, 256, False, {"tau": 0.0})]
    cases += [("structured-pebbles", 64, 128, False, {"tau": 0.0, "window": 11})]
    cases += [(name, 128, 128, gray, {}) for name in ("white", "checkerboard") for gray in (True, False)]
    for criterion in ("flat-ssd", "sad", "ncc"):
        cases.append(("structured-pebbles", 128, 128, True, {"criterion": criterion}))
    for name, side, size, gray, params in cases:
        seconds, longest = grow(exemplar(name, side, gray), size, **params)
        what = f"{name} {side} -> {size} {'gray' if gray else 'RGB'} {' '.join(map(str, params.values()))}"
        micro = seconds / size**2 * 1e6
        print(f"{what:44} {seconds * 1e3:7.0f} {micro:9.1f} {seconds * rate / 1e9:9.1f} {longest * 1e3:16.1f}")
        # All windows compared whole: textures take less, and nothing takes three times as long.
        window = EfrosLeungParams().replace(**params).window
        whole = 3 * (side - window + 1) ** 2 * window**2 * size**2 * (1 if gray else 3)
        assert seconds * rate < whole * (0.75 if "tau" in params else 3)
        assert longest * rate < 1e9


def test_worst_waiting() -> None:
    """A white exemplar of 512 x 512 in colour, window 41: every candidate matches every pixel."""
    job = Job(
        method="efros-leung",
        inputs={"exemplar": as_exemplar(np.ones((512, 512, 3), np.float32))},
        params=EfrosLeungParams(window=41),
    )
    moments: list[float] = []
    end = time.thread_time() + 3

    def watch(step: Step) -> None:
        if step.preview is not None:
            step.preview()
        moments.append(time.thread_time())

    with pytest.raises(Cancelled):
        run(job, watch, lambda: time.thread_time() > end)
    gaps = np.diff(moments)
    print(
        f"\nworst case with every preview: {1 / gaps.mean():.0f} steps a second, longest {gaps.max() * 1e3:.0f} ms"
    )
    # A cancel waits for a step: 200 units of a Fourier transform are less than a tenth of a second.
    assert gaps.max() < 200 * fourier_pair()


def test_drafts() -> None:
    source = as_exemplar("gallery:structured-pebbles")
    for window in (5, 15, 41):
        matching = Matching(window=window)
        draft({"exemplar": source}, matching, (256, 256), 0)
        begin = time.thread_time()
        picture = draft({"exemplar": source}, matching, (256, 256), 0)
        spent = time.thread_time() - begin
        print(
            f"\ndraft with window {window}: {picture.shape[1]} x {picture.shape[0]} in {spent * 1e3:.0f} ms",
            end="",
        )
        # Twice what is measured, whatever the window: the hand is still on the slider.
        assert spent < 120 * fourier_pair()
    print()
