"""The session, what differs between two of its states, and what changes make of it; without a window."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from texlab.runs.drafts import SMALLEST_DRAFT, draft_size
from texlab.state.changes import fitting, fresh_ids, rescaled, sample_of, with_code, with_crop_of
from texlab.state.chosen import Column, Sample, State
from texlab.state.difference import difference
from texlab.state.session import MAX_HISTORY, Session
from texlab_core.engine.inputs import Crop, DataInput, ImageInput, hash_arrays
from texlab_core.engine.registry import methods

HB, MSG = methods()["heeger-bergen"], methods()["msg"]
CROP = Crop(3, 5, 16, 24)


def image(height: int = 32, width: int = 48, name: str = "gallery:one", seed: int = 0) -> ImageInput:
    pixels = np.random.default_rng(seed).random((height, width, 3), np.float32)
    return ImageInput(pixels, name, hash_arrays({"pixels": pixels}))


@pytest.fixture
def session(qapp: Any) -> Session:
    made = Session()
    columns = tuple(Column(number, "heeger-bergen", HB.params()) for number in (1, 2, 3))
    made.apply(State(Sample(image()), columns, 5, (24, 32), 4), "start")
    made.select(2)
    made.reset_history()
    return made


def ids(session: Session) -> list[int]:
    return [column.id for column in session.state.columns]


# The session.


def test_every_change_of_the_history_is_told(session: Session) -> None:
    told: list[tuple[Any, Any]] = []
    session.history_changed.connect(lambda: told.append((session.undo_text, session.redo_text)))
    session.set_seed(7)
    session.undo()
    session.redo()
    session.reset_history()
    assert told == [("seed 7", None), (None, "seed 7"), ("seed 7", None), (None, None)]


def test_a_drag_is_one_step_until_it_ends(session: Session) -> None:
    changes: list[tuple[int, int]] = []
    session.changed.connect(lambda before, after: changes.append((before.seed, after.seed)))
    for seed in (6, 7, 8):
        session.set_seed(seed, merge="drag")
    session.finish_merge()
    session.set_seed(9, merge="drag")
    assert changes == [(5, 6), (6, 7), (7, 8), (8, 9)]
    session.undo()
    assert session.state.seed == 8
    session.undo()
    assert session.state.seed == 5
    # The step that was taken back is not what another drag goes on with.
    session.redo()
    session.redo()
    session.set_seed(10, merge="drag")
    session.undo()
    assert session.state.seed == 9


def test_a_drag_of_another_thing_does_not_end_this_one(session: Session) -> None:
    session.set_seed(6, merge="seed")
    session.finish_merge("size")
    session.set_seed(7, merge="seed")
    session.undo()
    assert session.state.seed == 5


def test_what_changes_nothing_is_no_step(session: Session) -> None:
    session.set_seed(5)
    session.remove_column(99)
    session.move_column(1, -1)
    assert session.undo_text is None


def test_the_history_has_an_end(session: Session) -> None:
    for seed in range(MAX_HISTORY + 50):
        session.set_seed(seed + 100)
    steps = 0
    while session.undo_text is not None:
        session.undo()
        steps += 1
    assert steps == MAX_HISTORY - 1


def test_the_neighbour_is_chosen_when_a_column_goes(session: Session) -> None:
    chosen: list[int] = []
    session.selected.connect(chosen.append)
    session.remove_column(2)
    assert (ids(session), session.selected_id, chosen) == ([1, 3], 3, [3])
    session.remove_column(3)
    session.remove_column(1)
    assert (session.selected_id, session.selected_column) == (0, None)


def test_columns_are_copied_and_moved(session: Session) -> None:
    assert session.duplicate_column(1) == 4
    assert ids(session) == [1, 4, 2, 3]
    session.move_column(1, 2)
    assert ids(session) == [4, 2, 1, 3]
    session.move_column(3, -9)
    assert ids(session) == [3, 4, 2, 1]
    assert session.add_column("msg", MSG.params(), after=4) == 5
    assert ids(session) == [3, 4, 5, 2, 1]
    assert session.duplicate_column(77) == 0


def test_another_method_comes_without_the_inputs_of_the_one_before(session: Session) -> None:
    code = (("code", DataInput({}, "code")),)
    session.set_method(1, "msg", MSG.params())
    session.set_inputs(1, code, "code")
    session.set_method(1, "heeger-bergen", HB.params())
    assert session.state.column(1) == Column(1, "heeger-bergen", HB.params())
    assert session.undo_text == "method heeger-bergen"


def test_seeds_stay_in_their_range(session: Session) -> None:
    session.set_seed(-4)
    assert session.state.seed == 0
    session.set_seed(2**40)
    assert session.state.seed == 2**31 - 1


# The difference of two states.


def states() -> tuple[State, State]:
    columns = tuple(Column(number, "heeger-bergen", HB.params()) for number in (1, 2, 3))
    before = State(Sample(image()), columns, 5, (24, 32), 4)
    return before, before


@pytest.mark.parametrize("change", [{"seed": 6}, {"size": (24, 33)}])
def test_seed_and_size_concern_every_column(change: dict[str, Any]) -> None:
    before, _ = states()
    found = difference(before, dataclasses.replace(before, **change))
    assert (found.sample, found.added, found.removed, found.run) == (False, (), (), (1, 2, 3))


def test_parameters_and_inputs_concern_their_column() -> None:
    before, _ = states()
    second = before.columns[1]
    for changed in (
        dataclasses.replace(second, params=HB.params(iterations=3)),
        dataclasses.replace(second, inputs=(("mask", image()),)),
        dataclasses.replace(second, size=(8, 8)),
    ):
        assert difference(before, before.with_column(changed)).run == (2,)


def test_columns_come_go_and_change_places() -> None:
    before, _ = states()
    first, second, third = before.columns
    fourth = Column(4, "msg", MSG.params())
    found = difference(before, dataclasses.replace(before, columns=(fourth, third, first)))
    assert (found.added, found.removed, found.run) == ((4,), (2,), (4,))
    moved = difference(before, dataclasses.replace(before, columns=(third, second, first)))
    assert (moved.added, moved.removed, moved.run) == ((), (), ())


def test_the_sample_is_another_one_when_its_pixels_are() -> None:
    before, _ = states()
    assert before.sample is not None
    same = Sample(image(name="another name"))
    assert not difference(before, dataclasses.replace(before, sample=same)).sample
    for other in (
        None,
        Sample(image(seed=1)),
        dataclasses.replace(before.sample, scale=0.5),
        dataclasses.replace(before.sample, crop=CROP),
    ):
        assert difference(before, dataclasses.replace(before, sample=other)).sample


# What opening and choosing make of it.


@pytest.mark.parametrize(
    ("size", "scale"), [((256, 256), 1.0), ((257, 100), 0.996), ((1024, 640), 0.25), ((90, 2560), 0.1)]
)
def test_a_photograph_is_reduced_to_a_comfortable_size(size: tuple[int, int], scale: float) -> None:
    sample = sample_of(image(*size, name="photo.png"), "photo.png")
    assert (sample.scale, sample.crop, sample.path) == (scale, None, "photo.png")
    assert sample.source.size == size


def test_the_crop_is_kept_from_one_texture_of_the_gallery_to_the_next() -> None:
    one, two = Sample(image(), crop=CROP), Sample(image(name="gallery:two"))
    assert with_crop_of(two, one).crop == CROP
    # Not where the crop would not fit, another scale is used, or one of them is a file.
    for sample, before in (
        (Sample(image(18, 48, name="gallery:two")), one),
        (Sample(image(32, 28, name="gallery:two")), one),
        (dataclasses.replace(two, scale=0.5), one),
        (Sample(image(name="mine.png")), one),
        (two, Sample(image(name="mine.png"), crop=CROP)),
        (two, None),
    ):
        assert with_crop_of(sample, before).crop is None
    exactly = Sample(image(19, 29, name="gallery:two"))
    assert with_crop_of(exactly, one).crop == CROP


def test_the_crop_stays_over_the_same_part_at_another_scale() -> None:
    sample = rescaled(Sample(image(100, 200), 1.0, Crop(20, 60, 40, 80)), 0.5)
    assert (sample.scale, sample.crop) == (0.5, Crop(10, 30, 20, 40))
    assert rescaled(Sample(image(100, 200), 1.0, Crop(60, 120, 40, 80)), 0.03).crop == Crop(1, 4, 2, 2)


def test_a_crop_that_does_not_fit_any_more_is_dropped() -> None:
    for crop, kept in (
        (Crop(0, 0, 32, 48), True),
        (Crop(1, 0, 32, 48), False),
        (Crop(0, 1, 32, 48), False),
        (Crop(-1, 0, 8, 8), False),
        (Crop(0, 0, 1, 8), False),
    ):
        assert (fitting(Sample(image(), crop=crop)).crop == crop) == kept
    tiny = fitting(Sample(image(), 0.01, CROP))
    assert (tiny.scale, tiny.crop) == (1.0, None)


def test_a_code_goes_to_the_chosen_column_of_msg() -> None:
    code = DataInput({"a": 1}, "code")
    before, _ = states()
    state, column_id = with_code(before, code, 1)
    assert (column_id, state.columns[-1].method, state.columns[-1].inputs) == (4, "msg", (("code", code),))
    two = dataclasses.replace(state, columns=(*state.columns, Column(5, "msg", MSG.params())), next_id=6)
    assert with_code(two, code, 5)[1] == 5
    assert with_code(two, code, 1)[1] == 4


def test_an_id_is_never_used_again() -> None:
    before, _ = states()
    state = fresh_ids(before, before.next_id)
    taken = range(before.next_id, before.next_id + len(before.columns))
    assert ([column.id for column in state.columns], state.next_id) == ([*taken], taken.stop)
    assert [column.params for column in state.columns] == [column.params for column in before.columns]


# Drafts.


@pytest.mark.parametrize(
    ("size", "seconds", "draft"),
    [
        ((512, 512), None, (256, 256)),
        ((512, 256), 0.2, (256, 128)),
        ((512, 256), 0.05, None),
        ((512, 256), 0.051, (504, 256)),
        ((512, 256), 500.0, (SMALLEST_DRAFT, SMALLEST_DRAFT)),
        ((32, 40), 500.0, None),
    ],
)
def test_a_draft_takes_its_share_of_the_time(size: Any, seconds: float | None, draft: Any) -> None:
    assert draft_size(size, seconds) == draft
