"""Steps: a scrubber over the stages of a run."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QSizePolicy, QSlider, QVBoxLayout

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.state.intentions import ShowStage
from texlab.widgets.own_keys import is_plain
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label
from texlab.widgets.slider import Slider

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QHideEvent, QKeyEvent

    from texlab.state.scene import Frame, Scene

STAGES = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1, Qt.Key.Key_Home: -(10**6), Qt.Key.Key_End: 10**6}
SPEEDS = ((1, "1 per second"), (2, "2 per second"), (4, "4 per second"), (10, "10 per second"))


class StepsDock(FramedDock):
    """Plays the stages that the chosen column kept: noise, iterations, levels."""

    name = "steps"
    title = "Steps"
    help = "The stages of the run, one by one: noise, iterations, levels."
    order = 30
    empty = "The stages of a run appear here."
    heavy = True
    folds = False
    # The stage is what is looked at, and each run has its own.
    no_settings = frozenset({"slider"})

    def build(self) -> None:
        """Make the scrubber and the picture."""
        self._frames: tuple[Frame, ...] = ()
        self._column = 0
        self._stage: Frame | None = None
        self._timer = QTimer(self)
        self._timer.timeout.connect(self._advance)
        self.play = self.add_button("play", "Play", "Play the stages in a loop (Space)", self.toggle)
        self.slider = Slider("Stage", self._said)
        self.slider.setMinimumWidth(180)
        self.slider.setPageStep(1)
        self.slider.setTickPosition(QSlider.TickPosition.TicksBelow)
        self.slider.valueChanged.connect(self._choose)
        self.slider.sliderPressed.connect(self.pause)
        self.add_slider(self.slider, "slider", "Which stage to show (Left, Right, Home, End)")
        self.speed = self.add_choice(
            "speed", "Speed", "How fast to play", [(text, rate) for rate, text in SPEEDS], self._take_speed
        )
        self.speed.setCurrentIndex(1)
        self.label = Label("")
        self.label.setSizePolicy(QSizePolicy.Policy.Minimum, QSizePolicy.Policy.Fixed)
        self.label.setMinimumWidth(150)
        self.add_control(
            self.label, "label", "Name of the stage", "The stage that is shown and how many there are"
        )
        self.readout = self.add_readout()
        self.pane = PicturePane("steps-pane", "Picture of the stage")
        self.pane.hovered.connect(self._hover)
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.pane)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def show_scene(self, scene: Scene) -> None:
        """Stand where the other tabs look: at a stage, or at the end when they look at the result again."""
        super().show_scene(scene)
        given_back = self._stage is not None and scene.stage is None
        self._stage = scene.stage
        if given_back and self._frames and not self.playing:
            blocked = self.slider.blockSignals(True)
            self.slider.setValue(len(self._frames) - 1)
            self.slider.blockSignals(blocked)
            self._show(len(self._frames) - 1)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the chosen column's stages; there is nothing to compute."""
        column = scene.selected
        if column is None or not column.frames:
            self.why = "" if column is None or column.result is None else f"{column.title} keeps no stages."
            self.controls.hide()
            return None
        self.controls.show()
        answer = (column.id, column.frames)

        def compute(should_stop: Callable[[], bool]) -> tuple[int, tuple[Frame, ...]]:
            return answer

        return Question((self.name, column.id, tuple(Same(frame) for frame in column.frames)), compute)

    def show_answer(self, answer: tuple[int, tuple[Frame, ...]]) -> None:
        """Take the stages; a scrubber at the end stays at the end, so that a run can be watched."""
        column, frames = answer
        at_end = column != self._column or self.slider.value() == self.slider.maximum()
        self._column, self._frames = column, frames
        place = len(frames) - 1 if at_end and not self.playing else min(self.slider.value(), len(frames) - 1)
        if self._stage is not None and not self.playing:
            place = next((at for at, frame in enumerate(frames) if frame is self._stage), place)
        blocked = self.slider.blockSignals(True)
        self.slider.setRange(0, len(frames) - 1)
        self.slider.setValue(place)
        self.slider.blockSignals(blocked)
        self._show(place)

    def present_nothing(self, reason: str) -> None:
        """Stop playing and say why there is nothing."""
        self.pause()
        self.label.setText("")
        super().present_nothing(reason)

    def clear_shown(self) -> None:
        """Let go of the stages."""
        super().clear_shown()
        self._frames, self._stage = (), None

    @property
    def playing(self) -> bool:
        """Whether the stages are being played."""
        return self._timer.isActive()

    def toggle(self) -> None:
        """Play, or pause."""
        if self.playing:
            self.pause()
        elif len(self._frames) > 1:
            self._timer.start(1000 // int(self.speed.currentData()))
            self.play.setText("Pause")

    def pause(self) -> None:
        """Stop playing."""
        self._timer.stop()
        self.play.setText("Play")

    def hideEvent(self, event: QHideEvent) -> None:
        """Stop playing: nobody looks."""
        self.pause()
        super().hideEvent(event)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it scrubs or plays."""
        return is_plain(event) and (event.key() in STAGES or event.key() == Qt.Key.Key_Space)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Scrub with the arrow keys, Home and End; play and pause with Space."""
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif event.key() == Qt.Key.Key_Space:
            self.toggle()
        else:
            self.pause()
            self.slider.setValue(self.slider.value() + STAGES[Qt.Key(event.key())])

    def _take_speed(self) -> None:
        if self.playing:
            self._timer.setInterval(1000 // int(self.speed.currentData()))

    def _advance(self) -> None:
        self.slider.setValue((self.slider.value() + 1) % len(self._frames))

    def _show(self, place: int) -> None:
        if 0 <= place < len(self._frames):
            frame = self._frames[place]
            self.pane.set_picture(frame.picture)
            self.label.setText(f"{frame.name}   {place + 1} of {len(self._frames)}")
            self.slider.tell()
            self.tell_again()

    def _said(self, place: int) -> str:
        frames = self._frames
        return f"{frames[place].name}, {place + 1} of {len(frames)}" if place < len(frames) else ""

    def _choose(self, place: int) -> None:
        """Show a stage here and in every other tab; the last one is the result itself."""
        self._show(place)
        last = place >= len(self._frames) - 1
        self._stage = None if last else self._frames[place]
        self.intention.emit(ShowStage(self._column, self._stage))

    def _hover(self, row: int, column: int) -> None:
        self.readout.tell(partial(self._value_words, row, column))

    def _value_words(self, row: int, column: int) -> str:
        picture = self.pane.picture
        if picture is None or not (0 <= row < picture.shape[0] and column < picture.shape[1]):
            return ""
        numbers = " ".join(f"{value / 255:.3f}" for value in picture[row, column])
        return f"{column}, {row}   RGB {numbers}"
