"""The pop-out test: design from a seed, pasting, chance and intervals, documents, the machine observer."""

from __future__ import annotations

import csv
import datetime
import io
import math
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.engine.registry import find_method
from texlab_core.errors import Cancelled, InputError
from texlab_core.files import strict_json
from texlab_core.images.exemplar import as_exemplar
from texlab_core.popout.design import (
    Design,
    Setting,
    chance,
    figures,
    least_size,
    paste,
    ramp,
    settings_of,
    usual_size,
)
from texlab_core.popout.making import Made, check_folder, make, picture_of, write_test
from texlab_core.popout.observer import local_difference, observe
from texlab_core.popout.record import COLUMNS, Record, read_answers, read_record, table_of
from texlab_core.popout.scoring import Answer, at_least, wilson
from texlab_core.popout.store import Kept, PopoutStore

if TYPE_CHECKING:
    from pathlib import Path

NOISE = np.random.default_rng(7).random((48, 40, 3), np.float32)


def design(**more: Any) -> Design:
    fields: dict[str, Any] = {"settings": settings_of(["tiling", "pixels"]), "repeats": 3, "size": (96, 100)}
    return Design(**({"exemplar": as_exemplar(NOISE), "seed": 5} | fields | more))


# Design.


def test_the_same_seed_gives_the_same_test_and_further_repeats_leave_it() -> None:
    one, again, other = design(), design(), design(seed=6)
    assert one.trials() == again.trials()
    assert one.trials() != other.trials()

    def drawn(which: Design) -> set[Any]:
        return {replace(each, number=0) for each in which.trials()}

    assert drawn(one) < drawn(design(repeats=4))
    assert [each.number for each in one.trials()] == [1, 2, 3, 4, 5, 6]
    assert sorted(each.setting for each in one.trials()) == [0, 0, 0, 1, 1, 1]


def test_places_are_inside_and_reach_every_end() -> None:
    one = design(repeats=100, share=0.5, size=(60, 61), settings=settings_of(["tiling"]))
    assert one.piece == (24, 20)
    for name, end in (("top", 36), ("left", 41), ("piece_top", 24), ("piece_left", 20)):
        found = [getattr(each, name) for each in one.trials()]
        assert min(found) >= 0
        assert max(found) <= end
        # All places are equally likely: the mean of 100 is within four standard errors of the middle.
        assert abs(np.mean(found) - end / 2) < 4 * (end + 1) / math.sqrt(12 * 100)
    assert len({each.seed for each in one.trials()}) == 100


def test_the_order_is_blind() -> None:
    orders = {tuple(each.setting for each in design(seed=seed).trials()) for seed in range(60)}
    # 6! / (3! 3!) orders are possible; three of one kind in front are as likely as any other.
    assert len(orders) > 15


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"repeats": 0}, "repeats: must be a whole number from 1 to 100, got 0."),
        ({"share": 0.0}, "share: must be a number above 0, at most 1, got 0.0."),
        ({"share": 0.3}, "The piece would have 12 x 14 pixels"),
        ({"feather": 11}, "feather: must be a whole number from 0 to 10, got 11."),
        ({"settings": ()}, "A pop-out test takes 1 to 20 methods, got 0."),
        ({"size": (50, 40)}, "in pictures of 40 x 50 a click in the middle would mostly be right; 48 x 57"),
        ({"share": 1.0, "size": (47, 200)}, "the piece has 40 x 48 pixels"),
        ({"settings": settings_of(["tiling"] * 20), "repeats": 26}, "at most 500 pictures, got 520."),
    ],
)
def test_what_cannot_be_a_test_is_said(more: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as raised:
        design(**more)
    assert words in str(raised.value)


def test_methods_that_make_other_things_are_refused() -> None:
    for name, words in (("solid", "makes solids"), ("mixture", "from the exemplar alone")):
        with pytest.raises(InputError, match=words):
            Setting(method=name, params=find_method(name).params())
    assert Setting(method="msg", params=find_method("msg").params()).name == "MSG"


def test_names_can_be_told_apart() -> None:
    params = find_method("tiling").params()
    named = [Setting(method="tiling", params=params, name=name) for name in ("", "a", "", "a 2", "a")]
    found = design(settings=tuple(named)).settings
    assert [each.name for each in found] == ["Tiling", "a", "Tiling 2", "a 2", "a 3"]


# Chance.


@pytest.mark.parametrize(
    ("size", "piece"), [((9, 7), (3, 2)), ((8, 8), (5, 3)), ((6, 9), (6, 1)), ((5, 5), (1, 5))]
)
def test_chance_is_the_best_click_over_all_places(size: tuple[int, int], piece: tuple[int, int]) -> None:
    covered = np.zeros(size)
    places = list(product(range(size[0] - piece[0] + 1), range(size[1] - piece[1] + 1)))
    for top, left in places:
        covered[top : top + piece[0], left : left + piece[1]] += 1
    assert chance(size, piece) == pytest.approx(covered.max() / len(places), abs=1e-12)


def test_the_least_size_is_the_smallest_that_leaves_guessing_at_a_half() -> None:
    for n in (16, 40, 48, 97):
        rows, columns = least_size((n, n))
        assert chance((rows, columns), (n, n)) <= 0.5
        assert chance((rows - 1, columns - 1), (n, n)) > 0.5
    assert usual_size(as_exemplar(NOISE), 1.0) == (256, 256)
    assert chance((384, 384), (128, 128)) == pytest.approx((128 / 257) ** 2)


# Pasting.


def test_a_hard_edge_changes_the_piece_and_nothing_else() -> None:
    image = np.random.default_rng(1).random((30, 40, 3), np.float32)
    piece = np.random.default_rng(2).random((8, 9, 3), np.float32)
    before = image.copy()
    made = paste(image, piece, 22, 31)
    np.testing.assert_array_equal(made[22:, 31:], piece)
    np.testing.assert_array_equal(image, before)
    changed = (made != image).any(axis=2)
    assert changed[22:, 31:].all()
    assert changed.sum() == 72
    for top, left in ((-1, 0), (23, 0), (0, 32)):
        with pytest.raises(ValueError, match="not inside"):
            paste(image, piece, top, left)


def test_a_feathered_edge_follows_the_raised_cosine() -> None:
    made = paste(np.zeros((20, 20, 1), np.float32), np.ones((10, 12, 1), np.float32), 3, 4, feather=4)[:, :, 0]
    rise = [math.sin(math.pi / 2 * (place + 0.5) / 4) ** 2 for place in range(4)]
    np.testing.assert_allclose(made[8, 4:8], rise, atol=1e-6)
    np.testing.assert_allclose(made[8, 12:16], rise[::-1], atol=1e-6)
    np.testing.assert_allclose(made[3, 4], rise[0] ** 2, atol=1e-6)
    assert (made[7:9, 8:12] == 1).all()
    assert made.sum() == pytest.approx(ramp(10, 4).sum() * ramp(12, 4).sum(), rel=1e-5)
    # The ramp and its mirror image make one: blending a texture with itself changes nothing.
    np.testing.assert_allclose(ramp(100, 4)[:4] + ramp(100, 4)[:4][::-1], 1, atol=1e-12)


def test_gray_and_colour_go_together() -> None:
    gray, colour = np.zeros((6, 6, 1), np.float32), np.ones((2, 2, 3), np.float32)
    assert paste(gray, colour, 1, 1).shape == (6, 6, 3)
    assert paste(np.zeros((6, 6, 3), np.float32), colour[:, :, :1], 1, 1, 1).shape == (6, 6, 3)


# Scoring.


@pytest.mark.parametrize(
    ("hits", "count", "low", "high"),
    # R. G. Newcombe, Statistics in Medicine 17 (1998), table I, method 3.
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_wilsons_interval_as_published(hits: int, count: int, low: float, high: float) -> None:
    assert wilson(hits, count) == pytest.approx((low, high), abs=5e-5)


def test_wilsons_interval_solves_its_equation() -> None:
    z = 1.959963984540054
    for hits, count in ((0, 1), (1, 1), (3, 7), (20, 20), (999, 1000)):
        low, high = wilson(hits, count)
        assert 0 <= low <= hits / count <= high <= 1
        for p in {low, high} - {0.0, 1.0}:
            assert abs(hits / count - p) == pytest.approx(z * math.sqrt(p * (1 - p) / count), abs=1e-12)
    assert wilson(0, 0) == (0.0, 1.0)
    with pytest.raises(ValueError, match="from 0 to 3"):
        wilson(4, 3)


def test_the_luck_of_guessing_is_the_binomial_tail() -> None:
    assert at_least(0, 5, 0.3) == 1
    assert at_least(5, 5, 0.5) == pytest.approx(1 / 32)
    assert at_least(1, 4, 0.25) == pytest.approx(1 - 0.75**4)
    outcomes = product((False, True), repeat=6)
    wanted = math.fsum(0.2 ** sum(each) * 0.8 ** (6 - sum(each)) for each in outcomes if sum(each) >= 3)
    assert at_least(3, 6, 0.2) == pytest.approx(wanted)


# The record.


def answered(record: Record, *, right: int) -> Record:
    """Answer every picture: the first ``right`` of each setting with its piece's last pixel."""
    seen: dict[int, int] = {}
    for each in record.trials:
        place = seen[each.setting] = seen.get(each.setting, 0) + 1
        inside = (each.top + record.piece[0] - 1, each.left + record.piece[1] - 1)
        outside = (each.top + record.piece[0], each.left) if each.top < 72 else (each.top - 1, each.left)
        row, column = inside if place <= right else outside
        record = record.answered(Answer(each.number, row, column, 1.5 * place))
    return record


def test_hits_end_with_the_piece_and_make_the_score() -> None:
    record = answered(Record.of(design()), right=2)
    for found in record.scores():
        assert (found.hits, found.misses, found.untold, found.answers) == (2, 1, 0, 3)
        assert found.share == pytest.approx(2 / 3)
        assert (found.low, found.high) == wilson(2, 3)
        assert found.seconds == 2.25
        assert found.chance == chance((96, 100), (24, 20))
        assert found.luck == at_least(2, 3, found.chance)
        assert found.machine is None
        assert found.verdict == "the piece stands out"
    # Another answer about the same picture takes the place of the first.
    changed = record.answered(Answer(1, None, None, 9.0))
    assert len(changed.answers) == 6
    assert changed.scores()[record.trials[0].setting].untold == 1
    assert [each.verdict for each in Record.of(design()).scores()] == ["no answers"] * 2
    assert math.isnan(Record.of(design()).scores()[0].share)
    assert Record.of(design()).scores()[0].luck == 1
    none = answered(Record.of(design()), right=0)
    assert {each.verdict for each in none.scores()} == {"not told from guessing"}


def test_the_machine_is_judged_by_the_pictures_that_were_answered() -> None:
    record = Record.of(design())
    first, second = record.trials[:2]
    both = record.with_machine(Answer(each.number, each.top, each.left) for each in (first, second))
    assert sum(each.machine or 0 for each in both.scores()) == 0
    seen = both.answered(Answer(first.number, None, None))
    assert seen.scores()[first.setting].machine == 1


def test_documents_come_back_as_they_were(tmp_path: Path) -> None:
    record = answered(Record.of(design()), right=1).with_machine([Answer(2, 3, 4)])
    path = tmp_path / "test.json"
    path.write_text(strict_json.dumps(record.to_json()))
    assert read_record(path).to_json() == record.to_json()
    assert read_record(path).scores() == record.scores()


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda data: data.update(version=2), "version"),
        (lambda data: data.update(more=1), "key: must be one of"),
        (lambda data: data["trials"][1].update(number=1), "number of trial 2: must be a whole number from 2 to 2"),
        (
            lambda data: data["trials"][0].update(top=73),
            "top of trial 1: must be a whole number from 0 to 72, got 73",
        ),
        (lambda data: data["trials"][0].pop("left"), "trial 1: must be an object with number"),
        (lambda data: data["design"].update(piece=[97, 20]), "piece: must fit"),
        (lambda data: data["design"].update(share=True and "x"), "share: must be a number"),
        (lambda data: data["design"].update(settings=[]), "settings: must be a list of 1 to 20"),
        (lambda data: data.update(answers={}), "answers: must be a list"),
        (
            lambda data: data["answers"].append({"trial": 1, "row": 1, "column": 1, "seconds": 1}),
            "1 is answered twice",
        ),
        (lambda data: data["answers"][0].update(row=96), "a row from 0 to 95"),
        (lambda data: data["answers"][0].update(row=None), "both row and column"),
        (lambda data: data["answers"][0].update(seconds=-1), "seconds: must be a number from 0"),
        (lambda data: data["answers"][0].update(trial=7), "trial: must be from 1 to 6, got 7."),
    ],
)
def test_damaged_documents_are_refused_in_one_sentence(tmp_path: Path, damage: Any, words: str) -> None:
    data = answered(Record.of(design()), right=1).to_json()
    data = strict_json.loads(strict_json.dumps(data))
    damage(data)
    path = tmp_path / "test.json"
    path.write_text(strict_json.dumps(data))
    with pytest.raises(InputError) as raised:
        read_record(path)
    assert words in str(raised.value)
    assert "\n" not in str(raised.value)


def test_the_table_has_a_line_for_each_picture() -> None:
    record = answered(Record.of(design()), right=1).with_machine([Answer(1, 0, 0)])
    rows = list(csv.DictReader(io.StringIO(table_of([("first", record)]))))
    assert tuple(rows[0]) == COLUMNS
    assert [row["trial"] for row in rows] == ["1", "2", "3", "4", "5", "6"]
    for row, trial in zip(rows, record.trials, strict=True):
        assert (int(row["top"]), int(row["left"])) == (trial.top, trial.left)
        row_hit = trial.top <= int(row["answer_row"]) < trial.top + int(row["piece_height"])
        column_hit = trial.left <= int(row["answer_column"]) < trial.left + int(row["piece_width"])
        assert row["hit"] == str(int(row_hit and column_hit))
    assert [row["machine_row"] for row in rows[:2]] == ["0", ""]
    # A name from a file is no formula.
    named = design(settings=(Setting(method="tiling", params=find_method("tiling").params(), name="=1+1"),))
    assert next(csv.DictReader(io.StringIO(table_of([("", Record.of(named))]))))["method"] == "'=1+1"


def test_tests_are_kept_under_their_time_and_read_in_its_order(tmp_path: Path) -> None:
    store = PopoutStore(tmp_path / "kept")
    assert store.all() == Kept()
    now = datetime.datetime(2026, 1, 2, 3, 4, 5)
    record = Record.of(design())
    names = []
    for right in (0, 1, 2):
        names.append(store.new_name(now))
        store.save(names[-1], answered(record, right=right))
    assert names == ["2026-01-02-030405", "2026-01-02-030405-2", "2026-01-02-030405-3"]
    store.save(names[0], answered(record, right=3))
    (store.folder / "broken.json").write_text("{")
    kept = store.all()
    assert [name for name, _ in kept.records] == sorted(names)
    assert [each.scores()[0].hits for _, each in kept.records] == [3, 1, 2]
    assert len(kept.problems) == 1
    assert "broken.json" in kept.problems[0]
    with pytest.raises(InputError, match="letters, digits and hyphens"):
        store.save("../up", record)
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be made"):
        PopoutStore(tmp_path / "file").save("a", record)


def test_answers_are_read_from_tables(tmp_path: Path) -> None:
    path = tmp_path / "answers.csv"
    path.write_text("trial,row,column,seconds,who\n1,5,6,2.5,me\n2,,,3,me\n3,,,,me\n4,7,8,,me\n")
    assert read_answers(path) == (Answer(1, 5, 6, 2.5), Answer(2, None, None, 3.0), Answer(4, 7, 8, None))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "must have the columns"),
        ("trial,row\n1,2\n", "column is missing"),
        ("trial,row,column\nx,1,2\n", "line 2: trial must be a whole number"),
        ("trial,row,column\n,1,2\n", "line 2: trial must be a whole number from 0, got ''"),
        ("trial,row,column\n1,1.5,2\n", "line 2: row must be a whole number"),
        ("trial,row,column\n1,1,\n", "must have both row and column"),
        ("trial,row,column,seconds\n1,1,2,nan\n", "seconds must be a number from 0, got 'nan'"),
        ('trial,row,column\n"1,1,2\n', "no table of comma-separated values"),
    ],
)
def test_tables_that_are_none_are_refused(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "answers.csv"
    path.write_text(text)
    with pytest.raises(InputError) as raised:
        read_answers(path)
    assert words in str(raised.value)


# Making.


def test_a_picture_is_the_methods_result_with_the_piece_in_it() -> None:
    one = design(repeats=1, settings=settings_of(["tiling"]))
    (trial,) = one.trials()
    picture = picture_of(one, trial)
    whole = np.tile(NOISE, (3, 3, 1))[:96, :100]
    inside = np.zeros((96, 100), bool)
    inside[trial.top : trial.top + 24, trial.left : trial.left + 20] = True
    np.testing.assert_array_equal(picture[~inside], whole[~inside])
    piece = NOISE[trial.piece_top : trial.piece_top + 24, trial.piece_left : trial.piece_left + 20]
    np.testing.assert_array_equal(picture[inside].reshape(piece.shape), piece)


def test_a_test_is_written_whole_and_its_pictures_tell_nothing(tmp_path: Path) -> None:
    shares: list[float] = []
    made = make(design(), on_progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1
    names = write_test(made, tmp_path / "test")
    assert names[:2] == ("001.png", "002.png")
    data = (tmp_path / "test" / "001.png").read_bytes()
    kinds = {data[place : place + 4] for place in _chunks(data)}
    assert kinds == {b"IHDR", b"sRGB", b"IDAT", b"IEND"}
    np.testing.assert_array_equal(
        np.rint(as_exemplar(tmp_path / "test" / "002.png").pixels * 255), made.pictures[1]
    )
    key = read_record(tmp_path / "test" / "key.json")
    assert key.trials == design().trials()
    assert read_answers(tmp_path / "test" / "answers.csv") == ()
    with pytest.raises(InputError, match="there are files in it"):
        write_test(made, tmp_path / "test")


def _chunks(data: bytes) -> list[int]:
    places, place = [], 8
    while place < len(data):
        places.append(place + 4)
        place += 12 + int.from_bytes(data[place : place + 4], "big")
    return places


def test_folders_that_cannot_be_used(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for out, words in (("", "is empty"), (tmp_path / "file", "it is a file"), (tmp_path / "a" / "b", "not exist")):
        with pytest.raises(InputError, match=words):
            check_folder(out)
    assert check_folder(tmp_path / "new") == tmp_path / "new"


def test_making_stops_at_any_question() -> None:
    asked = 0

    def stop() -> bool:
        nonlocal asked
        asked += 1
        return asked == 20

    with pytest.raises(Cancelled):
        make(design(), should_stop=stop)
    assert asked == 20


# The machine observer.


def striped(size: int, *, across: bool = False) -> np.ndarray:
    rng = np.random.default_rng(3)
    wave = np.sin(np.arange(size) * 2 * np.pi / 6)
    plane = np.tile(wave if across else wave[:, None], (size, 1) if across else (1, size))
    return np.clip(0.5 + 0.3 * plane + 0.05 * rng.standard_normal((size, size)), 0, 1)[:, :, None].astype(
        np.float32
    )


@pytest.mark.parametrize(("top", "left"), [(0, 0), (37, 90), (128, 128)])
def test_the_machine_finds_what_is_different(top: int, left: int) -> None:
    image = paste(striped(192), striped(192, across=True)[:64, :64], top, left)
    row, column = observe(image, (64, 64))
    assert abs(row - (top + 32)) <= 12
    assert abs(column - (left + 32)) <= 12


def test_the_machine_cannot_find_what_is_the_same() -> None:
    image = np.random.default_rng(4).random((160, 160, 1), np.float32)
    values = local_difference(image, (48, 48))[0]
    pasted = local_difference(
        paste(image, np.random.default_rng(5).random((48, 48, 1), np.float32), 60, 60), (48, 48)
    )[0]
    # A piece of the same noise raises no window above what chance gives elsewhere.
    assert pasted.max() < values.max() + values.std()


def test_the_machine_says_nothing_where_there_is_no_room() -> None:
    image = np.zeros((80, 200, 1), np.float32)
    assert observe(image, (32, 32)) is None
    assert observe(image, (60, 60)) is None
    assert observe(image, (48, 48)) is not None


def test_figures_2_to_5_of_the_paper() -> None:
    test = figures(seed=1)
    assert [each.name.partition(":")[0] for each in test.settings] == ["Fig. 2", "Fig. 3", "Fig. 4", "Fig. 5"]
    assert (test.piece, test.size) == (test.exemplar.size, (288, 288))
    made = make(test)
    assert isinstance(made, Made)
    hits = {made.record.trials[each.trial - 1].setting: made.record.hit(each) for each in made.record.machine}
    # As the paper says: the original is easily located, except in what its own method made.
    assert hits == {0: True, 1: True, 2: True, 3: False}
