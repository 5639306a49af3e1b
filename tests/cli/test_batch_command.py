"""``texlab batch``: what it makes, what it says, and what it refuses before any work."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from rich.console import Console

from tests.core.batch_tools import photos
from texlab.cli.commands import _progress
from texlab_core.batch.running import Progress


@pytest.fixture
def plan(texlab):
    photos(Path("in"))
    data = {"inputs": ["in/*.png"], "methods": ["tiling"], "seeds": [1, 2], "sizes": ["20x12"]}
    Path("plan.json").write_text(json.dumps(data), "utf-8")
    return "plan.json"


def test_it_makes_what_the_plan_says_and_goes_on(texlab, plan):
    first = texlab("batch", plan, "--out", "out", "--processes", 1)
    assert (first.code, first.err) == (0, "")
    assert first.out.splitlines()[0].startswith("6 textures in ")
    assert first.out.splitlines()[1:] == [str(Path("out/index.html")), str(Path("out/report.csv"))]
    assert len(list(Path("out/pictures").iterdir())) == 6
    again = texlab("batch", plan, "--out", "out", "--processes", 1, "--json")
    answer = json.loads(again.out)
    assert (answer["plan"], answer["jobs"], answer["made"], answer["found"]) == ("plan", 6, 0, 6)
    assert answer["failures"] == []


def test_a_sample_in_two_processes(texlab, plan):
    done = texlab("batch", plan, "--out", "out", "--processes", 2, "--sample", 3, "--json")
    assert json.loads(done.out)["made"] == 3


def test_what_fails_is_said_at_once_and_in_the_exit_code(texlab, plan):
    Path("in/photo-1.png").write_bytes(b"no image")
    done = texlab("batch", plan, "--out", "out", "--processes", 1, "--json")
    answer = json.loads(done.out)
    assert done.code == 2
    assert (answer["made"], answer["failed"]) == (4, 2)
    assert [each["job"] for each in answer["failures"]] == [
        f"in/photo-1.png, tiling, 20x12, seed {seed}" for seed in (1, 2)
    ]
    said = done.err.splitlines()
    assert said[0].startswith("texlab: in/photo-1.png: is not an image")
    assert said[-1].startswith("texlab: 2 of 6 jobs failed; ")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["missing.json"], "The plan missing.json cannot be read (No such file or directory)."),
        (["plan.json", "--sample", "0"], "sample: must be a whole number from 1, got 0."),
        (["plan.json", "--sample", "x"], "sample: must be a whole number, got 'x'."),
        (["plan.json", "--processes", "0"], "processes: must be a whole number from 1 to 256, got 0."),
        (["plan.json", "--cluster", "here"], "cluster: must be an address as in tcp://host:8786"),
        (["plan.json", "--cluster", "local:1", "--processes", "1"], "not allowed with argument --cluster"),
        (["gallery:nothing"], "There is no plan called gallery:nothing"),
    ],
)
def test_what_is_refused(texlab, plan, words, sentence):
    done = texlab("batch", *words, "--out", "out")
    assert done.code == 2
    assert sentence in done.err
    assert not Path("out").exists()


def test_the_bar_says_how_long_it_will_take(monkeypatch):
    class Terminal:
        def isatty(self):
            return True

        def write(self, text):
            self.text = getattr(self, "text", "") + text

        def flush(self):
            pass

    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr(
        "rich.console.Console", lambda stderr: Console(file=terminal, force_terminal=True, width=120)
    )
    with _progress.batch_bar("Batch") as show:
        show(Progress(9, 0, 20, None))
        show(Progress(10, 1, 20, 125.0, "in/a.png: is no image."))
    assert "in/a.png: is no image." in terminal.text
    assert "11 of 20, 1 failed" in terminal.text
    assert "2 min left" in terminal.text


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.2, "1 s"), (89, "89 s"), (150, "2 min"), (5900, "98 min"), (6600, "1 h 50 min")]
)
def test_times_as_people_say_them(seconds, words):
    assert _progress.spoken(seconds) == words
