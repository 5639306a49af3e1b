"""A textured sphere with needles: local estimates of its orientation, and the truth beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab.docks.base import Question
from texlab.docks.lab.page import LabPage, Shown, Told
from texlab.docks.recent import Recent
from texlab_core.shape.sheets import FOUND, TRUTH, needles
from texlab_core.shape.sphere import LIMB, SLANT_BINS, errors_by_slant, local_shape, render_sphere
from texlab_core.sheets.laboratory import gray

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.scene import Scene
    from texlab_core.shape.sphere import SphereTexture

TEXTURES = (("discs", "discs"), ("noise", "noise"))
_SIDE = 384


class SpherePage(LabPage):
    """Shows local shape from texture on a sphere."""

    name = "lab-sphere"
    title = "Sphere"
    help = "A textured sphere: the orientation of each window as a needle, and the truth beside it (11.4.2)."

    def build(self) -> None:
        """Make the controls and the pictures."""
        self._recent = Recent(4)
        self.texture = self.add_choice("texture", "Texture", "What is on the sphere", TEXTURES, self.ask)
        tip = "Side of the windows (four deviations): wide ones read low slants better and blur high ones"
        self.window_size = self.add_number("window", "window", tip, (8, 96), self.ask)
        self.window_size.setSuffix(" px")
        self.window_size.setValue(24)
        self.add_again("Another one", "Draw another texture of the same kind")
        self.lay_out(3, words=True)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the sphere; it needs no exemplar."""
        texture, window = self.texture.currentData(), self.window_size.value()
        seed, recent = self.seed, self._recent

        def compute(should_stop: Callable[[], bool]) -> Told:
            return sphere_answer(texture, window, seed, recent)

        return Question((texture, window, seed), compute)

    def show_answer(self, answer: Told) -> None:
        """Show pictures and words."""
        self.pictures.show_pictures(answer.shown)
        self.words.setText(answer.words)


def sphere_answer(texture: SphereTexture, window: int, seed: int, recent: Recent) -> Told:
    """Return the view, needles of the estimates and of the truth, and the errors by slant."""
    sphere = recent.get((texture, seed), lambda: render_sphere(_SIDE, np.random.default_rng(seed), texture))
    found = local_shape(sphere.image, window)
    step = max(12, window // 2)
    known = np.nan_to_num(sphere.slant, nan=90.0) < LIMB
    errors = errors_by_slant(sphere, found)
    told = ", ".join(
        f"{error:.0f}° at {low} to {high}°" for (low, high), error in zip(SLANT_BINS, errors, strict=True)
    )
    return Told(
        (
            Shown.of("view", gray(sphere.image), np.nan_to_num(sphere.slant), "° slant in truth"),
            Shown.of(
                "estimates",
                needles(sphere.image, found.slant, found.tilt, known, step, FOUND),
                found.slant,
                "° slant",
            ),
            Shown.of(
                "truth",
                needles(sphere.image, sphere.slant, sphere.tilt, known, step, TRUTH),
                np.nan_to_num(sphere.slant),
                "° slant",
            ),
        ),
        f"The normal is off by {told} of slant. Near the middle the cosine is flat; the limb is left out.",
    )
