"""What the set-up script installs, and what it says where it may not."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from types import ModuleType

REALLY = subprocess.run
SCRIPT = Path(__file__).resolve().parents[2] / ".ci" / "setup_env.py"
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="system packages are installed on Linux only")


@pytest.fixture
def setup_env(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The script on a machine that has nothing, as an ordinary user; no command is really run."""
    spec = importlib.util.spec_from_file_location("setup_env", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    commands: list[list[str]] = []

    def run(command: list[str], **_: Any) -> SimpleNamespace:
        commands.append(command)
        return SimpleNamespace(returncode=0)

    monkeypatch.setattr(module, "VENV", tmp_path)
    monkeypatch.delenv("TEXLAB_LOCKED", raising=False)
    monkeypatch.setattr(module, "loads", lambda soname: False)
    monkeypatch.setattr(module, "is_root", lambda: False)
    monkeypatch.setattr(module.shutil, "which", lambda name: "/usr/bin/apt-get" if name == "apt-get" else None)
    monkeypatch.setattr(module.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(module.subprocess, "run", run)
    monkeypatch.delenv("DISPLAY", raising=False)
    module.commands = commands  # type: ignore[attr-defined]
    return module


def installs(setup_env: ModuleType) -> list[list[str]]:
    """Return what pip was asked for."""
    return [command for command in setup_env.commands if command[1:4] == ["-m", "pip", "install"]]


def test_an_ordinary_user_is_told_the_one_command(
    setup_env: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    assert setup_env.main("test") == 2
    said = capsys.readouterr().err
    packages = {*setup_env.QT_LIBRARIES.values(), *setup_env.X11_LIBRARIES.values(), "xvfb", "python3-venv"}
    (command,) = [line for line in said.splitlines() if "apt-get install" in line]
    assert command.strip().startswith("sudo apt-get install -y")
    assert packages <= set(command.split())
    assert setup_env.commands == []


def test_without_apt_the_libraries_are_named(
    setup_env: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(setup_env.shutil, "which", lambda name: None)
    assert setup_env.main("run") == 2
    said = capsys.readouterr().err
    assert all(soname in said for soname in setup_env.QT_LIBRARIES)
    assert said.count("\n") == 1


def test_root_installs_and_is_told_when_that_was_in_vain(
    setup_env: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(setup_env, "is_root", lambda: True)
    assert setup_env.main("run") == 2
    update, install = setup_env.commands
    assert update[:2] == ["apt-get", "update"]
    assert {"libgl1", "libxcb-cursor0", "python3-venv"} <= set(install)
    assert capsys.readouterr().err.startswith("Still missing after apt-get install: libgl1 ")


def test_a_virtual_x_server_is_welcome_but_not_needed(
    setup_env: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(setup_env, "loads", lambda soname: True)
    monkeypatch.setattr(setup_env.importlib.util, "find_spec", lambda name: True)
    assert setup_env.main("test") == 0
    assert capsys.readouterr().err.startswith("Without xvfb the tests")
    assert installs(setup_env)[-1][-2:] == ["--editable", ".[test]"]
    assert (setup_env.VENV / ".ready-test").exists()
    assert (setup_env.VENV / ".ready-run").exists()


@pytest.fixture
def locked(setup_env: ModuleType, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The script on a machine that has everything, asked for the locked versions."""
    monkeypatch.setattr(setup_env, "loads", lambda soname: True)
    monkeypatch.setattr(setup_env.importlib.util, "find_spec", lambda name: True)
    monkeypatch.setenv("TEXLAB_LOCKED", "1")
    return setup_env


def test_locked_versions_are_installed_with_their_hashes(locked: ModuleType) -> None:
    assert locked.main("test") == 0
    versions, own = installs(locked)
    assert versions[-3:] == ["--require-hashes", "--requirement", str(locked.LOCK)]
    assert own[-3:] == ["--no-deps", "--editable", "."]


@pytest.mark.parametrize(
    ("said", "code", "last"),
    [
        ("ERROR: THESE PACKAGES DO NOT MATCH THE HASHES\n", 2, "--requirement"),
        ("ERROR: No matching distribution found\n", 0, "--editable"),
    ],
)
def test_a_wrong_hash_is_refused_and_a_missing_version_replaced(
    locked: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: Any, said: str, code: int, last: str
) -> None:
    def run(command: list[str], **_: Any) -> SimpleNamespace:
        locked.commands.append(command)
        return SimpleNamespace(returncode=int("--require-hashes" in command), stderr=said)

    monkeypatch.setattr(locked.subprocess, "run", run)
    assert locked.main("test") == code
    assert last in installs(locked)[-1]
    assert said.strip() in capsys.readouterr().err


def test_only_a_window_needs_the_libraries_of_x11(setup_env: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "libxcb-cursor0" not in setup_env.missing_packages("run")
    monkeypatch.setenv("DISPLAY", ":0")
    assert "libxcb-cursor0" in setup_env.missing_packages("run")


def test_what_is_installed_is_compiled_on_all_cores_but_for_the_tests_of_others(
    setup_env: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(setup_env.subprocess, "run", REALLY)
    packages = setup_env.VENV / "lib" / "python3" / "site-packages"
    for name in ("one/__init__.py", "one/tests/test_one.py", "two/test/here.py", "two/testing/here.py", "odd.py"):
        path = packages / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("1 +" if name == "odd.py" else "value = 1\n")
    setup_env.compile_installed(Path(sys.executable))
    compiled = {path.parent.parent.name + "/" + path.name.split(".")[0] for path in packages.rglob("*.pyc")}
    assert compiled == {"one/__init__", "testing/here"}


def test_pip_leaves_compiling_to_it(locked: ModuleType) -> None:
    assert locked.main("test") == 0
    assert all("--no-compile" in command for command in installs(locked))
    assert locked.commands[-1][2:4] == ["compileall", "-qq"]
