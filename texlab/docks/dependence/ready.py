"""Ready-made examples of dependence that is lost: the textbook's assignment, and failures that the papers show."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab.state.intentions import OpenFailure, OpenLesson
from texlab_core.engine.registry import find_method
from texlab_core.findings.failures import examples

if TYPE_CHECKING:
    from texlab.state.intentions import Intention
    from texlab_core.findings.failures import Failure

LESSON = "assignment-a"
# Heeger and Bergen, section 6 and its figures; De Bonet, figures 2 to 4 of section 2.
FAILURES = (
    "coral",
    "wood-grain",
    "dots-in-lines",
    "hay",
    "fur",
    "marble",
    "inhomogeneous-seeds",
    "even-seeds",
    "tiling",
    "independent-pixels",
    "independent-bands",
)
# The method that does not make bands without asking the others.
ASKING = "de-bonet"


def choices() -> list[tuple[str, str]]:
    """Return the examples as (text, name) for a list."""
    known = examples()
    return [
        ("Assignment a: where independence fails", LESSON),
        *((_titled(known[name]), name) for name in FAILURES),
    ]


def _titled(example: Failure) -> str:
    method = find_method(example.method).title
    return example.title if example.title == method else f"{example.title} ({method})"


def opening(name: str) -> Intention:
    """Return what opens an example, with De Bonet's method beside it."""
    return OpenLesson(LESSON) if name == LESSON else OpenFailure(name, ASKING)
