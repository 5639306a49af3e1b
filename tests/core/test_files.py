"""Files are written whole, together, or not at all."""

import os
import stat

import numpy as np
import pytest

from texlab_core.documents.record import save_maps, save_result
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.files import leftovers
from texlab_core.files import whole as files
from texlab_core.files.whole import write_pieces, write_together, write_whole
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats import maps as map_files

NOISE = np.random.default_rng(0).random((8, 8)).astype(np.float32)


def listed(folder):
    return {each.name: each.read_bytes() for each in folder.iterdir() if each.is_file()}


def result():
    return run(Job(method="tiling", inputs={"exemplar": as_exemplar(NOISE)}))


@pytest.mark.parametrize("at", [0, 1, 2])
def test_none_is_written_when_one_cannot_be(tmp_path, monkeypatch, at):
    paths = [tmp_path / name for name in "abc"]
    for path in paths[:2]:
        path.write_bytes(b"old")
    before = listed(tmp_path)
    synced = []

    def full(_):
        synced.append(1)
        if len(synced) == at + 1:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.os, "fsync", full)
    with pytest.raises(InputError, match=f"{'abc'[at]}: cannot be written .No space left on device"):
        write_together(dict.fromkeys(paths, b"new"))
    assert listed(tmp_path) == before


def test_an_interruption_leaves_nothing_behind(tmp_path, monkeypatch):
    def interrupt(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(files.os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "a", b"new")
    assert listed(tmp_path) == {}


def test_a_file_of_pieces_is_the_old_one_or_the_new_one(tmp_path):
    seen = []

    def pieces(last):
        for each in (b"one ", b"two ", last):
            seen.append((tmp_path / "a").read_bytes())
            yield each

    write_whole(tmp_path / "a", b"old")
    write_pieces(tmp_path / "a", pieces(b"three"))
    assert seen == [b"old"] * 3
    assert listed(tmp_path) == {"a": b"one two three"}
    with pytest.raises(TypeError):
        write_pieces(tmp_path / "a", pieces(None))
    assert listed(tmp_path) == {"a": b"one two three"}
    with pytest.raises(InputError, match="b: cannot be written"):
        write_pieces(tmp_path / "missing" / "b", pieces(b""))


def test_folders_are_cleared_unless_the_caller_has_done_so(tmp_path):
    left = tmp_path / f".texlab-{leftovers._host()}-{2**31 - 1}-0123456789abcdef.tmp"
    left.write_bytes(b"half")
    write_together({tmp_path / "a": b"new"}, clears=False)
    assert left.exists()
    write_together({tmp_path / "a": b"new"})
    assert not left.exists()


@pytest.mark.skipif(os.name == "nt", reason="permissions of Unix")
def test_what_is_replaced_keeps_its_permissions(tmp_path):
    path = tmp_path / "private"
    path.write_bytes(b"old")
    path.chmod(0o600)
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_what_is_write_protected_stays(tmp_path, monkeypatch):
    path = tmp_path / "a"
    path.write_bytes(b"old")
    # Asked of the system, which lets root write everywhere.
    monkeypatch.setattr(files.os, "access", lambda *_: False)
    with pytest.raises(InputError, match="it is write-protected"):
        write_whole(path, b"new")
    assert path.read_bytes() == b"old"


@pytest.mark.skipif(os.name == "nt", reason="pipes of Unix")
def test_a_pipe_is_not_replaced_by_a_file(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to("pipe")
    for name in ("pipe", "link"):
        with pytest.raises(InputError, match=r"cannot be written \(it is no regular file\)\.$"):
            write_whole(tmp_path / name, b"new")
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)
    assert {each.name for each in tmp_path.iterdir()} == {"pipe", "link"}


def test_an_image_and_its_maps_are_written_together(tmp_path, monkeypatch):
    made = result()
    save_result(made, tmp_path / "a.jpg", maps=tmp_path)
    before = listed(tmp_path)
    assert {"a.jpg", "index.json"} < set(before)
    synced = []

    def full(_):
        synced.append(1)
        if len(synced) == 2:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.os, "fsync", full)
    again = run(Job(method="tiling", inputs=made.job.inputs, size=(16, 8)))
    with pytest.raises(InputError, match="cannot be written"):
        save_result(again, tmp_path / "a.jpg", maps=tmp_path)
    assert listed(tmp_path) == before


def test_maps_overwrite_no_spared_file(tmp_path):
    made = result()
    spared = tmp_path / "source.png"
    spared.write_bytes(b"precious")
    link = tmp_path / "elsewhere.png"
    link.symlink_to(spared)
    for each in (spared, link, tmp_path / "." / "source.png"):
        with pytest.raises(InputError, match="would be overwritten by a map"):
            save_maps(made, tmp_path, spare=[each])
    assert {each.name for each in tmp_path.iterdir()} == {"source.png", "elsewhere.png"}
    spared.unlink()
    assert map_files.INDEX in {each.name for each in save_maps(made, tmp_path)}
