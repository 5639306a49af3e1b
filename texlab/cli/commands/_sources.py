"""What a method works on, from the command line: an image, a texture of the gallery, or a code of 69 numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from texlab_core.errors import InputError

if TYPE_CHECKING:
    from texlab_core.engine.inputs import Crop, Input
    from texlab_core.engine.registry import Method

CODE_SUFFIX = ".msg.json"


def is_code(source: str) -> bool:
    """Return whether a source is an MSG code, by its name."""
    return source.lower().endswith(CODE_SUFFIX)


def load_inputs(source: str, method: Method, *, scale: float = 1.0, crop: Crop | None = None) -> dict[str, Input]:
    """Return the inputs of a job.

    Parameters
    ----------
    source
        An image file, ``gallery:NAME``, or a code ``X.msg.json``.
    scale, crop
        What is done to an image first.

    Raises
    ------
    InputError
        When it cannot be read, or the method cannot work on it.
    """
    if not is_code(source):
        from texlab_core.images.exemplar import as_exemplar

        return {"exemplar": as_exemplar(source, scale=scale, crop=crop)}
    if not any(spec.name == "code" for spec in method.inputs):
        raise InputError(f"{source} is a code of numbers, and {method.title} needs an image; say --method msg.")
    if scale != 1.0 or crop is not None:
        raise InputError(f"{source} is a code of numbers, which can be neither scaled nor cropped.")
    from texlab_core.methods.spectral.codefile import load_code_input

    return {"code": load_code_input(Path(source))}
