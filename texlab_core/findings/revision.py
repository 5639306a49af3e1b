"""What the numbers and sentences of a record rest on: those of an older program are not taken for new ones."""

from __future__ import annotations

import functools
import hashlib

from texlab_core.engine.plugins import OWN_PACKAGE
from texlab_core.engine.run import version_of
from texlab_core.findings.limits import RULES
from texlab_core.findings.registry import detectors
from texlab_core.measures.limits import LIMITS
from texlab_core.measures.registry import measures

# Raised whenever a measure or a detector says something else of the same result.
REVISION = 1


@functools.cache
def judged_by() -> str:
    """Return a short text that differs where the same result might be judged differently.

    Returns
    -------
    str
        The revision of our own measures and detectors, and a hash of all limits and of what other packages with
        measures or detectors are installed, in which versions.
    """
    limits = [(each.name, each.terms, each.fit.weights, each.fit.limit, each.methods, each.when) for each in RULES]
    packages = {each.package for each in measures().values()} | {each.package for each in detectors().values()}
    zones = [(each.measure, each.good, each.bad) for each in LIMITS.values()]
    content = repr((limits, zones, [(name, version_of(name)) for name in sorted(packages - {OWN_PACKAGE})]))
    return f"{REVISION}-{hashlib.sha256(content.encode()).hexdigest()[:12]}"
