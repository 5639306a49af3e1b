"""Lessons: the format and its refusals, what comes with the program, the index of figures, the page."""

from __future__ import annotations

import copy
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.documents import lessons as format_
from texlab_core.documents.lesson_parts import LessonError
from texlab_core.documents.lessons import figure_parts, lesson_from_json, read_lesson, step_from_json, write_lesson
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError
from texlab_core.images.formats.writing import encode_png
from texlab_core.lessons import page as pages
from texlab_core.lessons import result_drawings
from texlab_core.lessons.drawing import kinds
from texlab_core.lessons.figure_index import figure_index, numbers
from texlab_core.lessons.running import REDUCED_SIDE, check_lesson, jobs, run_lesson, run_step
from texlab_core.lessons.shelf import bundled, find, own
from texlab_core.sheets.contact_sheet import Tile, contact_sheet

if TYPE_CHECKING:
    from pathlib import Path

STEP: dict[str, Any] = {
    "sentence": "Repeat, or draw at random.",
    "note": "Two lines,\nas a note may have.",
    "question": "Which is right?",
    "answer": "Neither.",
    "try": "Another seed.",
    "figures": ["de-bonet 2", "msg table 1"],
    "exemplar": {"source": "gallery:structured-pebbles", "crop": {"top": 8, "left": 4, "height": 40, "width": 48}},
    "size": {"width": 64, "height": 56},
    "seed": 7,
    "columns": [
        {"method": "tiling", "parameters": {"mirror": True}, "title": "mirrored", "seed": 8},
        {"method": "heeger-bergen", "parameters": {"iterations": 1}},
    ],
    "chosen": 1,
    "series": {"column": 1, "parameter": "iterations", "values": [0, 1]},
    "drawing": {"kind": "histograms", "settings": {"levels": 1}},
    "tab": {"name": "pyramid", "settings": {"kind": "laplacian", "log": True}},
    "pixel": {"column": 1, "x": 63, "y": 55},
    "view": {"zoom": 4.0, "x": 10.0, "y": 20.0, "tile": True},
    "marks": [{"top": 1, "left": 2, "height": 8, "width": 9}],
}
LESSON: dict[str, Any] = {
    "format": "texlab-lesson",
    "version": 1,
    "title": "Two ways",
    "chapter": "11.3",
    "papers": ["de-bonet"],
    "summary": "Short.",
    "steps": [STEP],
}


TAKEN: dict[str, Any] = {"source": "gallery:stochastic-lava"}


def changed(*path: str | int, to: Any) -> dict[str, Any]:
    """Return the lesson with one value replaced, or left out when ``to`` is Ellipsis."""
    data = copy.deepcopy(LESSON)
    place: Any = data
    for key in path[:-1]:
        place = place[key]
    if to is ...:
        del place[path[-1]]
    else:
        place[path[-1]] = to
    return data


def test_a_lesson_comes_back_from_its_json_as_it_was(tmp_path: Path) -> None:
    lesson = lesson_from_json(LESSON)
    assert lesson.to_json() == LESSON
    write_lesson(lesson, tmp_path / "two.json")
    assert read_lesson(tmp_path / "two.json") == lesson
    assert lesson.steps[0].marks == ((1, 2, 8, 9),)
    assert lesson.steps[0].size == (56, 64)


@pytest.mark.parametrize(
    ("more", "version"),
    [
        ({}, 1),
        ({"levels": [0.1, 0.8, 1.2]}, 2),
        ({"alpha": "black"}, 2),
        ({"levels": [0, 1, 2], "alpha": "keep"}, 2),
    ],
)
def test_levels_and_transparency_come_back_in_the_least_version(more: dict[str, Any], version: int) -> None:
    crop = {"top": 0, "left": 1, "height": 20, "width": 30}
    data = changed("steps", 0, "exemplar", to={**TAKEN, "crop": crop, **more}) | {"version": version}
    lesson = lesson_from_json(data)
    assert lesson.to_json() == data
    taken = lesson.steps[0].exemplar
    assert taken is not None
    assert taken.alpha == more.get("alpha", "white")
    assert (None if taken.levels is None else taken.levels.to_json()) == more.get("levels")
    # What was written by hand may still have the older number.
    assert lesson_from_json(data | {"version": 1}) == lesson


def test_a_step_works_on_its_levels_and_transparency(tmp_path: Path) -> None:
    pixels = np.random.default_rng(4).integers(0, 256, (24, 20, 4), np.uint8)
    (tmp_path / "glass.png").write_bytes(encode_png(pixels))
    colours, alpha = pixels[..., :3] / np.float32(255), pixels[..., 3:] / np.float32(255)
    expected = {
        "white": colours * alpha + (1 - alpha),
        "black": colours * alpha,
        "ignore": colours,
        "keep": colours,
    }
    for use, seen in expected.items():
        step = {
            "sentence": "Glass.",
            "exemplar": {"source": "glass.png", "alpha": use, "levels": [0.2, 0.9, 1.5]},
            "size": {"width": 16, "height": 16},
            "seed": 1,
            "columns": [{"method": "pixels"}],
        }
        lesson = lesson_from_json(LESSON | {"version": 2, "steps": [step]}, folder=tmp_path)
        for reduced in (False, True):
            shown = run_step(lesson, lesson.steps[0], reduced=reduced)
            assert shown.exemplar is not None
            levelled = np.clip((seen - 0.2) / 0.7, 0, 1) ** (1 / 1.5)
            np.testing.assert_allclose(shown.exemplar.pixels, levelled, atol=2e-5)
            assert (shown.exemplar.alpha is not None) == (use == "keep")
            assert shown.results[0].job.inputs["exemplar"].sha256 == shown.exemplar.sha256


@pytest.mark.parametrize("key", sorted(STEP))
def test_every_key_of_a_step_is_checked_and_named(key: str) -> None:
    with pytest.raises(LessonError, match=rf"^The lesson cannot be used: step 1: .*{key}"):
        lesson_from_json(changed("steps", 0, key, to=[{"x": object.__name__}, 3]))


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "another format": (changed("format", to="texlab-preset"), "no lesson"),
    "a newer version": (changed("version", to=3), "version 3"),
    "no title": (changed("title", to=""), "title: must be 1 to 80"),
    "an unknown key": (changed("teacher", to="me"), "teacher"),
    "no steps": (changed("steps", to=[]), "steps: must be a list of 1 to 60, got 0"),
    "an unknown paper": (changed("papers", to=["julesz"]), "julesz"),
    "an unknown figure": (changed("steps", 0, "figures", to=["de-bonet two"]), "de-bonet two"),
    "an unknown method": (changed("steps", 0, "columns", 0, "method", to="magic"), "magic"),
    "a parameter out of range": (changed("steps", 0, "columns", 1, "parameters", to={"iterations": 99}), "99"),
    "an unknown parameter": (changed("steps", 0, "columns", 1, "parameters", to={"rounds": 3}), "rounds"),
    "columns without an exemplar": (changed("steps", 0, "exemplar", to=...), "exemplar: is missing"),
    "an unknown texture": (changed("steps", 0, "exemplar", to="gallery:custard"), "custard"),
    "a file above the lesson": (changed("steps", 0, "exemplar", to="../../secret.png"), "below it"),
    "a file anywhere": (changed("steps", 0, "exemplar", to="/etc/passwd"), "below it"),
    "a file on a drive": (changed("steps", 0, "exemplar", to="C:\\secret.png"), "below it"),
    "an answer without a question": (changed("steps", 0, "question", to=...), "answer: goes with a question"),
    "a choice beyond the columns": (changed("steps", 0, "chosen", to=2), "from 0 to 1"),
    "a slider of another method": (changed("steps", 0, "series", "parameter", to="alpha"), "alpha"),
    "a slider out of range": (changed("steps", 0, "series", "values", to=[0, 51]), "51"),
    "a pixel beside the result": (changed("steps", 0, "pixel", "x", to=64), "64 x 56"),
    "a column's negative seed": (changed("steps", 0, "columns", 0, "seed", to=-1), "seed"),
    "a negative seed": (changed("steps", 0, "seed", to=-1), "seed"),
    "a sentence too long": (changed("steps", 0, "sentence", to="a" * 161), "at most|1 to 160"),
    "a mark of no height": (changed("steps", 0, "marks", 0, "height", to=0), "height"),
    "nested settings": (changed("steps", 0, "tab", "settings", to={"a": {"b": 1}}), "settings: a"),
    "an input the method lacks": (
        changed("steps", 0, "columns", 0, "inputs", to={"second": "gallery:stochastic-lava"}),
        "takes none here",
    ),
    "an input that is missing": (changed("steps", 0, "columns", 0, to={"method": "mixture"}), "needs second"),
    "levels upside down": (
        changed("steps", 0, "exemplar", to={**TAKEN, "levels": [0.9, 0.1, 1]}),
        "levels: .*0.9",
    ),
    "levels of two numbers": (changed("steps", 0, "exemplar", to={**TAKEN, "levels": [0, 1]}), "levels: "),
    "levels in words": (changed("steps", 0, "exemplar", to={**TAKEN, "levels": "auto"}), "levels: .*auto"),
    "another transparency": (
        changed("steps", 0, "exemplar", to={**TAKEN, "alpha": "pink"}),
        "alpha: must be one of white, black, ignore, keep, got .*pink",
    ),
    "a number for transparency": (changed("steps", 0, "exemplar", to={**TAKEN, "alpha": 1}), "alpha: .*got 1"),
    "a size of three sides": (changed("steps", 0, "size", to={"width": 4, "height": 4, "depth": 4}), "size"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_bad_lesson_is_refused_in_one_sentence(case: str) -> None:
    data, says = REFUSED[case]
    with pytest.raises(LessonError, match=says) as refused:
        lesson_from_json(data, what="the lesson bad.json")
    assert str(refused.value).startswith("The lesson bad.json cannot be used: ")
    assert "\n" not in str(refused.value)


def test_a_text_alone_is_a_picture_or_a_tab() -> None:
    step = step_from_json({"sentence": "Look.", "exemplar": "gallery:stochastic-lava", "tab": "maps"})
    assert step.exemplar is not None
    assert step.exemplar.crop is None
    assert step.tab is not None
    assert step.tab.name == "maps"
    assert step.to_json()["exemplar"] == "gallery:stochastic-lava"


def test_a_lesson_without_a_folder_uses_the_gallery_only(tmp_path: Path) -> None:
    data = changed("steps", 0, "exemplar", to="pictures/stone.png")
    lesson = lesson_from_json(data)
    with pytest.raises(LessonError, match="no folder"):
        jobs(lesson, lesson.steps[0])
    (tmp_path / "pictures").mkdir()
    rng = np.random.default_rng(3)
    pixels = rng.integers(0, 256, (40, 40, 3), dtype=np.uint8)
    (tmp_path / "pictures" / "stone.png").write_bytes(encode_png(pixels))
    (tmp_path / "own.json").write_text(json.dumps(data))
    lesson = read_lesson(tmp_path / "own.json")
    exemplar: Any = jobs(lesson, lesson.steps[0])[0].inputs["exemplar"]
    assert np.array_equal(np.rint(exemplar.pixels * 255), pixels)


def test_a_drawing_without_what_it_needs_is_refused() -> None:
    cases: list[tuple[dict[str, Any], str]] = [
        ({"drawing": {"kind": "oil"}}, "kind must be one of"),
        ({"drawing": {"kind": "filters"}}, "needs an exemplar"),
        ({"drawing": {"kind": "filters", "settings": {"scale": 40}}, "exemplar": "gallery:stochastic-lava"}, "40"),
        ({"drawing": {"kind": "candidates"}, "exemplar": "gallery:stochastic-lava"}, "needs a column"),
    ]
    for parts, says in cases:
        lesson = lesson_from_json({**LESSON, "steps": [{"sentence": "Look.", **parts}]})
        with pytest.raises(LessonError, match=rf"^Step 1 of Two ways: .*{says}"):
            check_lesson(lesson)


def test_a_drawing_of_one_method_needs_a_column_of_it() -> None:
    data = changed("steps", 0, "drawing", to={"kind": "msg-code"})
    with pytest.raises(LessonError, match="needs a chosen column of msg"):
        check_lesson(lesson_from_json(data))


def test_a_step_is_what_its_jobs_give() -> None:
    lesson = lesson_from_json(LESSON)
    step = lesson.steps[0]
    made = run_step(lesson, step)
    assert [each.job.method for each in made.results] == ["tiling", "heeger-bergen"]
    assert all(each.image.shape == (56, 64, 3) for each in (*made.results, *made.series))
    assert [each.job.params.to_json()["iterations"] for each in made.series] == [0, 1]
    # The slider passes through the column's own value, which is not run again.
    assert made.series[1] is made.results[1]
    for result, job in zip((*made.results, *made.series), jobs(lesson, step), strict=True):
        assert np.array_equal(result.image, run(job).image)
    assert made.drawn is not None
    assert made.drawn.sheet.dtype == np.uint8


def test_a_reduced_step_is_small() -> None:
    lesson = lesson_from_json(changed("steps", 0, "exemplar", to="gallery:structured-pebbles"))
    for job in jobs(lesson, lesson.steps[0], reduced=True):
        exemplar: Any = job.inputs["exemplar"]
        assert max(exemplar.size) == REDUCED_SIDE
        assert max(job.size) <= REDUCED_SIDE


def test_a_lesson_is_stopped_at_once() -> None:
    with pytest.raises(Cancelled):
        list(run_lesson(lesson_from_json(LESSON), should_stop=lambda: True))


# What comes with the program.


@pytest.mark.parametrize("name", bundled())
def test_every_step_of_a_bundled_lesson_can_be_run(name: str) -> None:
    lesson = find(name)
    check_lesson(lesson)
    made = list(run_lesson(lesson, reduced=True))
    assert len(made) == len(lesson.steps)
    for step, result in zip(lesson.steps, made, strict=True):
        assert len(result.results) == len(step.columns)
        assert (result.drawn is None) == (step.drawing is None)
        shown = [each.image for each in result.results]
        assert shown or result.drawn is not None, f"nothing to see: {step.sentence}"
        assert all(np.isfinite(image).all() and image.std() > 0 for image in shown), step.sentence


@pytest.mark.parametrize("name", bundled())
def test_a_bundled_lesson_is_complete(name: str) -> None:
    lesson = find(name)
    assert lesson.summary
    assert lesson.papers
    assert any(step.question for step in lesson.steps)
    for step in lesson.steps:
        assert step.note, step.sentence
        assert step.sentence.endswith((".", "?", "!")), step.sentence
        assert bool(step.question) == bool(step.answer), step.sentence
        for figure in step.figures:
            paper, number = figure_parts(figure)
            assert number in numbers(paper), f"{paper} has no figure {number}"


def test_a_bundled_lesson_is_written_as_it_would_be_written_again() -> None:
    for name, lesson in bundled().items():
        again = lesson_from_json(json.loads(json.dumps(lesson.to_json())))
        assert again == lesson, name


def test_drawings_beside_the_words_have_captions_for_the_back_row(monkeypatch: pytest.MonkeyPatch) -> None:
    shares: list[float] = []

    def noted(*args: Any, **more: Any) -> Any:
        shares.append(more.get("share", 0.0))
        return contact_sheet(*args, **more)

    monkeypatch.setattr(result_drawings, "contact_sheet", noted)
    shown = [
        (lesson, step)
        for lesson in bundled().values()
        for step in lesson.steps
        if step.tab is None and step.drawing is not None
    ]
    assert shown
    for lesson, step in shown:
        run_step(lesson, replace(step, series=None), reduced=True)
    # At 1280 x 720 such a sheet has 760 pixels across: capitals are 0.7 of the size of their letters.
    assert len(shares) == len(shown)
    assert all(0.7 * share * 760 / 4.2 >= 720 / 40 for share in shares)


def test_captions_of_a_share_are_that_large() -> None:
    picture = np.ones((256, 256, 3), np.float32)

    def ink(share: float) -> int:
        sheet = contact_sheet([Tile(picture, ("H",))], 1, share=share)
        return int((sheet.min((1, 2)) < 128).sum())

    assert ink(0.2) == pytest.approx(0.2 * 256 * 0.71, abs=3)
    assert ink(0) < 0.5 * ink(0.2)


def test_every_kind_of_drawing_is_in_some_lesson() -> None:
    used = {step.drawing.kind for each in bundled().values() for step in each.steps if step.drawing is not None}
    assert used == set(kinds())


def test_the_index_has_every_number_of_the_papers_once() -> None:
    index = figure_index(bundled())
    keys = [(each.paper, each.number) for each in index]
    expected = [("de-bonet", str(n)) for n in range(1, 15)]
    expected += [("heeger-bergen", str(n)) for n in range(1, 9)]
    expected += [("msg", str(n)) for n in range(1, 9)] + [("msg", "table 1"), ("msg", "table 2")]
    expected += [("forsyth-ponce", f"11.{n}") for n in range(1, 26)]
    assert sorted(keys) == sorted(expected)
    for each in index:
        for lesson, step in each.steps:
            assert f"{each.paper} {each.number}" in bundled()[lesson].steps[step - 1].figures
        assert bool(each.steps) != bool(each.reason), f"{each.title}: a step or a reason"


def test_lessons_are_found_by_name_and_by_file(tmp_path: Path) -> None:
    assert find("heeger-bergen").title == bundled()["heeger-bergen"].title
    with pytest.raises(LessonError, match="did you mean heeger-bergen"):
        find("heeger-berge")
    (tmp_path / "good.json").write_text(json.dumps(LESSON))
    (tmp_path / "bad.json").write_text("{")
    found, problems = own(tmp_path)
    assert list(found) == ["good"]
    assert len(problems) == 1
    assert "bad.json" in problems[0]
    assert own(tmp_path / "none") == ({}, ())
    assert find(str(tmp_path / "good.json")) == found["good"]


# The page.


class Links(HTMLParser):
    """Collects what a page refers to, and its tags."""

    def __init__(self) -> None:
        super().__init__()
        self.sources: list[str] = []
        self.tags: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        found = dict(attrs)
        self.sources += [found[key] or "" for key in ("src", "href") if key in found]
        self.sources += json.loads(found.get("data-files") or "[]")


def test_the_page_has_every_picture_beside_it_and_nothing_from_elsewhere(tmp_path: Path) -> None:
    data = changed("title", to='<img src="http://example.org/x">')
    page = pages.export(lesson_from_json(data), tmp_path / "out", reduced=True)
    text = page.read_text(encoding="utf-8")
    links = Links()
    links.feed(text)
    assert links.tags.count("section") == 1
    assert links.sources
    assert all((tmp_path / "out" / each).is_file() for each in links.sources)
    assert "http://example.org" in text
    assert '<img src="http' not in text
    assert not re.search(r'(src|href)="(https?:)?//', text)
    assert "default-src 'none'" in text
    assert sum(each.endswith(".png") for each in set(links.sources)) == 5
    # Written again into the same folder, but never over something else.
    pages.export(lesson_from_json(data), tmp_path / "out", reduced=True)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    with pytest.raises(LessonError, match="not empty"):
        pages.export(lesson_from_json(data), tmp_path / "mine")
    with pytest.raises(InputError, match="is a file"):
        pages.export(lesson_from_json(data), tmp_path / "mine" / "notes.txt")


def test_a_lesson_that_would_not_be_read_is_not_written(tmp_path: Path) -> None:
    lesson = lesson_from_json(LESSON)
    bad = format_.Lesson(title="", steps=lesson.steps)
    with pytest.raises(LessonError, match="title"):
        write_lesson(bad, tmp_path / "bad.json")
    assert not (tmp_path / "bad.json").exists()
