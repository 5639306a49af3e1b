"""What a method works on, from the command line: images, gallery textures, codes, arrays, by their names."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from texlab.cli.commands._options import parse_crop, parse_number
from texlab.cli.terminal import interrupted
from texlab_core.errors import InputError, ParamError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Mapping, Sequence

    from texlab.cli.parser import Parser
    from texlab_core.engine.inputs import Crop, ImageInput, Input
    from texlab_core.engine.levels import Levels
    from texlab_core.engine.registry import InputSpec, Method

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
    levels: Levels | Literal["auto"] | None = None

    def read(self, source: str) -> ImageInput:
        """Return the exemplar; raises ``InputError``, and ``Cancelled`` after Ctrl-C."""
        from texlab_core.engine.levels import Levels
        from texlab_core.images.exemplar import as_exemplar

        image = as_exemplar(
            source,
            scale=self.scale,
            crop=self.crop,
            alpha=self.alpha,
            background=self.background,
            levels=self.levels if isinstance(self.levels, Levels) else None,
            should_stop=interrupted,
        )
        if self.levels != "auto":
            return image
        whole = image.origin is not None and image.origin.taken is None
        scale, crop = (self.scale, self.crop) if whole else (1.0, None)
        return as_exemplar(image, scale=scale, crop=crop, levels=Levels.auto(image.pixels))


def add_scale_options(parser: Parser, *, keeps: bool = False, levels: bool = True) -> None:
    """Add ``--scale``, ``--crop`` and ``--levels``, and what belongs to every image.

    ``levels`` is False where these are those of a pyramid; for the rest see :func:`add_alpha_options`.
    """
    parser.add_argument("--scale", metavar="S", help="reduce the image first, 0 < S <= 1")
    parser.add_argument("--crop", metavar="WxH+X+Y", help="use this part of the (reduced) image")
    if levels:
        parser.add_argument(
            "--levels",
            dest="image_levels",
            metavar="B,W,G|auto",
            help="then make B black and W white (0 to 1), with the gamma G",
        )
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
        _levels(getattr(args, "image_levels", None)),
    )


def _levels(text: str | None) -> Levels | Literal["auto"] | None:
    from texlab_core.engine.levels import Levels

    return None if text is None else Levels.parse(text) or "auto"


@dataclass(frozen=True)
class Source:
    """Where an input comes from, and how an image is read."""

    place: str
    reading: Reading


def add_input_options(parser: Parser) -> None:
    """Add the options for further inputs by name."""
    parser.add_argument(
        "--input",
        action="append",
        default=[],
        metavar="NAME=FILE|gallery:NAME",
        help="a further input of the method, as in second=gallery:stochastic-rock; texlab methods ID lists them",
    )
    parser.add_argument(
        "--input-scale", action="append", default=[], metavar="NAME=S", help="reduce that input first, 0 < S <= 1"
    )
    parser.add_argument(
        "--input-crop", action="append", default=[], metavar="NAME=WxH+X+Y", help="use this part of that input"
    )


def parse_inputs(args: argparse.Namespace) -> dict[str, Source]:
    """Return the further inputs that were named; raises ``InputError``."""
    places = by_name(args.input, "input", "a name and a source as in second=wall.jpg")
    scales = by_name(args.input_scale, "input-scale", "a name and a factor as in second=0.5")
    crops = by_name(args.input_crop, "input-crop", "a name and a part as in second=256x192+10+20")
    for option, given in (("input-scale", scales), ("input-crop", crops)):
        for name in given:
            if name not in places:
                raise InputError(f"--{option} names the input {name}, and --input does not.")
    return {
        name: Source(
            place,
            Reading(
                parse_number("input-scale", scales[name], float) if name in scales else 1.0,
                parse_crop(crops[name]) if name in crops else None,
            ),
        )
        for name, place in places.items()
    }


def by_name(
    texts: Sequence[str], option: str, allowed: str, given: Mapping[str, str] | None = None
) -> dict[str, str]:
    """Return the values of ``NAME=VALUE`` by name, after those that are given already.

    Raises
    ------
    InputError
        When one has another form (``allowed`` says which), or a name comes twice.
    """
    found = dict(given or {})
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name or not value:
            raise ParamError(option, allowed, text)
        if name in found:
            raise InputError(f"The input {name} is given twice.")
        found[name] = value
    return found


def load_inputs(
    source: str, method: Method, reading: Reading, others: Mapping[str, Source] | None = None
) -> dict[str, Input]:
    """Return the inputs of a job.

    Parameters
    ----------
    source
        An image file, ``gallery:NAME``, or a code ``X.msg.json``.
    method
        Whose inputs they are.
    reading
        What is done to an image first.
    others
        Further inputs by name.

    Raises
    ------
    InputError
        When one cannot be read, or the method cannot work on it.
    """
    specs = {spec.name: spec for spec in method.inputs}
    first = "code" if is_code(source) else "exemplar"
    if first not in specs:
        raise InputError(f"{source} is a code of numbers, and {method.title} needs an image; say --method msg.")
    if first == "code" and (reading.scale != 1.0 or reading.crop is not None or reading.levels is not None):
        raise InputError(
            f"{source} is a code of numbers, which can be neither scaled nor cropped, and has no levels."
        )
    if first in (others or {}):
        raise InputError(f"The input {first} is given twice.")
    return {first: load_input(Source(source, reading), specs[first]), **load_others(others or {}, method)}


def load_others(others: Mapping[str, Source], method: Method) -> dict[str, Input]:
    """Return the further inputs of a method, each read as its kind wants it; raises ``InputError``."""
    from texlab_core.images.named_input import spec_of

    specs = {name: spec_of(method, name) for name in others}
    found = {}
    for name, source in others.items():
        # What is transparent in it is what the method says.
        reading = replace(source.reading, background=specs[name].background)
        found[name] = load_input(Source(source.place, reading), specs[name])
    return found


def load_input(source: Source, spec: InputSpec) -> Input:
    """Return one input, read as its kind wants it; raises ``InputError``, and ``Cancelled`` after Ctrl-C."""
    from texlab_core.images.named_input import read_input

    reading = source.reading
    if spec.kind == "image":
        return reading.read(source.place)
    return read_input(source.place, spec, scale=reading.scale, crop=reading.crop)
