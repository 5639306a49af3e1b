"""``texlab lessons``, ``texlab lesson`` and ``texlab figures``."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from texlab.cli.main import main
from texlab.storage.paths import config_dir
from texlab_core.lessons.shelf import find

if TYPE_CHECKING:
    from pathlib import Path

SMALL: dict[str, Any] = {
    "format": "texlab-lesson",
    "version": 1,
    "title": "Small",
    "chapter": "",
    "papers": [],
    "summary": "One step.",
    "steps": [
        {
            "sentence": "It repeats.",
            "exemplar": "gallery:structured-pebbles",
            "size": {"width": 40, "height": 40},
            "columns": [{"method": "tiling"}],
        }
    ],
}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "small.json"
    path.write_text(json.dumps(SMALL))
    return path


def test_lessons_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lessons"]) == 0
    text = capsys.readouterr().out
    assert "heeger-bergen" in text
    assert "Heeger and Bergen 1995" in text
    # Titles stand under each other.
    assert len({line.index(find(line.split()[0]).title) for line in text.splitlines()}) == 1
    assert main(["lessons", "--json"]) == 0
    found = {each["name"]: each for each in json.loads(capsys.readouterr().out)}
    assert len(found["heeger-bergen"]["steps"]) == 13


def test_your_own_lessons_are_listed_by_their_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("TEXLAB_HOME", str(tmp_path))
    folder = config_dir() / "lessons"
    folder.mkdir(parents=True)
    # Called as one of the program's.
    mine = folder / "heeger-bergen.json"
    mine.write_text(json.dumps(SMALL))
    (folder / "broken.json").write_text("{")
    assert main(["lessons"]) == 0
    said = capsys.readouterr()
    assert f"{mine}  -" in said.out
    assert "Small, 1 steps" not in said.out
    assert "Small, 1 step (no paper)" in said.out
    assert len(said.err.splitlines()) == 1
    assert "broken.json" in said.err
    assert main(["lessons", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    (found,) = (each for each in listed if each["own"])
    assert (found["name"], found["lesson"]) == ("heeger-bergen", str(mine))
    assert main(["lesson", found["lesson"]]) == 0
    assert "Small, 1 step\n" in capsys.readouterr().out


def test_figures_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figures"]) == 0
    assert "11.15" in capsys.readouterr().out
    assert main(["figures", "--json"]) == 0
    found = {(each["paper"], each["number"]): each for each in json.loads(capsys.readouterr().out)}
    assert found["heeger-bergen", "7"]["steps"][0]["lesson"] == "heeger-bergen"
    assert found["heeger-bergen", "1"]["reason"]


def test_a_lesson_is_shown_checked_and_exported(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["lesson", str(file)]) == 0
    assert "1. It repeats." in capsys.readouterr().out
    assert main(["lesson", str(file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["steps"] == [{**SMALL["steps"][0], "seed": 1}]
    assert main(["lesson", str(file), "--check", "--reduced", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["results"]) == 1
    assert main(["lesson", str(file), "--export", str(tmp_path / "out"), "--json"]) == 0
    page = json.loads(capsys.readouterr().out)["page"]
    assert page == str(tmp_path / "out" / "index.html")
    assert (tmp_path / "out" / "step-01-0.png").is_file()
    assert main(["lesson", str(file), "--check", "--reduced", "--export", str(tmp_path / "other")]) == 0
    said = capsys.readouterr().out
    assert "every step can be run" in said
    assert "index.html" in said


def test_what_cannot_be_used_is_said_in_one_sentence(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file.write_text(json.dumps({**SMALL, "steps": []}))
    assert main(["lesson", str(file)]) == 2
    assert "small.json cannot be used: steps" in capsys.readouterr().err
    assert main(["lesson", "custard"]) == 2
    assert "There is no lesson called 'custard'" in capsys.readouterr().err
