"""How De Bonet's defaults were chosen: ``python -m texlab_core.figures.defaults [--write HELP_PAGE]``.

Over the homogeneous textures of the gallery, the central 128 x 128 pixels to 256 x 256, it measures the defaults
beside what they replaced and what the paper has, prints the table of the help page, and says whether the defaults
are as new, as seamless, as alike and as fast as they have to be.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.figures import Figure
from texlab_core.figures._tools import page, title_of
from texlab_core.files.regular import read_regular
from texlab_core.files.whole import write_whole
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.gallery import gallery
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import PreparedCache, Subject
from texlab_core.sheets.contact_sheet import Tile

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.result import Result

SIDE, OUTPUT = 128, 256
SEEDS = (1, 2)
# A help page is far shorter.
MAX_PAGE_BYTES = 2**20
# Textures whose central part is not the same all over, beside the class that is called so.
_UNEVEN = frozenset(
    {
        "failure-colourgradient",
        "failure-sizegradient",
        "failure-spiral",
        "letters-handwriting",
        "oriented-fur",
        "oriented-oldwood",
        "oriented-woodgrain",
        "stochastic-marble",
        "stochastic-sea",
        "structured-butterfly",
        "structured-coins",
        "structured-coral",
    }
)
_SHIFTED: Mapping[str, Any] = MappingProxyType({"coarsest": "shift", "coarsest_side": 8, "fitting": "crop"})
SETTINGS: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "defaults": {},
        "preset variety": {"patch": 0.33, "alpha": 0.2},
        "preset paper": {"coarsest": "tile", "coarsest_side": 1, "fit_filters": False, "fitting": "crop"},
        "preset shifted": _SHIFTED,
        "shifted, alpha 0.30": {**_SHIFTED, "alpha": 0.3},
        "fit, border smooth": {"coarsest": "fit", "border": "smooth"},
        "alpha 0.30": {"alpha": 0.3},
        "coarsest side 16": {"coarsest_side": 16},
        "coarsest side 4": {"coarsest_side": 4, "fit_filters": False},
        "channels scaled": {"channels": "scaled"},
        "channels principal": {"channels": "principal"},
        "channels luminance": {"channels": "luminance"},
    }
)
# Measure, head of the column, format.
COLUMNS = (
    ("discriminability", "D", ".2f"),
    ("visual-difference", "V", ".2f"),
    ("tile-share", "tiled", ".2f"),
    ("laid-down-share", "laid down", ".2f"),
    ("copied-share", "copied", ".2f"),
    ("cuts", "cuts", ".1f"),
    ("own-cuts", "own", ".1f"),
    ("time", "time", ".2f"),
)
MOST_TILED, MOST_TIME = 0.35, 1.5
_SHOWN = (
    "stochastic-lava",
    "stochastic-gravel",
    "structured-scales",
    "structured-crazypaving",
    "quasiperiodic-brick",
    "structured-pebbles",
)
_TABLE = re.compile(r"(?<=<!-- defaults -->\n)\n.*?\n(?=\n<!-- end of defaults -->)", re.DOTALL)


@dataclass(frozen=True)
class Row:
    """Medians of one setting over textures and seeds, by measure; ``time`` is relative to the preset shifted."""

    setting: str
    medians: Mapping[str, float]


def homogeneous() -> tuple[str, ...]:
    """Return the names of the gallery's homogeneous textures."""
    return tuple(each.name for each in gallery() if each.cls != "inhomogeneous" and each.name not in _UNEVEN)


def centre(name: str) -> ImageInput:
    """Return the central part of a gallery texture."""
    height, width = as_exemplar(f"gallery:{name}").size
    crop = Crop(top=(height - SIDE) // 2, left=(width - SIDE) // 2, height=SIDE, width=SIDE)
    return as_exemplar(f"gallery:{name}", crop=crop)


def measured(
    names: Sequence[str], settings: Mapping[str, Mapping[str, Any]] = SETTINGS, seeds: Sequence[int] = SEEDS
) -> list[Row]:
    """Measure settings over textures; the preset shifted must be among them."""
    found: dict[str, list[dict[str, float]]] = {setting: [] for setting in settings}
    for name in names:
        exemplar, prepared = centre(name), PreparedCache()
        for seed in seeds:
            for setting, values in settings.items():
                result, spent = _timed(exemplar, values, seed)
                ids = [each for each, _, _ in COLUMNS if each != "time"]
                numbers = measure_all(Subject.of_result(result, prepared), ids)
                found[setting].append(numbers | {"time": spent})
    usual = np.array([each["time"] for each in found["preset shifted"]])
    rows = []
    for setting, every in found.items():
        medians = {each: float(np.median([one[each] for one in every])) for each, _, _ in COLUMNS}
        # Texture by texture: some take longer than others.
        medians["time"] = float(np.median(np.array([one["time"] for one in every]) / usual))
        rows.append(Row(setting, medians))
    return rows


def _timed(exemplar: ImageInput, values: Mapping[str, Any], seed: int) -> tuple[Result, float]:
    """Return a result, and the shortest CPU time of three runs with the analysis kept, as while a knob moves."""
    params, cache = find_method("de-bonet").params.from_json(values), AnalysisCache()
    job = Job(method="de-bonet", inputs={"exemplar": exemplar}, params=params, size=(OUTPUT, OUTPUT), seed=seed)
    result = run(job, cache=cache)
    spent = []
    for _ in range(3):
        start = time.thread_time()
        run(job, cache=cache)
        spent.append(time.thread_time() - start)
    return result, min(spent)


def table(rows: Sequence[Row]) -> str:
    """Return the table of the help page."""
    heads = [head for _, head, _ in COLUMNS]
    lines = ["| setting | " + " | ".join(heads) + " |", "|---|" + "---|" * len(heads)]
    for row in rows:
        numbers = [format(row.medians[name], form) for name, _, form in COLUMNS]
        lines.append(f"| {row.setting} | " + " | ".join(numbers) + " |")
    return "\n".join(lines)


def shortfalls(rows: Sequence[Row]) -> list[str]:
    """Return in what the defaults fall short, one sentence each."""
    by_name = {row.setting: row.medians for row in rows}
    own, former = by_name["defaults"], by_name["shifted, alpha 0.30"]
    limits = {
        "tile-share": ("median tile share", MOST_TILED, own["tile-share"] < MOST_TILED),
        "cuts": ("median cut", own["own-cuts"], own["cuts"] <= own["own-cuts"]),
        "discriminability": (
            "median D", former["discriminability"], own["discriminability"] <= former["discriminability"],
        ),
        "time": ("time", MOST_TIME, own["time"] <= MOST_TIME),
    }  # fmt: skip
    return [
        f"The {what} of the defaults is {own[name]:.2f} and may be at most {limit:.2f}."
        for name, (what, limit, holds) in limits.items()
        if not holds
    ]


def pictures() -> NDArray[np.uint8]:
    """Show the defaults beside what they replaced and what the paper has."""
    settings = {"shifted": "preset shifted", "paper": "preset paper", "defaults": "defaults"}
    tiles = []
    for name in _SHOWN:
        exemplar = centre(name)
        tiles.append(Tile(exemplar.pixels, ("exemplar", title_of(name))))
        for caption, setting in settings.items():
            result, _ = _timed(exemplar, SETTINGS[setting], SEEDS[0])
            numbers = measure_all(Subject.of_result(result), ("tile-share",))
            tiles.append(Tile(result.image, (caption, f"tiled {numbers['tile-share']:.2f}")))
    return page(tiles, 4)


FIGURES = (
    Figure("de-bonet-defaults.jpg", "De Bonet's defaults beside the former ones and the paper's.", pictures),
)


def main() -> int:
    """Measure, print, and compare with the bar; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m texlab_core.figures.defaults", allow_abbrev=False)
    parser.add_argument("--write", type=Path, metavar="HELP_PAGE", help="put the table into the help page")
    args = parser.parse_args()
    rows = measured(homogeneous())
    print(table(rows))
    try:
        if args.write is not None:
            text = read_regular(args.write, MAX_PAGE_BYTES).decode("utf-8")
            written, count = _TABLE.subn(lambda _: f"\n{table(rows)}\n", text)
            if count != 1:
                raise InputError(f"{args.write}: has no place for the table of the defaults.")
            write_whole(args.write, written.encode())
    except (InputError, OSError) as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return 2
    found = shortfalls(rows)
    for sentence in found:
        print(sentence, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
