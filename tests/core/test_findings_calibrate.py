"""Calibration: limits by brute force, textures that are left out, the table and the file that it writes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from texlab_core.files.resources import resource
from texlab_core.findings import calibrate, fitted
from texlab_core.findings.finding import FINDING
from texlab_core.findings.limits import RULES, Fit, Rule, Term
from texlab_core.images.gallery import gallery
from texlab_core.measures.calibrate import Labelled
from texlab_core.measures.registry import find_measure
from texlab_core.measures.subject import Subject

LABELS = Path(__file__).parents[1] / "data/labels"


def labels(shown: list[bool], textures: list[str], method: str = "m") -> list[Labelled]:
    return [
        Labelled(texture, method, "v", 0 if flaw else 3, frozenset({"noise"} if flaw else ()))
        for flaw, texture in zip(shown, textures, strict=True)
    ]


@pytest.mark.parametrize("seed", range(5))
def test_the_limit_sees_most_of_those_that_are_right_often_enough(seed: int) -> None:
    random = np.random.default_rng(seed)
    values = np.round(random.normal(size=60), 1)
    shown = values + random.normal(size=60) > 0.0
    found = calibrate.find_limit(values, shown, 0.8)
    hits = {}
    for cut in np.unique(values):
        spoken = values >= cut
        if shown[spoken].mean() >= 0.8 and shown[spoken].sum() >= calibrate.FEWEST:
            hits[cut] = shown[spoken].sum()
    spoken = values >= found
    assert shown[spoken].mean() >= 0.8
    assert shown[spoken].sum() == max(hits.values())
    assert not np.isclose(values, found).any() or found == values.max()


def test_without_any_right_one_nothing_is_said() -> None:
    assert calibrate.find_limit(np.arange(5.0), np.zeros(5, bool), 0.9) == np.inf
    # Where the aim is out of reach, the limit that is right most often.
    values, shown = np.arange(8.0), np.array([0, 0, 1, 0, 1, 0, 1, 0], bool)
    limit = calibrate.find_limit(values, shown, 0.99)
    assert shown[values >= limit].mean() == pytest.approx(0.5)


def test_weights_point_where_the_flaw_is() -> None:
    random = np.random.default_rng(1)
    columns = random.normal(size=(400, 2)) * [1, 10]
    shown = columns @ [1.0, -0.2] + random.normal(size=400) * 0.3 > 0
    first, second = calibrate.weigh(columns, shown)
    assert first > 0
    assert second / first == pytest.approx(-0.2, rel=0.15)


def test_precision_and_recall_are_those_of_textures_left_out() -> None:
    rule = Rule(name="noise", terms=(Term("specks"),), fit=Fit((1.0,), 0.0), reasons=("noise",), target=0.9)
    textures = [name for name in "abcd" for _ in range(10)]
    shown = [place % 2 == 0 for place in range(40)]
    values = {"specks": np.where(shown, 1.0, 0.0)}
    found = calibrate.fit(rule, values, labels(shown, textures))
    assert (found.precision, found.recall, found.cases, found.positive) == (1.0, 1.0, 40, 20)
    assert found.limit == pytest.approx(0.5)
    # One texture is the other way round: it is judged by the others' limit, and so wrongly.
    values["specks"][30:] = 1 - values["specks"][30:]
    turned = calibrate.fit(rule, values, labels(shown, textures))
    assert turned.recall == pytest.approx(15 / 20)
    assert turned.precision == pytest.approx(15 / 20)


def test_missing_values_never_speak_and_other_methods_are_not_asked() -> None:
    rule = Rule(
        name="noise",
        terms=(Term("specks"), Term("cuts")),
        fit=Fit((1.0, 0.0), 0.0),
        reasons=("noise",),
        judged=("m",),
        quiet=0.5,
    )
    textures = [name for name in "abcd" for _ in range(10)]
    shown = [place % 2 == 0 for place in range(40)]
    values = {"specks": np.where(shown, 1.0, 0.0), "cuts": np.zeros(40)}
    values["specks"][0] = np.nan
    asked = labels(shown, textures)
    other = [Labelled(each.texture, "n", "v", 3, each.reasons) for each in asked]
    both = {name: np.concatenate([each, each]) for name, each in values.items()}
    found = calibrate.fit(rule, both, asked + other)
    assert (found.cases, found.positive) == (40, 20)
    assert found.recall == pytest.approx(19 / 20)


def test_the_numbers_of_the_program_are_written_by_it() -> None:
    fits = {rule.name: rule.fit for rule in RULES if rule.reasons}
    assert Path(fitted.__file__).read_text(encoding="utf-8") == calibrate.source(fits)
    table = calibrate.table(fits)
    assert table.count("\n") == 2 + len(fits)
    rows = [line for line in table.splitlines() if line.endswith("finding |")]
    assert rows == table.splitlines()[2 : 2 + len(rows)]


def test_alarms_are_counted_on_real_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("stochastic-gravel", "quasiperiodic-brick")
    monkeypatch.setattr(calibrate, "gallery", lambda: [each for each in gallery() if each.name in names])
    pairs = list(calibrate.real_pieces())
    assert len(pairs) == 2
    for exemplar, piece in pairs:
        assert exemplar.size == piece.size == (128, 128)
        assert exemplar.sha256 != piece.sha256
    values = calibrate.measure_pieces()
    rule = Rule(name="noise", terms=(Term("specks"),), fit=Fit((1.0,), 0.0), reasons=("noise",))
    wanted = [find_measure("specks").of(Subject.of_images(*pair)) for pair in pairs]
    np.testing.assert_array_equal(values["specks"], wanted)
    between = sum(wanted) / 2
    assert min(wanted) < between < max(wanted)
    found = calibrate.with_alarms(rule, Fit((1.0,), between), values)
    assert (found.pieces, found.alarms) == (2, 1)
    values["specks"][:] = np.nan
    assert calibrate.with_alarms(rule, Fit((1.0,), between), values).alarms == 0


def test_what_is_certain_and_speaks_of_real_pieces_is_for_what_was_labelled_only() -> None:
    for rule in RULES:
        if rule.reasons and rule.certainty == FINDING and rule.fit.alarms > rule.fit.pieces / 10:
            # Either nearly every result of the methods shows it, or the rule is bound to the labelled parameters.
            assert rule.fit.positive / rule.fit.cases > 0.95 or rule.when is not None, rule.name
        assert not rule.reasons or rule.fit.pieces == 56


def test_the_command_measures_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(calibrate, "gallery", lambda: gallery()[:1])
    kept = tmp_path / "values.json"
    assert calibrate.main([str(LABELS), "--values", str(kept)]) == 0
    first = capsys.readouterr().out
    assert first.startswith("| finding |")
    data = json.loads(kept.read_text())
    assert set(data) == set(calibrate.needed())
    assert calibrate.main([str(LABELS), "--values", str(kept)]) == 0
    assert capsys.readouterr().out == first
    kept.write_text(json.dumps({"cuts": [1.0]}))
    assert calibrate.main([str(LABELS), "--values", str(kept)]) == 2
    assert "remove it to measure anew" in capsys.readouterr().err
    assert calibrate.main([str(tmp_path / "none")]) == 2


def test_the_help_shows_the_table() -> None:
    page = resource("help/findings.md").read_text(encoding="utf-8")
    assert calibrate.table({rule.name: rule.fit for rule in RULES if rule.reasons}) in page
