"""The layout of the coarsest level: patches and repetitions that continue each other."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from texlab_core.engine.streams import Streams
from texlab_core.kernels.patches import UNKNOWN
from texlab_core.methods.de_bonet import seams as seams_module
from texlab_core.methods.de_bonet.layout import Layout, lay_out_steps
from texlab_core.methods.de_bonet.quadtree import Grid
from texlab_core.methods.de_bonet.seams import STRIP, Seams
from texlab_core.work.tasks import finish


def pixels(height: int, width: int, channels: int = 3, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((height, width, channels)).astype(np.float32)


def laid(image: np.ndarray, cells: tuple[int, int], output: tuple[int, int], seed: int = 0, **knobs) -> np.ndarray:
    """Return row and column of the source of each cell, (rows, columns, 2)."""
    depth = (image.shape[0] // cells[0]).bit_length() - 1
    seams = Seams.of(image, *cells)
    exemplar, grid = Grid(*cells, depth), Grid(*output, depth)
    steps = lay_out_steps(seams, exemplar, cells, grid, Layout(**knobs), Streams(seed))
    return np.stack(np.divmod(finish(steps).reshape(output), cells[1]), axis=-1)


def misfit(image: np.ndarray, cells: tuple[int, int], axis: int, one, other, cyclic: bool) -> float:
    """Return by brute force how badly cell ``other`` continues cell ``one`` to its right (axis 1) or below (0)."""
    image = np.round(image * 255)
    tall, wide = image.shape[0] // cells[0], image.shape[1] // cells[1]
    length = image.shape[axis]
    side = (tall, wide)[axis]
    across = np.arange((tall, wide)[1 - axis])

    def strip(line: int, start: int, cell) -> np.ndarray:
        places = np.arange(start, start + STRIP) % length
        rest = cell[1 - axis] * (tall, wide)[1 - axis] + across
        return image[np.ix_(places, rest)] if axis == 0 else image[np.ix_(rest, places)]

    lines = ((one[axis] + 1) * side, other[axis] * side)
    total, halves = 0.0, 0
    for shift in (-STRIP, 0):
        if not cyclic and any(line == (0 if shift else length) for line in lines):
            continue
        both = [strip(line, line + shift, cell) for line, cell in zip(lines, (one, other), strict=True)]
        total, halves = total + ((both[0] - both[1]) ** 2).mean(), halves + 1
    return total / halves if halves else UNKNOWN


def cost_of(
    image: np.ndarray, cells, source: np.ndarray, region: np.ndarray, cyclic: bool, periodic: bool
) -> float:
    """Return the misfit along the border of a region, all of whose neighbours count."""
    total, (rows, columns) = 0.0, region.shape
    for y, x in np.argwhere(region):
        for axis, step in itertools.product((0, 1), (-1, 1)):
            other = [y, x]
            other[axis] += step
            if periodic:
                other = [other[0] % rows, other[1] % columns]
            if not (0 <= other[0] < rows and 0 <= other[1] < columns) or region[tuple(other)]:
                continue
            pair = (source[y, x], source[tuple(other)])
            total += misfit(image, cells, axis, *(pair if step > 0 else pair[::-1]), cyclic)
    return total


@pytest.mark.parametrize("table", [512, 0])
@pytest.mark.parametrize("coarsest", ["patches", "fit"])
def test_the_last_part_lies_where_it_continues_best(
    coarsest: str, table: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The part that was laid down last has all its neighbours: no other place would fit better."""
    monkeypatch.setattr(seams_module, "_TABLE", table)
    image, cells = pixels(48, 48), (6, 6)
    cyclic = coarsest == "fit"
    for seed in range(3):
        source = laid(image, cells, (12, 12), seed, coarsest=coarsest, places=1)
        offset = (source - np.indices((12, 12)).transpose(1, 2, 0)) % 6
        region = (offset == offset[-1, -1]).all(-1)
        # Only the part in the corner, should another have the same offset.
        grown = np.zeros_like(region)
        grown[-1, -1] = True
        for _ in range(12):
            near = grown.copy()
            near[1:] |= grown[:-1]
            near[:-1] |= grown[1:]
            near[:, 1:] |= grown[:, :-1]
            near[:, :-1] |= grown[:, 1:]
            grown = near & region
        own = cost_of(image, cells, source, grown, cyclic, False)
        rows, columns = np.nonzero(grown)
        low = source[rows, columns].min(0)
        for dy, dx in itertools.product(range(-6, 7), repeat=2):
            moved = source.copy()
            moved[rows, columns] += (dy, dx)
            if cyclic:
                moved %= 6
            elif moved[rows, columns].min() < 0 or moved[rows, columns].max() > 5:
                continue
            if goes_on(moved, grown, 6):
                continue
            assert cost_of(image, cells, moved, grown, cyclic, False) >= own - 1e-6
        assert (low >= 0).all()


def goes_on(source: np.ndarray, region: np.ndarray, side: int) -> bool:
    offset = (source - np.indices(region.shape).transpose(1, 2, 0)) % side
    for axis in (0, 1):
        for y, x in np.argwhere(region):
            for step in (-1, 1):
                other = [y, x]
                other[axis] += step
                inside = 0 <= other[0] < region.shape[0] and 0 <= other[1] < region.shape[1]
                if inside and not region[tuple(other)] and (offset[y, x] == offset[tuple(other)]).all():
                    return True
    return False


def test_a_periodic_exemplar_is_continued_without_a_misfit() -> None:
    """Shifted by whole periods the exemplar goes on as it is, and no two neighbours have the same shift."""
    y, x = np.mgrid[:64, :64]
    wave = (0.5 + 0.25 * np.sin(2 * np.pi * x / 8) + 0.25 * np.sin(2 * np.pi * y / 16))[..., None]
    for coarsest in ("patches", "fit"):
        source = laid(wave.astype(np.float32), (8, 8), (24, 24), coarsest=coarsest, places=1, patch=0.3)
        # Every cell is a period wide, and every other row of cells is the same.
        phase = (source[..., 0] - np.arange(24)[:, None]) % 2
        assert (phase == phase[0, 0]).all()
        offsets = (source - np.indices((24, 24)).transpose(1, 2, 0)) % 8
        assert len(np.unique(offsets.reshape(-1, 2), axis=0)) > 1


@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 1.0])
@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("output", [(9, 30), (25, 17), (8, 9)])
def test_patches_lie_within_the_exemplar(share: float, periodic: bool, output: tuple[int, int]) -> None:
    source = laid(pixels(64, 64), (8, 8), output, patch=share, periodic=periodic)
    assert source.min() >= 0
    assert source.max() <= 7
    if share < 1:
        # Within a patch neighbours stay neighbours; they meet others along lines that are not straight.
        together = (np.diff(source, axis=1) == (0, 1)).all(-1)
        assert 0.3 * (share >= 0.3) < together.mean() < 1
        assert together.any(0).sum() > 0.8 * together.shape[1] or share < 0.3


def test_nothing_padded_is_laid_down() -> None:
    image = pixels(64, 64)
    steps = lay_out_steps(Seams.of(image, 8, 8), Grid(8, 8, 3), (6, 7), Grid(20, 20, 3), Layout(), Streams(1))
    rows, columns = np.divmod(finish(steps), 8)
    assert (rows.max(), columns.max()) == (5, 6)


def test_an_output_no_larger_than_the_exemplar_is_the_exemplar_unless_it_tiles() -> None:
    own = np.indices((8, 8)).transpose(1, 2, 0)
    for coarsest in ("patches", "fit", "shift", "tile"):
        np.testing.assert_array_equal(laid(pixels(64, 64), (8, 8), (8, 8), coarsest=coarsest), own)
    tile = laid(pixels(64, 64), (8, 8), (8, 8), periodic=True)
    assert (tile != own).any()


def test_tiles_continue_themselves() -> None:
    """The misfit across the border of a tile is that of the lines within."""
    y, x = np.mgrid[:64, :64]
    smooth = np.stack([0.5 + 0.4 * np.sin(x / 7 + y / 11), 0.5 + 0.4 * np.cos(y / 5 - x / 13)], -1)
    image = np.ascontiguousarray(smooth[..., [0, 1, 0]], np.float32)
    closed, cut = [], []
    for seed in range(10):
        for periodic, into in ((True, closed), (False, cut)):
            source = laid(image, (8, 8), (16, 16), seed, periodic=periodic)
            into.append(np.mean([misfit(image, (8, 8), 1, source[r, -1], source[r, 0], False) for r in range(16)]))
    assert np.mean(closed) < 0.6 * np.mean(cut)


def test_layouts_are_a_function_of_the_seed() -> None:
    image = pixels(64, 64)
    one, same, other = (laid(image, (8, 8), (20, 20), seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert (one != other).any()


def test_at_its_own_size_a_texture_is_new_unless_nothing_may_differ() -> None:
    from texlab_core.engine.job import Job
    from texlab_core.engine.run import run
    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.measures.registry import measure_all
    from texlab_core.measures.subject import Subject
    from texlab_core.methods.de_bonet.params import DeBonetParams

    exemplar = as_exemplar("gallery:stochastic-gravel")
    same, new = (
        run(Job(method="de-bonet", inputs={"exemplar": exemplar}, params=DeBonetParams(alpha=alpha), seed=1))
        for alpha in (0.0, 0.15)
    )
    np.testing.assert_allclose(same.image, exemplar.pixels, atol=1e-6)
    assert measure_all(Subject.of_result(new), ["laid-down-share"])["laid-down-share"] < 0.5
