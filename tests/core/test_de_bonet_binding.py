"""Which cell of the threshold table binds, against releasing one after the other."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.de_bonet.binding import binding, binding_steps
from texlab_core.methods.de_bonet.explain import explain
from texlab_core.methods.de_bonet.params import DeBonetParams
from texlab_core.methods.de_bonet.sampling import Sampling, match_chain
from texlab_core.methods.de_bonet.thresholds import ThresholdTable


def sampled(channels: int = 1, size: tuple[int, int] = (32, 40), **knobs) -> Sampling:
    pixels = np.random.default_rng(2).random((32, 32, channels)).astype(np.float32)
    pixels = (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1)) / 3
    params = DeBonetParams(**({"alpha": 0.8, "beta": 0.5} | knobs))
    return run(
        Job(method="de-bonet", inputs={"exemplar": as_exemplar(pixels)}, params=params, size=size)
    ).details.sampling


def candidates(sampling: Sampling) -> float:
    children = 4 if sampling.literal[0] else 1
    sizes = [match_chain(sampling, 1, place)[-1].size for place in range(sampling.grid.count(1))]
    return children * float(np.mean(sizes))


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("siblings", ["parity", "literal"])
def test_releasing_a_cell(channels: int, siblings: str) -> None:
    """By brute force: every cell in turn lets everything through, and all candidates are listed anew."""
    sampling = sampled(channels, siblings=siblings, alpha=2.0 if channels == 3 else 0.8, filters="both")
    found = binding(sampling, None)
    assert found.candidates == pytest.approx(candidates(sampling))
    assert found.released.shape == (sampling.grid.depth, len(sampling.analysis.features))
    for row in range(found.released.shape[0]):
        for column in range(found.released.shape[1]):
            table = sampling.thresholds.copy()
            table[row, column] = np.inf
            more = candidates(dataclasses.replace(sampling, thresholds=table))
            assert found.released[row, column] == pytest.approx(more - found.candidates)
    best = np.unravel_index(found.released.argmax(), found.released.shape)
    assert found.strictest == tuple(best)
    assert found.released.max() > 0


def test_exclusions_are_those_of_the_explained_pixels() -> None:
    sampling = sampled()
    found = binding(sampling, None)
    depth = sampling.grid.depth
    tested, excluded = np.zeros(depth, np.int64), np.zeros(depth, np.int64)
    violated, alone = np.zeros_like(found.violated), np.zeros_like(found.alone)
    # One pixel for each parent of pixels.
    for row in range(0, 32, 2):
        for column in range(0, 40, 2):
            for each in explain(sampling, row, column).levels[:-1]:
                k = depth - each.level
                tested[k] += each.tested
                excluded[k] += each.tested - len(each.matches)
                violated[k] += each.violated
                alone[k] += each.alone
    np.testing.assert_array_equal(found.tested, tested)
    np.testing.assert_array_equal(found.excluded, excluded)
    np.testing.assert_array_equal(found.violated, violated)
    np.testing.assert_array_equal(found.alone, alone)
    np.testing.assert_allclose(found.alone_shares, alone / np.maximum(excluded, 1)[:, None])
    assert (found.alone_shares <= 1).all()


def test_one_cell_alone_binds() -> None:
    open_ = {(k, name): 1e6 for k in (1, 2) for name in sampled().analysis.feature_names}
    table = ThresholdTable().changed(open_ | {(2, "luminance/first-90"): 0.01})
    sampling = sampled(thresholds=table)
    found = binding(sampling, None)
    column = sampling.analysis.feature_names.index("luminance/first-90")
    assert found.strictest == (1, column)
    assert found.alone_shares[1, column] == 1
    assert found.candidates + found.released[1, column] == 16 * 16
    assert np.delete(found.released.ravel(), len(sampling.analysis.features) + column).max() == 0


def test_some_places_stand_for_all() -> None:
    sampling = sampled(size=(128, 128))
    every, some = binding(sampling, None), binding(sampling, 512)
    assert some.candidates == pytest.approx(every.candidates, rel=0.2)
    steps = list(binding_steps(sampling, 40))
    assert steps[-1] == (40, 40)
    assert len(steps) == 40


def test_a_pyramid_without_halvings_has_no_cells() -> None:
    flat = sampled(coarsest_side=64)
    assert flat.grid.depth == 0
    found = binding(flat)
    assert (found.candidates, found.released.size, found.strictest) == (1.0, 0, None)
    everything = sampled(
        thresholds=ThresholdTable().changed(
            {(k, n): 1e6 for k in (1, 2) for n in sampled().analysis.feature_names}
        )
    )
    assert binding(everything).strictest is None
