"""The one gray of coloured pictures."""

from __future__ import annotations

import numpy as np

from texlab_core.transforms.luma import luma


def test_gray_stays_and_colours_are_weighted() -> None:
    gray = np.linspace(0, 1, 6, dtype=np.float32).reshape(2, 3, 1)
    np.testing.assert_array_equal(luma(gray), gray[..., 0])
    primaries = np.eye(3, dtype=np.float64)[None]
    np.testing.assert_allclose(luma(primaries), [[0.299, 0.587, 0.114]], atol=1e-15)
    assert luma(primaries.astype(np.float32)).dtype == np.float32
    assert luma(primaries).flags.c_contiguous
