"""Growing an image pixel by pixel: in small portions, watched, cancelled and gone on with at any point."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.steps import FloatImage, Step
from texlab_core.methods.efros_leung.order import first_layer, following_layer, raster_rows
from texlab_core.methods.efros_leung.windows import make_window
from texlab_core.work.tasks import now_and_then

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

    from numpy.typing import NDArray

    from texlab_core.kernels.neighbourhood_types import Canvas, Pool, Rule, Search, Window
    from texlab_core.methods.efros_leung.windows import Matching

PORTION_S = 0.004
RAISE = 1.1
_CRITERIA = {"ssd": 0, "flat-ssd": 0, "sad": 1, "ncc": 2}


@dataclass
class Growth:
    """An image that grows; everything about it that changes.

    Parameters
    ----------
    canvas
        The image and its maps, changed in place.
    pool, matching
        The candidates, and how they are compared.
    choice_key, order_key
        Keys of the hashes that choose from a match set and that order equals.
    guesses
        0 is the exact search; otherwise only coherent candidates and so many random ones are compared (a draft).
    settings
        Identifies everything that the way of growing depends on; a state goes on in its layer only under the same.
    queue, row
        The layer at hand; for a causal window the next row to look at.
    started
        Whether there was a first layer.
    filled, since, position
        How many pixels were filled so far (earlier runs included), how many of them under other settings, and
        where in the queue to begin.
    filled_before_layer, layer_best, limit
        For the growing error limit: count and smallest distance of the layer, and the limit itself.
    """

    canvas: Canvas
    pool: Pool
    matching: Matching
    choice_key: int
    order_key: int
    guesses: int = 0
    settings: bytes = b""
    queue: NDArray[np.int32] = field(default_factory=lambda: np.empty(0, np.int32))
    row: int = 0
    started: bool = False
    filled: int = 0
    since: int = 0
    position: int = 0
    filled_before_layer: int = 0
    layer_best: float = float("inf")
    limit: float | None = None

    def __post_init__(self) -> None:
        from texlab_core.kernels.neighbourhood_types import ERROR_LIMIT, FILLED, LAYER_BEST, POSITION

        channels = self.canvas.values.shape[0]
        self.window: Window = make_window(self.matching, channels)
        self.rule: Rule = make_rule(self.matching, self.choice_key, guesses=self.guesses)
        self.search: Search = make_search(self.pool, self.window, channels)
        self.search.numbers[POSITION] = self.position
        self.search.numbers[FILLED] = self.filled
        self.search.levels[LAYER_BEST] = self.layer_best
        self.search.levels[ERROR_LIMIT] = self.matching.limit if self.limit is None else self.limit
        self.total = self.filled + self.canvas.status.size - _count_known(self.canvas.status)
        self._budget = 500_000

    def run(self) -> Generator[Step, None, None]:
        """Fill everything that is unknown; a Step after each portion of about 4 ms."""
        while (yield from self._next_layer()):
            while self._place() < len(self.queue):
                self.advance()
                yield self.step()

    def advance(self) -> None:
        """Do about 4 ms of work. The portion is measured in work, and no bit of the result depends on it."""
        from texlab_core.kernels.neighbourhoods import grow

        begin = time.perf_counter()
        work = grow(self.canvas, self.pool, self.window, self.rule, self.search, self.queue, self._budget)
        elapsed = max(time.perf_counter() - begin, 1e-6)
        if work >= self._budget:
            wanted = work * PORTION_S / elapsed
            self._budget = int(min(max(wanted, 0.5 * self._budget, 1e4), 2.0 * self._budget, 1e9))

    def step(self) -> Step:
        """Return where things stand."""
        done = self._filled()
        return Step(done, self.total, "growing", preview=self.picture, filled=self.known, state=self.state)

    def picture(self) -> FloatImage:
        """Return the image so far, (H, W, C) float32 in [0, 1]; unknown pixels are mid-gray."""
        values = np.where(self.known(), self.canvas.values, np.uint8(128))
        return np.ascontiguousarray(np.moveaxis(values, 0, 2)).astype(np.float32) / np.float32(255.0)

    def known(self) -> NDArray[np.bool_]:
        """Return which pixels have their value, (H, W) bool."""
        return np.equal(self.canvas.status, 1)

    def state(self) -> Mapping[str, NDArray[Any]]:
        """Return copies of all that is needed to go on bit for bit, as the arrays of an ``ArraysInput``."""
        from texlab_core.kernels.neighbourhood_types import ERROR_LIMIT, LAYER_BEST

        levels = self.search.levels
        begun = self.filled_before_layer, self.row, int(self.started), self.since
        numbers = [self._place(), self._filled(), *begun]
        arrays = {name: value.copy() for name, value in self.canvas._asdict().items()}
        return arrays | {
            "queue": self.queue.copy(),
            "numbers": np.array(numbers, np.int64),
            "levels": np.array([levels[LAYER_BEST], levels[ERROR_LIMIT]]),
            "settings": np.frombuffer(self.settings, np.uint8).copy(),
        }

    def _place(self) -> int:
        from texlab_core.kernels.neighbourhood_types import POSITION

        return int(self.search.numbers[POSITION])

    def _filled(self) -> int:
        from texlab_core.kernels.neighbourhood_types import FILLED

        return int(self.search.numbers[FILLED])

    def _next_layer(self) -> Generator[Step, None, bool]:
        """Have a layer that is not at its end; return False when all is filled."""
        from texlab_core.kernels.neighbourhood_types import POSITION

        status, height = self.canvas.status, self.canvas.status.shape[0]
        while self._place() >= len(self.queue):
            if self.matching.causal:
                if self.row >= height:
                    return False
                self.queue, self.row = raster_rows(status, self.row)
                self.search.numbers[POSITION] = 0
                yield self.step()
            else:
                self._raise_limit()
                finding = (
                    following_layer(status, self.window, self.matching.wraps, self.order_key, self.queue)
                    if self.started
                    else first_layer(status, self.window, self.matching.wraps, self.order_key)
                )
                queue = yield from now_and_then(finding, PORTION_S, self.step)
                self.queue, self.started = queue, True
                self.search.numbers[POSITION] = 0
                self.filled_before_layer = self._filled()
                if len(queue) == 0:
                    return False
        return True

    def _raise_limit(self) -> None:
        """After a whole layer without a pixel, raise the limit until its best pixel passes (textbook: by 1.1)."""
        from texlab_core.kernels.neighbourhood_types import ERROR_LIMIT, LAYER_BEST

        levels = self.search.levels
        # Finite: a layer was searched since the last time (a state may have been saved right after it was raised).
        if np.isfinite(levels[LAYER_BEST]) and self._filled() == self.filled_before_layer:
            while levels[ERROR_LIMIT] < levels[LAYER_BEST]:
                # The least subnormal numbers times 1.1 are themselves.
                levels[ERROR_LIMIT] = max(levels[ERROR_LIMIT] * RAISE, np.finfo(np.float64).tiny)
        levels[LAYER_BEST] = np.inf


def make_rule(matching: Matching, key: int, *, leave_out: bool = False, guesses: int = 0) -> Rule:
    """Return how to compare and choose as the kernels take it."""
    from texlab_core.kernels.neighbourhood_types import Rule

    return Rule(
        criterion=_CRITERIA[matching.criterion],
        eps=round(matching.eps * 1e6),
        tau=round(matching.tau * 1e3),
        key=np.uint64(key),
        tiles=matching.wraps,
        leave_out=leave_out,
        guesses=guesses,
    )


def make_search(pool: Pool, window: Window, channels: int) -> Search:
    """Return working memory for the kernels."""
    from texlab_core.kernels.neighbourhood_types import BUCKETS, LANES, Search

    # A multiple of four, and room for the coherent candidates.
    entries = len(window.rows) * channels + 64
    return Search(
        offset=np.zeros(entries, np.int64),
        weight=np.zeros(entries, np.int32),
        value=np.zeros(entries, np.int32),
        telling=np.zeros(entries),
        bucket=np.zeros(entries, np.int64),
        counts=np.zeros(BUCKETS + 1, np.int64),
        spare_offset=np.zeros(entries, np.int64),
        spare_weight=np.zeros(entries, np.int32),
        spare_value=np.zeros(entries, np.int32),
        sums=np.zeros((3, LANES), np.int32),
        found=np.zeros(pool.plane + 64, np.int32),
        distance=np.zeros(pool.plane + 64),
        numbers=np.zeros(16, np.int64),
        levels=np.zeros(16),
    )


def _count_known(status: NDArray[np.uint8]) -> int:
    parts = np.array_split(status.reshape(-1), max(1, status.size >> 20))
    return sum(int(np.count_nonzero(part == 1)) for part in parts)


def empty_canvas(channels: int, size: tuple[int, int]) -> Canvas:
    """Return a canvas of which nothing is known; zeros, so that no memory is touched before it is needed."""
    from texlab_core.kernels.neighbourhood_types import Canvas

    return Canvas(
        values=np.zeros((channels, *size), np.uint8),
        status=np.zeros(size, np.uint8),
        source=np.zeros(size, np.int32),
        order=np.zeros(size, np.int32),
        matches=np.zeros(size, np.int32),
        d_min=np.zeros(size, np.float32),
    )
