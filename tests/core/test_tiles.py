"""Results that are said to tile: the step across their border against the steps within, over ten seeds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.transforms import gaussian, laplacian

if TYPE_CHECKING:
    from texlab_core.engine.steps import FloatImage

SEEDS = range(10)


def exemplar(height: int, width: int) -> Any:
    """Return blobs that do not tile."""
    white = np.random.default_rng(4).standard_normal((height + 12, width + 12))
    kernel = np.exp(-0.5 * (np.arange(-6, 7) / 1.6) ** 2)
    smooth = np.apply_along_axis(np.convolve, 0, white, kernel, "valid")
    smooth = np.apply_along_axis(np.convolve, 1, smooth, kernel, "valid")
    return as_exemplar(((smooth - smooth.min()) / np.ptp(smooth)).astype(np.float32)[..., None])


def steps(images: list[FloatImage], axis: int) -> np.ndarray:
    """Return the mean absolute step across every line of an axis, over all images; the last is the border's."""
    return np.mean([np.abs(image - np.roll(image, -1, axis)).mean((1 - axis, 2)) for image in images], axis=0)


def made(method: str, size: tuple[int, int], knobs: dict[str, Any], sides: tuple[int, int]) -> list[FloatImage]:
    params, cache = find_method(method).params.from_json(knobs), AnalysisCache()
    source = exemplar(*sides)
    jobs = (Job(method=method, inputs={"exemplar": source}, params=params, size=size, seed=seed) for seed in SEEDS)
    return [run(job, cache=cache).image for job in jobs]


# Method, knobs, size of the result: all that claims to tile.
CLAIMS = [
    ("heeger-bergen", {}, (64, 48)),
    ("heeger-bergen", {}, (51, 45)),
    ("heeger-bergen", {"border": "wrap"}, (51, 45)),
    ("heeger-bergen", {"pyramid": "laplacian"}, (64, 48)),
    ("heeger-bergen", {"pyramid": "laplacian"}, (51, 45)),
    ("heeger-bergen", {"pyramid": "laplacian", "border": "periodic"}, (37, 64)),
    ("heeger-bergen", {"pyramid": "textbook"}, (51, 45)),
    ("msg", {}, (64, 48)),
    ("msg", {}, (51, 45)),
    ("uncoded", {}, (51, 45)),
    ("de-bonet", {"tileable": True}, (64, 96)),
    ("de-bonet", {"tileable": True}, (128, 64)),
    ("de-bonet", {"tileable": True}, (100, 90)),
    ("de-bonet", {"tileable": True}, (75, 81)),
    ("de-bonet", {"tileable": True, "border": "smooth", "alpha": 0.3}, (128, 96)),
    ("de-bonet", {"tileable": True, "coarsest": "fit", "border": "smooth"}, (128, 192)),
    ("de-bonet", {"tileable": True, "coarsest": "tile", "border": "periodic", "alpha": 0.0}, (128, 128)),
    ("efros-leung", {"tiles": True, "window": 11}, (40, 36)),
]


@pytest.mark.parametrize(("method", "knobs", "size"), CLAIMS, ids=str)
def test_the_border_is_no_seam(method: str, knobs: dict[str, Any], size: tuple[int, int]) -> None:
    images = made(method, size, knobs, (48, 48) if method == "efros-leung" else (64, 64))
    for axis in (0, 1):
        found = steps(images, axis)
        inside, border = found[:-1], found[-1]
        # The border is a line between cells or blocks of all levels, and those are compared.
        if knobs.get("pyramid") == "textbook":
            inside = np.sort(inside)[-4:]
        elif method == "de-bonet" and all(side % 8 == 0 for side in size):
            inside = inside[7::8] if knobs.get("coarsest") is None else inside[63::64]
        if inside.size:
            assert border <= 1.12 * inside.mean(), (axis, border, inside.mean())


def test_the_former_way_at_odd_sides_has_a_seam() -> None:
    """What the test above would find: a claim that does not hold."""
    knobs = {"pyramid": "laplacian", "odd_sides": "doubled"}
    found = [steps(made("heeger-bergen", (51, 45), knobs, (64, 64)), axis) for axis in (0, 1)]
    assert max(each[-1] / each[:-1].mean() for each in found) > 1.05
    found = [steps(made("de-bonet", (64, 96), {"tileable": False}, (64, 64)), axis) for axis in (0, 1)]
    assert max(each[-1] / each[:-1].mean() for each in found) > 1.3


@pytest.mark.parametrize("mode", ["interpolate", "replicate"])
@pytest.mark.parametrize("shape", [(17, 16), (33, 47, 3), (5, 1), (64, 48), (1, 1), (3, 2)])
def test_spread_pyramids_reconstruct(shape: tuple[int, ...], mode: Any) -> None:
    image = np.random.default_rng(1).random(shape)
    levels = max(0, gaussian.max_levels(shape))
    bands = laplacian.build(image, levels, "spread", mode)
    np.testing.assert_allclose(laplacian.collapse(bands, "spread", mode), image, atol=1e-12)
    constant = laplacian.build(np.full(shape, 0.3), levels, "spread", mode)
    for band in constant[:-1]:
        np.testing.assert_allclose(band, 0, atol=1e-12)
    if all(side % 2**levels == 0 for side in shape[:2]):
        for one, other in zip(bands, laplacian.build(image, levels, "periodic", mode), strict=True):
            np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("side", [16, 17, 45])
def test_spread_filters_are_the_binomial_stretched(side: int) -> None:
    """Along an even side they are the binomial itself; every filter sums to one and looks the same everywhere."""
    impulses = np.eye(side)[:, None, :]
    # An odd side beside it chooses the spread filters for both.
    reduced = np.stack([gaussian.reduce(np.repeat(row, 3, 0), "spread")[0] for row in impulses])
    np.testing.assert_allclose(reduced.sum(0), 1)
    if side % 2 == 0:
        expected = np.stack([gaussian.reduce(np.repeat(row, 4, 0), "periodic")[0] for row in impulses])
        np.testing.assert_allclose(reduced, expected, atol=1e-12)
    # The centre of each filter lies where its sample lies.
    step = side / (-(-side // 2))
    for sample, weights in enumerate(reduced.T):
        away = (np.arange(side) - sample * step + side / 2) % side - side / 2
        assert abs((weights * away).sum()) < 0.1
        assert (weights[np.abs(away) >= 1.5 * step] == 0).all()
