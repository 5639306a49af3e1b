"""Build the program as a folder that needs no Python: ``python .ci/program.py`` makes dist/texlab.

A virtual environment of its own in build/program gets TexLab as a wheel and PyInstaller; so nothing of the
checkout and no test tool comes along. Then the program compiles its kernels once, and keeps the machine code in
its folder: on another kind of processor it compiles them anew.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "program"
DIST = ROOT / "dist"
# What PyInstaller's analysis would bring along, and the program never imports.
LEFT_OUT = ("tkinter", "matplotlib", "IPython", "pytest", "distributed", "dask", "pdoc")
ENTRY = """
import multiprocessing
import sys

if __name__ == "__main__":
    # The processes of a batch are this program again.
    multiprocessing.freeze_support()
    if sys.argv[1:] == ["--compile-kernels"]:
        from texlab_core.warming import warm_up

        warm_up()
        sys.exit(0)
    from texlab.cli.main import main

    sys.exit(main())
"""


def main() -> int:
    """Return the exit code of the first step that fails, or 0."""
    python = WORK / "env" / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if not python.exists():
        venv.create(WORK / "env", with_pip=True)
    pip = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    # Under another name than the package, which it would hide.
    entry = WORK / "entry" / "start_texlab.py"
    entry.parent.mkdir(parents=True, exist_ok=True)
    entry.write_text(ENTRY, "utf-8")
    options = ["--noconfirm", "--onedir", "--name", "texlab", "--distpath", str(DIST)]
    options += ["--workpath", str(WORK / "work"), "--specpath", str(WORK)]
    for name in LEFT_OUT:
        options += ["--exclude-module", name]
    steps = [
        [*pip, "--force-reinstall", "--no-deps", str(ROOT)],
        [*pip, f"{ROOT}[program]"],
        [str(python), "-P", "-m", "PyInstaller", *options, str(entry)],
    ]
    for step in steps:
        code = subprocess.run(step, cwd=WORK, check=False).returncode
        if code:
            return code
    program = DIST / "texlab" / ("texlab.exe" if os.name == "nt" else "texlab")
    shutil.copytree(ROOT / "resources" / "linux", DIST / "texlab" / "linux", dirs_exist_ok=True)
    # In a bare environment: nothing of this Python or this checkout may be needed.
    bare = {"PATH": os.defpath, "HOME": str(WORK), "TEXLAB_HOME": str(WORK / "home")}
    compiled = subprocess.run([str(program), "--compile-kernels"], env=bare, cwd=WORK, check=False).returncode
    if compiled:
        return compiled
    tried = [str(program), "synth", "gallery:structured-pebbles", "--method", "heeger-bergen", "--size", "64x64"]
    code = subprocess.run([*tried, "--out", str(WORK / "tried.png")], env=bare, cwd=WORK, check=False).returncode
    print(f"{program.parent}: {'does not run' if code else 'runs'}")
    return code


if __name__ == "__main__":
    sys.exit(main())
