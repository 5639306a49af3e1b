"""What the coded methods share: from an exemplar to a plane and its tone, and from a plane to a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.params import Knob
from texlab_core.engine.progress import Progress

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.steps import FloatImage, Step
    from texlab_core.methods.spectral.choices import BandwidthAxes, BandwidthMeasure, HistogramChoice
    from texlab_core.methods.spectral.code import MsgCode
    from texlab_core.methods.spectral.fourier import Floats, Plane
    from texlab_core.methods.spectral.tone import Tone

HISTOGRAM = Knob(
    "What the last step matches the gray levels to.",
    choices={"coded": "the histogram in 16 numbers", "full": "the exemplar's histogram in 256 numbers"},
    source="Navarro & Portilla 1996, sections 3.1.4 and 3.2.4",
    group="Histogram",
)
_EXTRA = 256 - 16


def gray_of(pixels: FloatImage) -> FloatImage:
    """Return the luma of a picture, (H, W, 1); a gray one as it is."""
    from texlab_core.transforms.luma import luma

    gray: FloatImage = luma(pixels)[..., None]
    return pixels if pixels.shape[2] == 1 else gray


@dataclass(frozen=True, eq=False)
class Finish:
    """The last step of a coded method: the histogram, the colours, the number of channels.

    Parameters
    ----------
    tone
        The coded histogram and colours.
    full
        (256,) the uncoded histogram when it is to be matched instead.
    channels
        Channels of the picture.
    """

    tone: Tone
    full: Floats | None
    channels: int

    @classmethod
    def choose(cls, tone: Tone, masses: Floats | None, choice: HistogramChoice, channels: int) -> Finish:
        """Return the last step with the histogram that was chosen."""
        return cls(tone, masses if choice == "full" else None, channels)

    @property
    def parameters(self) -> int:
        """How many numbers it takes."""
        return self.tone.parameters + (0 if self.full is None else _EXTRA)

    def apply(self, plane: Plane, progress: Progress, stage: str) -> Generator[Step, None, FloatImage]:
        """Return the picture of a plane, (H, W, C) float32 in [0, 1]."""
        yield progress.at(stage, 0.0, lambda: self.preview(plane))
        image = yield from self.tone.apply(plane, progress, stage, self.full)
        return self._widened(image)

    def preview(self, plane: Plane) -> FloatImage:
        """Return a plane in gray levels as it is before the histogram step."""
        return self._widened(np.clip(plane / np.float32(255), 0, 1)[:, :, None])

    def _widened(self, image: FloatImage) -> FloatImage:
        # A colour exemplar that holds only grays is coded as gray.
        return image if image.shape[2] == self.channels else np.repeat(image, self.channels, axis=2)


def encode(
    pixels: FloatImage, measure: BandwidthMeasure = "participation", axes: BandwidthAxes = "uv"
) -> Generator[Step, None, tuple[MsgCode, Floats]]:
    """Return the MSG code of an image and its uncoded histogram.

    Parameters
    ----------
    pixels
        (H, W, C) float32 in [0, 1]; C is 1 or 3.
    measure
        How the bandwidths are measured.
    axes
        Along which axes they are: those of the frequency plane, or along and across the waves of each channel.
    """
    from texlab_core.methods.spectral.analysis import analyze_plane
    from texlab_core.methods.spectral.tone import split_tone

    progress = Progress({"colours and histogram": 1, "transform": 2, "features": 1})
    plane, tone, masses = yield from split_tone(pixels, progress, "colours and histogram")
    code = yield from analyze_plane(plane, tone, measure, progress, "transform", "features", axes)
    return code, masses
