"""Calibration: its numbers by hand, cuts without the texture they judge, the right order on labelled results."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from texlab_core.errors import InputError
from texlab_core.measures import calibrate
from texlab_core.measures.discriminability import SCALE, SHRINKAGE
from texlab_core.measures.limits import LIMITS, Limit
from texlab_core.measures.registry import find_measure

LABELS = Path(__file__).parents[1] / "data" / "labels"


def test_auc_is_the_share_of_pairs_in_order() -> None:
    rng = np.random.default_rng(0)
    values = rng.integers(0, 6, 40).astype(float)
    hits = rng.random(40) < 0.4
    pairs = [(a > b) + (a == b) / 2 for a in values[hits] for b in values[~hits]]
    assert calibrate.auc(values, hits) == pytest.approx(np.mean(pairs))
    assert math.isnan(calibrate.auc(values, np.ones(40, bool)))
    with_gap = np.append(values, np.nan)
    assert calibrate.auc(with_gap, np.append(hits, True)) == calibrate.auc(values, hits)


def test_the_best_cut_makes_the_fewest_mistakes() -> None:
    rng = np.random.default_rng(1)
    values = rng.random(30)
    good = values + 0.3 * rng.standard_normal(30) < 0.5
    cut = calibrate.best_cut(values, good)
    right = np.count_nonzero((values <= cut) == good)
    assert right == max(np.count_nonzero((values <= each) == good) for each in [-1.0, *values])
    assert calibrate.best_cut(values, np.zeros(30, bool)) < values.min()
    assert calibrate.best_cut(values, np.ones(30, bool)) == values.max()


def test_a_texture_is_judged_by_the_others() -> None:
    # Good below 1 in a and b; in c everything is shifted, and the others' cut misses its good one.
    values = np.array([0.0, 2.0, 0.0, 2.0, 5.0, 9.0])
    good = np.array([True, False, True, False, True, False])
    textures = ["a", "a", "b", "b", "c", "c"]
    assert calibrate.accuracy_left_out(values, good, textures) == pytest.approx(5 / 6)
    assert calibrate.within_textures(values, good, textures) == 1
    assert math.isnan(calibrate.within_textures(values, np.ones(6, bool), textures))


def test_labelled_results_come_in_the_right_order() -> None:
    labels = calibrate.read_labels(LABELS)
    assert len(labels) == 9
    good = np.array([each.score >= calibrate.GOOD for each in labels])
    assert 0 < good.sum() < 9
    found = calibrate.measure_labels(LABELS, labels, ["discriminability", "visual-difference", "laid-down-share"])
    assert calibrate.auc(-found["discriminability"], good) > 0.85
    method = np.array([each.method for each in labels])
    # De Bonet's first defaults lay the exemplar down; Heeger and Bergen's method never does.
    laid = found["laid-down-share"]
    assert laid[method == "de-bonet"].min() > 0.6 > 0.4 > laid[method == "heeger-bergen"].max()
    seen = found["visual-difference"]
    assert seen[method == "de-bonet"].max() < seen[method == "heeger-bergen"].min()


def test_what_the_observer_was_unsure_of_is_told_apart(tmp_path: Path) -> None:
    notes = ("", "borderline 2/1", "halo; borderline 1/2", "borderline 3/2", "borderline 0/1", "border cut")
    rows = ["texture\tmethod\tparameters\tscore\treasons\tnote"]
    rows += [f"{'ab'[place > 3]}\tmsg\t\t{1 + place % 2}\t\t{note}" for place, note in enumerate(notes)]
    (tmp_path / "results.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    labels = calibrate.read_labels(tmp_path)
    assert [each.borderline for each in labels] == [False, True, True, False, False, False]
    good = np.array([each.score >= calibrate.GOOD for each in labels])
    # Wrong in the two unsure ones only.
    values = np.array([3.0, 4.0, 0.0, 1.0, 3.5, 1.5])
    said = calibrate._without_borderline(labels, values, good)
    assert said.startswith("| D without 2 results that are borderline | 1.000 | 1.000 |")
    assert calibrate.auc(-values, good) < 1


def test_d_with_its_own_constant_is_the_measures_but_for_the_scale() -> None:
    labels = calibrate.read_labels(LABELS)[:4]
    ids = ("discriminability", "magnitude-difference", "block-distance")
    values = calibrate.measure_labels(LABELS, labels, ids)
    found = calibrate.measure_diagonals(LABELS, labels)
    assert found.shape == (len(calibrate.DIAGONALS), 4)
    own = found[calibrate.DIAGONALS.index(SHRINKAGE[2])]
    b = np.exp((own - np.log(values["magnitude-difference"] + 0.001)) / 2) - 0.05
    np.testing.assert_allclose(b * SCALE, values["block-distance"], rtol=1e-6)
    # A smaller constant makes distances larger: less is added to the covariance.
    assert (np.diff(found, axis=0) < 0).all()


def test_the_table_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert calibrate.main([str(LABELS), "--out", str(tmp_path / "table.md")]) == 0
    text = (tmp_path / "table.md").read_text(encoding="utf-8")
    assert text.startswith("9 results on 3 textures, ")
    for name in (*calibrate.BY_SCORE, *calibrate.BY_EXEMPLAR):
        assert f"({name}) |" in text
    assert calibrate.main([str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith("labels: ")
    (tmp_path / "results.tsv").write_text("texture\tmethod\na\tb\n", encoding="utf-8")
    with pytest.raises(InputError, match="parameters is missing"):
        calibrate.read_labels(tmp_path)


@pytest.mark.parametrize("limit", LIMITS.values(), ids=lambda limit: limit.measure)
def test_limits_are_of_registered_measures_and_in_their_range(limit: Limit) -> None:
    measure = find_measure(limit.measure)
    assert measure.low < limit.good <= limit.bad < measure.high
    assert limit.zone(limit.good) == "good"
    assert limit.zone(limit.bad) == "bad"
    assert limit.zone((limit.good + limit.bad) / 2) == limit.zone(math.nan) == "unsure"
    assert limit.evidence.endswith(".")


def test_a_limit_may_be_a_lower_one() -> None:
    limit = Limit("visual-difference", 0.5, 0.2, "None.")
    assert [limit.zone(value) for value in (0.9, 0.5, 0.3, 0.2, 0.0)] == ["good", "good", "unsure", "bad", "bad"]
