"""The Laplacian pyramid step by step: smooth, reduce, expand, subtract; and back: expand, add."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab.docks.base import Question
from texlab.docks.lab.page import LARGEST, LabPage, Shown, plane_of
from texlab.docks.recent import Same
from texlab.style.pictures import to_picture
from texlab_core.sheets.laboratory import gray, signed
from texlab_core.transforms.gaussian import Expansion, max_levels
from texlab_core.transforms.pyramid_steps import analysis_steps, synthesis_steps

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.state.scene import Scene

WAYS = (("down: smooth, reduce, expand, subtract", "down"), ("up: expand, add", "up"))
MODES = (("interpolate", "interpolate"), ("replicate", "replicate"))


class StepsPage(LabPage):
    """Shows one level of the analysis or of the synthesis."""

    name = "lab-steps"
    title = "Steps"
    help = "A Laplacian pyramid step by step: smooth, reduce, expand, subtract; and back (Algorithms 11.1, 11.2)."
    empty = "The steps appear as soon as there is an exemplar."

    def build(self) -> None:
        """Make the controls and the pictures."""
        self.way = self.add_choice("way", "Direction", "Analysis or synthesis", WAYS, self.ask)
        self.level = self.add_number("level", "level", "Which level; 0 is the finest", (0, 12), self.ask)
        tip = "Interpolate, or repeat every sample as the textbook's operator does"
        self.mode = self.add_choice("mode", "Expansion", tip, MODES, self.ask)
        self.lay_out(5, linked=False)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the steps of the chosen level."""
        self.why = ""
        if scene.exemplar is None:
            return None
        pixels = scene.exemplar.pixels
        most = max_levels([min(side, LARGEST) for side in pixels.shape[:2]])
        if most < 1:
            self.why = "The exemplar is too small for a pyramid."
            return None
        level, way = min(self.level.value(), most - 1), self.way.currentData()
        mode: Expansion = self.mode.currentData()

        def compute(should_stop: Callable[[], bool]) -> tuple[Shown, ...]:
            return step_pictures(plane_of(pixels), level, way, mode, most)

        return Question((Same(pixels), level, way, mode), compute)

    def show_answer(self, answer: tuple[Shown, ...]) -> None:
        """Show the steps."""
        self.readout.setText("")
        self.pictures.show_pictures(answer)


def step_pictures(
    plane: NDArray[np.float32], level: int, way: str, mode: Expansion, most: int
) -> tuple[Shown, ...]:
    """Return the pictures of one level of the way down or up."""
    if way == "down":
        step = analysis_steps(plane, level + 1, mode)[level]
        return (
            Shown(f"level {level}", to_picture(gray(step.image)), step.image),
            Shown(
                "smoothed",
                to_picture(gray(step.smooth)),
                step.smooth,
                "",
                "Smoothed with 1 4 6 4 1 along both axes.",
            ),
            Shown(
                f"reduced: level {level + 1}",
                to_picture(gray(step.reduced)),
                step.reduced,
                "",
                "Every second sample.",
            ),
            Shown("expanded", to_picture(gray(step.expanded)), step.expanded),
            Shown("the band", to_picture(signed(step.band)), step.band, "", "The level less what was expanded."),
        )
    steps = analysis_steps(plane, most, mode)
    back = synthesis_steps(steps, mode)[most - 1 - level]
    off = float(np.abs(back.image - steps[level].image).max())
    return (
        Shown(f"level {level + 1}, expanded", to_picture(gray(back.expanded)), back.expanded),
        Shown("+ the band", to_picture(signed(back.band)), back.band),
        Shown(f"= level {level}", to_picture(gray(back.image)), back.image, "", f"At most {off:.1g} off."),
    )
