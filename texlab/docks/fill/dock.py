"""Fill holes: paint a mask on a picture, and let Efros-Leung fill it, or let the picture grow outward."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtWidgets import QFileDialog

from texlab.docks.base import Question
from texlab.docks.fill.masks import fill_inputs
from texlab.docks.fill.tools import FillTools
from texlab.docks.fill.work import Work
from texlab.docks.frame import replace_items, shown_image
from texlab.docks.recent import Same
from texlab.state.filling import NO_FILL
from texlab.state.intentions import AskOnce, FillHoles, RunFill, TakeExemplar, Tell
from texlab.style.pictures import to_picture
from texlab_core.engine.inputs import ImageInput, hash_arrays
from texlab_core.engine.registry import find_method

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab.state.filling import FillScene
    from texlab.state.scene import Scene
    from texlab.style.pictures import Picture
    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage

METHOD = "efros-leung"
MOST_WORKS = 3
MAX_SEED = 2**31 - 1
_FROM = [("Copy from around the hole", "near"), ("Copy from the chosen column's result", "column")]
_IMAGES = "Images (*.png *.jpg *.jpeg *.tif *.tiff *.webp *.bmp *.pgm *.ppm *.avif *.jxl)"
_RESULTS = "PNG (*.png);;TIFF (*.tif);;WebP (*.webp);;JPEG (*.jpg)"


class FillDock(FillTools):
    """Paints the hole, and the region that may be copied from."""

    name = "fill"
    title = "Fill"
    help = "Paint a hole on a picture, and Efros-Leung fills it; or let the picture grow outward."
    order = 75
    empty = "A picture to paint on appears as soon as there is an exemplar."

    def build(self) -> Iterator[None]:
        """Make the tools, and begin with no picture."""
        yield from super().build()
        self._image: FloatImage | None = None
        self._exemplar: ImageInput | None = None
        self._works: dict[str, Work] = {}
        self._work: Work | None = None
        self._other: ImageInput | None = None
        self._filling: FillScene = NO_FILL
        self._where_shown = ""
        self._update()

    # What there is to see.

    def show_scene(self, scene: Scene) -> None:
        """Follow the fill that is under way."""
        super().show_scene(scene)
        before, self._filling = self._filling, scene.fill
        filling = self._filling
        if filling is before:
            return
        if (filling.status == "finished" and before.status == "running") or self._missed(before, filling):
            self._take(filling)
        if filling.status == "failed":
            self.intention.emit(Tell(filling.message, problem=True))
        self._show_work()
        self._update()

    def _missed(self, before: FillScene, filling: FillScene) -> bool:
        """Return whether a fill has begun and finished while nobody looked."""
        return filling.status == "finished" and before.plan is not filling.plan

    def _take(self, filling: FillScene) -> None:
        found, plan = filling.found, filling.plan
        assert found is not None
        assert plan is not None
        work: Work = plan.token
        for note in found.result.notes:
            self.intention.emit(Tell(note, problem=False))
        if found.box is not None:
            work.take(found)
            work.shares = None
            if work is self._work:
                self.canvases["mask"].set_shares(np.zeros(work.picture.size, np.uint8))
            return

        def make(should_stop: Callable[[], bool]) -> tuple[ImageInput, Picture]:
            pixels = found.result.image
            name = work.picture.name if work.grown is not None else f"{work.picture.name}, grown"
            digest = hash_arrays({"pixels": pixels})
            depth = work.picture.depth
            return ImageInput(pixels, name, digest, None, (), depth, found.alpha), to_picture(pixels)

        def done(made: tuple[ImageInput, Picture]) -> None:
            grown = Work(made[0], found)
            for sha, each in self._works.items():
                if each is work:
                    self._works[sha] = grown
            if self._work is work:
                self._show_picture(grown, made[1])

        self.intention.emit(AskOnce("fill", make, done))

    def question(self, scene: Scene) -> Question | None:
        """Ask for the pictures that are painted on."""
        self.why = ""
        if scene.exemplar is None:
            return None
        exemplar, image = scene.exemplar, scene.exemplar.pixels
        where = self.where.currentData()
        if where == "photo":
            source = scene.source or scene.exemplar
            work = self._works.get(source.sha256)
            picture = source if work is None else work.picture
            return Question(
                (self.name, where, Same(picture)),
                lambda _: (where, picture, picture.pixels, shown := to_picture(picture.pixels), shown),
            )
        if where == "column":
            found = shown_image(scene.selected)
            if found is None or scene.selected is None or scene.selected.status != "finished":
                self.why = "The chosen column has no finished result to fill."
                return None
            if scene.selected.method == METHOD and self._filled(scene):
                # What was filled is not painted on by itself: the mask would move under the pointer.
                return Question((self.name, "kept"), lambda _: None) if self._image is not None else None
            image = found

        def compute(should_stop: Callable[[], bool]) -> tuple[str, ImageInput, FloatImage, Picture, Picture]:
            return where, exemplar, image, to_picture(image), to_picture(exemplar.pixels)

        return Question((self.name, where, Same(exemplar), Same(image)), compute)

    def _filled(self, scene: Scene) -> bool:
        result = scene.selected.result if scene.selected is not None else None
        return result is not None and "mask" in result.job.inputs

    def show_answer(self, answer: tuple[str, ImageInput, FloatImage, Picture, Picture] | None) -> None:
        """Paint on these pictures."""
        if answer is not None:
            where, self._exemplar, self._image, picture, exemplar_picture = answer
            self._leave_work()
            if where == "photo":
                sha = self._exemplar.sha256
                source = self.scene.source
                sha = sha if source is None else source.sha256
                work = self._works.pop(sha, None) or Work(self._exemplar)
                # The newest last; a few are kept, so that a look at another picture loses nothing.
                self._works[sha] = work
                while len(self._works) > MOST_WORKS:
                    del self._works[next(iter(self._works))]
                self._show_picture(work, picture)
            else:
                if self._where_shown == "photo":
                    self.canvases["mask"].set_shares(np.zeros(picture.shape[:2], np.uint8))
                self.canvases["mask"].show_image(picture)
                self.canvases["region"].show_image(exemplar_picture)
            self._where_shown = where
        self._update()

    def _leave_work(self) -> None:
        if self._work is not None:
            self._work.shares = self.canvases["mask"].shares
        self._work = None

    def _show_picture(self, work: Work, picture: Picture) -> None:
        self._work = work
        self._exemplar, self._image = work.picture, work.picture.pixels
        for canvas in self.canvases.values():
            canvas.show_image(picture)
        shares = work.shares if work.shares is not None else np.zeros(picture.shape[:2], np.uint8)
        self.canvases["mask"].set_shares(shares)
        self._show_work()
        self._update()

    def _show_work(self) -> None:
        """Lay the fills over the picture, and what the one under way looks like."""
        if self._work is None:
            return
        shown = self._work.pictures
        plan = self._filling.plan
        preview = self._filling.preview if self._filling.status == "running" else None
        if preview is not None and plan is not None and plan.token is self._work and plan.box is not None:
            shown = (*shown, (plan.box, preview))
        self.canvases["mask"].show_patches(shown)

    def _update(self, *_: object) -> None:
        running, alone, work = self._filling.status == "running", self.by_itself, self._work
        marked = self._image is not None and self.canvases["mask"].marked_box() is not None
        there = self._image is not None
        made = work is not None and bool(work.made)
        self.fill_button.setEnabled(marked and not (running and alone))
        self.grow_button.setEnabled(there)
        self.margins.setEnabled(there and not running)
        self.undo_button.setEnabled(self.canvas.can_undo or (alone and made and not running))
        self.again_button.setEnabled(made and not running)
        for button in (self.save_button, self.use_button):
            button.setEnabled(made or (work is not None and work.grown is not None))
        of_a_picture = (self.source, self.other_button, self.reach, self.hardness, self.margins)
        for control in (*of_a_picture, self.again_button, self.save_button, self.use_button):
            control.setVisible(alone)
        self.grow_button.setVisible(not alone)
        self.reach.setEnabled(self.source.currentData() == "near")
        self.stop_button.setVisible(running)
        self.progress.setVisible(running)
        self.progress.setValue(round(1000 * self._filling.fraction))

    # What the user does.

    def _where_changed(self) -> None:
        self._tool_changed()
        self._update()
        self.ask()

    def _undo(self) -> None:
        if self.canvas.can_undo:
            self.canvas.undo()
        elif self._work is not None and self.by_itself:
            back = self._work.take_back()
            if back is not None:
                shares = np.zeros(self._work.picture.size, np.uint8)
                shares[back.patch[0]] = back.shares
                self.canvases["mask"].set_shares(shares)
                self._show_work()
        self._update()

    def _params(self) -> Params:
        """Return the parameters of a column of the method, with the reach that is set here."""
        columns = self.scene.columns
        found = next((each.params for each in columns if each.method == METHOD), None)
        params = find_method(METHOD).params() if found is None else found
        return params.replace(reach=self.reach.value())

    def _fill(self) -> None:
        if self.by_itself:
            self._run((0, 0, 0, 0), self.scene.seed)
        elif self._image is not None:
            height, width = self._image.shape[:2]
            self._submit((height, width))

    def _again(self) -> None:
        work = self._work
        back = work.take_back() if work is not None else None
        if work is None or back is None:
            return
        shares = np.zeros(work.picture.size, np.uint8)
        shares[back.patch[0]] = back.shares
        self.canvases["mask"].set_shares(shares)
        self._show_work()
        self._run((0, 0, 0, 0), (back.seed + 1) & MAX_SEED)

    def _grow(self) -> None:
        self._submit(None)

    def _grow_by(self, margins: tuple[int, int, int, int]) -> None:
        self._run(margins, self.scene.seed)

    def _run(self, margins: tuple[int, int, int, int], seed: int) -> None:
        work, scene = self._work, self.scene
        if work is None or self._filling.status == "running":
            return
        exemplar: Callable[[], ImageInput | None] | None = None
        if self.source.currentData() == "other":
            exemplar = partial(_same, self._other)
        elif self.source.currentData() == "column":
            result = scene.selected.result if scene.selected is not None else None
            if result is None or result.volume is not None:
                self.intention.emit(Tell("The chosen column has no finished result to copy from.", problem=True))
                return
            exemplar = partial(_image_of, result)
        region = self.canvases["region"].mask if exemplar is None else None
        canvas = self.canvases["mask"]
        plan = work.plan(
            canvas.shares.copy(),
            canvas.marked_box(),
            self._params(),
            exemplar=exemplar,
            region=region,
            margins=margins,
            seed=seed,
        )
        self.intention.emit(RunFill(plan))

    def _open_other(self) -> None:
        path, _ = QFileDialog.getOpenFileName(self, "Copy from another image", "", _IMAGES)
        if not path:
            return

        def read(should_stop: Callable[[], bool]) -> ImageInput:
            from texlab_core.images.exemplar import as_exemplar

            return as_exemplar(path, should_stop=should_stop)

        def done(image: ImageInput) -> None:
            self._other = image
            height, width = image.size
            replace_items(self.source, [*_FROM, (f"Copy from {image.name}, {width} x {height}", "other")])
            self.source.setCurrentIndex(self.source.findData("other"))
            self._update()

        self.intention.emit(AskOnce("open", read, done))

    def _save(self) -> None:
        work = self._work
        if work is None:
            return
        name = f"{Path(work.picture.name.removeprefix('gallery:')).stem}-filled.png"
        path, kind = QFileDialog.getSaveFileName(self, "Save the filled picture", name, _RESULTS)
        if not path:
            return
        suffix = kind.partition("*")[2].rstrip(")") or ".png"

        def write(should_stop: Callable[[], bool]) -> str:
            from texlab_core.documents.record import result_bits, save_result
            from texlab_core.images.formats.writing import can_hold_alpha, named_with_suffix

            made = work.result()
            assert made is not None
            result, alpha = made
            target = named_with_suffix(path, suffix)
            bits = result_bits(result, target)
            notes = save_result(result, target, bits=bits, alpha=alpha if can_hold_alpha(target) else None)
            depth = "in floats" if bits == "float" else f"in {bits} bits"
            return " ".join((f"Saved {target} with its recipe, {depth}.", *notes))

        self.intention.emit(AskOnce("save", write, lambda said: self.intention.emit(Tell(said, problem=False))))

    def _use(self) -> None:
        work = self._work
        if work is None:
            return

        def make(should_stop: Callable[[], bool]) -> ImageInput:
            made = work.result()
            assert made is not None
            result, alpha = made
            name = f"{work.picture.name}, filled"
            digest = hash_arrays({"pixels": result.image})
            image = ImageInput(result.image, name, digest, None, (), work.picture.depth, alpha)
            image.pixels.flags.writeable = False
            return image

        self.intention.emit(AskOnce("use", make, lambda image: self.intention.emit(TakeExemplar(image))))

    def _submit(self, size: tuple[int, int] | None) -> None:
        exemplar, image = self._exemplar, self._image
        if exemplar is None or image is None:
            return
        mask, region = self.canvases["mask"].mask, self.canvases["region"].mask

        def make(should_stop: Callable[[], bool]) -> tuple[tuple[str, ImageInput], ...]:
            return fill_inputs(exemplar, image, mask, region)

        def done(inputs: tuple[tuple[str, ImageInput], ...]) -> None:
            self.intention.emit(FillHoles(METHOD, inputs, size))

        self.intention.emit(AskOnce("fill", make, done))


def _image_of(result: Result) -> ImageInput:
    return ImageInput(result.image, f"{result.job.method} result", hash_arrays({"pixels": result.image}))


def _same(image: ImageInput | None) -> ImageInput | None:
    return image
