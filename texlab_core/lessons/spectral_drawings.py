"""Drawings of the multiscale Gabor scheme: Navarro and Portilla, Figs. 2, 4, 5 and 7, Tables 1 and 2."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.params import Params
from texlab_core.lessons.drawing import Drawn, Kind
from texlab_core.lessons.plots import curves, table
from texlab_core.sheets.contact_sheet import Tile, contact_sheet
from texlab_core.sheets.laboratory import enlarged, gray

if TYPE_CHECKING:
    from texlab_core.lessons.drawing import Scene

_SIDE, _CELL = 256, 320
_OCTAVES = ("1/32", "1/16", "1/8", "1/4")
_ANGLES = ("0°", "45°", "90°", "135°")


@dataclass(frozen=True, kw_only=True)
class Settings(Params):
    """Nothing to set."""


def _filters(settings: Settings, scene: Scene) -> Drawn:
    from texlab_core.transforms import gabor_bank as bank

    u, v = bank.channel_profiles(_SIDE, vertical=False), bank.channel_profiles(_SIDE, vertical=True)
    # Amplitudes of the sixteen filters and their mirror images.
    amplitude = np.sqrt(v[:, :, None] * u[:, None, :])
    mirror = np.sqrt(bank.mirrored(v)[:, :, None] * bank.mirrored(u)[:, None, :])
    plane = np.fft.fftshift(np.maximum(amplitude, mirror).max(axis=0))
    middle = _SIDE // 2
    axis = np.arange(middle) / _SIDE
    rows = [(axis, amplitude[4 * octave, 0, :middle]) for octave in range(bank.OCTAVES)]
    tiles = [
        Tile(gray(plane), ("the sixteen filters and their mirror images",)),
        Tile(curves(rows, (_SIDE, _CELL), bottom=0), ("cut along the u axis, 0 to 1/2 cycles per pixel",)),
    ]
    return Drawn(contact_sheet(tiles, 2, largest=_CELL), ("4 octaves x 4 orientations",))


def _regions(settings: Settings, scene: Scene) -> Drawn:
    from texlab_core.transforms import gabor_bank as bank

    reach = bank.residual_reach(_SIDE)
    u, v = bank.channel_profiles(_SIDE, vertical=False)[:4], bank.channel_profiles(_SIDE, vertical=True)[:4]
    lowest = np.sqrt(v[:, :, None] * u[:, None, :]).max(axis=0)
    lowest = np.fft.fftshift(np.maximum(lowest, bank.mirrored(bank.mirrored(lowest).T).T))
    cut = slice(_SIDE // 2 - 16, _SIDE // 2 + 17)
    places = np.arange(-16, 17)
    inside = (np.abs(places)[:, None] <= reach) & (np.abs(places)[None, :] <= reach)
    first = np.where(inside[..., None], (0.84, 0.37, 0.0), gray(lowest[cut, cut])).astype(np.float32)
    # Mean, the two axes, and the quadrants by the sign of u times v.
    across, down = np.meshgrid(places, places)
    shown = np.ones((*inside.shape, 3), np.float32)
    paint = (
        (inside & (across * down > 0), (0.0, 0.45, 0.70)),
        (inside & (across * down < 0), (0.0, 0.62, 0.45)),
        (inside & (down == 0), (0.90, 0.62, 0.0)),
        (inside & (across == 0), (0.80, 0.47, 0.65)),
        ((across == 0) & (down == 0), (0.1, 0.1, 0.1)),
    )
    for where, colour in paint:
        shown[where] = colour
    middle = shown[16 - reach - 1 : 16 + reach + 2, 16 - reach - 1 : 16 + reach + 2]
    tiles = [
        Tile(enlarged(first, _CELL), ("vermilion: the low-pass residual", "white: the lowest four filters")),
        Tile(
            enlarged(middle, _CELL), ("its five regions: mean, two axes,", "quadrants of equal and unequal sign")
        ),
    ]
    return Drawn(contact_sheet(tiles, 2, largest=_CELL), (f"frequencies up to {reach}/{_SIDE} along each axis",))


def _histogram(settings: Settings, scene: Scene) -> Drawn:
    from texlab_core.methods.spectral.marginal import encode_histogram, gray_level_distance

    counts = np.bincount(np.rint(scene.plane() * 255).astype(np.int64).reshape(-1), minlength=256)
    masses = counts / counts.sum()
    coded = encode_histogram(masses)
    levels = np.arange(256.0)
    picture = curves([(levels, masses), (levels, coded.masses())], (_SIDE, 2 * _CELL), bottom=0)
    tiles = [Tile(picture, ("black: 256 gray levels", f"vermilion: from 16 numbers ({coded.kind})"))]
    distance = gray_level_distance(masses, coded.masses())
    return Drawn(contact_sheet(tiles, 1, largest=2 * _CELL), (f"{distance:.2f} gray levels apart on average",))


def _code(settings: Settings, scene: Scene) -> Drawn:
    details: Any = scene.made().details
    code = details.code
    rms = code.rms_table()
    rows: list[tuple[str, ...]] = [("cycles/px", *_ANGLES)]
    rows += [(name, *(f"{each:.1f}" for each in line)) for name, line in zip(_OCTAVES, rms, strict=True)]
    energies = table(rows, shade=np.asarray(rms / max(float(rms.max()), 1e-9)))
    counted = [
        ("what", "numbers"),
        ("energies of the channels", "16"),
        ("bandwidths along u and v", "32"),
        ("low-pass residual", "5"),
        ("histogram", "16"),
        ("gray texture", "69"),
        ("this texture", f"{code.parameters}"),
    ]
    tiles = [
        Tile(table(counted), ("Table 1: what the code holds",)),
        Tile(energies, ("Table 2: rms in percent of the mean",)),
    ]
    lowest, angle = np.unravel_index(int(rms.argmax()), rms.shape)
    line = f"the strongest channel is {_OCTAVES[lowest]} cycles per pixel at {_ANGLES[angle]}, {rms.max():.1f} %"
    return Drawn(contact_sheet(tiles, 2, largest=480), (line,))


def _samples(settings: Settings, scene: Scene) -> Drawn:
    from texlab_core.methods.spectral import acf, car

    reach = acf.REACH
    side = 2 * reach + 1
    flat = np.arange(side * side).reshape(side, side)
    half = flat >= side * side // 2
    one = np.where(half[..., None], (0.0, 0.45, 0.70), (0.85, 0.92, 0.97)).astype(np.float32)
    two = np.ones((reach + 1, side, 3), np.float32)
    for up, left in car.OFFSETS:
        two[reach - up, reach - left] = (0.0, 0.45, 0.70)
    two[reach, reach] = (0.84, 0.37, 0.0)
    tiles = [
        Tile(
            _grid(one), ("AC-H: the centre of the autocorrelation", f"{acf.PARAMETERS} samples, the rest mirrors")
        ),
        Tile(_grid(two), ("CAR: the neighbours of a pixel", f"{car.COEFFICIENTS} coefficients")),
    ]
    return Drawn(contact_sheet(tiles, 2, largest=_CELL))


def _grid(cells: Any) -> Any:
    """Enlarge cells with white lines between them."""
    large = enlarged(cells, 24 * max(cells.shape[:2]))
    large[::24] = large[:, ::24] = 1
    return large


KINDS = {
    "msg-filters": Kind(Settings, _filters, needs=()),
    "msg-regions": Kind(Settings, _regions, needs=()),
    "msg-histogram": Kind(Settings, _histogram),
    "msg-code": Kind(Settings, _code, ("exemplar", "result"), ("msg",)),
    "sampled-statistics": Kind(Settings, _samples, needs=()),
}
