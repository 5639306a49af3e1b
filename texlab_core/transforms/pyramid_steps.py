"""The Laplacian pyramid step by step: smooth, reduce, expand, subtract; and back: expand, add.

Reference: Forsyth and Ponce, algorithms 11.1 and 11.2, eq. 11.2.1; Burt and Adelson 1983.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.transforms.gaussian import BINOMIAL, Border, Expansion, expand, max_levels, reduce

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Plane = NDArray[np.float32]


@dataclass(frozen=True, eq=False, slots=True)
class Down:
    """One level of the analysis.

    Parameters
    ----------
    image
        (H, W): this level of the Gaussian pyramid.
    smooth
        The same after the binomial filter.
    reduced
        (ceil(H / 2), ceil(W / 2)): every second sample of it, the next level.
    expanded
        (H, W): the prediction from there.
    band
        (H, W): what the prediction lacks, this level of the Laplacian pyramid.
    """

    image: Plane
    smooth: Plane
    reduced: Plane
    expanded: Plane
    band: Plane


@dataclass(frozen=True, eq=False, slots=True)
class Up:
    """One level of the synthesis: ``expanded`` + ``band`` = ``image``."""

    expanded: Plane
    band: Plane
    image: Plane


def analysis_steps(
    plane: Plane, levels: int, mode: Expansion = "interpolate", border: Border = "reflect"
) -> tuple[Down, ...]:
    """Return the levels of the analysis, finest first.

    Parameters
    ----------
    plane
        (H, W) float32.
    levels
        1 to as often as the plane can be halved.
    mode, border
        See :mod:`texlab_core.transforms.gaussian`; ``replicate`` is the operator of section 11.2.1.

    Raises
    ------
    ParamError
        When there are not so many levels.
    """
    most = max_levels(plane.shape)
    if not 1 <= levels <= most:
        raise ParamError(
            "levels", f"a whole number from 1 to {most} for {plane.shape[1]} x {plane.shape[0]}", levels
        )
    found = []
    for _ in range(levels):
        reduced = reduce(plane, border)
        expanded = expand(reduced, plane.shape, border, mode)
        found.append(Down(plane, smooth(plane, border), reduced, expanded, plane - expanded))
        plane = reduced
    return tuple(found)


def synthesis_steps(
    steps: tuple[Down, ...], mode: Expansion = "interpolate", border: Border = "reflect"
) -> tuple[Up, ...]:
    """Return the way back from the bands and the coarsest level alone, coarsest first."""
    image = steps[-1].reduced
    found = []
    for step in reversed(steps):
        expanded = expand(image, step.band.shape, border, mode)
        image = step.band + expanded
        found.append(Up(expanded, step.band, image))
    return tuple(found)


def smooth(plane: Plane, border: Border = "reflect") -> Plane:
    """Return a plane after the filter of :func:`texlab_core.transforms.gaussian.reduce`, not yet subsampled."""
    import cv2

    kernel = np.array(BINOMIAL)
    kind = cv2.BORDER_REFLECT_101 if border == "reflect" else cv2.BORDER_WRAP
    framed = cv2.copyMakeBorder(plane, 2, 2, 2, 2, kind)
    return np.ascontiguousarray(cv2.sepFilter2D(framed, cv2.CV_32F, kernel, kernel)[2:-2, 2:-2], np.float32)
