"""Growing the output level by level while it is being sampled; shared by the methods that sample a pyramid."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.steps import Step
from texlab_core.errors import InputError
from texlab_core.methods.de_bonet.analysis import PIXELS_AT_ONCE
from texlab_core.methods.de_bonet.collapse import coarsest, collapse_steps, enlarge
from texlab_core.methods.de_bonet.quadtree import Grid
from texlab_core.work.tasks import relay, row_bounds, through

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.de_bonet.analysis import Analysis
    from texlab_core.methods.de_bonet.sampling import Progress

_LARGEST_GRID = 2**27


def check_size(size: tuple[int, int], depth: int) -> None:
    """Refuse outputs so thin that whole cells of the coarsest level would be many times larger.

    Raises
    ------
    InputError
        When more than 128 megapixels would have to be made.
    """
    height, width = Grid.covering(*size, depth).shape(0)
    if height * width > _LARGEST_GRID:
        raise InputError(
            f"size: the pyramid works on multiples of {2**depth} pixels, and {width} x {height} is more than "
            f"{_LARGEST_GRID // 2**20} megapixels; choose a size that is less thin, got {size[1]} x {size[0]}."
        )


def visible(image: FloatImage, size: tuple[int, int]) -> FloatImage:
    """Return what was asked for of the finest level, clipped to the legal range: only here, at the very end."""
    return np.clip(image[: size[0], : size[1]], 0, 1)


def visible_steps(image: FloatImage, size: tuple[int, int]) -> Generator[None, None, FloatImage]:
    """Do what :func:`visible` does in parts of a few milliseconds."""
    out = np.empty((*size, image.shape[2]), np.float32)
    for first, last in row_bounds((size[0], size[1] * image.shape[2]), PIXELS_AT_ONCE):
        np.clip(image[first:last, : size[1]], 0, 1, out=out[first:last])
        yield
    return out


def analyze_in_steps(
    steps: Generator[tuple[int, int], None, Analysis], stage: str
) -> Generator[Step, None, Analysis]:
    """Turn the progress of an analysis into steps."""
    return relay(steps, lambda part: Step(*part, stage))


def total_work(grid: Grid, after: int = 0) -> int:
    """Return the number of steps of a growth, and of ``after`` more units of work that follow it."""
    return 2 * sum(grid.count(level) for level in range(grid.depth)) + grid.count(grid.depth) + after


def grow_levels(
    grid: Grid,
    progress: Iterable[Progress],
    make: Callable[[int], Generator[Any, None, None]],
    *,
    preview: Callable[[], FloatImage],
    after: int,
) -> Generator[Step, None, None]:
    """Make each level as soon as its sources are complete; every level that is finished becomes a frame.

    Parameters
    ----------
    progress
        Yields (level, count) when ``count`` more locations of a level have their source, coarse levels first.
    make
        Makes a level below the coarsest, which is there already; called for one after the other.
    preview
        Makes a picture of the levels that are there.
    after
        Work that follows, in locations.
    """
    level = grid.depth
    missing = [grid.count(each) for each in range(level)]
    total, done = total_work(grid, after), grid.count(level)
    yield Step(done, total, f"level {level}", preview=preview, frame=f"level {level}")
    for made_level, made in progress:
        if made:
            missing[made_level] -= made
            done += made
        yield Step(done, total, f"level {made_level}", preview=preview)
        while level > 0 and missing[level - 1] == 0:
            level -= 1
            yield from through(make(level), Step(done, total, f"level {level}", preview=preview))
            done += grid.count(level)
            yield Step(done, total, f"level {level}", preview=preview, frame=f"level {level}")


def grow(
    analysis: Analysis,
    grid: Grid,
    sources: Sequence[NDArray[np.int32]],
    progress: Iterable[Progress],
    *,
    size: tuple[int, int],
    periodic: bool,
    after: int = 0,
) -> Generator[Step, None, FloatImage]:
    """Collapse each level as soon as its sources are complete.

    Parameters
    ----------
    sources
        Per level, in quadtree order; the coarsest is complete, the others are being filled by ``progress``.
    progress, after
        As for :func:`grow_levels`.
    size
        Height and width of the pictures.
    periodic
        Border rule of the output.

    Returns
    -------
    ndarray
        The finest level, cropped and clipped, (H, W, C) float32.
    """
    there = grid.depth
    image = coarsest(analysis, grid, sources[there])

    def preview() -> FloatImage:
        return visible(enlarge(image, there, periodic), size)

    def make(level: int) -> Generator[None, None, None]:
        nonlocal there, image
        image = yield from collapse_steps(analysis, grid, level, image, sources[level], periodic)
        there = level

    yield from grow_levels(grid, progress, make, preview=preview, after=after)
    step = Step(total_work(grid), total_work(grid, after), "level 0", preview=preview)
    return (yield from through(visible_steps(image, size), step))
