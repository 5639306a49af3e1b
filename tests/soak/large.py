"""``python -m tests.soak.large``: whether a window falls back to its memory once a large result has been closed.

The window first shows everything at a small size: every tab, every page of the laboratory. That is where it has to
come back to. Then another column makes a result of ``--size``, every tab looks at it, and the column is removed.
What is compared is the resident size after the program itself has come to rest and given memory back; nothing here
helps it.
"""

from __future__ import annotations

import argparse
import faulthandler
import os
import signal
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QCoreApplication, QEvent

from tests.soak.census import largest_arrays, malloc_in_use
from texlab.app.memory import memory_bytes
from texlab.app.start import application, await_threads, build, complete
from texlab.storage.settings import Settings
from texlab.style.theme import ThemeSource
from texlab_core.engine.registry import methods
from texlab_core.warming import warm_up

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

FIRST = "gallery:structured-pebbles"
SMALL = (64, 64)
STAYS = "pixels"
LIMIT_S = 1800.0
# The program looks at its memory every few seconds, and gives back at the second look at rest.
REST_S = 12.0


def main(arguments: list[str] | None = None) -> int:
    """Make a large result and close it; return 0 when the memory fell back."""
    parser = argparse.ArgumentParser(prog="python -m tests.soak.large", description=__doc__)
    parser.add_argument("--size", type=int, default=4096, help="side of the large result")
    parser.add_argument("--method", default="heeger-bergen")
    parser.add_argument("--set", nargs="*", default=["iterations=1"], help="parameters of the method, name=value")
    parser.add_argument("--growth", type=float, default=0.15, help="share that may stay")
    options = parser.parse_args(arguments)
    if hasattr(signal, "SIGUSR1"):
        faulthandler.register(signal.SIGUSR1)
    with tempfile.TemporaryDirectory(prefix="texlab-large-") as home:
        os.environ["TEXLAB_HOME"] = os.environ["HOME"] = home
        os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
        here = Path.cwd()
        os.chdir(home)
        hook = sys.excepthook
        try:
            return _run(options)
        finally:
            # The window's own hook writes to its log.
            sys.excepthook = hook
            os.chdir(here)


def _run(options: Any) -> int:
    application()
    # Compiled code stays for good, and would be taken for growth.
    warm_up()
    settings, themes = Settings(), ThemeSource("light")
    settings.values.setdefault("panels", True)
    window = build(settings, themes)
    window.resize(1280, 800)
    window.show()
    explorer = complete(window, settings, themes)
    explorer.saved = {"seed": 5, "size": list(SMALL)}
    params = methods()[options.method].params.parse(dict(each.split("=", 1) for each in options.set))
    explorer.start(FIRST, columns=[(STAYS, methods()[STAYS].params()), (options.method, params)])
    rest(explorer)
    look(explorer)
    before = weigh(explorer, "small")
    print(f"    {largest_arrays(0)[0]}", flush=True)
    column = explorer.session.state.columns[-1]
    explorer.session.select(column.id)
    explorer.session.set_column_size(column.id, (options.size, options.size))
    rest(explorer)
    weigh(explorer, f"{options.size} x {options.size}")
    look(explorer, told=True)
    most = weigh(explorer, "every tab looked")
    print(f"{'the most at any time':20} RSS {peak_bytes() / 2**20:7.1f} MB", flush=True)
    explorer.session.remove_column(column.id)
    after = weigh(explorer, "closed")
    print("    " + "\n    ".join(largest_arrays(12)), flush=True)
    window.close()
    window.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    await_threads()
    share = after / before - 1
    print(f"{100 * share:+.1f} % of {before / 2**20:.0f} MB stay of {(most - before) / 2**20:.0f} MB more")
    return 0 if share <= options.growth else 1


def rest(explorer: Explorer, least_s: float = 0.2) -> None:
    """Wait until the window has been at rest for so long."""
    end, since = time.monotonic() + LIMIT_S, time.monotonic()
    while time.monotonic() - since < least_s:
        QCoreApplication.processEvents()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        if not explorer.idle:
            since = time.monotonic()
        if since > end:
            raise TimeoutError("The window does not come to rest.")
        time.sleep(0.005)


def look(explorer: Explorer, *, told: bool = False) -> None:
    """Show every tab, and every page of the laboratory; ``told`` prints which of them take a second or more."""
    from texlab.docks.lab.dock import LabDock

    def until_rest(what: str) -> None:
        since = time.process_time()
        rest(explorer)
        took = time.process_time() - since
        if told and took >= 1:
            print(f"    {what}: {took:.1f} s, RSS {(memory_bytes() or 0) / 2**20:.0f} MB", flush=True)

    for name, host in explorer.hosts.items():
        explorer.window.raise_dock(name)
        until_rest(name)
        if isinstance(host.dock, LabDock):
            for page in (*range(host.dock.bar.count()), 0):
                host.dock.bar.setCurrentIndex(page)
                until_rest(f"{name}, {host.dock.bar.tabText(page)}")


def peak_bytes() -> int:
    """Return the largest resident size so far, where the system tells it."""
    try:
        import resource
    except ImportError:
        return 0
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most if sys.platform == "darwin" else most * 1024


def weigh(explorer: Explorer, what: str) -> int:
    """Wait until the program has given back what it does not need; print and return its resident size."""
    since = time.process_time()
    rest(explorer, REST_S)
    took = time.process_time() - since
    resident = memory_bytes() or 0
    kept = explorer.controller.shared.kept.nbytes
    print(
        f"{what:20} RSS {resident / 2**20:7.1f} MB, malloc has given out {malloc_in_use() / 2**20:7.1f}, "
        f"kept results {kept / 2**20:6.1f}, {took:.0f} s of processor time",
        flush=True,
    )
    return resident


if __name__ == "__main__":
    sys.exit(main())
