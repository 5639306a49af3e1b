"""Exemplars of the program's own for the stories that the papers and the textbook tell.

``python -m texlab_core.figures._exemplars FOLDER`` draws them; the gallery holds them as they are drawn here.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Picture = NDArray[np.uint8]

SIDE = 256
LINES = 14
_MANY = 3
_TEXT = (
    "A texture looks the same wherever a window",
    "is laid on it, as long as the window is not",
    "too small. Grass does, and sand, and a wall",
    "of bricks; a face does not, nor a letter by",
    "itself. A page of letters seen from afar is",
    "a texture again: gray lines, evenly spaced,",
    "with ragged gaps where one word ends and an",
    "other begins. How many lines are there? One",
    "who counts them finds fourteen; whoever only",
    "looks is content with twelve or sixteen, for",
    "the eye takes the spacing, and not the count.",
    "So does a code of sixty nine numbers, which",
    "keeps how often things come back, and loses",
    "where they were. Read on and see for yourself.",
)


def smooth_noise(rng: np.random.Generator, wavelength: float, side: int = SIDE) -> Floats:
    """Return periodic noise without waves shorter than a wavelength, of mean 0 and deviation 1."""
    v, u = np.fft.fftfreq(side)[:, None], np.fft.rfftfreq(side)[None, :]
    spectrum = np.fft.rfft2(rng.standard_normal((side, side)))
    spectrum *= np.exp(-((np.hypot(u, v) * wavelength) ** 2))
    spectrum[0, 0] = 0
    plane: Floats = np.fft.irfft2(spectrum, (side, side))
    plane /= plane.std()
    return plane


def _mixed(share: Floats, low: tuple[int, int, int], high: tuple[int, int, int]) -> Floats:
    return np.asarray(np.array(low) + share[..., None] * (np.array(high) - np.array(low, np.float64)))


def _rounded(values: Floats) -> Picture:
    return (np.clip(values, 0, 255) + 0.5).astype(np.uint8)


def _step(values: Floats, low: float, high: float) -> Floats:
    """Rise smoothly from 0 at ``low`` to 1 at ``high``."""
    place: Floats = np.clip((values - low) / (high - low), 0, 1)
    return place * place * (3 - 2 * place)


def coral() -> Picture:
    """Draw small spots that lie in winding lines."""
    rng = np.random.default_rng(11)
    y, x = np.mgrid[:SIDE, :SIDE].astype(np.float64)
    across = 2 * np.pi * (y / 16 + 0.45 * smooth_noise(rng, 70))
    line = np.round(across / (2 * np.pi))
    # Every line has its spots elsewhere.
    start = 2 * np.pi * ((line * 0.6180339887) % 1)
    along = 2 * np.pi * (x / 9.5 + 0.12 * smooth_noise(rng, 40)) + start
    spots = _step(np.cos(across) + np.cos(along), 0.55, 1.35)
    ground = 0.5 + 0.16 * smooth_noise(rng, 14) + 0.06 * smooth_noise(rng, 3)
    colours = _mixed(ground, (118, 62, 44), (196, 124, 88))
    return _rounded(colours + spots[..., None] * (_mixed(ground, (226, 206, 178), (252, 240, 220)) - colours))


def hay() -> Picture:
    """Draw straws that lie over each other, most of them in one direction."""
    from PIL import Image, ImageDraw

    rng = np.random.default_rng(12)
    side = SIDE * _MANY
    image = Image.new("RGB", (side, side), (92, 70, 34))
    draw = ImageDraw.Draw(image)
    for layer in range(1500):
        x, y = rng.uniform(-80, side + 80, 2)
        angle = math.radians(32 + 20 * rng.standard_normal())
        long, wide = rng.uniform(120, 420), int(rng.integers(4, 10))
        light = rng.uniform(0.55, 1) * (0.7 + 0.3 * layer / 1500)
        colour = [int(light * (base + rng.uniform(-12, 12))) for base in (226, 194, 112)]
        dx, dy = long / 2 * math.cos(angle), long / 2 * math.sin(angle)
        shadow = (int(colour[0] * 0.45), int(colour[1] * 0.45), int(colour[2] * 0.4))
        draw.line((x - dx + 3, y - dy + 4, x + dx + 3, y + dy + 4), shadow, wide + 2)
        draw.line((x - dx, y - dy, x + dx, y + dy), (colour[0], colour[1], colour[2]), wide)
    return _reduced(image)


def marble() -> Picture:
    """Draw veins: a slanted wave that noise of many scales has bent."""
    rng = np.random.default_rng(13)
    y, x = np.mgrid[:SIDE, :SIDE].astype(np.float64)
    turbulence = sum(np.abs(smooth_noise(rng, scale)) * scale / 90 for scale in (90, 45, 22, 11, 6))
    veins = np.abs(np.sin(np.pi * (x + 0.55 * y) / 90 + 1.15 * np.asarray(turbulence)))
    clouds = 0.5 + 0.16 * smooth_noise(rng, 50) + 0.03 * smooth_noise(rng, 3)
    light = np.clip(0.35 * clouds + 0.75 * veins**0.45, 0, 1)
    return _rounded(_mixed(light, (72, 78, 92), (240, 238, 232)))


def butterfly() -> Picture:
    """Draw the bars and spots of a wing: veins that fan out, and rows of spots between them."""
    rng = np.random.default_rng(14)
    y, x = np.mgrid[:SIDE, :SIDE].astype(np.float64)
    radius = np.hypot(x + 60, y - 128) + 3 * smooth_noise(rng, 60)
    angle = np.arctan2(y - 128, x + 60) + 0.012 * smooth_noise(rng, 50)
    sector = angle / 0.16
    offset = (sector - np.round(sector)) * 0.16 * radius
    vein = 1 - _step(np.abs(offset), 2.0, 4.5)
    bars = _step(np.cos(2 * np.pi * radius / 62 + 0.9), 0.55, 0.8)
    colours = _mixed(0.5 + 0.2 * smooth_noise(rng, 8), (196, 104, 24), (240, 160, 60))
    dark = np.maximum(vein, bars)
    colours += dark[..., None] * (np.array([34.0, 24, 20]) - colours)
    for ring, size, light in (
        (112, 6.5, (250, 244, 226)),
        (174, 7.5, (250, 244, 226)),
        (236, 8.5, (120, 190, 230)),
    ):
        # In the middle between two veins.
        between = ((sector - np.floor(sector)) - 0.5) * 0.16 * radius
        spot = 1 - _step(np.hypot(radius - ring, between), size - 2, size)
        colours += spot[..., None] * (np.array(light, np.float64) - colours)
    return _rounded(colours)


def page() -> Picture:
    """Draw fourteen lines of print, evenly spaced over the whole height."""
    from PIL import Image, ImageDraw, ImageFont

    image = Image.new("L", (SIDE * _MANY, SIDE * _MANY), 246)
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(11.4 * _MANY)
    for number, words in enumerate(_TEXT):
        draw.text((4 * _MANY, (number + 0.5) * SIDE * _MANY / LINES), words, 26, font, anchor="lm")
    return np.repeat(_reduced(image)[..., None], 3, axis=2)


def seeds(*, even: bool) -> Picture:
    """Draw seeds that lie evenly, or ever larger and denser towards the right below."""
    from PIL import Image, ImageDraw

    rng = np.random.default_rng(15)
    side = SIDE * _MANY
    image = Image.new("RGB", (side, side), (168, 150, 122))
    draw = ImageDraw.Draw(image)
    placed: list[tuple[float, float, float]] = []
    for _ in range(6000):
        x, y = rng.uniform(-20, side + 20, 2)
        size = 1.0 if even else 0.5 + 1.1 * (x + y) / (2 * side)
        if any(math.hypot(x - a, y - b) < 27 * (size + other) / 2 for a, b, other in placed):
            continue
        placed.append((x, y, size))
        angle, light = rng.uniform(0, np.pi), rng.uniform(0.75, 1.05)
        turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
        circle = np.linspace(0, 2 * np.pi, 40)
        outline = turn @ (np.stack([17 * np.cos(circle), 9 * np.sin(circle)]) * size)
        colour = (int(92 * light), int(62 * light), int(38 * light))
        draw.polygon([(x + 3 + a, y + 5 + b) for a, b in outline.T], (122, 106, 82))
        draw.polygon([(x + a, y + b) for a, b in outline.T], colour)
        shine = turn @ (np.stack([8 * np.cos(circle), 2.5 * np.sin(circle)]) * size)
        draw.polygon(
            [(x + a - 2, y + b - 2) for a, b in shine.T], (colour[0] + 46, colour[1] + 38, colour[2] + 28)
        )
    return _reduced(image)


def _reduced(image: Any) -> Picture:
    from PIL import Image

    return np.asarray(image.resize((SIDE, SIDE), Image.Resampling.BOX))


EXEMPLARS: dict[str, Callable[[], Picture]] = {
    "structured-coral": coral,
    "oriented-hay": hay,
    "stochastic-marble": marble,
    "structured-butterfly": butterfly,
    "letters-page": page,
    "structured-seeds": lambda: seeds(even=True),
    "inhomogeneous-seedgradient": lambda: seeds(even=False),
}


def main(arguments: Sequence[str]) -> int:
    """Draw all of them into a folder."""
    from PIL import Image

    if len(arguments) != 1:
        print("usage: python -m texlab_core.figures._exemplars FOLDER", file=sys.stderr)
        return 2
    for name, draw in EXEMPLARS.items():
        Image.fromarray(draw()).save(Path(arguments[0]) / f"{name}.png", optimize=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
