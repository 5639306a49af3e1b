"""What a run will take, said before it starts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from texlab_core.engine.inputs import ImageInput
from texlab_core.engine.registry import Estimate
from texlab_core.engine.sizes import size_text
from texlab_core.errors import InputError
from texlab_core.work.memory import machine_bytes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method

# What nobody has asked for by hand starts by itself up to here: 4096 x 4096.
LARGE_SAMPLES = 2**24
# Nor does what takes longer than a minute on one core, or more than this share of the machine's memory.
LARGE_SHARE = 0.25
LARGE_SECONDS = 60


def estimate_of(method: Method, inputs: Inputs, params: Params, size: Sequence[int]) -> Estimate:
    """Foretell what a run takes: by the method itself, else from the pixels of the images and of the output."""
    if method.estimate is not None:
        return method.estimate(inputs, params, tuple(size))
    images = sum(math.prod(each.size) for each in inputs.values() if isinstance(each, ImageInput))
    return Estimate(None, method.bytes_per_pixel * (images + math.prod(size)))


def check_memory(method: Method, estimate: Estimate, size: Sequence[int]) -> None:
    """Refuse what the machine cannot hold.

    Raises
    ------
    InputError
        When a run takes more memory than there is.
    """
    held = machine_bytes()
    if held is not None and estimate.nbytes > held:
        raise InputError(
            f"{method.title} of {size_text(tuple(size))} needs about {estimate.nbytes / 1e9:.1f} GB of memory, "
            f"and this machine has {held / 1e9:.1f} GB; choose a smaller size."
        )


def is_large(estimate: Estimate, size: Sequence[int]) -> bool:
    """Return whether a run should not start before somebody has asked for it."""
    held = machine_bytes()
    if math.prod(size) > LARGE_SAMPLES or (estimate.seconds or 0) > LARGE_SECONDS:
        return True
    return held is not None and estimate.nbytes > LARGE_SHARE * held


def in_words(estimate: Estimate) -> str:
    """Return what a run takes, as part of a sentence: "about 6.9 GB of memory and 40 s"."""
    megabytes = max(1, round(estimate.nbytes / 1e6))
    memory = f"{estimate.nbytes / 1e9:.1f} GB" if megabytes >= 100 else f"{megabytes} MB"
    seconds = estimate.seconds
    if seconds is None:
        return f"about {memory} of memory"
    time = f"{max(1, round(seconds))} s" if seconds < 120 else f"{round(seconds / 60)} min"
    return f"about {memory} of memory and {time}"
