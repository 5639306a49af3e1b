"""What a method works on, from the command line: an image, a texture of the gallery, or a code of 69 numbers."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from texlab.cli.commands._options import parse_crop, parse_number
from texlab.cli.terminal import interrupted
from texlab_core.errors import InputError, ParamError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.engine.inputs import Crop, ImageInput, Input
    from texlab_core.engine.registry import Method

CODE_SUFFIX = ".msg.json"


def is_code(source: str) -> bool:
    """Return whether a source is an MSG code, by its name."""
    return source.lower().endswith(CODE_SUFFIX)


@dataclass(frozen=True)
class Reading:
    """How an image is read: what is done to it first, and with its transparency."""

    scale: float = 1.0
    crop: Crop | None = None
    alpha: Literal["background", "ignore", "keep"] = "background"
    background: float = 1.0

    def read(self, source: str) -> ImageInput:
        """Return the exemplar; raises ``InputError``, and ``Cancelled`` after Ctrl-C."""
        from texlab_core.images.exemplar import as_exemplar

        return as_exemplar(
            source,
            scale=self.scale,
            crop=self.crop,
            alpha=self.alpha,
            background=self.background,
            should_stop=interrupted,
        )


def add_scale_options(parser: Parser, *, keeps: bool = False) -> None:
    """Add ``--scale`` and ``--crop``, and what belongs to every image; see :func:`add_alpha_options`."""
    parser.add_argument("--scale", metavar="S", help="reduce the image first, 0 < S <= 1")
    parser.add_argument("--crop", metavar="WxH+X+Y", help="use this part of the (reduced) image")
    add_alpha_options(parser, keeps=keeps)


def add_alpha_options(parser: Parser, *, keeps: bool = False) -> None:
    """Add ``--alpha`` and ``--background``; ``keeps`` for commands whose result can carry transparency."""
    uses = ("background", "ignore", "keep") if keeps else ("background", "ignore")
    parser.add_argument(
        "--alpha",
        choices=uses,
        default="background",
        help="transparency: lay the image over the background (default), "
        + ("ignore it, or keep it and carry it to the result" if keeps else "or ignore it"),
    )
    parser.add_argument(
        "--background",
        default="white",
        metavar="GRAY",
        help="under transparent pixels: white (default), black or a level from 0 to 1",
    )


def parse_reading(args: argparse.Namespace) -> Reading:
    """Return how to read the image; raises ``ParamError``."""
    levels = {"black": 0.0, "white": 1.0}
    background = levels.get(args.background.lower())
    if background is None:
        try:
            background = parse_number("background", args.background, float)
        except ParamError:
            background = float("nan")
        if not 0 <= background <= 1:
            raise ParamError("background", "black, white or a gray level from 0 to 1", args.background)
    scale, crop = getattr(args, "scale", None), getattr(args, "crop", None)
    return Reading(
        1.0 if scale is None else parse_number("scale", scale, float),
        None if crop is None else parse_crop(crop),
        args.alpha,
        background,
    )


def load_inputs(source: str, method: Method, reading: Reading) -> dict[str, Input]:
    """Return the inputs of a job.

    Parameters
    ----------
    source
        An image file, ``gallery:NAME``, or a code ``X.msg.json``.
    reading
        What is done to an image first.

    Raises
    ------
    InputError
        When it cannot be read, or the method cannot work on it.
    """
    if not is_code(source):
        return {"exemplar": reading.read(source)}
    if not any(spec.name == "code" for spec in method.inputs):
        raise InputError(f"{source} is a code of numbers, and {method.title} needs an image; say --method msg.")
    if reading.scale != 1.0 or reading.crop is not None:
        raise InputError(f"{source} is a code of numbers, which can be neither scaled nor cropped.")
    from texlab_core.methods.spectral.codefile import load_code_input

    return {"code": load_code_input(Path(source))}
