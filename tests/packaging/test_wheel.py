"""The wheel holds everything, and works from another folder, unpacked or still zipped."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = {"texlab": "texlab", "texlab_core": "texlab_core", "resources": "texlab_resources"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "pip", "wheel", str(ROOT), "--no-deps", "--no-build-isolation", "--no-index"]
    done = subprocess.run([*command, "--wheel-dir", str(folder)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    (made,) = folder.glob("texlab-*.whl")
    return made


def test_it_holds_every_file_and_no_other(wheel: Path) -> None:
    wanted = {
        f"{package}/{path.relative_to(ROOT / folder).as_posix()}"
        for folder, package in PACKAGES.items()
        for path in (ROOT / folder).rglob("*")
        if path.is_file() and not {"__pycache__", ".DS_Store"} & set(path.parts)
    }
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    held = {name for name in names if ".dist-info/" not in name}
    assert held == wanted
    assert "texlab_resources/gallery/SOURCES.tsv" in held
    assert any(name.endswith(".dist-info/licenses/LICENSE") for name in names)


def run_from(place: Path, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run ``texlab`` as found in ``place``, in another folder."""
    code = (
        "import sys, texlab_core, texlab.cli.main\n"
        f"assert texlab_core.__file__.startswith({str(place)!r}), texlab_core.__file__\n"
        "sys.exit(texlab.cli.main.main(sys.argv[1:]))"
    )
    environment = os.environ | {"PYTHONPATH": str(place), "NUMBA_CACHE_DIR": str(folder / "numba")}
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True,
        text=True,
        encoding="utf-8",
        cwd=folder,
        env=environment,
        check=False,
    )


@pytest.mark.slow
@pytest.mark.parametrize("zipped", [False, True], ids=["unpacked", "zipped"])
def test_it_works_from_another_folder(wheel: Path, tmp_path: Path, zipped: bool) -> None:
    place = wheel
    if not zipped:
        place = tmp_path / "site"
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(place)
    listed = run_from(place, tmp_path, "gallery", "--json")
    assert listed.returncode == 0, listed.stderr
    assert len(json.loads(listed.stdout)) == 58
    made = run_from(
        place,
        tmp_path,
        *("synth", "gallery:structured-pebbles", "--method", "heeger-bergen", "--out", "a.png"),
        *("--size", "64x48", "--crop", "64x64+0+0", "--json"),
    )
    assert made.returncode == 0, made.stderr
    assert json.loads(made.stdout)["method"] == "heeger-bergen"
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
