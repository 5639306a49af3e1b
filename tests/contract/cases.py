"""The methods, and small jobs to hold them to their promises."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from hypothesis import strategies as st

from texlab_core.engine.job import Job
from texlab_core.engine.params import Params, describe
from texlab_core.engine.registry import Method, methods
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.steps import FloatImage

METHODS = list(methods().values())
IDS = list(methods())


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


def job(method: Method, exemplar: ImageInput | None = None, **changes: Any) -> Job:
    """Return a job of the method on a small colour texture."""
    inputs: dict[str, Any] = {}
    knobs = {field.name for field in describe(method.params)}
    for spec in method.inputs:
        if spec.kind == "image" and spec.name == "exemplar":
            inputs[spec.name] = exemplar or texture(24, 32)
        # A knob with the name of an input says something of that input.
        elif spec.required or spec.name in knobs:
            if spec.kind != "image":
                raise AssertionError(
                    f"Give tests/contract/cases.py an example of the input {spec.name} of {method.id}."
                )
            # Another texture of another size, of as many channels.
            inputs[spec.name] = texture(21, 26, inputs["exemplar"].channels)
    if changes.get("size") is not None:
        changes["size"] = size_for(method, changes["size"])
    return Job(**({"method": method.id, "inputs": inputs} | changes))


def size_for(method: Method, size: tuple[int, int]) -> tuple[int, ...]:
    """Return a size as the method takes it: with a small depth before it for a method of three dimensions."""
    return (*(5,) * (method.dimensions - 2), *size)


def params_of(method: Method) -> st.SearchStrategy[Params]:
    """Return a strategy for every setting that each knob accepts and the checks over several knobs let pass."""
    values: dict[str, st.SearchStrategy[Any]] = {}
    for field in describe(method.params):
        low, high = field.knob.low, field.knob.high
        if field.kind == "int":
            numbers = st.integers(None if low is None else int(low), None if high is None else int(high))
            values[field.name] = numbers.filter(lambda value: value % 2 == 1) if field.knob.odd else numbers
        elif field.kind == "float":
            values[field.name] = st.floats(low, high, allow_nan=False, allow_infinity=False)
        elif field.kind == "bool":
            values[field.name] = st.booleans()
        elif field.kind == "choice":
            values[field.name] = st.sampled_from(field.choices)
        else:
            values[field.name] = st.just(field.default)
    return (
        st.fixed_dictionaries(values)
        .map(lambda chosen: _build(method, chosen))
        .filter(lambda built: built is not None)
    )  # type: ignore[return-value]


def _build(method: Method, chosen: dict[str, Any]) -> Params | None:
    from texlab_core.errors import ParamError

    try:
        return method.params(**chosen)
    except ParamError:  # a check over several fields
        return None


def assert_image(image: FloatImage, shape: tuple[int, ...]) -> None:
    """Assert what every image that leaves a method is: float32 in [0, 1], of this shape."""
    assert isinstance(image, np.ndarray)
    assert image.dtype == np.float32
    assert image.shape == shape
    assert np.isfinite(image).all()
    assert image.min() >= 0
    assert image.max() <= 1


def assert_sentence(text: str) -> None:
    """Assert that a text is one sentence for people."""
    assert text == text.strip()
    assert "\n" not in text
    assert text.endswith((".", "?"))
