"""How well the measures tell what an observer sees: ``python -m texlab_core.measures.calibrate LABELS``.

``LABELS`` holds ``results.tsv`` (texture, method, parameters, score, reasons, note), ``exemplars.tsv`` (texture,
kinds), ``gallery/TEXTURE.VARIANT.webp`` and ``gallery/TEXTURE.exemplar.webp``. Nothing is fitted to a texture that
is judged: cuts are chosen on all other textures (leave one texture out).
"""

from __future__ import annotations

import csv
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.discriminability import (
    SHRINKAGE,
    joined,
    looks,
    magnitude_difference,
    nearest_blocks,
    prepared_looks,
)
from texlab_core.measures.registry import find_measure, measure_all
from texlab_core.measures.subject import PreparedCache, Subject
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput

GOOD = 2
# In the note on a result that the observer could as well have called good, or not.
BORDERLINE = re.compile(r"borderline (2/1|1/2)\b")
# What is judged by the score, and what by a reason within the methods that show it.
BY_SCORE = (
    "discriminability",
    "magnitude-difference",
    "block-distance",
    "spectral-distance",
    "spectral-variation",
    "w1-pixels",
    "w1-bands",
    "dependence-difference",
    "block-distance-back",
)
_ALL = ("heeger-bergen", "de-bonet", "msg", "efros-leung")
BY_REASON = (
    ("block-distance-back", "structure-lost", _ALL, 1),
    ("block-distance-back", "verbatim", ("de-bonet", "efros-leung"), -1),
    ("block-distance-back", "noise", ("de-bonet",), 1),
    ("cuts", "straight-cuts", ("de-bonet",), 1),
    ("cuts-at-sides", "straight-cuts", ("de-bonet",), 1),
    ("palette-distance", "colours-invented", ("heeger-bergen",), 1),
    ("exemplar-drift", "blotchy", ("heeger-bergen",), 1),
    ("odd-blocks", "garbage", ("efros-leung",), 1),
    ("w1-pixels", "colours-invented", ("heeger-bergen",), 1),
    ("patches-copied", "verbatim", ("de-bonet", "efros-leung"), 1),
    ("laid-down-share", "repetition", ("de-bonet", "efros-leung"), 1),
    ("visual-difference", "verbatim", ("de-bonet", "efros-leung"), -1),
)
# Constants on the diagonal of D's covariance that its own is compared with.
DIAGONALS = (0.001, 0.003, SHRINKAGE[2], 0.03)
BY_EXEMPLAR = ("exemplar-drift", "exemplar-unevenness")


@dataclass(frozen=True)
class Labelled:
    """One result that was looked at."""

    texture: str
    method: str
    variant: str
    score: int
    reasons: frozenset[str]
    borderline: bool = False


def read_labels(folder: Path) -> list[Labelled]:
    """Return the labels; raises ``InputError`` when the table is missing or not as described."""
    found = []
    for row in _rows(folder / "results.tsv", ("texture", "method", "parameters", "score", "reasons", "note")):
        name, _, value = row["parameters"].partition("=")
        short = {"alpha": value.partition(".")[2], "tau": f"tau{value}", "window": f"w{value}"}.get(name, "")
        variant = f"{row['method']}-{short}" if short else row["method"]
        reasons = frozenset(filter(None, row["reasons"].split(",")))
        borderline = BORDERLINE.search(row["note"]) is not None
        found.append(Labelled(row["texture"], row["method"], variant, int(row["score"]), reasons, borderline))
    return found


def _rows(path: Path, fields: Iterable[str]) -> list[dict[str, str]]:
    try:
        with path.open(encoding="utf-8", newline="") as stream:
            rows = list(csv.DictReader(stream, delimiter="\t"))
    except OSError as error:
        raise InputError(f"labels: {path} cannot be read ({error.strerror}).") from error
    missing = [each for each in fields if not rows or each not in rows[0]]
    if missing:
        raise InputError(f"labels: {path} must have the columns {', '.join(fields)}; {missing[0]} is missing.")
    return rows


def measure_labels(
    folder: Path, labels: Sequence[Labelled], ids: Iterable[str], tell: Callable[[int], None] = lambda _: None
) -> dict[str, NDArray[np.float64]]:
    """Return each measure of each labelled result, NaN where it says nothing."""
    wanted = list(ids)
    values = {each: np.full(len(labels), np.nan) for each in wanted}
    cache = PreparedCache()
    exemplars: dict[str, ImageInput] = {}
    for place, label in enumerate(labels):
        if label.texture not in exemplars:
            exemplars = {label.texture: as_exemplar(folder / "gallery" / f"{label.texture}.exemplar.webp")}
        exemplar = exemplars[label.texture]
        image = as_exemplar(folder / "gallery" / f"{label.texture}.{label.variant}.webp").pixels
        for name, value in measure_all(Subject(image=image, exemplar=exemplar, cache=cache), wanted).items():
            values[name][place] = value
        tell(place + 1)
    return values


def measure_diagonals(folder: Path, labels: Sequence[Labelled]) -> NDArray[np.float64]:
    """Return D of each labelled result for each of :data:`DIAGONALS`, (constants, n), without its usual scale."""
    found = np.full((len(DIAGONALS), len(labels)), np.nan)
    texture, prepared = "", []
    cache = PreparedCache()
    for place, label in enumerate(labels):
        if label.texture != texture:
            texture = label.texture
            exemplar = as_exemplar(folder / "gallery" / f"{texture}.exemplar.webp")
            own = looks(exemplar.pixels, go_on)
            prepared = [prepared_looks(own, (*SHRINKAGE[:2], each), 1.0) for each in DIAGONALS]
        image = as_exemplar(folder / "gallery" / f"{texture}.{label.variant}.webp").pixels
        m = magnitude_difference(Subject(image=image, exemplar=exemplar, cache=cache))
        blocks = looks(image, go_on).blocks
        for row, each in enumerate(prepared):
            if m is not None:
                found[row, place] = joined(m, float(nearest_blocks(blocks, each).mean()))
    return found


def auc(values: NDArray[np.float64], positive: NDArray[np.bool_]) -> float:
    """Return the chance that a positive case has the larger value than a negative one (ties count half)."""
    from scipy.stats import rankdata

    known = np.isfinite(values)
    ranks = rankdata(values[known])
    hits = positive[known]
    count, others = int(hits.sum()), int((~hits).sum())
    if not count or not others:
        return float("nan")
    return float((ranks[hits].sum() - count * (count + 1) / 2) / (count * others))


def best_cut(values: NDArray[np.float64], good: NDArray[np.bool_]) -> float:
    """Return the value at or below which results are to be called good, for the fewest mistakes."""
    order = np.argsort(values, kind="stable")
    right = np.concatenate([[0], np.cumsum(np.where(good[order], 1, -1))])
    place = int(right.argmax())
    ordered = values[order]
    if place == 0:
        return float(ordered[0]) - 1.0
    return float(ordered[place - 1] if place == len(ordered) else (ordered[place - 1] + ordered[place]) / 2)


def accuracy_left_out(values: NDArray[np.float64], good: NDArray[np.bool_], textures: Sequence[str]) -> float:
    """Return the share that a single cut judges rightly, chosen each time on all other textures."""
    names = np.asarray(textures)
    right = 0
    for texture in dict.fromkeys(textures):
        own = names == texture
        cut = best_cut(values[~own], good[~own])
        right += int(np.count_nonzero((values[own] <= cut) == good[own]))
    return right / len(names)


def within_textures(values: NDArray[np.float64], good: NDArray[np.bool_], textures: Sequence[str]) -> float:
    """Return how often a good result has the smaller value than one that is not, of the same texture."""
    names = np.asarray(textures)
    found = pairs = 0.0
    for texture in dict.fromkeys(textures):
        own = names == texture
        first, second = values[own & good][:, None], values[own & ~good][None]
        found += float(np.count_nonzero(first < second)) + float(np.count_nonzero(first == second)) / 2
        pairs += first.size * second.size
    return found / pairs if pairs else float("nan")


def table(folder: Path, tell: Callable[[int], None] = lambda _: None) -> str:
    """Return everything as tables in Markdown, as the help shows them."""
    labels = read_labels(folder)
    ids = dict.fromkeys((*BY_SCORE, *(each[0] for each in BY_REASON)))
    values = measure_labels(folder, labels, ids, tell)
    good = np.array([each.score >= GOOD for each in labels])
    textures = [each.texture for each in labels]
    lines = [
        f"{len(labels)} results on {len(set(textures))} textures, {int(good.sum())} of them good (score 2 or 3).",
        "",
        "| measure | AUC | within one texture | one cut, right |",
        "|---|---|---|---|",
    ]
    for name in BY_SCORE:
        numbers = auc(-values[name], good), within_textures(values[name], good, textures)
        right = accuracy_left_out(values[name], good, textures)
        lines.append(f"| {_title(name)} | {numbers[0]:.3f} | {numbers[1]:.3f} | {right:.0%} |")
        if name == "discriminability":
            lines.append(_without_borderline(labels, values[name], good))
    lines += [
        "",
        "| D with this on the diagonal | AUC | within one texture | one cut, right |",
        "|---|---|---|---|",
    ]
    for constant, found in zip(DIAGONALS, measure_diagonals(folder, labels), strict=True):
        numbers = auc(-found, good), within_textures(found, good, textures)
        right = accuracy_left_out(found, good, textures)
        used = " (used)" if constant == SHRINKAGE[2] else ""
        lines.append(f"| {constant:g}{used} | {numbers[0]:.3f} | {numbers[1]:.3f} | {right:.0%} |")
    lines += ["", "| measure | tells | of methods | AUC |", "|---|---|---|---|"]
    for name, reason, chosen, sign in BY_REASON:
        within = np.array([each.method in chosen for each in labels])
        hits = np.array([reason in each.reasons for each in labels])
        told = auc(sign * values[name][within], hits[within])
        of = "all" if chosen == _ALL else ", ".join(chosen)
        lines.append(f"| {_title(name)} | {reason.replace('-', ' ')} | {of} | {told:.2f} |")
    return "\n".join([*lines, "", *_exemplars(folder, textures)]) + "\n"


def _without_borderline(labels: Sequence[Labelled], values: NDArray[np.float64], good: NDArray[np.bool_]) -> str:
    """Return the row of a measure over the labels of which the observer was sure."""
    sure = np.array([not each.borderline for each in labels])
    textures = [each.texture for each in labels if not each.borderline]
    numbers = auc(-values[sure], good[sure]), within_textures(values[sure], good[sure], textures)
    right = accuracy_left_out(values[sure], good[sure], textures)
    count = len(labels) - len(textures)
    return f"| D without {count} results that are borderline | {numbers[0]:.3f} | {numbers[1]:.3f} | {right:.0%} |"


def _exemplars(folder: Path, textures: Sequence[str]) -> list[str]:
    rows = _rows(folder / "exemplars.tsv", ("texture", "kinds"))
    kinds = {row["texture"]: row["kinds"].split(",") for row in rows}
    names = [each for each in dict.fromkeys(textures) if each in kinds]
    uneven = np.array(["inhomogeneous" in kinds[each] for each in names])
    lines = ["| measure | tells | AUC |", "|---|---|---|"]
    for measure in BY_EXEMPLAR:
        found = []
        for name in names:
            exemplar = as_exemplar(folder / "gallery" / f"{name}.exemplar.webp")
            value = find_measure(measure).of(Subject(image=exemplar.pixels, exemplar=exemplar))
            found.append(np.nan if value is None else value)
        lines.append(f"| {_title(measure)} | inhomogeneous exemplar | {auc(np.array(found), uneven):.2f} |")
    return lines


def _title(name: str) -> str:
    return f"{find_measure(name).title} ({name})"


def main(arguments: Sequence[str]) -> int:
    """Print the table, or write it to ``--out``."""
    import argparse

    from texlab_core.files.whole import write_whole

    parser = argparse.ArgumentParser(prog="python -m texlab_core.measures.calibrate", description=__doc__)
    parser.add_argument("labels", metavar="LABELS", help="folder with results.tsv, exemplars.tsv and gallery/")
    parser.add_argument("--out", metavar="FILE", help="write the tables there (default: standard output)")
    args = parser.parse_args(arguments)
    try:
        text = table(Path(args.labels))
        if args.out is None:
            print(text, end="")
        else:
            write_whole(args.out, text.encode())
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
