"""The sources of exemplars in the history: the same picture, opened again, is held once."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from texlab_core.engine.inputs import ImageInput

_FACTS = ("sha256", "name", "notes", "depth")


def known_source(source: ImageInput, known: Iterable[ImageInput]) -> ImageInput:
    """Return the known source that is the same picture, or else this one."""
    return next((each for each in known if each is source or _is_same(each, source)), source)


def _is_same(one: ImageInput, other: ImageInput) -> bool:
    """Whether two images are the same in all that is shown of them and worked with."""
    equal = all(getattr(one, name) == getattr(other, name) for name in _FACTS)
    return equal and _is_whole(one) and _is_whole(other) and _taken(one) == _taken(other)


def _is_whole(image: ImageInput) -> bool:
    """Whether an image is all that there is of its source, and opaque."""
    origin = image.origin
    return image.alpha is None and (
        origin is None or (origin.scale == 1 and origin.crop is None and origin.alpha is None)
    )


def _taken(image: ImageInput) -> object:
    return None if image.origin is None else (image.origin.taken, image.origin.notes)
