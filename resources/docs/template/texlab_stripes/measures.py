"""What only this method can say of its results, under a name of its own."""

from __future__ import annotations

from texlab_core.measures.registry import Measure, register

register(
    Measure(
        id="stripes",
        title="stripes",
        summary="Number of stripes, whole or cut.",
        low=1.0,
        high=1e6,
        better="neither",
        needs=("method",),
        form=".0f",
    )
)
