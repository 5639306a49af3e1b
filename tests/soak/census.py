"""What there is in the process: memory, objects, windows, timers, threads."""

from __future__ import annotations

import ctypes
import gc
import importlib
import pkgutil
import sys
import threading
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shiboken6
from PySide6.QtCore import QObject, QTimer
from PySide6.QtGui import QPixmapCache
from PySide6.QtWidgets import QApplication, QGraphicsView, QWidget

import texlab
import texlab_core
from texlab.app.memory import memory_bytes
from texlab.docks.recent import Recent
from texlab_core.work.kept import shrink

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer


@dataclass(frozen=True)
class Census:
    """Counts at one moment, after everything had time to come to rest."""

    events: int
    resident: int
    """Bytes of the process."""
    in_use: int
    """Bytes that malloc has given out; less than the resident size is what lies between."""
    widgets: int
    windows: int
    objects: int
    timers: int
    items: int
    threads: int
    kept: int
    """Bytes of finished results and analyses."""
    types: Counter[str]

    def line(self) -> str:
        """Return the counts as a line of a table."""
        megabytes = (f"{size / 2**20:>8.1f}" for size in (self.resident, self.in_use, self.kept))
        counts = self.widgets, self.windows, self.objects, self.timers, self.items, self.threads
        return " ".join([f"{self.events:>7}", *megabytes, *(f"{count:>8}" for count in counts)])


NAMES = "events", "RSS MB", "used MB", "kept MB", "widgets", "windows", "qobjects", "timers", "items", "threads"
HEAD = " ".join([f"{NAMES[0]:>7}", *(f"{name:>8}" for name in NAMES[1:])])


def take(events: int, explorer: Explorer | None) -> Census:
    """Count what there is."""
    gc.collect()
    resident = memory_bytes() or 0
    widgets = QApplication.allWidgets()
    tops = QApplication.topLevelWidgets()
    objects: set[int] = set()
    timers = 0
    app = QApplication.instance()
    for root in (app, *tops):
        if root is None:
            continue
        for each in (root, *root.findChildren(QObject)):
            objects.add(shiboken6.getCppPointer(each)[0])
            timers += isinstance(each, QTimer) and each.isActive()
    views = [each for each in widgets if isinstance(each, QGraphicsView)]
    items = sum(len(each.scene().items()) for each in views if each.scene() is not None)
    kept = 0
    if explorer is not None:
        shared = explorer.controller.shared
        kept = shared.kept.nbytes + sum(shared.cache._sizes.values())
    return Census(
        events,
        resident,
        malloc_in_use(),
        len(widgets),
        sum(isinstance(each, QWidget) and each.isVisible() for each in tops),
        len(objects),
        timers,
        items,
        threading.active_count(),
        kept,
        Counter(type(each).__name__ for each in gc.get_objects()),
    )


def import_everything() -> None:
    """Load all modules of the program, so that what is loaded when it is first wanted is no growth."""
    for package in (texlab, texlab_core):
        for each in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not each.name.startswith(("texlab.__main__", "texlab._pyinstaller", "texlab_core.figures")):
                importlib.import_module(each.name)


def let_go() -> None:
    """Empty what is kept in the modules for the next time: pictures of Qt's style, filters, answers of tabs."""
    QPixmapCache.clear()
    shrink(0)
    for each in gc.get_objects():
        if isinstance(each, Recent):
            each.clear()
    gc.collect()


def largest_arrays(count: int) -> list[str]:
    """Return what the largest arrays are that anything holds, and what holds them; the sum comes first."""
    found: dict[int, tuple[int, str]] = {}
    for holder in gc.get_objects():
        for each in gc.get_referents(holder):
            if isinstance(each, np.ndarray) and each.base is None:
                name = ", ".join(map(str, list(holder)[:6])) if isinstance(holder, dict) else type(holder).__name__
                found[id(each)] = each.nbytes, f"{each.shape} {each.dtype} in {name}"
    ordered = sorted(found.values(), reverse=True)
    whole = f"{sum(size for size, _ in ordered) / 2**20:.2f} MB in {len(ordered)} arrays"
    return [whole, *(f"{size / 2**20:.2f} MB {what}" for size, what in ordered[:count])]


class _Mallinfo2(ctypes.Structure):
    _fields_ = [
        (name, ctypes.c_size_t)
        for name in (
            *("arena", "ordblks", "smblks", "hblks", "hblkhd"),
            *("usmblks", "fsmblks", "uordblks", "fordblks", "keepcost"),
        )
    ]  # fmt: skip


def malloc_info_2() -> _Mallinfo2:
    """Return what malloc says of itself (glibc 2.33 and newer); zeros elsewhere."""
    if sys.platform != "linux":
        return _Mallinfo2()
    try:
        mallinfo2 = ctypes.CDLL(None).mallinfo2
    except (AttributeError, OSError):
        return _Mallinfo2()
    mallinfo2.restype = _Mallinfo2
    return mallinfo2()  # type: ignore[no-any-return]


def malloc_in_use() -> int:
    """Return the bytes that malloc has given out; 0 where that is not known."""
    found = malloc_info_2()
    return int(found.uordblks + found.hblkhd)
