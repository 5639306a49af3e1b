"""What a picture is filled with unless something else is said: how far around its holes, and how it grows."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import ImageInput, Input, hash_arrays
from texlab_core.engine.job import Job
from texlab_core.errors import InputError
from texlab_core.methods.efros_leung.patches import pack_patches

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.efros_leung.parts import Box
    from texlab_core.methods.efros_leung.patches import Patch

REACH = 64
"""Pixels around a hole in which there is texture enough to fill it, by default."""
SMALL = 2**18
"""Pictures up to so many pixels are searched as a whole: 512 x 512."""
_FULL = 255


def with_reach(params: Params, size: Sequence[int]) -> tuple[Params, tuple[str, ...]]:
    """Return parameters that fill a large picture hole by hole, and a sentence for each change.

    Parameters
    ----------
    params
        Of Efros-Leung; where they have a reach already nothing is changed.
    size
        Height and width of the result.
    """
    if params.to_json()["reach"] > 0 or math.prod(size) <= SMALL:
        return params, ()
    said = f"Only what is within {REACH} pixels of a hole was looked at; reach=0 searches the whole picture."
    return params.replace(reach=REACH), (said,)


def grown_by(
    params: Params, size: tuple[int, int], margins: tuple[int, int, int, int]
) -> tuple[Params, tuple[int, int]]:
    """Return parameters and the size of a picture that grows outward by margins.

    Parameters
    ----------
    params
        Of Efros-Leung.
    size
        Height and width of the picture.
    margins
        Pixels to the left, above, to the right and below, each at least 0.

    Raises
    ------
    InputError
        When a margin is negative.
    """
    left, top, right, bottom = margins
    if min(margins) < 0:
        raise InputError(f"margins: must be at least 0, got {', '.join(map(str, margins))}.")
    changed = params.replace(anchor="at", left=left, top=top)
    return changed, (size[0] + top + bottom, size[1] + left + right)


def fill_job(
    picture: ImageInput,
    shares: NDArray[np.uint8],
    params: Params,
    *,
    patches: Sequence[Patch] = (),
    exemplar: ImageInput | None = None,
    region: NDArray[np.bool_] | None = None,
    margins: tuple[int, int, int, int] = (0, 0, 0, 0),
    seed: int = 0,
) -> Job:
    """Return the job that fills a picture hole by hole, at its own resolution.

    Parameters
    ----------
    picture
        What is filled; it is also what is copied from, unless an ``exemplar`` is given.
    shares
        (H, W) uint8: 0 stays, 255 is filled, between them the fill covers what was there in part.
    params
        Of Efros-Leung; without a reach they take the usual one.
    patches
        What was filled in it before, in that order.
    exemplar
        Another image to copy from.
    region
        (H, W) bool of what is copied from: copy only this; None for all.
    margins
        Pixels to grow to the left, above, to the right and below.
    seed
        Of the job.

    Raises
    ------
    InputError
        When it cannot work.
    """
    if params.to_json()["reach"] == 0:
        params = params.replace(reach=REACH)
    inputs: dict[str, Input] = {"exemplar": exemplar or picture}
    size = picture.size
    if any(margins):
        params, size = grown_by(params, size, margins)
    if exemplar is not None or any(margins):
        inputs["start"] = picture
    if shares.any():
        soft = ((shares > 0) & (shares < _FULL)).any()
        inputs["blend" if soft else "mask"] = _gray(shares.astype(np.float32) / np.float32(_FULL), "painted hole")
    if patches:
        inputs["patches"] = pack_patches(patches)
    if region is not None and region.any():
        inputs["region"] = _gray(region.astype(np.float32), "painted region")
    return Job(method="efros-leung", inputs=inputs, params=params, size=size, seed=seed)


def _gray(pixels: NDArray[np.float32], name: str) -> ImageInput:
    kept = np.ascontiguousarray(pixels[..., None])
    kept.flags.writeable = False
    return ImageInput(kept, name, hash_arrays({"pixels": kept}))


@dataclass(frozen=True, eq=False)
class Filled:
    """What is kept of a finished fill: a large picture is not held once more for each hole.

    Parameters
    ----------
    result
        The result without its maps and its model; its image is that of the box alone.
    box
        Where it lies in the picture; None: it is the whole result.
    alpha
        Transparency of the same pixels, (h, w, 1), where the picture has one.
    """

    result: Result
    box: Box | None
    alpha: FloatImage | None

    def whole(self, picture: ImageInput, patches: Sequence[Patch]) -> tuple[Result, FloatImage | None]:
        """Return the result with its whole image, and its transparency.

        Parameters
        ----------
        picture
            What was filled.
        patches
            All that was filled in it, this one included.
        """
        if self.box is None:
            return self.result, self.alpha
        image = np.array(np.broadcast_to(picture.pixels, (*picture.size, self.result.image.shape[2])))
        for box, marked, pixels in patches:
            image[box][marked] = np.broadcast_to(pixels, image[box].shape)[marked]
        alpha = None if picture.alpha is None else picture.alpha.copy()
        if alpha is not None and self.alpha is not None:
            alpha[self.box] = self.alpha
        return replace(self.result, image=image), alpha


def filled_of(result: Result, box: Box | None) -> Filled:
    """Return what is kept of the result of :func:`fill_job`: all of its image, or a box of it."""
    from texlab_core.documents.record import carried_alpha

    alpha = carried_alpha(result)
    part = (slice(None), slice(None)) if box is None else box
    small = replace(result, image=result.image[part].copy(), maps={}, model=None, details=None)
    return Filled(small, box, None if alpha is None else alpha[part].copy())
