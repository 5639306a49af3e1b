"""Figures of the help page of solid textures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.figures import Figure
from texlab_core.figures._charts import Line, log_chart
from texlab_core.figures._tools import PAGE_WIDTH, make, page, texture, title_of
from texlab_core.images.exemplar import as_exemplar
from texlab_core.sheets.contact_sheet import Tile
from texlab_core.solids.pictures import middle, picture_of, slice_at
from texlab_core.solids.rendering import View, render, render_wrapped
from texlab_core.stats.solids import streaks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage, FloatVolume
    from texlab_core.solids.pictures import Cut

SIDE = 64
PAPER = (255, 255, 255)


def _volume(name: str, **values: Any) -> FloatVolume:
    volume = make("solid", texture(name, 96), SIDE, **values).volume
    assert volume is not None
    return volume


def _cut(volume: FloatVolume, cut: Cut) -> FloatImage:
    return _floats(picture_of(slice_at(volume, cut, middle(volume.shape)), 2))


def _floats(picture: NDArray[np.uint8]) -> FloatImage:
    return (picture / np.float32(255)).astype(np.float32)


def slices() -> NDArray[np.uint8]:
    """Show exemplars, slices along the three axes, and the block: colour and grain come, shapes do not."""
    tiles = []
    for name in ("stochastic-granite", "structured-pebbles", "oriented-woodgrain"):
        exemplar, volume = texture(name, 96), _volume(name, kind="mixed", iterations=3)
        part = picture_of(exemplar.pixels[:SIDE, :SIDE], 2)
        tiles.append(Tile(_floats(part), (title_of(name),)))
        cuts: tuple[Cut, ...] = ("xy", "xz", "yz")
        tiles += [Tile(_cut(volume, cut), (f"slice {cut}",)) for cut in cuts]
        block = render(volume, View(), (2 * SIDE, 2 * SIDE), background=PAPER, smooth=True)
        tiles.append(Tile(_floats(block), ("carved",)))
    return page(tiles, 5)


def pooled_and_per_slice() -> NDArray[np.uint8]:
    """Show what matching every slice by itself does to the other two cuts."""
    tiles = []
    for name in ("inhomogeneous-rust", "stochastic-lava"):
        gray = as_exemplar(texture(name, 96).pixels.mean(axis=-1), name=name)
        for choice in ("pooled", "per-slice"):
            volume = make("solid", gray, SIDE, kind="mixed", histograms=choice).volume
            assert volume is not None
            caption = (f"{title_of(name)}, {choice}", f"streaks {streaks(volume[..., 0]):.1f}")
            tiles.append(Tile(_cut(volume, "yz"), caption))
    return page(tiles, 4)


def objects() -> NDArray[np.uint8]:
    """Show objects cut from a solid over the same objects with the exemplar wrapped around them."""
    exemplar, volume = texture("stochastic-cork", 96), _volume("stochastic-cork")
    views = [View("block"), View("sphere"), View("cylinder"), View("torus", pitch=35)]
    size = (168, 168)
    cut = [render(volume, view, size, background=PAPER, smooth=True) for view in views]
    worn = [
        render_wrapped(exemplar.pixels, volume.shape, view, size, background=PAPER, smooth=True) for view in views
    ]
    tiles = [Tile(_floats(picture), (f"{view.shape}, cut",)) for picture, view in zip(cut, views, strict=True)]
    tiles += [
        Tile(_floats(picture), (f"{view.shape}, wrapped",)) for picture, view in zip(worn, views, strict=True)
    ]
    return page(tiles, 4)


def rounds_of_bands() -> NDArray[np.uint8]:
    """Show bands that climb in plain rounds before they fall, and the same bands in balanced ones."""
    lines = []
    for name, band in (
        ("quasiperiodic-knit", "l2"),
        ("inhomogeneous-litbrick", "l3"),
        ("manmade-ribs", "l3"),
    ):
        half = as_exemplar(f"gallery:{name}", scale=0.5)
        gray = as_exemplar(half.pixels.mean(axis=-1), name=name)
        for balance in (False, True):
            curve = make("solid", gray, SIDE, iterations=12, balance=balance).curves[f"band-{band}"]
            label = f"{title_of(name)}, {band}, {'balanced' if balance else 'plain'}"
            lines.append(Line(label, curve.x.tolist(), curve.y.tolist()))
    return log_chart(
        lines,
        x_label="rounds",
        y_label="distance of one band before matching (W1 / standard deviation)",
        y_range=(0.02, 3.0),
        size=(300, PAGE_WIDTH),
    )


FIGURES = (
    Figure("solid-slices.jpg", "Slices have the exemplar's colours and grain, not its shapes.", slices),
    Figure("solid-streaks.jpg", "Slices matched together, and one by one.", pooled_and_per_slice),
    Figure("solid-bands.png", "Bands that climb in plain rounds, and the same in balanced ones.", rounds_of_bands),
    Figure("solid-objects.jpg", "Cut from a solid, and wrapped in an image.", objects),
)
