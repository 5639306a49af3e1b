"""What the docks share: a line of controls, a body, a sentence instead of the body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from PySide6.QtCore import QPoint, QRect, QSize, Qt
from PySide6.QtGui import QPalette
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QPushButton,
    QSizePolicy,
    QStackedLayout,
    QVBoxLayout,
    QWidget,
)

from texlab.docks.base import Dock
from texlab.docks.recent import Recent, Same
from texlab.state.intentions import ShowStage, TakePicture
from texlab.style.text_size import is_teaching
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.control_settings import control_settings
from texlab.widgets.flow_layout import FlowLayout
from texlab.widgets.number_box import WholeBox
from texlab.widgets.once import Once
from texlab.widgets.pane import Pane
from texlab.widgets.picture_handle import PictureHandle
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.readout import MARGIN, Readout
from texlab.widgets.scroll_room import ScrollRoom

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from PySide6.QtGui import QResizeEvent

    from texlab.state.scene import ColumnScene, Frame, Scene
    from texlab.style.theme import Theme
    from texlab.widgets.control_settings import Setting
    from texlab.widgets.slider import Slider
    from texlab_core.engine.steps import FloatImage


WORKING = "Working ..."
STALE = "From before; the new one is being computed"
# What comes sooner needs no such words.
STALE_MS = 400
# A window on a screen of 683 pixels (1366 at 200 %) has so much beside gallery and parameters.
MOST_NEEDED = 360
QWIDGETSIZE_MAX = 2**24 - 1


def shown_image(column: ColumnScene | None) -> FloatImage | None:
    """Return the column's values: the finished result, or the preview while it runs."""
    if column is None:
        return None
    return column.image if column.result is None else column.result.image


@dataclass(frozen=True, eq=False)
class LookedAt:
    """What the tabs look at: a stage of a run, a result or a preview, or nothing yet.

    Parameters
    ----------
    image
        (H, W, C) float32, or None.
    stage
        The stage that is looked at instead.
    stage_channels
        Channels that the stage has as values: those of the exemplar.
    """

    image: FloatImage | None
    stage: Frame | None = None
    stage_channels: int = 3

    @property
    def channels(self) -> int:
        """Number of channels; 0 while there is nothing."""
        if self.stage is not None:
            return self.stage_channels
        return 0 if self.image is None else self.image.shape[2]

    @property
    def key(self) -> Same:
        """Tells it from all others."""
        return Same(self.image if self.stage is None else self.stage)

    def with_channels(self, channels: int) -> LookedAt:
        """Return it when it has this number of channels, else nothing."""
        return self if self.channels == channels else LookedAt(None)

    def values(self) -> FloatImage | None:
        """Return (H, W, C) float32 in [0, 1], or None; for ``Question.compute``."""
        return self.image if self.stage is None else self.stage.values(self.stage_channels)


class _Body(QWidget):
    """What a tab shows; on a narrow screen it is squeezed, and the window fits all the same."""

    def minimumSizeHint(self) -> QSize:
        """Return what the parts need, but no more than a small screen has; large text is scrolled instead."""
        needed = super().minimumSizeHint()
        return needed if is_teaching() else needed.boundedTo(QSize(MOST_NEEDED, QWIDGETSIZE_MAX))


class FramedDock(Dock):
    """A dock with a line of controls above its body.

    Subclasses fill ``self.body`` in ``build``, add controls with ``add_...`` and show an answer in
    ``show_answer``. A ``question`` that returns None leaves its reason in ``self.why``.
    """

    empty: ClassVar[str] = "Nothing to show yet."
    heavy: ClassVar[bool] = False
    """Whether its answers are as large as pictures, and go when they are out of date and out of sight."""
    folds: ClassVar[bool] = True
    """Whether it leaves its room to the body when one teaches."""
    no_settings: ClassVar[frozenset[str]] = frozenset()
    """Controls that act on the session (a column, a pixel, a lesson), and do not say how the tab stands."""

    def __init__(self, parent: QWidget | None = None, *, whole: bool = True) -> None:
        super().__init__(parent, whole=whole)
        self.theme: Theme = DARK if self.palette().window().color().lightness() < 128 else LIGHT
        self.answer: Any = None
        self.why = ""
        self.controls = QWidget(self)
        self.controls.setObjectName(f"{self.name}-controls")
        self._line = FlowLayout(self.controls)
        # Docks show and hide their controls themselves; this hides them from outside.
        self._fold = QWidget(self)
        folded = QVBoxLayout(self._fold)
        folded.setContentsMargins(0, 0, 0, 0)
        folded.addWidget(self.controls)
        self.handle = PictureHandle()
        self.handle.clicked.connect(lambda _: self.intention.emit(TakePicture(self.name, "copy")))
        self.handle.dragged.connect(lambda: self.intention.emit(TakePicture(self.name, "drag")))
        self.stage_of = 0
        self.stage_button = QPushButton()
        self.stage_button.clicked.connect(lambda _: self.intention.emit(ShowStage(self.stage_of, None)))
        tip = "A stage chosen under Steps is shown instead of the result: click to go back to the result"
        self.add_control(self.stage_button, "stage", "Back to the result", tip)
        self.stage_button.hide()
        self.body = _Body()
        self.body.setObjectName(f"{self.name}-body")
        self.body.setAccessibleName(self.title or self.name)
        self._stale = Label(STALE, self.body, name=f"{self.name}-stale")
        self._stale.setAutoFillBackground(True)
        self._stale.setBackgroundRole(QPalette.ColorRole.ToolTipBase)
        self._stale.setForegroundRole(QPalette.ColorRole.ToolTipText)
        self._stale.setMargin(3)
        self._stale.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._stale.hide()
        self._stale_soon = Once(self, STALE_MS, lambda: self._mark_stale(True))
        self._message = Label(self.empty, name=f"{self.name}-message", muted=True, wraps=True)
        self._message.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._pages = pages = QWidget(self)
        self._stack = QStackedLayout(pages)
        self._stack.addWidget(self._message)
        self._room = ScrollRoom(self.body, f"{self.name}-room")
        self._room.setAccessibleName(self.title)
        self._stack.addWidget(self._room)
        pages.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        # Without controls the value under the cursor has a line of its own.
        self._readout: Readout | None = None
        self._told = Label(" ")
        self._told.setMargin(2 * MARGIN)
        self._told.hide()
        self._folded = False
        self._room.asked.connect(self._ask_for_room)
        self._stack.currentChanged.connect(self._ask_for_room)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self._fold)
        layout.addWidget(pages, 1)
        layout.addWidget(self._told)
        self._left = self._make_rest()
        if whole:
            for _ in self.pieces():
                pass

    def pieces(self) -> Iterator[None]:
        """Make what is not made yet, piece by piece."""
        yield from self._left

    def _make_rest(self) -> Iterator[None]:
        yield from self.build() or ()
        tip = "Drag what this tab shows into a slide; a click copies it; Ctrl+Shift+S saves it"
        self.add_control(self.handle, "picture", "Picture of this tab", tip)
        self.paint_theme(self.theme)

    # For subclasses.

    def build(self) -> Iterator[None] | None:
        """Make the controls and the body; a large one yields between its parts."""
        raise NotImplementedError

    def show_answer(self, answer: Any) -> None:
        """Show an answer in the body."""
        raise NotImplementedError

    def paint_theme(self, theme: Theme) -> None:
        """Give every plot and picture of the body its colours."""
        for part in _themed(self.body):
            part.set_theme(theme)

    def drop_kept(self) -> None:
        """Empty what is kept from one answer to the next."""
        for each in vars(self).values():
            if isinstance(each, Recent):
                each.clear()

    def looked_at(self, scene: Scene) -> LookedAt:
        """Return what to look at in the chosen column, and say so when that is a stage of its run."""
        stage, exemplar = scene.stage, scene.exemplar
        self.stage_of = scene.selected_id
        self.stage_button.setVisible(stage is not None)
        if stage is None or exemplar is None:
            return LookedAt(shown_image(scene.selected))
        self.stage_button.setText(f"Stage: {stage.name} ✕")
        return LookedAt(None, stage, exemplar.pixels.shape[2])

    def tell_again(self) -> None:
        """Say what is under the pointer now, after what is shown there has changed."""
        if self._readout is not None:
            self._readout.tell_again()

    def ask(self, *_: object) -> None:
        """Ask again because a control was changed."""
        self.asks.emit()

    # The contract of docks.

    def present(self, answer: Any) -> None:
        """Show what ``Question.compute`` returned."""
        self.answer = answer
        self._mark_stale(False)
        self.show_body()
        self.show_answer(answer)
        self.tell_again()

    def present_nothing(self, reason: str) -> None:
        """Show why there is nothing to show, in one sentence."""
        self.answer = None
        self._mark_stale(False)
        self._message.setText(self.why or reason or self.empty)
        self._stack.setCurrentWidget(self._message)
        self._ask_for_room()
        if self.heavy:
            self.clear_shown()
        self.tell_again()

    def present_waiting(self) -> None:
        """Say that the answer is under way; over an earlier one that is shown, once that has lasted a moment."""
        self._message.setText(WORKING)
        if self.answer is not None:
            self._stale_soon.start()

    def forget(self) -> None:
        """Let go of what was shown, which was about pictures that are no longer there."""
        if not self.heavy:
            return
        self.answer = None
        self._mark_stale(False)
        self._message.setText(WORKING)
        self._stack.setCurrentWidget(self._message)
        self.clear_shown()
        self.drop_kept()

    def clear_shown(self) -> None:
        """Empty what shows pictures of an answer that there is no more."""
        for pane in self.body.findChildren(Pane):
            pane.show_nothing()

    def _mark_stale(self, stale: bool) -> None:
        self._stale_soon.stop()
        self._stale.setVisible(stale)
        if stale:
            self._stale.adjustSize()
            self._stale.move(max(0, (self.body.width() - self._stale.width()) // 2), 4)
            self._stale.raise_()

    def settings(self) -> dict[str, Setting]:
        """Return how the controls stand, by name, folded away or not."""
        prefix = f"{self.name}-"
        found = control_settings(self, prefix) | control_settings(self._fold, prefix)
        return {name: value for name, value in found.items() if name not in self.no_settings}

    def take_settings(self, wanted: Mapping[str, Any]) -> tuple[str, ...]:
        """Set controls by name, as a user would; return one clause for each that cannot be set."""
        return super().take_settings({k: value for k, value in wanted.items() if k not in self.no_settings})

    def fold_controls(self, folded: bool) -> None:
        """Leave the whole room to the body, or show the controls again."""
        self._folded = folded and self.folds
        self._fold.setVisible(not self._folded)
        self._make_line()

    def _make_line(self) -> None:
        """Keep a line for values free where what is shown does not need it; else they are told over its edge."""
        room = self.height() - self._told.sizeHint().height()
        spare = self._folded and self._readout is not None and room >= self.least_height(self.width())
        self._told.setVisible(spare)

    def least_height(self, width: int) -> int:
        """Return the height below which the body has to be scrolled, without the line for values."""
        needed = self._room.needed(width).height()
        if self.message is not None:
            needed = max(needed, self._message.heightForWidth(width))
        return needed + (0 if self._folded else self._fold.sizeHint().height())

    def minimumSizeHint(self) -> QSize:
        """Return the least size, without the line for values: nobody makes room for it."""
        needed = super().minimumSizeHint()
        return needed - QSize(0, 0 if self._told.isHidden() else self._told.sizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Tell values where there is room for them."""
        super().resizeEvent(event)
        self._make_line()

    def _ask_for_room(self, *_: object) -> None:
        if self._folded:
            self._make_line()
            self.needs_room.emit()

    def show_body(self) -> None:
        """Show the body instead of a sentence: what is in it needs no answer."""
        self._stack.setCurrentWidget(self._room)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.theme = theme
        self.paint_theme(theme)

    @property
    def message(self) -> str | None:
        """The sentence that is shown instead of the body, or None."""
        return self._message.text() if self._stack.currentWidget() is self._message else None

    # Controls.

    def add_control(self, control: QWidget, name: str, label: str, tip: str) -> None:
        """Put a widget into the line of controls."""
        control.setObjectName(f"{self.name}-{name}")
        # A sign or one letter is no name.
        control.setAccessibleName(label if sum(map(str.isalpha, label)) > 1 else tip.split(";")[0])
        set_tip(control, tip)
        self._line.addWidget(control)

    def add_slider(self, slider: Slider, name: str, tip: str) -> None:
        """Put a slider into the line of controls; it names itself."""
        said = slider.accessibleName()
        self.add_control(slider, name, said, tip)

    def add_choice(
        self, name: str, label: str, tip: str, items: Iterable[tuple[str, Any]], changed: Callable[[], Any]
    ) -> QComboBox:
        """Add a list of (text, value); ``changed`` is called when the user chooses."""
        box = ChoiceBox()
        box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        for text, value in items:
            box.addItem(text, value)
        box.activated.connect(lambda _: changed())
        self.add_control(box, name, label, tip)
        return box

    def add_number(
        self, name: str, label: str, tip: str, limits: tuple[int, int], changed: Callable[[], Any]
    ) -> WholeBox:
        """Add a whole number with its label inside the box."""
        box = WholeBox()
        box.setRange(*limits)
        box.setPrefix(f"{label} ")
        box.valueChanged.connect(lambda _: changed())
        self.add_control(box, name, label, tip)
        return box

    def add_switch(self, name: str, label: str, tip: str, changed: Callable[[bool], Any]) -> QCheckBox:
        """Add a check box."""
        box = QCheckBox(label)
        box.toggled.connect(changed)
        self.add_control(box, name, label, tip)
        return box

    def add_button(self, name: str, label: str, tip: str, pressed: Callable[[], Any]) -> QPushButton:
        """Add a push button."""
        button = QPushButton(label)
        button.clicked.connect(lambda _: pressed())
        self.add_control(button, name, label, tip)
        return button

    def add_readout(self) -> Readout:
        """Add the place where the value under the cursor is told: over the controls, which nobody uses then."""
        self._readout = Readout(f"{self.name}-readout", self, self._readout_room)
        return self._readout

    def _readout_room(self) -> QRect:
        spare = self._pages if self._folded else self.controls
        part = self._told if self._told.isVisible() else spare
        return QRect(part.mapTo(self, QPoint()), part.size())


def _themed(widget: QWidget) -> Iterator[Any]:
    """Yield what has colours of its own inside a widget; each gives them to the parts inside itself."""
    for child in widget.findChildren(QWidget, options=Qt.FindChildOption.FindDirectChildrenOnly):
        if hasattr(child, "set_theme"):
            yield child
        else:
            yield from _themed(child)


def replace_items(box: QComboBox, items: list[tuple[str, Any]]) -> None:
    """Give a list other items, keeping the chosen one where it still exists, without telling anyone."""
    if [(box.itemText(place), box.itemData(place)) for place in range(box.count())] == items:
        return
    chosen = box.currentData()
    blocked = box.blockSignals(True)
    box.clear()
    for text, value in items:
        box.addItem(text, value)
    box.setCurrentIndex(max(0, next((place for place, item in enumerate(items) if item[1] == chosen), 0)))
    box.blockSignals(blocked)
