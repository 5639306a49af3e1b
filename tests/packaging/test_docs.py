"""Every tutorial and every example of the reference runs and prints what it says; the site can be built."""

from __future__ import annotations

import doctest
import importlib
import importlib.util
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import texlab_core

if TYPE_CHECKING:
    from types import ModuleType

ROOT = Path(__file__).resolve().parents[2]
TUTORIALS = sorted((ROOT / "resources" / "docs" / "tutorials").glob("*.md"))
FLAGS = doctest.NORMALIZE_WHITESPACE


@pytest.fixture(scope="module")
def builder() -> ModuleType:
    spec = importlib.util.spec_from_file_location("build_docs", ROOT / ".ci" / "build_docs.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.stem)
def test_a_tutorial_runs_and_prints_what_it_says(builder: ModuleType, path: Path) -> None:
    code = builder.code_of(path.read_text("utf-8"))
    test = doctest.DocTestParser().get_doctest(code, {"__name__": "__main__"}, path.stem, str(path), 0)
    assert len(test.examples) >= 8
    said: list[str] = []
    # dataclasses look up the module of a class.
    runner = doctest.DocTestRunner(optionflags=FLAGS, verbose=False)
    runner.run(test, out=said.append)
    assert runner.failures == 0, "".join(said)


def _with_examples() -> list[str]:
    """Return the modules of the package whose docstrings hold examples."""
    found = []
    for path in sorted((ROOT / "texlab_core").rglob("*.py")):
        if re.search(r"^ *>>> ", path.read_text("utf-8"), re.MULTILINE):
            parts = path.relative_to(ROOT).with_suffix("").parts
            found.append(".".join(parts[:-1] if parts[-1] == "__init__" else parts))
    return found


@pytest.mark.parametrize("name", _with_examples())
def test_the_examples_in_docstrings_run(name: str) -> None:
    module = importlib.import_module(name)
    result = doctest.testmod(module, optionflags=FLAGS)
    assert result.failed == 0
    assert result.attempted > 0


def test_tutorials_lead_to_one_another() -> None:
    assert len(TUTORIALS) == 8
    for path in TUTORIALS:
        for target in re.findall(r"\]\(([^)]+)\)", path.read_text("utf-8")):
            assert (path.parent / target).is_file(), target


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore", "error:Found ", "error:The module specification")
def test_the_site_is_built(builder: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", list(sys.path))
    builder.build(tmp_path)
    start = (tmp_path / "index.html").read_text("utf-8")
    for target in re.findall(r'href="([^"]+)"', start):
        assert (tmp_path / target).is_file(), target
    for path in TUTORIALS:
        page = (tmp_path / f"{path.stem}.html").read_text("utf-8")
        assert ".md" not in re.findall(r'href="([^"]+)"', page)
    reference = (tmp_path / "api" / "texlab_core" / "api.html").read_text("utf-8")
    assert "synthesize" in reference
    assert "gallery:NAME" in reference
    front = (tmp_path / "api" / "texlab_core.html").read_text("utf-8")
    for name in texlab_core.__all__:
        section = re.search(rf'<section id="{name}">(.*?)</section>', front, re.DOTALL)
        assert section is not None, name
        assert 'class="docstring"' in section[1], name
