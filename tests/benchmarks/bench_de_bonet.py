"""De Bonet: synthesis and collapse in units of a Fourier transform, growth with size, memory.

A unit is the CPU time of one 256 x 256 float32 rfft2 + irfft2 pair of scipy.fft in the same process.
"""

from __future__ import annotations

import sys
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.de_bonet.params import DeBonetParams

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.engine.steps import FloatImage

pytestmark = pytest.mark.benchmark

GRAY = as_exemplar("gallery:stochastic-gravel").pixels
RGB = as_exemplar("gallery:structured-pebbles").pixels


def cpu(work: Callable[[], object], times: int = 7) -> float:
    """Return the median CPU time of this thread in seconds, after one run to warm up."""
    work()
    spent = []
    for _ in range(times):
        began = time.thread_time()
        work()
        spent.append(time.thread_time() - began)
    return float(np.median(spent))


def unit() -> float:
    from scipy import fft

    picture = np.random.default_rng(0).random((256, 256), np.float32)
    return cpu(lambda: fft.irfft2(fft.rfft2(picture), s=picture.shape), 200)


def cartoon(side: int, discs: int, grain: float = 0.0, channels: int = 1) -> FloatImage:
    random = np.random.default_rng(5)
    y, x = np.mgrid[:side, :side]
    image = np.ones((side, side, channels), np.float32)
    for _ in range(discs):
        row, column = random.integers(0, side, 2)
        inside = (y - row) ** 2 + (x - column) ** 2 < random.uniform(6, 14) ** 2
        image[inside] = random.uniform(0, 0.8, channels)
    return np.clip(image + grain * random.standard_normal(image.shape), 0, 1).astype(np.float32)


def grown(pixels: FloatImage, alpha: float, side: int, coarsest: Any = "patches") -> Callable[[], object]:
    """Return sampling and collapse, without the analysis and without maps and measures."""
    from texlab_core.methods.de_bonet.analysis import analyze_steps
    from texlab_core.methods.de_bonet.growth import grow
    from texlab_core.methods.de_bonet.layout import Layout
    from texlab_core.methods.de_bonet.sampling import prepare_steps, sample_steps
    from texlab_core.work.tasks import finish

    analysis = finish(analyze_steps(pixels))
    table = np.full((analysis.depth, len(analysis.features)), alpha, np.float32)

    layout = Layout(coarsest=coarsest)

    def work() -> FloatImage:
        preparing = prepare_steps(
            analysis, table, (side, side), layout=layout, literal_levels=0, streams=Streams(0)
        )
        sampling = finish(preparing)
        progress = sample_steps(sampling)
        steps = grow(analysis, sampling.grid, sampling.sources, progress, size=(side, side), periodic=False)
        return finish(steps)

    return work


def whole(pixels: FloatImage, alpha: float, side: int) -> Callable[..., Any]:
    """Return the whole job with its maps, its analysis taken from the cache as while a slider moves."""
    job = Job(
        method="de-bonet",
        inputs={"exemplar": as_exemplar(pixels)},
        params=DeBonetParams(alpha=alpha),
        size=(side, side),
    )
    cache = AnalysisCache()
    return lambda on_step=None: run(job, on_step, cache=cache)


def test_128_to_256() -> None:
    one = unit()
    print(f"\nunit: {one * 1e3:.3f} ms of CPU time")
    print("128 -> 256, in units          sampling + collapse   with maps   target")
    for name, pixels, target in (
        ("gray", GRAY[:128, :128], 30),
        ("RGB", RGB[:128, :128], 60),
        ("flat cartoon", cartoon(128, 4), 150),
        ("flat cartoon RGB", cartoon(128, 4, channels=3), 150),
        ("flat cartoon with grain", cartoon(128, 4, 0.01), 150),
    ):
        for alpha in (0.05, 0.15, 0.3):
            sampled, made = cpu(grown(pixels, alpha, 256)) / one, cpu(whole(pixels, alpha, 256)) / one
            print(f"{name:24} {alpha:4.2f} {sampled:19.1f} {made:12.1f} {target:8}")
            assert sampled < target
            # Maps and measures cost no more than what they tell of.
            assert made < 2 * target


def test_layouts() -> None:
    print("\ntime of 128 -> 256, alpha 0.15, relative to repetitions that are shifted at random")
    for name, pixels in (("gray", GRAY[:128, :128]), ("RGB", RGB[:128, :128])):
        usual = cpu(grown(pixels, 0.15, 256, "shift"))
        ratios = {
            layout: cpu(grown(pixels, 0.15, 256, layout)) / usual for layout in ("patches", "fit", "tile", "iid")
        }
        print(f"{name:5}", ", ".join(f"{layout} {ratio:.2f}" for layout, ratio in ratios.items()))
        # A choice of layout is no choice of speed: twice what the slowest takes.
        assert max(ratios.values()) < 3.5


def test_growth_with_area() -> None:
    for name, pixels in (("gray", GRAY[:128, :128]), ("RGB", RGB[:128, :128])):
        sides = (128, 256, 512, 1024)
        spent = [cpu(grown(pixels, 0.15, side), 5) / side**2 for side in sides]
        ratios = ", ".join(f"{side}: {each / spent[0]:.2f}" for side, each in zip(sides, spent, strict=True))
        print(f"\ntime per pixel of the output, alpha 0.15, {name}, relative to 128: {ratios}")
        # Linear in the area, although the picture leaves the caches.
        assert max(spent) < 2 * spent[0]


def test_large() -> None:
    import resource

    one = unit()
    for name, pixels, alpha, most in (
        ("RGB 256 -> 1024, alpha 0.15", RGB[:256, :256], 0.15, 1000),
        ("RGB 256 -> 1024, alpha 0.30", RGB[:256, :256], 0.3, 1000),
        ("flat cartoon with grain 256 -> 512, alpha 0.30", cartoon(256, 8, 0.01), 0.3, 1500),
        ("flat cartoon with grain 256 -> 1024, alpha 0.30", cartoon(256, 8, 0.01), 0.3, 5000),
    ):
        side = 512 if "512" in name else 1024
        work = whole(pixels, alpha, side)
        work()
        moments = [time.thread_time()]
        work(lambda step, moments=moments: moments.append(time.thread_time()))
        gaps = np.diff(moments)
        # The kernel counts KiB; this is the peak of the whole process so far.
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(f"\n{name}: {moments[-1] - moments[0]:.3f} s of CPU time, longest step {gaps.max() * 1e3:.0f} ms, "
              f"peak of the process {peak:.0f} MB", end="")  # fmt: skip
        # Twice what is measured; a cancel waits for a step, and 200 units are less than a tenth of a second.
        assert moments[-1] - moments[0] < most * one
        assert gaps.max() < 200 * one
    print()


def test_against_the_compiled_pseudo_code() -> None:
    """The pseudo-code is timed on some locations of each level, and scaled to all of them."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "core"))
    from de_bonet_oracle import flat, rasters, sample_some

    for name, pixels in (("gray", GRAY[:128, :128]), ("RGB", RGB[:128, :128])):
        result = whole(pixels, 0.15, 256)()
        sampling, pyramids = result.details.sampling, rasters(result.details.sampling)
        random = np.random.default_rng(0)
        total = 0.0
        for level in range(sampling.grid.depth):
            height, width = sampling.grid.shape(level)
            count = min(height * width, 200)
            chosen = np.stack((random.integers(0, height, count), random.integers(0, width, count)), 1)
            arguments = (flat(pyramids, level), pyramids.features[level].shape, chosen, random.random(count))
            total += cpu(partial(sample_some, *arguments), 1) * height * width / count
        fast = cpu(grown(pixels, 0.15, 256))
        print(
            f"\n{name} 128 -> 256, alpha 0.15: pseudo-code {total:.1f} s, {total / fast:.0f} times as long", end=""
        )
        assert total > 200 * fast
    print()


def test_explain_a_pixel() -> None:
    from texlab_core.methods.de_bonet.explain import explain

    one = unit()
    for name, pixels in (("gravel", GRAY[:256, :256]), ("flat cartoon with grain", cartoon(512, 12, 0.01))):
        sampling = whole(pixels, 0.3, 512)().details.sampling
        spent = [cpu(partial(explain, sampling, *at), 3) for at in np.ndindex(8, 8)]
        print(f"\nexplain a pixel, {name}: at most {max(spent) * 1e3:.1f} ms", end="")
        # The pointer moves on after a sixtieth of a second, about 44 units.
        assert max(spent) < 15 * one
    print()
