"""The line below a column: state, times, numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab.style.numbers import duration, remaining
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
        if any(name == "code" for name, _ in scene.inputs):
            parts.append("from a code, not the exemplar")
        parts += [size_text(made), duration(scene.elapsed_s)]
        if scene.stored:
            parts.append("kept from before")
    if scene.status == "finished":
        parts += signs(scene.findings or ())
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


def shows_numbers(scene: ColumnScene) -> bool:
    """Whether the numbers are about the picture that is shown: a finished one, or one of an earlier session."""
    return scene.status == "finished" or (
        scene.status in ("idle", "waiting") and scene.result is None and not scene.draft
    )


def known_numbers(scene: ColumnScene | None) -> dict[str, float] | None:
    """Return the numbers about the finished result by id, as files keep them; None while there are none."""
    # Those of a draft are about a smaller picture.
    measured = scene is not None and scene.status == "finished" and not scene.draft and bool(scene.measures)
    return numbers_of(scene) if measured and scene is not None else None


@dataclass(frozen=True)
class Figure:
    """A number that is shown large.

    Parameters
    ----------
    text
        Title and value, with a mark where it became better or worse.
    short
        The value alone, for where the title has no room.
    tip
        What it says, what the mark is about, and what is known about its limits.
    """

    text: str
    tip: str
    short: str = ""


def figures(numbers: Mapping[str, float], before: Mapping[str, float] | None = None) -> list[Figure]:
    """Return the few numbers that are shown at once; ▲ is better than ``before``, ▼ worse."""
    from texlab_core.measures.limits import LIMITS
    from texlab_core.measures.registry import measures, written

    chosen = [each for each in measures().values() if each.id in numbers and not each.part_of][:MOST_NUMBERS]
    made = []
    for each in chosen:
        value, old = numbers[each.id], (before or {}).get(each.id)
        (text,) = written(numbers, [each.id])
        tip = [each.summary]
        if each.id in LIMITS:
            limit = LIMITS[each.id]
            tip.append(f"{limit.zone(value).capitalize()}. {limit.evidence}")
        mark = ""
        if old is not None and each.text(old) != each.text(value) and each.better != "neither":
            mark = "▲" if (value < old) == (each.better == "lower") else "▼"
            tip.append(f"{'Better' if mark == '▲' else 'Worse'} than the result before: {each.text(old)}.")
        tip.insert(0, text)
        made.append(Figure(f"{text} {mark}".rstrip(), "\n".join(tip), each.text(value)))
    return made


def details(scene: ColumnScene) -> list[str]:
    """Return every number about the picture in words, with the size of the picture that they are about."""
    from texlab_core.measures.registry import measures, written

    numbers = numbers_of(scene)
    lines = written(numbers, [name for name in measures() if name in numbers])
    if lines and scene.measured_size is not None:
        height, width = scene.measured_size
        lines.insert(0, f"Measured at {width} x {height}:")
    return [each.sentence for each in scene.findings or ()] + lines
