"""TexLab in a notebook: short texts, pictures, progress, and results that are made when they are asked for."""

from __future__ import annotations

import base64
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from rich.console import Console

import texlab_core
from tests.core.toy import noise_method, stock
from texlab_core import progress as progress_module
from texlab_core.engine import registry
from texlab_core.engine.inputs import ArraysInput, Crop, DataInput
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.steps import Curve, Map, Output, Step
from texlab_core.errors import ImageError, InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image

IMAGE = np.linspace(0, 1, 40 * 30 * 3, dtype=np.float32).reshape(40, 30, 3)


@pytest.fixture(autouse=True)
def toy(monkeypatch: pytest.MonkeyPatch) -> None:
    stock(monkeypatch, registry._METHODS, noise_method())


def test_everything_with_arrays_has_a_short_repr() -> None:
    exemplar = as_exemplar(IMAGE, name="n" * 400, crop=Crop(0, 0, 20, 20))
    result = run(Job(method="toy-noise", inputs={"exemplar": exemplar}, size=(300, 400)))
    shown = [
        exemplar,
        exemplar.origin,
        result,
        result.job,
        Output(image=result.image),
        Map(np.zeros((300, 400), np.int32), "label", "Labels"),
        Curve.of(np.arange(1000), "Distance"),
        ArraysInput({"a": np.zeros((300, 400))}, "state"),
        DataInput(list(range(1000)), "code"),
        texlab_core.sweep(exemplar, "toy-noise", vary={"rounds": [1, 2]}),
    ]
    for each in shown:
        assert re.fullmatch(rf"<{type(each).__name__}: .+>", repr(each)), each
        assert len(repr(each)) < 200
    assert repr(result.job).endswith("..., 400 x 300, seed 0>")
    assert repr(as_exemplar(IMAGE, name="a")).startswith("<ImageInput: a, 30 x 40 pixels, colour, SHA-256 ")


@pytest.mark.parametrize("channels", [1, 3])
def test_a_result_shows_its_picture_and_numbers(channels: int) -> None:
    result = texlab_core.synthesize(IMAGE[..., :channels], "toy-noise", size=(5, 7), rounds=2)
    png = result._repr_png_()
    assert png is not None
    values = read_image(png, "picture").values
    wanted = np.rint(result.image.astype(np.float64) * 255)
    assert np.array_equal(values.reshape(wanted.shape), wanted)
    html = result._repr_html_()
    assert base64.b64encode(png).decode() in html
    assert 'width="7" height="5"' in html
    assert "<th>rounds</th><td>2</td>" in html
    assert f"<th>mean</th><td>{result.measures['mean']:.4g}</td>" in html
    assert "toy-noise on array, 7 x 5, seed 0, in " in html


def test_text_from_outside_stays_text() -> None:
    exemplar = as_exemplar(IMAGE, name="<script>")
    html = run(Job(method="toy-noise", inputs={"exemplar": exemplar}))._repr_html_()
    assert "<script>" not in html
    assert "&lt;script&gt;" in html
    series = texlab_core.sweep(exemplar, "toy-noise", vary={"seed": [1]})
    assert "<td>1</td>" in series._repr_html_()


def test_a_sweep_runs_what_is_asked_for() -> None:
    steps: list[Step] = []
    series = texlab_core.sweep(
        IMAGE,
        "toy-noise",
        vary={"rounds": [1, 2], "seed": [4, 5, 6]},
        size=(4, 5),
        spread=0.5,
        on_step=steps.append,
    )
    assert len(series) == 6
    assert steps == [], "nothing has run"
    assert [dict(each) for each in series.values] == [
        {"rounds": rounds, "seed": seed} for seed in (4, 5, 6) for rounds in (1, 2)
    ]
    alone = texlab_core.synthesize(IMAGE, "toy-noise", size=(4, 5), seed=5, rounds=2, spread=0.5)
    assert np.array_equal(series[3].image, alone.image)
    assert [step.phase for step in steps].count("analysis") == 2
    steps.clear()
    assert [result.job.seed for result in series[2:]] == [5, 5, 6, 6]
    assert "analysis" not in {step.phase for step in steps}, "what they share is analyzed once"
    assert [values["rounds"] for values, _ in series[:2].items()] == [1, 2]
    assert series[-1].job.seed == 6


def test_a_comparison_runs_what_is_asked_for() -> None:
    series = texlab_core.compare(IMAGE, ["toy-noise", "tiling"], size=(6, 6), seed=3)
    assert [dict(each) for each in series.values] == [
        {"method": "toy-noise", "seed": 3},
        {"method": "tiling", "seed": 4},
    ]
    assert series[1].image.shape == (6, 6, 3)
    assert len(texlab_core.compare(IMAGE)) == 4


def test_what_does_not_fit_is_refused_before_anything_runs() -> None:
    with pytest.raises(InputError, match="vary: must name"):
        texlab_core.sweep(IMAGE, "toy-noise", vary={})
    with pytest.raises(InputError, match="rounds: must be"):
        texlab_core.sweep(IMAGE, "toy-noise", vary={"rounds": [1, 99]})
    with pytest.raises(InputError, match="did you mean rounds"):
        texlab_core.sweep(IMAGE, "toy-noise", vary={"round": [1]})
    with pytest.raises(InputError, match="method: must be"):
        texlab_core.compare(IMAGE, ["nothing"])


@pytest.mark.parametrize("kind", ["uint8", "uint16", "uint32", "uint64"])
def test_unsigned_numbers_are_shares_of_their_largest(kind: str) -> None:
    top = np.iinfo(kind).max
    values = np.array([[0, top // 5, top], [top, 0, top // 3]], kind)
    assert np.allclose(as_exemplar(values).pixels[..., 0], values / float(top), rtol=0, atol=1e-7)


@pytest.mark.parametrize(
    "kind", ["int8", "int16", "int32", "int64", "float16", "float32", "float64", "longdouble"]
)
def test_other_numbers_are_taken_as_they_are_or_mapped(kind: str) -> None:
    inside = np.array([[0, 1, 0], [1, 0, 1]], kind)
    exemplar = as_exemplar(inside)
    assert np.array_equal(exemplar.pixels[..., 0], inside.astype(np.float32))
    assert exemplar.notes == ()
    outside = np.array([[-2, 0, 2], [6, 2, 0]], kind)
    mapped = as_exemplar(outside)
    assert np.allclose(mapped.pixels[..., 0], (outside.astype(np.float64) + 2) / 8, rtol=0, atol=1e-7)
    assert mapped.notes == ("Values from -2 to 6 were mapped to 0 to 1.",)


def test_bools_and_what_is_no_number() -> None:
    marks = np.eye(3, dtype=bool)
    assert np.array_equal(as_exemplar(marks).pixels[..., 0], marks)
    for kind in (complex, "U3", object):
        with pytest.raises(ImageError, match="the values must be bools, integers or floats"):
            as_exemplar(np.zeros((3, 3)).astype(kind))


def test_an_array_and_the_same_values_in_a_file_are_the_same_exemplar(tmp_path: Path) -> None:
    import tifffile

    rng = np.random.Generator(np.random.PCG64(1))
    for kind in ("uint8", "uint16", "uint32", "int16", "float32", "float64"):
        values = (rng.random((6, 7)) * 200 - (50 if kind[0] != "u" else 0)).astype(kind)
        tifffile.imwrite(tmp_path / "a.tif", values, photometric="minisblack")
        assert as_exemplar(values).sha256 == as_exemplar(tmp_path / "a.tif").sha256, kind


@dataclass
class Handle:
    """What a notebook gives for a display."""

    shown: list[str]

    def update(self, html: str) -> None:
        self.shown.append(html)


@pytest.fixture
def notebook(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    shown: list[str] = []

    def display(html: str, display_id: bool) -> Handle:
        assert display_id
        shown.append(html)
        return Handle(shown)

    ipython, inner = ModuleType("IPython"), ModuleType("IPython.display")
    ipython.get_ipython = lambda: SimpleNamespace(kernel=object())  # type: ignore[attr-defined]
    inner.HTML = str  # type: ignore[attr-defined]
    inner.display = display  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", inner)
    return shown


def test_a_notebook_gets_a_bar_that_goes_again(notebook: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress_module, "INTERVAL_S", -1.0)
    told: list[Step] = []
    result = texlab_core.synthesize(IMAGE, "toy-noise", size=(4, 4), progress=True, on_step=told.append)
    assert np.array_equal(result.image, texlab_core.synthesize(IMAGE, "toy-noise", size=(4, 4)).image)
    assert notebook[0] == 'Toy noise <progress value="0.000" max="1"></progress> 0% '
    assert notebook[-2] == 'Toy noise <progress value="1.000" max="1"></progress> 100% round 3'
    assert notebook[-1] == ""
    assert len(notebook) == 2 + len(told)


def test_a_notebook_is_not_flooded(notebook: list[str]) -> None:
    with texlab_core.progress_bar("<b>") as show:
        for done in range(1000):
            show(Step(done, 1000, "work"))
    assert len(notebook) < 100
    assert notebook[0].startswith("&lt;b&gt; <progress")


def test_a_terminal_gets_a_bar_and_a_file_none(monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    texlab_core.synthesize(IMAGE, "toy-noise", progress=True)
    assert capsys.readouterr().err == ""

    class Terminal:
        text = ""

        def isatty(self) -> bool:
            return True

        def write(self, text: str) -> None:
            self.text += text

        def flush(self) -> None:
            pass

    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    monkeypatch.setattr(
        "rich.console.Console",
        lambda stderr: Console(file=terminal, force_terminal=True, width=100),  # type: ignore[arg-type]
    )
    texlab_core.synthesize(IMAGE, "toy-noise", progress=True)
    assert "Toy noise" in terminal.text
    assert "100 %" in terminal.text


def test_type_checkers_see_the_types(tmp_path: Path) -> None:
    for package in ("texlab", "texlab_core"):
        assert (Path(texlab_core.__file__).parents[1] / package / "py.typed").is_file()
    (tmp_path / "use.py").write_text(
        "import texlab_core\n"
        "result = texlab_core.synthesize('a.png', size=(3, 4))\n"
        "reveal_type(result)\n"
        "reveal_type(texlab_core.sweep('a.png', vary={'seed': [1]}))\n",
        "utf-8",
    )
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--no-incremental", "--follow-imports=silent", "use.py"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={"MYPYPATH": str(Path(texlab_core.__file__).parents[1]), "PATH": ""},
        check=False,
    )
    assert "texlab_core.engine.result.Result" in done.stdout, done.stdout + done.stderr
    assert "texlab_core.series.Series" in done.stdout
