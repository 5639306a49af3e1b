"""What every dock is: a question about the scene, computed elsewhere, and the showing of its answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtWidgets import QMenu, QToolTip, QWidget

from texlab.state.intentions import TakePicture, TakeStage
from texlab.state.scene import Scene
from texlab.widgets.control_settings import control_settings, take_control_settings
from texlab.widgets.own_keys import OwnKeys

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from PySide6.QtGui import QContextMenuEvent

    from texlab.style.theme import Theme


class Dock(OwnKeys, QWidget):
    """A tab below the images.

    A dock gets frozen data and sends frozen values; it holds no controller, worker or session, never computes and
    never writes.

    - ``scene`` is the newest scene; a dock keeps no column, result or picture of it anywhere else, unless it
      lets go of that in ``forget``.
    - ``show_scene`` shows at once what needs no computing. It is called for every newer scene while the dock is
      seen, so what it shows follows from the scene alone: whatever happened while the dock was hidden is in it.
    - ``question`` says (quickly, from the scene and the dock's own controls) what is to be computed in a
      background thread; ``present`` shows the answer, ``present_nothing`` why there is none, ``present_waiting``
      that it is under way. When its own controls change what it asks, a dock emits ``asks``.
    - A dock that takes more than a few milliseconds to make is made in ``pieces``, so that the window answers in
      between.
    - What the user does to the session through it (take parameters, choose a pixel, save a file) it emits as
      ``intention``: a value of :mod:`texlab.state.intentions`.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    help: ClassVar[str]
    order: ClassVar[int] = 100
    within: ClassVar[str] = ""
    """Name of the dock of which this one is a part; "" for a tab of the window."""
    follows_pointer: ClassVar[bool] = False
    """Whether what it shows depends on ``scene.probe``; others do not hear of a pointer that moves."""
    rest_ms: ClassVar[int] = 100
    """How long an answer stays before the dock is asked again."""

    asks = Signal()
    needs_room = Signal()
    """When one teaches: what is shown may have another ``least_height``."""
    intention = Signal(object)
    """A value of :mod:`texlab.state.intentions`."""

    def __init__(self, parent: QWidget | None = None, *, whole: bool = True) -> None:
        """Make the dock; one that is not made as a whole is ready once ``pieces()`` has come to its end."""
        super().__init__(parent)
        self.scene = Scene()
        """The newest one, also while the dock is not seen: what goes from the window is not held here."""
        self.setObjectName(f"dock-{self.name}")
        self.setAccessibleName(self.title)

    def pieces(self) -> Iterator[None]:
        """Make what is not made yet, piece by piece; nobody else knows the dock until then."""
        yield from ()

    def note_scene(self, scene: Scene) -> None:
        """Take note of the newest scene, whether the dock is seen or not."""
        self.scene = scene

    def show_scene(self, scene: Scene) -> None:
        """Show what needs no computing."""
        self.note_scene(scene)

    def question(self, scene: Scene) -> Question | None:
        """Return what to compute for this scene, or None when there is nothing to show."""
        raise NotImplementedError

    def present(self, answer: Any) -> None:
        """Show what ``Question.compute`` returned."""
        raise NotImplementedError

    def present_nothing(self, reason: str) -> None:
        """Show why there is nothing to show, in one sentence."""
        raise NotImplementedError

    def present_waiting(self) -> None:
        """Say that the answer is under way, where nothing else is shown."""

    def forget(self) -> None:
        """Let go of an answer that nobody sees and that is about pictures that are no longer there."""

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""

    def least_height(self, width: int) -> int:
        """Return the height in pixels, at a width, below which something that it shows has to be scrolled."""
        return self.minimumSizeHint().height()

    def fold_controls(self, folded: bool) -> None:
        """Leave the whole room to what is shown, or show the controls again; not every dock can."""

    def settings(self) -> dict[str, bool | int | float | str]:
        """Return how the controls stand, by name; :meth:`take_settings` takes it back."""
        return control_settings(self, f"{self.name}-")

    def take_settings(self, wanted: Mapping[str, Any]) -> tuple[str, ...]:
        """Set controls by name, as a user would; return one clause for each that cannot be set."""
        return take_control_settings(self, f"{self.name}-", wanted)

    def is_prepared(self, wanted: Mapping[str, Any]) -> bool:
        """Return whether everything is made that is shown with these settings."""
        return True

    def prepare(self, wanted: Mapping[str, Any]) -> None:
        """Make what will be shown with these settings, and show it not yet."""

    def set_seen(self, seen: bool) -> None:
        """Take note of whether any part of the dock can be seen; a tab behind another one cannot."""

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Offer what can be done with what the panel shows."""
        menu = QMenu(self)
        menu.setObjectName("panel-menu")
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for text, intention in (
            ("Copy picture of this panel", TakePicture(self.name, "copy")),
            ("Save picture of this panel ...", TakePicture(self.name, "save")),
            ("Over the stage, or back", TakeStage(self.within or self.name)),
        ):
            action = menu.addAction(text)
            action.triggered.connect(lambda _=False, intention=intention: self.intention.emit(intention))
        menu.popup(event.globalPos())
        event.accept()

    def event(self, event: QEvent) -> bool:
        """Keep the tooltip of the frame, which explains the whole dock, off the pictures and plots."""
        if event.type() == QEvent.Type.ToolTip:
            QToolTip.hideText()
            return True
        return super().event(event)


@dataclass(frozen=True, eq=False)
class Question:
    """What a dock wants to know.

    Parameters
    ----------
    key
        Hashable; while it stays equal nothing is computed again.
    compute
        Called in a background thread with a ``should_stop`` function; its value goes to ``Dock.present``. It must
        not touch any widget.
    """

    key: tuple[Any, ...]
    compute: Callable[[Callable[[], bool]], Any]
