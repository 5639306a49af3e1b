"""MSG in units of one transform pair of the same size, and how often an edited code is repainted."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import scipy.fft

from tests.benchmarks.clock import cpu, fourier_pair
from tests.core.spectral_tools import ANY, analyzed, synthesized, texture
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.methods.spectral.codefile import code_input
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.benchmark


def each(work: Callable[[], Any], repeats: int) -> float:
    """Return the least CPU time of one call over a few series, in seconds."""

    def series() -> None:
        for _ in range(repeats):
            work()

    return cpu(series, 7) / repeats


@pytest.mark.parametrize(("side", "repeats", "target"), [(256, 40, 6), (512, 12, 4), (1024, 4, 4)])
def test_analysis_and_synthesis_in_transform_pairs(side: int, repeats: int, target: int) -> None:
    size = (side, side)
    plane = texture(size)
    code = analyzed(plane)
    pair = each(lambda: scipy.fft.irfft2(scipy.fft.rfft2(plane), s=size), repeats)
    analysis = each(lambda: analyzed(plane), repeats)
    synthesis = each(lambda: synthesized(code, size), repeats)
    result = synthesized(code, size)[1]
    histogram = each(lambda: finish(code.tone.apply(result, ANY, "a")), repeats)
    print(
        f"\n{side}: pair {1e3 * pair:.2f} ms; analysis {analysis / pair:.2f} + synthesis {synthesis / pair:.2f} = "
        f"{(analysis + synthesis) / pair:.2f} pairs (target {target}); histogram step {1e3 * histogram:.2f} ms"
    )
    assert analysis + synthesis < target * pair


def test_an_edited_code_is_made_anew_many_times_a_second() -> None:
    code = analyzed(texture((256, 256)))
    factor = iter(np.linspace(1, 3, 10_000))

    def edit() -> None:
        edited = replace(code, energies=(code.energies[0] * float(next(factor)), *code.energies[1:]))
        run(Job(method="msg", inputs={"code": code_input(edited)}, size=(256, 256)))

    took, unit = each(edit, 20), fourier_pair()
    print(f"\n256: an edited code takes {1e3 * took:.2f} ms, {took / unit:.1f} units, as a whole job")
    # A sixtieth of a second is about 44 units.
    assert took < 20 * unit
