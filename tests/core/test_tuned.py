"""The script that judges what the tuner finds: what holds, what it prints, its exit code."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from texlab_core.engine.run import run
from texlab_core.figures import _tuned
from texlab_core.figures._stated import place
from texlab_core.figures._tuned import Gain, gain
from texlab_core.figures.defaults import centre, homogeneous
from texlab_core.files.resources import resource
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import Subject

if TYPE_CHECKING:
    from pathlib import Path

    from texlab_core.engine.job import Job
    from texlab_core.engine.params import Params

GOOD = Gain("a", kept=-4.1, gained=0.5, base_kept=-4.0, base_gained=0.4, changes={"alpha": 0.2})


def test_what_holds_has_a_larger_v_at_no_larger_d() -> None:
    assert GOOD.holds
    assert replace(GOOD, kept=-4.0).holds
    assert not replace(GOOD, kept=-3.99).holds
    assert not replace(GOOD, gained=0.4).holds
    assert "D  -4.00 ->  -4.10  V 0.400 -> 0.500  holds" in GOOD.line()
    assert replace(GOOD, kept=-3.9).line().endswith("fails")
    assert replace(GOOD, kept=-4.0, gained=0.4, changes={}).line().endswith("nothing found")


def test_it_fails_below_the_bar(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    count = len(homogeneous())
    for failing, code in ((count // 5, 0), (count // 5 + 1, 1)):
        left = iter(range(count))
        monkeypatch.setattr(
            _tuned, "gain", lambda name, _, left=left, most=failing: replace(
                GOOD, name=name, kept=-3.9 if next(left) < most else -4.1
            ),
        )  # fmt: skip
        monkeypatch.setattr("sys.argv", ["tuned"])
        assert _tuned.main() == code
        out = capsys.readouterr().out
        assert out.count("\n") == count + 1
        assert f"on {count - failing} of {count} textures" in out
    page = tmp_path / "page.md"
    page.write_text("Before.\n\n<!-- tuned -->\n\nOld.\n\n<!-- end of tuned -->\n\nAfter.\n")
    monkeypatch.setattr(_tuned, "gain", lambda name, _: replace(GOOD, name=name))
    monkeypatch.setattr("sys.argv", ["tuned", "--write", str(page)])
    assert _tuned.main() == 0
    said = f"V is larger at no larger D on {count} of {count} textures (100%)."
    assert page.read_text() == f"Before.\n\n<!-- tuned -->\n\n{said}\n\n<!-- end of tuned -->\n\nAfter.\n"
    page.write_text("No place.\n")
    assert _tuned.main() == 2
    assert "has no place called 'tuned'" in capsys.readouterr().err
    monkeypatch.undo()
    monkeypatch.setattr("sys.argv", ["tuned", "--budget", "3", "--only", "stochastic-gravel"])
    assert _tuned.main() == 2
    assert "budget: must be a whole number from 24" in capsys.readouterr().err


def test_judges_are_seeds_that_the_search_never_saw(monkeypatch: pytest.MonkeyPatch) -> None:
    class Found:
        """What a search would give."""

        def __init__(self, found: Params) -> None:
            self.found, self.changes = found, {"alpha": 0.3}

    seen: list[Job] = []

    def tuned(base: Job, **options: object) -> Found:
        seen.append(base)
        assert options["limit"] == "start"
        return Found(base.params.replace(alpha=0.3))

    monkeypatch.setattr(_tuned, "tune", tuned)
    judged = gain("stochastic-gravel", judges=(7, 8))
    assert seen[0].size == (256, 256)
    assert not {seen[0].seed, 1} & set(_tuned.JUDGES)
    for params, kept, gained in (
        (seen[0].params, judged.base_kept, judged.base_gained),
        (seen[0].params.replace(alpha=0.3), judged.kept, judged.gained),
    ):
        numbers = [
            measure_all(
                Subject.of_result(run(replace(seen[0], params=params, seed=seed))),
                ("discriminability", "visual-difference"),
            )
            for seed in (7, 8)
        ]
        assert kept == pytest.approx(sum(each["discriminability"] for each in numbers) / 2)
        assert gained == pytest.approx(sum(each["visual-difference"] for each in numbers) / 2)
    assert seen[0].inputs["exemplar"].sha256 == centre("stochastic-gravel").sha256


def test_the_help_says_on_how_many_it_holds() -> None:
    found = place("tuned").search(resource("help/de-bonet.md").read_text(encoding="utf-8"))
    assert found is not None
    held, count = map(int, re.findall(r"(\d+) of (\d+)", found[0])[0])
    assert found[0] == _tuned.words([replace(GOOD, kept=-4.1 if each < held else -3.9) for each in range(count)])
    assert count == len(homogeneous())
    assert held >= _tuned.BAR * count
