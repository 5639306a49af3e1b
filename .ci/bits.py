"""Which methods give other bits with other versions of the libraries.

    python .ci/bits.py > bits.json              here and now
    python .ci/bits.py --against bits.json      what differs from then; exit code 1 when something does

The jobs are small, one for each method with its defaults, one for each of its presets, in colour and in gray; a
solid counts with all its voxels, and a method that takes further images gets one.
"""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path


def main(arguments: list[str]) -> int:
    """Print the hashes, or what differs from those in a file."""
    found = {"versions": dict(_versions()), "bits": _bits()}
    if not arguments:
        print(json.dumps(found, indent=2))
        return 0
    if len(arguments) != 2 or arguments[0] != "--against":
        print((__doc__ or "").strip(), file=sys.stderr)
        return 2
    before = json.loads(Path(arguments[1]).read_text("utf-8"))
    for name in sorted({*found["versions"], *before["versions"]}):
        then, now = before["versions"].get(name, "none"), found["versions"].get(name, "none")
        if then != now:
            print(f"{name}: {then} then, {now} now")
    names = sorted({*found["bits"], *before["bits"]})
    differs = [name for name in names if found["bits"].get(name) != before["bits"].get(name)]
    for name in differs:
        print(f"other bits: {name}")
    print(f"{len(names) - len(differs)} of {len(names)} jobs give the same bits.")
    return 1 if differs else 0


def _versions() -> dict[str, str]:
    from texlab_core.engine.run import versions

    return dict(versions())


def _bits() -> dict[str, str]:
    from texlab_core.contract.cases import job
    from texlab_core.documents.preset_store import bundled_presets
    from texlab_core.engine.inputs import Crop
    from texlab_core.engine.registry import find_method, methods
    from texlab_core.engine.run import run
    from texlab_core.images.exemplar import as_exemplar

    exemplars = {
        "colour": as_exemplar("gallery:structured-pebbles", crop=Crop(16, 16, 48, 56)),
        "gray": as_exemplar("gallery:stochastic-grass", scale=0.5, crop=Crop(0, 0, 48, 56)),
    }
    variants = [(method.id, method.id, method.params()) for method in methods().values()]
    variants += [(f"{each.method}/{each.name}", each.method, each.params()) for each in bundled_presets()]
    found = {}
    for kind, exemplar in exemplars.items():
        for name, method, params in variants:
            result = run(job(find_method(method), exemplar, params=params, size=(40, 64), seed=1), threads=1)
            whole = result.image if result.volume is None else result.volume
            found[f"{name}, {kind}"] = hashlib.sha256(whole.tobytes()).hexdigest()
    return found


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    sys.exit(main(sys.argv[1:]))
