"""CPU time of the measures at 256 x 256 with the exemplar's part cached, in Fourier pairs of the same process."""

import numpy as np
import pytest

from tests.benchmarks.clock import cpu, fourier_pair
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.registry import find_measure, measures
from texlab_core.measures.subject import PreparedCache, Subject

pytestmark = pytest.mark.benchmark
LIMIT = 60


def test_d_and_v_follow_a_slider():
    exemplar = as_exemplar("gallery:structured-pebbles")
    image = as_exemplar(np.random.default_rng(0).random((256, 256, 3), np.float32)).pixels
    cache = PreparedCache()

    def ask(*names):
        subject = Subject(image=image, exemplar=exemplar, cache=cache)
        return [find_measure(name).of(subject) for name in names]

    unit = fourier_pair()
    for measure in measures().values():
        if measure.needs == ("exemplar",) and not measure.slow:
            print(f"{measure.id}: {cpu(lambda name=measure.id: ask(name)) / unit:.1f} units")
    both = cpu(lambda: ask("discriminability", "visual-difference")) / unit
    print(f"D and V together: {both:.1f} units, at most {LIMIT}")
    assert both < LIMIT
