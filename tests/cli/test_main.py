"""Discovery, help, exit codes and errors of the command line."""

from __future__ import annotations

import json
import os
import pkgutil
import re
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import pytest

import texlab.cli.commands
from texlab.cli import main as cli
from texlab.cli.commands._knobs import knobs
from texlab.cli.main import find_commands
from texlab_core.engine.params import describe
from texlab_core.engine.registry import methods
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.version import __version__

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

    from tests.cli.conftest import Texlab
    from texlab.cli.parser import Parser

HEAVY = ("PySide6", "shiboken6", "pyqtgraph", "numba", "scipy", "cv2", "PIL", "rich", "tifffile")


def test_every_file_of_commands_is_a_command() -> None:
    files = {
        each.name for each in pkgutil.iter_modules(texlab.cli.commands.__path__) if not each.name.startswith("_")
    }
    found = find_commands()
    assert set(found) == {name.replace("_", "-") for name in files}
    assert {"gui", "synth", "redo", "methods", "gallery", "screenshot"} <= set(found)
    assert [command.ORDER for command in found.values()] == sorted(command.ORDER for command in found.values())
    assert all(command.HELP.endswith(".") for command in found.values())


def test_help_lists_every_command(texlab: Texlab) -> None:
    shown = texlab("--help")
    assert shown.code == 0
    for name in find_commands():
        assert re.search(rf"^    {name}\s", shown.out, re.MULTILINE)


@pytest.mark.parametrize("name", find_commands())
def test_every_command_has_help(texlab: Texlab, name: str) -> None:
    shown = texlab(name, "--help")
    assert shown.code == 0
    assert f"texlab {name}" in shown.out
    assert shown.err == ""


def test_version(texlab: Texlab) -> None:
    assert texlab("--version").out == f"texlab {__version__}\n"


@pytest.mark.parametrize(
    "arguments",
    [
        ["sing"],
        ["--loud"],
        ["synth"],
        ["synth", "--size"],
        ["screenshot"],
        ["methods", "--jso"],
        ["redo", "a", "b"],
    ],
)
def test_a_wrong_command_line_gets_one_sentence_and_a_hint(texlab: Texlab, arguments: list[str]) -> None:
    shown = texlab(*arguments)
    assert shown.code == 2
    assert shown.out == ""
    assert shown.err.count("\n") == 1
    assert shown.err.endswith(" --help.\n")


class Failing:
    """A command that raises."""

    HELP = "Fail."
    ORDER = 1

    def __init__(self, error: BaseException) -> None:
        self.error = error

    def configure(self, parser: Parser) -> None:
        parser.add_argument("--json", action="store_true")

    def execute(self, args: argparse.Namespace) -> int:
        raise self.error


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (InputError("No."), 2, "texlab: No.\n"),
        (ParamError("seed", "small", 9), 2, "texlab: seed: must be small, got 9.\n"),
        (
            FileNotFoundError(2, "No such file or directory", "a.png"),
            2,
            "texlab: a.png: No such file or directory.\n",
        ),
        (
            OSError(28, "No space left on device"),
            2,
            "texlab: Standard output cannot be written: No space left on device.\n",
        ),
        (MemoryError(), 2, "texlab: There is not enough memory for this; try a smaller size.\n"),
        (KeyboardInterrupt(), 130, ""),
        (Cancelled(), 130, ""),
    ],
)
def test_errors_become_one_sentence_and_an_exit_code(
    texlab: Texlab, monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int, said: str
) -> None:
    monkeypatch.setattr(cli, "find_commands", lambda names: {"fail": Failing(error)})
    shown = texlab("fail", "--json")
    assert (shown.code, shown.out, shown.err) == (code, "", said)


def test_an_unexpected_error_is_logged_and_said_in_one_sentence(
    texlab: Texlab, monkeypatch: pytest.MonkeyPatch, texlab_home: Path
) -> None:
    # An OSError without a number comes from a library, not from the system.
    for error in (ZeroDivisionError("one\ntwo"), OSError("one two")):
        monkeypatch.setattr(cli, "find_commands", lambda names, error=error: {"fail": Failing(error)})
        shown = texlab("fail")
        log = texlab_home / "log" / "texlab.log"
        assert shown.code == 1
        what = f"Something unexpected happened ({type(error).__name__}: one two)"
        assert shown.err == f"texlab: {what}; the details are in {log}.\n"
    assert "Traceback" in log.read_text("utf-8")
    assert "Traceback" not in shown.err


def test_a_log_that_cannot_be_written_is_said_too(
    texlab: Texlab, monkeypatch: pytest.MonkeyPatch, texlab_home: Path
) -> None:
    texlab_home.write_text("in the way")
    monkeypatch.setattr(cli, "find_commands", lambda names: {"fail": Failing(ZeroDivisionError("x"))})
    shown = texlab("fail")
    assert shown.code == 1
    assert "could not be written" in shown.err
    assert shown.err.count("\n") == 1


def python(code: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run code in a new process without a display."""
    without = {name: value for name, value in os.environ.items() if name not in _DISPLAYS}
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True,
        text=True,
        encoding="utf-8",
        env=without | environment,
        check=False,
    )


_DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")


@pytest.mark.parametrize(
    "arguments",
    [["--help"], ["--version"], ["synth", "--help"], ["methods"], ["methods", "--json"], ["gallery", "--json"]],
    ids=" ".join,
)
def test_asking_imports_nothing_heavy(arguments: list[str]) -> None:
    code = (
        "import sys\nfrom texlab.cli.main import main\ncode = main(sys.argv[1:])\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules], file=sys.stderr)\nsys.exit(code)"
    )
    done = python(code, *arguments)
    assert done.returncode == 0
    assert done.stderr == "[]\n"


@pytest.mark.parametrize(
    ("arguments", "commands"),
    [(["--version"], []), (["synth", "--help"], ["synth"]), (["gallery", "--json"], ["gallery"])],
    ids=lambda value: " ".join(value),
)
def test_only_the_command_that_is_named_is_imported(arguments: list[str], commands: list[str]) -> None:
    code = (
        "import sys\nfrom texlab.cli.main import main\nmain(sys.argv[1:])\n"
        "names = sorted(name.removeprefix('texlab.cli.commands.') for name in sys.modules "
        "if name.startswith('texlab.cli.commands.') and '._' not in name)\n"
        "heavy = [name for name in ('numpy', 'texlab_core.engine.registry') if name in sys.modules]\n"
        "print(names, heavy, file=sys.stderr)"
    )
    assert python(code, *arguments).stderr == f"{commands} []\n"


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a display")
def test_without_a_display_the_window_is_refused_and_qt_not_imported() -> None:
    call = "import sys\nfrom texlab.cli.main import main\ncode = main([])\n"
    done = python(call + "assert 'PySide6' not in sys.modules\nsys.exit(code)")
    assert done.returncode == 2
    assert done.stderr.startswith("texlab: There is no display to open a window on; ")
    assert done.stderr.count("\n") == 1


def test_what_a_terminal_cannot_print_does_not_fail() -> None:
    done = python(
        "from texlab.cli.main import main; import sys; sys.exit(main(['gallery']))", PYTHONIOENCODING="ascii"
    )
    assert done.returncode == 0
    assert r"Ram\xf3n" in done.stdout


@pytest.mark.skipif(os.name == "nt", reason="pipes of a shell")
def test_a_reader_that_goes_away_is_no_error() -> None:
    gallery = [sys.executable, "-m", "texlab", "gallery"]
    with subprocess.Popen(gallery, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        errors = process.stderr.read()
    assert errors == b""
    assert process.returncode == 0


def test_methods_lists_every_method(texlab: Texlab) -> None:
    shown = texlab("methods")
    assert shown.code == 0
    for line, method in zip(shown.out.splitlines(), methods().values(), strict=True):
        assert line.startswith(method.id)
        assert method.summary in line
    as_json = json.loads(texlab("methods", "--json").out)
    assert [each["id"] for each in as_json] == list(methods())


@pytest.mark.parametrize("name", list(methods()))
def test_methods_shows_every_parameter_of_one_with_the_defaults_of_params(texlab: Texlab, name: str) -> None:
    method = methods()[name]
    as_json = json.loads(texlab("methods", name, "--json").out)
    assert {each["name"]: each["default"] for each in as_json["parameters"]} == method.params().to_json()
    shown = texlab("methods", name).out
    listed = knobs(method) + "\n"
    assert shown.endswith(listed)
    assert texlab("synth", "--method", name, "--help").out.endswith(listed)
    assert texlab("synth", "--help", f"--method={name}").out.endswith(listed)
    for field in describe(method.params):
        assert f"\n  {field.name}=" in shown
        for choice, about in field.knob.choices.items():
            assert choice in shown
            assert about in shown


def test_an_unknown_method_is_named(texlab: Texlab) -> None:
    shown = texlab("methods", "no-such-method")
    assert (shown.code, shown.out) == (2, "")
    assert "no-such-method" in shown.err


def test_gallery_lists_every_texture_under_its_class(texlab: Texlab) -> None:
    shown = texlab("gallery")
    assert shown.code == 0
    listed = json.loads(texlab("gallery", "--json").out)
    assert len(listed) == 58
    assert all(f"  {each['uri']} " in shown.out for each in listed)
    assert shown.out.count("\n\n") == len({each["class"] for each in listed}) - 1


def test_the_entry_point_of_the_window_takes_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Any] = []
    monkeypatch.setattr(cli, "main", lambda arguments: seen.append(arguments) or 0)
    monkeypatch.setattr(sys, "argv", ["texlab-gui", "wall.png"])
    assert cli.main_gui() == 0
    assert seen == [["gui", "wall.png"]]


def test_a_file_or_a_texture_alone_opens_the_window(
    texlab: Texlab, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    from texlab.app import start as app

    opened: list[str | None] = []
    monkeypatch.setattr(app, "run_gui", lambda image: opened.append(image) or 0)
    photo = tmp_path / "wall.png"
    photo.write_bytes(b"")
    assert texlab(str(photo)).code == 0
    assert texlab("gallery:oriented-zebra").code == 0
    assert opened == [str(photo), "gallery:oriented-zebra"]
    assert texlab(str(tmp_path / "gone.png")).code == 2
    assert len(opened) == 2
