"""Pipes, devices, folders, dangling links and endless files in every place where the program reads a file."""

from __future__ import annotations

import ast
import os
import tracemalloc
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import texlab
import texlab_core
from texlab.cli.defaults import _tables
from texlab.storage.kept_exemplar import Kept
from texlab.storage.kept_exemplar import load as load_kept
from texlab.storage.kept_inputs import load_input
from texlab.storage.log import append_to_log
from texlab.storage.paths import config_dir, log_file
from texlab.storage.settings import Settings
from texlab_core.batch.choices import _lines as batch_lines
from texlab_core.batch.plan import read_plan
from texlab_core.documents.preset_store import PresetStore, find_preset
from texlab_core.documents.presets import read_preset
from texlab_core.documents.project_reading import read_project
from texlab_core.documents.record import read_recipe
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.regular import open_regular, read_regular
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats import maps
from texlab_core.images.formats.volumes import read_volume
from texlab_core.images.named_input import read_arrays
from texlab_core.methods.spectral.codefile import load_code_input, read_code
from texlab_core.sheets.sweep_sources import find_sweep

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.skipif(os.name == "nt", reason="pipes, devices and links of Unix")

LARGE = 2**40
DIGEST = "0" * 64


def pipe(path: Path) -> None:
    os.mkfifo(path)


def device(path: Path) -> None:
    path.symlink_to("/dev/zero")


def terminal(path: Path) -> None:
    path.symlink_to("/dev/tty")


def folder(path: Path) -> None:
    path.mkdir()


def dangling(path: Path) -> None:
    path.symlink_to("nowhere")


def endless(path: Path) -> None:
    with path.open("wb") as file:
        file.write(b"{" if path.suffix == ".json" else b"\x89PNG\r\n\x1a\n")
        file.truncate(LARGE)


def damaged(path: Path) -> None:
    path.write_bytes(b"\x93NUMPY\x01\0PK\x03\x04 nothing")


MAKERS = (pipe, device, terminal, folder, dangling, endless, damaged)


def read_settings(path: Path) -> None:
    settings = Settings()
    assert settings.values == {}
    # Settings that are not there are no problem.
    raise InputError(settings.problem or "Nothing was read.")


def list_presets(path: Path) -> None:
    # What is no file is none of a preset's; what is one is reported.
    store = PresetStore(path.parent)
    assert store.presets() == ()
    raise InputError(next(iter(store.problems()), "Nothing was read."))


def read_index(path: Path) -> None:
    assert maps._earlier(path.parent) == set()
    raise InputError("Nothing was read.")


def read_document(path: Path) -> None:
    from texlab.storage.reading import open_document

    open_document(str(path))


def read_source(path: Path) -> None:
    from texlab.storage.reading import open_source

    open_source(str(path))


READERS: dict[str, tuple[str, Callable[[Path], Any]]] = {
    "strict JSON": ("a.json", strict_json.load),
    "recipe": ("a.png", read_recipe),
    "recipe by text": ("a.png", lambda path: read_recipe(str(path))),
    "preset": ("a.json", read_preset),
    "preset by name": ("a.json", lambda path: find_preset(str(path), PresetStore(path.parent / "none"))),
    "preset to import": ("a.json", lambda path: PresetStore(path.parent / "none").import_file(path)),
    "own presets": ("a.json", list_presets),
    "code": ("a.msg.json", read_code),
    "code as an input": ("a.msg.json", load_code_input),
    "sweep": ("a.json", lambda path: find_sweep(str(path))),
    "project": ("a.texlab", read_project),
    "sheet": ("a.png", lambda path: find_sweep(str(path))),
    "image": ("a.png", as_exemplar),
    "index of maps": (maps.INDEX, read_index),
    "plan": ("a.json", read_plan),
    "plan in TOML": ("a.toml", read_plan),
    "list of images": ("a.txt", lambda path: batch_lines([path.name], path.parent)),
    "document of the window": ("a.json", read_document),
    "source of the window": ("a.png", read_source),
    "defaults of the command line": ("a.toml", _tables),
    "settings": ("settings.json", read_settings),
    "arrays": ("a.npz", read_arrays),
    "solid": ("a.npy", read_volume),
    "solid as a stack": ("a.tif", read_volume),
    "kept exemplar": ("exemplar.npy", lambda path: load_kept(Kept(path, "x"))),
    "kept mask": (
        f"{DIGEST}.npz",
        lambda path: load_input({"name": "mask", "sha256": DIGEST}, "image", path.parent),
    ),
    "kept state": (
        f"{DIGEST}.npz",
        lambda path: load_input({"name": "state", "sha256": DIGEST}, "arrays", path.parent),
    ),
}


@pytest.mark.parametrize("make", MAKERS, ids=lambda make: make.__name__)
@pytest.mark.parametrize("reader", READERS)
def test_every_reader_refuses_in_one_sentence(
    texlab_home: Path, make: Callable[[Path], None], reader: str
) -> None:
    name, read = READERS[reader]
    config_dir().mkdir(parents=True)
    path = config_dir() / name
    make(path)
    tracemalloc.start()
    try:
        with pytest.raises(InputError) as caught:
            read(path)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    sentence = str(caught.value)
    assert sentence.endswith(".")
    assert "\n" not in sentence
    # The longest of all limits is the recipes', 32 MB; numba and its friends may be imported on the way.
    assert peak < 250 * 2**20


@pytest.mark.parametrize("reader", READERS)
def test_a_link_to_a_good_file_is_no_reason_to_refuse(texlab_home: Path, reader: str) -> None:
    # What is refused is refused for what it holds, never for how it is reached.
    name, read = READERS[reader]
    config_dir().mkdir(parents=True)
    (config_dir() / "target").write_bytes(b"\xff plain text")
    (config_dir() / name).symlink_to("target")
    with pytest.raises(InputError) as caught:
        read(config_dir() / name)
    assert "regular" not in str(caught.value)


def test_what_is_opened_is_what_is_looked_at(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The file becomes a pipe between the look at its name and the opening.
    path = tmp_path / "a.json"
    path.write_text("[]")
    opened = os.open

    def swapped(name: Any, *rest: Any) -> int:
        path.unlink()
        os.mkfifo(path)
        return opened(name, *rest)

    monkeypatch.setattr(os, "open", swapped)
    before = len(os.listdir("/proc/self/fd")) if os.path.isdir("/proc/self/fd") else None
    with pytest.raises(OSError, match="it is no regular file"):
        read_regular(path, 100)
    if before is not None:
        assert len(os.listdir("/proc/self/fd")) == before


def test_limits_are_exact(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"x" * 100)
    assert read_regular(path, 100) == b"x" * 100
    with pytest.raises(OSError, match="it is longer than 99 bytes, the most that is read"):
        read_regular(path, 99)
    with open_regular(path) as file:
        assert file.read() == b"x" * 100
    if os.path.exists("/proc/self/status"):
        # Files of the system have a length of 0, and content all the same.
        assert b"python" in read_regular("/proc/self/status", 10_000)
        with pytest.raises(OSError, match="longer than 10 bytes"):
            read_regular("/proc/self/status", 10)


@pytest.mark.parametrize("make", [pipe, device, folder], ids=lambda make: make.__name__)
def test_the_log_is_a_file_or_none(texlab_home: Path, make: Callable[[Path], None]) -> None:
    log_file().parent.mkdir(parents=True)
    make(log_file())
    with pytest.raises(OSError, match=r"it is no regular file|it is a folder"):
        append_to_log("something")


# Who may open files at all: the readers and writers of texlab_core.files, and what reads the program's own.

OPENERS = {
    "open",
    "fdopen",
    "read_bytes",
    "read_text",
    "fromfile",
    "memmap",
    "imread",
    "mmap",
    "np.load",
    "numpy.load",
}
ALLOWED = {
    ("texlab_core/files/regular.py", "os.open"),
    ("texlab_core/files/regular.py", "os.fdopen"),
    ("texlab_core/files/whole.py", "os.open"),
    # Discards what cannot or shall not be printed.
    ("texlab/cli/main.py", "os.open"),
    ("texlab/cli/terminal.py", "os.open"),
    ("texlab/cli/terminal.py", "open"),
    ("texlab/cli/piping.py", "open"),
    # Its own result, in a folder that it has just made.
    ("texlab/cli/piping.py", "out.read_bytes"),
    # Is given a descriptor that a reader has opened.
    ("texlab/storage/arrays.py", "np.load"),
    ("texlab_core/images/named_input.py", "np.load"),
    # A lock, which is neither read nor written, and what its own processes pass on to each other.
    ("texlab_core/batch/folder.py", "os.open"),
    ("texlab_core/batch/processes.py", "open"),
    ("texlab_core/batch/child.py", "np.load"),
    # The system's own.
    ("texlab/app/memory.py", "Path('/proc/self/statm').read_text"),
    ("texlab_core/work/memory.py", "Path(path).read_text"),
}


def calls(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.Call):
            continue
        name = ast.unparse(node.func)
        packaged = "resource(" in name or name in ("file.open", "file.read_bytes", "entry.read_text")
        # The text inside of an image that is open.
        packaged = packaged or name in ("read_text", "jpeg_text.read_text", "webp_text.read_text")
        if not packaged and (
            name in OPENERS or name.rpartition(".")[2] in OPENERS - {"open"} or name == "os.open"
        ):
            found.add(name)
    return found


@pytest.mark.parametrize("package", [texlab, texlab_core], ids=lambda package: package.__name__)
def test_nobody_else_opens_files(package: Any) -> None:
    (root,) = map(Path, package.__path__)
    found = {
        (path.relative_to(root.parent).as_posix(), name) for path in root.rglob("*.py") for name in calls(path)
    }
    # Images have a door of their own, which is walked with the other readers.
    assert {each for each in found - ALLOWED if "/images/formats/" not in each[0]} == set()


def test_the_walk_finds_what_it_looks_for(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    path.write_text(
        "open(1)\nnp.load(2)\nPath(3).read_text()\nos.open(4)\nfile.open()\nresource('a').read_bytes()"
    )
    assert calls(path) == {"open", "np.load", "Path(3).read_text", "os.open"}
