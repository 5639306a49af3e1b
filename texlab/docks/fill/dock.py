"""Fill holes: paint a mask on the exemplar or on a result, and let Efros-Leung fill it, or grow it outward."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtWidgets import QFileDialog, QHBoxLayout

from texlab.docks.base import Question
from texlab.docks.fill.mask_canvas import DEFAULT_RADIUS, MaskCanvas
from texlab.docks.frame import FramedDock, shown_image
from texlab.docks.recent import Same
from texlab.state.intentions import AskOnce, FillHoles, Tell
from texlab.style.pictures import to_picture
from texlab.widgets.number_box import WholeBox
from texlab_core.engine.inputs import ImageInput, hash_arrays

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.state.scene import Scene
    from texlab.style.pictures import Picture
    from texlab_core.engine.steps import FloatImage

METHOD = "efros-leung"
_TOOLS = [("Brush", "brush"), ("Rubber", "rubber"), ("Rectangle", "rectangle")]
_TARGETS = [("Hole to fill", "mask"), ("Region to copy from", "region")]
_WHERE = [("Exemplar", "exemplar"), ("Chosen column", "column")]


class FillDock(FramedDock):
    """Paints the hole, and the region that may be copied from."""

    name = "fill"
    title = "Fill"
    help = "Paint a hole on the exemplar or on a result, and Efros-Leung fills it; or let a picture grow outward."
    order = 75
    empty = "A picture to paint on appears as soon as there is an exemplar."

    def build(self) -> None:
        """Make the tools and the two canvases."""
        self.canvases = {
            "mask": MaskCanvas("fill-mask", "Paint the hole", self.body),
            "region": MaskCanvas("fill-region", "Paint the region to copy from", self.body),
        }
        self.where = self.add_choice(
            "where",
            "Picture",
            "Which picture is filled: the exemplar or the chosen column's result",
            _WHERE,
            self.ask,
        )
        self.target = self.add_choice(
            "target",
            "What is painted",
            "The hole that is filled, or the part of the exemplar that may be copied (all of it when unpainted)",
            _TARGETS,
            self._target_changed,
        )
        self.tool = self.add_choice("tool", "Tool", "What the left button paints with", _TOOLS, self._tool_changed)
        self.radius = WholeBox()
        self.radius.setRange(1, 64)
        self.radius.setValue(DEFAULT_RADIUS)
        self.radius.setPrefix("radius ")
        self.radius.valueChanged.connect(self._radius_changed)
        self.add_control(self.radius, "radius", "Radius", "Radius of the brush, in pixels")
        self.add_button("undo", "Undo stroke", "Take the last stroke back (Ctrl+Z on the picture)", self._undo)
        self.add_button("clear", "Clear", "Unmark everything", lambda: self._replace(lambda mask: mask & False))
        self.add_button("invert", "Invert", "Mark what is not marked", lambda: self._replace(np.logical_not))
        self.add_button(
            "load", "Load mask ...", "Mark what is transparent in a picture, or bright in one without", self._load
        )
        self.fill_button = self.add_button("run", "Fill", "Fill the hole in a column of its own", self._fill)
        self.grow_button = self.add_button(
            "grow", "Grow outward", "Grow the picture to the size in the tool bar, and fill its hole", self._grow
        )
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        for key, canvas in self.canvases.items():
            canvas.setVisible(key == "mask")
            layout.addWidget(canvas)
            canvas.changed.connect(self._update)
        self._image: FloatImage | None = None
        self._exemplar: ImageInput | None = None
        self._update()

    @property
    def canvas(self) -> MaskCanvas:
        """The canvas that is painted on."""
        return self.canvases[self.target.currentData()]

    def question(self, scene: Scene) -> Question | None:
        """Ask for the pictures that are painted on."""
        self.why = ""
        if scene.exemplar is None:
            return None
        exemplar, image = scene.exemplar, scene.exemplar.pixels
        if self.where.currentData() == "column":
            found = shown_image(scene.selected)
            if found is None or scene.selected is None or scene.selected.status != "finished":
                self.why = "The chosen column has no finished result to fill."
                return None
            if scene.selected.method == METHOD and self._filled(scene):
                # What was filled is not painted on by itself: the mask would move under the pointer.
                return Question((self.name, "kept"), lambda _: None) if self._image is not None else None
            image = found

        def compute(should_stop: Callable[[], bool]) -> tuple[ImageInput, FloatImage, Picture, Picture]:
            return exemplar, image, to_picture(image), to_picture(exemplar.pixels)

        return Question((self.name, Same(exemplar), Same(image)), compute)

    def _filled(self, scene: Scene) -> bool:
        result = scene.selected.result if scene.selected is not None else None
        return result is not None and "mask" in result.job.inputs

    def show_answer(self, answer: tuple[ImageInput, FloatImage, Picture, Picture] | None) -> None:
        """Paint on these pictures."""
        if answer is not None:
            self._exemplar, self._image, picture, exemplar_picture = answer
            self.canvases["mask"].show_image(picture)
            self.canvases["region"].show_image(exemplar_picture)
        self._update()

    def _target_changed(self) -> None:
        for key, canvas in self.canvases.items():
            canvas.setVisible(key == self.target.currentData())
        self._tool_changed()

    def _tool_changed(self, *_: object) -> None:
        for canvas in self.canvases.values():
            canvas.tool = self.tool.currentData()

    def _radius_changed(self, *_: object) -> None:
        for canvas in self.canvases.values():
            canvas.radius = self.radius.value()

    def _undo(self) -> None:
        self.canvas.undo()

    def _replace(self, change: Callable[[NDArray[np.bool_]], NDArray[np.bool_]]) -> None:
        self.canvas.set_mask(change(self.canvas.mask))

    def _update(self) -> None:
        marked = self._image is not None and bool(self.canvases["mask"].mask.any())
        self.fill_button.setEnabled(marked)
        self.grow_button.setEnabled(self._image is not None)

    def _load(self) -> None:
        path, _ = QFileDialog.getOpenFileName(
            self, "Load mask", "", "Images (*.png *.tif *.tiff *.webp *.bmp *.pgm)"
        )
        if path:
            canvas, size = self.canvas, self.canvas.mask.shape

            def done(mask: NDArray[np.bool_]) -> None:
                if mask.shape == canvas.mask.shape:
                    canvas.set_mask(mask)
                else:
                    sentence = "The mask was read for another picture; load it again."
                    self.intention.emit(Tell(sentence, problem=True))

            self.intention.emit(AskOnce("mask", lambda should_stop: read_mask(path, size), done))

    def _fill(self) -> None:
        if self._image is not None:
            height, width = self._image.shape[:2]
            self._submit((height, width))

    def _grow(self) -> None:
        self._submit(None)

    def _submit(self, size: tuple[int, int] | None) -> None:
        exemplar, image = self._exemplar, self._image
        if exemplar is None or image is None:
            return
        mask, region = self.canvases["mask"].mask.copy(), self.canvases["region"].mask.copy()

        def make(should_stop: Callable[[], bool]) -> tuple[tuple[str, ImageInput], ...]:
            return fill_inputs(exemplar, image, mask, region)

        def done(inputs: tuple[tuple[str, ImageInput], ...]) -> None:
            self.intention.emit(FillHoles(METHOD, inputs, size))

        self.intention.emit(AskOnce("fill", make, done))


def fill_inputs(
    exemplar: ImageInput, image: FloatImage, mask: NDArray[np.bool_], region: NDArray[np.bool_]
) -> tuple[tuple[str, ImageInput], ...]:
    """Return the further inputs of a fill; a start image only where it is not the exemplar itself."""
    inputs = [("mask", mask_input(mask, "painted hole"))]
    if image is not exemplar.pixels:
        inputs.append(("start", ImageInput(image, "result", hash_arrays({"pixels": image}))))
    if region.any():
        inputs.append(("region", mask_input(region, "painted region")))
    return tuple(inputs)


def mask_input(mask: NDArray[np.bool_], name: str) -> ImageInput:
    """Return a mask as an image: 1 where it is marked."""
    pixels = np.ascontiguousarray(mask[..., None], np.float32)
    pixels.flags.writeable = False
    return ImageInput(pixels, name, hash_arrays({"pixels": pixels}))


def read_mask(path: str, size: tuple[int, ...]) -> NDArray[np.bool_]:
    """Read a mask: what is transparent, or in a picture without transparency what is brighter than half.

    Raises
    ------
    InputError
        When it cannot be read or has another size.
    """
    from texlab_core.errors import InputError
    from texlab_core.images.exemplar import as_exemplar

    over_white, over_black = (as_exemplar(path, background=level).pixels for level in (1.0, 0.0))
    # Transparent pixels, and no others, depend on what they are laid over.
    opaque = over_white.shape == over_black.shape and np.array_equal(over_white, over_black)
    if opaque:
        mask: NDArray[np.bool_] = over_white.mean(axis=2) > 0.5
    else:
        light, dark = (_three(each) for each in (over_white, over_black))
        mask = (light - dark).max(axis=2) > 0.5
    if mask.shape != tuple(size):
        raise InputError(
            f"mask: must have the size of the picture, {size[1]} x {size[0]} pixels, "
            f"got {mask.shape[1]} x {mask.shape[0]}."
        )
    return mask


def _three(pixels: FloatImage) -> Any:
    return np.broadcast_to(pixels, (*pixels.shape[:2], 3))
