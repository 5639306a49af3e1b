"""What the program chooses by itself is said, and the rest offered: scale, transparency, depth, column."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QFileDialog

from tests.gui.conftest import hb, ids, wait_idle
from texlab.state.changes import as_a_whole, at_full_size, is_reduced, reduced_words, sample_of
from texlab.state.chosen import Sample
from texlab.state.session import Session
from texlab.window.save_kinds import chosen_bits, named, save_kinds, saved_words
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.writing import check_format
from texlab_core.images.unit_range import TRANSPARENCY, use_of_alpha

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.app.explorer import Explorer

CONTROL = Qt.KeyboardModifier.ControlModifier
LEFT = Qt.MouseButton.LeftButton


@pytest.mark.parametrize("depth", [8, 16, "float"])
def test_every_kind_can_be_written_and_the_exemplars_depth_comes_first(depth: Any) -> None:
    kinds = save_kinds(depth)
    assert kinds[0].bits == depth
    assert len({kind.label for kind in kinds}) == len(kinds) == 7
    for kind in kinds:
        path = named("wall.v2", kind)
        assert path == Path(f"wall.v2{kind.suffix}")
        assert check_format(path, kind.bits) == kind.suffix
        assert chosen_bits(path, kind) == kind.bits
    assert [kind.suffix for kind in save_kinds(8, solid=True)] == [".tif", ".tif", ".tif", ".npy"]


def test_a_typed_suffix_wins_over_the_chosen_kind() -> None:
    png = next(kind for kind in save_kinds(16) if kind.suffix == ".png" and kind.bits == 16)
    tif = next(kind for kind in save_kinds(16) if kind.bits == "float")
    assert named("a.jpg", png) == Path("a.jpg")
    assert chosen_bits(Path("a.jpg"), png) is None
    assert chosen_bits(Path("a.TIFF"), tif) == "float"


def test_what_is_said_of_a_saved_file() -> None:
    assert (
        saved_words(Path("a.png"), 16, 16, "none")
        == "Saved a.png with its recipe, in 16 bits, as the exemplar has."
    )
    assert "the exemplar has 16 bits." in saved_words(Path("a.jpg"), 8, 16, "none")
    assert "carried along" in saved_words(Path("a.png"), 8, 8, "carried")
    assert "could not come along" in saved_words(Path("a.jpg"), 8, 8, "lost")


def test_a_large_picture_is_reduced_and_its_middle_offered() -> None:
    image = as_exemplar(np.random.default_rng(1).random((300, 4000)))
    sample = sample_of(image, None)
    assert is_reduced(sample)
    assert reduced_words(sample) == "shown at 6.4 % so that it fits 256 px"
    part = at_full_size(sample)
    assert (part.scale, part.crop.top, part.crop.left) == (1.0, 22, 1872)
    assert (part.crop.height, part.crop.width) == (256, 256)
    assert reduced_words(part) == ""
    assert as_a_whole(part) == sample
    small = Sample(as_exemplar(np.zeros((40, 30))))
    assert as_a_whole(small) == small
    assert not is_reduced(small)


def test_the_other_choices_are_taken_from_the_exemplars_menu(
    qtbot: Any, open_window: Callable[..., Explorer], tmp_path: Path
) -> None:
    path = tmp_path / "glass.png"
    pixels = np.random.default_rng(2).integers(0, 256, (40, 512, 4), np.uint8)
    Image.fromarray(pixels).save(path)
    explorer = open_window(str(path), [("tiling", hb_params("tiling"))])
    exemplar = explorer.workspace.exemplar
    assert exemplar.scale_box.text() == "50 %"
    assert exemplar.choices.accessibleName() == "shown at 50 % so that it fits 256 px; change"
    assert "shown at 50 % so that it fits 256 px" in exemplar.line.toolTip().replace("\n", " ")

    def choose(name: str) -> None:
        menu = exemplar.choices.menu()
        next(each for each in menu.actions() if each.objectName() == name).trigger()

    choose("exemplar-part")
    wait_idle(qtbot, explorer)
    sample = explorer.session.state.sample
    assert (sample.scale, sample.crop.width, sample.crop.height) == (1.0, 256, 40)
    for use, (alpha, background) in TRANSPARENCY.items():
        choose(f"exemplar-alpha-{use}")
        qtbot.waitUntil(lambda use=use: explorer.session.state.sample.alpha == use)
        wait_idle(qtbot, explorer)
        right = as_exemplar(str(path), alpha=alpha, background=background, crop=sample.crop)
        assert np.array_equal(explorer.controller.exemplar.pixels, right.pixels)
        assert use_of_alpha(right.notes) == alpha
    target = tmp_path / "out.png"
    explorer.opener.save(explorer.controller.column_scene(ids(explorer)[0]).result, str(target))
    qtbot.waitUntil(target.exists)
    assert explorer.window.status.errand.text() in ("Saving ...", "")
    wait_idle(qtbot, explorer)
    assert read_image(target, "out.png").values.shape[2] == 4
    assert explorer.window.status.errand.text() == ""
    explorer.session.undo()
    assert explorer.session.state.sample.alpha == "ignore"
    explorer.window.close()
    again = open_window(None)
    assert again.session.state.sample.alpha == "ignore"


def hb_params(name: str) -> Any:
    from texlab_core.engine.registry import methods

    return methods()[name].params()


def test_saving_is_seen_and_keeps_the_exemplars_depth(
    qtbot: Any, open_window: Callable[..., Explorer], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, target = tmp_path / "deep.png", tmp_path / "out"
    Image.fromarray(np.random.default_rng(2).integers(0, 65536, (40, 40)).astype(np.uint16)).save(path)
    explorer = open_window(str(path), [hb()])
    offered: list[str] = []

    def ask(*arguments: Any) -> tuple[str, str]:
        offered.extend(arguments[-1].split(";;"))
        return str(target), offered[0]

    monkeypatch.setattr(QFileDialog, "getSaveFileName", ask)
    seen: list[str] = []
    explorer.controller.errands_changed.connect(lambda _: seen.append(explorer.window.status.errand.text()))
    explorer.exchange.export(ids(explorer)[0])
    qtbot.waitUntil(target.with_suffix(".png").exists)
    wait_idle(qtbot, explorer)
    assert offered[0] == "PNG, 16 bits (*.png)"
    assert read_image(target.with_suffix(".png"), "out").values.dtype == np.uint16
    assert seen == ["Saving ...", ""]
    assert "in 16 bits, as the exemplar has" in explorer.window.message_bar.label.text()


def test_a_column_that_comes_back_is_chosen(qapp: Any) -> None:
    session = Session()
    made = [session.add_column(*hb()) for _ in range(3)]
    session.select(made[1])
    session.remove_column(made[1])
    assert session.selected_id == made[2]
    session.undo()
    assert session.selected_id == made[1]
    session.redo()
    session.select(made[0])
    session.undo()
    assert session.selected_id == made[1]
    session.select(made[2])
    session.set_columns([hb()], "one")
    session.undo()
    assert session.selected_id == made[2]


@pytest.mark.parametrize("part", ["line", "method_box", "progress", "run_button"])
def test_a_press_anywhere_on_a_card_chooses_its_column(qtbot: Any, explorer: Explorer, part: str) -> None:
    first, second = ids(explorer)
    explorer.session.select(first)
    view = explorer.workspace.columns[second]
    qtbot.mousePress(getattr(view, part), LEFT)
    assert explorer.session.selected_id == second
    if part == "method_box":
        # Its list has the keyboard now.
        view.method_box.hidePopup()
        return
    qtbot.mouseRelease(getattr(view, part), LEFT)
    wait_idle(qtbot, explorer)
    remove = explorer.window.findChild(QAction, "action-remove")
    assert remove.isEnabled()
    qtbot.keyClick(explorer.window, Qt.Key.Key_W, CONTROL)
    assert ids(explorer) == [first]
    wait_idle(qtbot, explorer)
