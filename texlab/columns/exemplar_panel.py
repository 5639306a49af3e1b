"""What is typed about the exemplar: its crop in numbers, its levels over their histogram."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import (
    QCheckBox,
    QFormLayout,
    QFrame,
    QHBoxLayout,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.number_box import NumberBox, WholeBox
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.inputs import Crop
from texlab_core.engine.levels import GAMMAS, Levels

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QPaintEvent

    from texlab.style.theme import Theme

LEAST = 8
_CHANNELS = (("#d84c4c", "#3f9a3f", "#4a6fe0"), ("#888888",))
_STEP = 0.005


class Histogram(QWidget):
    """The values before the levels, by channel, with what becomes black and white."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("levels-histogram")
        self.setAccessibleName("Histogram of the exemplar")
        self._shares: NDArray[np.float64] = np.zeros((1, 256))
        self._levels = Levels()
        self._ground, self._line = QColor("#ffffff"), QColor("#000000")

    def show_histogram(self, shares: NDArray[np.float64], levels: Levels) -> None:
        """Show these shares, (C, n), and these levels."""
        self._shares, self._levels = shares, levels
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._ground, self._line = QColor(theme.canvas), QColor(theme.text)
        self.update()

    def sizeHint(self) -> QSize:
        """Return a size at which 256 bars are seen."""
        return QSize(260, 90)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint roots of the shares, so that rare values are seen too."""
        painter = QPainter(self)
        width, height = self.width(), self.height()
        painter.fillRect(self.rect(), self._ground)
        tops = np.sqrt(self._shares / max(float(self._shares.max()), 1e-12)) * (height - 2)
        painter.setOpacity(0.6)
        bins = tops.shape[1]
        for colour, row in zip(_CHANNELS[len(tops) == 1], tops, strict=False):
            for place in np.flatnonzero(row > 0.5):
                left, right = int(place * width / bins), int((place + 1) * width / bins)
                tall = int(row[place])
                painter.fillRect(left, height - tall, max(1, right - left), tall, QColor(colour))
        painter.setOpacity(1.0)
        for value in (self._levels.black, self._levels.white):
            painter.setPen(QPen(self._line, 2, Qt.PenStyle.SolidLine))
            x = min(max(round(value * width), 1), width - 1)
            painter.drawLine(x, 0, x, height)
        # The curve of the levels over the histogram.
        painter.setPen(QPen(self._line, 1, Qt.PenStyle.DashLine))
        grays = np.linspace(0, 1, 65, dtype=np.float32)
        curve = self._levels.applied(grays)
        places = np.stack([grays * width, height - 1 - curve * (height - 2)], axis=1)
        painter.drawPolyline(QPolygonF([QPointF(float(x), float(y)) for x, y in places]))
        painter.end()


class ExemplarPanel(QFrame):
    """A window of its own that goes with a click elsewhere.

    ``crop_wanted(crop or None)``, ``scale_wanted(scale)``, ``levels_wanted(levels or None, look_only)``.
    """

    crop_wanted = Signal(object)
    scale_wanted = Signal(float)
    levels_wanted = Signal(object, bool)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("exemplar-panel")
        self.setAccessibleName("Crop and levels of the exemplar")
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self._whole = (1, 1)
        self._ratio = 1.0
        self._auto = Levels()
        layout = QVBoxLayout(self)
        self.size_label = Label(muted=True)
        layout.addWidget(_heading("Crop"))
        layout.addWidget(self.size_label)
        self.boxes: dict[str, WholeBox] = {}
        for names in (("x", "y"), ("width", "height")):
            row = QHBoxLayout()
            for name in names:
                side = self.boxes[name] = WholeBox()
                side.setObjectName(f"crop-{name}")
                side.setAccessibleName(f"Crop: {name}")
                side.setPrefix(f"{name} ")
                side.setRange(0, 99_999)
                side.valueChanged.connect(lambda _, name=name: self._typed(name))
                set_tip(side, "Of the part that is used, in pixels of the scaled picture")
                row.addWidget(side)
            layout.addLayout(row)
        self.lock = QCheckBox("Keep the ratio of the sides")
        self.lock.setObjectName("crop-lock")
        self.lock.toggled.connect(self._remember_ratio)
        layout.addWidget(self.lock)
        row = QHBoxLayout()
        self.powers_button = _button("crop-powers", "Powers of two", "The nearest sides of 64, 128, 256, ...")
        self.powers_button.clicked.connect(self._to_powers)
        self.whole_button = _button("crop-none", "All of it", "Use the whole picture at this scale")
        self.whole_button.clicked.connect(lambda: self.crop_wanted.emit(None))
        self.full_button = _button("scale-full", "Work at 100 %", "No reduction; the crop keeps its place")
        self.full_button.clicked.connect(lambda: self.scale_wanted.emit(1.0))
        for button in (self.powers_button, self.whole_button, self.full_button):
            row.addWidget(button)
        layout.addLayout(row)
        layout.addWidget(_heading("Levels"))
        self.histogram = Histogram()
        layout.addWidget(self.histogram)
        form = QFormLayout()
        self.black, self.white, self.gamma = NumberBox(), NumberBox(), NumberBox()
        numbers = (("Black", self.black, 0.0, 0.9999), ("White", self.white, 0.0001, 1.0))
        for name, box, low, high in (*numbers, ("Gamma", self.gamma, *GAMMAS)):
            box.setObjectName(f"levels-{name.lower()}")
            box.setAccessibleName(f"Levels: {name.lower()}")
            box.setRange(low, high)
            box.setDecimals(4 if name != "Gamma" else 2)
            box.setSingleStep(_STEP if name != "Gamma" else 0.05)
            box.valueChanged.connect(self._levels_typed)
            form.addRow(name, box)
        set_tip(self.black, "What becomes black, 0 to 1")
        set_tip(self.white, "What becomes white, 0 to 1")
        set_tip(self.gamma, "Above 1 the middle becomes brighter")
        self.use = ChoiceBox()
        self.use.setObjectName("levels-use")
        self.use.setAccessibleName("What the levels are for")
        self.use.addItem("The methods see them, recipes have them", False)
        self.use.addItem("For looking only: exemplar and results", True)
        self.use.activated.connect(self._levels_typed)
        form.addRow("For", self.use)
        layout.addLayout(form)
        row = QHBoxLayout()
        self.auto_button = _button("levels-auto", "Auto", "The whole range, but for 0.1 % at each end")
        self.auto_button.clicked.connect(lambda: self._emit_levels(self._auto))
        self.reset_button = _button("levels-reset", "Reset", "The values as they are")
        self.reset_button.clicked.connect(lambda: self.levels_wanted.emit(None, False))
        row.addWidget(self.auto_button)
        row.addWidget(self.reset_button)
        row.addStretch(1)
        layout.addLayout(row)

    def show_choice(
        self, whole: tuple[int, int], scale: float, crop: Crop | None, source: tuple[int, int]
    ) -> None:
        """Show the crop; ``whole`` is height and width of the scaled picture, ``source`` of the picture itself."""
        self._whole = whole
        self.size_label.setText(
            f"of {whole[1]} x {whole[0]} pixels"
            + ("" if scale == 1 else f", the picture of {source[1]} x {source[0]} at {100 * scale:.3g} %")
        )
        part = crop or Crop(0, 0, *whole)
        values = {"x": part.left, "y": part.top, "width": part.width, "height": part.height}
        limits = {"x": (0, whole[1] - 1), "y": (0, whole[0] - 1), "width": (2, whole[1]), "height": (2, whole[0])}
        for name, box in self.boxes.items():
            with QSignalBlocker(box):
                box.setRange(*limits[name])
                box.setValue(values[name])
        self.whole_button.setEnabled(crop is not None)
        self.full_button.setEnabled(scale != 1)
        if not self.lock.isChecked():
            self._remember_ratio()

    def show_levels(
        self, shares: NDArray[np.float64] | None, levels: Levels | None, look_only: bool, auto: Levels | None
    ) -> None:
        """Show the levels over the histogram of the values before them."""
        shown, self._auto = levels or Levels(), auto or Levels()
        for box, value in ((self.black, shown.black), (self.white, shown.white), (self.gamma, shown.gamma)):
            with QSignalBlocker(box):
                box.setValue(value)
        if levels is not None:
            with QSignalBlocker(self.use):
                self.use.setCurrentIndex(self.use.findData(look_only))
        if shares is not None:
            self.histogram.show_histogram(shares, shown)
        self.reset_button.setEnabled(levels is not None)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.histogram.set_theme(theme)

    def _remember_ratio(self, *_: object) -> None:
        self._ratio = self.boxes["width"].value() / max(self.boxes["height"].value(), 1)

    def _typed(self, name: str) -> None:
        width, height = self.boxes["width"].value(), self.boxes["height"].value()
        if self.lock.isChecked() and name in ("width", "height"):
            if name == "width":
                height = min(max(2, round(width / self._ratio)), self._whole[0])
            else:
                width = min(max(2, round(height * self._ratio)), self._whole[1])
        self._emit_crop(self.boxes["x"].value(), self.boxes["y"].value(), width, height)

    def _to_powers(self) -> None:
        sides = []
        for name, most in (("width", self._whole[1]), ("height", self._whole[0])):
            exponent = round(np.log2(max(self.boxes[name].value(), LEAST)))
            while 2**exponent > most and exponent > 1:
                exponent -= 1
            sides.append(2 ** int(exponent))
        # The middle stays where it is.
        left = self.boxes["x"].value() + (self.boxes["width"].value() - sides[0]) // 2
        top = self.boxes["y"].value() + (self.boxes["height"].value() - sides[1]) // 2
        self._emit_crop(left, top, sides[0], sides[1])

    def _emit_crop(self, left: int, top: int, width: int, height: int) -> None:
        """Ask for a crop; one that would reach beyond the picture is moved inside."""
        width, height = min(width, self._whole[1]), min(height, self._whole[0])
        left = min(max(left, 0), self._whole[1] - width)
        top = min(max(top, 0), self._whole[0] - height)
        self.crop_wanted.emit(Crop(top, left, height, width))

    def _levels_typed(self, *_: object) -> None:
        black, white = self.black.value(), self.white.value()
        if white - black < _STEP / 50:
            # What is typed last counts; the other end makes room.
            if self.sender() is self.white:
                black = max(0.0, white - _STEP / 50)
            else:
                white = min(1.0, black + _STEP / 50)
        self._emit_levels(Levels(black, white, self.gamma.value()))

    def _emit_levels(self, levels: Levels) -> None:
        look_only = bool(self.use.currentData())
        self.levels_wanted.emit(None if levels.plain else levels, look_only)


def _heading(text: str) -> Label:
    label = Label(text)
    label.setProperty("role", "heading")
    return label


def _button(name: str, text: str, tip: str) -> QPushButton:
    button = QPushButton(text)
    button.setObjectName(name)
    set_tip(button, tip)
    return button
