"""The special editors of parameter types that no slider, box or list can show."""

from __future__ import annotations


def register_editors() -> None:
    """Register every special editor with the parameter form."""
    from texlab.docks.thresholds import knob

    knob.register()
