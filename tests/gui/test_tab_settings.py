"""How a tab stands: setting its controls, as lessons and layouts do, changes nothing of the session."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import pytest
from dock_scenes import column_of, frames, image_input, noise, scene_of, shown
from PySide6.QtWidgets import QAbstractButton, QComboBox, QWidget

from texlab.docks import dock_classes
from texlab.docks.explain.dock import ExplainDock
from texlab.docks.inputs.dock import InputsDock
from texlab.docks.lessons.dock import LessonsDock
from texlab.docks.solids.dock import SolidsDock
from texlab.state.intentions import LightUp, ShowMarks
from texlab.state.lesson_scene import LessonScene
from texlab.state.scene import ColumnScene, Probe, Scene
from texlab.widgets.number_box import NumberBox, WholeBox
from texlab.widgets.settling import settle_all
from texlab.widgets.slider import Slider
from texlab_core.engine.registry import find_method
from texlab_core.engine.steps import Map
from texlab_core.images.exemplar import as_exemplar
from texlab_core.lessons.shelf import bundled

if TYPE_CHECKING:
    from collections.abc import Iterator

    from PySide6.QtWidgets import QApplication

    from texlab.docks.base import Dock

SIDES = (10, 12, 16)


def plain(method: str, **more: Any) -> ColumnScene:
    return ColumnScene(1, method, method, find_method(method).params(), **more)


def with_lesson(scene: Scene) -> Scene:
    """Return a scene in which a step of a lesson is given and a pixel is kept."""
    lesson = next(each for each in bundled().values() if len(each.steps) > 2)
    return dataclasses.replace(
        scene, probe=Probe(1, 3, 4, pinned=True), lesson=LessonScene(name="a", lesson=lesson, place=1)
    )


def scenes() -> list[Scene]:
    """Return scenes in each of which the controls of other tabs have something to act on."""
    exemplar = noise(40, 48)
    # The box says 35 % of it.
    reduced = as_exemplar(image_input(noise(200, 240)), scale=0.347)
    more = {"maps": {"a": Map(noise()[:, :, 0], "count", "A"), "b": Map(noise()[:, :, 1], "count", "B")}}
    columns = (
        column_of(
            noise(), method="heeger-bergen", params=find_method("heeger-bergen").params(), frames=frames(3), **more
        ),
        plain("mixture", inputs=(("second", reduced),)),
        plain("solid", size=SIDES),
        plain("de-bonet"),
        plain("msg"),
    )
    return [with_lesson(scene_of(column, exemplar=exemplar)) for column in columns]


def others(widget: QWidget) -> Iterator[Any]:
    """Yield values that a control has not, and the one that it had."""
    if isinstance(widget, QComboBox):
        items = [widget.itemData(place) for place in range(widget.count())]
        before = widget.currentData()
        found = [each for each in items if isinstance(each, bool | int | float | str) and each != before]
        yield from found[:3]
        if found:
            yield before
    elif isinstance(widget, QAbstractButton):
        yield not widget.isChecked()
        yield not widget.isChecked()
    elif isinstance(widget, WholeBox | NumberBox | Slider):
        before = widget.value()
        yield before + (1 if before < widget.maximum() else -1)
        yield before


@pytest.mark.parametrize("kind", dock_classes(), ids=lambda kind: kind.name)
def test_a_control_that_describes_the_tab_acts_on_nothing_else(qtbot: Any, kind: type[Dock]) -> None:
    dock = kind()
    qtbot.addWidget(dock)
    told: list[Any] = []
    for scene in scenes():
        dock.show_scene(scene)
        dock.question(scene)
        dock.intention.connect(told.append)
        for widget in dock.findChildren(QWidget):
            name = widget.objectName().removeprefix(f"{dock.name}-")
            if not name or name == widget.objectName():
                continue
            if isinstance(widget, QAbstractButton) and not widget.isCheckable():
                continue
            for value in others(widget):
                dock.take_settings({name: value})
                settle_all(dock)
                acts = [each for each in told if not isinstance(each, LightUp | ShowMarks)]
                assert acts == [], f"{dock.name}-{name} set to {value!r}"
        dock.intention.disconnect()


def test_how_a_tab_stands_says_nothing_of_the_session(qtbot: Any) -> None:
    for kind, its in (
        (InputsDock, {"scale"}),
        (ExplainDock, {"column", "row"}),
        (SolidsDock, {"width", "height", "depth"}),
        (LessonsDock, {"jump"}),
    ):
        dock: Any = kind()
        qtbot.addWidget(dock)
        for scene in scenes():
            dock.show_scene(scene)
            dock.question(scene)
            assert not its & dock.settings().keys()
            assert all(isinstance(dock.findChild(QWidget, f"{dock.name}-{name}"), QWidget) for name in its)


def test_the_scale_that_a_box_shows_is_no_new_one(qtbot: Any) -> None:
    dock = InputsDock()
    qtbot.addWidget(dock)
    reduced = as_exemplar(image_input(noise(200, 240)), scale=0.347)
    scene = scene_of(plain("mixture", inputs=(("second", reduced),)), exemplar=noise())
    dock.show_scene(scene)
    assert dock.scale.value() == 35
    told: list[Any] = []
    dock.intention.connect(told.append)
    dock.scale.setValue(60)
    dock.scale.setValue(35)
    settle_all(dock)
    assert told == []
    dock.scale.setValue(60)
    settle_all(dock)
    assert len(told) == 1


def test_the_list_of_lessons_follows_the_size_of_the_text(qtbot: Any, qapp: QApplication) -> None:
    dock = shown(qtbot, LessonsDock(), 1600, 400)
    scene = Scene()
    dock.present(dock.question(scene).compute(lambda: False))
    item = dock.list.topLevelItem(0).child(0)
    before, width = item.sizeHint(0), dock.list.minimumWidth()
    font = dock.list.font()
    font.setPointSizeF(2 * font.pointSizeF())
    dock.list.setFont(font)
    after = item.sizeHint(0)
    assert after.width() > 1.5 * before.width()
    assert after.height() > 1.5 * before.height()
    assert dock.list.minimumWidth() > width
