"""Whenever the program ends by force, files and sets of files are old or new, and what is left over is cleared."""

from __future__ import annotations

import hashlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from tests.core.kills import deaths
from texlab_core.documents.presets import Preset, read_preset
from texlab_core.documents.record import read_recipe, save_maps, save_result
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.files import leftovers
from texlab_core.files.whole import check_target, write_together, write_whole
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.maps import INDEX

posix = pytest.mark.skipif(os.name == "nt", reason="links, pipes and signals of Unix")


def result(seed, method="pixels"):
    pixels = np.random.default_rng(seed).random((20, 24)).astype(np.float32)
    return run(Job(method=method, inputs={"exemplar": as_exemplar(pixels)}, size=(10, 11), seed=seed))


@pytest.fixture(scope="module")
def results():
    return result(1), result(2)


def ours(folder):
    return sorted(each.name for each in folder.rglob(".texlab-*"))


def test_a_file_is_old_or_new(tmp_path, monkeypatch):
    path = tmp_path / "a"
    seen = set()
    for _ in deaths(monkeypatch, lambda: path.write_bytes(b"old"), lambda: write_whole(path, b"new")):
        seen.add(path.read_bytes())
    assert seen == {b"old", b"new"} or seen == {b"old"}
    assert path.read_bytes() == b"new"
    assert ours(tmp_path) == []


def test_a_manifest_names_the_files_of_one_set(tmp_path, monkeypatch):
    def files(what):
        data = {name: f"{what} {name}".encode() for name in ("x", "y", "z")}
        digests = {name: hashlib.sha256(each).hexdigest() for name, each in data.items()}
        return {tmp_path / name: each for name, each in data.items()} | {
            tmp_path / "index": json.dumps(digests).encode()
        }

    def prepare():
        for path, data in files("old").items():
            path.write_bytes(data)

    manifest = (tmp_path / "index", b"{}")
    states = set()
    for _ in deaths(monkeypatch, prepare, lambda: write_together(files("new"), manifest=manifest)):
        named = json.loads((tmp_path / "index").read_bytes())
        for name, digest in named.items():
            assert hashlib.sha256((tmp_path / name).read_bytes()).hexdigest() == digest
        # Every file by itself is whole.
        words = {(tmp_path / name).read_bytes().split()[0] for name in "xyz"}
        assert words <= {b"old", b"new"}
        states.add((bool(named), *sorted(words)))
    # Both sets were seen, and the moments in between named nothing.
    assert (True, b"old") in states
    assert (True, b"new") in states
    assert (False, b"new", b"old") in states
    assert not any(named and len(words) > 1 for named, *words in states)


def test_what_was_left_over_is_cleared_by_the_next_write(tmp_path, monkeypatch):
    most = 0
    contents = {tmp_path / "a": b"new a", tmp_path / "b": b"new b"}
    for _ in deaths(monkeypatch, lambda: (tmp_path / "a").write_bytes(b"old"), lambda: write_together(contents)):
        most = max(most, len(ours(tmp_path)))
        write_whole(tmp_path / "c", b"other")
        assert ours(tmp_path) == []
    assert most >= 2


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif", "webp"])
def test_an_image_and_its_maps_are_those_of_one_run(tmp_path, monkeypatch, results, suffix):
    old, new = results
    image, folder = tmp_path / f"o.{suffix}", tmp_path / "maps"

    def prepare():
        save_result(old, image, maps=folder)

    for _ in deaths(monkeypatch, prepare, lambda: save_result(new, image, maps=folder)):
        seed = read_recipe(image).seed
        assert seed in (1, 2)
        index = json.loads((folder / INDEX).read_bytes())
        for name, digest in index.get("sha256", {}).items():
            assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest
        if index["maps"]:
            source = np.load(folder / "source.npy")
            assert np.array_equal(source, (old if seed == 1 else new).maps["source"].data)
    assert read_recipe(image).seed == 2
    assert ours(tmp_path) == []


@posix
@pytest.mark.parametrize("at", [1, 3, 5])
def test_a_real_kill(tmp_path, results, at):
    old, _ = results
    save_result(old, tmp_path / "o.jpg", maps=tmp_path / "maps")
    code = f"""
import os, signal
from tests.core.test_consistency import result, save_result
new = result(2)
replace, count = os.replace, 0
def killed(*given):
    global count
    count += 1
    if count == {at}:
        os.kill(os.getpid(), signal.SIGKILL)
    replace(*given)
os.replace = killed
save_result(new, {str(tmp_path / "o.jpg")!r}, maps={str(tmp_path / "maps")!r})
"""
    done = subprocess.run([sys.executable, "-c", code], check=False)
    assert done.returncode == -signal.SIGKILL
    assert ours(tmp_path) != []
    index = json.loads((tmp_path / "maps" / INDEX).read_bytes())
    assert (index["maps"] == {}) == (at > 1)
    assert read_recipe(tmp_path / "o.jpg").seed in (1, 2)
    # Nothing of it is in the way of the next one, and the process is known to be dead.
    save_result(old, tmp_path / "o.jpg", maps=tmp_path / "maps")
    assert ours(tmp_path) == []
    assert json.loads((tmp_path / "maps" / INDEX).read_bytes())["maps"]


def test_a_failing_rename_brings_everything_back(tmp_path, monkeypatch):
    paths = [tmp_path / name for name in "abcd"]
    for path in paths[:2]:
        path.write_bytes(b"old")
    replace = os.replace
    for at in range(1, 6):
        calls = []

        def failing(*given, at=at, calls=calls):
            calls.append(given)
            if len(calls) == at:
                raise OSError(5, "Input/output error")
            replace(*given)

        with monkeypatch.context() as patch:
            patch.setattr(os, "replace", failing)
            with pytest.raises(InputError, match=r"cannot be written \(Input/output error\)\.$"):
                write_together(dict.fromkeys(paths, b"new"), manifest=(paths[0], b"meanwhile"))
        assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == {"a": b"old", "b": b"old"}


def test_file_systems_without_links(tmp_path, monkeypatch):
    def refuse(*_):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    paths = [tmp_path / "a", tmp_path / "b"]
    paths[0].write_bytes(b"old")
    write_together(dict.fromkeys(paths, b"new"))
    assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == {"a": b"new", "b": b"new"}


# What dead processes leave.


def test_only_leftovers_of_the_dead_are_removed(tmp_path):
    host = leftovers._host()
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    day_ago = time.time() - 90_000
    stays = [
        f".texlab-{host}-{os.getppid()}-{'0' * 16}.tmp",
        f".texlab-{'f' * 8 if host != 'f' * 8 else 'e' * 8}-{dead.pid}-{'0' * 16}.tmp",
        f".texlab-{'1' * 16}.tmp",
        ".texlab-notes.tmp",
        f"texlab-{host}-{dead.pid}-{'0' * 16}.tmp",
        f".texlab-{host}-{dead.pid}-{'0' * 16}.png",
    ]
    goes = [f".texlab-{host}-{dead.pid}-{'2' * 16}.{end}" for end in ("tmp", "old")]
    goes += [f".texlab-{host}-{os.getpid()}-{'3' * 16}.tmp", f".texlab-{'4' * 16}.tmp"]
    for name in (*stays, *goes):
        (tmp_path / name).write_bytes(b"")
    os.utime(tmp_path / goes[-1], (day_ago, day_ago))
    (tmp_path / f".texlab-{host}-{dead.pid}-{'5' * 16}.tmp").mkdir()
    used = leftovers.reserve(tmp_path)
    used.write_bytes(b"")
    assert {each.name for each in leftovers.sweep(tmp_path)} == set(goes)
    assert {each.name for each in tmp_path.iterdir() if each.is_file()} == {*stays, used.name}
    leftovers.release(used)
    assert not used.exists()
    assert leftovers.sweep(tmp_path / "missing") == ()


def test_a_process_of_somebody_else_is_alive(monkeypatch):
    def refuse(*_):
        raise PermissionError

    monkeypatch.setattr(os, "kill", refuse)
    assert leftovers._is_running(1)


# What may not be written, known beforehand.


@posix
def test_targets_that_are_no_files_are_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "dangling").symlink_to("nowhere")
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_bytes(b"x")
    (tmp_path / "link").symlink_to("file")
    refused = {
        "": "is empty",
        tmp_path / "pipe": "it is no regular file",
        "/dev/null": "it is no regular file",
        tmp_path / "dangling": "it is a link to a file that does not exist",
        tmp_path / "loop": "symbolic links",
        tmp_path / "folder": "is a folder, and a file is wanted",
        tmp_path / "missing" / "a.png": "missing does not exist",
        tmp_path / "file" / "a.png": "Not a directory|does not exist",
        "a\0b": "cannot be written",
    }
    before = sorted(each.name for each in tmp_path.iterdir())
    for path, reason in refused.items():
        with pytest.raises(InputError, match=reason) as caught:
            check_target(path)
        assert str(caught.value).endswith(".")
        if path:
            with pytest.raises(InputError, match="cannot be written"):
                write_whole(path, b"new")
    assert sorted(each.name for each in tmp_path.iterdir()) == before
    for name in ("file", "link", "new"):
        assert check_target(tmp_path / name) == tmp_path / name
    write_whole(tmp_path / "link", b"y")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_bytes() == b"y"


@posix
def test_two_names_of_one_file_are_no_set(tmp_path):
    (tmp_path / "a").write_bytes(b"old")
    (tmp_path / "b").symlink_to("a")
    with pytest.raises(InputError, match="two files would be written under this name"):
        write_together({tmp_path / "a": b"1", tmp_path / "b": b"2"})
    assert (tmp_path / "a").read_bytes() == b"old"


# Images and recipes that are none of each other's.


def test_a_jpeg_holds_its_recipe_and_overwrites_nothing_beside_it(tmp_path, results):
    old, new = results
    foreign = tmp_path / "photo.texlab.json"
    foreign.write_text("mine")
    save_result(old, tmp_path / "photo.jpg")
    save_result(new, tmp_path / "photo.jpeg")
    assert foreign.read_text() == "mine"
    assert read_recipe(tmp_path / "photo.jpg").seed == 1
    assert read_recipe(tmp_path / "photo.jpeg").seed == 2
    assert read_recipe((tmp_path / "photo.jpeg").read_bytes()).seed == 2


def test_a_recipe_beside_a_file_is_that_of_the_file(tmp_path, monkeypatch, results):
    from texlab_core.documents.beside import read_beside, sidecar, write_with_recipe
    from texlab_core.documents.recipe import recipe_json
    from texlab_core.errors import NoRecipeError

    recipes = [json.dumps(recipe_json(each)) for each in results]
    path, data = tmp_path / "solid.npy", [b"\x93NUMPY old", b"\x93NUMPY new"]
    seen = []
    for _ in deaths(
        monkeypatch,
        lambda: write_with_recipe(path, data[0], recipes[0]),
        lambda: write_with_recipe(path, data[1], recipes[1]),
    ):
        which = data.index(path.read_bytes())
        assert read_recipe(path).seed == which + 1
        seen.append(which)
    assert set(seen) == {0, 1}
    assert ours(tmp_path) == []
    # The recipe alone can be followed as well, and says no more than it should.
    assert read_recipe(sidecar(path)).seed == 2
    assert set(json.loads(sidecar(path).read_bytes())) == {*json.loads(recipes[1]), "sha256"}
    with path.open("rb") as file:
        assert json.loads(read_beside(path, file)) == json.loads(recipes[1])
    path.write_bytes(b"\x93NUMPY of somebody else")
    with pytest.raises(NoRecipeError, match=r"solid\.npy\.texlab\.json beside it is that of another file\.$"):
        read_recipe(path)
    for foreign in ("mine", "[]", '{"a": 1}'):
        sidecar(path).write_text(foreign)
        with pytest.raises(NoRecipeError, match="beside it is none"):
            read_recipe(path)
        with pytest.raises(InputError, match="is there already and holds no recipe"):
            write_with_recipe(path, data[0], recipes[0])
        assert sidecar(path).read_text() == foreign
        assert path.read_bytes() == b"\x93NUMPY of somebody else"


def first_version(result, path):
    """Save as the first version did: the recipe of a JPEG in a file beside it."""
    from texlab_core.documents.recipe import recipe_json
    from texlab_core.images.formats.writing import write_image

    write_image(path, result.image)
    path.with_suffix(".texlab.json").write_text(json.dumps(recipe_json(result)))


def test_recipes_beside_old_jpegs(tmp_path, results):
    from texlab_core.errors import NoRecipeError
    from texlab_core.images.formats.writing import write_image

    old, new = results
    path = tmp_path / "photo.jpg"
    first_version(old, path)
    assert read_recipe(path).seed == 1
    assert run(read_recipe(path).job()).image.tobytes() == old.image.tobytes()
    # One that holds its own needs none, whatever lies there.
    save_result(new, path)
    assert read_recipe(path).seed == 2
    first_version(old, path)
    write_image(tmp_path / "photo.jpeg", np.zeros((10, 11), np.float32))
    for name in ("photo.jpg", "photo.jpeg"):
        with pytest.raises(NoRecipeError, match=r"may as well be that of photo\.jpe?g\.$"):
            read_recipe(tmp_path / name)
    (tmp_path / "photo.jpeg").unlink()
    write_image(path, np.zeros((16, 16), np.float32))
    with pytest.raises(NoRecipeError, match=r"it makes an image of 11 x 10 pixels\.$"):
        read_recipe(path)
    for content in ("mine", "{}", "[" * 100):
        path.with_suffix(".texlab.json").write_text(content)
        with pytest.raises(NoRecipeError, match=r"^photo\.jpg holds no recipe, and photo\.texlab\.json"):
            read_recipe(path)


def test_maps_overwrite_only_what_maps_brought(tmp_path, results):
    old, new = results
    tmp_path.joinpath("source.png").write_bytes(b"precious")
    with pytest.raises(InputError, match=r"source\.png is there already, and no earlier maps brought it"):
        save_result(old, tmp_path / "o.png", maps=tmp_path)
    assert {each.name for each in tmp_path.iterdir()} == {"source.png"}
    folder = tmp_path / "deep" / "maps"
    with pytest.raises(InputError, match="would be overwritten by a map"):
        save_result(old, tmp_path / "o.png", maps=folder, spare=[folder / "source.png"])
    assert {each.name for each in tmp_path.iterdir()} == {"source.png"}
    save_maps(old, folder)
    files = {each.name for each in folder.iterdir()}
    # A method with other maps leaves those of the first alone, and the first may come again.
    save_maps(result(3, "heeger-bergen"), folder)
    assert files <= {each.name for each in folder.iterdir()}
    save_maps(new, folder)
    assert np.array_equal(np.load(folder / "source.npy"), new.maps["source"].data)
    with pytest.raises(InputError, match=r"would be overwritten by a map"):
        save_result(old, folder / "source.png", maps=folder)
    assert np.array_equal(np.load(folder / "source.npy"), new.maps["source"].data)


def test_presets_are_old_or_new_too(tmp_path, monkeypatch):
    from texlab_core.documents.preset_store import PresetStore

    store = PresetStore(tmp_path / "presets")

    def of(alpha):
        return Preset(name="mine", method="heeger-bergen", parameters={"iterations": alpha})

    seen = set()
    for _ in deaths(monkeypatch, lambda: store.save(of(3), replace=True), lambda: store.save(of(4), replace=True)):
        (path,) = Path(store.folder).glob("*.json")
        seen.add(read_preset(path).parameters["iterations"])
    assert seen <= {3, 4}
    assert store.load("mine").parameters["iterations"] == 4
