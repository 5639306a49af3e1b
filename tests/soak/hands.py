"""Random hands: real events of mouse and keyboard, drawn from a seed, for whatever window is in front."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import shiboken6
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QContextMenuEvent, QGuiApplication, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QApplication,
    QFileDialog,
    QLineEdit,
    QMenu,
    QTabBar,
    QWidget,
)

if TYPE_CHECKING:
    import random
    from collections.abc import Callable

    from texlab.app.explorer import Explorer

NONE = Qt.KeyboardModifier.NoModifier
BUTTONS = Qt.MouseButton
MODIFIERS = (
    (Qt.KeyboardModifier.ControlModifier, Qt.Key.Key_Control),
    (Qt.KeyboardModifier.AltModifier, Qt.Key.Key_Alt),
    (Qt.KeyboardModifier.ShiftModifier, Qt.Key.Key_Shift),
)
KEYS = [
    *("Tab", "Return", "Space", "Escape", "Left", "Right", "Up", "Down", "PageUp", "PageDown", "Home", "End"),
    *("Delete", "Backspace", "Plus", "Minus", "Period", *"0123579ABDFGLTWXZ", "F1", "F4", "F5"),
]
# These end the window, or start another program that nobody would end.
FORBIDDEN = {"action-quit", "action-another-window"}
# A person does not do these every second, and each costs more than a hundred others.
RARE = {"action-run-all", "action-batch", "action-failures", "action-four", "action-spectra"}


def is_there(address: int) -> bool:
    """Return whether a window of this address still exists: what Qt deletes by itself Python is not told."""
    return any(shiboken6.getCppPointer(each)[0] == address for each in QGuiApplication.allWindows())


def letters(key: Qt.Key, held: Qt.KeyboardModifier) -> str:
    """Return the text that a key writes, as a keyboard gives it."""
    text = QTest.keyToAscii(key).strip("\0")
    return text.upper() if held & Qt.KeyboardModifier.ShiftModifier else text


class Hands:
    """Moves mouse and keys at random; the same seed makes the same movements, where the window does the same."""

    def __init__(self, random: random.Random, explorer: Explorer) -> None:
        self.random = random
        self.explorer = explorer
        self._seen: list[QWidget] = []
        self._age = 0
        self.acts: list[tuple[int, Callable[[QWidget], None]]] = [
            (26, self.hover),
            (14, self.click),
            (3, self.double_click),
            (5, self.wheel),
            (7, self.drag),
            (6, self.context_menu),
            (8, self.press_key),
            (7, self.shortcut),
            (7, self.menu_command),
            (5, self.choose_tab),
            (3, self.choose_texture),
            (4, self.type_number),
            (2, self.resize),
            (1, self.about),
            (2, self.crop),
        ]

    def act(self) -> str:
        """Do one thing; return its name."""
        front = self.front()
        if front is None:
            return "nothing"
        if front is not self.explorer.window and (
            isinstance(front, QFileDialog) or self.random.random() < (0.2 if isinstance(front, QMenu) else 0.1)
        ):
            self.key(front, Qt.Key.Key_Escape)
            return "escape"
        weights = [weight for weight, _ in self.acts]
        act = self.random.choices([each for _, each in self.acts], weights)[0]
        act(front)
        return act.__name__

    def front(self) -> QWidget | None:
        """Return what gets the events: a popup, a dialog, the window itself."""
        popup, modal = QApplication.activePopupWidget(), QApplication.activeModalWidget()
        if popup is not None or modal is not None:
            return popup or modal
        window = self.explorer.window
        others = [
            each
            for each in QApplication.topLevelWidgets()
            if each.isVisible()
            and each is not window
            and each.isWindow()
            and not isinstance(each, QMenu)
            and each.windowType() in (Qt.WindowType.Dialog, Qt.WindowType.Window)
        ]
        if others and self.random.random() < 0.3:
            return self.random.choice(others)
        return window if window.isVisible() else None

    # Where.

    def widget(self, front: QWidget) -> QWidget:
        """Return any widget that can be seen in a window."""
        self._age += 1
        if self._age > 12 or not self._seen or self._seen[0] is not front:
            found = [each for each in front.findChildren(QWidget) if each.isVisible() and each.isEnabled()]
            self._seen = [front, *(each for each in found if not each.visibleRegion().isEmpty())]
            self._age = 0
        return self.random.choice(self._seen)

    def place(self, front: QWidget, widget: QWidget | None = None) -> QPoint:
        """Return a place in a window: anywhere, or within one of its parts."""
        if widget is None and self.random.random() < 0.5:
            widget = front
        widget = widget or self.widget(front)
        try:
            shown = widget.visibleRegion().boundingRect()
            if shown.isEmpty():
                raise RuntimeError
            at = QPoint(
                self.random.randint(shown.left(), shown.right()), self.random.randint(shown.top(), shown.bottom())
            )
            return widget.mapTo(front, at) if widget is not front else at
        except RuntimeError:
            # It has gone since the parts were listed.
            self._seen = []
            return QPoint(self.random.randrange(front.width()), self.random.randrange(front.height()))

    # Events, through the window system's door.

    def move(self, front: QWidget, at: QPoint) -> None:
        handle = front.windowHandle()
        if handle is not None:
            QTest.mouseMove(handle, at)

    def press(self, front: QWidget, button: Qt.MouseButton, at: QPoint) -> None:
        handle = front.windowHandle()
        if handle is not None:
            address = shiboken6.getCppPointer(handle)[0]
            QTest.mousePress(handle, button, NONE, at)
            # A press may close the window, and the release would be sent to what is no more.
            if is_there(address):
                QTest.mouseRelease(handle, button, NONE, at)

    def key(self, front: QWidget, key: Qt.Key, held: Qt.KeyboardModifier = NONE) -> None:
        handle = front.windowHandle()
        if handle is None:
            return
        address = shiboken6.getCppPointer(handle)[0]
        text = letters(key, held)
        strokes = [
            *((True, name, held, "") for modifier, name in MODIFIERS if modifier & held),
            (True, key, held, text),
            (False, key, held, text),
            *((False, name, NONE, "") for modifier, name in reversed(MODIFIERS) if modifier & held),
        ]
        # One event at a time, and none to a window that has gone: after each the program has a turn, and what it
        # closes then is deleted. QTest.keyPress sends the modifiers too, and would not look in between.
        QApplication.processEvents()
        for down, each, modifiers, written in strokes:
            if not is_there(address):
                return
            QTest.simulateEvent(handle, down, each.value, modifiers, written, False)

    # What hands do.

    def hover(self, front: QWidget) -> None:
        for _ in range(3):
            self.move(front, self.place(front))

    def click(self, front: QWidget) -> None:
        self.press(front, BUTTONS.LeftButton, self.place(front))

    def double_click(self, front: QWidget) -> None:
        at = self.place(front)
        self.press(front, BUTTONS.LeftButton, at)
        # Not QTest.mouseDClick: its four events would go to a window that the first of them has closed. What it
        # presses one by one lies half a second apart.
        usual = QApplication.doubleClickInterval()
        QApplication.setDoubleClickInterval(10_000)
        if shiboken6.isValid(front):
            self.press(front, BUTTONS.LeftButton, at)
        QApplication.setDoubleClickInterval(usual)

    def wheel(self, front: QWidget) -> None:
        at = self.place(front)
        target = front.childAt(at) or front
        steps = QPoint(0, self.random.choice((-240, -120, 120, 240)))
        event = QWheelEvent(
            QPointF(target.mapFrom(front, at)) if target is not front else QPointF(at),
            QPointF(front.mapToGlobal(at)), QPoint(), steps, BUTTONS.NoButton, NONE,
            Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(target, event)

    def drag(self, front: QWidget) -> None:
        handle = front.windowHandle()
        if handle is None:
            return
        start = self.place(front)
        address = shiboken6.getCppPointer(handle)[0]
        QTest.mousePress(handle, BUTTONS.LeftButton, NONE, start)
        for _ in range(3):
            start += QPoint(self.random.randint(-40, 40), self.random.randint(-30, 30))
            if is_there(address):
                QTest.mouseMove(handle, start)
        if is_there(address):
            QTest.mouseRelease(handle, BUTTONS.LeftButton, NONE, start)

    def context_menu(self, front: QWidget) -> None:
        at = self.place(front)
        target = front.childAt(at) or front
        local = target.mapFrom(front, at) if target is not front else at
        menu = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, local, front.mapToGlobal(at))
        self.press(front, BUTTONS.RightButton, at)
        # The window system would send it; a press may have taken away what it was meant for.
        if shiboken6.isValid(target) and not isinstance(front, QMenu):
            QApplication.sendEvent(target, menu)

    def press_key(self, front: QWidget) -> None:
        held = self.random.choice((NONE, NONE, NONE, Qt.KeyboardModifier.ShiftModifier))
        self.key(front, getattr(Qt.Key, f"Key_{self.random.choice(KEYS)}"), held)

    def shortcut(self, front: QWidget) -> None:
        actions = [
            each
            for each in self.explorer.window.actions_by_name.values()
            if not each.shortcut().isEmpty() and each.objectName() not in FORBIDDEN
        ]
        stroke = self.random.choice(actions).shortcut()[0]
        self.key(front, stroke.key(), stroke.keyboardModifiers())

    def menu_command(self, front: QWidget) -> None:
        """Open a menu of the menu bar and click one of its commands; or what is in the menu that is open."""
        if isinstance(front, QMenu):
            self.choose(front)
            return
        if front is not self.explorer.window:
            return
        bar = self.explorer.window.menuBar()
        title = self.random.choice(bar.actions())
        self.press(front, BUTTONS.LeftButton, bar.mapTo(front, bar.actionGeometry(title).center()))
        opened = QApplication.activePopupWidget()
        if isinstance(opened, QMenu):
            self.choose(opened)

    def choose(self, menu: QMenu) -> None:
        actions = [
            each
            for each in menu.actions()
            if each.isEnabled()
            and not each.isSeparator()
            and each.objectName() not in FORBIDDEN
            and (each.objectName() not in RARE or self.random.random() < 0.2)
        ]
        if actions:
            self.press(menu, BUTTONS.LeftButton, menu.actionGeometry(self.random.choice(actions)).center())
        else:
            self.key(menu, Qt.Key.Key_Escape)

    def choose_tab(self, front: QWidget) -> None:
        bars = [each for each in front.findChildren(QTabBar) if each.isVisible() and each.count()]
        if bars:
            bar = self.random.choice(bars)
            tab = bar.tabRect(self.random.randrange(bar.count())).center()
            if bar.rect().contains(tab):
                self.press(front, BUTTONS.LeftButton, bar.mapTo(front, tab))
                return
        self.explorer.window.show_dock(self.random.choice(list(self.explorer.hosts)))

    def choose_texture(self, front: QWidget) -> None:
        tree = self.explorer.window.gallery.tree
        if front is self.explorer.window and tree.isVisible():
            heads = [tree.topLevelItem(place) for place in range(tree.topLevelItemCount())]
            leaves = [head.child(at) for head in heads if head is not None for at in range(head.childCount())]
            item = self.random.choice(leaves)
            tree.scrollToItem(item)
            at = tree.visualItemRect(item).center()
            self.press(front, BUTTONS.LeftButton, tree.viewport().mapTo(front, at))

    def type_number(self, front: QWidget) -> None:
        boxes = [
            each
            for each in front.findChildren(QAbstractSpinBox)
            if each.isEnabled() and not each.visibleRegion().isEmpty()
        ]
        if boxes:
            box = self.random.choice(boxes)
            self.press(front, BUTTONS.LeftButton, box.mapTo(front, QPoint(8, box.height() // 2)))
            self.key(front, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
            text = self.random.choice(("0.5", "1", "3", "12", "64", "0,25"))
            target: Any = QApplication.focusWidget()
            if isinstance(target, QLineEdit | QAbstractSpinBox):
                QTest.keyClicks(target, text)
            self.key(front, Qt.Key.Key_Return)

    def resize(self, front: QWidget) -> None:
        if front is self.explorer.window:
            front.resize(self.random.randint(900, 1500), self.random.randint(650, 1000))

    def about(self, front: QWidget) -> None:
        self.explorer.window.actions_by_name["about"].trigger()

    def crop(self, front: QWidget) -> None:
        """Show the crop box and right-click one of its handles, which have menus of their own."""
        exemplar = self.explorer.workspace.exemplar
        if front is not self.explorer.window or exemplar.visibleRegion().isEmpty():
            return
        toggle = exemplar.crop_button
        self.press(front, BUTTONS.LeftButton, toggle.mapTo(front, toggle.rect().center()))
        box = exemplar._box
        if box.isVisible():
            handle = self.random.choice(box.getHandles())
            at = exemplar.pane.mapFromScene(handle.scenePos())
            self.press(
                front,
                self.random.choice((BUTTONS.LeftButton, BUTTONS.RightButton)),
                exemplar.pane.mapTo(front, at),
            )
