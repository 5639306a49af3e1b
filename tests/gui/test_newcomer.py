"""Somebody's first day: from a photograph to files that make themselves again, with the mouse and the keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pypdf
import pytest
import tifffile
from PIL import Image
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QFileDialog, QMenu, QSlider, QToolButton

from tests.gui.conftest import drag, handle_point, ids, result_image, wait_idle
from texlab.presets.dialog import PresetDialog
from texlab.style.pictures import to_picture
from texlab_core.engine.inputs import Crop
from texlab_core.engine.registry import methods
from texlab_core.images.formats.reading import read_image

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from PySide6.QtGui import QAction

    from texlab.app.explorer import Explorer

LEFT = Qt.MouseButton.LeftButton
PHOTO = (3000, 4000)


@pytest.fixture
def photo(tmp_path: Path) -> Path:
    """Twelve megapixels of 16 bits: pebbles of some 25 pixels."""
    rng = np.random.default_rng(12)
    rows, columns = (np.arange(side, dtype=np.float32) for side in PHOTO)
    pixels = np.empty(PHOTO, np.uint16)
    pixels[:] = 30000 + 9000 * np.sin(columns / 4)[None, :]
    pixels += (9000 + 9000 * np.sin(rows / 5)).astype(np.uint16)[:, None]
    pixels += rng.integers(0, 3000, PHOTO, np.uint16)
    path = tmp_path / "beach.tif"
    tifffile.imwrite(path, pixels)
    return path


class Hand:
    """What a hand does in the window, and nothing else."""

    def __init__(self, qtbot: Any, explorer: Explorer) -> None:
        self.qtbot = qtbot
        self.explorer = explorer
        self.window = explorer.window

    def click(self, widget: Any, place: QPoint | None = None) -> None:
        self.qtbot.mouseClick(widget, LEFT, pos=place or widget.rect().center())

    def write(self, field: Any, text: str, *, enter: bool = True) -> None:
        """Type over what stands in a field."""
        self.qtbot.mouseClick(field, LEFT)
        field.selectAll()
        self.qtbot.keyClicks(field, text)
        if enter:
            self.qtbot.keyClick(field, Qt.Key.Key_Return)

    def pick(self, menu: QMenu, action: QAction) -> None:
        """Press an entry of a menu, which the mouse has opened."""
        menu.popup(self.window.mapToGlobal(QPoint(20, 40)))
        self.qtbot.mouseClick(menu, LEFT, pos=menu.actionGeometry(action).center())

    def toolbar(self, name: str) -> None:
        self.click(self.window.toolbar.widgetForAction(self.window.actions_by_name[name]))

    def open(self, path: Path) -> None:
        """Press Open, and choose a file in the system's dialog."""
        before = self.explorer.session.state
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(QFileDialog, "getOpenFileNames", lambda *_: ([str(path)], ""))
            self.toolbar("open")
        self.qtbot.waitUntil(lambda: self.explorer.session.state is not before)

    def wait(self) -> None:
        wait_idle(self.qtbot, self.explorer)


def columns() -> list[tuple[str, Any]]:
    known = methods()
    return [(name, known[name].params()) for name in ("pixels", "de-bonet")]


def test_a_photograph_becomes_files_that_make_themselves_again(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, photo: Path, tmp_path: Path
) -> None:
    explorer = open_window(str(texture), columns(), size=64)
    hand = Hand(qtbot, explorer)
    open_photo(hand, photo)
    crop_it(hand)
    copy = tune_it(hand)
    compare_it(hand, copy)
    save_preset(hand)
    made = export_it(hand, tmp_path / "made")
    hand.window.menus["&File"].popup(hand.window.mapToGlobal(QPoint(5, 30)))
    hand.pick(hand.window.menus["&File"], hand.window.actions_by_name["quit"])
    assert not explorer.window.isVisible()
    again = Hand(qtbot, open_window(None))
    come_back(again)
    make_it_again(again, made[2])


def open_photo(hand: Hand, photo: Path) -> None:
    """It is read reduced, which is said beside it with what else can be had."""
    explorer, exemplar = hand.explorer, hand.explorer.workspace.exemplar
    hand.open(photo)
    hand.wait()
    assert exemplar.title.text() == "beach.tif"
    assert exemplar.line.text().startswith("shown at 6.4 % so that it fits 256 px")
    assert exemplar.scale_box.text() == "6.4 %"
    assert explorer.controller.exemplar.size == (192, 256)
    assert explorer.controller.exemplar.depth == 16


def crop_it(hand: Hand) -> None:
    """A part of 64 x 64 at 50 %, typed."""
    exemplar = hand.explorer.workspace.exemplar
    hand.write(exemplar.scale_box, "50 %")
    hand.qtbot.waitUntil(lambda: exemplar.pane.picture.shape[:2] == (1500, 2000))
    hand.click(exemplar.crop_button)
    hand.click(exemplar.more)
    panel = exemplar.panel
    # What is typed first takes the place of what stands there.
    assert panel.boxes["x"].lineEdit().selectedText() == "500"
    hand.qtbot.keyClicks(panel.boxes["x"], "480")
    hand.qtbot.keyClick(panel.boxes["x"], Qt.Key.Key_Return)
    for name, text in (("y", "300"), ("width", "64"), ("height", "64")):
        hand.write(panel.boxes[name], text)
    hand.qtbot.keyClick(panel, Qt.Key.Key_Escape)
    hand.wait()
    sample = hand.explorer.session.state.sample
    assert (sample.scale, sample.crop) == (0.5, Crop(300, 480, 64, 64))
    assert exemplar.scale_box.text() == "50 %"
    line = exemplar.line.text().replace("\n", " ")
    assert line == "64 x 64 gray at 480, 300 of 2000 x 1500, 4000 x 3000 scaled to 50 %"


def tune_it(hand: Hand) -> int:
    """A copy of De Bonet is A, what it was copied from B; return the id of the copy."""
    explorer, tuning = hand.explorer, hand.explorer.tuning
    _, first = ids(explorer)
    views = explorer.workspace.columns
    hand.click(views[first].pane.viewport())
    hand.pick(hand.window.toolbar.layout_menu, hand.window.actions_by_name["layout-tune"])
    hand.window.toolbar.layout_menu.aboutToShow.emit()
    assert hand.window.actions_by_name["layout-tune"].isChecked()
    assert hand.window.front_dock() == "thresholds"
    assert tuning.a == first
    hand.click(tuning.bar.copy)
    hand.wait()
    copy = ids(explorer)[-1]
    assert (tuning.a, tuning.b) == (copy, first)
    assert [views[each].badge.text() for each in ids(explorer)] == ["", "B", "A"]
    assert [each for each in ids(explorer) if views[each].isVisible()] == [first, copy]
    # The part that is used fills its pane, frame and all.
    shown = explorer.workspace.exemplar.pane.view_rect()
    assert shown.contains(480, 300)
    assert shown.contains(543, 363)
    assert min(shown.width(), shown.height()) < 70
    slider = hand.window.findChild(QSlider, "slider-alpha")
    drag(hand.qtbot, slider, [handle_point(slider), handle_point(slider, 0.5), handle_point(slider, 0.7)])
    hand.wait()
    alphas = [explorer.session.state.column(each).params.alpha for each in (first, copy)]
    assert alphas[0] == methods()["de-bonet"].params().alpha < alphas[1]
    label = views[copy].method_box.label
    assert label.startswith("De Bonet, alpha ")
    assert tuning.bar.words.text() == f"A {label}"
    assert tuning.bar.other.currentText() == views[first].method_box.label != label
    return copy


def compare_it(hand: Hand, copy: int) -> None:
    """Flicker, swipe, difference and magnifier, by the buttons below the pictures and by keys."""
    explorer, bar = hand.explorer, hand.explorer.tuning.bar
    comparison, views = explorer.tuning.comparison, explorer.workspace.columns
    a, b = (to_picture(result_image(explorer, each)) for each in (copy, explorer.tuning.b))
    assert not np.array_equal(a, b)
    flicker, swipe, magnifier = (
        bar.findChild(QToolButton, f"compare-{name}") for name in ("flicker", "swipe", "magnifier")
    )
    hand.click(flicker)
    assert np.array_equal(comparison.layer, b)
    hand.click(flicker)
    assert comparison.layer is None
    hand.click(swipe)
    assert np.array_equal(comparison.layer, b[:, 32:])
    hand.click(swipe)
    hand.click(magnifier)
    pane, exemplar = views[copy].pane, explorer.workspace.exemplar.pane
    hand.qtbot.mouseMove(pane.viewport(), pane.to_widget(20.5, 30.5).toPoint())
    magnifiers = explorer.tuning._magnifiers
    hand.qtbot.waitUntil(lambda: magnifiers[pane].isVisible())
    assert np.array_equal(magnifiers[pane].piece, a[12:29, 22:39])
    # The same place of the part of the exemplar that is used.
    assert np.array_equal(magnifiers[exemplar].piece, exemplar.picture[312:329, 502:519])
    hand.click(magnifier)
    # Another column can be B.
    place = bar.other.findText("Independent pixels")
    bar.other.setCurrentIndex(place)
    bar.other.activated.emit(place)
    assert explorer.tuning.b == ids(explorer)[0]
    assert views[ids(explorer)[0]].isVisible()


def save_preset(hand: Hand) -> None:
    """Below the list of presets, under a name."""
    bar = hand.window.parameters.presets
    hand.pick(bar.menu, bar.actions_by_name["save"])
    dialog = hand.window.findChild(PresetDialog, "preset-dialog")
    hand.write(dialog.name, "my beach", enter=False)
    hand.click(dialog.ok)
    hand.wait()
    assert bar.box.currentText() == "my beach (own)"


def export_it(hand: Hand, folder: Path) -> list[Path]:
    """Four seeds as deep as the exemplar, a figure, an animation; return the files of the seeds."""
    exports = hand.explorer.handlers.exports
    hand.pick(hand.window.menus["&File"], hand.window.actions_by_name["export-many"])
    dialog = exports.dialog
    titles = [dialog.columns.item(row).text() for row in range(dialog.columns.count())]
    assert titles == [view.method_box.label for view in hand.explorer.workspace.columns.values()]
    assert dialog.bits.currentText() == "as the exemplar (16 bits)"
    # Where to write to is proposed; what it needs stands there at once.
    assert dialog.run_button.isEnabled()
    assert dialog.names.text() == "beach-de-bonet-64x64-seed5.png"
    hand.write(dialog.out, str(folder), enter=False)
    hand.write(dialog.seeds, "1-4", enter=False)
    hand.write(dialog.sizes, "96", enter=False)

    def run() -> tuple[Path, ...]:
        exports.written = ()
        hand.click(dialog.run_button)
        hand.qtbot.waitUntil(lambda: bool(exports.written))
        return exports.written

    made = list(run())
    assert [path.name for path in made] == [f"beach-de-bonet-96x96-seed{seed}.png" for seed in (1, 2, 3, 4)]
    for path in made:
        values = read_image(path, path.name).values
        assert (values.shape, values.dtype) == ((96, 96, 1), np.uint16)
        assert len(np.unique(values)) > 256
    hand.qtbot.keyClick(dialog.kind, Qt.Key.Key_Down)
    # It stands beside the files, under a name that says what it is of.
    assert dialog.out.text().endswith("beach.pdf")
    assert dialog.message.text() == ""
    hand.write(dialog.out, str(folder / "four.pdf"), enter=False)
    (figure,) = run()
    text = pypdf.PdfReader(figure).pages[0].extract_text()
    assert all(f"seed {seed}" in text for seed in (1, 2, 3, 4))
    hand.qtbot.keyClick(dialog.kind, Qt.Key.Key_Down)
    assert dialog.out.text().endswith("beach.webp")
    assert dialog.names.text().startswith("beach.webp, of De Bonet, alpha ")
    hand.write(dialog.out, str(folder / "growth.webp"), enter=False)
    (movie,) = run()
    with Image.open(movie) as shown:
        assert shown.n_frames > 1
        assert shown.info["loop"] == 0
    hand.click(dialog.close_button)
    return made


def come_back(hand: Hand) -> None:
    """Everything is as it was left: the part of the photograph, the pair, the preset."""
    explorer = hand.explorer
    sample = explorer.session.state.sample
    assert (sample.source.name, sample.scale, sample.crop) == ("beach.tif", 0.5, Crop(300, 480, 64, 64))
    assert explorer.tuning.active
    assert explorer.tuning.bar.isVisible()
    assert sum(view.isVisible() for view in explorer.workspace.columns.values()) == 2
    assert hand.window.layouts.current == "tune"
    assert hand.window.parameters.presets.box.findText("my beach (own)") >= 0


def make_it_again(hand: Hand, file: Path) -> None:
    """From its own file alone, to the bit."""
    explorer = hand.explorer
    hand.open(file)
    hand.wait()
    state = explorer.session.state
    assert (state.seed, state.size) == (3, (96, 96))
    made = result_image(explorer, explorer.session.selected_id)
    stored = read_image(file, file.name).values
    assert np.array_equal(np.rint(made[..., :1].astype(np.float64) * 65535), stored)
