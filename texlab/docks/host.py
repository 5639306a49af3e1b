"""Makes the docks when they are first seen, asks their questions in the background, hands them the answers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QDeadlineTimer, QEvent, QObject, QTimer, Signal
from PySide6.QtWidgets import QWidget

from texlab.runs.worker import Task, Worker
from texlab.state.scene import same_but_probe
from texlab.widgets.once import Once

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from PySide6.QtWidgets import QDockWidget

    from texlab.docks.base import Dock, Question
    from texlab.runs.slots import Slots
    from texlab.state.scene import Scene
    from texlab.style.theme import Theme
    from texlab.widgets.control_settings import Setting

LOOKS = frozenset((QEvent.Type.Show, QEvent.Type.Hide, QEvent.Type.Move, QEvent.Type.Resize))
NOTHING_YET = "There is nothing to show yet."


class DockHost(QObject):
    """Drives one dock: only while it is visible, one question at a time, the newest scene next.

    A running question is not interrupted by a newer scene, or a live run would never be shown; the newer scene is
    asked about as soon as the answer is there, but not within ``dock.rest_ms`` of it: while a control is dragged,
    the pictures come first. A question is dropped when its dock goes out of sight: all docks share the places, and
    nobody who looks at one waits for what nobody sees.

    Parameters
    ----------
    kind
        A dock, or its class: then the dock is made when it is first seen in its ``frame``, piece by piece, with
        turns of the event loop between them; or at once when it is asked for.
    slots
        Places to compute in.

    ``made(dock)`` once, before the dock is shown.
    """

    made = Signal(object)

    def __init__(self, kind: Dock | type[Dock], slots: Slots, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.kind = kind
        self.name = kind.name
        self._dock: Dock | None = None
        self._frame: QDockWidget | None = None
        self._theme: Theme | None = None
        # What is left to make, once that has begun.
        self._pieces: Iterator[None] | None = None
        self._is_making = False
        self._half_made: tuple[Dock, Iterator[None]] | None = None
        # How the controls stand in a dock that was just made, and how they were wanted before.
        self._first: dict[str, Setting] = {}
        self._wanted: dict[str, Any] = {}
        self._worker = Worker(self.name, slots, self)
        self._worker.finished.connect(self._answered)
        self._worker.failed.connect(self._refused)
        self._scene: Scene | None = None
        self._asked: tuple[Any, ...] | None = None
        self._computing = False
        # Whether the dock has been told anything since it forgot.
        self._knows = False
        self._dirty = False
        self._was_seen: bool | None = None
        self._rested = QDeadlineTimer(0)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.timeout.connect(self._update)
        self._look = Once(self, 0, self._update)
        self._more = Once(self, 0, self._go_on_making)
        if not isinstance(kind, type):
            self._take(kind)

    # Making.

    @property
    def dock(self) -> Dock:
        """The dock, which is made now if nobody has seen it yet."""
        # Who hears that it was made may ask for it.
        if not self._is_making:
            self.make()
        assert self._dock is not None
        return self._dock

    def make(self) -> None:
        """Make the dock now, before anybody looks at it."""
        while self.make_more():
            pass

    def make_more(self) -> bool:
        """Make the next piece of the dock, a few milliseconds of work; return whether there is more to make."""
        if self.is_made:
            return False
        if self._pieces is None:
            self._pieces = self._make_pieces()
        pieces, self._is_making = self._pieces, True
        # One that fails is begun anew.
        self._pieces = None
        try:
            for _ in pieces:
                self._pieces = pieces
                break
        finally:
            self._is_making = False
        return self._pieces is not None

    def _make_pieces(self) -> Iterator[None]:
        assert isinstance(self.kind, type)
        dock = self.kind(whole=False)
        self._half_made = dock, dock.pieces()
        yield
        yield from self._half_made[1]
        self._first = dock.settings()
        if self._theme is not None:
            dock.set_theme(self._theme)
        self._take(dock)
        if self._scene is not None:
            dock.note_scene(self._scene)
        self.made.emit(dock)
        yield
        self._half_made = None
        self._put()
        wanted, self._wanted = self._wanted, {}
        if wanted:
            dock.take_settings(wanted)

    def _go_on_making(self) -> None:
        if not self.seen:
            return
        if self.make_more():
            self._more.start()
        else:
            self._update()

    @property
    def is_made(self) -> bool:
        """Whether there is a dock already."""
        return self._dock is not None and self._pieces is None

    def set_frame(self, frame: QDockWidget) -> None:
        """Say where in the window the dock has its place; it is made when that is seen."""
        self._frame = frame
        frame.installEventFilter(self)
        if self._dock is None:
            # A frame with nothing in it does not keep to the heights that it is given.
            frame.setWidget(QWidget())
        self._put()

    def _take(self, dock: Dock) -> None:
        self._dock = dock
        dock.installEventFilter(self)
        dock.asks.connect(self._update)

    def _put(self) -> None:
        """Put the dock into its frame."""
        if self._dock is None or self._frame is None:
            return
        before = self._frame.widget()
        # Who came here by a key before anything was made goes on in what is made now.
        has_keyboard = before is not None and before.hasFocus()
        self._frame.setWidget(self._dock)
        if has_keyboard:
            self._dock.setFocus()
        if before is not None:
            before.deleteLater()
        self._dock.show()
        layout = self._frame.layout()
        if layout is not None:
            # It has its size at once: whoever made it may want to give it the keyboard.
            layout.activate()

    # What a dock that nobody has seen is told, and says.

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        if self._dock is not None:
            self._dock.set_theme(theme)

    def settings(self) -> dict[str, Any]:
        """Return how the controls stand; empty while nobody has seen them and nothing else is wanted."""
        return self._dock.settings() if self._dock is not None and self.is_made else dict(self._wanted)

    def take_settings(self, wanted: Mapping[str, Any]) -> None:
        """Set what can be set; a dock that nobody has seen is made with it.

        What :meth:`settings` returned before the dock was made brings back how the dock was made.
        """
        if self._dock is None or not self.is_made:
            self._wanted = dict(wanted)
        else:
            self._dock.take_settings(wanted or self._first)

    # Showing.

    def show_scene(self, scene: Scene) -> None:
        """Take a newer scene."""
        before, self._scene = self._scene, scene
        if self._dock is not None:
            self._dock.note_scene(scene)
        moved = before is not None and not self.kind.follows_pointer and same_but_probe(scene, before)
        if not moved:
            self._update()
        if before is None or moved or self._dock is None or not self._knows or self.seen:
            return
        if scene.has_lost(before):
            # A tab behind another one would keep its pictures, and all that was computed from them, for good.
            self._asked, self._knows = None, False
            self._dock.forget()

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        self._worker.leave()

    def close(self) -> None:
        """Stop and join the thread."""
        self._rest.stop()
        self._look.stop()
        self._more.stop()
        self._worker.close()
        if self._half_made is not None:
            # Parts that lie nowhere yet would be nobody's; whoever lets go of the pieces ends them.
            dock, rest = self._half_made
            for _ in rest:
                pass
            self._half_made = self._pieces = self._dock = None
            dock.deleteLater()

    @property
    def busy(self) -> bool:
        """Whether an answer is under way, a newer scene waits to be asked about, or the dock is being made."""
        soon = self._rest.isActive() or self._look.isActive() or self._more.isActive()
        return self._computing or (soon and self.seen)

    @property
    def seen(self) -> bool:
        """Whether any part of the dock can be seen: Qt calls the tabs behind the front one visible, too."""
        part: QWidget | None = self._dock if self.is_made else self._frame
        return part is not None and is_seen(part)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Catch up when the dock comes into sight or goes: shown, hidden, its frame brought to the front."""
        kind = event.type()
        if kind == QEvent.Type.ParentChange and watched is self._dock:
            frame = self._dock.parentWidget()
            if frame is not None:
                frame.installEventFilter(self)
        elif kind in LOOKS:
            # The frame has its new place when the event has been handled.
            self._look.start()
        return super().eventFilter(watched, event)

    def _update(self) -> None:
        seen = self.seen
        if not self.is_made:
            if seen and not self._is_making:
                self._more.start()
            return
        dock = self.dock
        if seen is not self._was_seen:
            self._was_seen = seen
            dock.set_seen(seen)
            if not seen:
                self._drop()
        if self._scene is None or not seen:
            return
        self._knows = True
        dock.show_scene(self._scene)
        if self._computing:
            self._dirty = True
            return
        if not self._rested.hasExpired():
            if not self._rest.isActive():
                self._rest.start(self._rested.remainingTime())
            return
        question = dock.question(self._scene)
        if question is None:
            self._asked = None
            dock.present_nothing(NOTHING_YET)
            return
        if question.key == self._asked:
            return
        self._asked = question.key
        self._ask(question)

    def _ask(self, question: Question) -> None:
        def work(task: Task) -> Any:
            return question.compute(task.should_stop)

        self._computing = True
        self.dock.present_waiting()
        self._worker.submit(work)

    def _drop(self) -> None:
        """Forget a question under way: it is asked anew when the dock is seen again."""
        if self._computing:
            self._worker.cancel()
            self._asked, self._computing, self._dirty = None, False, False

    def _answered(self, answer: Any) -> None:
        self._computing = False
        self._rested.setRemainingTime(self.dock.rest_ms)
        self.dock.present(answer)
        self._again()

    def _refused(self, sentence: str) -> None:
        self._computing = False
        self.dock.present_nothing(sentence)
        self._again()

    def _again(self) -> None:
        if self._dirty:
            self._dirty = False
            self._update()


def is_seen(part: QWidget) -> bool:
    """Return whether any of a widget can be seen; what its own parts cover is seen through them."""
    return part.isVisible() and not _lies_outside(part) and _shows(part)


def _lies_outside(part: QWidget) -> bool:
    """Return whether a widget, or what it lies in, is beside its parent: so Qt puts the tabs behind the front one.

    There are hundreds of parts in them, and every change of the scene asks.
    """
    here: QWidget | None = part
    while here is not None and not here.isWindow():
        above = here.parentWidget()
        if above is not None and not above.rect().intersects(here.geometry()):
            return True
        here = above
    return False


def _shows(part: QWidget) -> bool:
    if not part.isVisible():
        return False
    if not part.visibleRegion().isEmpty():
        return True
    return any(isinstance(each, QWidget) and _shows(each) for each in part.children())
