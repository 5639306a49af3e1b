"""The line below a column: state, times, numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab.style.numbers import duration, remaining
from texlab.widgets.status_line import SEPARATOR

if TYPE_CHECKING:
    from texlab.state.scene import ColumnScene

_SIGNS = {
    "idle": "",
    "waiting": "waits for a core",
    "running": "",
    "finished": "",
    "cancelled": "stopped",
    "failed": "",
}


def status_line(scene: ColumnScene) -> str:
    """Return what is said under a column's picture, as one line."""
    return SEPARATOR.join(status_parts(scene))


def status_parts(scene: ColumnScene) -> list[str]:
    """Return what is said under a column's picture."""
    if scene.status == "failed":
        return [scene.message]
    parts = []
    sign = scene.message if scene.status == "waiting" and scene.message else _SIGNS[scene.status]
    if sign:
        parts.append(sign)
    if scene.status == "cancelled" and scene.resumable:
        parts.append("F6 goes on")
    if scene.draft and scene.status in ("running", "finished"):
        parts.append("draft")
    if scene.status == "running" and scene.message:
        parts.append(scene.message)
    if scene.status == "running" and scene.elapsed_s > 1.0 and 0.02 < scene.fraction < 1:
        left = scene.elapsed_s * (1 - scene.fraction) / scene.fraction
        parts.append(f"about {remaining(left)} left" if left >= 1 else "almost done")
    if scene.status == "finished" and scene.result is not None:
        height, width = scene.result.image.shape[:2]
        parts += [f"{width} x {height}", duration(scene.elapsed_s)]
        if any(name == "code" for name, _ in scene.inputs):
            parts.append("from a code, not the exemplar")
        numbers = {**scene.result.measures, **scene.metrics}
        parts += [format_measure(name, numbers[name]) for name in _MEASURES if name in numbers][:MOST_NUMBERS]
    return parts


MOST_NUMBERS = 3

# In the order in which they are shown, as far as a result has them.
_MEASURES = {
    "parameters": ("numbers", "{:.0f}"),
    "copied-share": ("copied", "{:.0%}"),
    "median-candidates": ("candidates", "{:.0f}"),
    "w1-bands": ("W1 bands", "{:.3f}"),
    "largest-pole": ("largest pole", "{:.3f}"),
    "spectral-distance": ("spectrum", "{:.1f} dB"),
    "spectral-variation": ("power moved", "{:.0%}"),
}


def format_measure(name: str, value: float) -> str:
    """Return a measure as it is shown under a column."""
    title, shape = _MEASURES[name]
    return f"{title} {shape.format(value)}"
