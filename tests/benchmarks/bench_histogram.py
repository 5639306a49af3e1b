"""Histogram matching: ns per sample and in units of NumPy's argsort, by size."""

from __future__ import annotations

import numpy as np
import pytest

from tests.benchmarks.clock import cpu
from texlab_core.stats import histogram
from texlab_core.work.tasks import finish

pytestmark = pytest.mark.benchmark


def test_matching() -> None:
    print("\nns per sample      exact   exact, other size   256 bins   16384 bins   argsort and scatter")
    for side in (64, 128, 256, 512, 1024, 2048):
        count = side * side
        random = np.random.default_rng(0)
        values = random.laplace(size=count).astype(np.float32)
        target = histogram.sorted_sample(random.normal(size=count))
        half = histogram.sorted_sample(random.normal(size=count // 2))
        coarse, fine = histogram.tables(target), histogram.tables(target, histogram.PREVIEW_BINS)

        def scatter(values: np.ndarray = values, target: np.ndarray = target) -> np.ndarray:
            matched = np.empty_like(target)
            matched[np.argsort(values)] = target
            return matched

        times = 9 if side < 1024 else 3
        spent = [
            cpu(work, times) * 1e9 / count
            for work in (
                lambda v=values, t=target: histogram.match_ranks(v, t),
                lambda v=values, t=half: histogram.match_ranks(v, t),
                lambda v=values, t=coarse: finish(histogram.match_tables_in_place(v.copy(), t)),
                lambda v=values, t=fine: finish(histogram.match_tables_in_place(v.copy(), t)),
                scatter,
            )
        ]
        exact, other, paper, preview, sorting = spent
        print(f"{side:4} x {side:<4} {exact:12.1f} {other:19.1f} {paper:10.1f} {preview:12.1f} {sorting:21.1f}")
        # Ranks need no more than sorting does, and tables, which know no order, not much more either.
        assert max(exact, other) < sorting
        assert max(paper, preview) < 3 * sorting
