"""Arrays that are kept for the next time: by their bytes, read-only, and made again with the same values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.stats import spectrum
from texlab_core.transforms import gabor_bank, octave_bands, spots_bars
from texlab_core.work import kept as module
from texlab_core.work.kept import ArrayCache, kept, shrink

if TYPE_CHECKING:
    from collections.abc import Callable

KEPT: dict[str, tuple[Callable[..., Any], tuple[Any, ...]]] = {
    "triangles": (spectrum._triangles, (48, 9)),
    "distinct profiles": (gabor_bank.distinct_profiles, (40,)),
    "channel profiles": (gabor_bank.channel_profiles, (40, True)),
    "octave filters": (octave_bands._kept_filters, ((24, 30), 1)),
    "kernels": (spots_bars.scaled_kernels, (1.5,)),
    "spectra of kernels": (spots_bars._spectrum, (3, 1.5, (60, 54))),
}


@pytest.fixture
def store(monkeypatch: pytest.MonkeyPatch) -> ArrayCache:
    made = ArrayCache(1000)
    monkeypatch.setattr(module, "ARRAYS", made)
    return made


def parts(value: Any) -> tuple[Any, ...]:
    return value if isinstance(value, tuple) else (value,)


@pytest.mark.parametrize("name", list(KEPT))
def test_what_is_let_go_of_is_made_again(name: str, store: ArrayCache) -> None:
    make, args = KEPT[name]
    first = make(*args)
    assert make(*args) is first
    assert not any(each.flags.writeable for each in parts(first))
    assert store.nbytes == sum(each.nbytes for each in parts(first))
    shrink(0)
    assert store.nbytes == 0
    again = make(*args)
    assert again is not first
    for one, other in zip(parts(again), parts(first), strict=True):
        np.testing.assert_array_equal(one, other)


def test_bytes_are_counted_whoever_made_them(store: ArrayCache) -> None:
    asked: list[tuple[str, int, bool]] = []

    @kept
    def ones(count: int, *, twice: bool = False) -> np.ndarray:
        asked.append(("ones", count, twice))
        return np.ones(count * (1 + twice), np.uint8)

    @kept
    def pair(count: int) -> tuple[np.ndarray, ...]:
        asked.append(("pair", count, False))
        return np.ones(count, np.uint8), np.zeros(count, np.uint8)

    assert ones(300).sum() == 300
    assert ones(300, twice=True).sum() == 600
    # The same number, and another function.
    assert [each.sum() for each in pair(300)] == [300, 0]
    assert len(asked) == 3
    # What was not used for longest has gone.
    assert store.nbytes == 600
    ones(300)
    assert asked[3:] == [("ones", 300, False)]
    assert pair(300)[0].sum() == 300
    ones(5000)
    assert store.nbytes == 5000
    ones(5000)
    assert len(asked) == 5


def test_the_responses_of_a_filter_are_its_convolution() -> None:
    plane = np.random.default_rng(5).random((31, 42)).astype(np.float32)
    found = spots_bars.scaled_responses(plane, 2.0)
    kernels = spots_bars.scaled_kernels(2.0)
    reach = kernels.shape[1] // 2
    padded = np.pad(plane.astype(np.float64), reach, mode="reflect")
    windows = np.lib.stride_tricks.sliding_window_view(padded, kernels.shape[1:])
    right = np.einsum("yxij,kij->kyx", windows, kernels[:, ::-1, ::-1], optimize=True)
    np.testing.assert_allclose(found, right, atol=2e-6)
