"""What a search for parameters tried and found, as a report and as a preset."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab_core.engine.params import frozen_mapping
from texlab_core.measures.registry import find_measure
from texlab_core.sheets.tuning_search import Measured

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab_core.documents.presets import Preset
    from texlab_core.engine.job import Job
    from texlab_core.engine.params import Params


# The two numbers: D is to stay small, V is to grow.
KEPT = "discriminability"
GAINED = "visual-difference"


@dataclass(frozen=True, kw_only=True)
class Trial(Measured):
    """One finished run of a search.

    Parameters
    ----------
    index
        Place in the order of asking.
    phase
        Part of the search that asked for it: "start", "alpha and coarsest side", "layouts", "fresh seeds".
    seed
        Of its random numbers.
    kept, gained
        The two numbers (D and V); NaN when it failed.
    error
        Why it failed, one sentence.
    """

    index: int
    phase: str
    seed: int
    error: str = ""


@dataclass(frozen=True, kw_only=True)
class Tuning:
    """What a search found, and everything that it tried.

    Parameters
    ----------
    base
        The job that it began with.
    limit
        D was to be no larger.
    trials
        All runs, in the order of asking; the first is ``base``.
    found
        The suggested parameters; those of ``base`` where nothing better holds on seeds that the search never saw.
    kept, gained
        Means of D and V of ``found`` over those seeds, and the same of ``base``.
    fresh
        Number of those seeds.
    """

    base: Job
    limit: float
    trials: tuple[Trial, ...]
    found: Params
    kept: float
    gained: float
    base_kept: float
    base_gained: float
    budget: int
    fresh: int
    knobs: tuple[str, ...] = ()

    @property
    def changes(self) -> Mapping[str, Any]:
        """The parameters that differ from those of the base, by name."""
        before = self.base.params
        return frozen_mapping(
            {name: value for name, value in self.found.to_json().items() if value != before.to_json()[name]}
        )

    @property
    def sentence(self) -> str:
        """What was found, in one or two sentences."""
        kept, gained = find_measure(KEPT), find_measure(GAINED)
        runs = f"{len(self.trials)} run{'' if len(self.trials) == 1 else 's'}"
        if not self.changes:
            return (
                f"In {runs} nothing made more that is new with {kept.title} at most {kept.text(self.limit)} than"
                f" what it began with ({kept.title} {kept.text(self.base_kept)},"
                f" {gained.title} {gained.text(self.base_gained)})."
            )
        held = "" if self.kept <= self.limit else f" No setting reached {kept.text(self.limit)}."
        return (
            f"{gained.title} {gained.text(self.gained)} instead of {gained.text(self.base_gained)}, {kept.title}"
            f" {kept.text(self.kept)} instead of {kept.text(self.base_kept)}: means over {self.fresh} seeds that"
            f" the search never saw, after {runs}.{held}"
        )

    def preset(self, name: str) -> Preset:
        """Return the suggestion as a preset of all parameters; raises ``PresetError`` for a name that is none."""
        from texlab_core.documents.presets import Preset
        from texlab_core.engine.inputs import ImageInput

        exemplar = self.base.inputs.get("exemplar")
        return Preset.of(
            name,
            self.base.method,
            self.found,
            note=f"Tuned. {self.sentence}",
            exemplar=exemplar if isinstance(exemplar, ImageInput) else None,
        )

    def to_json(self) -> dict[str, Any]:
        """Return the report: what was asked, tried and found."""
        before = self.base.params.to_json()

        def differing(params: Params) -> dict[str, Any]:
            return {name: value for name, value in params.to_json().items() if value != before[name]}

        return {
            "method": self.base.method,
            "limit": self.limit,
            "budget": self.budget,
            "knobs": list(self.knobs),
            "runs": len(self.trials),
            "sentence": self.sentence,
            "start": {KEPT: _number(self.base_kept), GAINED: _number(self.base_gained), "parameters": before},
            "found": {
                KEPT: _number(self.kept),
                GAINED: _number(self.gained),
                "changes": dict(self.changes),
                "parameters": self.found.to_json(),
            },
            "trials": [
                {
                    "phase": each.phase,
                    "seed": each.seed,
                    "changes": differing(each.params),
                    KEPT: _number(each.kept),
                    GAINED: _number(each.gained),
                    "error": each.error or None,
                }
                for each in self.trials
            ],
        }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None
