"""The preset bar and what is behind it: save, take, rename, delete, import, export; refusals change nothing."""

from __future__ import annotations

import json

import pytest
from bench import Bench, begin
from mouse import on_screen
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication, QComboBox, QFileDialog, QToolButton, QWidget

from tests.stub_method import StubParams, exemplar, stub  # noqa: F401
from texlab.presets.bar import PresetBar
from texlab.presets.dialog import PresetDialog
from texlab.presets.manager import PresetManager
from texlab.state.chosen import Column, Sample, State
from texlab.state.intentions import AskOnce, ChooseColumn, EditParams, Tell
from texlab_core.documents.presets import Preset, read_preset, write_preset
from texlab_core.engine.registry import find_method

pytestmark = pytest.mark.usefixtures("stub")
LEFT = Qt.MouseButton.LeftButton
PATIENCE_MS = 20_000
START = StubParams(grain=7.0)


def paper():
    return Preset(name="paper", method="stub", parameters={"level": 0.25, "border": "wrap"}, note="As printed.")


class PresetBench(Bench):
    """Session, controller, bar and manager, wired as in the window."""

    def __init__(self, qtbot, home):
        super().__init__(choose=lambda column_id: self.session.select(column_id))
        self.qtbot = qtbot
        self.folder = home / "config" / "presets"
        self.window = QWidget()
        qtbot.addWidget(self.window)
        self.bar = PresetBar(self.window)
        self.bar.resize(260, 30)
        self.window.resize(280, 200)
        self.window.show()
        on_screen(qtbot, self.window)
        self.manager = PresetManager(self.window, self.bar)
        self.manager.intention.connect(self.carrier.carry_out)
        self.problems, self.said = self.hear()
        columns = (Column(1, "stub", START), Column(2, "heeger-bergen", find_method("heeger-bergen").params()))
        self.session.changed.connect(lambda *_: self.show())
        self.session.selected.connect(lambda _: self.show())
        self.controller.exemplar_ready.connect(lambda prepared: self.manager.show_exemplar(prepared.exemplar))
        begin(self.session, *columns, seed=1, size=(16, 16))
        self.wait()

    def show(self):
        self.manager.show_session(self.session.state, self.session.selected_id)

    def wait(self):
        """Wait until nothing is read or written."""
        self.qtbot.waitUntil(lambda: not self.controller.busy, timeout=PATIENCE_MS)

    @property
    def params(self):
        return self.session.state.column(1).params

    @property
    def listed(self):
        return [self.bar.box.itemText(place) for place in range(self.bar.box.count())]

    @property
    def files(self):
        found = self.folder.iterdir() if self.folder.is_dir() else ()
        return {path.name: path.read_bytes() for path in found}

    def choose(self, text):
        """Choose a preset in the list with the keyboard."""
        box = self.bar.box
        box.setFocus()
        place = box.findText(text)
        assert place >= 0, text
        while box.currentIndex() != place:
            self.qtbot.keyClick(box, Qt.Key.Key_Down if place > box.currentIndex() else Qt.Key.Key_Up)

    def command(self, name):
        """Choose a command in the menu with the keyboard."""
        menu, wanted = self.bar.menu, self.bar.actions_by_name[name]
        assert wanted.isEnabled()
        assert wanted.isVisible()
        menu.popup(self.bar.mapToGlobal(QPoint(0, 30)))
        for _ in range(len(menu.actions())):
            self.qtbot.keyClick(menu, Qt.Key.Key_Down)
            if menu.activeAction() is wanted:
                break
        self.qtbot.keyClick(menu, Qt.Key.Key_Return)

    @property
    def dialog(self):
        return self.window.findChild(PresetDialog, "preset-dialog")

    def name(self, text):
        """Type a name into the dialog and accept it."""
        dialog = self.dialog
        dialog.name.selectAll()
        self.qtbot.keyClicks(dialog.name, text)
        self.qtbot.keyClick(dialog.name, Qt.Key.Key_Return)
        self.wait()

    def save(self, name):
        self.command("save")
        self.name(name)

    def file(self, path):
        """Choose a file in the file dialog."""
        dialog = self.window.findChild(QFileDialog, "preset-file-dialog")
        dialog.selectFile(str(path))
        dialog.accept()
        self.wait()


@pytest.fixture
def bench(qtbot, texlab_home, monkeypatch):
    monkeypatch.setattr(
        "texlab.presets.manager.bundled_presets", lambda method: [paper()] if method == "stub" else []
    )
    made = PresetBench(qtbot, texlab_home)
    yield made
    made.wait()
    assert not any(made.asked.values()), "nobody asked the window for anything"
    made.controller.close()


def document(**changes):
    data = {"format": "texlab-preset", "version": 1, "name": "foam", "method": "stub", "parameters": {}}
    return json.dumps(data | changes)


# The bar


def test_what_is_listed(bench):
    assert bench.listed == ["Presets", "paper"]
    assert bench.bar.box.itemData(1, Qt.ItemDataRole.ToolTipRole) == "As printed."
    assert bench.bar.current is None
    enabled = {name for name, action in bench.bar.actions_by_name.items() if action.isEnabled()}
    assert enabled - {"restore"} == {"save", "import"}
    assert not bench.bar.actions_by_name["restore"].isVisible()
    for control in (bench.bar.findChild(QComboBox), bench.bar.findChild(QToolButton)):
        assert control.objectName()
        assert control.toolTip()
        assert control.accessibleName()


def test_taking_a_preset_is_one_step_and_leaves_the_rest(bench):
    bench.choose("paper")
    assert bench.params == StubParams(grain=7.0, level=0.25, border="wrap")
    assert bench.session.undo_text == "preset paper"
    assert bench.bar.current == paper()
    # A bundled preset can be exported, and neither renamed nor deleted.
    actions = bench.bar.actions_by_name
    assert [actions[name].isEnabled() for name in ("rename", "delete", "export")] == [False, False, True]
    bench.session.undo()
    assert bench.params == START
    assert bench.session.undo_text is None


def test_a_changed_preset_is_no_longer_shown_as_chosen(bench):
    bench.choose("paper")
    bench.session.set_params(1, bench.params.replace(grain=8.0), "grain")
    # The preset says nothing of this knob.
    assert bench.bar.current == paper()
    bench.session.set_params(1, bench.params.replace(level=0.5), "level")
    assert bench.bar.current is None
    assert bench.bar.box.currentText() == "Presets"
    assert not bench.bar.actions_by_name["export"].isEnabled()


def test_another_method_has_its_own(bench):
    bench.save("mine")
    bench.session.select(2)
    bench.wait()
    assert bench.listed == ["Presets"]
    bench.session.select(1)
    bench.wait()
    assert bench.listed == ["Presets", "paper", "mine (own)"]
    # A preset that is still shown for another method is not taken.
    bench.session.select(2)
    bench.manager.take(paper())
    assert bench.session.undo_text is None
    bench.session.remove_column(2)
    bench.session.remove_column(1)
    bench.wait()
    assert bench.listed == ["Presets"]


# Saving


def test_save_and_take_again(bench, qtbot):
    bench.session.set_sample(Sample(exemplar()))
    bench.wait()
    bench.session.set_params(1, StubParams(level=3.5, rounds=4), "level")
    bench.wait()
    bench.command("save")
    dialog = bench.dialog
    assert dialog.name.text() == ""
    assert not dialog.ok.isEnabled()
    assert dialog.message.text() == ""
    qtbot.keyClicks(dialog.note, "Bright.")
    bench.name("Gleam / not")
    assert dialog.message.text().startswith("The name of a preset can hold no slash")
    assert dialog.isVisible()
    assert bench.files == {}
    bench.name("Gleam")
    assert bench.said == ["Saved the preset Gleam."]
    assert list(bench.files) == ["stub-Gleam.json"]
    kept = read_preset(bench.folder / "stub-Gleam.json")
    assert kept.params() == StubParams(level=3.5, rounds=4)
    assert kept.note == "Bright."
    assert kept.exemplar.name == "noise"
    assert bench.bar.box.currentText() == "Gleam (own)"
    bench.session.set_params(1, StubParams(), "reset")
    bench.choose("Gleam (own)")
    assert bench.params == StubParams(level=3.5, rounds=4)
    bench.wait()


def test_a_partial_preset_holds_what_differs(bench, qtbot):
    bench.command("save")
    dialog = bench.dialog
    qtbot.mouseClick(dialog.partial, LEFT, pos=QPoint(8, dialog.partial.height() // 2))
    bench.name("grainy")
    assert dict(read_preset(bench.folder / "stub-grainy.json").parameters) == {"grain": 7.0}


def test_a_preset_of_the_same_name_is_replaced_and_the_dialog_says_so(bench, qtbot):
    bench.command("save")
    qtbot.keyClicks(bench.dialog.note, "Keep this note.")
    bench.name("mine")
    bench.session.set_params(1, START.replace(level=1.5), "level")
    bench.command("save")
    dialog = bench.dialog
    qtbot.keyClicks(dialog.name, "MINE")
    assert dialog.ok.text() == "Replace"
    assert dialog.message.text() == "There is a preset called MINE; it will be replaced."
    qtbot.keyClick(dialog.name, Qt.Key.Key_Return)
    bench.wait()
    assert len(bench.files) == 1
    assert bench.listed == ["Presets", "paper", "MINE (own)"]
    assert bench.bar.current.params().level == 1.5
    # What is chosen is offered to be saved again, with its note.
    bench.command("save")
    assert bench.dialog.name.text() == "MINE"
    assert bench.dialog.ok.text() == "Replace"
    qtbot.keyClick(bench.dialog, Qt.Key.Key_Escape)
    assert len(bench.files) == 1


def test_an_own_preset_stands_for_the_bundled_one_of_its_name(bench):
    bench.save("Paper")
    assert bench.listed == ["Presets", "Paper (own)"]
    assert bench.bar.current.params() == START
    bench.command("delete")
    bench.wait()
    assert bench.listed == ["Presets", "paper"]


@pytest.mark.parametrize("name", ["a/b", "a\\b", " a", "a.", "x" * 61, "tab\there"])
def test_names_that_are_none(qtbot, name):
    dialog = PresetDialog("Save preset", "", [], is_new=True)
    qtbot.addWidget(dialog)
    dialog.open()
    dialog.name.setText(name)
    assert not dialog.ok.isEnabled()
    assert dialog.message.text().startswith("The name of a preset ")
    qtbot.keyClick(dialog.name, Qt.Key.Key_Return)
    assert dialog.isVisible()
    dialog.name.setText("good")
    assert dialog.ok.isEnabled()
    dialog.note.setPlainText("x" * 4001)
    assert not dialog.ok.isEnabled()
    dialog.reject()


# Renaming and deleting


def test_rename(bench, qtbot):
    bench.save("one")
    bench.save("two")
    bench.choose("one (own)")
    bench.command("rename")
    dialog = bench.dialog
    assert dialog.name.text() == "one"
    assert not dialog.note.isVisible()
    assert not dialog.ok.isEnabled()
    dialog.name.selectAll()
    qtbot.keyClicks(dialog.name, "Two")
    assert dialog.message.text() == "There is a preset called Two already."
    assert not dialog.ok.isEnabled()
    bench.name("One")
    assert bench.listed == ["Presets", "paper", "One (own)", "two (own)"]
    bench.command("rename")
    bench.name("three")
    assert bench.listed == ["Presets", "paper", "three (own)", "two (own)"]
    assert bench.bar.box.currentText() == "three (own)"
    assert len(bench.files) == 2
    assert bench.problems == []
    assert bench.params == START


def test_delete_and_bring_back(bench):
    bench.save("Salt & pepper")
    before = bench.files
    bench.command("delete")
    bench.wait()
    assert bench.files == {}
    assert bench.listed == ["Presets", "paper"]
    assert bench.bar.current is None
    restore = bench.bar.actions_by_name["restore"]
    assert restore.text() == "Bring back Salt && pepper"
    bench.command("restore")
    bench.wait()
    assert list(bench.files.values()) == list(before.values())
    assert bench.bar.box.currentText() == "Salt & pepper (own)"
    assert not restore.isVisible()
    assert bench.params == START


def test_bringing_back_does_not_replace(bench):
    bench.save("mine")
    bench.command("delete")
    bench.wait()
    bench.session.set_params(1, StubParams(level=4.0), "level")
    bench.save("mine")
    before = bench.files
    bench.command("restore")
    bench.wait()
    assert bench.problems == ["There is a preset of stub called mine already."]
    assert bench.files == before
    assert bench.bar.actions_by_name["restore"].isVisible()


def test_a_preset_that_vanished_is_one_sentence(bench):
    bench.save("mine")
    for path in bench.folder.iterdir():
        path.unlink()
    bench.command("delete")
    bench.wait()
    assert len(bench.problems) == 1
    assert "no preset of stub called 'mine'" in bench.problems[0]


# Files


def test_export_and_import(bench, tmp_path):
    bench.choose("paper")
    bench.command("export")
    dialog = bench.window.findChild(QFileDialog, "preset-file-dialog")
    assert dialog.selectedFiles()[0].endswith("stub-paper.json")
    bench.file(tmp_path / "sent")
    assert bench.said == [f"Exported to {tmp_path / 'sent.json'}."]
    assert read_preset(tmp_path / "sent.json") == paper()
    # What was chosen is chosen still.
    assert bench.bar.current == paper()
    other = Preset(name="from a friend", method="stub", parameters={"level": 2}, note="Try this.")
    write_preset(other, tmp_path / "gift.json")
    bench.command("import")
    bench.file(tmp_path / "gift.json")
    assert bench.said[1:] == ["The preset from a friend was imported."]
    assert bench.params == StubParams(grain=7.0, level=2.0, border="wrap")
    assert bench.session.undo_text == "preset from a friend"
    assert bench.bar.box.currentText() == "from a friend (own)"
    assert len(bench.files) == 1


def test_what_is_wanted_leaves_as_intentions(qtbot, tmp_path):
    window = QWidget()
    qtbot.addWidget(window)
    manager, wanted = PresetManager(window, PresetBar(window)), []
    manager.intention.connect(wanted.append)
    columns = (Column(4, "stub", START), Column(9, "stub", START), Column(2, "msg", find_method("msg").params()))
    manager.show_session(State(None, columns, 1, (16, 16), 10), 9)
    manager.take(paper())
    listing, edit = wanted
    assert isinstance(listing, AskOnce)
    assert edit == EditParams(9, paper().params(START), "preset paper")
    wanted.clear()
    manager.take(Preset(name="other", method="msg", parameters={}))
    manager.show_session(State(None, columns, 1, (16, 16), 10), 2)
    wanted.clear()
    manager.import_preset(paper())
    (reading,) = wanted
    read = reading.compute(lambda: False)
    wanted.clear()
    reading.done(read)
    # No column of the method is chosen: the first one takes it.
    assert wanted[:3] == [
        ChooseColumn(4),
        EditParams(4, paper().params(START), "preset paper"),
        Tell("The preset paper was imported."),
    ]
    assert [type(each) for each in wanted[3:]] == [AskOnce]


def test_an_imported_preset_goes_to_a_column_of_its_method(bench, tmp_path):
    write_preset(Preset(name="gift", method="stub", parameters={"level": 2}), tmp_path / "gift.json")
    bench.session.select(2)
    bench.wait()
    bench.manager.import_file(str(tmp_path / "gift.json"))
    bench.wait()
    assert bench.session.selected_id == 1
    assert bench.params.level == 2
    assert bench.listed == ["Presets", "paper", "gift (own)"]
    bench.session.duplicate_column(1)
    bench.session.select(3)
    bench.wait()
    write_preset(Preset(name="gift 2", method="stub", parameters={"level": 4}), tmp_path / "gift.json")
    bench.manager.import_file(str(tmp_path / "gift.json"))
    bench.wait()
    # The chosen column comes first.
    assert bench.session.state.column(3).params.level == 4
    assert bench.params.level == 2


HOSTILE = {
    "empty": "",
    "not JSON": "{",
    "no preset": "[1, 2]",
    "another format": document(format="texlab-sweep"),
    "newer": document(version=2),
    "version zero": document(version=0),
    "unknown key": document(extra=1),
    "unknown method": document(method="magic"),
    "unknown knob": document(parameters={"speed": 9}),
    "out of range": document(parameters={"level": 1e9}),
    "text for a number": document(parameters={"level": "high"}),
    "even window": document(parameters={"window": 4}),
    "NaN": document(parameters={"level": 0}).replace(": 0}", ": NaN}"),
    "infinite": document(parameters={"level": 0}).replace(": 0}", ": 1e999}"),
    "twice the same key": document(parameters={}).replace("{}", '{"level": 1, "level": 2}'),
    "deep": document(parameters={}).replace("{}", "[" * 100_000 + "]" * 100_000),
    "huge": document(note="x" * 3_000_000),
    "long number": document(parameters={"level": 0}).replace(": 0}", ": " + "9" * 10_000 + "}"),
    "bad name": document(name="../../etc/passwd"),
    "no name": document(name=""),
    "not UTF-8": b"\xff\xfe\x00\x01" * 40,
}


@pytest.mark.parametrize("what", HOSTILE)
def test_a_hostile_file_is_one_sentence_and_changes_nothing(bench, tmp_path, what):
    bench.save("mine")
    path = tmp_path / "hostile.json"
    content = HOSTILE[what]
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    state, files, listed = bench.session.state, bench.files, bench.listed
    bench.said.clear()
    bench.manager.import_file(str(path))
    bench.wait()
    assert len(bench.problems) == 1, bench.problems
    sentence = bench.problems[0]
    assert "hostile.json" in sentence
    assert sentence.endswith((".", ")"))
    assert "\n" not in sentence
    assert len(sentence) < 400
    assert "Error" not in sentence
    assert bench.session.state == state
    assert bench.session.undo_text is None
    assert bench.files == files
    assert bench.listed == listed
    assert bench.said == []


def test_missing_files_and_folders(bench, tmp_path):
    for path in (tmp_path / "gone.json", tmp_path):
        bench.problems.clear()
        bench.manager.import_file(str(path))
        bench.wait()
        assert len(bench.problems) == 1
        assert bench.files == {}


def test_importing_a_name_that_is_taken_changes_nothing(bench, tmp_path):
    bench.save("mine")
    before = bench.files
    write_preset(Preset(name="Mine", method="stub", parameters={"level": 2}), tmp_path / "mine.json")
    bench.manager.import_file(str(tmp_path / "mine.json"))
    bench.wait()
    assert bench.problems == ["There is a preset of stub called Mine already."]
    assert bench.files == before
    assert bench.params == START


def test_a_damaged_file_among_the_own_is_told_once(bench):
    bench.save("mine")
    (bench.folder / "broken.json").write_text("{", encoding="utf-8")
    for _ in range(3):
        bench.session.select(2)
        bench.wait()
        bench.session.select(1)
        bench.wait()
    assert len(bench.problems) == 1
    assert "broken.json" in bench.problems[0]
    assert bench.listed == ["Presets", "paper", "mine (own)"]
    assert (bench.folder / "broken.json").read_text(encoding="utf-8") == "{"


def test_cancelling_does_nothing(bench, qtbot):
    bench.command("import")
    dialog = bench.window.findChild(QFileDialog, "preset-file-dialog")
    dialog.reject()
    QApplication.processEvents()
    bench.command("save")
    qtbot.keyClick(bench.dialog, Qt.Key.Key_Escape)
    bench.wait()
    assert bench.files == {}
    assert bench.said == bench.problems == []
