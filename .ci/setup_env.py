"""Prepare a checkout: system libraries, virtual environment, dependencies.

    python3 .ci/setup_env.py run|test|bench

With TEXLAB_LOCKED=1 it installs the versions of .ci/lock.txt and checks their hashes; without, or where
one of them cannot be had, the newest ones that pyproject.toml allows.

Standard library only, since nothing else is there yet. As root on Debian and its relatives it installs missing
system packages; otherwise it prints the one command that does, and exits with 2.
"""

from __future__ import annotations

import ctypes
import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / ".venv"
LOCK = ROOT / ".ci" / "lock.txt"
# How pip says that a file is not the one that was locked.
MISMATCH = "DO NOT MATCH THE HASHES"
EXTRAS = {"run": "", "test": "[test]", "bench": "[test,bench]"}
INCLUDED = {"run": ("run",), "test": ("run", "test"), "bench": ("run", "test", "bench")}

# Shared libraries that Qt loads, and the Debian packages that hold them.
QT_LIBRARIES = {
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libglib-2.0.so.0": "libglib2.0-0",
    "libfontconfig.so.1": "libfontconfig1",
    "libdbus-1.so.3": "libdbus-1-3",
}
X11_LIBRARIES = {
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
    "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-shape.so.0": "libxcb-shape0",
}
# Packages without which the goal is still reached in part.
OPTIONAL = frozenset({"xvfb"})


def main(goal: str) -> int:
    """Prepare for ``goal``; return the exit code."""
    if sys.version_info < (3, 11):  # noqa: UP036  (this file runs before anything checked the version)
        return refuse(f"TexLab needs Python 3.11 or later, and {sys.executable} is {sys.version.split()[0]}.")
    wanted = missing_packages(goal)
    if wanted and is_root() and shutil.which("apt-get"):
        apt_install(wanted)
        wanted = [name for name in missing_packages(goal) if name not in OPTIONAL]
        if wanted:
            return refuse(f"Still missing after apt-get install: {' '.join(wanted)}.")
    elif any(name not in OPTIONAL for name in wanted):
        return refuse(how_to_install(wanted))
    elif wanted:
        print(f"Without {' '.join(wanted)} the tests under a virtual X server are left out.", file=sys.stderr)
    try:
        python = make_venv()
    except subprocess.CalledProcessError:
        return refuse(f"The virtual environment {VENV} could not be made; the reason is above.")
    print(f"Installing TexLab and what it needs into {VENV.name} (once) ...", flush=True)
    pip = [str(python), "-m", "pip", "install", "--disable-pip-version-check", "--no-compile"]
    quiet = [] if sys.stdout.isatty() else ["--quiet"]
    wanted = ["--editable", f".{EXTRAS[goal]}"]
    if os.environ.get("TEXLAB_LOCKED") == "1":
        # Exactly what was tested, byte for byte; then TexLab itself, which asks for nothing more.
        locked = [*pip, *quiet, "--require-hashes", "--requirement", str(LOCK)]
        tried = subprocess.run(locked, cwd=ROOT, stderr=subprocess.PIPE, text=True, check=False)
        if tried.returncode and MISMATCH in tried.stderr:
            return refuse(f"{tried.stderr}A file has another hash than .ci/lock.txt says.")
        if tried.returncode:
            print(f"{tried.stderr}The locked versions cannot be had here; the newest are taken.", file=sys.stderr)
        else:
            wanted = ["--no-deps", "--editable", "."]
    done = subprocess.run([*pip, *quiet, *wanted], cwd=ROOT, check=False)
    if done.returncode:
        return refuse("pip could not install TexLab; its message is above.")
    compile_installed(python)
    for each in INCLUDED[goal]:
        (VENV / f".ready-{each}").touch()
    return 0


def missing_packages(goal: str) -> list[str]:
    """Return the Debian packages that the goal needs and that are not there."""
    if sys.platform != "linux":
        return []
    libraries = dict(QT_LIBRARIES)
    if goal != "run" or os.environ.get("DISPLAY") or is_root():
        libraries |= X11_LIBRARIES
    missing = [package for soname, package in libraries.items() if not loads(soname)]
    if goal != "run" and shutil.which("Xvfb") is None:
        missing.append("xvfb")
    if not has_pip_source():
        missing.append("python3-venv")
    return missing


def loads(soname: str) -> bool:
    """Return whether the dynamic linker finds a library."""
    try:
        ctypes.CDLL(soname)
    except OSError:
        return False
    return True


def has_pip_source() -> bool:
    """Return whether an environment with pip exists or can be made."""
    return (VENV / "bin" / "pip").exists() or any(
        map(importlib.util.find_spec, ("ensurepip", "pip", "virtualenv"))
    )


def apt_install(packages: list[str]) -> None:
    """Install Debian packages; only root can."""
    print(f"Installing system packages: {' '.join(packages)} ...", flush=True)
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    install = ["apt-get", "install", "-y", "-qq", "--no-install-recommends", *packages]
    for command in (["apt-get", "update", "-qq"], install):
        subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=False)


def how_to_install(packages: list[str]) -> str:
    """Return the sentence that names what to install."""
    if shutil.which("apt-get"):
        command = f"apt-get install -y --no-install-recommends {' '.join(packages)}"
        return f"Some system packages are missing; this installs them:\n\n    sudo {command}\n"
    sonames = {package: soname for soname, package in (QT_LIBRARIES | X11_LIBRARIES).items()}
    listed = ", ".join(sonames.get(package, package) for package in packages)
    return f"Install these with your system's package manager, then try again: {listed}."


def make_venv() -> Path:
    """Make the virtual environment unless a working one is there; return its Python."""
    python = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if works(python):
        return python
    if importlib.util.find_spec("ensurepip"):
        call("-m", "venv", "--clear", str(VENV))
    elif importlib.util.find_spec("pip"):
        call("-m", "venv", "--clear", "--without-pip", str(VENV))
        call("-m", "pip", "--python", str(python), "install", "--quiet", "pip")
    else:
        call("-m", "virtualenv", "--clear", str(VENV))
    return python


def compile_installed(python: Path) -> None:
    """Compile what was installed, on all cores; pip does it on one, with the tests of every package."""
    library = VENV / ("Lib" if os.name == "nt" else "lib")
    # What cannot be compiled is nobody's fault here: it says so to whoever imports it.
    command = [str(python), "-m", "compileall", "-qq", "-j", "0", "-x", r"[\\/]tests?[\\/]", str(library)]
    subprocess.run(command, stdin=subprocess.DEVNULL, check=False)


def works(python: Path) -> bool:
    """Return whether an interpreter starts and has pip."""
    if not python.exists():
        return False
    return subprocess.run([str(python), "-c", "import pip"], capture_output=True, check=False).returncode == 0


def call(*arguments: str) -> None:
    """Run this Python with arguments; a failure ends the program."""
    subprocess.run([sys.executable, *arguments], check=True)


def is_root() -> bool:
    """Return whether system packages may be installed."""
    return hasattr(os, "geteuid") and os.geteuid() == 0


def refuse(sentence: str) -> int:
    """Say why it cannot go on; return the exit code."""
    print(sentence, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
