"""Which part of the frequency plane each band of a pyramid keeps, over the exemplar's spectrum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab.docks.base import Question
from texlab.docks.frame import replace_items
from texlab.docks.lab.page import LabPage, Shown, plane_of
from texlab.docks.recent import Recent, Same
from texlab.style.pictures import to_picture
from texlab_core.sheets.laboratory import gray, signed
from texlab_core.stats import frequency_support
from texlab_core.stats.bands import band_keys, most_levels, names, split
from texlab_core.stats.spectrum import power_spectrum

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.scene import Scene
    from texlab_core.engine.steps import FloatImage
    from texlab_core.stats.pyramid_kinds import PyramidKind

KINDS: tuple[PyramidKind, ...] = ("steerable", "laplacian", "gaussian", "oriented", "gabor", "filter bank")
OUTLINE = (255, 95, 176)
# The largest side of the frequency plane; larger exemplars are shown on a plane of this size.
_SIDE = 256
_COLOURS = np.array(
    [
        (0, 114, 178),
        (230, 159, 0),
        (0, 158, 115),
        (240, 228, 66),
        (86, 180, 233),
        (213, 94, 0),
        (204, 121, 167),
        (150, 150, 150),
    ],
    np.float32,
)


@dataclass(frozen=True, eq=False)
class SupportAnswer:
    """What is painted, and which band has the largest gain at each place of the plane."""

    shown: tuple[Shown, ...]
    strongest: np.ndarray[Any, np.dtype[np.int64]]


class SupportPage(LabPage):
    """Shows the annulus or wedge of a band."""

    name = "lab-support"
    title = "Support"
    help = "Which ring or wedge of the frequency plane a band keeps, over the exemplar's spectrum (Fig. 11.8)."
    empty = "The frequency plane appears as soon as there is an exemplar."

    def build(self) -> None:
        """Make the controls and the pictures."""
        self._recent = Recent(4)
        kinds = [(kind, kind) for kind in KINDS]
        self.kind = self.add_choice("kind", "Pyramid", "Which pyramid", kinds, self.ask)
        self.levels = self.add_number("levels", "levels", "Levels besides the residual", (0, 8), self.ask)
        self.levels.setValue(3)
        self.orientations = self.add_number(
            "orientations", "K", "Orientations, where it has any", (1, 18), self.ask
        )
        self.orientations.setValue(4)
        self.band = self.add_choice("band", "Band", "Which band; or click its part of the plane", [], self.ask)
        self.lay_out(4, linked=False)
        self.pictures.clicked.connect(self._clicked)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the supports of the chosen pyramid on the exemplar's plane."""
        if scene.exemplar is None:
            return None
        pixels, kind = scene.exemplar.pixels, self.kind.currentData()
        levels = min(self.levels.value(), most_levels(pixels.shape[:2], kind))
        orientations = self.orientations.value()
        keys = band_keys(kind, levels, orientations)
        items: list[tuple[str, Any]] = [
            (names(key, kind, orientations)[0], place) for place, key in enumerate(keys)
        ]
        first = not self.band.count()
        replace_items(self.band, items)
        if first:
            # An oriented band of a middle level shows a wedge.
            self.band.setCurrentIndex(min(1 + orientations, self.band.count() - 1))
        band, recent = self.band.currentData(), self._recent
        settings = (kind, levels, orientations)

        def compute(should_stop: Callable[[], bool]) -> SupportAnswer:
            size = (min(pixels.shape[0], _SIDE), min(pixels.shape[1], _SIDE))
            key = (size, settings)
            found = recent.get(key, lambda: frequency_support.supports(kind, size, levels, orientations))
            return support_pictures(pixels, found, band, settings)

        return Question((Same(pixels), settings, band), compute)

    def drop_kept(self) -> None:
        """Let go of the bands' planes: they are of no exemplar, and would stay."""
        self._recent.clear()

    def show_answer(self, answer: SupportAnswer) -> None:
        """Show the pictures."""
        self.readout.setText("")
        self.pictures.show_pictures(answer.shown)

    def _clicked(self, index: int, row: int, column: int) -> None:
        answer: SupportAnswer | None = self.answer
        if answer is None or index > 2:
            return
        height, width = answer.strongest.shape
        if 0 <= row < height and 0 <= column < width:
            self.band.setCurrentIndex(self.band.findData(int(answer.strongest[row, column])))
            self.ask()


def support_pictures(
    pixels: FloatImage,
    found: tuple[frequency_support.Support, ...],
    band: int,
    settings: tuple[PyramidKind, int, int],
) -> SupportAnswer:
    """Return the exemplar's spectrum with the band's outline, its gain, all bands, and the band itself."""
    import cv2

    support, plane = found[band], plane_of(pixels)
    height, width = support.gain.shape
    spectrum = power_spectrum(plane[..., None]).log_picture()
    if spectrum.shape != (height, width):
        spectrum = np.asarray(cv2.resize(spectrum, (width, height), interpolation=cv2.INTER_AREA), np.float32)
    painted = to_picture(gray(spectrum, max(float(np.percentile(spectrum, 99.9)), 1.0)))
    inside = support.outline().astype(np.uint8)
    edge = cv2.morphologyEx(inside, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)) > 0
    painted[edge] = OUTLINE
    relative = np.stack([each.relative for each in found])
    strongest = relative.argmax(axis=0)
    colours = _COLOURS[strongest % len(_COLOURS)] * (0.25 + 0.75 * relative.max(axis=0))[..., None]
    kind, levels, orientations = settings
    bands = split(plane, kind, levels, orientations)
    kept = bands[min(band, len(bands) - 1)].plane
    shown = gray(kept) if support.key.kind == "lowpass" else signed(kept)
    return SupportAnswer(
        (
            Shown(
                "spectrum, outlined",
                painted,
                spectrum,
                " dB",
                "The exemplar's spectrum; outlined: half the band's gain.",
            ),
            Shown("gain", to_picture(gray(support.relative)), support.gain, "", f"Gain of {support.title}."),
            Shown("all bands: click one", colours.astype(np.uint8), strongest),
            Shown("the band", to_picture(shown), kept, "", f"The exemplar's {support.title}."),
        ),
        strongest,
    )
