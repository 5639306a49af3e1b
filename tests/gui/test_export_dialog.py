"""Export in the window: names beforehand, the same core as the command line, progress and stopping."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pypdf
import pytest
from mouse import on_screen
from PIL import Image
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QPushButton

from tests.gui.conftest import ids, result_image, wait_idle
from texlab.state.chosen import Sample
from texlab.window.export_desk import column_items, foreseen
from texlab.window.export_dialog import ExportDialog, ExportRequest
from texlab_core.documents.record import read_recipe
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def opened(explorer: Any, qtbot: Any) -> Any:
    explorer.window.actions_by_name["export-many"].trigger()
    dialog = explorer.handlers.exports.dialog
    on_screen(qtbot, dialog.run_button)
    return dialog


def run(qtbot: Any, dialog: ExportDialog) -> None:
    qtbot.waitUntil(dialog.run_button.isEnabled)
    qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)


def press(qtbot: Any, dialog: ExportDialog) -> None:
    run(qtbot, dialog)
    qtbot.waitUntil(lambda: dialog.folder_button.isEnabled())


def test_the_chosen_column_is_written_with_seeds_and_sizes(
    explorer: Any, opened: ExportDialog, qtbot: Any, tmp_path: Path
) -> None:
    opened.out.clear()
    assert opened.names.text() == "Say where to write to."
    assert not opened.run_button.isEnabled()
    opened.out.setText(str(tmp_path / "made"))
    opened.seeds.setText("5..6")
    opened.sizes.setText("48x48,24x20")
    names = [f"waves-heeger-bergen-{size}-seed{seed}.png" for size in ("48x48", "24x20") for seed in (5, 6)]
    assert opened.names.text().splitlines() == names
    press(qtbot, opened)
    assert sorted(path.name for path in (tmp_path / "made").iterdir()) == sorted(names)
    assert opened.message.text() == f"Written: 4 files in {tmp_path / 'made'}."
    chosen = explorer.session.selected_id
    values = read_image(tmp_path / "made" / names[0], "a").values
    np.testing.assert_array_equal(values, np.rint(result_image(explorer, chosen).astype(np.float64) * 255))
    assert read_recipe(tmp_path / "made" / names[3]).size == (20, 24)
    qtbot.mouseClick(opened.path_button, Qt.MouseButton.LeftButton)
    assert QGuiApplication.clipboard().text().splitlines()[0] == str(tmp_path / "made" / names[0])


def test_a_column_is_written_with_its_own_seed(explorer: Any, qtbot: Any) -> None:
    column_id = explorer.session.selected_id
    explorer.session.set_column_seed(column_id, explorer.session.state.seed + 6)
    wait_idle(qtbot, explorer)
    (item,) = column_items(explorer.controller, (column_id,))
    assert item.job.seed == explorer.session.state.seed + 6
    assert item.result is not None
    assert item.result.image is result_image(explorer, column_id)


def test_the_names_follow_the_columns(explorer: Any, opened: ExportDialog, qtbot: Any, tmp_path: Path) -> None:
    session, (first, second) = explorer.session, ids(explorer)
    opened.out.setText(str(tmp_path))
    opened.pattern.setText("{title}-{seed}-{size}")
    for row in range(2):
        opened.columns.item(row).setCheckState(Qt.CheckState.Checked)

    def shows(*more: str) -> bool:
        """Whether what is shown is what is asked for now."""
        request = opened.request()
        wanted = "\n".join(foreseen(request, column_items(explorer.controller, request.columns)))
        return opened.names.text() == wanted and all(each in wanted for each in more)

    qtbot.waitUntil(shows)
    session.set_column_seed(first, 41)
    qtbot.waitUntil(lambda: shows("-41-"))
    session.set_size((24, 24))
    qtbot.waitUntil(lambda: shows("-41-24x24"))
    session.rename_column(first, "Mine")
    qtbot.waitUntil(lambda: shows("Mine-41-24x24"))
    assert opened.columns.things[0] == (first, "Mine")
    # What was ticked stays so; what was emptied is not filled.
    opened.columns.item(1).setCheckState(Qt.CheckState.Unchecked)
    session.remove_column(second)
    qtbot.waitUntil(lambda: opened.columns.things == [(first, "Mine")])
    assert opened.columns.ticked == (first,)
    opened.out.clear()
    session.undo()
    qtbot.waitUntil(lambda: len(opened.columns.things) == 2)
    assert opened.columns.ticked == (first,)
    assert opened.names.text() == "Say where to write to."
    # An animation is of the column that is chosen.
    opened.kind.setCurrentIndex(2)
    for column, title in opened.columns.things:
        session.select(column)
        qtbot.waitUntil(lambda title=title: opened.names.text().endswith(f", of {title}"))
    wait_idle(qtbot, explorer)


def test_a_figure_of_all_columns(explorer: Any, opened: ExportDialog, qtbot: Any, tmp_path: Path) -> None:
    opened.kind.setCurrentIndex(1)
    opened.out.setText(str(tmp_path / "a.txt"))
    assert opened.names.text() == "The name of a figure ends in .pdf or .svg."
    opened.out.setText(str(tmp_path / "a.pdf"))
    for row in range(opened.columns.count()):
        opened.columns.item(row).setCheckState(Qt.CheckState.Checked)
    opened.width_cm.setText("8,5")
    assert opened.names.text() == "a.pdf, 2 panels"
    press(qtbot, opened)
    page = pypdf.PdfReader(tmp_path / "a.pdf").pages[0]
    assert float(page.mediabox.width) == pytest.approx(8.5 / 2.54 * 72, abs=1e-3)
    assert "iterations 1" in page.extract_text()


def test_an_exemplar_that_comes_while_the_fields_are_shown_is_said(
    explorer: Any, opened: ExportDialog, qtbot: Any
) -> None:
    assert opened.names.text().startswith("waves-")
    other = as_exemplar(np.random.default_rng(5).random((40, 48, 1), np.float32), name="other")
    explorer.session.set_sample(Sample(other))
    qtbot.waitUntil(lambda: opened.names.text().startswith("other-"))
    assert opened.run_button.isEnabled()


def test_an_animation(explorer: Any, opened: ExportDialog, qtbot: Any, tmp_path: Path) -> None:
    opened.kind.setCurrentIndex(2)
    opened.out.setText(str(tmp_path / "a.webp"))
    opened.motion.setEditText("iterations=1:4:4")
    press(qtbot, opened)
    with Image.open(tmp_path / "a.webp") as movie:
        assert (movie.n_frames, movie.info["loop"]) == (4, 0)


def test_what_is_there_is_replaced_only_when_that_is_said(
    opened: ExportDialog, qtbot: Any, tmp_path: Path
) -> None:
    made = tmp_path / "made"
    made.mkdir()
    opened.out.setText(str(made))
    opened.sizes.setText("16")
    opened.seeds.setText("5..9")
    names = opened.names.text().splitlines()
    for name in names[:4]:
        (made / name).write_text("mine")
    run(qtbot, opened)
    said = f"4 files are there already: {', '.join(names[:3])} and 1 more. Replace, or write elsewhere."
    qtbot.waitUntil(lambda: opened.message.text() == said)
    assert opened.run_button.text() == "Replace"
    assert sorted(each.name for each in made.iterdir()) == sorted(names[:4])
    # Another edit, another question.
    opened.seeds.setText("6")
    assert (opened.run_button.text(), opened.message.text()) == ("Export", "")
    run(qtbot, opened)
    qtbot.waitUntil(lambda: opened.message.text().startswith(f"One file is there already: {names[1]}."))
    press(qtbot, opened)
    assert read_recipe(made / names[1]).seed == 6
    assert (made / names[0]).read_text() == "mine"
    assert opened.run_button.text() == "Export"
    # It would replace what it has just written.
    run(qtbot, opened)
    qtbot.waitUntil(lambda: opened.run_button.text() == "Replace")


def test_what_the_file_dialog_has_asked_about_is_not_asked_again(
    opened: ExportDialog, qtbot: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.svg"
    path.write_text("mine")
    monkeypatch.setattr("texlab.window.export_dialog.QFileDialog.getSaveFileName", lambda *_: (str(path), ""))
    opened.kind.setCurrentIndex(1)
    opened.sizes.setText("16")
    qtbot.mouseClick(opened.findChild(QPushButton, "export-out-choose"), Qt.MouseButton.LeftButton)
    press(qtbot, opened)
    assert path.read_text().startswith("<")


def test_only_files_that_were_named_are_replaced(
    explorer: Any, opened: ExportDialog, qtbot: Any, tmp_path: Path
) -> None:
    opened.out.setText(str(tmp_path))
    opened.sizes.setText("16")
    opened.pattern.setText("{name}-{method}-{seed}")
    column_id = explorer.session.selected_id
    first, second = (tmp_path / f"waves-heeger-bergen-{seed}.png" for seed in (1, 2))
    for seed, path in ((1, first), (2, second)):
        path.write_text("mine")
        explorer.session.set_column_seed(column_id, seed)
        wait_idle(qtbot, explorer)
        # The second time the button means the first file alone.
        run(qtbot, opened)
        qtbot.waitUntil(
            lambda path=path: opened.message.text().startswith(f"One file is there already: {path.name}.")
        )
        assert opened.run_button.text() == "Replace"
    assert (first.read_text(), second.read_text()) == ("mine", "mine")
    press(qtbot, opened)
    assert first.read_text() == "mine"
    assert read_recipe(second).seed == 2


def test_what_is_found_for_another_folder_is_no_leave_to_replace(
    opened: ExportDialog, qtbot: Any, tmp_path: Path
) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    opened.out.setText(str(one))
    opened.sizes.setText("16")
    name = opened.names.text()
    for folder in (one, other):
        folder.mkdir()
        (folder / name).write_text("mine")
    run(qtbot, opened)
    # Its answer comes with the next turn of the loop, at the soonest.
    opened.out.setText(str(other))
    qtbot.waitUntil(
        lambda: opened.message.text() == "Nothing was written: what is asked for has changed meanwhile."
    )
    assert opened.run_button.text() == "Export"
    run(qtbot, opened)
    qtbot.waitUntil(lambda: opened.message.text().startswith("One file is there already"))
    assert [(folder / name).read_text() for folder in (one, other)] == ["mine", "mine"]
    # What the desk is told is what was named, whatever the button says.
    assert opened.request().replace == {other / name}


def test_a_growth_says_how_many_pictures_it_has(opened: ExportDialog, qtbot: Any, tmp_path: Path) -> None:
    opened.kind.setCurrentIndex(2)
    opened.out.setText(str(tmp_path / "frames"))
    opened.frames.setValue(40)
    press(qtbot, opened)
    pictures = [read_image(each, "a").values for each in sorted((tmp_path / "frames").iterdir())]
    assert len(pictures) == 40
    shown = 1 + sum(not np.array_equal(one, other) for one, other in pairwise(pictures))
    assert 1 < shown < 40
    assert opened.message.text().endswith(
        f"Its 40 frames show {shown} different pictures: a run of this method shows no more."
    )
    # Frames that are there already are told, too.
    run(qtbot, opened)
    qtbot.waitUntil(lambda: opened.message.text().startswith("40 files are there already: frame-0001.png, "))


def test_what_fails_is_said_in_the_dialog(explorer: Any, opened: ExportDialog, qtbot: Any, tmp_path: Path) -> None:
    opened.out.setText(str(tmp_path / "none" / "made"))
    run(qtbot, opened)
    qtbot.waitUntil(lambda: "cannot be made" in opened.message.text())
    assert opened.run_button.isEnabled()
    assert not opened.folder_button.isEnabled()


def test_it_can_be_stopped(explorer: Any, opened: ExportDialog, qtbot: Any, tmp_path: Path) -> None:
    opened.out.setText(str(tmp_path / "made"))
    opened.seeds.setText("1..200")
    run(qtbot, opened)
    assert opened.stop_button.isEnabled()
    qtbot.mouseClick(opened.stop_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: opened.message.text() == "Stopped; nothing was written.")
    assert list(tmp_path.glob("made/*")) == []


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"columns": ()}, "at least one column"),
        ({"out": ""}, "Say where"),
        ({"seeds": "4..1"}, "seeds"),
        ({"sizes": "9x"}, "sizes"),
        ({"pattern": "{x}"}, "name"),
        ({"pattern": "a", "seeds": "1,2"}, "add {seed}"),
        ({"bits": "float"}, "8 or 16"),
        ({"quality": 50}, "loses nothing"),
        ({"kind": "figure", "out": "a.pdf", "width": "wide"}, "width"),
        ({"kind": "figure", "out": "a.pdf", "width": "1"}, "width"),
        ({"kind": "animation", "motion": "dance", "out": "a.gif"}, "animate"),
        ({"kind": "animation", "out": "a.avi"}, ".mp4"),
    ],
)
def test_what_cannot_be_is_said_beforehand(explorer: Any, changes: dict[str, Any], said: str) -> None:
    asked = ExportRequest(
        **({"kind": "files", "columns": tuple(ids(explorer)[:1]), "seeds": "", "sizes": "", "out": "x"} | changes)
    )
    with pytest.raises(InputError) as caught:
        foreseen(asked, column_items(explorer.controller, asked.columns))
    assert said in str(caught.value)


def test_every_field_has_a_name_and_a_tip(qtbot: Any) -> None:
    dialog = ExportDialog()
    qtbot.addWidget(dialog)
    for _, widget, *_ in dialog._rows():
        assert widget.accessibleName()
        assert widget.toolTip()
        assert widget.objectName().startswith("export-")
