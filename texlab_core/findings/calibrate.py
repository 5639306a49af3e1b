"""Fit the limits of the findings to labels and judge them: ``python -m texlab_core.findings.calibrate LABELS``.

``LABELS`` is a folder as for :mod:`texlab_core.measures.calibrate`. Precision and recall are those on textures
that were left out, one after the other: weights and limit are fitted anew without them each time. Beside them it
says of how many real other pieces of the gallery's textures a rule speaks, with which nothing is wrong.
"""

from __future__ import annotations

import dataclasses
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import Crop
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.whole import write_whole
from texlab_core.findings.finding import FINDING
from texlab_core.findings.limits import RULES, Fit
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.gallery import gallery
from texlab_core.measures.calibrate import GOOD, measure_labels, read_labels
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import Subject

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.findings.limits import Rule
    from texlab_core.measures.calibrate import Labelled

Values = dict[str, "NDArray[np.float64]"]
# Of the labelled exemplars, and what a real piece may share with one at most.
SIDE = 128
MOST_SHARED = 0.25
RIDGE = 1.0
ROUNDS = 12
# A limit that fewer labelled results reach rests on chance.
FEWEST = 3
DIGITS = 5


def needed(rules: Iterable[Rule] = RULES) -> tuple[str, ...]:
    """Return the ids of the measures that the rules with labels rest on."""
    return tuple(dict.fromkeys(term.measure for rule in rules if rule.reasons for term in rule.terms))


def scores(rule: Rule, weights: Sequence[float], values: Values) -> NDArray[np.float64]:
    """Return the weighted sum of every labelled result, NaN where a measure says nothing."""
    return _columns(rule, values) @ np.asarray(weights, np.float64)


def _columns(rule: Rule, values: Values) -> NDArray[np.float64]:
    columns = []
    for term in rule.terms:
        own = values[term.measure]
        columns.append(own if term.log is None else np.log(np.maximum(own, 0) + term.log))
    return np.stack(columns, axis=1)


def weigh(columns: NDArray[np.float64], shown: NDArray[np.bool_]) -> tuple[float, ...]:
    """Return the weights of a logistic regression with a small ridge, (n, terms) float64 against (n,) bool."""
    mean, spread = columns.mean(axis=0), columns.std(axis=0) + 1e-9
    data = np.column_stack([(columns - mean) / spread, np.ones(len(columns))])
    ridge = np.diag([RIDGE] * columns.shape[1] + [1e-6])
    found = np.zeros(data.shape[1])
    for _ in range(ROUNDS):
        chance = 1 / (1 + np.exp(-data @ found))
        weight = chance * (1 - chance) + 1e-6
        found = found + np.linalg.solve(
            (data.T * weight) @ data + ridge, data.T @ (shown - chance) - ridge @ found
        )
    return tuple(float(each) for each in found[:-1] / spread)


def find_limit(values: NDArray[np.float64], shown: NDArray[np.bool_], target: float) -> float:
    """Return the lowest value from which on at least the share ``target`` is right; infinite without any.

    Of the limits that at least three right results reach, the one that sees most; where none is right often
    enough,
    the one that is right most often.
    """
    order = np.argsort(-values, kind="stable")
    ordered = values[order]
    right = np.cumsum(shown[order])
    share = right / np.arange(1, len(order) + 1)
    possible = (
        np.append(ordered[:-1] != ordered[1:], True) & (right >= min(FEWEST, int(shown.sum()))) & (right > 0)
    )
    if not possible.any():
        return float("inf")
    enough = possible & (share >= target)
    places = (
        np.flatnonzero(enough) if enough.any() else np.flatnonzero(possible & (share == share[possible].max()))
    )
    place = int(places[np.argmax(right[places])])
    return float(ordered[place] if place + 1 == len(ordered) else (ordered[place] + ordered[place + 1]) / 2)


def fit(rule: Rule, values: Values, labels: Sequence[Labelled]) -> Fit:
    """Return weights, limit, and what a rule reaches on textures that are left out."""
    asked = np.array([not rule.judged or each.method in rule.judged for each in labels])
    shown = np.array([bool(each.reasons & set(rule.reasons)) for each in labels])
    good = np.array([each.score >= GOOD for each in labels])
    names = np.array([each.texture for each in labels])
    columns = _columns(rule, values)
    known = np.isfinite(columns).all(axis=1)

    def trained(using: NDArray[np.bool_]) -> tuple[tuple[float, ...], float]:
        own = using & asked & known
        weights = (float(rule.terms[0].sign),) if len(rule.terms) == 1 else weigh(columns[own], shown[own])
        found = columns @ np.asarray(weights)
        limit = find_limit(found[own], shown[own], rule.target)
        if rule.quiet is not None:
            limit = max(limit, float(np.quantile(found[using & known & good], rule.quiet)))
        return weights, limit

    spoken = np.zeros(len(labels), bool)
    for name in dict.fromkeys(names):
        out = names == name
        weights, limit = trained(~out)
        with np.errstate(invalid="ignore"):
            spoken[out] = (columns[out] @ np.asarray(weights)) >= limit
    spoken &= asked & known
    weights, limit = trained(np.ones(len(labels), bool))
    right, cases = int((spoken & shown).sum()), asked
    return Fit(
        weights=tuple(_rounded(each) for each in weights),
        limit=_rounded(limit),
        precision=round(right / int(spoken.sum()), 3) if spoken.any() else 0.0,
        recall=round(right / max(1, int((shown & cases).sum())), 3),
        cases=int(cases.sum()),
        positive=int((shown & cases).sum()),
    )


def real_pieces() -> Iterator[tuple[ImageInput, ImageInput]]:
    """Return the central part of each texture of the gallery, as labelled, and the part in its upper left corner.

    Textures where the two would share more than a quarter of their area are left out.
    """
    for each in gallery():
        height, width = as_exemplar(f"gallery:{each.name}").size
        top, left = (height - SIDE) // 2, (width - SIDE) // 2
        shared = max(0, SIDE - top) * max(0, SIDE - left)
        if min(top, left) < 0 or shared > MOST_SHARED * SIDE**2:
            continue
        parts = (Crop(top=down, left=across, height=SIDE, width=SIDE) for down, across in ((top, left), (0, 0)))
        exemplar, piece = (as_exemplar(f"gallery:{each.name}", crop=crop) for crop in parts)
        yield exemplar, piece


def measure_pieces() -> Values:
    """Return the measures of the real pieces as if they were results."""
    rows = [measure_all(Subject.of_images(exemplar, piece), needed()) for exemplar, piece in real_pieces()]
    return {name: np.array([row.get(name, np.nan) for row in rows], np.float64) for name in needed()}


def with_alarms(rule: Rule, found: Fit, pieces: Values) -> Fit:
    """Return a fit with how many real pieces there are, and of how many it speaks."""
    with np.errstate(invalid="ignore"):
        spoken = scores(rule, found.weights, pieces) >= found.limit
    return dataclasses.replace(found, pieces=len(spoken), alarms=int(np.count_nonzero(spoken)))


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def fit_all(
    values: Values, labels: Sequence[Labelled], pieces: Values, rules: Iterable[Rule] = RULES
) -> dict[str, Fit]:
    """Return the fits of all rules that have labels, by name, with their alarms."""
    return {rule.name: with_alarms(rule, fit(rule, values, labels), pieces) for rule in rules if rule.reasons}


def table(fits: Mapping[str, Fit]) -> str:
    """Return precision and recall as a table in Markdown, findings first, then what only says "look at"."""
    lines = [
        "| finding | of methods | labels | precision | recall | real pieces | says |",
        "|---|---|---|---|---|---|---|",
    ]
    rows = []
    for rule in RULES:
        if rule.name in fits:
            fresh = dataclasses.replace(rule, fit=fits[rule.name])
            methods = ", ".join(rule.judged) or "all"
            own = fresh.fit
            rows.append(
                (
                    fresh.certainty != FINDING,
                    f"| {rule.name.partition('.')[0].replace('-', ' ')} | {methods} | {own.positive} of "
                    f"{own.cases} |"
                    f" {own.precision:.2f} | {own.recall:.2f} | {own.alarms} of {own.pieces} |"
                    f" {fresh.certainty} |",
                )
            )
    return "\n".join([*lines, *(text for _, text in sorted(rows, key=lambda row: row[0]))]) + "\n"


def source(fits: Mapping[str, Fit]) -> str:
    """Return the text of ``fitted.py``."""
    lines = [
        '"""What ``python -m texlab_core.findings.calibrate LABELS --write`` found; not to be changed by hand."""',
        "",
        "from __future__ import annotations",
        "",
        "# By rule: weights, limit, precision, recall, labels, of which positive; real pieces, of which alarms.",
        "NUMBERS: dict[str, tuple[tuple[float, ...], float, float, float, int, int, int, int]] = {",
    ]
    for name, each in fits.items():
        weights = f"({', '.join(map(repr, each.weights))}{',' if len(each.weights) == 1 else ''})"
        rest = f"{each.limit!r}, {each.precision!r}, {each.recall!r}, {each.cases}, {each.positive}"
        rest += f", {each.pieces}, {each.alarms}"
        lines.append(f'    "{name}": ({weights}, {rest}),')
    return "\n".join([*lines, "}", ""])


def measured(folder: Path, kept: Path | None, tell: Callable[[int], None] = lambda _: None) -> Values:
    """Return the measures of the labelled results; from the file ``kept`` if it is there, else written to it."""
    labels = read_labels(folder)
    if kept is not None and kept.exists():
        found = strict_json.load(kept, what=f"values: {kept}")
        values = {name: np.array(found[name], np.float64) for name in needed() if name in found}
        if len(values) == len(needed()) and all(len(each) == len(labels) for each in values.values()):
            return values
        raise InputError(
            f"values: {kept} must hold all measures of {len(labels)} results; remove it to measure anew."
        )
    values = measure_labels(folder, labels, needed(), tell)
    if kept is not None:
        lists = {name: [None if np.isnan(x) else float(x) for x in each] for name, each in values.items()}
        write_whole(kept, json.dumps(lists).encode())
    return values


def main(arguments: Sequence[str]) -> int:
    """Print the table; ``--write`` renews the limits of the program."""
    import argparse

    parser = argparse.ArgumentParser(prog="python -m texlab_core.findings.calibrate", description=__doc__)
    parser.add_argument("labels", metavar="LABELS", help="folder with results.tsv and gallery/")
    parser.add_argument("--values", metavar="FILE", help="keep the measured values there, or take them from it")
    parser.add_argument("--write", action="store_true", help="renew texlab_core/findings/fitted.py")
    args = parser.parse_args(arguments)
    try:
        folder = Path(args.labels)
        values = measured(folder, None if args.values is None else Path(args.values))
        fits = fit_all(values, read_labels(folder), measure_pieces())
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    if args.write:
        write_whole(Path(__file__).with_name("fitted.py"), source(fits).encode())
    print(table(fits), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
