"""Texture as smoothed energy: the stages of Fig. 11.6, and classes by k-means of 24 filters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab.docks.base import Question
from texlab.docks.lab.page import LabPage, Shown, looker, plane_of
from texlab.docks.recent import Recent, Same
from texlab.style.pictures import to_picture
from texlab_core.sheets.laboratory import gray
from texlab_core.stats import representation

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.scene import Scene

# Apart without colour, by their lightness too.
CLASS_COLOURS = np.array(
    [(0, 0, 0), (95, 95, 95), (175, 175, 175), (255, 255, 255)], np.uint8
)  # as the figure has them
GATHERED = np.array(
    [
        (0, 114, 178),
        (230, 159, 0),
        (0, 158, 115),
        (240, 228, 66),
        (86, 180, 233),
        (213, 94, 0),
        (204, 121, 167),
        (90, 90, 90),
    ],
    np.uint8,
)


class RepresentationPage(LabPage):
    """Shows how pixels are sorted by the energy of filters."""

    name = "lab-representation"
    title = "Representation"
    help = "Squared derivatives, their local means, and what is vertical, horizontal, both or neither (Fig. 11.6)."
    empty = "Classes appear as soon as there is an exemplar."

    def build(self) -> None:
        """Make the controls and the pictures."""
        self._recent = Recent(2)
        tip = "Deviation of the window over which energies are averaged, in pixels"
        self.smoothing = self.add_real("smoothing", "smoothing", tip, (1, 64, 1), self.ask, " px")
        self.smoothing.setValue(8)
        tip = "Above it a mean energy counts, as a share of the mean of both maps"
        self.threshold = self.add_real("threshold", "threshold", tip, (0.05, 4, 0.05), self.ask)
        self.threshold.setValue(0.5)
        tip = "Gather the energies of 24 filters (three scales) into so many classes; 1 leaves it out"
        self.classes = self.add_number("classes", "k-means", tip, (1, representation.MOST_CLASSES), self.ask)
        self.lay_out(7, words=True)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the stages on the exemplar."""
        if scene.exemplar is None:
            return None
        pixels, recent = scene.exemplar.pixels, self._recent
        settings = (self.smoothing.value(), self.threshold.value(), self.classes.value())

        def compute(should_stop: Callable[[], bool]) -> tuple[tuple[Shown, ...], str]:
            plane, look = plane_of(pixels), looker(should_stop)
            shown, words = stages(plane, settings[0], settings[1])
            if settings[2] < 2:
                return shown, words
            key = (Same(pixels), settings[0])
            smoothing = max(settings[0], 4.0)
            features = recent.get(key, lambda: representation.energy_features(plane, smoothing, look))
            found = representation.gather(features, settings[2], np.random.default_rng(0))
            return (*shown, Shown(f"k-means, {settings[2]}", GATHERED[found], found)), words

        return Question((Same(pixels), settings), compute)

    def show_answer(self, answer: tuple[tuple[Shown, ...], str]) -> None:
        """Show the stages."""
        self.readout.setText("")
        self.pictures.show_pictures(answer[0])
        self.words.setText(answer[1])


def stages(plane: representation.Plane, smoothing: float, threshold: float) -> tuple[tuple[Shown, ...], str]:
    """Return the figure's pictures for a plane, and how large the classes are."""
    found = representation.represent(plane, smoothing, threshold)
    white = float(np.percentile(found.vertical[::2, ::2], 99.5))
    white = max(white, float(np.percentile(found.horizontal[::2, ::2], 99.5)))
    mean = float(max(found.smooth_vertical.max(), found.smooth_horizontal.max()))
    shares = ", ".join(
        f"{name} {100 * share:.0f} %" for name, share in zip(representation.CLASS_NAMES, found.shares, strict=True)
    )
    shown = (
        Shown("exemplar", to_picture(gray(plane)), plane),
        Shown("vertical²", to_picture(gray(found.vertical, white)), found.vertical),
        Shown("horizontal²", to_picture(gray(found.horizontal, white)), found.horizontal),
        Shown("vertical mean", to_picture(gray(found.smooth_vertical, mean)), found.smooth_vertical),
        Shown("horizontal mean", to_picture(gray(found.smooth_horizontal, mean)), found.smooth_horizontal),
        Shown("classes", CLASS_COLOURS[found.classes], found.classes),
    )
    return shown, f"From black to white: {shares}."
