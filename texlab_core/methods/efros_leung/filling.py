"""What a picture is filled with unless something else is said: how far around its holes, and how it grows."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab_core.engine.params import Params

REACH = 128
"""Pixels around a hole in which there is texture enough to fill it, by default."""
SMALL = 2**18
"""Pictures up to so many pixels are searched as a whole: 512 x 512."""


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
