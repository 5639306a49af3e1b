"""``compare`` and ``sweep`` with names that ask for a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pypdf
import pytest

from texlab_core.sheets.sweep_sources import find_sweep

if TYPE_CHECKING:
    from tests.cli.conftest import Texlab

GRASS = ("gallery:stochastic-grass", "--crop", "32x32+0+0")
SWEEP = ("sweep", *GRASS, "--method", "tiling", "--vary", "seed=1:4:4")


def test_a_comparison_as_a_pdf(texlab: Texlab) -> None:
    done = texlab("compare", *GRASS, "--methods", "tiling,pixels", "--out", "a.pdf", "--width-cm", "8.5")
    assert (done.code, done.err) == (0, "")
    page = pypdf.PdfReader("a.pdf").pages[0]
    assert float(page.mediabox.width) == pytest.approx(8.5 / 2.54 * 72, abs=1e-3)
    text = page.extract_text()
    assert all(each in text for each in ("(a)", "Exemplar", "(b)", "Tiling", "(c)"))
    assert len(page.images) == 3


def test_a_sweep_is_found_again_in_its_figures(texlab: Texlab) -> None:
    for name in ("a.png", "a.pdf", "a.svg"):
        done = texlab(*SWEEP, "--out", name)
        assert (done.code, done.err) == (0, "")
    assert find_sweep("a.pdf").to_json() == find_sweep("a.svg").to_json() == find_sweep("a.png").to_json()
    again = texlab("sweep", GRASS[0], *GRASS[1:], "--recipe", "a.pdf", "--out", "b.svg")
    assert (again.code, again.err) == (0, "")
    with open("a.svg", "rb") as one, open("b.svg", "rb") as other:
        assert one.read() == other.read()


def test_a_series_is_wrapped_as_asked_and_a_grid_keeps_its_columns(texlab: Texlab) -> None:
    heights = []
    for columns in (2, 4):
        assert texlab(*SWEEP, "--columns", columns, "--out", "a.pdf").code == 0
        heights.append(float(pypdf.PdfReader("a.pdf").pages[0].mediabox.height))
    assert heights[0] > 1.5 * heights[1]
    grid = ("sweep", *GRASS, "--method", "heeger-bergen", "--vary", "seed=1,2", "--vary", "iterations=1,2")
    done = texlab(*grid, "--columns", "3", "--out", "b.pdf")
    assert done.code == 2
    assert "columns: must be 2, the values of seed" in done.err


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--out", "a.eps"), ".png, .pdf or .svg"),
        (("--out", "a.png", "--dpi", "200"), "dpi"),
        (("--out", "a.png", "--no-letters"), "no-letters"),
        (("--out", "a.pdf", "--width-cm", "1"), "width"),
        (("--out", "a.pdf", "--scale-bar", "1.5"), "scale-bar"),
    ],
)
def test_what_cannot_be_is_one_sentence(texlab: Texlab, more: tuple[str, ...], said: str) -> None:
    for command in (("compare", *GRASS, "--methods", "tiling"), SWEEP):
        done = texlab(*command, *more)
        assert done.code == 2
        assert said in done.err
        assert done.err.count("\n") == 1
