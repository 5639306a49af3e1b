"""The exemplar: the whole scaled source with a crop box, its scale, and its name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyqtgraph as pg
from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QDoubleSpinBox, QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QVBoxLayout

from texlab.views.column import STATUS_LINES
from texlab.views.image_pane import ImagePane, ViewLink
from texlab_core.inputs import Crop

if TYPE_CHECKING:
    from PySide6.QtGui import QResizeEvent
    from PySide6.QtWidgets import QWidget

    from texlab.scene import Picture
    from texlab.theme import Theme

MIN_CROP = 8
PROGRESS_HEIGHT = 7


class ExemplarView(QFrame):
    """Shows the scaled source; the crop box recomputes everything while it is dragged.

    ``crop_changed(crop or None, final)``, ``scale_changed(scale)``, ``hovered(row, column)`` in the scaled source.
    """

    crop_changed = Signal(object, bool)
    scale_changed = Signal(float)
    hovered = Signal(int, int)
    clicked = Signal(int, int)

    def __init__(self, link: ViewLink, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("column")
        self.setMinimumWidth(140)
        self.title = QLabel("Exemplar")
        self.title.setObjectName("exemplar-title")
        self.title.setProperty("role", "heading")
        self.title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.crop_button = QToolButton()
        self.crop_button.setObjectName("crop-toggle")
        self.crop_button.setText("Crop")
        self.crop_button.setCheckable(True)
        self.crop_button.setAutoRaise(True)
        self.crop_button.setToolTip("Use a part of the picture: drag the box or its corners (X)")
        self.scale_box = QDoubleSpinBox()
        self.scale_box.setObjectName("scale-box")
        self.scale_box.setAccessibleName("Scale of the exemplar")
        self.scale_box.setToolTip(
            "Scale of the picture before it is cropped. Photographs are usually too large for these methods: "
            "a texture element should be 10 to 40 pixels wide."
        )
        self.scale_box.setRange(0.01, 1.0)
        self.scale_box.setDecimals(3)
        self.scale_box.setSingleStep(0.05)
        self.scale_box.setKeyboardTracking(False)
        self.scale_box.setPrefix("×")
        self.scale_box.setMaximumWidth(76)
        self.line = QLabel()
        self.line.setObjectName("exemplar-line")
        self.line.setProperty("role", "muted")
        self.line.setWordWrap(True)
        self.line.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.line.setFixedHeight(self.line.fontMetrics().lineSpacing() * STATUS_LINES + 2)
        self.line.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.pane = ImagePane(link, self)
        self.pane.setObjectName("pane-exemplar")
        self._box: Any = None
        self._name = ""
        self._crop: Crop | None = None
        head = QHBoxLayout()
        head.setSpacing(2)
        head.addWidget(self.title, 1)
        head.addWidget(self.crop_button)
        head.addWidget(self.scale_box)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(4, 4, 4, 4)
        layout.setSpacing(3)
        layout.addLayout(head)
        layout.addWidget(self.pane, 1)
        layout.addSpacing(PROGRESS_HEIGHT)
        layout.addWidget(self.line)
        self.crop_button.clicked.connect(self._toggle)
        self.scale_box.valueChanged.connect(self.scale_changed)
        self.pane.hovered.connect(self.hovered)
        self.pane.clicked.connect(self.clicked)

    def show_source(self, picture: Picture | None) -> None:
        """Show the scaled source."""
        if picture is not self.pane.picture:
            self.pane.set_picture(picture)

    def show_choice(self, name: str, line: str, scale: float, crop: Crop | None) -> None:
        """Show name, size and notes, scale and crop without emitting anything."""
        self._name = name
        self.title.setToolTip(name)
        self._elide()
        self.line.setText(line)
        self.line.setToolTip(line)
        with QSignalBlocker(self.scale_box):
            self.scale_box.setValue(scale)
        with QSignalBlocker(self.crop_button):
            self.crop_button.setChecked(crop is not None)
        self._show_crop(crop)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Shorten the name to the room there is."""
        super().resizeEvent(event)
        self._elide()

    def _elide(self) -> None:
        room = self.title.width()
        self.title.setText(self.title.fontMetrics().elidedText(self._name, Qt.TextElideMode.ElideMiddle, room))

    def _show_crop(self, crop: Crop | None) -> None:
        if crop == self._crop and (crop is None) == (self._box is None):
            return
        self._crop = crop
        if crop is None:
            if self._box is not None:
                self.pane.view.removeItem(self._box)
                self._box = None
            return
        if self._box is None:
            self._box = pg.RectROI([0, 0], [1, 1], sideScalers=True, pen=self._pen(), snapSize=1.0)
            self._box.addScaleHandle([0, 0], [1, 1])
            self._box.addScaleHandle([1, 0], [0, 1])
            self._box.addScaleHandle([0, 1], [1, 0])
            for handle in self._box.getHandles():
                # pyqtgraph makes these menus without a parent, and nobody would delete them.
                handle.menu.setParent(self, handle.menu.windowFlags())
            self._box.sigRegionChanged.connect(lambda: self._dragged(final=False))
            self._box.sigRegionChangeFinished.connect(lambda: self._dragged(final=True))
            self.pane.view.addItem(self._box)
        with QSignalBlocker(self._box):
            self._box.setPos([crop.left, crop.top], update=False)
            self._box.setSize([crop.width, crop.height])
            self._box.stateChanged(finish=False)

    def _pen(self) -> Any:
        return pg.mkPen(QColor("#ffd54a"), width=2)

    def _toggle(self, on: bool) -> None:
        picture = self.pane.picture
        if picture is None:
            self.crop_button.setChecked(False)
            return
        if not on:
            self.crop_changed.emit(None, True)
            return
        height, width = picture.shape[:2]
        rows, columns = max(height // 2, min(height, MIN_CROP)), max(width // 2, min(width, MIN_CROP))
        self.crop_changed.emit(Crop((height - rows) // 2, (width - columns) // 2, rows, columns), True)

    def _dragged(self, *, final: bool) -> None:
        picture = self.pane.picture
        if picture is None or self._box is None:
            return
        height, width = picture.shape[:2]
        position, size = self._box.pos(), self._box.size()
        columns = min(max(round(abs(size.x())), MIN_CROP), width)
        rows = min(max(round(abs(size.y())), MIN_CROP), height)
        left = min(max(round(position.x()), 0), width - columns)
        top = min(max(round(position.y()), 0), height - rows)
        crop = Crop(top, left, rows, columns)
        if final:
            # The box itself snaps to what is used once the button is up.
            self._crop = None
            self._show_crop(crop)
        self._crop = crop
        self.crop_changed.emit(crop, final)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.pane.set_theme(theme)
