"""Scenes made by hand, for tests that drive one dock alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from mouse import on_screen
from PySide6.QtCore import QPoint, Qt

from texlab.state.scene import ColumnScene, Frame, Scene
from texlab.style.pictures import to_picture
from texlab.style.theme import LIGHT
from texlab_core.engine.inputs import ImageInput, hash_arrays
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.result import Result

if TYPE_CHECKING:
    from texlab.docks.base import Dock
    from texlab.widgets.image_pane import ImagePane


@dataclass(frozen=True, kw_only=True)
class PyramidParams(Params):
    scales: Annotated[int, Knob(help="Scales.", low=1, high=8)] = 3
    orientations: Annotated[int, Knob(help="Orientations.", low=1, high=18)] = 4


def image_input(pixels: Any, name: str = "test") -> ImageInput:
    pixels = np.ascontiguousarray(pixels, np.float32)
    return ImageInput(pixels, name, hash_arrays({"pixels": pixels}))


def noise(height: int = 48, width: int = 64, channels: int = 3, seed: int = 1) -> Any:
    return np.random.default_rng(seed).random((height, width, channels), np.float32)


def result_of(image: Any, **more: Any) -> Result:
    job: Any = None
    return Result(image=image, job=job, model=None, elapsed_s=0.1, versions={}, **more)


def column_of(image: Any = None, *, column_id: int = 1, title: str = "Stub", **more: Any) -> ColumnScene:
    """Return a finished column when ``image`` is given, else one that has nothing yet."""
    fields: dict[str, Any] = {"method": "stub", "params": PyramidParams(), "id": column_id, "title": title}
    if image is not None:
        outputs = {name: more.pop(name) for name in ("maps", "curves", "measures", "details") if name in more}
        fields |= {"picture": to_picture(image), "image": image, "result": result_of(image, **outputs)}
        fields["status"] = "finished"
    return ColumnScene(**(fields | more))


def scene_of(*columns: ColumnScene, exemplar: Any = None, selected: int = 1) -> Scene:
    given = None if exemplar is None else image_input(exemplar)
    return Scene(given, columns, selected)


def frames(count: int, height: int = 20, width: int = 30) -> tuple[Frame, ...]:
    return tuple(Frame(f"iteration {k}", np.full((height, width, 3), 10 * k + 5, np.uint8)) for k in range(count))


def feed(dock: Dock, scene: Scene) -> Any:
    """Ask the dock's question, compute, present; returns the answer, None when there was no question."""
    dock.show_scene(scene)
    question = dock.question(scene)
    if question is None:
        dock.present_nothing("There is nothing to show yet.")
        return None
    hash(question.key)
    again = dock.question(scene)
    assert again is not None
    assert again.key == question.key
    answer = question.compute(lambda: False)
    dock.present(answer)
    return answer


def place(pane: ImagePane, row: float, column: float) -> QPoint:
    """Return where the middle of an image pixel is painted, in the viewport."""
    return pane.to_widget(row + 0.5, column + 0.5).toPoint()


def hover(qtbot: Any, pane: ImagePane, row: float, column: float) -> None:
    viewport = pane.viewport()
    # pyqtgraph drops moves that come within 10 ms.
    qtbot.wait(15)
    qtbot.mouseMove(viewport, place(pane, row, column))


def click(qtbot: Any, pane: ImagePane, row: float, column: float) -> None:
    qtbot.mouseClick(pane.viewport(), Qt.MouseButton.LeftButton, pos=place(pane, row, column))


def shown(qtbot: Any, dock: Dock, width: int = 900, height: int = 260) -> Any:
    qtbot.addWidget(dock)
    dock.set_theme(LIGHT)
    dock.resize(width, height)
    dock.show()
    on_screen(qtbot, dock)
    return dock


def check_controls(dock: Dock) -> None:
    """Assert what holds for every control: a name, a tooltip, an accessible name, the keyboard reaches it."""
    from PySide6.QtWidgets import QAbstractButton, QAbstractSpinBox, QComboBox, QListWidget, QSlider, QTableWidget

    kinds = (QAbstractButton, QAbstractSpinBox, QComboBox, QSlider, QListWidget, QTableWidget)
    found = [widget for kind in kinds for widget in dock.findChildren(kind)]
    names = [widget.objectName() for widget in found if not widget.objectName().startswith("qt_")]
    assert names
    assert len(set(names)) == len(names)
    for widget in found:
        if widget.objectName().startswith("qt_") or isinstance(widget.parent(), QTableWidget):
            continue
        assert widget.objectName().startswith(dock.name), widget
        assert widget.toolTip(), widget.objectName()
        assert widget.accessibleName(), widget.objectName()
        assert widget.focusPolicy() & Qt.FocusPolicy.TabFocus, widget.objectName()
