"""Solids as objects: colours against the volume at the very point of the surface, outlines, shading, wrapping."""

from __future__ import annotations

import math

import numpy as np
import pytest

from texlab_core.errors import Cancelled, InputError
from texlab_core.kernels import solids as kernel
from texlab_core.solids.rendering import DARK, DISTANCE, SHAPES, Shape, View, render, render_wrapped

SIDE = 64


def positions(first: int, second: int, side: int = SIDE) -> np.ndarray:
    """Return a volume whose red and green tell two coordinates (0 right, 1 up, 2 front); blue is one half."""
    ramp = 0.5 + 0.45 * ((np.arange(side) + 0.5) / side * 2 - 1)
    places = np.broadcast_arrays(ramp, ramp[::-1, None], ramp[::-1, None, None])
    return np.stack([places[first], places[second], np.full((side,) * 3, 0.5)], axis=-1).astype(np.float32)


def rays(view: View, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the eye (3,) and the directions (size, size, 3) in object space, from a view's definition."""
    half = np.ones(3)
    radius = {
        "block": math.sqrt(3),
        "sphere": kernel.RADIUS,
        "cylinder": kernel.RADIUS * math.hypot(1, half[1]),
        "torus": kernel.RING + kernel.TUBE,
    }[view.shape]
    scale = view.zoom * 0.96 * size / 2 / (radius / math.sqrt(1 - (radius / DISTANCE) ** 2))
    places = (np.arange(size) + 0.5 - size / 2) / scale
    toward = np.stack(np.broadcast_arrays(places[None], -places[:, None], -DISTANCE), axis=-1)
    toward /= np.linalg.norm(toward, axis=-1, keepdims=True)
    back = view.matrix.T
    return back @ np.array([0, 0, DISTANCE]), toward @ back.T


def implicit(shape: Shape, p: np.ndarray) -> np.ndarray:
    """Return how far points are from the surface, up to a factor near 1."""
    x, y, z = np.moveaxis(p, -1, 0)
    if shape == "sphere":
        return np.abs(np.sqrt(x * x + y * y + z * z) - kernel.RADIUS)
    if shape == "cylinder":
        flat = np.sqrt(x * x + z * z)
        return np.abs(np.maximum(flat, np.abs(y)) - kernel.RADIUS)
    if shape == "torus":
        ring = np.sqrt(x * x + z * z) - kernel.RING
        return np.abs(np.sqrt(ring * ring + y * y) - kernel.TUBE)
    block = np.abs(p).max(axis=-1) - 1
    hole = kernel.CARVED - np.sqrt(((p - 1) ** 2).sum(axis=-1))
    return np.abs(np.maximum(block, hole))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("yaw", "pitch"), [(-30, 24), (0, 0), (130, -40), (75, 89)])
def test_a_point_has_the_volumes_colour_there(shape: Shape, yaw: float, pitch: float) -> None:
    view, size = View(shape, yaw, pitch), 72
    found = []
    for first, second in ((0, 1), (2, 0)):
        picture = render(positions(first, second), view, (size, size), background=(0, 0, 0)).astype(np.float64)
        seen = picture[..., 2] > 0
        # Blue is half the shade.
        found.append((picture[..., :2] / np.maximum(2 * picture[..., 2:], 1) - 0.5) / 0.45)
    assert seen.sum() > size * size / 8
    places = np.stack([found[0][..., 0], found[0][..., 1], found[1][..., 0]], axis=-1)[seen]
    eye, toward = rays(view, size)
    away = implicit(shape, places)
    beside = np.linalg.norm(np.cross(places - eye, toward[seen]), axis=-1)
    # At 8 bits, and at half a voxel from the sides, places are known to a few hundredths.
    assert np.median(away) < 0.025
    assert np.quantile(away, 0.95) < 0.06
    assert np.median(beside) < 0.02
    assert np.quantile(beside, 0.95) < 0.06


@pytest.mark.parametrize("shape", SHAPES)
def test_outlines_lie_where_the_rays_miss(shape: Shape) -> None:
    view, size = View(shape, 20, 35), 72
    picture = render(np.ones((8, 8, 8, 1), np.float32), view, (size, size), background=(0, 0, 0))
    eye, toward = rays(view, size)
    # Brute force: is any of many points on the ray inside?
    steps = np.linspace(DISTANCE - 2, DISTANCE + 2, 800)
    points = eye + steps[:, None, None, None] * toward
    x, y, z = np.moveaxis(points, -1, 0)
    if shape == "sphere":
        inside = x * x + y * y + z * z < kernel.RADIUS**2
    elif shape == "cylinder":
        inside = (x * x + z * z < kernel.RADIUS**2) & (np.abs(y) < kernel.RADIUS)
    elif shape == "torus":
        inside = (np.sqrt(x * x + z * z) - kernel.RING) ** 2 + y * y < kernel.TUBE**2
    else:
        inside = (np.abs(points) < 1).all(axis=-1) & (((points - 1) ** 2).sum(axis=-1) > kernel.CARVED**2)
    wrong = (picture.sum(axis=-1) > 0) != inside.any(axis=0)
    # Rays that only graze the surface may go either way.
    assert wrong.mean() < 0.004


def test_the_front_of_a_block_is_slice_zero() -> None:
    volume = np.random.Generator(np.random.PCG64(2)).random((16, 16, 16, 1), dtype=np.float32)
    size = 400
    picture = render(volume, View("block", 0, 0), (size, size)).astype(np.float64)
    eye, toward = rays(View("block", 0, 0), size)
    at = eye + toward * ((1 - eye[2]) / toward[..., 2:])
    column, row = (at[..., 0] + 1) * 8 - 0.5, (1 - at[..., 1]) * 8 - 0.5
    centre = (np.abs(column - np.rint(column)) < 0.04) & (np.abs(row - np.rint(row)) < 0.04)
    on_face = (np.abs(at[..., :2]) < 0.98).all(axis=-1) & (((at - 1) ** 2).sum(axis=-1) > kernel.CARVED**2 + 0.05)
    chosen = centre & on_face
    assert chosen.sum() > 100
    values = volume[0, np.rint(row[chosen]).astype(int), np.rint(column[chosen]).astype(int), 0]
    shade = picture[chosen][:, 0] / (255 * values)
    assert shade[values > 0.3].std() < 0.02


def test_shading_depends_on_the_surface_alone() -> None:
    white, gray = (np.full((8, 8, 8, 1), value, np.float32) for value in (1.0, 0.5))
    for shape in SHAPES:
        bright, dim = (render(each, View(shape)).astype(int) for each in (white, gray))
        seen = (bright != DARK).any(axis=-1)
        assert np.abs(bright - 2 * dim)[seen].max() <= 1
        wrapped = render_wrapped(np.ones((4, 4, 1), np.float32), (8, 8, 8), View(shape)).astype(int)
        np.testing.assert_array_equal(wrapped, bright)


def test_a_whole_turn_comes_back_and_a_ball_never_changes() -> None:
    assert View(yaw=10).turned(360) == View(yaw=10)
    assert View(pitch=80).turned(0, 45).pitch == 90
    ball = np.full((8, 8, 8, 3), 0.7, np.float32)
    one, other = (render(ball, View("sphere", yaw, 10)) for yaw in (0, 77))
    assert np.abs(one.astype(int) - other).max() <= 1


def test_wrapped_images_go_around_a_whole_number_of_times() -> None:
    # Stripes of the image's own width: no seam where the last copy meets the first.
    stripes = np.broadcast_to(0.5 + 0.5 * np.cos(2 * np.pi * np.arange(24) / 24)[None, :, None], (24, 24, 1))
    image = np.ascontiguousarray(stripes, np.float32)
    for yaw in (0, 180):
        picture = render_wrapped(image, (64, 64, 64), View("cylinder", yaw, 0), (200, 200), background=(0, 0, 0))
        row = picture[100, 40:160, 0].astype(int)
        assert np.abs(np.diff(row)).max() < 60


def test_the_block_has_the_volumes_proportions() -> None:
    flat = np.ones((64, 16, 32, 1), np.float32)
    seen = render(flat, View("block", 0, 0), (300, 300), background=(0, 0, 0)).sum(axis=-1) > 0
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    assert np.ptp(columns) / np.ptp(rows) == pytest.approx(2, abs=0.05)


def test_smooth_pictures_average_four_rays() -> None:
    volume = positions(0, 1, 16)
    plain = render(volume, View("sphere"), (80, 80)).astype(float)
    coarse = plain.reshape(40, 2, 40, 2, 3).mean(axis=(1, 3))
    smooth = render(volume, View("sphere"), (40, 40), smooth=True)
    assert np.abs(smooth - coarse).max() <= 1


def test_drawing_can_be_stopped() -> None:
    def stop() -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        render(positions(0, 1, 8), View(), look=stop)


def test_what_cannot_be_drawn_gets_one_sentence() -> None:
    volume = positions(0, 1, 8)
    for make, words in (
        (lambda: View("cube"), "shape: must be one of block"),  # type: ignore[arg-type]
        (lambda: View(yaw=math.nan), "yaw: must be an angle"),
        (lambda: View(zoom=0), "zoom: must be from 0.1"),
        (lambda: render(volume[..., 0], View()), "A solid to draw is"),
        (lambda: render(volume, View(), (0, 5)), "size: must be from 1"),
    ):
        with pytest.raises(InputError, match=words):
            make()
