"""What a drop or a paste holds."""

from __future__ import annotations

from typing import Any


def source_of(mime: Any) -> str | bytes | None:
    """Return the path of the first local file, or the picture as PNG bytes, or None."""
    if mime is None:
        return None
    for url in mime.urls():
        if url.isLocalFile():
            return str(url.toLocalFile())
    if mime.hasImage():
        from PySide6.QtCore import QBuffer, QIODevice
        from PySide6.QtGui import QImage

        image = QImage(mime.imageData())
        buffer = QBuffer()
        buffer.open(QIODevice.OpenModeFlag.WriteOnly)
        if not image.isNull() and image.save(buffer, "PNG"):  # type: ignore[call-overload]
            return bytes(buffer.data().data())
    return None
