"""Between exemplars: means of quantile functions, and of colours by Gaussian optimal transport.

Reference: Heeger and Bergen 1995, section 4; Agueh and Carlier 2011 and Alvarez-Esteban et al. 2016 (barycentres).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.heeger_bergen.analysis import PlaneModel, Target, TextureModel
from texlab_core.stats.histogram import resample
from texlab_core.transforms.colour import axes_of_covariance

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.methods.mixture.common import Common
    from texlab_core.stats.histogram import Sample
    from texlab_core.transforms.steerable import BandKey
    from texlab_core.work.tasks import Task

# Added to every variance: a flat cloud of colours then has an inverse. It is far below one gray level.
_FLOOR = 1e-12
_STEPS = 100
_CLOSE = 1e-14

Weights = tuple[float, ...]


def quantile_mean(samples: Sequence[Sample], weights: Sequence[float]) -> Sample:
    """Return the mean of quantile functions: the Wasserstein barycentre of distributions on a line.

    Parameters
    ----------
    samples
        Sorted, of any sizes.
    weights
        As many; they add up to 1.

    Returns
    -------
    ndarray
        Sorted float32, as many as the longest sample with a weight has.
    """
    chosen = [(sample, weight) for sample, weight in zip(samples, weights, strict=True) if weight > 0]
    if len(chosen) == 1:
        return chosen[0][0]
    count = max(sample.size for sample, _ in chosen)
    total = np.zeros(count)
    for sample, weight in chosen:
        total += weight * resample(sample, count)
    return total.astype(np.float32)


def covariance_mean(covariances: Sequence[NDArray[np.float64]], weights: Sequence[float]) -> NDArray[np.float64]:
    """Return the covariance of the Gaussian optimal-transport mean of Gaussians.

    It solves S = sum w_i (S^1/2 C_i S^1/2)^1/2, and is found by the iteration of Alvarez-Esteban et al.

    Parameters
    ----------
    covariances
        (C, C) each, positive semidefinite.
    weights
        As many; they add up to 1.
    """
    floor = _FLOOR * np.eye(len(covariances[0]))
    chosen = [(each + floor, weight) for each, weight in zip(covariances, weights, strict=True) if weight > 0]
    mean: NDArray[np.float64] = sum((weight * each for each, weight in chosen), np.zeros_like(floor))
    for _ in range(_STEPS):
        root, back = _roots(mean)
        middle = sum((weight * _roots(root @ each @ root)[0] for each, weight in chosen), np.zeros_like(floor))
        following = back @ middle @ middle @ back
        following = (following + following.T) / 2
        done = np.abs(following - mean).max() <= _CLOSE * max(1.0, float(np.abs(mean).max()))
        mean = following
        if done:
            break
    return mean


def _roots(matrix: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the square root of a positive matrix, and its inverse."""
    values, vectors = np.linalg.eigh(matrix)
    roots = np.sqrt(np.maximum(values, _FLOOR * _FLOOR))
    return (vectors * roots) @ vectors.T, (vectors / roots) @ vectors.T


class Recipe:
    """What every part of a mixture takes from each exemplar: one weight for each, adding up to 1."""

    def __init__(self, fine: Weights, coarse: Weights, pixels: Weights, colours: Weights, cut: int) -> None:
        self.fine, self.coarse, self.pixels, self.colours, self.cut = fine, coarse, pixels, colours, cut

    def band(self, key: BandKey) -> Weights:
        """Return the weights of a subband."""
        fine = key.kind == "highpass" or (key.kind != "lowpass" and key.level < self.cut)
        return self.fine if fine else self.coarse


def blend(exemplars: Sequence[Common], recipe: Recipe) -> Task[TextureModel]:
    """Return the model of a mixture.

    Parameters
    ----------
    exemplars
        In common units.
    recipe
        Weights of each part.

    Yields
    ------
    int
        Samples worked through since the last time.
    """
    levels = min(each.levels for each in exemplars)
    covariance = covariance_mean([each.covariance for each in exemplars], recipe.colours)
    mean = sum(
        (weight * each.mean for each, weight in zip(exemplars, recipe.colours, strict=True)),
        np.zeros_like(exemplars[0].mean),
    )
    palette = []
    for channel in range(len(mean)):
        palette.append(quantile_mean([each.palette[channel] for each in exemplars], recipe.colours))
        yield palette[-1].size
    axes = axes_of_covariance(mean, covariance, max(len(each.planes) for each in exemplars))
    planes = []
    for axis in range(len(axes.spread)):
        targets = [each.planes[axis] if axis < len(each.planes) else None for each in exemplars]
        pixels = _target([None if each is None else each.pixels for each in targets], recipe.pixels)
        yield pixels.sample.size
        bands = {}
        keys = next(each for each in targets if each is not None).bands
        for key in keys:
            finer = key.level < levels or key.kind in ("highpass", "lowpass")
            if not finer or key.level > levels:
                continue
            bands[key] = _target([None if each is None else each.bands[key] for each in targets], recipe.band(key))
            yield bands[key].sample.size
        planes.append(PlaneModel(pixels, bands))
    return TextureModel(axes, tuple(planes), tuple(palette), levels)


def _target(targets: Sequence[Target | None], weights: Weights) -> Target:
    """Return the mean of targets; an exemplar without this axis does not vary along it."""
    flat = np.zeros(1, np.float32)
    sample = quantile_mean([flat if each is None else each.sample for each in targets], weights)
    spread = sum(weight * each.spread for each, weight in zip(targets, weights, strict=True) if each is not None)
    return Target(sample, float(spread))
