"""What is dropped or pasted: always a copy, several at once, or one sentence why not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PIL import Image
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragMoveEvent, QDropEvent, QImage
from PySide6.QtWidgets import QApplication

from tests.gui.conftest import wait_idle
from texlab.widgets.mime import brought_by, can_bring
from texlab.widgets.pasted import Pasted

if TYPE_CHECKING:
    from pathlib import Path

    from texlab.app.explorer import Explorer

ACTION = Qt.DropAction
LEFT = Qt.MouseButton.LeftButton
SHIFT = Qt.KeyboardModifier.ShiftModifier


def files(*paths: Path) -> QMimeData:
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    return mime


def drop(window: Any, mime: QMimeData) -> None:
    plain = Qt.KeyboardModifier.NoModifier
    QApplication.sendEvent(window, QDragEnterEvent(QPoint(9, 9), ACTION.CopyAction, mime, LEFT, plain))
    QApplication.sendEvent(window, QDropEvent(QPointF(9, 9), ACTION.CopyAction, mime, LEFT, plain))


@pytest.mark.parametrize(
    ("possible", "taken"),
    [
        (ACTION.CopyAction, ACTION.CopyAction),
        (ACTION.CopyAction | ACTION.MoveAction, ACTION.CopyAction),
        (ACTION.CopyAction | ACTION.MoveAction | ACTION.LinkAction, ACTION.CopyAction),
        (ACTION.MoveAction, ACTION.IgnoreAction),
        (ACTION.LinkAction, ACTION.IgnoreAction),
    ],
)
def test_a_drop_is_a_copy_or_nothing(
    explorer: Explorer, texture: Path, possible: Qt.DropAction, taken: Qt.DropAction
) -> None:
    """The shift key asks for a move, after which a file manager deletes the file."""
    mime, place = files(texture), QPoint(200, 200)
    enter = QDragEnterEvent(place, possible, mime, LEFT, SHIFT)
    QApplication.sendEvent(explorer.window, enter)
    assert enter.isAccepted() == (taken == ACTION.CopyAction)
    assert enter.dropAction() == taken
    if not enter.isAccepted():
        # Qt tells nothing more of a drag that was not let in.
        return
    for event in (
        QDragMoveEvent(place, possible, mime, LEFT, SHIFT),
        QDropEvent(QPointF(place), possible, mime, LEFT, SHIFT),
    ):
        QApplication.sendEvent(explorer.window, event)
        assert event.dropAction() == taken
        assert event.isAccepted()
    QApplication.processEvents()


def test_bytes_are_taken_before_a_picture_that_would_be_decoded_here() -> None:
    mime = QMimeData()
    mime.setImageData(QImage(4, 4, QImage.Format.Format_RGB32))
    assert isinstance(brought_by(mime).sources[0], Pasted)
    mime.setData("image/jpeg", b"jpeg")
    mime.setData("image/png", b"png")
    assert brought_by(mime).sources == (b"png",)


def test_an_address_is_refused_in_words(qtbot: Any, explorer: Explorer) -> None:
    mime = QMimeData()
    mime.setUrls([QUrl("https://example.org/wood.png?" + "x" * 200)])
    assert can_bring(mime)
    before = explorer.session.state
    drop(explorer.window, mime)
    qtbot.waitUntil(explorer.window.message_bar.isVisible)
    said = explorer.window.message_bar.label.text()
    assert said.startswith("https://example.org/wood.png?xx")
    assert "nothing is fetched from the network" in said
    assert len(said) < 300
    assert explorer.session.state == before
    # With the picture in it, the address does not matter.
    mime.setImageData(QImage(4, 4, QImage.Format.Format_RGB32))
    assert brought_by(mime).sources


def test_several_files_make_a_strip_to_choose_from(
    qtbot: Any, explorer: Explorer, texture: Path, tmp_path: Path
) -> None:
    gallery = explorer.window.gallery
    assert not gallery.strip.isVisible()
    gray, bad = tmp_path / "gray.png", tmp_path / "bad.png"
    Image.fromarray(np.arange(24 * 30, dtype=np.uint16).reshape(24, 30).astype(np.uint8)).save(gray)
    bad.write_text("no picture")
    explorer.window.layouts.arrange("tune")
    drop(explorer.window, files(gray, texture, bad))
    qtbot.waitUntil(lambda: explorer.session.state.sample.path == str(gray))
    wait_idle(qtbot, explorer)
    strip = gallery.strip
    assert strip.isVisible()
    assert [strip.list.item(k).text() for k in range(3)] == ["gray.png", "waves.png", "bad.png"]
    qtbot.waitUntil(lambda: strip.list.item(2).flags() == Qt.ItemFlag.NoItemFlags)
    assert "bad.png" in strip.list.item(2).toolTip()
    shown = strip.list.item(1).icon().pixmap(48, 48).toImage()
    assert len({shown.pixel(x, y) for x in range(48) for y in range(48)}) > 50
    qtbot.mouseClick(strip.list.viewport(), LEFT, pos=strip.list.visualItemRect(strip.list.item(1)).center())
    qtbot.waitUntil(lambda: explorer.session.state.sample.path == str(texture))
    wait_idle(qtbot, explorer)
    explorer.session.undo()
    wait_idle(qtbot, explorer)
    assert strip.list.currentRow() == 0
    qtbot.mouseClick(strip.close_button, LEFT)
    assert not strip.isVisible()
    assert explorer.session.state.sample.path == str(gray)
