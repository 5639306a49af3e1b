"""The line below a column: state, times, numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab.style.numbers import duration, remaining
from texlab.widgets.status_line import SEPARATOR
from texlab_core.engine.sizes import size_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab.state.scene import ColumnScene
    from texlab_core.findings.finding import Finding

# How many numbers are shown at once; the tool tip has all.
MOST_NUMBERS = 3

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
    if scene.status == "idle" and scene.message:
        return [scene.message]
    parts = []
    sign = scene.message if scene.status == "waiting" and scene.message else _SIGNS[scene.status]
    if sign:
        parts.append(sign)
    if scene.status == "cancelled" and scene.resumable:
        parts.append("F6 goes on")
    if scene.draft and scene.status in ("running", "finished"):
        parts.append("draft" if scene.image is None else f"draft {scene.image.shape[1]} x {scene.image.shape[0]}")
    if scene.status == "running" and scene.message:
        parts.append(scene.message)
    if scene.status == "running" and scene.elapsed_s > 1.0 and 0.02 < scene.fraction < 1:
        left = scene.elapsed_s * (1 - scene.fraction) / scene.fraction
        parts.append(f"about {remaining(left)} left" if left >= 1 else "almost done")
    if scene.status == "finished" and scene.result is not None:
        result = scene.result
        made = result.image.shape[:2] if result.volume is None else result.volume.shape[:3]
        parts += [size_text(made), duration(scene.elapsed_s)]
        if any(name == "code" for name, _ in scene.inputs):
            parts.append("from a code, not the exemplar")
    if scene.status == "finished":
        parts += signs(scene.findings)
        parts += headline(numbers_of(scene))
    return parts


def signs(findings: Sequence[Finding]) -> list[str]:
    """Return how many findings and how many hints there are, each with its sign: they are counted apart."""
    sure = sum(each.certainty == "finding" for each in findings)
    hints = len(findings) - sure
    return ([f"! {sure}"] if sure else []) + ([f"? {hints}"] if hints else [])


def numbers_of(scene: ColumnScene) -> dict[str, float]:
    """Return the numbers about the picture by id: what was measured, and what the method says itself."""
    said = {} if scene.result is None else scene.result.measures
    return {**said, **scene.measures}


def headline(numbers: Mapping[str, float]) -> list[str]:
    """Return the few numbers that are shown at once, in words."""
    from texlab_core.measures.registry import measures, written

    ids = [each.id for each in measures().values() if each.id in numbers and not each.part_of]
    return written(numbers, ids[:MOST_NUMBERS])


def details(scene: ColumnScene) -> list[str]:
    """Return every number about the picture in words, with the size of the picture that they are about."""
    from texlab_core.measures.registry import measures, written

    numbers = numbers_of(scene)
    lines = written(numbers, [name for name in measures() if name in numbers])
    if lines and scene.measured_size is not None:
        height, width = scene.measured_size
        lines.insert(0, f"Measured at {width} x {height}:")
    return [each.sentence for each in scene.findings] + lines
