"""Sheets of the textbook's laboratory: filters, representation, Gabor pairs, equalization, pyramids; in gray.

Zero is mid-gray where values scatter around it; pictures of one row share one scale unless their caption says
more.

Reference: Forsyth and Ponce, Figs. 11.3 to 11.15.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.sheets.contact_sheet import Tile, contact_sheet
from texlab_core.stats import representation as classes
from texlab_core.transforms import spots_bars

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.stats.dependence import Dependence
    from texlab_core.stats.equalization import Equalization
    from texlab_core.stats.frequency_support import Support
    from texlab_core.stats.local_frequency import LocalFrequency
    from texlab_core.stats.representation import Representation
    from texlab_core.transforms.gabor import Response
    from texlab_core.transforms.gabor_pair import GaborPair
    from texlab_core.transforms.pyramid_steps import Down, Up

    Plane = NDArray[np.float32]
    Sheet = NDArray[np.uint8]

_CELL = 256
_FOOTPRINT_SIDE = 256
_PLOT = (192, 256)


def gray(plane: NDArray[Any], white: float = 1.0, black: float = 0.0) -> FloatImage:
    """Return a plane as a picture, (H, W, 1) float32, from black to white."""
    shown: FloatImage = ((plane - black) / max(white - black, 1e-12)).astype(np.float32)
    return np.clip(shown, 0, 1)[..., None]


def signed(plane: NDArray[Any], limit: float | None = None) -> FloatImage:
    """Return a plane as a picture whose mid-gray is 0."""
    largest = float(np.abs(plane).max()) if limit is None else limit
    return gray(plane, largest, -largest)


def enlarged(picture: FloatImage, side: int) -> FloatImage:
    """Repeat the pixels of a small picture as often as they fit into a side."""
    times = max(1, side // max(picture.shape[:2]))
    return picture.repeat(times, axis=0).repeat(times, axis=1)


def hues(degrees: NDArray[Any], saturation: NDArray[Any]) -> FloatImage:
    """Return orientations (0 to 180 degrees) as hues, gray where the saturation is 0, (H, W, 3) float32."""
    phase = degrees[..., None] / 180 + np.array([0, 1 / 3, 2 / 3], np.float32)
    colour = 0.5 + 0.45 * np.cos(2 * np.pi * phase)
    mixed: FloatImage = (0.5 + (colour - 0.5) * saturation[..., None]).astype(np.float32)
    return mixed


def filters_sheet(plane: Plane, scales: Sequence[float]) -> tuple[Sheet, list[Plane]]:
    """Draw the filter bank: for each scale its kernels, their footprints, and absolute responses on one scale.

    Returns
    -------
    sheet
        (H, W, 3) uint8.
    responses
        The responses of each scale, (8, H, W) float32.
    """
    tiles, heads, found = [], [], []
    for scale in scales:
        kernels, responses = spots_bars.scaled_kernels(scale), spots_bars.scaled_responses(plane, scale)
        magnitude, white = spots_bars.strength(responses)
        for number, kernel in enumerate(kernels):
            caption = (spots_bars.filter_name(number),) if scale == scales[0] else ()
            tiles.append(Tile(enlarged(signed(kernel), _CELL), caption))
        for kernel in kernels:
            size = max(_FOOTPRINT_SIDE, kernel.shape[0])
            print_of = spots_bars.footprint(kernel, (size, size))
            tiles.append(Tile(gray(print_of, float(print_of.max()))))
        tiles += [Tile(gray(each, white)) for each in magnitude]
        heads += [f"kernels, scale {scale:g}", "footprints", f"|response|, white {white:.3g}"]
        found.append(responses)
    return contact_sheet(tiles, spots_bars.FILTERS, row_heads=heads, largest=_CELL // 2), found


def representation_sheet(plane: Plane, found: Representation, gathered: NDArray[np.uint8] | None = None) -> Sheet:
    """Draw Fig. 11.6: input, squared derivatives, their local means, classes; and the k-means classes if given."""
    white = float(np.percentile([found.vertical, found.horizontal], 99.5))
    smooth = float(max(found.smooth_vertical.max(), found.smooth_horizontal.max()))
    kinds = ", ".join(
        f"{name} {100 * share:.0f} %" for name, share in zip(classes.CLASS_NAMES, found.shares, strict=True)
    )
    more = Tile(None)
    if gathered is not None:
        more = Tile(gray(gathered, float(gathered.max() or 1)), ("k-means, 24 filters",))
    tiles = [
        Tile(gray(plane), ("input",)),
        Tile(gray(found.vertical, white), ("vertical, squared",)),
        Tile(gray(found.smooth_vertical, smooth), ("vertical, local mean",)),
        Tile(gray(found.classes, 3), ("classes from black to white", kinds)),
        more,
        Tile(gray(found.horizontal, white), ("horizontal, squared",)),
        Tile(gray(found.smooth_horizontal, smooth), ("horizontal, local mean",)),
    ]
    return contact_sheet(tiles, 4, largest=_CELL)


def gabor_sheet(plane: Plane, pair: GaborPair, response: Response, local: LocalFrequency | None = None) -> Sheet:
    """Draw both kernels of a pair and their answers; local wavelength and orientation if given."""
    kernel = pair.kernel()
    limit = float(np.abs(kernel).max())
    strong = float(np.percentile(response.magnitude, 99.5))
    faint = np.clip(response.magnitude / max(0.15 * strong, 1e-9), 0, 1)
    tiles = [
        Tile(gray(plane), ("input",)),
        Tile(enlarged(signed(kernel.real, limit), _CELL), ("symmetric kernel",)),
        Tile(enlarged(signed(kernel.imag, limit), _CELL), ("antisymmetric kernel",)),
        Tile(signed(response.even, strong), ("symmetric answer",)),
        Tile(signed(response.odd, strong), ("antisymmetric answer",)),
        Tile(gray(response.magnitude, strong), (f"magnitude, white {strong:.3g}",)),
        Tile(hues(np.degrees(response.phase).astype(np.float32) / 2 % 180, faint), ("phase; gray where faint",)),
    ]
    if local is not None:
        octaves = np.log2(local.wavelength / 4)
        tiles += [
            Tile(gray(octaves, float(np.log2(12))), ("local wavelength, 4 px black to 48 px white",)),
            Tile(hues(local.orientation, local.coherence), ("local orientation; gray where there is none",)),
        ]
    return contact_sheet(tiles, 4, largest=_CELL)


def equalization_sheet(found: Equalization, one: Plane, result: Plane, value: float | None = None) -> Sheet:
    """Draw Fig. 11.15: both images under their cumulative histograms, the way of one value, and the result."""
    (one_x, one_y), (two_x, two_y) = found.curves()
    low, high = min(one_x[0], two_x[0]), max(one_x[-1], two_x[-1])
    arrow = found.arrow(float(np.median(found.two)) if value is None else value)
    way_two = [(arrow.value, 0.0), (arrow.value, arrow.share), (high, arrow.share)]
    way_one = [(low, arrow.share), (arrow.new_value, arrow.share), (arrow.new_value, 0.0)]
    plots = [
        _curve(list(zip(x.tolist(), y.tolist(), strict=True)), way, low, high)
        for x, y, way in ((two_x, two_y, way_two), (one_x, one_y, way_one))
    ]
    told = f"{arrow.value:.3g} -> {100 * arrow.share:.3g} % -> {arrow.new_value:.3g}"
    tiles = [
        Tile(plots[0], ("image two, cumulative", told)),
        Tile(plots[1], ("image one, cumulative",)),
        Tile(None),
        Tile(gray(found.plane, high, low), ("image two",)),
        Tile(gray(one, high, low), ("image one",)),
        Tile(gray(result, high, low), ("image two with image one's histogram",)),
    ]
    return contact_sheet(tiles, 3, largest=_CELL)


def _curve(
    points: list[tuple[float, float]], way: list[tuple[float, float]], low: float, high: float
) -> FloatImage:
    """Draw a cumulative histogram and a way through it."""
    from PIL import Image, ImageDraw

    many, (height, width) = 3, _PLOT
    image = Image.new("RGB", (width * many, height * many), (255, 255, 255))
    draw = ImageDraw.Draw(image)

    def place(point: tuple[float, float]) -> tuple[float, float]:
        across = (point[0] - low) / max(high - low, 1e-12)
        return (6 + across * (width - 12)) * many, (height - 6 - point[1] * (height - 12)) * many

    draw.rectangle([place((low, 1.0)), place((high, 0.0))], outline=(170, 170, 170), width=many)
    draw.line([place(each) for each in points], (24, 24, 24), 2 * many, joint="curve")
    draw.line([place(each) for each in way], (213, 94, 0), 2 * many)
    small = image.resize((width, height), Image.Resampling.LANCZOS)
    return (np.asarray(small) / 255).astype(np.float32)


def supports_sheet(supports: Sequence[Support], columns: int) -> Sheet:
    """Draw which part of the frequency plane each band keeps (Fig. 11.8); black is nothing, white the most."""
    tiles = [Tile(gray(each.relative), (each.title, f"gain up to {each.gain.max():.2g}")) for each in supports]
    return contact_sheet(tiles, columns, largest=_CELL // 2)


def steps_sheet(down: Sequence[Down], up: Sequence[Up]) -> Sheet:
    """Draw the pyramid step by step: smooth, reduce, expand, subtract, level by level; and back."""
    limit = max(float(np.abs(each.band).max()) for each in down)
    tiles, heads = [], []
    for level, each in enumerate(down):
        shown = (gray(each.image), gray(each.smooth), gray(each.reduced), gray(each.expanded))
        captions = ("image" if level == 0 else "reduced", "smooth", "every second sample", "expanded")
        tiles += [Tile(picture, (words,)) for picture, words in zip(shown, captions, strict=True)]
        tiles.append(Tile(signed(each.band, limit), ("image - expanded",)))
        heads.append(f"down, level {level}")
    for level, back in zip(reversed(range(len(up))), up, strict=True):
        tiles += [Tile(gray(back.expanded), ("expanded",)), Tile(signed(back.band, limit), ("+ band",))]
        tiles += [Tile(gray(back.image), ("= image",)), Tile(None), Tile(None)]
        heads.append(f"up, level {level}")
    return contact_sheet(tiles, 5, row_heads=heads, largest=_CELL // 2)


def dependence_sheet(shown: Sequence[tuple[str, Plane, Dependence]]) -> Sheet:
    """Draw, for every (name, plane (H, W), what its bands have to do with each other), both histograms.

    What is given grows to the right, what is looked at upwards. Black: none; the joint histogram by the root of
    its shares, every column of the conditional one up to its own largest share.
    """
    tiles = []
    for name, plane, found in shown:
        joint, conditional = found.joint[::-1], found.conditional[::-1]
        largest = conditional.max(axis=0)
        columns = conditional / np.where(largest > 0, largest, 1)
        tiles += [
            Tile(gray(plane), (name,)),
            Tile(enlarged(gray(np.sqrt(joint / joint.max())), _CELL), ("joint histogram", found.pair.title())),
            Tile(enlarged(gray(columns), _CELL), ("conditional histogram", f"{found.information:.3f} bits")),
        ]
    return contact_sheet(tiles, 3, largest=_CELL)
