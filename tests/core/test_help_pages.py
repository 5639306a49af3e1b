"""The help pages: every link leads somewhere, every knob is explained, every figure can be redrawn."""

from __future__ import annotations

import base64
import io
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from texlab_core.engine.params import describe
from texlab_core.engine.registry import methods
from texlab_core.figures import _report, encode, figures
from texlab_core.files.resources import resource
from texlab_core.lessons.shelf import bundled

PAGES = {
    entry.name[:-3]: entry.read_text(encoding="utf-8")
    for entry in resource("help").iterdir()
    if entry.name.endswith(".md")
}
OURS = {
    "heeger-bergen", "solid", "mixture", "de-bonet", "efros-leung", "msg",
    "uncoded", "car", "ac-h", "tiling", "pixels", "bands",
}  # fmt: skip
FIGURES = {entry.name: entry for entry in resource("help/figures").iterdir()}
REPORTS = {entry.name.removesuffix(".html"): entry for entry in resource("help/reports").iterdir()}
LINK = re.compile(r"(!?)\[[^\]]*\]\(([^)\s]+)\)")
page_named = pytest.mark.parametrize("page", sorted(PAGES))


def links(page, *, image=False):
    return [target for bang, target in LINK.findall(PAGES[page]) if bool(bang) == image]


@page_named
def test_every_link_leads_somewhere(page):
    for target in links(page):
        if target.startswith("knob:"):
            method, knob = target[5:].split("/")
            assert knob in {each.name for each in describe(methods()[method].params)}, target
        elif target.startswith("lesson:"):
            assert target[7:] in bundled(), target
        elif target.startswith("report:"):
            assert target[7:] in REPORTS, target
        else:
            assert target.endswith(".md")
            assert target[:-3] in PAGES, target


@page_named
def test_every_figure_is_there_and_described(page):
    for target in links(page, image=True):
        assert target.startswith("figures/")
        assert target[8:] in FIGURES
    assert "![](" not in PAGES[page]


@page_named
def test_code_fits_the_page(page):
    for code in re.findall(r"```(.*?)```", PAGES[page], re.DOTALL):
        assert max(map(len, code.splitlines())) <= 80


@page_named
def test_a_page_starts_with_its_title_and_has_only_one(page):
    first, *others = PAGES[page].splitlines()
    assert re.fullmatch(r"# \S.*", first)
    outside = re.sub(r"```.*?```", "", PAGES[page], flags=re.DOTALL)
    assert len(re.findall(r"^# ", outside, re.MULTILINE)) == 1
    assert PAGES[page].count("```") % 2 == 0
    assert others


def test_these_methods_have_a_page_of_their_own():
    # One that is new has a page that is made from its declarations, until one is written.
    assert methods().keys() & PAGES.keys() >= OURS


@pytest.mark.parametrize(
    "method", [each for each in methods().values() if each.id in PAGES], ids=lambda each: each.id
)
def test_the_page_of_a_method_names_all_its_knobs(method):
    linked = {target[5:] for target in links(method.id) if target.startswith("knob:")}
    assert {f"{method.id}/{each.name}" for each in describe(method.params)} <= linked
    surname = re.search(r"[A-Z][a-z]{3,}", method.reference)[0]
    assert surname in PAGES[method.id]


def test_every_page_is_reached_from_the_index():
    reached, waiting = set(), ["index"]
    while waiting:
        page = waiting.pop()
        if page not in reached:
            reached.add(page)
            waiting += [target[:-3] for target in links(page) if target.endswith(".md")]
    assert reached == set(PAGES)


def test_the_figures_are_those_that_the_program_draws_and_all_are_used():
    used = {target[8:] for page in PAGES for target in links(page, image=True)}
    assert used == set(FIGURES) == {each.file for each in figures()}


@pytest.mark.parametrize("name", sorted(FIGURES))
def test_figures_fit_the_page(name):
    content = FIGURES[name].read_bytes()
    assert len(content) < 300_000
    with Image.open(io.BytesIO(content)) as image:
        assert 160 <= image.width <= 720
        assert image.format == ("JPEG" if name.endswith(".jpg") else "PNG")


def blocks(file):
    """Return the mean colours of blocks of 16 x 16 pixels."""
    with Image.open(file) as image:
        small = image.convert("RGB").resize((image.width // 16, image.height // 16), Image.Resampling.BOX)
    return np.asarray(small, np.float64), image.size


@pytest.mark.parametrize(
    "figure",
    [
        pytest.param(each, id=each.name, marks=[pytest.mark.slow] if "efros" in each.name else [])
        for each in figures()
    ],
)
def test_figures_are_redrawn_as_they_are_stored(figure):
    """Blocks are compared, not pixels: on another machine a texture may come out with other details."""
    drawn, size = blocks(io.BytesIO(encode(figure, figure.draw())))
    stored, stored_size = blocks(io.BytesIO(FIGURES[figure.file].read_bytes()))
    assert size == stored_size
    assert np.abs(drawn - stored).mean() < 8


def test_the_reports_are_those_that_are_linked():
    assert set(REPORTS) == {target[7:] for page in PAGES for target in links(page) if target.startswith("report:")}


def rows_of(report):
    """Return the rows of a report: their cells without pictures by their titles, and their pictures."""
    found = {}
    for row in re.findall(r"<tr data-state.*?</tr>", report):
        pictures = [base64.b64decode(each) for each in re.findall(r'src="data:image/webp;base64,([^"]*)"', row)]
        (title,) = re.findall(r'alt="(.*?, seed 1)"', row)
        found[title] = re.findall(r"<td[^>]*>(.*?)</td>", row)[2:], pictures
    return found


def assert_alike(cells, others):
    """Assert that words are the same, and numbers nearly: a texture may come out with other details elsewhere."""
    number = r"-?\d+(?:\.\d+)?"
    assert [re.sub(number, "#", cell) for cell in cells] == [re.sub(number, "#", cell) for cell in others]
    one, other = (np.array(re.findall(number, " ".join(each)), float) for each in (cells, others))
    np.testing.assert_allclose(one, other, rtol=0.05, atol=0.1)


def test_the_report_of_the_help_is_what_its_module_makes(tmp_path):
    """Two of the forty are made again; pictures are compared by blocks, as those of figures are."""
    text = REPORTS["de-bonet-800"].read_text("utf-8")
    assert len(text) < 500_000
    # Nothing but itself: no file beside it, no address.
    assert set(re.findall(r'(?:src|href)="(?!data:image/webp;base64,)([^"]*)"', text)) == set()
    assert "http" not in re.sub(r'"data:[^"]*"', "", text).replace("http-equiv", "")
    stored = rows_of(text)
    assert len(stored) == 40
    made = rows_of(_report.report(tmp_path / "batch", sample=2).decode())
    assert len(made) == 2
    for title, (cells, pictures) in made.items():
        there, kept = stored[title]
        assert cells[:4] == there[:4]
        assert_alike(cells[4:], there[4:])
        assert len(pictures) == 2
        for drawn, picture in zip(pictures, kept, strict=True):
            (one, size), (other, other_size) = blocks(io.BytesIO(drawn)), blocks(io.BytesIO(picture))
            assert size == other_size
            assert np.abs(one - other).mean() < 8
    assert _report.main([str(tmp_path / "report.html"), "--batch", str(tmp_path / "no" / "batch")]) == 2


def test_the_command_draws_what_was_asked_for(tmp_path, monkeypatch, capsys):
    from texlab_core.figures.__main__ import main

    monkeypatch.setattr("sys.argv", ["figures", str(tmp_path / "out"), "msg-table-2"])
    assert main() == 0
    assert [each.name for each in Path(tmp_path / "out").iterdir()] == ["msg-table-2.png"]
    monkeypatch.setattr("sys.argv", ["figures", str(tmp_path), "no-such"])
    assert main() == 2
    assert "figure: must be one of" in capsys.readouterr().err
