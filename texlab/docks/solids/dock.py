"""Solids: three slices linked by cross-hairs, the exemplar, the shaded object, and one wrapped in the image."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QFileDialog, QGridLayout, QMenu, QPushButton

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.docks.solids.panes import ObjectPane, SlicePane
from texlab.state.intentions import AskOnce, EditSize, Tell
from texlab.widgets.picture_area import PictureArea
from texlab.widgets.plain import Label
from texlab_core.engine.estimate import check_memory, estimate_of, in_words
from texlab_core.engine.registry import find_method
from texlab_core.errors import Cancelled, InputError
from texlab_core.solids.pictures import CUTS, Cut, Place, Turn, Walk, cross_of, middle, picture_of, slice_at
from texlab_core.solids.rendering import SHAPES, View, render, render_wrapped
from texlab_core.solids.shots import Shot, save_shot

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtCore import QObject

    from texlab.state.scene import ColumnScene, Scene
    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatVolume

# While it is turned the object is drawn at most this large, and without smooth outlines.
LIVE_SIDE, STILL_SIDE = 400, 800
LARGEST_SIDE = 256
NAMES = {"xy": "Slice xy", "xz": "Slice xz", "yz": "Slice yz"}
# Normal to the slices of a cut: its place in (depth, row, column).
NORMAL = {"xy": 0, "xz": 1, "yz": 2}
SAVED = {
    "picture": ("Picture of the object ...", "PNG (*.png)", ".png"),
    "slices": ("Picture of slices and object ...", "PNG (*.png)", ".png"),
    "turn": ("Animation of a turn ...", "WebP (*.webp);;GIF (*.gif);;APNG (*.apng)", ".webp"),
    "walk": ("Walk through the xy slices ...", "WebP (*.webp);;GIF (*.gif);;APNG (*.apng)", ".webp"),
}


@dataclass(frozen=True, eq=False)
class SolidAnswer:
    """What is shown: pictures of the slices by their cuts, of the exemplar, of the object and the wrapped one."""

    result: Result
    volume: FloatVolume
    place: Place
    slices: dict[Cut, Picture]
    drawn: Picture
    wrapped: Picture | None
    exemplar: Picture | None


class SolidsDock(FramedDock):
    """Shows the chosen column's solid."""

    name = "solids"
    title = "Solid"
    help = "A solid texture, cut along three axes and carved into objects; beside it the exemplar wrapped around."
    order = 45
    rest_ms = 0
    empty = "Slices and objects appear when a column makes a solid: add the method Solid texture."
    # The size is the column's.
    no_settings = frozenset({"width", "height", "depth"})

    heavy = True

    def build(self) -> None:
        """Make the controls and the panes."""
        shapes = [(shape.capitalize(), shape) for shape in SHAPES]
        self.shape_box = self.add_choice("shape", "Object", "What is carved from the solid", shapes, self._changed)
        tip = "Show the same object with the exemplar wrapped around it: stretched, squeezed, with a seam"
        self.beside = self.add_switch("beside", "Wrapped image beside", tip, lambda _: self._changed())
        self.sides = {
            axis: self.add_number(
                axis, label, f"{label} of the solid in voxels", (1, LARGEST_SIDE), partial(self._resize, axis)
            )
            for axis, label in (("width", "Width"), ("height", "Height"), ("depth", "Depth"))
        }
        for box in self.sides.values():
            box.setKeyboardTracking(False)
            # What is typed is foretold before it is taken.
            box.lineEdit().textEdited.connect(lambda _: self._foretell())
        self.needs = Label()
        tip = "What a solid of these sides takes on one core: known before it is made"
        self.add_control(self.needs, "needs", "Expected memory and time", tip)
        self.save_button = QPushButton("Save view ...")
        menu = QMenu(self.save_button)
        for what, (text, _, _) in SAVED.items():
            menu.addAction(text).triggered.connect(partial(self._save, what))
        self.save_button.setMenu(menu)
        self.add_control(self.save_button, "save", "Save view", "Save a picture or an animation with its recipe")
        self.values = Label()
        self.add_control(
            self.values, "values", "Place and colour", "Where the cross-hairs meet, and the values there"
        )
        self.panes: dict[Cut, SlicePane] = {}
        for cut in CUTS:
            pane = SlicePane(f"solids-{cut}", NAMES[cut], self.body)
            pane.moved.connect(partial(self._move, cut))
            pane.stepped.connect(partial(self._step, cut))
            pane.released.connect(self.ask)
            self.panes[cut] = pane
        self.exemplar = PictureArea("solids-exemplar", "Exemplar", "What the solid was made from", self.body)
        self.object = ObjectPane("solids-object", "Carved", self.body)
        self.wrapped = ObjectPane("solids-wrapped", "Wrapped image", self.body)
        for turning in (self.object, self.wrapped):
            turning.turned.connect(self._turn)
            turning.zoomed.connect(self._zoom)
            turning.homed.connect(self._home)
            turning.released.connect(self.ask)
        self.areas: list[PictureArea] = [*self.panes.values(), self.exemplar, self.object, self.wrapped]
        self.grid = QGridLayout(self.body)
        self.grid.setContentsMargins(6, 0, 6, 6)
        self.grid.setSpacing(4)
        self._columns = (0, 0)
        self._arrange()
        self.view = View()
        self.place: Place | None = None
        self._column_id = 0
        self._result: Result | None = None
        self._filling = False
        self.beside.setChecked(True)
        self.body.installEventFilter(self)

    # Where things are.

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Put the panes into one row or two, whichever makes them larger."""
        if watched is self.body and event.type() == QEvent.Type.Resize:
            self._arrange()
            self.ask()
        return super().eventFilter(watched, event)

    def _arrange(self) -> None:
        shown = [area for area in self.areas if area is not self.wrapped or self.beside.isChecked()]
        width, height = max(self.body.width(), 1), max(self.body.height(), 1)
        caption = shown[0].caption_height

        def side(columns: int) -> float:
            rows = -(-len(shown) // columns)
            return min(width / columns, height / rows - caption)

        columns = max((len(shown), -(-len(shown) // 2)), key=side)
        self.wrapped.setVisible(self.beside.isChecked())
        if (columns, len(shown)) == self._columns:
            return
        self._columns = (columns, len(shown))
        for area in self.areas:
            self.grid.removeWidget(area)
        for index, area in enumerate(shown):
            self.grid.addWidget(area, index // columns, index % columns)

    def paint_theme(self, theme: Theme) -> None:
        """Give the panes their colours; objects are drawn on the canvas."""
        super().paint_theme(theme)
        self.ask()

    # What is asked.

    def show_scene(self, scene: Scene) -> None:
        """Show the size of the chosen column."""
        super().show_scene(scene)
        column = scene.selected
        solid = column is not None and find_method(column.method).dimensions == 3
        self.controls.setVisible(solid)
        if column is None or not solid:
            self._result = None
            return
        if column.id != self._column_id:
            self._column_id, self._result, self.place = column.id, None, None
        if len(column.size) == 3:
            self._filling = True
            for axis, side in zip(("depth", "height", "width"), column.size, strict=True):
                if not self.sides[axis].hasFocus():
                    self.sides[axis].setValue(side)
            self._filling = False
        self._foretell()

    def _foretell(self) -> None:
        """Say what a solid of the sides in the boxes, as they are typed, will take."""
        scene, column = self.scene, self.scene.selected
        if scene.exemplar is None or column is None:
            self.needs.setText("")
            return
        method = find_method(column.method)
        depth, height, width = (self.sides[each].typed for each in ("depth", "height", "width"))
        if method.dimensions != 3 or depth is None or height is None or width is None:
            self.needs.setText("")
            return
        inputs = {**dict(column.inputs), "exemplar": scene.exemplar}
        expected = estimate_of(method, inputs, column.params, (depth, height, width))
        try:
            check_memory(method, expected, (depth, height, width))
        except InputError as error:
            self.needs.setText(str(error))
            return
        self.needs.setText(f"needs {in_words(expected)}")

    def question(self, scene: Scene) -> Question | None:
        """Ask for the pictures of the chosen column's solid; while a new one is made the last one stays."""
        column = scene.selected
        self.why = self.empty
        if column is None or find_method(column.method).dimensions != 3:
            return None
        result = self._solid_of(column)
        if result is None or result.volume is None:
            waits = column.status in ("failed", "idle") and column.message
            self.why = waits or "The solid appears when it has been made."
            return None
        self._result = result
        volume = result.volume
        place = self._fitting(volume)
        live = self.object.dragging or self.wrapped.dragging
        view = replace(self.view, shape=self.shape_box.currentData())
        side = self.object.side(LIVE_SIDE if live else STILL_SIDE)
        colour = QColor(self.theme.canvas)
        background = (colour.red(), colour.green(), colour.blue())
        exemplar = result.job.inputs.get("exemplar")
        beside = self.beside.isChecked()

        def compute(should_stop: Callable[[], bool]) -> SolidAnswer:
            def look() -> None:
                if should_stop():
                    raise Cancelled

            size = (side, side)
            drawn = render(volume, view, size, background=background, smooth=not live, look=look)
            pixels = getattr(exemplar, "pixels", None)
            wrapped = None
            if beside and pixels is not None:
                wrapped = render_wrapped(
                    pixels, volume.shape, view, size, background=background, smooth=not live, look=look
                )
            slices = {cut: picture_of(slice_at(volume, cut, place)) for cut in CUTS}
            own = None if pixels is None else picture_of(pixels)
            return SolidAnswer(result, volume, place, slices, drawn, wrapped, own)

        key = (self.name, Same(volume), place, view, side, live, background, beside, Same(exemplar))
        return Question(key, compute)

    def forget(self) -> None:
        """Let go of the last solid."""
        super().forget()
        self._result = None

    def clear_shown(self) -> None:
        """Empty the panes of slices and objects, too."""
        super().clear_shown()
        for area in self.areas:
            area.set_picture(None)

    def _solid_of(self, column: ColumnScene) -> Result | None:
        """Return the newest solid of this column."""
        if column.result is not None and column.result.volume is not None:
            return column.result
        return self._result if column.status in ("waiting", "running", "cancelled") else None

    def _fitting(self, volume: FloatVolume) -> Place:
        """Return the place of the cross-hairs, inside of this volume."""
        if self.place is None:
            self.place = middle(volume.shape)
        depth, row, column = (
            min(index, side - 1) for index, side in zip(self.place, volume.shape[:3], strict=True)
        )
        return depth, row, column

    def show_answer(self, answer: SolidAnswer) -> None:
        """Show all pictures."""
        for cut, pane in self.panes.items():
            pane.show_slice(answer.slices[cut], cross_of(cut, answer.place), self._caption(cut, answer.place))
        self.exemplar.set_picture(answer.exemplar)
        self.object.set_picture(answer.drawn)
        self.wrapped.set_picture(answer.wrapped)
        depth, row, column = answer.place
        values = " ".join(f"{value:.3f}" for value in answer.volume[answer.place])
        self.values.setText(f"x {column}, y {row}, z {depth}: {values}")

    def _caption(self, cut: Cut, place: Place) -> str:
        axis = {"xy": "z", "xz": "y", "yz": "x"}[cut]
        return f"{NAMES[cut]}, {axis} {place[NORMAL[cut]]}"

    # What the hand does.

    def _changed(self) -> None:
        self._arrange()
        self.ask()

    def _move(self, cut: Cut, row: int, column: int) -> None:
        if self.answer is None:
            return
        depth, y, x = self._fitting(self.answer.volume)
        self.place = {"xy": (depth, row, column), "xz": (row, y, column), "yz": (column, row, x)}[cut]
        self._show_crosses()

    def _step(self, cut: Cut, by: int) -> None:
        if self.answer is None:
            return
        place = list(self._fitting(self.answer.volume))
        axis = NORMAL[cut]
        place[axis] = min(max(place[axis] + by, 0), self.answer.volume.shape[axis] - 1)
        self.place = (place[0], place[1], place[2])
        self._show_crosses()

    def _show_crosses(self) -> None:
        """Move the cross-hairs at once; the slices follow."""
        assert self.place is not None
        for cut, pane in self.panes.items():
            pane.cross = cross_of(cut, self.place)
            pane.update()
        self.ask()

    def _turn(self, yaw: float, pitch: float) -> None:
        self.view = self.view.turned(yaw, pitch)
        self.ask()

    def _zoom(self, factor: float) -> None:
        self.view = replace(self.view, zoom=min(max(self.view.zoom * factor, 0.3), 8.0))
        self.ask()

    def _home(self) -> None:
        self.view = View()
        self.ask()

    def _resize(self, axis: str) -> None:
        if not self._filling and self._column_id:
            depth, height, width = (self.sides[each].value() for each in ("depth", "height", "width"))
            self.intention.emit(EditSize(self._column_id, (depth, height, width)))

    # Files.

    def _save(self, what: str, _: bool = False) -> None:
        if self.answer is None:
            self.intention.emit(Tell("There is no solid to save a picture of yet.", problem=True))
            return
        title, kinds, suffix = SAVED[what]
        path = QFileDialog.getSaveFileName(self, title.rstrip(" ."), f"solid-{what}{suffix}", kinds)[0]
        if path:
            self.save_to(path if Path(path).suffix else path + suffix, what)

    def save_to(self, path: str, what: str) -> None:
        """Save a picture or an animation of what is shown, in the background."""
        answer: SolidAnswer = self.answer
        view = replace(self.view, shape=self.shape_box.currentData())
        motion = {"turn": Turn(), "walk": Walk()}.get(what)
        shown = (
            "slices" if what == "slices" else "both" if self.beside.isChecked() and what != "walk" else "object"
        )
        shot = Shot(shown, view, motion, answer.place)  # type: ignore[arg-type]

        def save(should_stop: Callable[[], bool]) -> str:
            from texlab_core.documents.recipe import written_recipe

            def look() -> None:
                if should_stop():
                    raise Cancelled

            recipe = written_recipe(answer.result)
            exemplar: ImageInput | Any = answer.result.job.inputs.get("exemplar")
            pixels = getattr(exemplar, "pixels", None)
            save_shot(path, answer.volume, shot, recipe=recipe, exemplar=pixels, look=look)
            return path

        def done(saved: str) -> None:
            self.intention.emit(Tell(f"Saved {saved}."))

        self.intention.emit(AskOnce("save view", save, done))
