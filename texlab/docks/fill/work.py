"""What was done to one picture: its fills, one after the other, and the hole that is painted now."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from texlab.state.filling import FillPlan
from texlab.style.pictures import to_picture
from texlab_core.methods.efros_leung.filling import fill_job
from texlab_core.methods.efros_leung.parts import dilated

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from texlab.style.pictures import Picture
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.job import Job
    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.efros_leung.filling import Filled
    from texlab_core.methods.efros_leung.parts import Box
    from texlab_core.methods.efros_leung.patches import Patch

# Seen around a hole while it is filled, in pixels.
AROUND = 8


@dataclass(frozen=True, eq=False)
class Made:
    """One fill: what came out, the hole that was painted for it, and its seed."""

    found: Filled
    patch: Patch
    picture: Picture
    shares: NDArray[np.uint8]
    seed: int


@dataclass(eq=False)
class Work:
    """A picture with its fills.

    Parameters
    ----------
    picture
        As it was opened, or as it was grown.
    grown
        The result that the picture is, where it was grown outward.
    made
        The fills, in their order.
    shares
        (H, W) uint8, the hole that is painted now; None: nothing.
    """

    picture: ImageInput
    grown: Filled | None = None
    made: list[Made] = field(default_factory=list)
    shares: NDArray[np.uint8] | None = None
    asked: tuple[NDArray[np.uint8], int] | None = None
    """Box of the hole and seed of the fill that is under way."""

    @property
    def patches(self) -> tuple[Patch, ...]:
        """What was filled."""
        return tuple(each.patch for each in self.made)

    @property
    def pictures(self) -> tuple[tuple[Box, Picture], ...]:
        """The same as it is painted."""
        return tuple((each.patch[0], each.picture) for each in self.made)

    def plan(
        self,
        shares: NDArray[np.uint8],
        box: Box | None,
        params: Params,
        *,
        exemplar: Callable[[], ImageInput | None] | None,
        region: NDArray[np.bool_] | None,
        margins: tuple[int, int, int, int],
        seed: int,
    ) -> FillPlan:
        """Return what is to be done.

        ``box`` is the smallest one around what is marked, if anything is; ``exemplar`` makes another image to copy
        from, in a background thread.
        """
        picture, patches = self.picture, self.patches
        shown = None if box is None or any(margins) else dilated(box, AROUND, picture.size)
        self.asked = (shares if shown is None else shares[shown].copy(), seed)

        def make_job() -> Job:
            return fill_job(
                picture,
                shares,
                params,
                patches=patches,
                exemplar=None if exemplar is None else exemplar(),
                region=region,
                margins=margins,
                seed=seed,
            )

        return FillPlan(self, make_job, shown)

    def take(self, found: Filled) -> None:
        """Take a finished fill of this picture."""
        assert found.box is not None
        assert self.asked is not None
        shares, seed = self.asked
        pixels = found.result.image
        patch = (found.box, shares > 0, pixels)
        self.made.append(Made(found, patch, to_picture(pixels), shares, seed))

    def take_back(self) -> Made | None:
        """Take the last fill back; returns it."""
        return self.made.pop() if self.made else None

    def result(self) -> tuple[Result, FloatImage | None] | None:
        """Return the whole picture as it is now with the job that made it, and its transparency; or None."""
        if self.made:
            return self.made[-1].found.whole(self.picture, self.patches)
        return None if self.grown is None else self.grown.whole(self.picture, ())
