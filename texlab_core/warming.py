"""Loading what is loaded late (compiled kernels, transforms) before anybody waits for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import Cancelled, InputError
from texlab_core.images import as_exemplar
from texlab_core.registry import methods
from texlab_core.run import Job, Streams, run

if TYPE_CHECKING:
    from collections.abc import Callable

SIDE = 48


def warm_up(should_stop: Callable[[], bool] | None = None) -> tuple[str, ...]:
    """Run every method once on a tiny gray and a tiny coloured exemplar, and forget the results.

    Afterwards no run waits for a kernel to be compiled or loaded. It takes a second or two, or half a minute
    when nothing has been compiled on this machine yet.

    Returns
    -------
    tuple of str
        The methods that were run; not all of them when ``should_stop`` said so.
    """
    noise = Streams(0)("warm up").random((SIDE, SIDE, 3), np.float32)
    done: list[str] = []
    for name in methods():
        for pixels in (noise[..., :1], noise):
            try:
                run(Job(method=name, inputs={"exemplar": as_exemplar(pixels)}), should_stop=should_stop, threads=1)
            except Cancelled:
                return tuple(done)
            except InputError:
                # A method that cannot use an exemplar of this size loads its kernels when it is used.
                continue
        done.append(name)
    return tuple(done)
