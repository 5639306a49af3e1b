"""Inputs: the further images of the chosen column's method, each with its own source, part and scale."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QMenu, QPushButton

from texlab.columns.titles import titles
from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, replace_items
from texlab.docks.inputs.crop_pane import CropPane
from texlab.docks.recent import Same
from texlab.state.changes import COMFORTABLE_SIDE
from texlab.state.intentions import AskOnce, EditInputs, Tell
from texlab.style.pictures import to_picture
from texlab.widgets.mime import brought_by, take_copy
from texlab.widgets.pasted import Pasted, pixels_of
from texlab.widgets.picture_area import PictureArea
from texlab.widgets.settling import Settling
from texlab_core.engine.inputs import ImageInput
from texlab_core.engine.registry import EXEMPLAR, InputSpec, find_method
from texlab_core.images.formats.kinds import READABLE_SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QDragEnterEvent, QDragMoveEvent, QDropEvent

    from texlab.state.scene import ColumnScene, Scene
    from texlab.style.pictures import Picture
    from texlab.widgets.mime import Brought
    from texlab_core.engine.inputs import Crop, Input

SETTLE_MS = 300


@dataclass(frozen=True, eq=False)
class InputAnswer:
    """What is shown of an input: its scaled source with the part that is used, and that part."""

    given: ImageInput
    source: Picture
    used: Picture


def image_specs(method: str) -> tuple[InputSpec, ...]:
    """Return the images that a method takes besides the exemplar."""
    return tuple(
        spec for spec in find_method(method).inputs if spec.kind == "image" and spec.name != EXEMPLAR.name
    )


class InputsDock(FramedDock):
    """Chooses the further images of the chosen column."""

    name = "inputs"
    title = "Inputs"
    help = "What a method works on besides the exemplar: the other textures of a mixture, a start image, a mask."
    order = 72
    empty = "The method of the chosen column takes no further images; a mixture does."
    # How much an image is reduced is the column's.
    no_settings = frozenset({"scale"})

    def build(self) -> None:
        """Make the controls and the pictures."""
        self._filling = True
        self.which = self.add_choice("which", "Input", "Which of the method's images is chosen here", [], self.ask)
        self.gallery = self.add_button("gallery", "Gallery", "Choose a texture of the gallery", lambda: None)
        self.results = self.add_button("results", "Result of", "Take the result of another column", lambda: None)
        for button, fill in ((self.gallery, self._fill_gallery), (self.results, self._fill_results)):
            self._give_menu(button, fill)
        self.add_button("file", "File ...", "Open an image file; one can be dropped here, too", self._open)
        self.add_button("paste", "Paste", "Take the image on the clipboard", self._paste)
        self.scale = self.add_number(
            "scale", "Scale", "Reduce the picture first, in percent", (1, 100), self._rescale
        )
        self.scale.setSuffix(" %")
        self.scale.setValue(100)
        self.scale.setKeyboardTracking(False)
        self.whole = self.add_button("whole", "Whole picture", "Use all of it", lambda: self._crop(None))
        self.remove = self.add_button("remove", "Remove", "Work without this image", self._remove)
        self.source = CropPane("inputs-source", "Source")
        self.used = PictureArea("inputs-used", "As it is used", "The part that the method gets")
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.source, 1)
        layout.addWidget(self.used, 1)
        self.source.cropped.connect(self._crop)
        self.setAcceptDrops(True)
        self._settled = Settling(self, SETTLE_MS, self._take_scale)
        self._filling = False
        self._show_controls(None)

    def _give_menu(self, button: QPushButton, fill: Callable[[QMenu], None]) -> None:
        menu = QMenu(button)
        menu.aboutToShow.connect(partial(fill, menu))
        button.setMenu(menu)

    @property
    def spec(self) -> InputSpec | None:
        """The input that is chosen."""
        if self.scene.selected is None:
            return None
        return next(
            (each for each in image_specs(self.scene.selected.method) if each.name == self.which.currentData()),
            None,
        )

    @property
    def given(self) -> ImageInput | None:
        """The image that stands there now."""
        spec = self.spec
        found = (
            dict(self.scene.selected.inputs).get(spec.name)
            if self.scene.selected is not None and spec is not None
            else None
        )
        return found if isinstance(found, ImageInput) else None

    def show_scene(self, scene: Scene) -> None:
        """Show what the chosen column's method takes, and what it has."""
        super().show_scene(scene)
        specs = image_specs(scene.selected.method) if scene.selected is not None else ()
        replace_items(self.which, [(_text(spec), spec.name) for spec in specs])
        self._show_controls(self.given)

    def _show_controls(self, given: ImageInput | None) -> None:
        self.controls.setVisible(self.spec is not None)
        for control in (self.scale, self.whole, self.remove):
            control.setEnabled(given is not None)
        if given is not None and not self.scale.hasFocus() and not self._settled.isActive():
            self._filling = True
            self.scale.setValue(round(100 * (given.origin.scale if given.origin is not None else 1.0)))
            self._filling = False

    def question(self, scene: Scene) -> Question | None:
        """Ask for the pictures of the chosen input."""
        given, spec = self.given, self.spec
        self.why = self.empty
        if given is None:
            if spec is not None:
                self.why = (
                    f"{spec.help} Choose it in the gallery, open, drop or paste it, or take a column's result."
                )
            return None

        def compute(should_stop: Callable[[], bool]) -> InputAnswer:
            from texlab_core.images.exemplar import as_exemplar

            scaled = given
            if given.origin is not None and given.origin.crop is not None:
                whole = as_exemplar(given.origin.pixels, name=given.name)
                scaled = as_exemplar(whole, scale=given.origin.scale)
            return InputAnswer(given, to_picture(scaled.pixels), to_picture(given.pixels))

        return Question((self.name, self.which.currentData(), Same(given)), compute)

    def show_answer(self, answer: InputAnswer) -> None:
        """Show source and part."""
        origin = answer.given.origin
        self.source.show_source(answer.source, None if origin is None else origin.crop, answer.given.name)
        height, width = answer.given.size
        self.used.caption = f"As it is used, {width} x {height}"
        self.used.set_picture(answer.used)

    # What is chosen.

    def take(self, source: Any, *, name: str | None = None) -> None:
        """Read an image in the background and give it to the column."""
        column, spec = self.scene.selected, self.spec
        if column is None or spec is None:
            return

        def read(should_stop: Callable[[], bool]) -> ImageInput:
            from texlab_core.images.exemplar import as_exemplar

            given, called = source, name
            if isinstance(source, Pasted):
                given, called = pixels_of(source.image), source.name
            image = as_exemplar(given, name=called, background=spec.background, should_stop=should_stop)
            side = max(image.size)
            if spec.texture and side > COMFORTABLE_SIDE:
                # As a photograph that is opened as the exemplar.
                image = as_exemplar(image, scale=round(COMFORTABLE_SIDE / side, 3))
            return image

        self._give(read, column.id, spec.name, f"{spec.name} chosen")

    def _change(self, scale: float, crop: Crop | None, text: str) -> None:
        column, spec, given = self.scene.selected, self.spec, self.given
        if column is None or spec is None or given is None:
            return

        def read(should_stop: Callable[[], bool]) -> ImageInput:
            from texlab_core.images.exemplar import as_exemplar, take

            if scale == 1.0 and crop is None and given.origin is not None:
                return take(given.origin.pixels, given.name, notes=given.notes)
            return as_exemplar(given, scale=scale, crop=crop)

        self._give(read, column.id, spec.name, text)

    def _give(
        self, read: Callable[[Callable[[], bool]], ImageInput], column_id: int, name: str, text: str
    ) -> None:
        def done(image: ImageInput) -> None:
            column = self._scene_column(column_id)
            if column is not None and any(spec.name == name for spec in image_specs(column.method)):
                others: dict[str, Input] = {**dict(column.inputs), name: image}
                self.intention.emit(EditInputs(column_id, tuple(others.items()), text))

        self.intention.emit(AskOnce(f"input {name}", read, done))

    def _scene_column(self, column_id: int) -> ColumnScene | None:
        columns = self.scene.columns
        return next((column for column in columns if column.id == column_id), None)

    def _rescale(self) -> None:
        if not self._filling:
            self._settled.start()

    def _take_scale(self) -> None:
        given = self.given
        if given is None:
            return
        before = given.origin.scale if given.origin is not None else 1.0
        if self.scale.value() == round(100 * before):
            # The box shows whole percents; the scale itself may lie between them.
            return
        crop = given.origin.crop if given.origin is not None else None
        scale = self.scale.value() / 100
        if crop is not None:
            from texlab.state.changes import rescaled
            from texlab.state.chosen import Sample

            crop = rescaled(Sample(ImageInput(given.origin.pixels, given.name, ""), before, crop), scale).crop  # type: ignore[union-attr]
        self._change(scale, crop, "scale of an input")

    def _crop(self, crop: Crop | None) -> None:
        given = self.given
        if given is not None:
            self._change(given.origin.scale if given.origin is not None else 1.0, crop, "part of an input")

    def _remove(self) -> None:
        column, spec = self.scene.selected, self.spec
        if column is not None and spec is not None:
            rest = tuple(each for each in column.inputs if each[0] != spec.name)
            self.intention.emit(EditInputs(column.id, rest, f"{spec.name} removed"))

    def _open(self) -> None:
        pattern = " ".join(f"*{suffix}" for suffix in READABLE_SUFFIXES)
        path, _ = QFileDialog.getOpenFileName(self, "Open image", "", f"Images ({pattern})")
        if path:
            self.take(path)

    def _paste(self) -> None:
        self._take_brought(brought_by(QGuiApplication.clipboard().mimeData()))

    def _take_brought(self, brought: Brought) -> None:
        if brought.sources:
            self.take(brought.sources[0])
        else:
            sentence = brought.refusal or "There is no image on the clipboard."
            self.intention.emit(Tell(sentence, problem=True))

    def _fill_gallery(self, menu: QMenu) -> None:
        from texlab_core.images.gallery import gallery

        menu.clear()
        groups: dict[str, QMenu] = {}
        for entry in gallery():
            kind, _, rest = entry.name.partition("-")
            group = groups.get(kind) or groups.setdefault(kind, menu.addMenu(kind.capitalize()))
            group.addAction(rest).triggered.connect(partial(self._take_entry, entry.uri))

    def _take_entry(self, uri: str, _: bool = False) -> None:
        self.take(uri)

    def _fill_results(self, menu: QMenu) -> None:
        menu.clear()
        columns = self.scene.columns
        for place, (column, title) in enumerate(zip(columns, titles(columns), strict=True), 1):
            if column.result is not None and (self.scene.selected is None or column.id != self.scene.selected.id):
                text = f"{place}. {title}"
                menu.addAction(text).triggered.connect(partial(self._take_result, column.id))
        if menu.isEmpty():
            menu.addAction("No other column has a result").setEnabled(False)

    def _take_result(self, column_id: int, _: bool = False) -> None:
        column = self._scene_column(column_id)
        if column is not None and column.result is not None:
            self.take(column.result.image, name=f"{column.method} result")

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take images and files, where there is a place for them."""
        if self.spec is not None:
            take_copy(event)

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        """Go on taking a copy, whatever key is held."""
        take_copy(event)

    def dropEvent(self, event: QDropEvent) -> None:
        """Read what was dropped."""
        if take_copy(event):
            self._take_brought(brought_by(event.mimeData()))


def _text(spec: InputSpec) -> str:
    return spec.name if spec.required else f"{spec.name} (not needed)"
