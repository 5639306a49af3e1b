"""Efros-Leung equals a plain brute force: in picture, sources, match sets and distances."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.core.efros_leung_oracle import Oracle
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.efros_leung.params import EfrosLeungParams
from texlab_core.methods.efros_leung.windows import FULL_SPREAD, effective_tau, integer_weights, offsets

if TYPE_CHECKING:
    from texlab_core.engine.result import Result
    from texlab_core.methods.efros_leung.fill import Anchor

SHAPES = ("square", "disc", "cross", "causal")
CRITERIA = ("ssd", "flat-ssd", "sad", "ncc")


def texture(height: int, width: int, channels: int = 1, *, seed: int = 0, levels: int = 256) -> np.ndarray:
    """Return stripes with noise, (height, width, channels) uint8."""
    random = np.random.default_rng(seed)
    rows, columns = np.indices((height, width))
    stripes = 110 + 80 * np.sin(0.9 * columns + 0.3 * rows)[..., None] * np.linspace(1, 0.3, channels)
    noisy = np.clip(stripes + random.normal(0, 20, (height, width, channels)), 0, 255)
    return (np.floor(noisy / 256 * levels) * (255 / max(levels - 1, 1))).astype(np.uint8)


def image(values: np.ndarray) -> Any:
    return as_exemplar(values)


def oracle_for(result: Result, known: np.ndarray, start: np.ndarray, **more: Any) -> Oracle:
    """Return the brute force for the job of a result, grown to its end."""
    params = result.job.params
    assert isinstance(params, EfrosLeungParams)
    exemplar = np.rint(result.job.inputs["exemplar"].pixels * 255).astype(int)
    places = offsets(params.shape, params.window)
    weights = integer_weights(places, params.window, params.criterion, exemplar.shape[2])
    streams = Streams(result.job.seed)
    matching = params.matching(result.job.inputs["exemplar"])
    limit = matching.limit
    return Oracle(
        exemplar=exemplar,
        image=start,
        known=known,
        weights={(int(y), int(x)): int(w) for (y, x), w in zip(places, weights, strict=True)},
        shape=params.shape,
        window=params.window,
        criterion=params.criterion,
        eps=Fraction(round(params.eps * 10**6), 10**6),
        tau=Fraction(round(matching.tau * 1000), 1000),
        limit=limit,
        periodic=params.border == "periodic",
        tiles=params.tiles and params.shape != "causal",
        choice_key=streams.key("choice"),
        order_key=streams.key("order"),
        **more,
    ).run()


def assert_equal(result: Result, known: np.ndarray, start: np.ndarray, **more: Any) -> None:
    expected = oracle_for(result, known, start, **more)
    filled = ~known
    np.testing.assert_array_equal(result.maps["order"].data, expected.order)
    np.testing.assert_array_equal(result.maps["matches"].data, expected.matches)
    np.testing.assert_array_equal(result.maps["source"].data[filled], expected.source[filled])
    np.testing.assert_array_equal(np.rint(result.image * 255)[filled], expected.image[filled])
    np.testing.assert_array_equal(result.maps["distance"].data, expected.d_min.astype(np.float32))


def check_grown(exemplar: np.ndarray, size: tuple[int, int], seed: int = 1, **params: Any) -> Result:
    """Grow from a seed patch and compare."""
    settings = EfrosLeungParams(**({"window": 5, "tau": 0.0} | params))
    result = run(
        Job(method="efros-leung", inputs={"exemplar": image(exemplar)}, params=settings, size=size, seed=seed)
    )
    known = result.maps["order"].data == 0
    side = min(settings.seed_patch, *size, *exemplar.shape[:2])
    assert known.sum() == side * side
    start = np.rint(result.image * 255).astype(int) * known[..., None]
    assert_equal(result, known, start)
    return result


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("criterion", CRITERIA)
@pytest.mark.parametrize("channels", [1, 3])
def test_every_shape_and_criterion(shape: str, criterion: str, channels: int) -> None:
    check_grown(texture(14, 17, channels), (9, 12), shape=shape, criterion=criterion, eps=0.3)


@pytest.mark.parametrize("criterion", CRITERIA)
@pytest.mark.parametrize("tau", [2.5, 60.0])
def test_absolute_threshold(criterion: str, tau: float) -> None:
    result = check_grown(texture(13, 15), (10, 9), criterion=criterion, tau=tau)
    assert tau < 60 or result.maps["matches"].data.max() > 1


@pytest.mark.parametrize("criterion", CRITERIA)
@pytest.mark.parametrize("shape", ["square", "causal"])
@pytest.mark.parametrize(
    "exemplar",
    [
        np.full((9, 11, 1), 200, np.uint8),
        np.full((9, 9, 3), 255, np.uint8),
        ((np.indices((11, 12)).sum(0) % 2) * 255).astype(np.uint8)[..., None],
        texture(12, 12, levels=2),
    ],
    ids=["flat", "white", "checkerboard", "two-levels"],
)
def test_flat_and_checkerboard(exemplar: np.ndarray, criterion: str, shape: str) -> None:
    check_grown(exemplar, (8, 9), criterion=criterion, shape=shape)


@pytest.mark.parametrize("criterion", CRITERIA)
@pytest.mark.parametrize("shape", SHAPES)
def test_periodic_exemplar_and_tiles(criterion: str, shape: str) -> None:
    check_grown(texture(7, 9), (8, 7), criterion=criterion, shape=shape, border="periodic", tiles=True)
    check_grown(texture(12, 13), (6, 7), criterion=criterion, shape=shape, tiles=True, window=7)


def test_windows_larger_than_a_periodic_exemplar_and_the_tile() -> None:
    check_grown(texture(3, 4), (5, 4), border="periodic", tiles=True, window=13)


@pytest.mark.parametrize("criterion", CRITERIA)
@pytest.mark.parametrize("limit", [0.5, 12.0])
def test_growing_error_limit(criterion: str, limit: float) -> None:
    result = check_grown(texture(12, 13), (9, 8), criterion=criterion, error_limit=limit)
    plain = check_grown(texture(12, 13), (9, 8), criterion=criterion)
    # A pixel that finds nothing waits, so that the order depends on the data.
    assert limit > 1 or (result.maps["order"].data != plain.maps["order"].data).any()


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("border", ["inside", "periodic"])
def test_holes_in_the_exemplar(shape: str, border: str) -> None:
    exemplar = texture(16, 17, 3)
    hole = np.zeros((16, 17), bool)
    hole[5:9, 6:11] = hole[0, 0] = True
    params = EfrosLeungParams(window=5, shape=shape, border=border, tau=4.0)
    inputs = {"exemplar": image(exemplar), "mask": image(hole * np.uint8(255))}
    result = run(Job(method="efros-leung", inputs=inputs, params=params, seed=5))
    known = ~hole
    np.testing.assert_array_equal(result.image[known], inputs["exemplar"].pixels[known])
    np.testing.assert_array_equal(result.maps["source"].data[known], np.argwhere(known))
    assert_equal(result, known, exemplar.astype(int) * known[..., None], hole=hole)


def test_a_search_region_and_another_image_to_fill() -> None:
    exemplar, start = texture(13, 14, seed=1), texture(11, 10, seed=2)
    region = np.zeros((13, 14), bool)
    region[2:9, 3:12] = True
    mask = np.zeros((11, 10), np.uint8)
    mask[3:7, 2:6] = 1
    inputs = {
        name: image(value) for name, value in {"exemplar": exemplar, "start": start, "mask": mask * 255}.items()
    }
    inputs["region"] = image(region * np.uint8(255))
    job = Job(method="efros-leung", inputs=inputs, params=EfrosLeungParams(window=5), size=(11, 10), seed=3)
    result = run(job)
    known = mask == 0
    np.testing.assert_array_equal(result.image[known], inputs["start"].pixels[known])
    assert (result.maps["source"].data[known] == -1).all()
    assert region[tuple(result.maps["source"].data[~known].T)].all()
    assert_equal(result, known, start.astype(int) * known[..., None], region=region)


@pytest.mark.parametrize("anchor", ["center", "top-left", "bottom", "right"])
def test_growing_an_image_outward(anchor: Anchor) -> None:
    exemplar = texture(12, 13)
    inputs = {"exemplar": image(exemplar), "start": image(texture(4, 5, seed=4))}
    params = EfrosLeungParams(window=5, anchor=anchor)
    result = run(Job(method="efros-leung", inputs=inputs, params=params, size=(9, 8)))
    top = {"center": 2, "top-left": 0, "bottom": 5, "right": 2}[anchor]
    left = {"center": 1, "top-left": 0, "bottom": 1, "right": 3}[anchor]
    known = np.zeros((9, 8), bool)
    known[top : top + 4, left : left + 5] = True
    start = np.zeros((9, 8, 1), int)
    start[known] = texture(4, 5, seed=4).reshape(-1, 1)
    np.testing.assert_array_equal(result.image[known], inputs["start"].pixels.reshape(-1, 1))
    assert_equal(result, known, start)


@settings(max_examples=30)
@given(data=st.data())
def test_any_setting(data: st.DataObject) -> None:
    channels = data.draw(st.sampled_from([1, 3]))
    levels = data.draw(st.sampled_from([2, 5, 256]))
    exemplar = texture(data.draw(st.integers(7, 13)), data.draw(st.integers(7, 13)), channels, levels=levels)
    check_grown(
        exemplar,
        (data.draw(st.integers(1, 8)), data.draw(st.integers(1, 8))),
        seed=data.draw(st.integers(0, 99)),
        window=data.draw(st.sampled_from([3, 5, 7])),
        shape=data.draw(st.sampled_from(SHAPES)),
        criterion=data.draw(st.sampled_from(CRITERIA)),
        eps=data.draw(st.floats(0, 2)),
        tau=data.draw(st.floats(0, 60)),
        error_limit=data.draw(st.sampled_from([0.0, 1.0, 30.0])),
        border=data.draw(st.sampled_from(["inside", "periodic"])),
        tiles=data.draw(st.booleans()),
        seed_patch=data.draw(st.integers(1, 5)),
    )


@pytest.mark.slow
def test_blocks_and_survivors_on_a_larger_exemplar() -> None:
    for levels, tau in ((256, 0.0), (256, 6.0), (3, 0.0)):
        check_grown(texture(44, 47, 1, levels=levels), (12, 13), window=9, tau=tau)


def neighbour_correlation(pixels: np.ndarray) -> float:
    plane = pixels[..., 0].astype(np.float64)
    return float(np.corrcoef(plane[:, 1:].ravel(), plane[:, :-1].ravel())[0, 1])


def test_a_relative_tau_follows_the_contrast() -> None:
    """An exemplar whose values span 12 gray levels: texture, where an absolute tau of 3 makes noise of it."""
    y, x = np.mgrid[:40, :40]
    waves = np.sin(x / 3.1 + 0.7 * np.sin(y / 4.3)) + np.sin(y / 2.7)
    values = np.float32(80 + 6 * waves / np.abs(waves).max())[..., None] / 255
    job = {"method": "efros-leung", "inputs": {"exemplar": as_exemplar(values)}, "size": (32, 32)}
    relative, absolute = (
        run(Job(**job, params=EfrosLeungParams(window=9, tau_scale=scale))).image
        for scale in ("relative", "absolute")
    )
    own = neighbour_correlation(values)
    assert own > 0.9
    assert neighbour_correlation(relative) > 0.95 * own
    assert neighbour_correlation(absolute) < 0.5 * own


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("spread", [0.0, 1.0, 10.0, 40.0, 90.0])
def test_effective_tau(spread: float, channels: int) -> None:
    signs = np.where(np.arange(64 * channels).reshape(8, 8, channels) // channels % 2 == 0, 1.0, -1.0)
    pixels = np.float32(0.5 + signs * spread / 255)
    expected = 3 * min(1, spread / FULL_SPREAD)
    for criterion in ("ssd", "flat-ssd", "sad"):
        assert effective_tau(3.0, "relative", criterion, pixels) == pytest.approx(expected, rel=1e-5)
        assert effective_tau(3.0, "absolute", criterion, pixels) == 3.0
    assert effective_tau(3.0, "relative", "ncc", pixels) == 3.0
