"""What a drop or a paste holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab.widgets.pasted import Pasted

if TYPE_CHECKING:
    from PySide6.QtGui import QDropEvent

# Bytes as another program made them, the most faithful first; they are read in the background.
_ENCODED = ("image/png", "image/tiff", "image/webp", "image/jpeg", "image/bmp", "image/gif")
_LONGEST_ADDRESS = 80


@dataclass(frozen=True)
class Brought:
    """What was dropped or pasted: things to open, or why there is nothing to open."""

    sources: tuple[str | bytes | Pasted, ...] = ()
    refusal: str = ""


def brought_by(mime: Any) -> Brought:
    """Return the paths of all local files, or else the one picture; nothing is encoded or decoded here."""
    from PySide6.QtGui import QImage

    if mime is None:
        return Brought()
    urls = mime.urls()
    paths = dict.fromkeys(str(url.toLocalFile()) for url in urls if url.isLocalFile())
    if paths:
        return Brought(tuple(paths))
    kinds = mime.formats()
    for kind in _ENCODED:
        if kind in kinds and (data := bytes(mime.data(kind).data())):
            return Brought((data,))
    if mime.hasImage():
        image = QImage(mime.imageData())
        if not image.isNull():
            return Brought((Pasted(image),))
    if urls:
        address = urls[0].toDisplayString()
        shown = address if len(address) <= _LONGEST_ADDRESS else address[:_LONGEST_ADDRESS] + " …"
        return Brought(
            refusal=f"{shown} is an address, not a picture, and nothing is fetched from the network: save the "
            "picture there, then drop the file, or copy the picture itself and paste it."
        )
    return Brought()


def can_bring(mime: Any) -> bool:
    """Return whether a drag has anything that :func:`brought_by` has an answer to."""
    return bool(mime.hasUrls() or mime.hasImage() or any(kind in mime.formats() for kind in _ENCODED))


def take_copy(event: QDropEvent) -> bool:
    """Take a drag as a copy, or not at all, and return which: after a move its source deletes the file."""
    from PySide6.QtCore import Qt

    if can_bring(event.mimeData()) and event.possibleActions() & Qt.DropAction.CopyAction:
        event.setDropAction(Qt.DropAction.CopyAction)
        event.accept()
        return True
    event.setDropAction(Qt.DropAction.IgnoreAction)
    event.ignore()
    return False
