"""One Gabor pair with free parameters, and the wavelength and orientation around every pixel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab.docks.base import Question
from texlab.docks.lab.page import LabPage, Shown, looker, plane_of
from texlab.docks.recent import Recent, Same
from texlab.style.pictures import to_picture
from texlab_core.sheets.laboratory import enlarged, gray, hues, signed
from texlab_core.stats.local_frequency import LocalFrequency, local_frequency
from texlab_core.transforms.gabor_pair import LONGEST, SHORTEST, GaborPair

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.scene import Scene
    from texlab_core.stats.local_frequency import Plane

VIEWS = (("One pair", "pair"), ("Local frequency", "local"))
_KERNEL_SIDE = 128
_FAINT = 0.15


class GaborPairPage(LabPage):
    """Shows a pair of kernels and their answers."""

    name = "lab-gabor"
    title = "Gabor pair"
    help = (
        "A Gabor pair with free wavelength, orientation, width and phase; local frequency (Figs. 11.9 to 11.11)."
    )
    empty = "Answers appear as soon as there is an exemplar."

    def build(self) -> None:
        """Make the controls and the pictures."""
        self._recent = Recent(2)
        tip = "One pair on the exemplar, or which of 120 pairs prevails around each pixel"
        self.view = self.add_choice("view", "What is shown", tip, VIEWS, self._view_changed)
        tip = "Pixels from one stripe to the next"
        self.wavelength = self.add_real("wavelength", "wavelength", tip, (SHORTEST, LONGEST, 0.5), self.ask, " px")
        self.wavelength.setValue(8)
        tip = "Orientation of the wave: 0° for vertical stripes, 90° for horizontal ones"
        self.orientation = self.add_angle("orientation", "orientation", tip, (0, 179), 0, self.ask)
        tip = "Deviation of the Gaussian in wavelengths; a wide one tells frequencies better and places worse"
        self.sigma = self.add_real("sigma", "sigma", tip, (0.25, 2, 0.05), self.ask, " waves")
        self.sigma.setValue(0.5)
        tip = "Phase of the symmetric kernel's cosine: 90° makes it the antisymmetric one"
        self.phase = self.add_angle("phase", "phase", tip, (0, 359), 0, self.ask)
        self.lay_out(7, linked=False)

    def _view_changed(self) -> None:
        pair = self.view.currentData() == "pair"
        for control in (self.wavelength, self.orientation, self.sigma, self.phase):
            control.setVisible(pair)
        self.ask()

    def question(self, scene: Scene) -> Question | None:
        """Ask for the answers of the pair, or for the local frequency."""
        if scene.exemplar is None:
            return None
        pixels, recent = scene.exemplar.pixels, self._recent
        if self.view.currentData() == "local":

            def analyze(should_stop: Callable[[], bool]) -> tuple[Shown, ...]:
                plane, look = plane_of(pixels), looker(should_stop)
                found = recent.get(Same(pixels), lambda: local_frequency(plane, look))
                return local_pictures(plane, found)

            return Question(("local", Same(pixels)), analyze)
        wavelength = self.wavelength.value()
        sigma = min(max(wavelength * self.sigma.value(), 0.5), 128.0)
        pair = GaborPair(wavelength, self.orientation.value(), sigma, self.phase.value())

        def compute(should_stop: Callable[[], bool]) -> tuple[Shown, ...]:
            return pair_pictures(plane_of(pixels), pair)

        return Question((Same(pixels), pair), compute)

    def show_answer(self, answer: tuple[Shown, ...]) -> None:
        """Show the pictures."""
        self.readout.setText("")
        self.pictures.show_pictures(answer)


def pair_pictures(plane: Plane, pair: GaborPair) -> tuple[Shown, ...]:
    """Return both kernels and what they answer."""
    response, kernel = pair.respond(plane), pair.kernel()
    limit = float(np.abs(kernel).max())
    magnitude, phase = response.magnitude, np.degrees(response.phase)
    strong = max(float(np.percentile(magnitude[::2, ::2], 99.5)), 1e-9)
    seen = np.clip(magnitude / (_FAINT * strong), 0, 1)
    return (
        Shown("exemplar", to_picture(gray(plane)), plane),
        Shown("even kernel", to_picture(enlarged(signed(kernel.real, limit), _KERNEL_SIDE))),
        Shown("odd kernel", to_picture(enlarged(signed(kernel.imag, limit), _KERNEL_SIDE))),
        Shown("even answer", to_picture(signed(response.even, strong)), response.even),
        Shown("odd answer", to_picture(signed(response.odd, strong)), response.odd),
        Shown("magnitude", to_picture(gray(magnitude, strong)), magnitude),
        Shown("phase", to_picture(hues(phase / 2 % 180, seen)), phase, "°", "Local phase; gray where faint."),
    )


def local_pictures(plane: Plane, found: LocalFrequency) -> tuple[Shown, ...]:
    """Return the maps of the local frequency."""
    octaves = np.log2(found.wavelength / 4)
    return (
        Shown("exemplar", to_picture(gray(plane)), plane),
        Shown(
            "wavelength", to_picture(gray(octaves, 3.585)), found.wavelength, " px", "4 px black to 48 px white."
        ),
        Shown(
            "orientation",
            to_picture(hues(found.orientation, found.coherence)),
            found.orientation,
            "°",
        ),
        Shown("coherence", to_picture(gray(found.coherence)), found.coherence),
    )
