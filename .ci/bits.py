"""Which methods give other bits with other versions of the libraries.

    python .ci/bits.py > bits.json              here and now
    python .ci/bits.py --against bits.json      what differs from then; exit code 1 when something does

The jobs are small, one for each method with its defaults, one for each of its presets, in colour and in gray.
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
    from texlab_core.documents.preset_store import bundled_presets
    from texlab_core.engine.inputs import Crop
    from texlab_core.engine.job import Job
    from texlab_core.engine.registry import methods
    from texlab_core.engine.run import run
    from texlab_core.errors import InputError
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
            try:
                result = run(
                    Job(method=method, inputs={"exemplar": exemplar}, params=params, size=(40, 64), seed=1),
                    threads=1,
                )
                bits = hashlib.sha256(result.image.tobytes()).hexdigest()
            except InputError as error:
                bits = f"refused: {error}"
            found[f"{name}, {kind}"] = bits
    return found


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    sys.exit(main(sys.argv[1:]))
