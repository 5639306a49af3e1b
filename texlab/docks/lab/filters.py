"""Spots and bars at any scale: absolute responses, and kernel and footprint of the filter under the pointer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QHBoxLayout

from texlab.docks.base import Question
from texlab.docks.lab.page import MARGINS, LabPage, Pictures, Shown, looker, plane_of
from texlab.docks.recent import Recent, Same
from texlab.style.pictures import to_picture
from texlab_core.sheets.laboratory import enlarged, gray, signed
from texlab_core.transforms import spots_bars

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import numpy as np
    from numpy.typing import NDArray

    from texlab.state.scene import Scene

_SIDE = 128


@dataclass(frozen=True, eq=False)
class FiltersAnswer:
    """Responses of one scale, (8, H, W), and what is painted."""

    responses: NDArray[np.float32]
    white: float
    shown: tuple[Shown, ...]
    details: tuple[tuple[Shown, Shown], ...]


@lru_cache(maxsize=spots_bars.FILTERS)
def filter_pictures(number: int, scale: float) -> tuple[Shown, Shown]:
    """Return kernel and footprint of a filter."""
    kernel = spots_bars.scaled_kernels(scale)[number]
    side = max(_SIDE, kernel.shape[0])
    footprint = spots_bars.footprint(kernel, (side, side))
    return (
        Shown.of(short_name(number), enlarged(signed(kernel), _SIDE)),
        Shown("footprint", to_picture(gray(footprint, float(footprint.max()))), footprint),
    )


def short_name(number: int) -> str:
    """Return a filter's name for a small place: bars by the angle of the waves that they answer to."""
    spots = len(spots_bars.SPOTS)
    return f"spot {number + 1}" if number < spots else f"bar {180 * (number - spots) // spots_bars.BARS}°"


class FiltersPage(LabPage):
    """Shows the filter bank."""

    name = "lab-filters"
    title = "Filters"
    help = "Spots and bars at any scale: absolute responses, kernels and footprints (Figs. 11.3 to 11.5)."
    empty = "Responses appear as soon as there is an exemplar."

    def build(self) -> Iterator[None]:
        """Make the controls and the pictures."""
        self._recent = Recent(8)
        tip = "What all lengths of the filters are multiplied by; 2 to 4 find broad bars"
        self.scale = self.add_real("scale", "scale", tip, (*spots_bars.SCALES, 0.5), self.ask)
        self.scale.setDecimals(1)
        self.readout = self.add_readout()
        self.pictures = Pictures("lab-filters-responses", spots_bars.FILTERS)
        yield
        self.details = Pictures("lab-filters-details", 2, linked=False)
        self.pictures.hovered.connect(self._hover)
        self.details.hovered.connect(lambda *at: self.readout.setText(self.details.told(*at)))
        self._number = 2
        row = QHBoxLayout(self.body)
        row.setContentsMargins(*MARGINS)
        row.addWidget(self.pictures, 4)
        row.addWidget(self.details, 1)

    def question(self, scene: Scene) -> Question | None:
        """Ask for the responses of the exemplar."""
        if scene.exemplar is None:
            return None
        pixels, scale, recent = scene.exemplar.pixels, self.scale.value(), self._recent

        def compute(should_stop: Callable[[], bool]) -> FiltersAnswer:
            plane, look = plane_of(pixels), looker(should_stop)
            key = (Same(pixels), scale)
            responses = recent.get(key, lambda: spots_bars.scaled_responses(plane, scale, look))
            magnitude, white = spots_bars.strength(responses)
            shown = tuple(
                Shown(short_name(index), to_picture(gray(each, white)), responses[index])
                for index, each in enumerate(magnitude)
            )
            details = tuple(filter_pictures(index, scale) for index in range(spots_bars.FILTERS))
            return FiltersAnswer(responses, white, shown, details)

        return Question((Same(pixels), scale), compute)

    def show_answer(self, answer: FiltersAnswer) -> None:
        """Show the responses, all on one scale."""
        self.readout.setText("")
        self.pictures.show_pictures(answer.shown)
        self._show_filter()

    def _hover(self, index: int, row: int, column: int) -> None:
        if row >= 0 and index != self._number:
            self._number = index
            self._show_filter()
        self.readout.setText(self.pictures.told(index, row, column))

    def _show_filter(self) -> None:
        answer: FiltersAnswer | None = self.answer
        if answer is not None:
            self.details.show_pictures(answer.details[self._number])
