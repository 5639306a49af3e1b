"""What the Code tab says: names of octaves and angles, headings and tips of the groups of numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.transforms.gabor_bank import CENTRE_FREQUENCIES, CENTRE_ORIENTATIONS

if TYPE_CHECKING:
    from texlab.docks.spectral.code_numbers import Group

OCTAVE_NAMES = [f"1/{round(1 / frequency)}" for frequency in CENTRE_FREQUENCIES]
ANGLE_NAMES = [f"{angle:.0f}°" for angle in CENTRE_ORIENTATIONS]
RESIDUAL_NAMES = ["mean", "u axis", "v axis", "falling", "rising"]
HINT = (
    "Drag a cell up or down (Shift: finely), type a number, or press + and -; Delete empties it. "
    "A corner marks what is not as it was measured."
)
TIPS: dict[Group, str] = {
    "energy": "Rms of the 16 Gabor channels in per cent of the mean gray level (Table 2 of the paper). "
    "The histogram sets the contrast of the whole, so that the proportions count.",
    "u": "Equivalent bandwidth along the horizontal frequency axis in per cent of the filter's width; "
    "white noise has 71, a pure wave nearly 0.",
    "v": "Equivalent bandwidth along the vertical frequency axis in per cent of the filter's width.",
    "residual": "The low-pass residual: mean gray level, and mean moduli on both axes and in both quadrants.",
    "histogram": "The histogram in 16 numbers, from black to white. Lines: the exemplar's.",
}
HEADINGS: dict[Group, str] = {
    "energy": "Energies, % of mean",
    "u": "Bandwidths u, % of filter",
    "v": "Bandwidths v, % of filter",
    "residual": "Residual",
    "histogram": "Histogram",
}

# Where the bandwidths belong to the waves of each channel.
RADIAL: dict[Group, str] = HEADINGS | {
    "u": "Radial bandwidths, % of filter",
    "v": "Angular bandwidths, % of filter",
}


def short(shown: float, group: Group) -> str:
    """Return a number with as many digits as a cell has room for."""
    if group in ("u", "v"):
        return f"{shown:.0f}"
    return f"{shown:.2f}" if shown < 10 else f"{shown:.1f}" if shown < 100 else f"{shown:.0f}"
