"""``texlab presets``: every action, in words and as JSON; refusals are one sentence and change nothing."""

from __future__ import annotations

import json

import pytest

from tests.stub_method import stub  # noqa: F401
from texlab.cli.commands._options import own_presets
from texlab.cli.main import main

METHOD = "stub"
pytestmark = pytest.mark.usefixtures("stub")


@pytest.fixture
def call(capsys):
    def run(*words, code=0):
        assert main(["presets", *map(str, words)]) == code
        return capsys.readouterr()

    return run


def saved(call, name="foam", **options):
    words = [word for key, value in options.items() for word in (f"--{key}", value)]
    return json.loads(call("save", name, "--method", METHOD, "--json", *words).out)


def test_save_list_show(call):
    answer = saved(call, note="for foam", set="level=2")
    assert answer["method"] == METHOD
    assert answer["parameters"] == {"level": 2.0}
    listed = json.loads(call("--json").out)
    assert {"source": "own", "name": "foam", "note": "for foam"}.items() <= listed[0].items()
    assert call("list").out.startswith(f"{METHOD}/foam")
    assert "for foam" in (text := call("show", "foam", "--method", METHOD).out)
    assert "level=2.0" in text
    shown = json.loads(call("show", "foam", "--method", METHOD, "--json").out)
    assert shown == json.loads(call("--json", "show", "foam", "--method", METHOD).out)
    assert shown["format"] == "texlab-preset"


def test_export_import_rename_delete(call, tmp_path):
    saved(call)
    call("export", f"{METHOD}/foam", tmp_path)
    file = tmp_path / f"{METHOD}-foam.json"
    assert json.loads(file.read_text())["name"] == "foam"
    assert "is there already" in call("export", "foam", file, code=2).err
    call("export", "foam", file, "--replace")
    assert "already" in call("import", file, code=2).err
    call("import", file, "--name", "second")
    call("rename", "second", "third")
    assert [each.name for each in own_presets().presets()] == ["foam", "third"]
    call("delete", "third")
    call("import", file, "--replace")
    assert [each.name for each in own_presets().presets()] == ["foam"]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["show", "nothing-like-it"], "There is no preset called"),
        (["delete", "nothing-like-it"], "There is no preset called"),
        (["save", "a"], "say --method ID."),
        (["save", "a/b", "--method", METHOD], "can hold no slash"),
        (["save", "a", "--method", METHOD, "--set", "no_such=1"], "parameter name: must be"),
        (["save", "a", "--method", "no-such"], "method: must be one of"),
        (["list", "--method", "no-such"], "method: must be one of"),
        (["delete", "heeger-bergen/paper"], "heeger-bergen/paper comes with TexLab and stays as it is"),
        (["rename", "paper", "mine", "--method", "heeger-bergen"], "only your own can be renamed or deleted."),
        (["import", "."], "The preset . cannot be read"),
        (["import", "missing.json"], "cannot be read (No such file or directory)."),
        (["export", "foam", "missing/x.json"], "The folder missing does not exist."),
        (["export", "foam", ""], "The name of the file or folder to write is empty."),
        (["import", ""], "The name of the preset's file is empty."),
        (["export", "foam", f"{__file__}/x.json"], "test_presets_command.py does not exist."),
    ],
)
def test_refusals(call, words, says):
    saved(call)
    captured = call(*words, code=2)
    assert says in captured.err
    assert captured.err.count("\n") == 1
    assert captured.out == ""
    assert [each.name for each in own_presets().presets()] == ["foam"]


def test_files_that_cannot_be_used_are_listed(call):
    saved(call)
    (own_presets().folder / "bad.json").write_text("{")
    assert "not usable: The preset bad.json is not valid JSON" in call().out


def test_names_of_unusable_files_cannot_move_the_cursor(call):
    saved(call)
    (own_presets().folder / "a\x1b[2J\nb\u202e.json").write_text("{")
    shown = call().out
    assert all(each.isprintable() for each in shown.splitlines())
    assert shown.splitlines()[-1].startswith("not usable: The preset a")
