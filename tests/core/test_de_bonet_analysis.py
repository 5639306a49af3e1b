"""Quadtree order, oriented filters, normalized features, collapse."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texlab_core.methods.de_bonet.analysis import analyze_steps
from texlab_core.methods.de_bonet.channels import planes_of
from texlab_core.methods.de_bonet.collapse import coarsest, collapse_steps
from texlab_core.methods.de_bonet.fitting import choose_depth
from texlab_core.methods.de_bonet.quadtree import Grid
from texlab_core.transforms import gaussian, laplacian
from texlab_core.transforms.fourier import periodic_component
from texlab_core.transforms.oriented import derivatives, kernels
from texlab_core.work.tasks import finish


def pixels(height: int, width: int, channels: int = 1, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((height, width, channels)).astype(np.float32)


@given(st.integers(1, 5), st.integers(1, 5), st.integers(0, 4))
def test_quadtree_order(rows: int, columns: int, depth: int) -> None:
    grid = Grid(rows, columns, depth)
    for level in range(depth + 1):
        order, places = grid.order(level), grid.coordinates(level)
        height, width = grid.shape(level)
        assert sorted(order.ravel()) == list(range(grid.count(level)))
        for row, column in ((0, 0), (height - 1, width // 2), (height // 3, width - 1)):
            place = grid.location(level, row, column)
            assert place == order[row, column]
            assert tuple(places[place]) == (row, column)
            if level < depth:
                assert place >> 2 == grid.location(level + 1, row // 2, column // 2)
                assert place & 3 == 2 * (row % 2) + column % 2


def test_covering() -> None:
    assert Grid.covering(33, 64, 4) == Grid(3, 4, 4)
    assert Grid.covering(1, 1, 3) == Grid(1, 1, 3)


@pytest.mark.parametrize(
    ("size", "smallest", "depth"),
    [
        ((128, 128), 8, 4),
        ((128, 128), 1, 7),
        ((255, 255), 8, 4),
        ((143, 143), 8, 3),
        ((7, 90), 8, 0),
        ((1, 1), 1, 0),
    ],
)
def test_depth(size: tuple[int, int], smallest: int, depth: int) -> None:
    found = choose_depth(*size, smallest)
    if size == (255, 255):
        # 240 of 255 would lose more than the allowed share of the area, or just not.
        lost = 1 - (240 / 255) ** 2
        depth = 4 if lost <= 0.15 else 3
    assert found == depth


@pytest.mark.parametrize("size", [3, 5, 7, 9])
def test_kernels_are_exact_on_polynomials(size: int) -> None:
    smooth, first, second = kernels(size)
    x = np.arange(size) - size // 2
    np.testing.assert_allclose([smooth.sum(), (x * smooth).sum()], [1, 0], atol=1e-12)
    np.testing.assert_allclose([first.sum(), (x * first).sum(), (x**2 * first).sum()], [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose([second.sum(), (x * second).sum(), (x**2 * second).sum()], [0, 0, 2], atol=1e-12)


@pytest.mark.parametrize("orientations", [2, 3, 4, 8])
def test_derivatives_of_polynomials(orientations: int) -> None:
    y, x = np.mgrid[:20, :24].astype(np.float32)
    plane = 0.3 * x - 0.7 * y
    bowl = 0.02 * x * x + 0.05 * x * y - 0.01 * y * y
    first, second = derivatives(plane, 1, orientations), derivatives(bowl, 2, orientations)
    for k in range(orientations):
        angle = math.pi * k / orientations
        # Counter-clockwise from the horizontal, rows counting downwards.
        along = np.array([math.cos(angle), -math.sin(angle)])
        np.testing.assert_allclose(first[k, 4:-4, 4:-4], along @ [0.3, -0.7], atol=1e-5)
        hessian = np.array([[0.04, 0.05], [0.05, -0.02]])
        np.testing.assert_allclose(second[k, 4:-4, 4:-4], along @ hessian @ along, atol=1e-4)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("border", ["reflect", "periodic"])
def test_derivatives_turn_with_the_image(order: int, border: str) -> None:
    image = pixels(16, 16)[..., 0]
    straight = derivatives(image, order, 4, border=border)
    turned = derivatives(np.rot90(image).copy(), order, 4, border=border)
    for k in range(4):
        other = (k + 2) % 4
        sign = -1 if order == 1 and k + 2 >= 4 else 1
        np.testing.assert_allclose(turned[other], sign * np.rot90(straight[k]), atol=1e-6)


def test_periodic_derivatives_commute_with_shifts() -> None:
    image = pixels(12, 16, 3)
    shifted = derivatives(np.roll(image, (5, 3), (0, 1)), 2, 4, border="periodic")
    np.testing.assert_allclose(
        shifted, np.roll(derivatives(image, 2, 4, border="periodic"), (5, 3), (1, 2)), atol=1e-6
    )


def test_derivatives_refuse_small_images() -> None:
    with pytest.raises(ValueError, match="does not fit"):
        derivatives(np.zeros((4, 9), np.float32), 1, 4)


@pytest.mark.parametrize("border", ["reflect", "periodic"])
@pytest.mark.parametrize("channels", [1, 3])
def test_bands_are_the_laplacian_pyramid(border: str, channels: int) -> None:
    image = pixels(48, 64, channels)
    analysis = finish(analyze_steps(image, smallest=3, border=border))
    assert analysis.depth == 4
    for level, band in enumerate(laplacian.build(image.astype(np.float64), 4, border)):
        places = analysis.levels[level].coordinates
        np.testing.assert_allclose(analysis.levels[level].band, band[places[:, 0], places[:, 1]], atol=1e-6)


@pytest.mark.parametrize("border", ["reflect", "periodic"])
def test_features_from_first_principles(border: str) -> None:
    image = pixels(40, 24, 3)
    analysis = finish(analyze_steps(image, smallest=3, border=border, orientations=3))
    assert analysis.depth == 3
    pyramid, bands = gaussian.build(image, 3, border), laplacian.build(image, 3, border)
    for level in (1, 2, 3):
        each = analysis.levels[level]
        for column, feature in enumerate(analysis.features):
            channel = ("red", "green", "blue").index(feature.channel)
            if feature.kind == "laplacian":
                values = bands[level][..., channel]
            elif min(pyramid[level].shape[:2]) < 5:
                # Eq. 7: a level smaller than the filter.
                assert not each.features[:, column].any()
                assert each.scale[column] == np.inf
                continue
            else:
                order = 1 if feature.kind == "first" else 2
                found = derivatives(pyramid[level][..., channel], order, 3, border=border)
                values = found[round(feature.angle / 60)]
            values = values.astype(np.float64)
            np.testing.assert_allclose(each.scale[column], values.var(), rtol=1e-3)
            expected = (values / values.std())[each.coordinates[:, 0], each.coordinates[:, 1]]
            np.testing.assert_allclose(each.features[:, column], expected, atol=2e-3)


@pytest.mark.parametrize("normalization", ["variance", "level", "range", "sum", "printed"])
def test_scales(normalization: str) -> None:
    image = pixels(32, 32, 1)
    unit = finish(analyze_steps(image, smallest=8, normalization="variance")).levels[1]
    raw = unit.features.astype(np.float64) * np.sqrt(unit.scale)
    expected = {
        "variance": raw.var(0),
        "level": np.full(9, raw.var(0).mean()),
        "range": np.ptp(raw, axis=0) ** 2,
        "sum": (raw**2).sum(0),
        "printed": abs(raw.sum(0)),
    }[normalization]
    scale = finish(analyze_steps(image, smallest=8, normalization=normalization)).levels[1].scale
    np.testing.assert_allclose(scale, expected, rtol=1e-4)


def test_constant_features_are_ignored() -> None:
    analysis = finish(analyze_steps(np.full((32, 32, 1), 0.3, np.float32)))
    for level in analysis.levels[1:]:
        assert np.isinf(level.scale).all()
        assert not level.features.any()
        assert not level.classes.any()


def test_luminance_alone() -> None:
    image = pixels(32, 32, 3)
    gray = (image @ np.array([0.299, 0.587, 0.114], np.float32))[..., None]
    colour = finish(analyze_steps(image, channels="luminance"))
    mono = finish(analyze_steps(gray))
    assert colour.feature_names == mono.feature_names
    assert colour.channels == 3
    for one, other in zip(colour.levels[1:], mono.levels[1:], strict=True):
        np.testing.assert_allclose(one.features, other.features, atol=1e-3)


def test_classes_are_equal_rows() -> None:
    image = np.round(pixels(32, 32) * 1.2)
    image[8:, 8:] = 0.25
    level = finish(analyze_steps(image, smallest=4)).levels[1]
    _, expected = np.unique(level.features, axis=0, return_inverse=True)
    same = level.classes[:, None] == level.classes[None, :]
    np.testing.assert_array_equal(same, expected.ravel()[:, None] == expected.ravel()[None, :])
    assert level.classes.max() + 1 < level.classes.size


@pytest.mark.parametrize("border", ["reflect", "periodic"])
@pytest.mark.parametrize("shape", [(64, 48, 1), (32, 80, 3), (16, 16, 3)])
def test_collapse_of_the_exemplars_own_bands_is_the_exemplar(border: str, shape: tuple[int, int, int]) -> None:
    image = pixels(*shape, seed=3)
    analysis = finish(analyze_steps(image, smallest=1, border=border))
    grid = analysis.grid
    grown = coarsest(analysis, grid, np.arange(grid.count(grid.depth), dtype=np.int32))
    for level in range(grid.depth - 1, -1, -1):
        source = np.arange(grid.count(level), dtype=np.int32)
        grown = finish(collapse_steps(analysis, grid, level, grown, source, border == "periodic"))
    np.testing.assert_array_equal(grown, image)


def test_cropped_to_the_centre() -> None:
    image = pixels(37, 66)
    analysis = finish(analyze_steps(image, smallest=4))
    assert analysis.grid.shape(0) == (36, 64)
    assert analysis.rows.tolist() == list(range(36))
    assert analysis.columns.tolist() == list(range(1, 65))
    assert analysis.whole == (9, 16) == (analysis.grid.rows, analysis.grid.columns)
    assert "cropped from 66 x 37 to 64 x 36" in analysis.notes[0]


@pytest.mark.parametrize("border", ["reflect", "periodic", "smooth"])
@pytest.mark.parametrize(("size", "depth", "padded"), [((37, 66), 2, (40, 68)), ((64, 48), 3, (64, 48))])
def test_padded_as_the_border_says(
    border: str, size: tuple[int, int], depth: int, padded: tuple[int, int]
) -> None:
    image = pixels(*size, 3)
    analysis = finish(analyze_steps(image, smallest=5, fitting="pad", border=border))
    assert (analysis.depth, analysis.grid.shape(0)) == (depth, padded)
    assert analysis.whole == (size[0] >> depth, size[1] >> depth)
    for own, old, new in ((analysis.rows, size[0], padded[0]), (analysis.columns, size[1], padded[1])):
        beyond = [2 * (old - 1) - i if border == "reflect" else i - old for i in range(old, new)]
        assert own.tolist() == [*range(old), *beyond]
    # The bands add up to the padded exemplar.
    expected = periodic_component(image) if border == "smooth" else image
    expected = expected[np.ix_(analysis.rows, analysis.columns)]
    bands = laplacian.build(expected.astype(np.float64), depth, analysis.border)
    for level, band in enumerate(bands):
        places = analysis.levels[level].coordinates
        np.testing.assert_allclose(analysis.levels[level].band, band[places[:, 0], places[:, 1]], atol=1e-6)
    said = [note for note in analysis.notes if "padded from 66 x 37 to 68 x 40" in note]
    assert len(said) == (padded != size)


def test_padding_and_cropping_change_the_area_by_at_most_15_percent() -> None:
    for height in range(5, 140, 3):
        for width in (17, 64, 97, 131):
            for smallest in (1, 3, 8):
                for fitting in ("pad", "crop"):
                    depth = choose_depth(height, width, smallest, fitting)
                    side = 2**depth
                    assert depth == 0 or min(height, width) // side >= smallest
                    up = -1 if fitting == "pad" else 1
                    area = np.prod([up * (up * old // side) * side for old in (height, width)])
                    assert abs(area / (height * width) - 1) <= 0.15


def test_principal_axes() -> None:
    """Colours along two directions: two axes, in the order of their variance; what is constant is no axis."""
    random = np.random.default_rng(3)
    first, second = random.normal(0, 0.1, (2, 32, 32, 1))
    colour = 0.5 + first * np.array([0.8, 0.6, 0.0]) + 0.4 * second * np.array([0.0, 0.0, -1.0])
    planes = planes_of(colour.astype(np.float32), "principal")
    assert planes.names == ("axis-1", "axis-2")
    np.testing.assert_allclose(planes.axes, [[0.8, 0], [0.6, 0], [0, 1]], atol=0.05)
    analysis = finish(analyze_steps(colour.astype(np.float32), channels="principal"))
    assert {feature.channel for feature in analysis.features} == {"axis-1", "axis-2"}
    assert analysis.levels[0].band.shape[1] == 3
    assert planes_of(np.full((8, 8, 3), 0.5, np.float32), "principal").names == ("axis-1",)
    gray = pixels(16, 16)
    assert planes_of(gray, "principal").see(gray) is gray


def test_scaled_thresholds_are_thresholds_times_the_channels() -> None:
    image = pixels(32, 32, 3)
    every, scaled = (finish(analyze_steps(image, channels=channels)) for channels in ("all", "scaled"))
    assert every.feature_names == scaled.feature_names
    for one, other in zip(every.levels[1:], scaled.levels[1:], strict=True):
        np.testing.assert_allclose(other.scale, 3 * one.scale)
        np.testing.assert_allclose(other.features, one.features / np.sqrt(3), rtol=1e-5)
    gray = pixels(32, 32)
    one, other = (finish(analyze_steps(gray, channels=channels)) for channels in ("all", "scaled"))
    np.testing.assert_array_equal(one.levels[1].features, other.levels[1].features)


def test_periodic_component_has_no_jump() -> None:
    y, x = np.mgrid[:32, :48]
    ramp = (0.01 * x + 0.003 * y)[..., None].astype(np.float32)
    ripple = 0.1 * np.sin(2 * np.pi * 3 * x / 48)[..., None].astype(np.float32)
    component = periodic_component(ramp + ripple)

    def jump(image: np.ndarray) -> float:
        return float(np.abs(image[:, 0] - image[:, -1]).mean())

    assert jump(component) < 0.2 * jump(ramp + ripple)
    # A periodic image without jumps is left as it is, and the mean is kept.
    flat = np.full((16, 16, 3), 0.4, np.float32)
    np.testing.assert_allclose(periodic_component(flat), flat, atol=1e-6)
    np.testing.assert_allclose(component.mean(), (ramp + ripple).mean(), atol=1e-6)
