"""The exemplar's own line: another piece of its source, measured as a result."""

from __future__ import annotations

import numpy as np
import pytest

from texlab_core.engine.inputs import Crop
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import Subject
from texlab_core.sheets.own_line import other_place, own_measures


@pytest.mark.parametrize(
    ("size", "crop", "place"),
    [
        ((256, 256), Crop(top=0, left=0, height=128, width=128), (128, 128)),
        ((256, 256), Crop(top=64, left=64, height=128, width=128), (0, 0)),
        ((128, 300), Crop(top=0, left=172, height=128, width=128), (0, 0)),
        ((128, 180), Crop(top=0, left=0, height=128, width=128), None),
    ],
)
def test_the_corner_that_shares_least(size, crop, place) -> None:
    found = other_place(size, crop)
    assert (None if found is None else (found.top, found.left)) == place
    assert found is None or (found.height, found.width) == (crop.height, crop.width)


def test_it_is_measured_like_any_result() -> None:
    pixels = np.random.default_rng(0).random((96, 96, 1), np.float32)
    exemplar = as_exemplar(pixels, crop=Crop(top=0, left=0, height=48, width=48))
    ids = ("discriminability", "visual-difference")
    wanted = measure_all(Subject.of_images(exemplar, as_exemplar(pixels[48:, 48:])), ids)
    assert own_measures(exemplar, ids) == wanted
    assert set(wanted) == set(ids)
    assert own_measures(as_exemplar(pixels)) == {}
