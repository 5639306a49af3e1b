"""What a run will take is said before it starts, and what the machine does not have is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from texlab_core.engine import estimate as estimates
from texlab_core.engine.estimate import estimate_of, in_words, is_large
from texlab_core.engine.job import Job
from texlab_core.engine.registry import Estimate, methods
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar

EXEMPLAR = as_exemplar(np.random.default_rng(0).random((20, 30, 3), np.float32))


def test_pixels_of_exemplar_and_output_count() -> None:
    method = methods()["tiling"]
    found = estimate_of(method, {"exemplar": EXEMPLAR}, method.params(), (40, 50))
    assert found == Estimate(None, method.bytes_per_pixel * (20 * 30 + 40 * 50))


@pytest.mark.parametrize("name", list(methods()))
def test_every_method_foretells_something_that_grows(name: str) -> None:
    method = methods()[name]
    inputs = {"exemplar": EXEMPLAR} | {spec.name: EXEMPLAR for spec in method.inputs if spec.required}
    sizes: Any = [(16,) * method.dimensions, (64,) * method.dimensions]
    small, large = (estimate_of(method, inputs, method.params(), size) for size in sizes)
    assert 0 < small.nbytes < large.nbytes


def test_what_the_machine_does_not_have_is_refused_in_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(estimates, "machine_bytes", lambda: 10**9)
    with pytest.raises(InputError, match=r"^Heeger-Bergen of 4096 x 2048 needs about 2\.6 GB of memory, and this"):
        Job(method="heeger-bergen", inputs={"exemplar": EXEMPLAR}, size=(2048, 4096))
    Job(method="tiling", inputs={"exemplar": EXEMPLAR}, size=(2048, 4096))
    monkeypatch.setattr(estimates, "machine_bytes", lambda: None)
    Job(method="heeger-bergen", inputs={"exemplar": EXEMPLAR}, size=(2048, 4096))


def test_large_is_by_pixels_or_by_the_share_of_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(estimates, "machine_bytes", lambda: 4 * 10**9)
    assert not is_large(Estimate(None, 10**9), (4096, 4096))
    assert is_large(Estimate(None, 10**9), (4096, 4097))
    assert is_large(Estimate(None, 10**9 + 1), (8, 8))
    assert not is_large(Estimate(60, 10**6), (8, 8))
    assert is_large(Estimate(61, 10**6), (8, 8))
    assert in_words(Estimate(40.2, 69 * 10**8)) == "about 6.9 GB of memory and 40 s"
    assert in_words(Estimate(151, 69 * 10**8)) == "about 6.9 GB of memory and 3 min"
    assert in_words(Estimate(None, 3 * 10**6)) == "about 3 MB of memory"
