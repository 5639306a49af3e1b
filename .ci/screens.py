"""Pictures of every layout of the window in both themes, at the sizes of usual screens, to be looked at.

``python .ci/screens.py [FOLDER]`` writes ``LAYOUT-THEME-WxH.png`` into build/screens.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("QT_LOGGING_RULES", "default.warning=false")
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from PySide6.QtWidgets import QApplication

from texlab.app.screenshot import wait_until_idle
from texlab.app.start import application, build, complete
from texlab.storage.settings import Settings
from texlab.style.theme import ThemeSource

SIZES = ((1280, 800), (1366, 768), (1920, 1080), (3840, 2160))
LAYOUTS = ("explore", "explore-panels", "tune", "teach", "stage", "fill")
THEMES = ("light", "dark")


def arrange(explorer, layout: str) -> None:
    """Bring the window into a layout; ``stage`` and ``fill`` are panels over the pictures."""
    window, actions = explorer.window, explorer.window.actions_by_name
    window.big_panel.give_back()
    actions[f"layout-{layout if layout in ('tune', 'teach') else 'explore'}"].trigger()
    window.strip.set_open(layout != "explore")
    if layout in ("stage", "fill"):
        window.take_stage("sweeps" if layout == "stage" else "fill")


def main(folder: Path) -> int:
    """Draw them all; a window is opened once for each theme."""
    folder.mkdir(parents=True, exist_ok=True)
    application()
    for theme in THEMES:
        settings, themes = Settings(kept=False), ThemeSource(theme)
        window = build(settings, themes)
        window.show()
        explorer = complete(window, settings, themes)
        explorer.start("gallery:structured-pebbles")
        wait_until_idle(explorer)
        explorer.handlers.select(explorer.session.state.columns[1].id)
        for layout in LAYOUTS:
            for size in SIZES:
                # Text of Teach at another size would hold the window open.
                arrange(explorer, "explore")
                window.resize(*size)
                QApplication.processEvents()
                arrange(explorer, layout)
                wait_until_idle(explorer)
                QApplication.processEvents()
                path = folder / f"{layout}-{theme}-{size[0]}x{size[1]}.png"
                window.grab().save(str(path))
                print(path, flush=True)
        window.close()
        window.deleteLater()
        QApplication.processEvents()
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "build/screens")))
