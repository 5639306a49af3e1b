"""Colours of maps: places on a bar, keys, labels."""

import subprocess
import sys

import numpy as np
import pytest

from texlab.style import colouring
from texlab.style.colouring import Scale, colour_map
from texlab_core.engine.steps import Map


def test_diverging_is_white_at_zero_and_symmetric():
    colours = colouring.diverging(np.array([[-2.0, -1.0, 0.0, 1.0, 2.0]], np.float32), 1.0)[0].astype(int)
    assert colours.shape == (5, 3)
    assert np.all(np.abs(colours[2] - 247) <= 1)
    assert tuple(colours[0]) == tuple(colours[1]) == (33, 102, 172)
    assert tuple(colours[3]) == tuple(colours[4]) == (178, 24, 43)


def test_gray_spans_black_to_white():
    assert colouring.gray(np.array([-1.0, 0.0, 0.5, 1.0, 9.0], np.float32))[:, 0].tolist() == [0, 0, 128, 255, 255]


def test_log_scale_inverts_itself():
    scale = Scale(0, 999, "log")
    places = scale.place([0, 9, 99, 999])
    assert places == pytest.approx([0, 1 / 3, 2 / 3, 1], abs=1e-6)
    assert [scale.value(float(place)) for place in places] == pytest.approx([0, 9, 99, 999], rel=1e-4, abs=1e-4)


def test_ticks_are_round_and_lie_on_the_bar():
    assert [value for _, value in Scale(0.0, 1.0).ticks()] == pytest.approx([0, 0.5, 1])
    assert [value for _, value in Scale(-3.0, 5.2).ticks()] == pytest.approx([-3, 0, 5.2])
    assert [value for _, value in Scale(0.1, 0.87).ticks()] == pytest.approx([0.1, 0.2, 0.4, 0.6, 0.8, 0.87])
    assert Scale(2.0, 2.0).ticks() == [(0.0, 2.0)]
    for place, value in Scale(0.1, 900, "log").ticks():
        assert Scale(0.1, 900, "log").value(place) == pytest.approx(value, rel=1e-4)


@pytest.mark.parametrize("data", [np.zeros((3, 4)), np.full((3, 4), 7.0)])
def test_a_constant_map_has_one_colour(data):
    for kind in ("count", "scalar"):
        picture = colour_map(Map(data.astype(np.float32), kind, "constant"))
        assert picture.shape == (3, 4, 3)
        assert picture.dtype == np.uint8
        assert len(np.unique(picture.reshape(-1, 3), axis=0)) == 1


def test_unknown_scalars_are_gray():
    data = np.array([[0.0, np.nan], [1.0, np.inf]], np.float32)
    picture = colour_map(Map(data, "scalar", "error"))
    assert tuple(picture[0, 1]) == colouring.NOTHING
    assert tuple(picture[0, 0]) != tuple(picture[1, 0])


def test_every_scalar_unknown():
    picture = colour_map(Map(np.full((2, 2), np.nan, np.float32), "scalar", "error"))
    assert np.all(picture == colouring.NOTHING)


def test_identity_source_map_shows_the_key():
    rows, columns = np.mgrid[:40, :60]
    picture = colour_map(Map(np.stack([rows, columns], -1).astype(np.int32), "source", "source"), (40, 60))
    assert np.array_equal(picture, colouring.source_key(40, 60))


# Machado, Oliveira and Fernandes 2009, severity 1: linear RGB as dichromats see it.
SIGHT = {
    "trichromat": np.eye(3),
    "deuteranope": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "protanope": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
}


def lab(colours, sight):
    """Return CIE Lab (D65) of sRGB colours, 0 .. 255, as somebody sees them."""
    share = colours / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ np.array(SIGHT[sight]).T, 0, 1)
    to_xyz = [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.072175],
        [0.0193339, 0.119192, 0.9503041],
    ]
    xyz = seen @ np.array(to_xyz).T / (0.95047, 1.0, 1.08883)
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


@pytest.mark.parametrize("sight", SIGHT)
def test_places_far_apart_look_different_to_everybody(sight):
    side = 24
    seen = lab(colouring.source_key(side, side).reshape(-1, 3), sight)
    places = np.stack(np.indices((side, side)), -1).reshape(-1, 2) / side
    far = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) > 0.4
    difference = np.sqrt(((seen[:, None] - seen[None]) ** 2).sum(-1))
    assert difference[far].min() > 20


def test_pixels_without_a_source_are_gray():
    source = np.array([[[-1, -1], [3, 4]]], np.int32)
    picture = colour_map(Map(source, "source", "source"), (8, 8))
    assert tuple(picture[0, 0]) == colouring.NOTHING
    assert tuple(picture[0, 1]) != colouring.NOTHING


def test_large_sources_use_a_small_key():
    source = np.array([[[0, 0], [4999, 7999]]], np.int32)
    picture = colour_map(Map(source, "source", "source"), (5000, 8000))
    key = colouring.source_key(256, 256)
    assert np.array_equal(picture[0], [key[0, 0], key[-1, -1]])


def test_labels_get_colours_of_their_own():
    labels = np.arange(60, dtype=np.int32).reshape(6, 10)
    picture = colour_map(Map(labels, "label", "regions"))
    assert tuple(picture[0, 0]) == colouring.NOTHING
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) == 60
    table = colouring.label_table(60).astype(int)
    assert np.abs(np.diff(table[1:], axis=0)).max(1).min() > 40


def test_label_sizes_are_sorted_and_leave_out_zero():
    labels = np.array([[0, 0, 0, 2], [2, 2, 1, 5]], np.int32)
    assert colouring.label_sizes(labels) == [(2, 3), (1, 1), (5, 1)]
    assert colouring.label_sizes(np.zeros((2, 2), np.int32)) == []


def test_edges_are_darkened():
    labels = np.array([[1, 1, 2, 2]], np.int32)
    picture = np.full((1, 4, 3), 90, np.uint8)
    assert colouring.mark_edges(picture, labels)[0, :, 0].tolist() == [90, 30, 90, 90]


def test_needs_no_qt():
    code = "import sys, texlab.style.colouring; sys.exit(any('PySide6' in name for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
