"""Completion in real shells, and the manual page as man reads it."""

from __future__ import annotations

import os
import re
import select
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from texlab.cli.main import build_parser
from texlab_core.engine.registry import methods

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

PATIENCE_S = 60
SHELLS = {
    "bash": ["bash", "--norc", "--noprofile", "-i"],
    "zsh": ["zsh", "-f", "-i"],
}
# What is typed (T is the tabulator), and the words that the shell then runs.
TYPED = [
    ("texlab batT", "batch"),
    ("texlab synth --methT", "synth --method"),
    ("texlab synth --method heeT", "synth --method heeger-bergen"),
    ("texlab methods deT", "methods de-bonet"),
    ("texlab synth gallery:structured-coffT", "synth gallery:structured-coffeebeans"),
    ("texlab batch gallT", "batch gallery:de-bonet-800"),
    ("texlab sweep --sweep efros-leung-shT", "sweep --sweep efros-leung-shapes"),
    ("texlab screenshot --theme lT", "screenshot --theme light"),
    ("texlab presets renT", "presets rename"),
    ("texlab synth my-picT", "synth my-picture.png"),
]


class Shell:
    """A shell on a terminal of its own."""

    def __init__(self, name: str, folder: Path) -> None:
        import pty

        self.pid, self.terminal = pty.fork()
        if not self.pid:
            os.chdir(folder)
            os.execvpe(SHELLS[name][0], SHELLS[name], {**os.environ, "PS1": "> ", "TERM": "dumb", "HISTFILE": ""})
        self.read = ""

    def type(self, text: str) -> None:
        os.write(self.terminal, text.encode())

    def wait_for(self, pattern: str) -> str:
        """Return what matched, after reading until it appears."""
        while not (found := re.search(pattern, self.read)):
            ready, _, _ = select.select([self.terminal], [], [], PATIENCE_S)
            assert ready, f"{pattern!r} never came: {self.read!r}"
            self.read += os.read(self.terminal, 65536).decode(errors="replace")
        self.read = self.read[found.end() :]
        return found[0]

    def close(self) -> None:
        os.close(self.terminal)
        os.kill(self.pid, 9)
        os.waitpid(self.pid, 0)


@pytest.fixture(params=SHELLS)
def shell(request: pytest.FixtureRequest, tmp_path: Path, texlab) -> Iterator[Shell]:
    if shutil.which(request.param) is None:
        pytest.skip(f"{request.param} is not installed")
    script = tmp_path / "completion"
    script.write_text(texlab("completion", request.param).out, "utf-8")
    (tmp_path / "my-picture.png").write_bytes(b"")
    opened = Shell(request.param, tmp_path)
    if request.param == "zsh":
        opened.type("autoload -U +X compinit && compinit -u -D\n")
    # What is run is shown; completion itself must not run anything.
    opened.type(f"source {script}; texlab() {{ printf '<%s>\\n' \"$*\"; }}; echo re''ady\n")
    opened.wait_for("ready")
    yield opened
    opened.close()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has neither shell")
def test_a_real_shell_completes(shell: Shell) -> None:
    for typed, wanted in TYPED:
        shell.type(typed.replace("T", "\t") + "\n")
        assert shell.wait_for("<[^>]*>").strip("<> ").replace(" >", ">").strip() == wanted


def test_every_command_and_option_is_in_the_script(texlab) -> None:
    for name in SHELLS:
        script = texlab("completion", name).out
        for command, parser in build_parser().commands.items():
            line = re.search(rf"^ +{command}\) values='?(.*?)'? ;;$", script, re.MULTILINE)
            assert line is not None, command
            options = {option for action in parser._actions for option in action.option_strings}
            assert {option for option in options if option.startswith("--")} <= set(line[1].split())


def test_the_page_says_everything(texlab) -> None:
    page = texlab("manpage").out
    plain = page.replace("\\-", "-").replace("\\fB", "").replace("\\fI", "").replace("\\fR", "")
    for command, parser in build_parser().commands.items():
        assert f"\n.SS texlab {command}\n" in plain
        for action in parser._actions:
            for option in action.option_strings:
                assert option in ("-h", "--help") or option in plain
    for code in (0, 1, 2, 130):
        assert f"\n.B {code}\n" in page
    for name in ("TEXLAB_HOME", "NO_COLOR", "defaults.toml"):
        assert name in page


@pytest.mark.skipif(shutil.which("groff") is None, reason="groff is not installed")
def test_man_reads_the_page_without_a_warning(texlab) -> None:
    page = texlab("manpage").out
    done = subprocess.run(
        ["groff", "-man", "-Tutf8", "-ww", "-P-c"], input=page, capture_output=True, text=True, check=False
    )
    assert done.stderr == ""
    shown = re.sub(".\b", "", done.stdout)
    assert "--method ID" in shown
    assert all(len(line) <= 200 for line in shown.splitlines())


def test_methods_of_the_moment_are_completed(texlab) -> None:
    script = texlab("completion", "bash").out
    found = re.search(r"synth:--method\) values='(.*)' ;;", script)
    assert found is not None
    assert found[1].split() == list(methods())
