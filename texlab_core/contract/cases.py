"""Small jobs to hold methods to their promises, and what a broken promise is called."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.job import Job
from texlab_core.engine.params import describe
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab_core.engine.inputs import ImageInput, Input
    from texlab_core.engine.registry import Method
    from texlab_core.engine.steps import FloatImage


class Broken(AssertionError):
    """A promise that a method does not keep; one sentence for whoever writes the method."""


def promise(kept: object, sentence: str) -> None:
    """Raise ``Broken`` unless a promise is kept."""
    if not kept:
        raise Broken(sentence)


@contextlib.contextmanager
def case(what: str) -> Iterator[None]:
    """Note the case in whatever goes wrong with it."""
    try:
        yield
    except Exception as error:
        error.add_note(what)
        raise


def texture(height: int, width: int, channels: int = 3) -> ImageInput:
    """Return blobs of correlated colour, the same ones on every call."""
    rng = np.random.Generator(np.random.PCG64(height * 1000 + width))
    white = rng.standard_normal((height, width, channels))
    rows = np.exp(-0.5 * (np.fft.fftfreq(height) / 0.15) ** 2)[:, None, None]
    columns = np.exp(-0.5 * (np.fft.fftfreq(width) / 0.08) ** 2)[None, :, None]
    smooth = np.fft.ifft2(np.fft.fft2(white, axes=(0, 1)) * rows * columns, axes=(0, 1)).real
    if channels == 3:
        smooth = smooth @ np.array([[1.0, 0.6, 0.2], [0.0, 0.5, 0.1], [0.0, 0.1, 0.4]])
    low, high = smooth.min(), smooth.max()
    return as_exemplar(((smooth - low) / max(high - low, 1e-9)).astype(np.float32))


def odd_exemplars() -> dict[str, ImageInput]:
    """Return exemplars that are tiny, narrow, of odd sides, constant or of few colours, by what they are."""
    checks = np.indices((16, 16)).sum(0)[..., None] % 2
    return {
        "2 x 2": texture(2, 2),
        "2 x 9 in gray": texture(2, 9, 1),
        "3 x 5": texture(3, 5),
        "7 x 7 in gray": texture(7, 7, 1),
        "61 x 4": texture(61, 4),
        "13 x 31": texture(13, 31),
        "constant": as_exemplar(np.full((16, 16, 3), (0.2, 0.4, 0.6), np.float32)),
        "constant gray": as_exemplar(np.full((16, 16), 0.5, np.float32)),
        "black": as_exemplar(np.zeros((9, 12), np.uint8)),
        "one dot": as_exemplar(np.eye(1, 16 * 16, 100, dtype=np.float32).reshape(16, 16)),
        "two colours": as_exemplar(np.where(checks, (1.0, 0, 0), (0, 0, 1.0))),
    }


def job(method: Method, exemplar: ImageInput | None = None, **changes: Any) -> Job:
    """Return a job of the method on a small colour texture; another one stands for every other image it needs."""
    exemplar = texture(24, 32) if exemplar is None else exemplar
    inputs: dict[str, Input] = {}
    knobs = {field.name for field in describe(method.params)}
    for spec in method.inputs:
        if spec.kind == "image" and spec.name == "exemplar":
            inputs[spec.name] = exemplar
        # A knob with the name of an input says something of that input.
        elif spec.required or spec.name in knobs:
            promise(
                spec.kind == "image",
                f"the input {spec.name} is required, and these checks can make images only; give it a default.",
            )
            inputs[spec.name] = texture(21, 26, exemplar.channels)
    given: dict[str, Any] = {"method": method.id, "inputs": inputs} | changes
    if given.get("size") is not None:
        given["size"] = size_for(method, given["size"])
    return Job(**given)


def size_for(method: Method, size: tuple[int, int]) -> tuple[int, ...]:
    """Return a size as the method takes it: with a small depth before it for a method of three dimensions."""
    return (*(5,) * (method.dimensions - 2), *size)


def check_image(image: FloatImage, shape: tuple[int, ...], what: str) -> None:
    """Check what every image that leaves a method is: float32 in [0, 1], of this shape."""
    promise(isinstance(image, np.ndarray), f"{what} must be an array, got {type(image).__name__}.")
    promise(image.dtype == np.float32, f"{what} must be float32, got {image.dtype}.")
    promise(image.shape == shape, f"{what} must have the shape {shape}, got {image.shape}.")
    promise(np.isfinite(image).all(), f"{what} must hold finite values only.")
    low, high = float(image.min()), float(image.max())
    promise(low >= 0 and high <= 1, f"{what} must lie in 0 to 1, got {low:g} to {high:g}.")


def check_sentence(text: str, what: str) -> None:
    """Check that a text is one sentence for people."""
    good = text and text == text.strip() and "\n" not in text and text.endswith((".", "?"))
    promise(good, f"{what} must be one sentence on one line that ends with a full stop, got {text!r}.")
