"""What is sent back from where a job ran: the picture with its recipe, a small one, and numbers."""

from __future__ import annotations

import functools
import hashlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from texlab_core.documents.recipe import written_recipe
from texlab_core.documents.record import encode_result
from texlab_core.findings.diagnosis import findings_of
from texlab_core.images.formats.writing import encode_png, quantize
from texlab_core.measures.registry import measure_all, measure_quick
from texlab_core.measures.subject import PreparedCache, Subject

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage
    from texlab_core.images.formats.writing import Bits

THUMBNAIL = 128


@dataclass(frozen=True, slots=True)
class Picture:
    """A finished job, ready to be written.

    Parameters
    ----------
    png
        The file with its recipe: a PNG, or the TIFF stack of a solid.
    thumbnail
        A small PNG, its longest side at most 128 pixels.
    sha256
        Of the pixels before they were rounded: shape and float32 values.
    measures
        Numbers by name.
    findings
        What is wrong with it, one sentence each.
    notes
        What was done to the input.
    suffix
        Of the file.
    """

    png: bytes
    thumbnail: bytes
    sha256: str
    measures: Mapping[str, float] = field(default_factory=dict)
    findings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    suffix: str = ".png"


def finish(result: Result, *, bits: Bits = 8, measures: tuple[str, ...] | None = None) -> Picture:
    """Return what is kept of a result.

    Parameters
    ----------
    result
        What a job made.
    bits
        For each sample of the picture.
    measures
        Ids of the measures to take; None takes those that cost next to nothing.
    """
    whole = result.image if result.volume is None else result.volume
    subject = Subject.of_result(result, _prepared())
    taken = measure_quick(subject) if measures is None else measure_all(subject, measures)
    digest = hashlib.sha256(f"{whole.shape}".encode())
    digest.update(whole.tobytes())
    suffix = ".png" if result.volume is None else ".tif"
    return Picture(
        png=encode_result(result, f"result{suffix}", bits=bits, recipe=written_recipe(result, taken)),
        suffix=suffix,
        thumbnail=thumbnail(result.image),
        sha256=digest.hexdigest(),
        measures=taken,
        findings=tuple(each.sentence for each in findings_of(result, subject)),
        notes=result.notes,
    )


@functools.cache
def _prepared() -> PreparedCache:
    """Return what this process has prepared of the last exemplars for measuring."""
    return PreparedCache(exemplars=2)


def thumbnail(image: FloatImage, longest: int = THUMBNAIL) -> bytes:
    """Return a small PNG of an image, by area averaging; a small image stays as it is."""
    height, width = image.shape[:2]
    scale = min(1.0, longest / max(height, width))
    small: Any = image
    if scale < 1:
        import cv2

        size = max(1, round(width * scale)), max(1, round(height * scale))
        small = cv2.resize(image, size, interpolation=cv2.INTER_AREA).reshape(size[1], size[0], -1)
    return encode_png(quantize(small, 255))
