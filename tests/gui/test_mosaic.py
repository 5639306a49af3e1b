"""Arranging bands in a mosaic, drawing them and finding them again."""

import numpy as np
import pytest

from texlab.docks.bands import mosaic

SHAPES = [(32, 48)] * 5 + [(16, 24)] * 4 + [(8, 12)]


def pictures():
    return [np.full((*shape, 3), 10 + 10 * k, np.uint8) for k, shape in enumerate(SHAPES)]


@pytest.mark.parametrize("arrange", [mosaic.equal_tiles, mosaic.pyramid_tiles])
@pytest.mark.parametrize("columns", [1, 2, 3, 5, 10])
def test_tiles_fill_their_cells_and_nothing_else(arrange, columns):
    layout = arrange(SHAPES, columns)
    picture = layout.draw(pictures(), (1, 2, 3))
    assert picture.shape == (*layout.size, 3)
    covered = np.zeros(layout.size, int)
    for index, cell in enumerate(layout.cells):
        covered[cell.top : cell.top + cell.height, cell.left : cell.left + cell.width] += 1
        assert np.all(
            picture[cell.top : cell.top + cell.height, cell.left : cell.left + cell.width] == 10 + 10 * index
        )
    assert covered.max() == 1
    assert np.all(picture[covered == 0] == (1, 2, 3))


def test_equal_tiles_enlarge_coarse_bands():
    layout = mosaic.equal_tiles(SHAPES, 4)
    assert {(cell.height, cell.width) for cell in layout.cells} == {(32, 48)}
    ramp = np.zeros((8, 12, 3), np.uint8)
    ramp[:] = np.arange(12)[:, None]
    picture = layout.draw([*pictures()[:-1], ramp], (0, 0, 0))
    cell = layout.cells[-1]
    assert np.array_equal(picture[cell.top, cell.left : cell.left + 48, 0], np.arange(12).repeat(4))


def test_pyramid_tiles_keep_the_proportions():
    layout = mosaic.pyramid_tiles(SHAPES, 2)
    assert [(cell.height, cell.width) for cell in layout.cells] == SHAPES


def test_locate_gives_the_samples_of_the_band_itself():
    layout = mosaic.equal_tiles(SHAPES, 4)
    cell = layout.cells[9]
    assert layout.locate(cell.top, cell.left) == (9, 0, 0)
    assert layout.locate(cell.top + 31, cell.left + 47) == (9, 7, 11)
    assert layout.locate(cell.top + 13, cell.left + 9) == (9, 3, 2)
    assert layout.locate(0, 0) is None


def test_large_bands_are_drawn_smaller_but_located_exactly():
    shapes = [(1024, 512), (512, 256)]
    layout = mosaic.equal_tiles(shapes, 2)
    assert layout.cells[0].height == mosaic.LARGEST_TILE
    cell = layout.cells[0]
    assert layout.locate(cell.top + cell.height - 1, cell.left) == (0, 1021, 0)
    tiles = [np.full((*shape, 3), 77, np.uint8) for shape in shapes]
    assert layout.draw(tiles, (0, 0, 0))[cell.top, cell.left, 0] == 77


def test_neighbours_on_a_grid():
    layout = mosaic.equal_tiles(SHAPES, 4)
    assert layout.neighbour(0, "right") == 1
    assert layout.neighbour(0, "down") == 4
    assert layout.neighbour(5, "up") == 1
    assert layout.neighbour(5, "left") == 4
    assert layout.neighbour(3, "right") == 3
    assert layout.neighbour(0, "up") == 0


@pytest.mark.parametrize("columns", [1, 2, 5])
def test_every_band_of_a_pyramid_can_be_reached(columns):
    layout = mosaic.pyramid_tiles(SHAPES, columns)
    reached, todo = {0}, [0]
    while todo:
        here = todo.pop()
        for direction in ("left", "right", "up", "down"):
            there = layout.neighbour(here, direction)
            if there not in reached:
                reached.add(there)
                todo.append(there)
    assert reached == set(range(len(SHAPES)))


def test_columns_make_the_tiles_largest():
    assert mosaic.equal_columns([(10, 10)] * 6, (100, 600)) == 6
    assert mosaic.equal_columns([(10, 10)] * 6, (600, 100)) == 1
    assert mosaic.equal_columns([(10, 10)] * 6, (200, 300)) == 3
    for area in ((100, 800), (400, 400)):
        best = mosaic.pyramid_columns(SHAPES, area)
        scales = []
        for columns in range(1, 6):
            height, width = mosaic.pyramid_tiles(SHAPES, columns).size
            scales.append(min(area[0] / height, area[1] / width))
        assert scales[best - 1] == max(scales)


def test_colours():
    assert mosaic.parse_colour("#10ff02") == (16, 255, 2)
    assert mosaic.dim(np.full((1, 1, 3), 255, np.uint8), (15, 15, 15)).tolist() == [[[55, 55, 55]]]
