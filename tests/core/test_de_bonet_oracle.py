"""The hierarchical sampler against the compiled pseudo-code: every candidate set, every choice."""

from __future__ import annotations

import numpy as np
import pytest
from de_bonet_oracle import candidate_sets, rasters
from hypothesis import given, settings
from hypothesis import strategies as st

from texlab_core.engine.streams import Streams
from texlab_core.kernels.candidates import ranks
from texlab_core.methods.de_bonet import sampling as sampling_module
from texlab_core.methods.de_bonet.analysis import analyze_steps
from texlab_core.methods.de_bonet.layout import Layout
from texlab_core.methods.de_bonet.maps import candidate_map
from texlab_core.methods.de_bonet.sampling import (
    Sampling,
    candidate_bits,
    list_matches,
    match_chain,
    prepare_steps,
    sample_steps,
)
from texlab_core.methods.de_bonet.thresholds import threshold_law
from texlab_core.work.tasks import finish


def exemplar(height: int, width: int, channels: int, seed: int, flat: bool = False) -> np.ndarray:
    random = np.random.default_rng(seed)
    pixels = random.random((height, width, channels)).astype(np.float32)
    # Neighbours depend on each other, so that sets of all sizes appear.
    pixels = (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1) + np.roll(pixels, (1, 1), (0, 1))) / 4
    if flat:
        pixels[height // 4 :, width // 5 :] = 1
    return pixels


def sampled(
    pixels: np.ndarray, thresholds, size, *, seed=0, literal_levels=0, coarsest="shift", **options
) -> Sampling:
    analysis = finish(analyze_steps(pixels, **options))
    if callable(thresholds):
        thresholds = thresholds(analysis)
    table = np.broadcast_to(np.asarray(thresholds, np.float32), (analysis.depth, len(analysis.features))).copy()
    layout = Layout(coarsest=coarsest)
    sampling = finish(
        prepare_steps(analysis, table, size, layout=layout, literal_levels=literal_levels, streams=Streams(seed))
    )
    for _ in sample_steps(sampling):
        pass
    return sampling


def check_against_oracle(sampling: Sampling) -> None:
    pyramids = rasters(sampling)
    grid, exemplar_grid = sampling.grid, sampling.analysis.grid
    for level in range(grid.depth):
        literal = sampling.literal[level]
        oracle = candidate_sets(pyramids, level, parity=not literal)
        order, exemplar_order = grid.order(level).ravel(), exemplar_grid.order(level).ravel()
        counts = oracle.sum(1)
        matches = list_matches(sampling) if level == 0 else sampling.matches[level + 1]
        np.testing.assert_array_equal(counts, matches[order >> 2] * (4 if literal else 1))
        bits, key = candidate_bits(sampling, level), np.uint64(sampling.keys[level])
        for pixel, place in enumerate(order):
            candidates = np.sort(exemplar_order[oracle[pixel]])
            chain = match_chain(sampling, level + 1, int(place) >> 2)
            matched = chain[-1].astype(np.int64)
            if literal:
                children = (4 * matched[:, None] + np.arange(4)).ravel()
                ranked = children
            else:
                children = 4 * matched + (place & 3)
                ranked = matched
            np.testing.assert_array_equal(children, candidates)
            rank = np.empty(ranked.size, np.int64)
            ranks(key, int(place), bits, ranked.astype(np.int32), rank)
            assert sampling.sources[level][place] == children[rank.argmin()]
    if grid.depth:
        by_pixel = list_matches(sampling)[grid.order(0) >> 2] * (4 if sampling.literal[0] else 1)
        np.testing.assert_array_equal(candidate_map(sampling, grid.shape(0)), by_pixel)


@pytest.mark.parametrize("alpha", [0.0, 0.1, 0.5, 4.0])
@pytest.mark.parametrize("literal_levels", [0, 1, 9])
def test_gray(alpha: float, literal_levels: int) -> None:
    sampling = sampled(exemplar(32, 32, 1, 1), alpha, (48, 64), literal_levels=literal_levels, smallest=4)
    assert sampling.grid.depth == 3
    check_against_oracle(sampling)


@pytest.mark.parametrize("alpha", [0.05, 0.3])
@pytest.mark.parametrize("literal_levels", [0, 9])
def test_colour(alpha: float, literal_levels: int) -> None:
    check_against_oracle(
        sampled(exemplar(32, 24, 3, 2), alpha, (40, 31), literal_levels=literal_levels, smallest=3)
    )


@pytest.mark.parametrize("size", [(29, 45), (33, 17), (50, 21)])
def test_sizes_that_are_no_powers_of_two(size: tuple[int, int]) -> None:
    check_against_oracle(sampled(exemplar(*size, 1, 3), 0.3, (size[1] + 6, size[0] + 3), smallest=4))


@pytest.mark.parametrize("coarsest", ["patches", "fit", "shift", "tile", "iid"])
@pytest.mark.parametrize("options", [{"smallest": 1}, {"smallest": 4, "border": "periodic"}])
def test_coarsest_levels(coarsest: str, options: dict[str, object]) -> None:
    check_against_oracle(sampled(exemplar(16, 16, 1, 4), 0.4, (32, 40), coarsest=coarsest, **options))


@pytest.mark.parametrize("filters", ["first", "second", "laplacian"])
@pytest.mark.parametrize("normalization", ["variance", "level", "range", "sum", "printed"])
def test_features(filters: str, normalization: str) -> None:
    alpha = {"sum": 1e-4, "range": 0.01}.get(normalization, 0.3)
    options = {"filters": filters, "normalization": normalization, "channels": "luminance"}
    check_against_oracle(sampled(exemplar(24, 24, 3, 5), alpha, (24, 48), smallest=3, **options))


@pytest.mark.parametrize("beta", [0.0, 1.0, 2.0])
def test_law(beta: float) -> None:
    check_against_oracle(
        sampled(exemplar(32, 32, 1, 6), lambda a: threshold_law(0.4, beta, a.depth)[:, None], (32, 64), smallest=4)
    )


@settings(max_examples=25, deadline=None)
@given(
    st.tuples(st.integers(5, 34), st.integers(5, 34)),
    st.tuples(st.integers(1, 40), st.integers(1, 40)),
    st.sampled_from([1, 3]),
    st.integers(0, 2**31 - 1),
    st.integers(0, 4),
    st.integers(1, 6),
    st.floats(0.02, 2),
    st.booleans(),
)
def test_random_tables(
    size: tuple[int, int],
    output: tuple[int, int],
    channels: int,
    seed: int,
    literal_levels: int,
    smallest: int,
    scale: float,
    flat: bool,
) -> None:
    random = np.random.default_rng(seed)
    check_against_oracle(
        sampled(
            exemplar(*size, channels, seed, flat),
            lambda a: random.exponential(scale, (a.depth, len(a.features))),
            output,
            seed=seed,
            literal_levels=literal_levels,
            smallest=smallest,
        )
    )


@pytest.mark.parametrize("literal_levels", [0, 9])
def test_proposals_without_lists(monkeypatch: pytest.MonkeyPatch, literal_levels: int) -> None:
    """Where the sets of level 1 are not listed, proposals find what the pseudo-code and the ranks say."""
    monkeypatch.setattr(sampling_module, "_defer_from", lambda sampling: 64)
    pixels = np.ones((128, 128, 1), np.float32)
    pixels[64:90, 30:60] = exemplar(26, 30, 1, 7)
    pixels += 0.003 * exemplar(128, 128, 1, 8)
    sampling = sampled(pixels, 0.3, (48, 32), literal_levels=literal_levels, coarsest="iid")
    assert (sampling.matches[1] < 0).mean() > 0.2
    check_against_oracle(sampling)


def test_neither_chunks_nor_memory_limits_change_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    pixels = exemplar(64, 48, 3, 8, flat=True)
    whole = sampled(pixels, 0.3, (96, 128), smallest=4)
    for name, value in (("BUDGET", 500), ("STORED_MEMBERS", 2000), ("STORED_NODES", 30), ("NODES_AT_ONCE", 37)):
        monkeypatch.setattr(sampling_module, name, value)
    parts = sampled(pixels, 0.3, (96, 128), smallest=4)
    for one, other in zip(whole.sources, parts.sources, strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(list_matches(whole), list_matches(parts))


@pytest.mark.parametrize("bits", [12, 13, 14])
@pytest.mark.parametrize("kind", ["run", "sparse", "even", "random", "pair"])
def test_choice_is_uniform(bits: int, kind: str) -> None:
    random = np.random.default_rng(9)
    candidates = {
        "run": np.arange(1000, 1013),
        "sparse": np.array([0, 1, 5, 64, 65, 1023, 2048, 4095]),
        "even": np.arange(0, 64, 4),
        "random": np.sort(random.choice(4096, 31, replace=False)),
        "pair": np.array([7, 8]),
    }[kind].astype(np.int32)
    draws = 40_000
    wins, rank = np.zeros(candidates.size), np.empty(candidates.size, np.int64)
    for place in range(draws):
        ranks(np.uint64(12345), place, bits, candidates, rank)
        wins[rank.argmin()] += 1
    expected = draws / candidates.size
    squares = ((wins - expected) ** 2 / expected).sum()
    freedom = candidates.size - 1
    # Five standard deviations of the chi-squared distribution.
    assert squares < freedom + 5 * (2 * freedom) ** 0.5


def test_ranks_are_a_permutation() -> None:
    everything, rank = np.arange(4096, dtype=np.int32), np.empty(4096, np.int64)
    for place in range(20):
        ranks(np.uint64(3), place, 12, everything, rank)
        np.testing.assert_array_equal(np.sort(rank), everything)
