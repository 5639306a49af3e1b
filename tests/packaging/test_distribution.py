"""What is published besides the wheel: lock file, source archive, desktop files, icons, citation, hosted CI."""

from __future__ import annotations

import configparser
import importlib.metadata
import io
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name
from packaging.version import Version
from PIL import Image

import texlab_core
from texlab.cli.main import build_parser
from texlab_core.batch.plan import bundled_plans
from texlab_core.engine import registry, run
from texlab_core.images.formats.reading import READABLE_SUFFIXES

ROOT = Path(__file__).resolve().parents[2]
LINUX = ROOT / "resources" / "linux"
ICONS = ROOT / "resources" / "icons"


def project() -> dict[str, Any]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


def locked() -> dict[str, list[tuple[Version, str]]]:
    """Return the versions in the lock file by package, with the conditions under which each is meant."""
    text = (ROOT / ".ci" / "lock.txt").read_text("utf-8").replace("\\\n", " ")
    found: dict[str, list[tuple[Version, str]]] = {}
    for line in text.splitlines():
        requirement = Requirement(line.partition("--hash")[0].strip())
        (specifier,) = requirement.specifier
        assert specifier.operator == "=="
        marker = str(requirement.marker or "")
        found.setdefault(canonicalize_name(requirement.name), []).append((Version(specifier.version), marker))
    return found


def test_everything_in_the_lock_file_has_hashes_and_no_address() -> None:
    text = (ROOT / ".ci" / "lock.txt").read_text("utf-8")
    assert "//" not in text
    for block in text.replace("\\\n", " ").splitlines():
        assert re.search(r"--hash=sha256:[0-9a-f]{64}", block), block


def test_the_lock_file_fits_what_the_program_asks_for() -> None:
    versions = locked()
    extras = project()["optional-dependencies"]
    for text in [*project()["dependencies"], *extras["test"], *extras["cluster"]]:
        requirement = Requirement(text)
        found = versions[canonicalize_name(requirement.name)]
        assert all(version in requirement.specifier for version, _ in found), text


def test_what_broke_with_a_major_version_has_an_upper_bound() -> None:
    bounds = {Requirement(text).name: Requirement(text).specifier for text in project()["dependencies"]}
    for name, first_refused in {
        "opencv-contrib-python-headless": "6",
        "numpy": "3",
        "PySide6-Essentials": "6.12",
        "pyqtgraph": "0.15",
    }.items():
        assert Version(first_refused) not in bounds[name]
        assert isinstance(bounds[name], SpecifierSet)


def test_recipes_record_what_the_bits_depend_on(monkeypatch: pytest.MonkeyPatch) -> None:
    assert set(run.versions()) == {"python", "texlab", *run.LIBRARIES}
    assert "unknown" not in run.versions().values()
    assert run.versions()["llvmlite"] == importlib.metadata.version("llvmlite")
    # Methods that were compiled or computed with a library of their own name it by their package.
    method = registry.methods()["tiling"]
    import dataclasses

    other = dataclasses.replace(method, package="pytest")
    assert run.versions_for(method) == run.versions()
    assert run.versions_for(other) == {**run.versions(), "pytest": importlib.metadata.version("pytest")}
    missing = dataclasses.replace(method, package="no-such-package")
    assert run.versions_for(missing)["no-such-package"] == "unknown"


@pytest.mark.slow
def test_the_source_archive_makes_the_same_wheel(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "hatchling", "build", "--target", "sdist", "--directory", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    (archive,) = tmp_path.glob("texlab-*.tar.gz")
    with tarfile.open(archive) as tar:
        names = {name.partition("/")[2] for name in tar.getnames()}
    for wanted in (
        *("LICENSE", "README.md", "CITATION.cff", "Makefile", "pyproject.toml", ".ci/setup_env.py"),
        *("texlab/py.typed", "texlab_core/py.typed", ".ci/lock.txt", "resources/docs/template/pyproject.toml"),
        *("resources/gallery/SOURCES.tsv", "resources/icons/texlab.svg", "resources/linux/texlab.desktop"),
        *("resources/batches/de-bonet-800.json", "tests/packaging/test_distribution.py"),
    ):
        assert wanted in names, wanted
    assert not any("__pycache__" in name or name.startswith((".venv", "build/", "dist/")) for name in names)


def test_the_desktop_entry_names_what_exists() -> None:
    entry = configparser.ConfigParser(interpolation=None)
    entry.optionxform = str  # type: ignore[assignment, method-assign]
    entry.read(LINUX / "texlab.desktop", "utf-8")
    main = entry["Desktop Entry"]
    assert main["Exec"] == "texlab-gui %f"
    assert main["TryExec"] in project()["gui-scripts"]
    assert (ICONS / f"{main['Icon']}.svg").is_file()
    assert main["StartupWMClass"] == "texlab"
    kinds = [kind for kind in main["MimeType"].split(";") if kind]
    suffixes = {
        *(["image/png", "image/jpeg", "image/tiff", "image/webp", "image/bmp"]),
        *(["image/x-portable-graymap", "image/x-portable-pixmap"]),
    }
    assert suffixes < set(kinds)
    assert {".png", ".jpg", ".tif", ".webp", ".bmp", ".pgm", ".ppm"} <= set(READABLE_SUFFIXES)
    own = ET.parse(LINUX / "texlab-mime.xml").getroot()
    space = "{http://www.freedesktop.org/standards/shared-mime-info}"
    (kind,) = own.iter(f"{space}mime-type")
    assert kind.get("type") in kinds
    (glob,) = own.iter(f"{space}glob")
    assert glob.get("pattern") == "*.msg.json"


def test_the_metainfo_fits_the_desktop_entry() -> None:
    info = ET.parse(LINUX / "texlab.metainfo.xml").getroot()
    assert info.get("type") == "desktop-application"
    assert info.findtext("launchable") == "texlab.desktop"
    assert info.findtext("project_license") == project()["license"]
    binaries = {each.text for each in info.iter("binary")}
    assert binaries == {*project()["scripts"], *project()["gui-scripts"]}


@pytest.mark.skipif(sys.platform == "win32", reason="a script for the shell")
def test_the_desktop_files_are_installed_where_they_belong(tmp_path: Path) -> None:
    program = tmp_path / "bin" / "texlab"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m texlab "$@"\n', "utf-8")
    program.chmod(0o755)
    bare = {**os.environ, "PATH": f"{program.parent}:/usr/bin:/bin", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        ["sh", str(LINUX / "install.sh"), str(tmp_path)], env=bare, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    for wanted in (
        *("applications/texlab.desktop", "mime/packages/texlab.xml", "metainfo/texlab.metainfo.xml"),
        *("icons/hicolor/scalable/apps/texlab.svg", "icons/hicolor/256x256/apps/texlab.png"),
        "man/man1/texlab.1",
    ):
        assert (tmp_path / wanted).is_file(), wanted
    if shutil.which("desktop-file-validate"):
        subprocess.run(["desktop-file-validate", str(tmp_path / "applications/texlab.desktop")], check=True)


@pytest.mark.parametrize("size", [32, 64, 256])
def test_the_icons_are_the_drawing(size: int) -> None:
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from PySide6.QtCore import QBuffer
    from PySide6.QtGui import QImage, QPainter
    from PySide6.QtSvg import QSvgRenderer

    drawn = QImage(size, size, QImage.Format.Format_ARGB32)
    drawn.fill(0)
    painter = QPainter(drawn)
    QSvgRenderer(str(ICONS / "texlab.svg")).render(painter)
    painter.end()
    buffer = QBuffer()
    drawn.save(buffer, "PNG")
    wanted = np.asarray(Image.open(io.BytesIO(bytes(buffer.data().data()))).convert("RGBA"), np.float64)
    stored = np.asarray(Image.open(ICONS / f"texlab-{size}.png").convert("RGBA"), np.float64)
    assert stored.shape == (size, size, 4)
    assert np.abs(stored - wanted).mean() < 4, "run make icons"


def test_the_citation_names_this_version() -> None:
    found = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert found["version"] == texlab_core.__version__
    assert found["license"] == project()["license"]
    assert found["title"].startswith("TexLab")
    years = [each["year"] for each in found["references"]]
    assert years == [1995, 1997, 1999, 1996]


def test_hosted_ci_calls_what_a_checkout_calls() -> None:
    flow = yaml.safe_load((ROOT / ".github" / "workflows" / "test.yml").read_text("utf-8"))
    matrix = flow["jobs"]["newest"]["strategy"]["matrix"]
    assert matrix["os"] == ["ubuntu-latest", "macos-latest", "windows-latest"]
    assert matrix["python"] == ["3.11", "3.12", "3.13"]
    assert all(Version(f"{each}.0") in SpecifierSet(project()["requires-python"]) for each in matrix["python"])
    assert flow["jobs"]["locked"]["env"]["TEXLAB_LOCKED"] == "1"
    commands = " ".join(step.get("run", "") for job in flow["jobs"].values() for step in job["steps"])
    called = set(re.findall(r"\.ci/[\w.]+", commands))
    assert called == {".ci/run", ".ci/setup_env.py", ".ci/check.py", ".ci/bits.py"}
    assert all((ROOT / each).is_file() for each in called)
    goals = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
    assert set(re.findall(r"make (\w+)", commands)) <= goals
    # Ours are commands that there are, with plans that there are.
    assert set(re.findall(r"bin/texlab (\w+)", commands)) <= set(build_parser().commands)
    assert set(re.findall(r" gallery:(\S+)", commands)) <= set(bundled_plans())
