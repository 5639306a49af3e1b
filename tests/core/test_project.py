"""Project files come back as they were, and whatever is damaged or hostile is one sentence."""

from __future__ import annotations

import dataclasses
import io
import json
import os
import random
import stat
import struct
import zipfile

import numpy as np
import pytest

from texlab_core.documents.presets import Preset
from texlab_core.documents.project import (
    MAX_FILES,
    Project,
    ProjectColumn,
    ProjectError,
    encode_project,
    save_project,
)
from texlab_core.documents.project_history import ProjectPast
from texlab_core.documents.project_reading import read_project
from texlab_core.engine.inputs import ArraysInput, Crop, ImageInput
from texlab_core.engine.levels import Levels
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.files.archive import pack_archive
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.writing import encode_image

RANDOM = np.random.default_rng(2)
DEEP = RANDOM.integers(0, 65536, (40, 44, 3), np.uint16)


def column(method="tiling", **more):
    return ProjectColumn(method, find_method(method).params(), **more)


def pack(project):
    """Return the files of a project by name."""
    with zipfile.ZipFile(io.BytesIO(encode_project(project))) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def whole():
    mask = as_exemplar(RANDOM.integers(0, 2, (40, 44)).astype(np.float32), name="mask")
    picture = encode_image("a.png", RANDOM.random((16, 16, 3)).astype(np.float32))
    heeger = find_method("heeger-bergen").params().replace(iterations=3)
    return Project(
        exemplar=as_exemplar(DEEP, name="deep wall.tif"),
        columns=(
            column(title="Mine: α", result=picture),
            ProjectColumn(
                "heeger-bergen", heeger, {}, (24, 28), seed=9, pinned=True, measures={"discriminability": -3.25}
            ),
            column("mixture", inputs={"second": as_exemplar(RANDOM.random((20, 20, 3)), name="b")}),
            column("efros-leung", inputs={"mask": mask}),
        ),
        scale=0.75,
        crop=Crop(2, 3, 20, 24),
        seed=77,
        size=(32, 36),
        chosen=2,
        presets=(Preset(name="soft", method="heeger-bergen", parameters={"iterations": 2}, note="n"),),
        notes="Two lines,\nand a “quote”.",
        layout="tune",
    )


@pytest.fixture
def saved(tmp_path):
    path = tmp_path / "a.texlab"
    save_project(path, whole())
    return path


def same(one, other):
    if isinstance(one, ImageInput):
        return one.sha256 == other.sha256 and one.name == other.name and one.depth == other.depth
    return one.sha256 == other.sha256


def test_a_project_comes_back_as_it_was(saved):
    before, found = whole(), read_project(saved)
    for name in ("scale", "crop", "seed", "size", "chosen", "notes", "layout", "presets"):
        assert getattr(found, name) == getattr(before, name)
    np.testing.assert_array_equal(found.exemplar.pixels, before.exemplar.pixels)
    assert same(found.exemplar, before.exemplar)
    for one, other in zip(found.columns, before.columns, strict=True):
        for name in ("method", "params", "size", "title", "seed", "pinned", "measures"):
            assert getattr(one, name) == getattr(other, name)
        assert one.inputs.keys() == other.inputs.keys()
    assert [found.job(place).seed for place in (0, 1)] == [77, 9]
    assert found.columns[0].result.startswith(b"\x89PNG")
    np.testing.assert_array_equal(
        run(found.job(1)).image, run(before.job(1)).image, "the job of a column has the same bits"
    )


def test_the_same_project_has_the_same_bytes(saved, tmp_path):
    again = tmp_path / "b.texlab"
    save_project(again, read_project(saved))
    assert again.read_bytes() == saved.read_bytes()


def pasts(count=3, channels=3):
    method = find_method("heeger-bergen")
    found = []
    for place in range(count):
        params = method.params().replace(iterations=place % 5 + 1)
        gray = RANDOM.integers(0, 256, (5 + place, 64 - place, 3 if channels == 3 else 1), np.uint8)
        small = gray if channels == 3 else gray.repeat(3, axis=2)
        found.append(ProjectPast("heeger-bergen", params, (20 + place, 30), place, small, measures={"cuts": 1.5}))
    return tuple(found)


@pytest.mark.parametrize("channels", [1, 3])
def test_earlier_results_come_back(tmp_path, channels):
    mask = as_exemplar(RANDOM.integers(0, 2, (40, 44)).astype(np.float32), name="mask")
    filled = ProjectPast(
        "efros-leung", find_method("efros-leung").params(), (40, 44), 3, pasts(1)[0].thumbnail, {"mask": mask}
    )
    histories = pasts(3, channels), (filled,), ()
    made = dataclasses.replace(whole(), chosen=0, columns=tuple(column(history=each) for each in histories))
    path = tmp_path / "a.texlab"
    save_project(path, made)
    for before, now in zip(histories, read_project(path).columns, strict=True):
        assert len(before) == len(now.history)
        for one, other in zip(before, now.history, strict=True):
            for name in ("method", "params", "size", "seed", "measures"):
                assert getattr(one, name) == getattr(other, name)
            assert {each: one.inputs[each].sha256 for each in one.inputs} == {
                each: other.inputs[each].sha256 for each in other.inputs
            }
            np.testing.assert_array_equal(one.thumbnail, other.thumbnail)


def test_only_the_newest_earlier_results_are_kept(tmp_path):
    path = tmp_path / "a.texlab"
    save_project(path, dataclasses.replace(whole(), chosen=0, columns=(column(history=pasts(30)),)))
    (found,) = read_project(path).columns
    assert [past.seed for past in found.history] == list(range(6, 30))


@pytest.mark.parametrize(
    "change",
    [
        {"seed": -1}, {"size": {"width": 0, "height": 3}}, {"method": 4}, {"extra": 1}, {"parameters": []},
        {"thumbnail": [65, 3]}, {"thumbnail": [0, 3]}, {"thumbnail": [6, 64]}, {"thumbnail": "x"},
        {"inputs": {"mask": "0" * 64}}, {"inputs": []}, {"measures": {"a": "b"}}, {"measures": {"cuts": 10**380}},
        {"method": "none", "seed": -1}, {"method": "none", "size": {"width": 0, "height": 3}},
        {"parameters": {"no": 1}, "inputs": {"mask": "0" * 64}}, {"method": "none", "measures": {"a": "b"}},
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_history_is_one_sentence(tmp_path, change):
    files = pack(dataclasses.replace(whole(), chosen=0, columns=(column(history=pasts(2)),)))
    data = json.loads(files["project.json"])
    data["columns"][0]["history"][0] |= change
    path = tmp_path / "a.texlab"
    path.write_bytes(pack_archive(files | {"project.json": json.dumps(data).encode()}))
    with pytest.raises(ProjectError) as told:
        read_project(path)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    "change",
    [
        {"method": "none"}, {"method": "none", "size": {"width": 3, "height": 3, "depth": 3}},
        {"parameters": {"no": 1}}, {"parameters": {"iterations": 10**9}},
    ],
)  # fmt: skip
def test_an_earlier_result_of_what_is_not_known_here_is_left_out(tmp_path, change):
    made = dataclasses.replace(whole(), chosen=0, columns=(column(history=pasts(3)), column(history=pasts(1))))
    files = pack(made)
    data = json.loads(files["project.json"])
    data["columns"][0]["history"][1] |= change
    path = tmp_path / "a.texlab"
    path.write_bytes(pack_archive(files | {"project.json": json.dumps(data).encode()}))
    found = read_project(path)
    assert found.unknown_pasts == 1
    kept = found.columns[0].history
    assert [past.seed for past in kept] == [0, 2]
    for past, before in zip(kept, (made.columns[0].history[0], made.columns[0].history[2]), strict=True):
        np.testing.assert_array_equal(past.thumbnail, before.thumbnail)
    assert len(found.columns[1].history) == 1


@pytest.mark.parametrize("sheet", [None, b"", b"\x89PNG", b"no picture"])
def test_a_history_whose_pictures_are_missing_is_refused(tmp_path, sheet):
    files = pack(dataclasses.replace(whole(), chosen=0, columns=(column(history=pasts(2)),)))
    name = "history/0.png"
    path = tmp_path / "a.texlab"
    path.write_bytes(
        pack_archive(
            {each: data for each, data in files.items() if each != name} | ({} if sheet is None else {name: sheet})
        )
    )
    with pytest.raises(ProjectError, match="histor"):
        read_project(path)


def test_a_history_that_is_too_long_is_refused(tmp_path):
    files = pack(dataclasses.replace(whole(), chosen=0, columns=(column(history=pasts(2)),)))
    data = json.loads(files["project.json"])
    data["columns"][0]["history"] *= 13
    path = tmp_path / "a.texlab"
    path.write_bytes(pack_archive(files | {"project.json": json.dumps(data).encode()}))
    with pytest.raises(ProjectError, match="at most 24"):
        read_project(path)


@pytest.mark.parametrize(("files", "left"), [(512, 4), (11, 4), (9, 3), (7, 2), (4, 1), (3, 0)])
def test_earlier_results_go_before_a_project_cannot_be_saved(tmp_path, monkeypatch, files, left):
    """Each has an input of two files: the newest ones stay, as many as there is room for."""
    mixed = [
        dataclasses.replace(
            past, method="mixture", params=find_method("mixture").params(), inputs={"second": second}
        )
        for past, second in zip(pasts(4), (as_exemplar(DEEP[: 20 + place]) for place in range(4)), strict=True)
    ]
    project = dataclasses.replace(whole(), exemplar=None, crop=None, chosen=0, columns=(column(history=mixed),))
    monkeypatch.setattr("texlab_core.documents.project.MAX_FILES", files)
    path = tmp_path / "a.texlab"
    save_project(path, project)
    history = read_project(path).columns[0].history
    assert [past.seed for past in history] == [past.seed for past in mixed[4 - left :]]


def test_an_earlier_result_whose_input_is_too_large_is_left_out(tmp_path, monkeypatch):
    old, new = pasts(2)
    large = dataclasses.replace(
        old, method="mixture", params=find_method("mixture").params(), inputs={"second": as_exemplar(DEEP)}
    )
    project = dataclasses.replace(
        whole(), exemplar=None, crop=None, chosen=0, columns=(column(history=(large, new)),)
    )
    monkeypatch.setattr("texlab_core.documents.project.MAX_INPUT", 64)
    save_project(tmp_path / "a.texlab", project)
    (left,) = read_project(tmp_path / "a.texlab").columns[0].history
    assert left.seed == new.seed


def test_an_input_is_kept_once(tmp_path):
    second = as_exemplar(DEEP[:20], name="b")
    project = dataclasses.replace(
        whole(),
        columns=(column("mixture", inputs={"second": second}), column("mixture", inputs={"second": second})),
    )
    names = zipfile.ZipFile(io.BytesIO(encode_project(project))).namelist()
    assert len(names) == len(set(names)) == 1 + 2 + 2


def test_states_and_deep_and_cropped_exemplars_come_back(tmp_path):
    state = ArraysInput({"a": RANDOM.random((5, 4)), "b": np.arange(3)}, "state")
    floats = as_exemplar(RANDOM.random((30, 30, 3)).astype(np.float32), name="f", crop=Crop(1, 2, 20, 20))
    roles = [spec.name for spec in find_method("efros-leung").inputs if spec.kind == "arrays"]
    project = Project(floats, (column("efros-leung", inputs={roles[0]: state}),), size=(24, 24))
    path = tmp_path / "a.texlab"
    save_project(path, project)
    found = read_project(path)
    assert found.exemplar.sha256 == floats.sha256
    assert found.exemplar.origin.crop == Crop(1, 2, 20, 20)
    assert found.columns[0].inputs[roles[0]].sha256 == state.sha256
    save_project(path, Project(None, ()))
    assert read_project(path).exemplar is None


def rebuilt(path, changes=None, leave=(), text=None, infos=()):
    """Write the archive anew with other files in it."""
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist() if name not in leave}
    files.update(changes or {})
    if text is not None:
        data = json.loads(files["project.json"])
        text(data)
        files["project.json"] = json.dumps(data).encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
        for info, data in infos:
            archive.writestr(info, data)
    return path


def link(name):
    info = zipfile.ZipInfo(name)
    info.external_attr = (stat.S_IFLNK | 0o777) << 16
    return info


@pytest.mark.parametrize(
    "name",
    [
        "../evil",
        "/etc/passwd",
        "inputs/../../x",
        "inputs",
        "a\\b",
        "project.json/",
        "results/1.txt",
        "C:x",
        "Project.json",
    ],
)
def test_files_that_do_not_belong_there_are_refused(saved, name):
    with pytest.raises(ProjectError, match="does not belong there"):
        read_project(rebuilt(saved, {name: b"x"}))


def test_links_locks_and_bombs_are_refused(saved, tmp_path, monkeypatch):
    original = saved.read_bytes()
    with pytest.raises(ProjectError, match="is no file"):
        read_project(rebuilt(saved, infos=[(link("results/9.png"), b"/etc/passwd")]))
    saved.write_bytes(original)
    monkeypatch.setattr("texlab_core.documents.project_reading.MAX_BYTES", 2**20)
    with pytest.raises(ProjectError, match="unpacks to more than 1 MB"):
        read_project(rebuilt(saved, {"results/8.png": bytes(3 * 2**20)}))
    saved.write_bytes(original)
    with pytest.raises(ProjectError, match="longer than 1 MB"):
        read_project(rebuilt(saved, {"results/8.png": os.urandom(2**21)}))
    saved.write_bytes(original)
    many = {f"results/{number}.png": b"" for number in range(MAX_FILES)}
    with pytest.raises(ProjectError, match=f"at most {MAX_FILES} are read"):
        read_project(rebuilt(saved, many))
    with zipfile.ZipFile(saved, "w", zipfile.ZIP_BZIP2) as archive:
        archive.writestr("project.json", b"{}" * 99)
    with pytest.raises(ProjectError, match="packed in a way"):
        read_project(saved)
    locked = bytearray(original)
    for place in range(len(locked) - 4):
        if locked[place : place + 4] == b"PK\x01\x02":
            locked[place + 8] |= 1
    saved.write_bytes(locked)
    with pytest.raises(ProjectError, match=r"packed in a way|damaged"):
        read_project(saved)


def test_a_file_that_is_there_twice_is_refused(saved):
    with pytest.warns(UserWarning, match="Duplicate"), zipfile.ZipFile(saved, "a") as archive:
        archive.writestr("project.json", b"{}")
    with pytest.raises(ProjectError, match="twice"):
        read_project(saved)


def test_a_directory_that_lies_about_its_length_is_refused(saved):
    data = bytearray(saved.read_bytes())
    struct.pack_into("<I", data, len(data) - 10, 2**31)
    saved.write_bytes(data)
    with pytest.raises(ProjectError, match="damaged, or no archive"):
        read_project(saved)


def test_only_regular_files_are_read(tmp_path):
    for path in (tmp_path, tmp_path / "none", "/dev/zero"):
        with pytest.raises(ProjectError):
            read_project(path)
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    with pytest.raises(ProjectError, match="regular"):
        read_project(fifo)


CHANGES = {
    "format": "preset", "version": 4, "extra": 1, "seed": -1, "size": {"width": 0, "height": 3}, "scale": 0,
    "chosen": 4, "crop": [0, 0, 400, 400], "columns": {}, "presets": [{"format": "texlab-preset"}], "notes": 3,
    "layout": "wild", "exemplar": "0" * 64,
}  # fmt: skip
IN_COLUMN = {
    "method": "none", "parameters": {"iterations": 10**9}, "inputs": {"exemplar": "x"}, "size": {"width": 1},
    "title": "x" * 201, "result": "yes", "more": 1, "seed": -1, "pinned": 1, "measures": {"a": True},
}  # fmt: skip


@pytest.mark.parametrize(("key", "value"), CHANGES.items())
def test_what_is_wrong_in_a_project_is_one_sentence(saved, key, value):
    with pytest.raises(ProjectError) as caught:
        read_project(rebuilt(saved, text=lambda data: data.update({key: value})))
    assert str(caught.value).endswith(".")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("key", "value"), IN_COLUMN.items())
def test_what_is_wrong_in_a_column_is_one_sentence(saved, key, value):
    with pytest.raises(ProjectError) as caught:
        read_project(rebuilt(saved, text=lambda data: data["columns"][1].update({key: value})))
    assert "\n" not in str(caught.value)


def test_parts_that_are_missing_or_changed_are_told(saved):
    original = saved.read_bytes()
    names = zipfile.ZipFile(saved).namelist()
    for name in names:
        saved.write_bytes(original)
        with pytest.raises(ProjectError):
            read_project(rebuilt(saved, leave=(name,)))
    saved.write_bytes(original)
    picture = next(name for name in names if name.endswith("-source.png") or name.endswith("-pixels.png"))
    other = encode_image("a.png", RANDOM.random((40, 44, 3)).astype(np.float32), bits=16)
    with pytest.raises(ProjectError, match=r"another hash|cannot be used"):
        read_project(rebuilt(saved, {picture: other}))


def test_damaged_archives_are_one_sentence(saved):
    original = saved.read_bytes()
    dice = random.Random(7)
    refused: list[str] = []
    for _ in range(150):
        data = bytearray(original)
        kind = dice.randrange(4)
        if kind == 0:
            del data[dice.randrange(len(data)) :]
        elif kind == 1:
            for _ in range(dice.randrange(1, 9)):
                data[dice.randrange(len(data))] = dice.randrange(256)
        elif kind == 2:
            place = dice.randrange(len(data))
            data[place : place + dice.randrange(1, 40)] = dice.randbytes(dice.randrange(40))
        else:
            # The directory at the end decides most.
            for _ in range(dice.randrange(1, 4)):
                data[-dice.randrange(1, 900)] = dice.randrange(256)
        saved.write_bytes(data)
        try:
            read_project(saved)
        except ProjectError as error:
            refused.append(str(error))
    assert len(refused) > 100
    assert not any("\n" in sentence for sentence in refused)


def test_a_project_that_would_be_too_large_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr("texlab_core.documents.project.MAX_INPUT", 100)
    with pytest.raises(InputError, match="too large to be kept in a project"):
        save_project(tmp_path / "a.texlab", whole())
    assert not (tmp_path / "a.texlab").exists()
    monkeypatch.undo()
    monkeypatch.setattr("texlab_core.documents.project.MAX_BYTES", 100)
    with pytest.raises(InputError, match="at most 512 files"):
        encode_project(whole())


@pytest.fixture
def large(tmp_path, monkeypatch):
    """Save a project of which a part of a large picture is used."""
    monkeypatch.setattr("texlab_core.documents.project.LARGE", 1000)
    pixels = np.random.default_rng(4).integers(0, 256, (40, 60, 3), np.uint8)
    project = Project(
        exemplar=as_exemplar(pixels, name="photo.png"),
        columns=(ProjectColumn(method="pixels", params=find_method("pixels").params()),),
        scale=0.5,
        crop=Crop(2, 3, 10, 12),
        levels=Levels(0.1, 0.9, 1.2),
    )
    path = tmp_path / "large.texlab"
    save_project(path, project)
    return path, project


def test_the_part_in_use_comes_before_a_large_picture(large):
    path, project = large
    seen = []
    whole = read_project(path, seen.append)
    (first,) = seen
    assert first.exemplar.size == (10, 12)
    assert (first.scale, first.crop) == (1.0, None)
    assert whole.exemplar.size == (40, 60)
    assert (whole.scale, whole.crop, whole.levels) == (project.scale, project.crop, project.levels)
    # Both work on the very same pixels, levels and all.
    assert first.job(0).key == whole.job(0).key == project.job(0).key
    assert read_project(path).exemplar.sha256 == whole.exemplar.sha256


def test_only_what_has_a_part_of_a_large_picture_is_of_the_second_version(large, tmp_path):
    _, project = large
    for change, version in (({}, 2), ({"scale": 1.0, "crop": None}, 1)):
        assert not project.columns[0].history
        other = tmp_path / "other.texlab"
        save_project(other, dataclasses.replace(project, **change))
        with zipfile.ZipFile(other) as archive:
            data = json.loads(archive.read("project.json"))
        assert data["version"] == version
        assert ("used" in data) == (version == 2)
        seen = []
        read_project(other, seen.append)
        assert len(seen) == version - 1


def test_a_part_that_is_another_one_is_refused(large, tmp_path):
    path, project = large
    save_project(tmp_path / "other.texlab", dataclasses.replace(project, crop=Crop(0, 0, 10, 12)))
    with zipfile.ZipFile(tmp_path / "other.texlab") as archive:
        foreign = json.loads(archive.read("project.json"))["used"]
        others = {name: archive.read(name) for name in archive.namelist() if foreign in name}
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    for used, says in ((foreign, "is not the part of the exemplar"), (3, "the input used is missing")):
        data = json.loads(files["project.json"]) | {"used": used}
        changed = files | others | {"project.json": json.dumps(data).encode()}
        (tmp_path / "bad.texlab").write_bytes(pack_archive(changed))
        with pytest.raises(ProjectError, match=says):
            read_project(tmp_path / "bad.texlab")
