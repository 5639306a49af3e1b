"""The tool bar: icons in both themes at any scale, names for everyone, room at 1024 pixels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
import pytest
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QIcon, QImage
from PySide6.QtWidgets import QToolButton

from texlab.style.icons import PALE, RATIOS, tool_icon
from texlab.style.theme import DARK, LIGHT
from texlab.window.toolbar import ICON_SIDE, SHORT, ToolBar
from texlab_core.files.resources import resource

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer
    from texlab.style.theme import Theme

NAMES = (*SHORT, "layout")


def pixels(icon: QIcon, ratio: int, mode: QIcon.Mode = QIcon.Mode.Normal) -> Any:
    side = ICON_SIDE
    image = (
        icon.pixmap(QSize(side, side), float(ratio), mode).toImage().convertToFormat(QImage.Format.Format_RGBA8888)
    )
    assert (image.width(), image.height()) == (side * ratio, side * ratio)
    return np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine() // 4, 4).copy()


def luminance(colour: Any) -> float:
    linear = (np.asarray(colour[:3], float) / 255) ** 2.2
    return float(linear @ (0.2126, 0.7152, 0.0722))


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda theme: theme.name)
def test_icons_are_drawn_in_the_theme_at_every_scale(qapp: Any, theme: Theme) -> None:
    seen = {}
    for name in NAMES:
        icon = tool_icon(name, theme, ICON_SIDE)
        for ratio in RATIOS:
            drawn = pixels(icon, ratio)
            alpha = drawn[..., 3]
            assert 0.03 < (alpha > 128).mean() < 0.7, name
            # Lines are drawn, not enlarged: at twice the scale most pixels are all or nothing.
            if ratio == 3:
                assert ((alpha < 64) | (alpha > 192)).mean() > 0.9, name
            strong = drawn[alpha > 250]
            ground = np.array([int(theme.window[k : k + 2], 16) for k in (1, 3, 5)])
            light, dark = sorted((luminance(strong[0]), luminance(ground)), reverse=True)
            assert (light + 0.05) / (dark + 0.05) > 3, name
        pale = pixels(icon, 1, QIcon.Mode.Disabled)[..., 3]
        assert pale.max() == pytest.approx(255 * PALE, abs=2)
        seen[name] = pixels(icon, 2)[..., 3].tobytes()
    assert len(set(seen.values())) == len(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_drawings_are_plain_shapes_in_one_colour(name: str) -> None:
    text = resource(f"icons/tools/{name}.svg").read_text(encoding="utf-8")
    root = ElementTree.fromstring(text)
    assert root.attrib["viewBox"] == "0 0 24 24"
    kinds = {each.tag.rpartition("}")[2] for each in root.iter()}
    assert kinds <= {"svg", "title", "g", "path", "circle", "rect"}
    assert "#" not in text
    assert "currentColor" in text


def test_the_bar_has_groups_names_and_room(qtbot: Any, explorer: Explorer) -> None:
    window, bar = explorer.window, explorer.window.toolbar
    window.resize(1024, 700)
    qtbot.waitUntil(lambda: window.width() == 1024)
    bar.layout().activate()
    buttons = {name: bar.widgetForAction(window.actions_by_name[name]) for name in SHORT}
    for name, button in (*buttons.items(), ("layout", bar.layout_button)):
        assert isinstance(button, QToolButton)
        assert button.isVisible(), name
        assert button.accessibleName(), name
        assert button.toolTip(), name
        assert not button.icon().isNull(), name
        assert button.focusPolicy() & Qt.FocusPolicy.TabFocus, name
        assert button.geometry().right() < 1024, name
        assert button.width() >= button.sizeHint().width(), name
    # What runs and stops stands apart from what is before and after.
    run, stop = buttons["run-all"].geometry(), buttons["stop-all"].geometry()
    gap = stop.left() - run.right()
    assert run.left() - buttons["add"].geometry().right() > gap
    assert bar.layout_button.geometry().left() - stop.right() > gap
    # The menus are lists of words.
    assert not any(window.actions_by_name[name].isIconVisibleInMenu() for name in SHORT)
    before = buttons["open"].icon().cacheKey()
    explorer.themes.choose("dark")
    assert buttons["open"].icon().cacheKey() != before
    strong = pixels(buttons["open"].icon(), 2)
    assert luminance(strong[strong[..., 3] > 250][0]) > 0.5
    explorer.themes.choose("light")
    # Icons grow with the text.
    font = bar.font()
    font.setPointSizeF(2 * font.pointSizeF())
    bar.setFont(font)
    assert bar.iconSize().width() > 1.5 * ICON_SIDE


@pytest.mark.parametrize("size", [(8192, 4), (256, 10_000)])
def test_sizes_that_a_file_asks_for_are_shown_as_they_are(qtbot: Any, size: tuple[int, int]) -> None:
    names = (*SHORT, "layout-explore", "layout-teach", "layout-tune", "own-layouts")
    bar = ToolBar({name: QAction(name) for name in names})
    qtbot.addWidget(bar)
    told: list[object] = []
    for signal in (bar.size_turned, bar.seed_turned):
        signal.connect(told.append)
    bar.show_values(7, size)
    assert not told
    assert bar.size_shown == size
    assert bar.height_box.text() == str(size[0])
