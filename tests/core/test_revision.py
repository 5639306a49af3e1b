"""Numbers of an older program are not taken for new ones: what they rest on has a name that changes with them."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest

from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.findings import revision
from texlab_core.findings.limits import RULES
from texlab_core.findings.registry import detectors, find_all
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.registry import measure_all, measures
from texlab_core.measures.subject import Subject

KNOWN_REVISION = 1
NUMBERS = {
    "discriminability": -2.2435,
    "magnitude-difference": 0.070756,
    "block-distance": 1.1659,
    "visual-difference": 6.7245e-08,
    "laid-down-share": 1.0,
    "tile-share": 1.0,
    "self-repetition": 1.0,
    "copied-share": 0.98841,
    "largest-copy": 0.53333,
    "mean-copy": 1920.0,
    "source-repetition": 1.875,
    "patches-copied": 0.80808,
    "cuts": 32.006,
    "own-cuts": 4.5607,
    "seam": 35.648,
    "spectral-distance": 4.903,
    "spectral-variation": 0.24002,
    "peak-shift-octaves": 0.17865,
    "cuts-at-sides": 32.006,
    "peak-shift-degrees": 5.5243,
    "w1-pixels": 0.04776,
    "w1-bands": 0.085474,
    "dependence-difference": 0.10932,
    "block-distance-back": 0.55374,
    "odd-blocks": 2.4695,
    "energy-spread": 1.3291,
    "palette-distance": 0.0,
    "specks": 0.0088542,
    "empty-share": 0.0,
    "local-contrast": 1.0378,
    "exemplar-unevenness": 1.0107,
    "exemplar-drift": 0.15714,
    "exemplar-symmetry": 0.15294,
    "exemplar-symbols": 0.68285,
    "exemplar-structure": 0.38543,
    "exemplar-period": 0.22053,
}
FINDINGS = ["cuts", "does-not-tile", "repetition"]


def said() -> tuple[dict[str, float], list[str]]:
    """Return all measures of one small result, and the ids of its findings."""
    exemplar = as_exemplar("gallery:structured-pebbles", crop=Crop(30, 40, 64, 64))
    subject = Subject.of_result(run(Job(method="tiling", inputs={"exemplar": exemplar}, size=(96, 80))))
    return measure_all(subject, list(measures())), [each.id for each in find_all(subject)]


def test_what_says_something_else_has_another_revision() -> None:
    numbers, findings = said()
    hint = "raise REVISION in findings/revision.py, then renew the numbers of this test"
    assert revision.REVISION == KNOWN_REVISION, "renew the numbers of this test"
    assert numbers == pytest.approx(NUMBERS, rel=2e-3, abs=1e-4), hint
    assert findings == FINDINGS, hint


def judged() -> str:
    return revision.judged_by.__wrapped__()


def test_limits_and_other_packages_are_part_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    before = judged()
    assert revision.judged_by() == before
    assert before.startswith(f"{revision.REVISION}-")
    first = RULES[0]
    moved = dataclasses.replace(first, fit=dataclasses.replace(first.fit, limit=first.fit.limit + 0.01))
    found = {before}
    versions: dict[str, Any] = {"their-package": "1.0"}
    monkeypatch.setattr(revision, "version_of", versions.__getitem__)
    for change in ({"RULES": (moved, *RULES[1:])}, {"REVISION": revision.REVISION + 1}):
        with monkeypatch.context() as patch:
            for name, value in change.items():
                patch.setattr(revision, name, value)
            found.add(judged())
    theirs = dataclasses.replace(next(iter(detectors().values())), id="theirs", package="their-package")
    monkeypatch.setattr(revision, "detectors", lambda: {**detectors(), "theirs": theirs})
    found.add(judged())
    versions["their-package"] = "1.1"
    found.add(judged())
    assert len(found) == 5
