"""``python -m tests.soak``: random real events in the window; says what grew, and fails when something did.

Readings are compared in the same state: no window, what the program keeps to be quick the next time let go of,
garbage collected, freed memory given back. Otherwise a reading would tell which picture was on the stage, and not
what is left behind. Code stays for good once it is loaded: all of it is loaded before the first reading.
"""

from __future__ import annotations

import argparse
import dataclasses
import faulthandler
import gc
import os
import random
import signal
import sys
import tempfile
import threading
import time
import traceback
import tracemalloc
import weakref
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QCoreApplication, QEvent, QEventLoop, Qt, QTimer
from PySide6.QtWidgets import QApplication

from tests.soak import census
from tests.soak.hands import Hands
from tests.soak.large import look
from texlab.app.memory import give_back
from texlab.app.start import application, await_threads, build, complete
from texlab.storage.settings import Settings
from texlab.style.theme import ThemeSource
from texlab_core.engine.inputs import Crop
from texlab_core.warming import warm_up

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

FIRST = "gallery:structured-pebbles"
MOST_COLUMNS = 5
MOST_SIDE = 96
# An event that does not come back for this long has opened a box with a loop of its own.
STUCK_S = 0.15
LOOK_MS = 50
PAUSE_MS = 2
REST_S = 120.0
# Longer than any timer that a closed window may have left.
SETTLE_S = 0.5


def main(arguments: list[str] | None = None) -> int:
    """Run the soak; return 0 when nothing grew and nothing went wrong."""
    parser = argparse.ArgumentParser(prog="python -m tests.soak", description=__doc__)
    parser.add_argument("--events", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--every", type=int, default=1000, help="events between two counts")
    parser.add_argument("--reopen", type=int, default=500, help="events between two windows; 0: one window")
    parser.add_argument("--growth", type=float, default=0.05, help="share allowed after the first count")
    parser.add_argument("--objects", action="store_true", help="list the types that grew, and the largest arrays")
    parser.add_argument("--trace", action="store_true", help="list the lines whose memory grew (slow)")
    options = parser.parse_args(arguments)
    if hasattr(signal, "SIGUSR1"):
        faulthandler.register(signal.SIGUSR1)
    with tempfile.TemporaryDirectory(prefix="texlab-soak-") as home:
        os.environ["TEXLAB_HOME"] = os.environ["HOME"] = home
        os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
        here = Path.cwd()
        os.chdir(home)
        try:
            return Soak(options).run()
        finally:
            os.chdir(here)


class Soak:
    """One process, several windows one after the other, and what stays."""

    def __init__(self, options: Any) -> None:
        self.options = options
        self.random = random.Random(options.seed)
        self.problems: list[str] = []
        self.counts: list[census.Census] = []
        self.done = 0
        self.acts: dict[str, int] = {}
        self._snapshot: tracemalloc.Snapshot | None = None

    def run(self) -> int:
        """Do everything, say what was found, and return the exit code."""
        QApplication.setAttribute(Qt.ApplicationAttribute.AA_DontUseNativeDialogs)
        hooks = sys.excepthook, threading.excepthook
        sys.excepthook = lambda *error: self.note(traceback.format_exception(*error))
        threading.excepthook = lambda args: self.note(traceback.format_exception(args.exc_value))
        application()
        # Code stays for good, and would be taken for growth.
        warm_up()
        census.import_everything()
        threads = threading.active_count()
        if self.options.trace:
            tracemalloc.start(12)
        print(census.HEAD, flush=True)
        start = time.monotonic()
        while self.done < self.options.events:
            self._one_window(min(self.options.reopen or self.options.events, self.options.events - self.done))
        await_threads()
        if threading.active_count() > threads:
            self.problems.append(f"Threads left: {', '.join(each.name for each in threading.enumerate())}.")
        if windows := QApplication.topLevelWidgets():
            self.problems.append(f"Windows left: {', '.join(map(repr, windows))}.")
        self._judge()
        sys.excepthook, threading.excepthook = hooks
        print(f"{self.done} events in {time.monotonic() - start:.0f} s: {dict(sorted(self.acts.items()))}")
        for problem in self.problems:
            print(problem)
        return 1 if self.problems else 0

    def note(self, lines: list[str]) -> None:
        """Take down what nobody caught."""
        self.problems.append(f"After {self.done} events:\n{''.join(lines)}")
        print(self.problems[-1], file=sys.stderr, flush=True)

    def _one_window(self, events: int) -> None:
        """Open a window, do so many things in it, close it."""
        settings, themes = Settings(), ThemeSource("light")
        settings.values.setdefault("session", {"seed": 3, "size": [64, 64]})
        settings.values.setdefault("panels", True)
        window = build(settings, themes)
        window.resize(1280, 800)
        window.show()
        explorer = complete(window, settings, themes)
        explorer.start(None if self.done else FIRST)
        if not self.done:
            look(explorer)
        loop = QEventLoop()
        driver = Driver(self, explorer, events, loop)
        driver.start()
        loop.exec()
        self._rest(explorer)
        counted = self.done % self.options.every == 0 or self.done >= self.options.events
        if counted:
            self._count(explorer)
        window.close()
        window.deleteLater()
        gone = weakref.ref(explorer)
        del driver, explorer, window
        # Timers that were started before hold what they call until they have fired.
        end = time.monotonic() + SETTLE_S
        while time.monotonic() < end:
            QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
            QCoreApplication.processEvents()
            time.sleep(0.01)
        gc.collect()
        if gone() is not None:
            self.problems.append(f"The window that was closed after {self.done} events is still in memory.")
        if counted:
            self._count(None)

    def _rest(self, explorer: Explorer) -> None:
        """Close what is open over the window, and wait until it has come to rest."""
        for _ in range(20):
            front = QApplication.activePopupWidget() or QApplication.activeModalWidget()
            if front is None:
                break
            front.close()
            QCoreApplication.processEvents()
        explorer.controller.stop_all()
        end = time.monotonic() + REST_S
        while not explorer.idle:
            if time.monotonic() > end:
                self.problems.append(f"The window was not at rest {REST_S:.0f} s after event {self.done}.")
                return
            QCoreApplication.processEvents()
            QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
            time.sleep(0.005)

    def _count(self, explorer: Explorer | None) -> None:
        """Count with a window at rest, and without any: what windows show differs, what is left must not."""
        if explorer is None:
            census.let_go()
        # At rest the program does this by itself.
        give_back()
        found = census.take(self.done, explorer)
        print(found.line(), flush=True)
        if explorer is not None:
            return
        if self.counts and self.options.objects:
            for name, count in (found.types - self.counts[-1].types).most_common(25):
                print(f"        {count:>+8} {name}")
        if self.options.objects:
            print("        " + "\n        ".join(census.largest_arrays(8)), flush=True)
        if self.options.trace:
            before, self._snapshot = self._snapshot, tracemalloc.take_snapshot()
            for each in self._snapshot.compare_to(before, "traceback")[:12] if before is not None else ():
                print(f"        {each.size_diff / 2**20:+.2f} MB {each.count_diff:+}")
                print("            " + "\n            ".join(each.traceback.format(limit=4)))
        self.counts.append(found)

    def _judge(self) -> None:
        if len(self.counts) > 1:
            first, last = self.counts[0], self.counts[-1]
            growth = last.resident / first.resident - 1
            print(f"memory after {first.events} and {last.events} events, windows closed: {100 * growth:+.1f} %")
            if growth > self.options.growth:
                self.problems.append(f"The memory grew by {100 * growth:.1f} %.")


class Driver:
    """Does one thing after another from the event loop, also inside the loops of boxes and menus."""

    def __init__(self, soak: Soak, explorer: Explorer, events: int, loop: QEventLoop) -> None:
        self._soak, self._explorer, self._left, self._loop = soak, explorer, events, loop
        self._hands = Hands(soak.random, explorer)
        self._acting = 0
        self._since = 0.0

    def start(self) -> None:
        """Begin, as soon as there is an event loop."""
        QTimer.singleShot(0, self._turn)
        QTimer.singleShot(LOOK_MS, self._look)

    def _turn(self) -> None:
        if self._left <= 0:
            self._loop.quit()
            return
        self._act()
        QTimer.singleShot(PAUSE_MS, self._turn)

    def _look(self) -> None:
        """Go on where an event does not come back."""
        if self._left <= 0 and not self._acting:
            return
        # A timer's own slot is not called again inside itself: each look is another timer.
        QTimer.singleShot(LOOK_MS, self._look)
        if self._acting and time.monotonic() - self._since > STUCK_S:
            self._act()

    def _act(self) -> None:
        self._acting += 1
        self._since = time.monotonic()
        if self._left > 0:
            self._left -= 1
            self._soak.done += 1
        try:
            name = self._hands.act()
            self._soak.acts[name] = self._soak.acts.get(name, 0) + 1
        except RuntimeError as error:
            # What the program does wrong arrives in the hook; this is a hand over what has just gone.
            if "already deleted" not in str(error):
                raise
        finally:
            self._acting -= 1
        self._since = time.monotonic()
        self._bound()

    def _bound(self) -> None:
        """Keep the work small: a soak looks for what stays, not for what takes long."""
        session = self._explorer.session
        state = session.state
        for column in state.columns[MOST_COLUMNS:]:
            session.remove_column(column.id)
        if max(state.size) > MOST_SIDE:
            session.set_size((64, 64))
        sample = state.sample
        if sample is not None and sample.crop is None and max(sample.source.size) > 2 * MOST_SIDE:
            session.set_sample(dataclasses.replace(sample, crop=Crop(8, 8, MOST_SIDE, MOST_SIDE)))


if __name__ == "__main__":
    sys.exit(main())
