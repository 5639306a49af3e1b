"""The numbers in the words and tables of the help are those that the program measures."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pytest

from texlab_core.figures import _stated
from texlab_core.figures._stated import STATED, place
from texlab_core.files.resources import resource
from texlab_core.methods.efros_leung.params import EfrosLeungParams
from texlab_core.methods.efros_leung.windows import FULL_SPREAD, effective_tau
from texlab_core.popout.scoring import wilson

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

NUMBER = re.compile(r"-?\d*\.?\d+")


def page(name: str) -> str:
    return resource(f"help/{name}.md").read_text(encoding="utf-8")


def stated(page_name: str, name: str) -> str:
    found = place(name).search(page(page_name))
    assert found is not None, (page_name, name)
    return found[0]


def row(words: str, head: str) -> list[float]:
    (line,) = (line for line in words.splitlines() if line.startswith(f"| {head} |"))
    return [float(cell) for cell in line.strip("| ").split(" | ")[1:]]


def test_every_place_is_in_its_page_once_and_belongs_to_the_command() -> None:
    for each in STATED:
        assert len(place(each.name).findall(page(each.page))) == 1
    for name in {each.page for each in STATED}:
        marked = set(re.findall(r"<!-- end of (.*?) -->", page(name))) - {"defaults", "tuned"}
        assert marked == {each.name for each in STATED if each.page == name}


def test_tau_of_little_contrast() -> None:
    words = page("efros-leung")
    found = re.search(r"evenly over (\d+) of 255 gray levels gets a tau of ([\d.]+) instead of (\d+)", words)
    assert found is not None
    levels, tau, usual = int(found[1]), float(found[2]), float(found[3])
    pixels = np.tile(np.arange(levels) + 100, (levels, 1))[..., None].astype(np.float32) / 255
    params = EfrosLeungParams()
    assert params.tau == usual
    got = effective_tau(usual, "relative", params.criterion, pixels)
    assert round(got, 2) == tau
    assert float(re.search(r"spread by (\d+) gray", words)[1]) == FULL_SPREAD  # type: ignore[index]


# A part of each is measured anew: machines differ in the last digits, and by a texture's details.


def test_copied_neighbours() -> None:
    written = row(stated("de-bonet", "orientations"), "copied neighbours")
    assert len(written) == len(_stated.SAMPLED)
    found = _stated.copied_neighbours(_stated.SAMPLED[:1])
    assert found == pytest.approx(written[:1], abs=0.03)
    assert written == sorted(written)


def test_spectral_distances() -> None:
    words = stated("laboratory", "orientations")
    for title, name in list(_stated.MATCHED_ON.items())[:1]:
        written = row(words, title)
        assert len(written) == len(_stated.MATCHED)
        assert _stated.spectral_distances(name, (1,)) == pytest.approx(written[:1], abs=0.3)


def test_what_the_machine_observer_finds() -> None:
    words = stated("popout", "observer")
    numbers = [int(each) for each in re.findall(r"\bin (\d+)[,%.]", words.replace("\n", " "))]
    assert f"Of {len(_stated.WATCHED)} tests" in words
    *written, chance = numbers
    found, guessed = _stated.found_originals(_stated.WATCHED[:1])
    assert round(100 * guessed) == chance
    # One test of each cannot be more than all of them.
    assert all(one <= every <= len(_stated.WATCHED) for one, every in zip(found, written, strict=True))
    # What stands out is found nearly always; what does not, not far more often than by guessing.
    assert min(written[:3]) >= 0.9 * len(_stated.WATCHED)
    assert written[3] < 0.6 * len(_stated.WATCHED)


def test_searched() -> None:
    words = stated("laboratory", "search keys")
    ways = ("blank search", "hash keys", "hierarchy")
    for way, found in zip(ways, _stated.searched(), strict=True):
        assert row(words, way) == pytest.approx(found, rel=0.05, abs=0.5)


def test_shared_information() -> None:
    words = stated("laboratory", "dependence")
    written = [float(each) for each in NUMBER.findall(words) if "." in each.rstrip(".")]
    assert written == pytest.approx(_stated.shared_information(), abs=0.02)


@pytest.mark.parametrize("kind", ["noise", "discs"])
def test_normal_errors(kind: str) -> None:
    words = stated("shape-from-texture", "normals")
    search, moments = _stated.normal_errors(kind, _stated.SLANTS[:1])
    for how, found in (("search", search), ("moments", moments)):
        written = row(words, f"{kind}, {how}")
        assert len(written) == len(_stated.SLANTS)
        assert found == pytest.approx(written[:1], abs=1.0)


def test_marks_and_points() -> None:
    words = " ".join(stated("shape-from-texture", "marks and points").split())
    pattern = r"From 100 .* is (\d+), (\d+) and (\d+) degrees .* points (\d+) degrees at slant 0 and (\d+) at 40\."
    found = re.fullmatch(pattern, words)
    assert found is not None
    marks, density = _stated.evidence_errors()
    assert [*marks, *density] == pytest.approx([float(each) for each in found.groups()], abs=0.8)


def test_sphere() -> None:
    words = stated("shape-from-texture", "sphere")
    written = [float(each) for each in re.findall(r"\d+", words.partition("normals are")[2])[:4]]
    # One of the two spheres.
    assert _stated.sphere_errors((30,)) == pytest.approx(written, abs=3)


def test_solids() -> None:
    rows = [
        [cell.strip() for cell in line.split("|")[1:-1]] for line in stated("solid", "solids").splitlines()[2:]
    ]
    many = len(_stated.SOLIDS)
    assert [row[0] for row in rows] == [f"{k}, {b}" for k in ("laplacian", "mixed") for b in ("plain", "balanced")]
    nearer = [int(re.fullmatch(rf"(\d+) of {many}", row[1])[1]) for row in rows]  # type: ignore[index]
    farther, rises, left = (np.array([float(row[place]) for row in rows]) for place in (2, 3, 4))
    for plain, balanced in ((0, 1), (2, 3)):
        assert nearer[plain] < nearer[balanced]
        assert farther[plain] > farther[balanced]
        assert rises[plain] > 10 * rises[balanced]
        assert left[plain] >= left[balanced]
    granite = _stated.solid_bands("stochastic-granite", "mixed")
    assert (granite[:, -1] < granite[:, 0]).all()
    ribs = _stated.solid_bands("manmade-ribs", "laplacian", balance=False)
    assert (ribs[:, -1] >= ribs[:, 0]).sum() == 1


def test_two_hits_of_five_stand_out_where_guessing_finds_eleven_of_a_hundred() -> None:
    assert "guessing finds in 11 %, two hits of five stand out, and one does\nnot" in page("popout")
    assert wilson(2, 5)[0] > 0.11 > wilson(1, 5)[0]


def test_the_command_puts_numbers_into_their_places(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from texlab_core.figures.__main__ import main

    def words() -> str:
        return "new 7 \\1"

    given: Sequence[_stated.Stated] = (_stated.Stated("one", "some numbers", words),)
    monkeypatch.setattr(_stated, "STATED", given)
    text = "# One\n\n<!-- some numbers -->\n\nold 3\n\n<!-- end of some numbers -->\n\nother 4\n"
    (tmp_path / "one.md").write_text(text, encoding="utf-8")
    monkeypatch.setattr("sys.argv", ["figures", "--numbers", str(tmp_path)])
    assert main() == 0
    assert (tmp_path / "one.md").read_text(encoding="utf-8") == text.replace("old 3", "new 7 \\1")
    (tmp_path / "one.md").write_text("# One\n", encoding="utf-8")
    assert main() == 2
    assert "has no place called 'some numbers'" in capsys.readouterr().err
