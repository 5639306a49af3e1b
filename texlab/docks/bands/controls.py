"""The controls that choose a pyramid and a plane, and the subbands that they stand for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt

from texlab.docks.bands.middle import middle_of
from texlab.docks.recent import Recent, Same
from texlab.widgets.plain import set_tip, tip_text
from texlab_core.errors import Cancelled
from texlab_core.stats.bands import WITH_ORIENTATIONS, WITH_SCALES, channel_names, projection, split

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.docks.frame import FramedDock
    from texlab.state.scene import Scene
    from texlab_core.engine.steps import FloatImage
    from texlab_core.stats.bands import Band, Channel
    from texlab_core.stats.pyramid_kinds import PyramidKind

# Name and description of every kind.
KINDS: dict[PyramidKind, tuple[str, str]] = {
    "steerable": ("Steerable", "Oriented bands per scale, and two residuals; they add up to the image"),
    "laplacian": ("Laplacian", "What each scale has beyond the next coarser one; they add up to the image"),
    "gaussian": ("Gaussian", "The image, smoothed and halved again and again"),
    "oriented": (
        "Derivatives",
        "First (edges) and second (lines) derivatives of every level: the features of De Bonet. "
        "His threshold table counts angles counter-clockwise, this tab clockwise",
    ),
    "gabor": ("Gabor", "Symmetric Gabor filters, four octaves by four orientations, as in the MSG method"),
    "gabor magnitude": ("Gabor, magnitude", "Local amplitude of Gabor filters in quadrature"),
    "filter bank": ("Filter bank", "Two spots and six bars on every level (Forsyth and Ponce, Fig. 11.3)"),
}
CACHE_BYTES = 96 * 2**20
DEFAULT_SCALES, DEFAULT_ORIENTATIONS = 4, 4


@dataclass(frozen=True)
class PyramidSettings:
    """What the controls say."""

    kind: PyramidKind
    levels: int
    orientations: int


class BandCache:
    """The subbands that were looked at last, bounded in bytes."""

    def __init__(self) -> None:
        self._recent = Recent(CACHE_BYTES, lambda bands: sum(band.plane.nbytes for band in bands))

    def clear(self) -> None:
        """Forget everything."""
        self._recent.clear()

    def bands(
        self,
        image: FloatImage,
        exemplar: FloatImage,
        channel: Channel,
        settings: PyramidSettings,
        should_stop: Callable[[], bool],
    ) -> tuple[Band, ...]:
        """Return the subbands of an image's plane, of a large one those of its middle.

        Principal axes are those of the exemplar. Raises ``Cancelled`` when ``should_stop`` says so.
        """

        def look() -> None:
            if should_stop():
                raise Cancelled

        def make() -> tuple[Band, ...]:
            plane = projection(middle_of(exemplar), channel).plane(middle_of(image))
            return split(plane, settings.kind, settings.levels, settings.orientations, look)

        return self._recent.get((Same(image), Same(exemplar), channel, settings), make)


def channel_items(channels: int) -> list[tuple[str, Any]]:
    """Return the planes of an image as (text, value) for a list."""
    names = channel_names(channels)
    if len(names) == 1:
        return [("gray", names[0])]
    return [(name.replace("axis", "principal axis"), name) for name in names]


class PyramidControls:
    """Kind, number of scales and orientations.

    Scales and orientations are those of the chosen column's parameters (where it has such) until the user says
    otherwise; choosing another column, or changing its parameters, sets them again.
    """

    def __init__(self, dock: FramedDock, kinds: tuple[PyramidKind, ...]) -> None:
        items = [(KINDS[kind][0], kind) for kind in kinds]
        self.kind = dock.add_choice("kind", "Pyramid", "", items, self._changed)
        for place, kind in enumerate(kinds):
            self.kind.setItemData(place, tip_text(KINDS[kind][1]), Qt.ItemDataRole.ToolTipRole)
        self._describe()
        tip = "Number of scales; follows the chosen column until it is changed here"
        self.scales = dock.add_number("scales", "scales", tip, (0, 8), dock.ask)
        tip = "Oriented bands per scale; follows the chosen column until it is changed here"
        self.orientations = dock.add_number("orientations", "orientations", tip, (1, 18), dock.ask)
        self._dock = dock
        self._followed: tuple[object, ...] = ()
        self._set(DEFAULT_SCALES, DEFAULT_ORIENTATIONS)

    @property
    def settings(self) -> PyramidSettings:
        """What the controls say."""
        kind = self.kind.currentData()
        # What the kind does not have stays 1, so that nothing is computed again when it changes.
        scales = self.scales.value() if kind in WITH_SCALES else 1
        return PyramidSettings(kind, scales, self.orientations.value() if kind in WITH_ORIENTATIONS else 1)

    def follow(self, scene: Scene) -> None:
        """Take scales and orientations of the chosen column when it, or they, have changed."""
        column = scene.selected
        if column is None:
            return
        scales = getattr(column.params, "scales", None)
        orientations = getattr(column.params, "orientations", None)
        followed = (column.id, scales, orientations)
        if followed != self._followed:
            self._followed = followed
            self._set(
                scales if isinstance(scales, int) else DEFAULT_SCALES,
                orientations if isinstance(orientations, int) else DEFAULT_ORIENTATIONS,
            )

    def show(self, visible: bool) -> None:
        """Show the controls that matter."""
        kind = self.kind.currentData()
        self.scales.setVisible(visible and kind in WITH_SCALES)
        self.orientations.setVisible(visible and kind in WITH_ORIENTATIONS)

    def _set(self, scales: int, orientations: int) -> None:
        for box, value in ((self.scales, scales), (self.orientations, orientations)):
            blocked = box.blockSignals(True)
            box.setValue(value)
            box.blockSignals(blocked)

    def _describe(self) -> None:
        set_tip(self.kind, f"How the image is split. {KINDS[self.kind.currentData()][1]}")

    def _changed(self) -> None:
        self._describe()
        self.show(True)
        self._dock.ask()
