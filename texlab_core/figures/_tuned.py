"""What the tuner gains: ``python -m texlab_core.figures._tuned [--budget RUNS] [--only NAME ... | --write PAGE]``.

Over the homogeneous textures of the gallery, the central 128 x 128 pixels to 256 x 256, it lets the tuner look for
De Bonet parameters with a larger V at no larger D than the defaults have, measures both again with seeds that
neither the search nor its choice ever saw, and says on what share of the textures the promise holds.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.figures._stated import state
from texlab_core.figures.defaults import OUTPUT, centre, homogeneous
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import PreparedCache, Subject
from texlab_core.sheets.tuning import tune
from texlab_core.sheets.tuning_report import GAINED, KEPT
from texlab_core.sheets.tuning_search import DEFAULT_BUDGET

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab_core.engine.params import Params

# Of the textures on which V has to be larger at no larger D.
BAR = 0.8
# Judged with these; the tuner draws its own from the job's, which is 1.
JUDGES = tuple(range(101, 117))


@dataclass(frozen=True)
class Gain:
    """What became of one texture: D and V of the defaults, and of what was found, over the judging seeds.

    Parameters
    ----------
    name
        Of the texture.
    kept, gained
        D and V of what was found, means.
    base_kept, base_gained
        The same of the defaults.
    changes
        The parameters that the tuner changed; none where it found nothing better.
    """

    name: str
    kept: float
    gained: float
    base_kept: float
    base_gained: float
    changes: Mapping[str, object]

    @property
    def holds(self) -> bool:
        """Whether V is larger at no larger D."""
        return self.gained > self.base_gained and self.kept <= self.base_kept

    def line(self) -> str:
        """Return what is printed of it."""
        verdict = "holds" if self.holds else ("fails" if self.changes else "nothing found")
        return (
            f"{self.name:28} D {self.base_kept:6.2f} -> {self.kept:6.2f}  V {self.base_gained:.3f} ->"
            f" {self.gained:.3f}  {verdict}"
        )


def gain(name: str, budget: int = DEFAULT_BUDGET, judges: Sequence[int] = JUDGES) -> Gain:
    """Tune De Bonet for one texture of the gallery, and judge what was found beside the defaults."""
    params = find_method("de-bonet").params()
    base = Job(method="de-bonet", inputs={"exemplar": centre(name)}, params=params, size=(OUTPUT, OUTPUT), seed=1)
    cache, prepared = AnalysisCache(), PreparedCache()
    found = tune(base, limit="start", budget=budget, cache=cache, prepared=prepared)

    def judged(chosen: Params) -> tuple[float, float]:
        numbers = []
        for seed in judges:
            result = run(replace(base, params=chosen, seed=seed), cache=cache)
            measured = measure_all(Subject.of_result(result, prepared), (KEPT, GAINED))
            numbers.append((measured[KEPT], measured[GAINED]))
        kept, gained = np.mean(numbers, axis=0)
        return float(kept), float(gained)

    own = judged(params)
    kept, gained = judged(found.found) if found.changes else own
    return Gain(name, kept, gained, *own, changes=found.changes)


def words(found: Sequence[Gain]) -> str:
    """Return on how many of the textures the promise holds, as the help says it."""
    held = sum(each.holds for each in found)
    return f"V is larger at no larger D on {held} of {len(found)} textures ({held / len(found):.0%})."


def main() -> int:
    """Tune, print, and compare with the bar; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m texlab_core.figures._tuned", allow_abbrev=False)
    parser.add_argument("--budget", type=int, default=DEFAULT_BUDGET, help="runs for each texture")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--only", nargs="+", metavar="NAME", help="these textures instead of all homogeneous ones")
    which.add_argument("--write", type=Path, metavar="HELP_PAGE", help="put what holds into the help page")
    args = parser.parse_args()
    found = []
    try:
        for name in args.only or homogeneous():
            found.append(gain(name, args.budget))
            print(found[-1].line(), flush=True)
        if args.write is not None:
            state(args.write, "tuned", lambda: words(found))
    except (InputError, OSError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 2
    print(words(found))
    return 0 if sum(each.holds for each in found) >= BAR * len(found) else 1


if __name__ == "__main__":
    sys.exit(main())
