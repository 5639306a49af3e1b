"""Many subbands in one picture: where each lies, drawing them, finding them again. NumPy and OpenCV, no Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab.style.pictures import Picture

Direction = Literal["left", "right", "up", "down"]
Layout = Literal["equal", "pyramid"]

LARGEST_TILE = 384
STEPS = {"left": (0, -1), "right": (0, 1), "up": (-1, 0), "down": (1, 0)}


@dataclass(frozen=True, slots=True)
class Cell:
    """Place of one band in the mosaic, in mosaic pixels."""

    top: int
    left: int
    height: int
    width: int

    @property
    def centre(self) -> tuple[float, float]:
        """Row and column of the middle."""
        return self.top + self.height / 2, self.left + self.width / 2

    def holds(self, row: float, column: float) -> bool:
        """Whether a mosaic pixel lies in it."""
        return self.top <= row < self.top + self.height and self.left <= column < self.left + self.width


@dataclass(frozen=True, slots=True)
class Mosaic:
    """An arrangement of bands.

    Parameters
    ----------
    size
        Height and width of the whole picture.
    cells
        Place of every band.
    shapes
        Height and width of every band itself.
    """

    size: tuple[int, int]
    cells: tuple[Cell, ...]
    shapes: tuple[tuple[int, int], ...]

    def locate(self, row: float, column: float) -> tuple[int, int, int] | None:
        """Return the band at a mosaic pixel with the row and column in it, or None in a gap."""
        for index, cell in enumerate(self.cells):
            if cell.holds(row, column):
                height, width = self.shapes[index]
                inside = (
                    int((row - cell.top) * height // cell.height),
                    int((column - cell.left) * width // cell.width),
                )
                return index, *inside
        return None

    def neighbour(self, index: int, direction: Direction) -> int:
        """Return the nearest band in a direction; the same one at the border."""
        down, right = STEPS[direction]
        row, column = self.cells[index].centre
        best, nearest = index, np.inf
        for other, cell in enumerate(self.cells):
            ahead = (cell.centre[0] - row) * down + (cell.centre[1] - column) * right
            aside = abs((cell.centre[0] - row) * right) + abs((cell.centre[1] - column) * down)
            distance = ahead + 2 * aside
            if ahead > 1 and aside <= ahead * 1.5 and distance < nearest:
                best, nearest = other, distance
        return best

    def draw(self, pictures: Sequence[Picture], gap_colour: tuple[int, int, int]) -> Picture:
        """Put the pictures of the bands, each (h, w, 3) uint8, into one."""
        import cv2

        whole = np.empty((*self.size, 3), np.uint8)
        whole[:] = gap_colour
        for cell, picture in zip(self.cells, pictures, strict=True):
            smaller = cell.height < picture.shape[0]
            method = cv2.INTER_AREA if smaller else cv2.INTER_NEAREST
            part = cv2.resize(picture, (cell.width, cell.height), interpolation=method)
            whole[cell.top : cell.top + cell.height, cell.left : cell.left + cell.width] = part
        return whole


def equal_columns(shapes: Sequence[tuple[int, int]], area: tuple[int, int]) -> int:
    """Return with how many columns :func:`equal_tiles` becomes largest in an area (height, width)."""
    height, width = _tile(shapes)

    def scale(columns: int) -> float:
        rows = -(-len(shapes) // columns)
        return min(area[1] / (columns * width), area[0] / (rows * height))

    return max(range(1, len(shapes) + 1), key=lambda columns: (round(scale(columns), 6), -columns))


def equal_tiles(shapes: Sequence[tuple[int, int]], columns: int) -> Mosaic:
    """Arrange the bands in rows, all enlarged to the size of the largest one."""
    height, width = _tile(shapes)
    gap = max(2, height // 32)
    cells = []
    for index in range(len(shapes)):
        row, column = divmod(index, columns)
        cells.append(Cell(gap + row * (height + gap), gap + column * (width + gap), height, width))
    rows = -(-len(shapes) // columns)
    size = (gap + rows * (height + gap), gap + min(columns, len(shapes)) * (width + gap))
    return Mosaic(size, tuple(cells), tuple(shapes))


def pyramid_tiles(shapes: Sequence[tuple[int, int]], columns: int) -> Mosaic:
    """Arrange the bands level by level from left to right, in the proportion of their sizes.

    ``columns`` says how many bands of a level stand side by side.
    """
    largest = _tile(shapes)
    factor = largest[0] / max(shape[0] for shape in shapes)
    gap = max(2, largest[0] // 32)
    cells: list[Cell] = []
    left, lowest = gap, 0
    start = 0
    while start < len(shapes):
        stop = next((k for k in range(start, len(shapes)) if shapes[k] != shapes[start]), len(shapes))
        height, width = (max(1, round(side * factor)) for side in shapes[start])
        across = min(columns, stop - start)
        for place in range(stop - start):
            row, column = divmod(place, across)
            cells.append(Cell(gap + row * (height + gap), left + column * (width + gap), height, width))
        lowest = max(lowest, cells[-1].top + height)
        left += across * (width + gap)
        start = stop
    return Mosaic((lowest + gap, left), tuple(cells), tuple(shapes))


def pyramid_columns(shapes: Sequence[tuple[int, int]], area: tuple[int, int]) -> int:
    """Return with how many bands of a level side by side :func:`pyramid_tiles` becomes largest in an area."""

    def scale(columns: int) -> float:
        height, width = pyramid_tiles(shapes, columns).size
        return min(area[0] / height, area[1] / width)

    most = max(shapes.count(shape) for shape in shapes)
    return max(range(1, most + 1), key=lambda columns: (round(scale(columns), 6), -columns))


def _tile(shapes: Sequence[tuple[int, int]]) -> tuple[int, int]:
    """Return the largest shape, made smaller where it is larger than a tile may be."""
    height, width = max(shapes)
    factor = min(1.0, LARGEST_TILE / max(height, width))
    return max(1, round(height * factor)), max(1, round(width * factor))


def parse_colour(colour: str) -> tuple[int, int, int]:
    """Return red, green and blue of ``#rrggbb``."""
    red, green, blue = (int(colour[place : place + 2], 16) for place in (1, 3, 5))
    return red, green, blue


def dim(picture: NDArray[np.uint8], towards: tuple[int, int, int]) -> NDArray[np.uint8]:
    """Return a picture most of the way to a colour: how a muted band looks."""
    mixed = (picture.astype(np.uint16) + 5 * np.array(towards, np.uint16)) // 6
    return mixed.astype(np.uint8)
