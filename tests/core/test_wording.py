"""Names on one line, of characters that can be seen."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texlab_core.documents.presets import ExemplarRef
from texlab_core.documents.record import read_recipe, save_result
from texlab_core.engine.inputs import ArraysInput, DataInput
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.files.wording import did_you_mean, printable, sentence_case
from texlab_core.images.exemplar import as_exemplar

NOISE = np.arange(24, dtype=np.float32).reshape(4, 6) / 32


@pytest.mark.parametrize(
    ("given", "seen"),
    [
        ("wall.png", "wall.png"),
        ("Wände 墙.png", "Wände 墙.png"),
        ("a\nb\t c.png", "a b c.png"),
        ("\x1b[31mred.png", "\ufffd[31mred.png"),
        ("gnp\u202e.png", "gnp\ufffd.png"),
        ("\udcff\ud800", "\ufffd\ufffd"),
        ("x" * 300, "x" * 252 + "..."),
    ],
)
def test_names(given, seen):
    assert printable(given) == seen


@given(st.text(st.characters(exclude_categories=())))
def test_every_name_can_be_printed_and_encoded(text):
    seen = printable(text)
    assert seen.isprintable()
    assert len(seen) <= 255
    assert printable(seen) == seen
    seen.encode()


@pytest.mark.parametrize("name", ["\x1b[2J", "two\nlines", "\udcff.png", "\u202egnp", "x" * 5000])
def test_results_of_files_with_odd_names_can_be_redone(tmp_path, name):
    exemplar = as_exemplar(NOISE, name=name)
    made = run(Job(method="tiling", inputs={"exemplar": exemplar}, size=(9, 5)))
    save_result(made, tmp_path / "a.png")
    again = run(read_recipe(tmp_path / "a.png").job())
    assert np.array_equal(again.image, made.image)
    ExemplarRef(exemplar.name, exemplar.sha256)
    assert ArraysInput({"a": NOISE}, name).name == DataInput([1], name).name == exemplar.name


def test_the_names_of_files_keep_their_case(tmp_path):
    assert sentence_case("the recipe") == "The recipe"
    assert sentence_case("wall.png") == "wall.png"
    assert sentence_case("") == ""
    assert Path(as_exemplar(NOISE, name="Wall.png").name) == Path("Wall.png")


def test_the_name_that_is_most_like_a_wrong_one():
    assert did_you_mean("rond", ["sweep", "rounds", "round"]) == "did you mean round?"
    assert did_you_mean("zzz", ["rounds"]) == did_you_mean(3, ["rounds"]) == did_you_mean("rounds", []) == ""
