"""The gallery and the resources, from a checkout, as an installed package and inside a zip archive."""

import csv
import io
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import texlab_core
from texlab_core.errors import ImageError
from texlab_core.files import resources as resources_module
from texlab_core.files.resources import resource, resources
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.gallery import CLASSES, find_entry, gallery

CODE = Path(texlab_core.__file__).parent


def rows():
    table = resource("gallery/SOURCES.tsv").read_text(encoding="utf-8")
    return list(csv.DictReader(io.StringIO(table), delimiter="\t"))


def test_every_row_is_an_entry_with_its_licence_and_every_file_has_a_row():
    entries = {entry.file: entry for entry in gallery()}
    assert len(entries) == 58
    for row in rows():
        entry = entries.pop(row["file"])
        assert (entry.cls, entry.author, entry.licence) == (row["class"], row["author"], row["licence"])
        assert (entry.source, entry.done) == (row["source"], row["what_was_done"])
        assert entry.licence
        assert entry.author
    assert not entries
    files = {each.name for each in resource("gallery").iterdir()}
    assert files == {row["file"] for row in rows()} | {"SOURCES.tsv"}


def test_classes_come_in_their_order_and_hang_together():
    order = [entry.cls for entry in gallery()]
    assert list(dict.fromkeys(order)) == list(CLASSES)
    assert order == sorted(order, key=list(CLASSES).index)


def test_titles_are_for_people():
    assert find_entry("structured-pebbles").title == "Pebbles"
    assert find_entry("oriented-woodgrain").title == "Wood grain"
    titles = [entry.title for entry in gallery()]
    assert len(set(titles)) == len(titles)


def test_entries_are_found_with_and_without_the_prefix():
    entry = find_entry("gallery:structured-pebbles")
    assert entry is find_entry("structured-pebbles")
    assert entry.uri == "gallery:structured-pebbles"


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("pebbles", "did you mean structured-pebbles?"),
        ("structured-peples", "did you mean structured-pebbles"),
        ("Structured-Pebbles", "did you mean structured-pebbles"),
        ("", "it has 58, for example stochastic-bark."),
        ("qqq", "it has 58, for example stochastic-bark."),
        ("../SOURCES.tsv", "it has 58, for example stochastic-bark."),
    ],
)
def test_unknown_names_get_a_suggestion(name, hint):
    with pytest.raises(ImageError) as caught:
        as_exemplar(f"gallery:{name}")
    assert str(caught.value).startswith(f"The gallery has no texture called {name!r}; {hint}")


def test_every_texture_reads_as_the_file_has_it():
    for entry in gallery():
        stored = np.asarray(Image.open(io.BytesIO(entry.read())))
        made = as_exemplar(entry.uri)
        assert made.name == entry.uri
        stored = stored.reshape(*stored.shape[:2], -1)[..., : made.channels]
        assert np.array_equal(np.rint(made.pixels * 255), stored)


def test_listing_decodes_no_image():
    code = (
        "import sys; from texlab_core.images.gallery import gallery; "
        "print(len(gallery()), sorted({'PIL', 'numpy', 'cv2'} & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=CODE.parent
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "58 []\n", "")


def make_zip(path):
    with zipfile.ZipFile(path, "w") as archive:
        for name in ("__init__", "errors", "version", "images/__init__", "images/gallery"):
            archive.write(CODE / f"{name}.py", f"texlab_core/{name}.py")
        for name in ("__init__", "resources"):
            archive.write(CODE / f"files/{name}.py", f"texlab_core/files/{name}.py")
        for file in CODE.parent.joinpath("resources").rglob("*"):
            if file.is_file() and "__pycache__" not in file.parts:
                archive.write(file, f"texlab_resources/{file.relative_to(CODE.parent / 'resources').as_posix()}")
    return path


@pytest.mark.parametrize("unpacked", [False, True], ids=["zipped", "installed"])
def test_installed_and_zipped_resources_are_found_from_another_folder(tmp_path, unpacked):
    place = make_zip(tmp_path / "bundle.zip")
    if unpacked:
        zipfile.ZipFile(place).extractall(tmp_path / "site")
        place = tmp_path / "site"
    code = (
        f"import sys; sys.path[0] = {str(place)!r}; "
        "from texlab_core.images.gallery import find_entry, __file__ as where; "
        "print(where); print(find_entry('structured-pebbles').read()[:4])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    where, begins = done.stdout.splitlines()
    assert where.startswith(str(place))
    assert begins == repr(b"\x89PNG")


def test_in_a_checkout_its_own_folder_counts_even_where_a_copy_is_installed(tmp_path, monkeypatch):
    monkeypatch.setattr(resources_module, "__file__", str(tmp_path / "texlab_core" / "files" / "resources.py"))
    # Any package will do as the installed copy.
    monkeypatch.setattr(resources_module, "PACKAGE", "texlab_core")
    try:
        resources.cache_clear()
        assert resources() == Path(texlab_core.__file__).parent
        (tmp_path / "resources" / "gallery").mkdir(parents=True)
        resources.cache_clear()
        assert resources() == Path(texlab_core.__file__).parent, "somebody else's folder"
        (tmp_path / "resources" / "gallery" / "SOURCES.tsv").write_text("", "utf-8")
        resources.cache_clear()
        assert resources() == tmp_path / "resources"
    finally:
        resources.cache_clear()


def test_missing_resources_are_one_clear_sentence(tmp_path, monkeypatch):
    monkeypatch.setattr(resources_module, "__file__", str(tmp_path / "texlab_core" / "files" / "resources.py"))
    monkeypatch.setattr(resources_module, "PACKAGE", "texlab_resources_nowhere")
    resources.cache_clear()
    try:
        with pytest.raises(
            FileNotFoundError, match=r"^The program's resources are missing: .* install TexLab again\.$"
        ):
            resources()
    finally:
        resources.cache_clear()


def test_a_missing_file_is_one_clear_sentence(monkeypatch, tmp_path):
    monkeypatch.setattr("texlab_core.images.gallery.resource", lambda path: tmp_path / path)
    entry = find_entry("structured-pebbles")
    with pytest.raises(ImageError, match=r"structured-pebbles\.png is missing from the program's gallery"):
        entry.read()
