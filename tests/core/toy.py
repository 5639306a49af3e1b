"""Small methods with known answers, to test what drives methods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from texlab_core.engine.inputs import Inputs, exemplar_of
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.registry import Method
from texlab_core.engine.steps import Curve, Output, Step

if TYPE_CHECKING:
    from collections.abc import Generator

    import pytest

    from texlab_core.engine.plugins import Entry, Shelf
    from texlab_core.engine.streams import Streams


def stock(monkeypatch: pytest.MonkeyPatch, shelf: Shelf[Any], *entries: Entry, alone: bool = False) -> None:
    """Put entries on a shelf for one test, beside what is there or alone; other packages are looked for anew."""
    there = shelf.all()
    monkeypatch.setattr(shelf, "_entries", ({} if alone else dict(there)) | {each.id: each for each in entries})
    monkeypatch.setattr(shelf, "_ordered", None)
    monkeypatch.setattr(shelf, "_failures", None)


@dataclass(frozen=True, kw_only=True)
class NoiseParams(Params):
    rounds: Annotated[int, Knob(help="Rounds of drawing.", low=1, high=9)] = 3
    spread: Annotated[float, Knob(help="Width of the noise.", low=0, high=1)] = 0.25
    power: Annotated[int, Knob(help="Moment to keep.", low=1, high=4, stage="analysis")] = 1


class Log:
    """What a toy method was asked to do, and whether it was closed."""

    def __init__(self) -> None:
        self.analyzed = 0
        self.closed = 0


def noise_method(log: Log | None = None, **changes: Any) -> Method:
    """Return a method whose result is the exemplar's mean plus uniform noise: the closed form is in the tests."""
    log = log or Log()

    def analyze(inputs: Inputs, params: NoiseParams) -> Generator[Step, None, float]:
        log.analyzed += 1
        yield Step(0, 1, "measure")
        mean = float((exemplar_of(inputs).pixels.astype(np.float64) ** params.power).mean())
        yield Step(1, 1, "measure", phase="synthesis")
        return mean

    def synthesize(
        model: float, inputs: Inputs, params: NoiseParams, size: tuple[int, int], streams: Streams
    ) -> Generator[Step, None, Output]:
        channels = exemplar_of(inputs).channels
        image = np.zeros((*size, channels), np.float32)
        try:
            for i in range(params.rounds):
                noise = streams("noise", i).random((*size, channels), dtype=np.float32)
                image = np.clip(model + params.spread * (noise - 0.5), 0, 1).astype(np.float32)
                yield Step(i + 1, params.rounds, f"round {i + 1}", {"mean": float(image.mean())}, image.copy)
        finally:
            log.closed += 1
        curve = Curve.of([0.5, 0.25], "Distance")
        return Output(image=image, curves={"distance": curve}, measures={"mean": float(image.mean())})

    fields: dict[str, Any] = {
        "id": "toy-noise",
        "title": "Toy noise",
        "summary": "Noise around the mean.",
        "reference": "None.",
        "params": NoiseParams,
        "analyze": analyze,
        "synthesize": synthesize,
    }
    return Method(**(fields | changes))
