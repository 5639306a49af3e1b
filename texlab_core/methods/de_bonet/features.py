"""The features of De Bonet's parent structures and their names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab_core.methods.de_bonet.choices import FilterSet

FeatureKind = Literal["laplacian", "first", "second", "residual", "oriented"]


@dataclass(frozen=True, slots=True)
class Feature:
    """One component of a parent structure.

    Parameters
    ----------
    channel
        ``luminance`` (also of a gray exemplar), ``red``, ``green`` or ``blue``, or a principal axis of the
        exemplar's colours: ``axis-1`` (the strongest), ``axis-2``, ``axis-3``.
    kind
        The band of the Laplacian pyramid, or a first or second derivative of the Gaussian one; the low-pass
        residual of the steerable pyramid, or one of its oriented bands.
    angle
        Direction of the derivative, or of the waves of the band, in degrees, 0 <= angle < 180, counter-clockwise
        from the horizontal.
    """

    channel: str
    kind: FeatureKind
    angle: float = 0.0

    @property
    def name(self) -> str:
        """Name in threshold tables: ``red/first-45``; it does not depend on how many other features there are."""
        return f"{self.channel}/{self.kind}" + (f"-{round(self.angle, 2):g}" if self.directed else "")

    @property
    def directed(self) -> bool:
        """Whether it has an angle."""
        return self.kind in ("first", "second", "oriented")

    def mirrored(self) -> Feature:
        """Return the feature that a picture mirrored left to right has in place of this one."""
        return Feature(self.channel, self.kind, (180 - self.angle) % 180)


def channel_names(channels: int) -> tuple[str, ...]:
    """Return the names of 1 or 3 channels."""
    return ("luminance",) if channels == 1 else ("red", "green", "blue")


def feature_list(names: Sequence[str], filters: FilterSet, orientations: int) -> tuple[Feature, ...]:
    """Return the features in the order of the analysis: for each kind and angle, all channels by their names."""
    kinds: tuple[FeatureKind, ...] = ("first", "second")
    chosen = [kind for kind in kinds if filters in ("both", kind)]
    found = [Feature(name, "laplacian") for name in names]
    for kind in chosen:
        for k in range(orientations):
            found += [Feature(name, kind, 180 * k / orientations) for name in names]
    return tuple(found)
