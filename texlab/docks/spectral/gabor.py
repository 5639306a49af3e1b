"""Gabor: the filter bank of MSG in the frequency plane, and what its channels answer."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QRectF, QSignalBlocker
from PySide6.QtWidgets import QHBoxLayout, QWidget

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, LookedAt
from texlab.docks.recent import Recent, Same
from texlab.docks.spectral.gabor_pictures import RESIDUAL, GaborAnswer, GaborRequest, Pair, gabor_pictures
from texlab.docks.spectral.spectra import frequency_area
from texlab.state.intentions import Open
from texlab.style.colouring import gray
from texlab.style.numbers import number
from texlab.widgets.headed import headed
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.plane_pane import Drawn, PlanePane, Ring
from texlab.widgets.plots import ColourBar
from texlab.widgets.view_link import ViewLink
from texlab_core.transforms.gabor import circles, filter_bank
from texlab_core.transforms.gabor_bank import CHANNELS, channel_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from PySide6.QtCore import QObject

    from texlab.docks.spectral.gabor_pictures import Shown
    from texlab.state.scene import Scene

ZEBRA = "gallery:oriented-zebra"
PANES = 5
BANK_SIDE = 128
VIEWS = (("One channel", "channel"), ("Sum of channels", "sum"), ("Local frequency", "local"))
PARTS = (("Even", "even"), ("Odd", "odd"), ("Magnitude", "magnitude"), ("Phase", "phase"))
CACHE_BYTES = 64 * 2**20


class GaborDock(FramedDock):
    """Shows the multiscale Gabor transform of exemplar and result."""

    name = "gabor"
    title = "Gabor"
    help = "MSG's filter bank in the frequency plane, its channels, and local spatial frequency."
    order = 32
    heavy = True
    empty = "Channels appear as soon as there is an exemplar."

    def build(self) -> Iterator[None]:
        """Make the controls, the frequency plane and the pictures."""
        self._recent = Recent(CACHE_BYTES, lambda each: 3 * each.plane.nbytes)
        # Until a period or an orientation is chosen, the strongest peak's are taken.
        self._pair: Pair | None = None
        tip = "One channel, the sum of all (nearly the image), or one pair of filters on the exemplar"
        self.view = self.add_choice("view", "What is shown", tip, VIEWS, self._view_changed)
        channels = [(channel_name(channel), channel) for channel in range(CHANNELS)]
        tip = "Centre frequency in cycles per pixel, and orientation of the wave; or click its circle"
        self.channel = self.add_choice(
            "channel", "Channel", tip, [*channels, ("Residual", RESIDUAL)], self._channel_changed
        )
        self.channel.setCurrentIndex(8)
        tip = "Even: bright and dark stripes; odd: edges; magnitude: how strong; phase: where within a stripe"
        self.part = self.add_choice("part", "Part of the answer", tip, PARTS, self.ask)
        tip = "Pixels from one stripe to the next to which the pair answers most"
        self.period = self.add_number("period", "period", tip, (2, 256), self._pair_changed)
        self.period.setSuffix(" px")
        tip = "Orientation of the wave: 0° for vertical stripes, 90° for horizontal ones"
        self.orientation = self.add_number("orientation", "orientation", tip, (0, 179), self._pair_changed)
        self.orientation.setSuffix("°")
        self.orientation.setWrapping(True)
        tip = "Take period and orientation of the exemplar's strongest repetition"
        self.strongest = self.add_button("strongest", "Strongest peak", tip, self._take_strongest)
        tip = "Open the zebra and show its local spatial frequency: a quadrature pair, as in the textbook"
        self.zebra = self.add_button("zebra", "Zebra example", tip, self._open_zebra)
        self.readout = self.add_readout()
        yield
        self.plane = PlanePane("gabor-plane", "Filter bank in the frequency plane")
        set_tip(self.plane, "Gain of the filters; circles: half height. Click one to see its channel.")
        self.plane.show_picture(
            gray(filter_bank((BANK_SIDE, BANK_SIDE))), QRectF(*frequency_area((BANK_SIDE, BANK_SIDE)))
        )
        self.plane.hovered.connect(self._hover_plane)
        self.plane.left.connect(lambda: self.readout.setText(""))
        self.plane.clicked.connect(self._click_plane)
        row = QHBoxLayout(self.body)
        row.setContentsMargins(6, 0, 6, 6)
        row.setSpacing(4)
        self._plane_part = headed(Label("filter bank"), self.plane)
        row.addWidget(self._plane_part)
        self._link = ViewLink()
        self.panes: list[PicturePane] = []
        self.titles: list[Label] = []
        self._parts: list[QWidget] = []
        for index in range(PANES):
            yield
            pane = PicturePane(f"gabor-pane-{index}", f"Picture {index + 1}", self._link)
            pane.hovered.connect(lambda row, column, index=index: self._hover(index, row, column))
            title = Label("")
            part = headed(title, pane)
            row.addWidget(part, 1)
            self.panes.append(pane)
            self.titles.append(title)
            self._parts.append(part)
        self.bar = ColourBar("gabor-bar")
        row.addWidget(self.bar)
        self.body.installEventFilter(self)
        self._show_controls()

    # Asking.

    def question(self, scene: Scene) -> Question | None:
        """Ask for what the controls say of the exemplar and of the chosen column."""
        if scene.exemplar is None:
            return None
        exemplar = scene.exemplar.pixels
        request = GaborRequest(
            self.view.currentData(), self.channel.currentData(), self.part.currentData(), self._pair
        )
        result = self.looked_at(scene) if request.view != "local" else LookedAt(None)
        recent = self._recent

        def compute(should_stop: Callable[[], bool]) -> GaborAnswer:
            return gabor_pictures(exemplar, result.values(), request, recent, should_stop)

        return Question((self.name, Same(exemplar), result.key, request), compute)

    def _view_changed(self) -> None:
        self._show_controls()
        self.ask()

    def _show_controls(self) -> None:
        view = self.view.currentData()
        for control, of in (
            (self.channel, "channel"),
            (self.part, "channel"),
            (self.period, "local"),
            (self.orientation, "local"),
            (self.strongest, "local"),
        ):
            control.setVisible(view == of)
        self._draw_circles()

    def _channel_changed(self) -> None:
        self.part.setEnabled(self.channel.currentData() != RESIDUAL)
        self._draw_circles()
        self.ask()

    def _pair_changed(self) -> None:
        self._pair = Pair(self.period.value(), self.orientation.value())
        self._draw_circles()
        self.ask()

    def _take_strongest(self) -> None:
        self._pair = None
        self.ask()

    def _open_zebra(self) -> None:
        self.view.setCurrentIndex(self.view.findData("local"))
        self._pair = None
        self._view_changed()
        self.intention.emit(Open(ZEBRA))

    def _click_plane(self, u: float, v: float) -> None:
        if self.view.currentData() == "local":
            frequency = math.hypot(u, v)
            if 1 / self.period.maximum() <= frequency <= 0.5:
                self._set_pair(Pair(round(1 / frequency), round(math.degrees(math.atan2(v, u))) % 180))
                self._pair_changed()
            return
        near = min(circles(), key=lambda circle: math.hypot(u - circle.u, v - circle.v) / circle.radius)
        self.view.setCurrentIndex(self.view.findData("channel"))
        self.channel.setCurrentIndex(self.channel.findData(near.channel))
        self._show_controls()
        self._channel_changed()

    def _set_pair(self, pair: Pair) -> None:
        with QSignalBlocker(self.period), QSignalBlocker(self.orientation):
            self.period.setValue(pair.period)
            self.orientation.setValue(pair.orientation)

    # Showing.

    def show_answer(self, answer: GaborAnswer) -> None:
        """Show the pictures."""
        self.readout.setText("")
        if answer.request.pair is not None:
            self._set_pair(answer.request.pair)
        shown: list[Shown | None] = [*answer.shown, *[None] * (PANES - len(answer.shown))]
        for pane, title, part, each in zip(self.panes, self.titles, self._parts, shown, strict=True):
            part.setVisible(each is not None)
            pane.set_picture(None if each is None else each.picture)
            title.setText("" if each is None else each.title)
            set_tip(title, title.text())
        # All at one scale, the smallest one whole: larger ones can be panned.
        sizes = [each.picture.shape for each in answer.shown]
        self._link.set_extent(min(size[0] for size in sizes), min(size[1] for size in sizes))
        self._show_bar(answer.shown[-1] if answer.request.view == "channel" else None)
        self._draw_circles()

    def _show_bar(self, shown: Shown | None) -> None:
        self.bar.setVisible(shown is not None)
        if shown is not None:
            ticks = [(place, f"{number(value)}{shown.unit}") for place, value in shown.scale.ticks()]
            if shown.unit:
                ticks = [((degrees + 180) / 360, f"{degrees}°") for degrees in (-180, -90, 0, 90, 180)]
            self.bar.show_scale(shown.table, ticks)

    def _draw_circles(self) -> None:
        view, chosen = self.view.currentData(), self.channel.currentData()
        marks: list[Drawn] = []
        for circle in circles():
            here = view == "channel" and circle.channel == chosen
            marks.append(Ring(circle.u, circle.v, circle.radius, "chosen" if here else "centre"))
        if view == "local":
            frequency, angle = 1 / self.period.value(), math.radians(self.orientation.value())
            u, v = frequency * math.cos(angle), frequency * math.sin(angle)
            marks += [Ring(sign * u, sign * v, frequency / 3, "chosen") for sign in (1, -1)]
        self.plane.show_marks(sorted(marks, key=lambda mark: mark.tint == "chosen"))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Give the frequency plane, which is square, its width."""
        if watched is self.body and event.type() == QEvent.Type.Resize:
            room = self.body.height() - self.titles[0].fontMetrics().lineSpacing() - 8
            title = self.titles[0]
            least = max(90, title.fontMetrics().horizontalAdvance(title.text()) + 4)
            self._plane_part.setFixedWidth(max(least, min(room, self.body.width() // 3)))
        return super().eventFilter(watched, event)

    # The value under the cursor.

    def _hover(self, index: int, row: int, column: int) -> None:
        answer: GaborAnswer | None = self.answer
        if answer is None or row < 0 or index >= len(answer.shown):
            self.readout.setText("")
            self.bar.set_mark(None)
            return
        shown = answer.shown[index]
        value = float(shown.values[row, column])
        self.bar.set_mark(float(shown.scale.place(value)))
        self.readout.setText(f"{shown.title}, {column}, {row}: {number(value)}{shown.unit}")

    def _hover_plane(self, u: float, v: float) -> None:
        angle = math.degrees(math.atan2(v, u)) % 180
        channel, gain = strongest_filter(u, v)
        name = "the residual" if channel == RESIDUAL else channel_name(channel)
        self.readout.setText(f"{math.hypot(u, v):.4f} c/px, {angle:.0f}°: gain {gain:.2f} of {name}")


def strongest_filter(u: float, v: float) -> tuple[int, float]:
    """Return the filter (4 p + q, -1 for the residual) with the largest gain at a frequency, and that gain."""
    # A filter falls to half at its circle: gain = 2 ** -(distance / radius) ** 2.
    found = min(circles(), key=lambda circle: math.hypot(u - circle.u, v - circle.v) / circle.radius)
    return found.channel, float(2.0 ** -((math.hypot(u - found.u, v - found.v) / found.radius) ** 2))
