"""A pane for pictures that are looked at one at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt

from texlab.widgets.image_pane import ImagePane
from texlab.widgets.view_link import ViewLink

if TYPE_CHECKING:
    from texlab.style.pictures import Picture


class PicturePane(ImagePane):
    """An image pane that fits whatever picture it is given; panes of one ``link`` pan and zoom together."""

    def __init__(self, name: str, label: str, link: ViewLink | None = None) -> None:
        self._own_link = link or ViewLink()
        super().__init__(self._own_link)
        self.setObjectName(name)
        self.setAccessibleName(label)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)

    def set_picture(self, picture: Picture | None) -> None:
        """Show a picture, or nothing."""
        if picture is not None:
            self._own_link.set_extent(*picture.shape[:2])
        super().set_picture(picture)
