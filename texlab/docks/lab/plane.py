"""Shape from texture: a plane of isotropic texture, its landscape of hypotheses, and a disc to lay on it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from texlab.docks.base import Question
from texlab.docks.lab.page import MARGINS, DragPlane, LabPage, Pictures, Shown, plane_of
from texlab.docks.recent import Recent, Same
from texlab.style.colouring import SEQUENTIAL_TABLE, Scale, paint
from texlab.style.numbers import number
from texlab.style.pictures import to_picture
from texlab.widgets.headed import headed
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.plane_pane import Arrow, Path, Spot
from texlab_core.shape import exercises
from texlab_core.shape.isotropy import DOUBTFUL, SMALLEST_SIDE, isotropy_spectrum, landscape
from texlab_core.shape.orientation import MOST_SLANT, Orientation
from texlab_core.shape.rendering import rectified, slanted_plane
from texlab_core.shape.textures import disc_texture, noise_texture
from texlab_core.sheets.laboratory import gray

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.state.scene import Scene
    from texlab.style.pictures import Picture
    from texlab.widgets.plane_pane import Drawn, Tint
    from texlab_core.shape.isotropy import Landscape

SOURCES = (
    ("exemplar, seen as it is", "view"),
    ("exemplar, slanted", "texture"),
    ("noise, slanted", "noise"),
    ("discs, slanted", "discs"),
)
_SIDE, _POINTS = 256, 41
_COST = Scale(0, 1)


@dataclass(frozen=True, eq=False)
class View:
    """A view of a plane, and all that does not depend on the hypothesis."""

    image: NDArray[np.float32]
    picture: Picture
    costs: Landscape
    painted: Picture
    search: Orientation
    moments: Orientation
    truth: Orientation | None
    apparent: float | None


@dataclass(frozen=True, eq=False)
class PlaneAnswer:
    """A view, a hypothesis, and the view turned back by it (and by the truth)."""

    view: View
    hypothesis: Orientation
    shown: tuple[Shown, ...]


class PlanePage(LabPage):
    """Reads slant and tilt from a texture."""

    name = "lab-plane"
    title = "Plane"
    help = "Slant and tilt of a plane of isotropic texture: landscape, rectified patch, a disc to drag (11.4.1)."
    empty = "The view appears as soon as there is an exemplar."

    def build(self) -> None:
        """Make the controls and the views."""
        self._recent = Recent(6)
        self._hypothesis: Orientation | None = None
        self._prepared: tuple[Any, ...] = ()
        tip = (
            "What is looked at: the exemplar as the view of a plane, or a texture on a plane of known orientation"
        )
        self.source = self.add_choice("source", "View", tip, SOURCES, self._source_changed)
        self.source.setCurrentIndex(self.source.findData("discs"))
        tip = "Slant of the plane that is rendered"
        self.slant = self.add_angle("slant", "slant", tip, (0, int(MOST_SLANT)), 50, self._view_changed)
        tip = "Tilt of the plane that is rendered: 0° to the right, 90° down"
        self.tilt = self.add_angle("tilt", "tilt", tip, (0, 359), 30, self._view_changed)
        tip = "Take the hypothesis of least cost"
        self.search = self.add_button("search", "Search", tip, lambda: self._take("search"))
        tip = "Take the estimate by second moments of the spectrum"
        self.moments = self.add_button("moments", "Moments", tip, lambda: self._take("moments"))
        self.readout = self.add_readout()
        self.view = DragPlane("lab-plane-view", "View, with a disc that lies on the plane: drag its normal")
        self.landscape = DragPlane("lab-plane-landscape", "Cost of every hypothesis: drag to choose one")
        self.pictures = Pictures("lab-plane-pictures", 2, linked=False)
        self.view.dragged.connect(self._drag_normal)
        self.landscape.dragged.connect(self._drag_cost)
        self.landscape.hovered.connect(self._hover)
        self.landscape.left.connect(lambda: self.readout.setText(""))
        views = QWidget()
        self._cost_heading = Label("cost: drag the place")
        set_tip(self._cost_heading, "Cost of every hypothesis, at slant · (cos 2 tilt, sin 2 tilt); dark is low")
        row = QHBoxLayout(views)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(headed(Label("view: drag the arrow"), self.view), 1)
        row.addWidget(headed(self._cost_heading, self.landscape), 1)
        row.addWidget(self.pictures, 2)
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(*MARGINS)
        layout.addWidget(views, 1)
        layout.addWidget(self.make_words())

    # Asking.

    def question(self, scene: Scene) -> Question | None:
        """Ask for the view, its landscape, and the view turned back by the hypothesis."""
        self.why = ""
        source = self.source.currentData()
        pixels = None if scene.exemplar is None else scene.exemplar.pixels
        if source in ("view", "texture"):
            if pixels is None:
                return None
            if min(pixels.shape[:2]) < SMALLEST_SIDE:
                self.why = f"Shape from texture needs at least {SMALLEST_SIDE} x {SMALLEST_SIDE} pixels."
                return None
        else:
            pixels = None
        truth = None if source == "view" else Orientation(self.slant.value(), self.tilt.value())
        key = (source, Same(pixels), truth)
        if key != self._prepared:
            # Another plane: what was chosen for the last one means nothing.
            self._prepared, self._hypothesis = key, None
        hypothesis, recent = self._hypothesis, self._recent

        def compute(should_stop: Callable[[], bool]) -> PlaneAnswer:
            view = recent.get(key, lambda: prepared(source, pixels, truth, recent))
            chosen = view.search if hypothesis is None else hypothesis
            return PlaneAnswer(view, chosen, turned_back(view, chosen))

        return Question((key, hypothesis), compute)

    def _source_changed(self) -> None:
        rendered = self.source.currentData() != "view"
        self.slant.setVisible(rendered)
        self.tilt.setVisible(rendered)
        self.ask()

    def _view_changed(self) -> None:
        self.ask()

    def _take(self, which: str) -> None:
        answer: PlaneAnswer | None = self.answer
        if answer is not None:
            self._choose(getattr(answer.view, which))

    def _drag_cost(self, x: float, y: float, final: bool) -> None:
        self._choose(Orientation.from_disc(x, y))

    def _drag_normal(self, x: float, y: float, final: bool) -> None:
        radius = self._radius()
        if radius > 0:
            sine = min(math.hypot(x, y) / radius, math.sin(math.radians(MOST_SLANT)))
            self._choose(Orientation(math.degrees(math.asin(sine)), math.degrees(math.atan2(y, x)) % 360))

    def _choose(self, hypothesis: Orientation) -> None:
        self._hypothesis = hypothesis
        # The marks are under the finger at once; the patch follows from the thread.
        self._draw_marks(hypothesis)
        self.ask()

    # Showing.

    def show_answer(self, answer: PlaneAnswer) -> None:
        """Show view, landscape and patches."""
        height, width = answer.view.image.shape
        self.view.show_picture(answer.view.picture, QRectF(-width / 2, -height / 2, width, height))
        axis = answer.view.costs.axis
        step = float(axis[1] - axis[0])
        reach = float(axis[-1]) + step / 2
        self.landscape.show_picture(answer.view.painted, QRectF(-reach, -reach, 2 * reach, 2 * reach))
        self.pictures.show_pictures(answer.shown)
        self._draw_marks(self._hypothesis or answer.hypothesis)
        self.words.setText(words_of(answer))

    def _radius(self) -> float:
        answer: PlaneAnswer | None = self.answer
        return 0.0 if answer is None else min(answer.view.image.shape) / 3

    def _draw_marks(self, hypothesis: Orientation) -> None:
        answer: PlaneAnswer | None = self.answer
        if answer is None:
            return
        view, radius = answer.view, self._radius()
        drawn: list[Drawn] = []
        spots: list[Drawn] = []
        marks: list[tuple[Orientation, Tint, Any]] = [
            (view.search, "result", "square"),
            (view.moments, "centre", "cross"),
            (hypothesis, "chosen", "circle"),
        ]
        if view.truth is not None:
            marks.insert(0, (view.truth, "exemplar", "circle"))
        for orientation, tint, shape in marks:
            spots.append(Spot(*orientation.disc, tint, shape))
            if tint in ("exemplar", "chosen"):
                outline = exercises.outline(orientation, radius, 61)
                drawn.append(
                    Path(tuple((float(x), float(y)) for x, y in outline), tint, dashed=tint == "exemplar")
                )
                x, y = (float(each) * radius for each in orientation.normal[:2])
                drawn.append(Arrow(0, 0, x, y, tint, dashed=tint == "exemplar"))
        self.view.show_marks(drawn)
        self.landscape.show_marks(spots)

    def _hover(self, x: float, y: float) -> None:
        answer: PlaneAnswer | None = self.answer
        if answer is None:
            return
        costs = answer.view.costs
        column, row = (int(np.abs(costs.axis - each).argmin()) for each in (x, y))
        cost = float(costs.cost[row, column])
        orientation = Orientation.from_disc(x, y)
        told = f"slant {orientation.slant:.0f}°, tilt {orientation.tilt:.0f}° or {orientation.tilt + 180:.0f}°"
        self.readout.setText(f"{told}: cost {number(cost)}" if math.isfinite(cost) else "")


def prepared(source: str, pixels: NDArray[np.float32] | None, truth: Orientation | None, recent: Recent) -> View:
    """Return a view with its landscape and estimates."""
    apparent = None
    if pixels is not None:
        texture = plane_of(pixels)
    else:
        maker: Any = noise_texture if source == "noise" else disc_texture
        texture = recent.get(source, lambda: maker(2 * _SIDE, np.random.default_rng(0)))
    image = texture
    if truth is not None:
        beyond: Any = "mirrored" if pixels is not None else "repeated"
        image = slanted_plane(texture, truth, (_SIDE, _SIDE), beyond=beyond)
        apparent = isotropy_spectrum(texture[:_SIDE, :_SIDE]).by_moments().slant
    spectrum = isotropy_spectrum(image)
    costs = landscape(spectrum, _POINTS)
    low, high = float(np.nanmin(costs.cost)), float(np.nanmax(costs.cost))
    shown = (costs.cost - low) / max(high - low, 1e-9)
    painted = paint(_COST.place(shown), SEQUENTIAL_TABLE)
    search, moments = spectrum.by_search(), spectrum.by_moments()
    return View(image, to_picture(gray(image)), costs, painted, search, moments, truth, apparent)


def turned_back(view: View, hypothesis: Orientation) -> tuple[Shown, ...]:
    """Return what the hypothesis, and the truth, say the texture looks like frontally."""
    found = [("hypothesis, frontal", hypothesis)]
    if view.truth is not None:
        found.append(("truth, frontal", view.truth))
    flat = [(title, rectified(view.image, each)) for title, each in found]
    return tuple(Shown(title, to_picture(gray(plane)), plane) for title, plane in flat)


def words_of(answer: PlaneAnswer) -> str:
    """Return the estimates in words."""
    view = answer.view
    named = [("hypothesis (○)", answer.hypothesis), ("search (□)", view.search), ("moments (x)", view.moments)]
    parts = []
    for name, each in named:
        words = f"{name}: slant {each.slant:.0f}°, tilt {each.tilt % 180:.0f}° or {each.tilt % 180 + 180:.0f}°"
        if view.truth is not None:
            words += f", {each.error(view.truth):.0f}° off"
        parts.append(words)
    words = "; ".join(parts) + "."
    doubt = view.apparent if view.apparent is not None else 0.0
    if doubt > DOUBTFUL:
        words += (
            f" Frontally this texture reads {doubt:.0f}°: it is not isotropic, and nothing here can be trusted."
        )
    elif view.apparent is not None:
        words += f" Frontally this texture reads {doubt:.0f}°."
    return words
