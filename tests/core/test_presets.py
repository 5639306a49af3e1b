"""Presets: what is written comes back, what is wrong is refused in one sentence, and a refusal changes nothing."""

from __future__ import annotations

import dataclasses
import json
import os
import string
from pathlib import PureWindowsPath

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.stub_method import STUB, StubParams, know, stub  # noqa: F401
from texlab_core.documents.preset_store import PresetStore, bundled_presets, export_preset, file_name, find_preset
from texlab_core.documents.presets import (
    Preset,
    PresetError,
    check_name,
    pick,
    preset_from_json,
    read_preset,
    write_preset,
)
from texlab_core.engine.params import describe
from texlab_core.engine.registry import methods
from texlab_core.errors import InputError

pytestmark = pytest.mark.usefixtures("stub")
any_value = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def make(name="foam", **others):
    return Preset(name=name, **({"method": "stub", "parameters": {"level": 0.25}} | others))


def document(**changes):
    data = {"format": "texlab-preset", "version": 1, "name": "foam", "method": "stub", "parameters": {}}
    return {key: value for key, value in (data | changes).items() if value is not ...}


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()} if folder.is_dir() else {}


# Reading and writing


@pytest.mark.parametrize("method", methods().values(), ids=lambda method: method.id)
def test_defaults_of_every_method_come_back(method, tmp_path):
    preset = Preset.of("everything", method.id, method.params(), note="two\nlines")
    write_preset(preset, tmp_path / "a.json")
    assert read_preset(tmp_path / "a.json") == preset
    assert preset.params() == method.params()
    assert set(preset.parameters) == {each.name for each in describe(method.params)}


def test_a_partial_preset_leaves_the_others_as_they_are():
    preset = make(parameters={"level": 2, "border": "wrap"})
    base = StubParams(rounds=9, level=1, exact=False)
    assert preset.params(base) == StubParams(rounds=9, level=2, exact=False, border="wrap")
    assert preset.params() == StubParams(level=2, border="wrap")


def test_a_preset_cannot_be_changed_through_its_source():
    parameters = {"level": 0.25}
    preset = make(parameters=parameters)
    parameters["level"] = -1e9
    assert preset.parameters == {"level": 0.25}
    with pytest.raises(TypeError):
        preset.parameters["level"] = 0


def test_it_remembers_its_exemplar(tmp_path):
    data = document(exemplar={"name": "gallery:gravel", "sha256": "ab" * 32})
    preset = preset_from_json(data)
    assert preset.exemplar is not None
    assert preset.exemplar.sha256 == "ab" * 32
    assert preset.to_json() == data | {"note": ""}


def test_text_bytes_and_file_are_read_alike(tmp_path):
    text = json.dumps(document())
    (tmp_path / "a.json").write_text(text)
    assert read_preset(text) == read_preset(text.encode()) == read_preset(tmp_path / "a.json")


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ([], "it is no preset"),
        (document(format="texlab-code"), "it is no preset"),
        (document(version=2), "made by a newer TexLab"),
        (document(version="1"), "version: must be a whole number"),
        (document(version=True), "version: must be a whole number"),
        (document(version=0), "version: must be a whole number"),
        (document(colour="red"), "key: must be one of format, version"),
        (document(name=...), "name: is missing"),
        (document(method=...), "method: is missing"),
        (document(parameters=...), "parameters: is missing"),
        (document(parameters=[]), "parameters: must be a JSON object"),
        (document(parameters=None), "parameters: must be a JSON object"),
        (document(method="no-such"), "method: must be one of"),
        (document(method=[]), "method: must be the id of a method"),
        (document(parameters={"no_such": 1}), "parameter name: must be one of"),
        (document(parameters={"level": "high"}), "level: must be a number"),
        (document(parameters={"level": None}), "level: must be a number"),
        (document(parameters={"level": -1e6}), "level: must be a number"),
        (document(parameters={"level": 10**300}), "level: must be a number"),
        (document(name=7), "The name of a preset must be 1 to 60"),
        (document(name=""), "The name of a preset must be 1 to 60"),
        (document(name="x" * 61), "The name of a preset must be 1 to 60"),
        (document(name="../evil"), "can hold no slash"),
        (document(name="a\\b"), "can hold no slash"),
        (document(name=".."), "can hold no slash"),
        (document(name=" a"), "can hold no slash (/ or \\) and neither begin nor end with a space"),
        (document(name="a\nb"), "The name of a preset must be 1 to 60 printable"),
        (document(name="a\x00b"), "The name of a preset must be 1 to 60 printable"),
        (document(name="a\u202eb"), "The name of a preset must be 1 to 60 printable"),
        (document(note="\x1b[31m"), "note must be at most"),
        (document(note=1), "note must be at most"),
        (document(exemplar="gravel"), "exemplar: must hold a name and a sha256"),
        (document(exemplar={"name": "a", "sha256": "../x"}), "sha256 must be 64 hexadecimal digits"),
        (document(exemplar={"name": "a", "sha256": 1}), "exemplar: must hold"),
        (document(exemplar={"name": "a\n", "sha256": "0" * 64}), "exemplar name must be"),
    ],
)
def test_what_is_wrong_is_refused_in_one_sentence(data, says, tmp_path):
    path = tmp_path / "in.json"
    path.write_text(json.dumps(data))
    store = PresetStore(tmp_path / "store")
    store.save(make("kept"))
    before = contents(store.folder)
    with pytest.raises(PresetError) as caught:
        store.import_file(path)
    message = str(caught.value)
    assert message.startswith("The preset in.json cannot be used: ")
    assert says in message
    assert message.endswith(".")
    assert "\n" not in message
    assert "\x00" not in message
    assert len(message) < 400
    assert contents(store.folder) == before


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (" " * (2**20 + 1), "longer than 1 MB"),
        ("[" * 10_000, "nested more than 32 levels"),
        ('{"format": NaN}', "holds NaN"),
        ('{"name": "a", "name": "b"}', "twice"),
        ("", "not valid JSON"),
    ],
)
def test_hostile_files_are_refused_in_one_sentence(text, says, tmp_path):
    path = tmp_path / "in.json"
    path.write_text(text)
    with pytest.raises(PresetError, match=says) as caught:
        read_preset(path)
    assert str(caught.value).startswith("The preset in.json ")


@any_value
@given(
    st.recursive(st.none() | st.booleans() | st.floats() | st.text(max_size=5), lambda x: st.lists(x, max_size=3))
)
def test_any_value_for_a_knob_is_taken_or_refused(value):
    for each in describe(StubParams):
        try:
            preset = Preset(name="a", method="stub", parameters={each.name: value})
        except InputError:
            continue
        assert preset_from_json(json.loads(json.dumps(preset.to_json()))) == preset


# Names


@any_value
@given(st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=60))
def test_every_accepted_name_gives_a_file_name_that_windows_accepts(name):
    try:
        preset = make(name)
    except PresetError:
        return
    file = file_name(preset)
    assert not set(file) & set('<>:"/\\|?*')
    assert PureWindowsPath(file).name == file
    assert not file.startswith((".", " "))
    assert len(os.fsencode(file)) < 255


def test_names_are_composed_and_compared_without_case(tmp_path):
    assert check_name("e\u0301tude") == "\u00e9tude"
    store = PresetStore(tmp_path)
    store.save(make("Étude"))
    assert store.load("e\u0301TUDE".lower()).name == "Étude"
    with pytest.raises(PresetError, match="already"):
        store.save(make("étude"))


# The folder


def test_save_load_rename_delete(tmp_path):
    store = PresetStore(tmp_path / "made" / "later")
    assert store.presets() == ()
    store.save(make("foam", note="first"))
    with pytest.raises(PresetError, match=r"called foam already\.$"):
        store.save(make("foam", note="second"))
    assert store.load("foam").note == "first"
    store.save(make("foam", note="second"), replace=True)
    assert store.load("FOAM").note == "second"
    assert len(contents(store.folder)) == 1
    store.save(make("scum"))
    with pytest.raises(PresetError, match="called scum already"):
        store.rename("foam", "scum")
    with pytest.raises(PresetError, match="no slash"):
        store.rename("foam", "../x")
    assert [each.name for each in store.presets()] == ["foam", "scum"]
    assert store.rename("foam", "Foam").note == "second"
    assert store.rename("foam", "froth").note == "second"
    assert [each.name for each in store.presets()] == ["froth", "scum"]
    assert store.delete("froth").note == "second"
    with pytest.raises(PresetError, match=r"There is no preset called 'froth' \(there are scum\)\.$"):
        store.delete("froth")
    with pytest.raises(PresetError, match=r"did you mean scum\?"):
        store.load("scun")


def test_names_that_share_a_file_name_get_two_files(tmp_path):
    store = PresetStore(tmp_path)
    store.save(make("a?"))
    store.save(make("a%3f"))
    store.save(make("a%3F", note="the same as a%3f"), replace=True)
    assert [each.name for each in store.presets()] == ["a%3F", "a?"]
    assert len(contents(tmp_path)) == 2


def test_one_name_for_two_methods(monkeypatch):
    known = {"stub": STUB, "other": dataclasses.replace(STUB, id="other")}
    know(monkeypatch, known)
    both = (make("a"), make("a", method="other", parameters={}))
    assert pick(both, "a", "other").method == "other"
    assert pick(both, "stub/a").method == "stub"
    with pytest.raises(PresetError, match="Several methods have a preset called a"):
        pick(both, "a")


def test_import_and_export(tmp_path):
    store = PresetStore(tmp_path / "store")
    store.save(make("foam", note="mine"))
    path = store.export("foam", tmp_path)
    assert path.name == "stub-foam.json"
    with pytest.raises(PresetError, match="is there already"):
        export_preset(store.load("foam"), path)
    with pytest.raises(PresetError, match="already"):
        store.import_file(path)
    assert store.import_file(path, name="two").name == "two"
    assert store.import_file(path, replace=True).note == "mine"
    assert [each.name for each in store.presets()] == ["foam", "two"]


def test_a_file_that_cannot_be_used_is_reported_and_left_alone(tmp_path):
    store = PresetStore(tmp_path)
    store.save(make("good"))
    (tmp_path / "stub-bad.json").write_text("{")
    (tmp_path / "other.txt").write_text("no preset")
    (tmp_path / "folder.json").mkdir()
    assert [each.name for each in store.presets()] == ["good"]
    assert len(store.problems()) == 1
    assert "bad.json is not valid JSON" in store.problems()[0]
    store.save(make("bad"))
    assert (tmp_path / "stub-bad.json").read_text() == "{"
    assert store.load("bad").name == "bad"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_cannot_be_written(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(PresetError, match="cannot be written"):
        PresetStore(tmp_path).save(make())
    tmp_path.chmod(0o700)


def test_a_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    store = PresetStore(tmp_path)
    store.save(make("foam", note="old"))
    before = contents(tmp_path)

    def fail(*_):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, "replace", fail)
        with pytest.raises(PresetError, match=r"cannot be written \(No space left on device\)\.$"):
            store.save(make("foam", note="new"), replace=True)
    assert contents(tmp_path) == before


# Bundled


def test_bundled_presets_are_usable_and_named_after_their_files():
    presets = bundled_presets()
    assert len({each.key for each in presets}) == len(presets)
    for each in presets:
        assert each.params() is not None
        assert len(each.note) > 20
        assert set(file_name(each)) <= set(string.ascii_lowercase + string.digits + "-.")


def test_find_by_file_then_own_then_bundled(tmp_path):
    store = PresetStore(tmp_path / "store")
    write_preset(make("from a file"), tmp_path / "x.json")
    assert find_preset(str(tmp_path / "x.json"), store).name == "from a file"
    with pytest.raises(PresetError, match="is for the method"):
        find_preset(str(tmp_path / "x.json"), store, "another")
    for each in bundled_presets():
        assert find_preset(each.name, store, each.method) == each
        store.save(Preset(name=each.name, method=each.method, note="my own"))
        assert find_preset(f"{each.method}/{each.name}", store).note == "my own"


@pytest.mark.parametrize("name", ["\N{GRINNING FACE}" * 60, "?" * 60, "\u00e9" * 60, "x" * 60])
def test_the_longest_names_fit_into_a_file_name(tmp_path, name):
    store = PresetStore(tmp_path)
    preset = make(name, method="heeger-bergen", parameters={})
    assert len(file_name(preset).encode()) <= 250
    store.save(preset)
    assert store.load(name) == preset
    # Names that differ only where they are cut get files of their own.
    if len(name.encode()) > 200:
        store.save(make(name[:-1], method="heeger-bergen", parameters={}))
    assert store.load(name) == preset
    assert store.problems() == ()


def test_a_path_without_a_method_is_no_method():
    with pytest.raises(PresetError, match=r"There is no preset of stub called '/dev/null'"):
        pick((), "/dev/null", "stub")
