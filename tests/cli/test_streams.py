"""Pictures through standard input and output, quiet, no colours, and defaults from a file."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.core.batch_tools import photos
from texlab.cli import piping
from texlab_core.documents.reading import read_recipe
from texlab_core.images.formats.reading import read_image

ROOT = Path(__file__).resolve().parents[2]
TILING = ("--method", "tiling", "--size", "20x12")


@pytest.fixture
def photo(tmp_path):
    photos(tmp_path / "in", 1)
    return tmp_path / "in" / "photo-0.png"


def piped(tmp_path, *arguments, given=b"", **environment):
    """Run ``texlab`` with bytes on standard input; return code, bytes and text."""
    paths = {"PYTHONPATH": str(ROOT), "TEXLAB_HOME": str(tmp_path / "texlab-home")}
    done = subprocess.run(
        [sys.executable, "-m", "texlab", *map(str, arguments)],
        input=given,
        capture_output=True,
        cwd=tmp_path,
        env={**os.environ, **paths, **environment},
        check=False,
    )
    return done.returncode, done.stdout, done.stderr.decode()


def test_a_picture_comes_in_and_goes_out(tmp_path, photo, texlab):
    code, out, err = piped(tmp_path, "synth", "-", *TILING, "--out", "-", given=photo.read_bytes())
    assert (code, err) == (0, "")
    assert texlab("synth", photo, *TILING, "--out", "a.png").code == 0
    wanted = read_image(Path("a.png"), "a").values
    assert np.array_equal(read_image(out, "piped").values, wanted)
    # What comes out carries its recipe, and can be piped on.
    (tmp_path / "b.png").write_bytes(out)
    assert read_recipe(tmp_path / "b.png").inputs["exemplar"].name == "standard input"
    code, again, err = piped(tmp_path, "redo", "-", "--out", "-", given=out)
    assert (code, err) == (0, "")
    assert np.array_equal(read_image(again, "piped").values, wanted)


@pytest.mark.skipif(os.name == "nt", reason="a shell of Windows closes no streams")
@pytest.mark.parametrize(
    ("closed", "words", "sentence"),
    [
        ("<&-", ("synth", "-"), "Standard input is closed, and an image is wanted from it."),
        (">&-", ("synth", "in/photo-0.png"), "Standard output is closed, and --out - writes to it."),
    ],
    ids=["input", "output"],
)
def test_a_closed_stream_is_one_sentence(tmp_path, photo, closed, words, sentence):
    done = subprocess.run(
        ["sh", "-c", f'exec "$@" {closed}', "sh", sys.executable, "-m", "texlab", *words, *TILING, "--out", "-"],
        capture_output=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TEXLAB_HOME": str(tmp_path / "texlab-home")},
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr.decode()) == (2, b"", f"texlab: {sentence}\n")


def test_a_further_input_comes_in_by_its_name(tmp_path, photo, texlab):
    words = ("synth", photo, "--method", "mixture", "--size", "20x12", "--set", "iterations=1")
    code, out, err = piped(tmp_path, *words, "--input", "second=-", "--out", "-", given=photo.read_bytes())
    assert (code, err) == (0, "")
    assert texlab(*words, "--input", f"second={photo}", "--out", "a.png").code == 0
    assert np.array_equal(read_image(out, "piped").values, read_image(Path("a.png"), "a").values)


@pytest.mark.parametrize("command", ["compare", "sweep"])
def test_sheets_are_piped_too(tmp_path, photo, command):
    more = {"compare": ["--methods", "tiling"], "sweep": ["--method", "tiling", "--vary", "seed=1,2"]}[command]
    code, out, err = piped(tmp_path, command, "-", *more, "--out", "-", given=photo.read_bytes())
    assert (code, err) == (0, "")
    assert read_image(out, "sheet").values.ndim == 3


def test_a_code_goes_out_as_text(tmp_path, photo):
    code, out, err = piped(tmp_path, "encode", "-", "--out", "-", given=photo.read_bytes())
    assert (code, err) == (0, "")
    assert out.startswith(b"{")


@pytest.mark.parametrize(
    ("words", "given", "sentence"),
    [
        (["synth", "-", *TILING, "--out", "a.png"], b"", "Nothing came from standard"),
        (["synth", "-", *TILING, "--out", "a.png"], b"junk", "texlab: standard input: is not an image"),
        (["synth", "in/photo-0.png", *TILING, "--out", "-", "--json"], b"", "both want standard output"),
        (["fill", "-", "--mask", "-", "--out", "a.png"], b"x", "only one of image and mask"),
        (["synth", "-", *TILING, "--input", "second=-", "--out", "a.png"], b"x", "only one of image and second"),
        (
            ["synth", "in/photo-0.png", *TILING, "--input", "second=-", "--out", "a.png"],
            b"",
            "Nothing came from standard",
        ),
        (["batch", "-", "--out", "out"], b"x", "A plan is a .json or .toml file"),
    ],
)
def test_what_cannot_be_piped_is_one_sentence(tmp_path, photo, words, given, sentence):
    code, out, err = piped(tmp_path, *words, given=given)
    assert (code, out) == (2, b"")
    assert sentence in err
    assert err.count("\n") == 1
    assert not (tmp_path / "a.png").exists()


def test_a_terminal_gets_no_picture(monkeypatch, texlab, photo, capsys):
    monkeypatch.setattr("sys.stdout.isatty", lambda: True, raising=False)
    shown = texlab("synth", photo, *TILING, "--out", "-")
    assert shown.code == 2
    assert "Standard output is a terminal" in shown.err


def test_endless_input_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr(piping, "MAX_BYTES", 10)
    code = (
        "import sys; from texlab.cli import main, piping; piping.MAX_BYTES = 10; sys.exit(main.main(sys.argv[1:]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, "synth", "-", *TILING, "--out", "a.png"],
        input=b"x" * 11,
        capture_output=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        check=False,
    )
    assert done.returncode == 2
    assert b"came from standard input, the most that is read" in done.stderr


def test_quiet_prints_errors_only(texlab, photo):
    assert texlab("synth", photo, *TILING, "--out", "a.png", "--quiet").out == ""
    assert Path("a.png").is_file()
    assert texlab("synth", photo, *TILING, "--out", "a.png", "--quiet", "--json").out.startswith("{")
    wrong = texlab("synth", "missing.png", *TILING, "--out", "a.png", "--quiet")
    assert (wrong.code, wrong.out) == (2, "")
    assert "missing.png" in wrong.err
    # The next command speaks again.
    assert texlab("synth", photo, *TILING, "--out", "a.png").out != ""


@pytest.mark.skipif(sys.platform == "win32", reason="needs a terminal of Unix")
@pytest.mark.parametrize(
    ("more", "environment", "bar", "colours"),
    [([], {}, True, True), ([], {"NO_COLOR": "1"}, True, False), (["--quiet"], {}, False, False)],
    ids=["plain", "no-colour", "quiet"],
)
def test_the_bar_has_colours_only_where_they_are_wanted(tmp_path, photo, more, environment, bar, colours):
    import pty

    terminal, end = pty.openpty()
    words = ["synth", str(photo), *TILING, "--out", "a.png", *more]
    clean = {
        name: value for name, value in os.environ.items() if name not in ("NO_COLOR", "FORCE_COLOR", "COLORTERM")
    }
    process = subprocess.Popen(
        [sys.executable, "-m", "texlab", *words],
        stdout=subprocess.PIPE,
        stderr=end,
        cwd=tmp_path,
        env={**clean, "PYTHONPATH": str(ROOT), "TERM": "xterm", **environment},
    )
    os.close(end)
    shown = b""
    try:
        while data := os.read(terminal, 65536):
            shown += data
    except OSError:
        pass  # Linux says so that the other end was closed.
    out, _ = process.communicate()
    os.close(terminal)
    assert process.returncode == 0
    assert (b"tiling" in shown.lower()) == bar
    assert (b"\x1b[3" in shown or b"\x1b[9" in shown) == colours
    assert (out == b"") == (more == ["--quiet"])


@pytest.fixture
def defaults(texlab_home):
    def write(text):
        (texlab_home / "config").mkdir(parents=True, exist_ok=True)
        (texlab_home / "config" / "defaults.toml").write_text(text, "utf-8")

    return write


def test_defaults_come_from_a_file_and_the_command_line_comes_first(texlab, photo, defaults):
    table = '[synth]\nmethod = "heeger-bergen"\nsize = "20x12"\nseed = 3\njson = true\n'
    defaults(table + 'set = ["iterations=2", "scales=2"]\n')
    import json

    made = json.loads(texlab("synth", photo, "--out", "a.png").out)
    assert (made["method"], made["size"], made["seed"]) == ("heeger-bergen", {"width": 20, "height": 12}, 3)
    assert (made["parameters"]["iterations"], made["parameters"]["scales"]) == (2, 2)
    other = json.loads(texlab("synth", photo, "--out", "a.png", "--seed", "4", "--set", "orientations=3").out)
    assert other["seed"] == 4
    assert (other["parameters"]["iterations"], other["parameters"]["orientations"]) == (2, 3)
    assert "parameters of Heeger-Bergen" in texlab("synth", "--help").out
    # Other commands are not touched.
    assert texlab("methods").code == 0


def test_a_default_gives_way_to_what_excludes_it(texlab, defaults):
    defaults("[batch]\nprocesses = 2\n")
    shown = texlab("batch", "plan.json", "--out", "out", "--cluster", "here")
    assert "cluster: must be an address" in shown.err


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[synth", "are not valid TOML"),
        ("[sinth]\n", "a table must be one of"),
        ("synth = 1\n", "a table must be one of"),
        ("[synth]\nsise = 1\n", "a default of texlab synth must be one of"),
        ("[synth]\nhelp = true\n", "a default of texlab synth must be one of"),
        ("[synth]\njson = 1\n", "json must be true or false"),
        ("[synth]\nseed = true\n", "seed must be a text or a number"),
        ("[synth]\nseed = 2020-01-01\n", "seed must be a text or a number"),
        ("#" * (2**20 + 1), "are longer than"),
        ('[synth]\nseed = "x"\n', "seed: must be a whole number"),
    ],
)
def test_wrong_defaults_are_one_sentence(texlab, photo, defaults, text, sentence):
    defaults(text)
    shown = texlab("synth", photo, *TILING, "--out", "a.png")
    assert shown.code == 2
    assert sentence in shown.err
    assert shown.err.count("\n") == 1


def test_defaults_that_cannot_be_read_are_said(texlab, photo, texlab_home):
    (texlab_home / "config" / "defaults.toml").mkdir(parents=True)
    shown = texlab("synth", photo, *TILING, "--out", "a.png")
    assert shown.code == 2
    assert "cannot be read" in shown.err


def test_the_exit_codes_are_in_the_help(texlab):
    shown = texlab("--help").out
    for code in (0, 1, 2, 130):
        assert f"\n  {code} " in shown
