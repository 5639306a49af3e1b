"""What the experiments of ``texlab lab`` share: an image, a picture to write, numbers to print."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import output_file, parse_number, refuse_overwriting
from texlab.cli.commands._sources import add_scale_options, parse_reading
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Sequence
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from texlab.cli.parser import Parser
    from texlab_core.engine.inputs import ImageInput


@dataclass(frozen=True)
class Experiment:
    """One sub-command.

    Parameters
    ----------
    help
        One sentence.
    configure
        Adds its arguments.
    execute
        Runs it and returns the exit code.
    note
        Below its help.
    """

    help: str
    configure: Callable[[Parser], None]
    execute: Callable[[argparse.Namespace], int]
    note: str = ""


def add_image(parser: Parser, name: str = "image", words: str = "the picture") -> None:
    """Add an image with the options that crop and reduce it."""
    parser.add_argument(name, metavar="IMAGE|gallery:NAME", help=words)
    add_scale_options(parser, levels=False)


def add_out(parser: Parser, *, required: bool = False) -> None:
    """Add the picture to write."""
    parser.add_argument("--out", required=required, metavar="SHEET.png", help="picture to write")


def number(args: argparse.Namespace, name: str) -> float:
    """Return an option as a number."""
    return parse_number(name, getattr(args, name), float)


def whole(args: argparse.Namespace, name: str) -> int:
    """Return an option as a whole number."""
    return parse_number(name, getattr(args, name), int)


def checked_seed(args: argparse.Namespace) -> int:
    """Return the seed."""
    from texlab_core.engine.job import check_seed

    return check_seed(whole(args, "seed"))


def numbers(name: str, text: str) -> list[float]:
    """Return numbers that are separated by commas."""
    return [parse_number(name, part, float) for part in text.split(",")]


def out_file(args: argparse.Namespace, *sources: str) -> Path | None:
    """Return where the picture goes, checked before any work."""
    if args.out is None:
        return None
    out = output_file(args.out)
    if out.suffix.lower() != ".png":
        raise ParamError("out", "a file name that ends in .png", args.out)
    for source in sources:
        refuse_overwriting(out, source)
    return out


def load(args: argparse.Namespace, source: str) -> ImageInput:
    """Return the image, read as the options say."""
    return parse_reading(args).read(source)


def load_plane(args: argparse.Namespace, source: str) -> NDArray[np.float32]:
    """Return the luma of the image, (H, W) float32."""
    from texlab_core.transforms.luma import luma

    plane: NDArray[np.float32] = luma(load(args, source).pixels)
    return plane


def report(
    args: argparse.Namespace, answer: dict[str, Any], lines: Sequence[str], out: Path | None, sheet: Any = None
) -> int:
    """Write the picture, if one is wanted; print one JSON object, or the lines.

    Parameters
    ----------
    answer
        JSON data.
    lines
        The same for people.
    out
        Where the picture goes; None writes none.
    sheet
        A function that makes it, (H, W, 3) uint8.
    """
    if out is not None:
        from texlab_core.files.whole import write_whole
        from texlab_core.images.formats.writing import encode_png

        write_whole(out, encode_png(sheet()))
        answer = {"out": str(out), **answer}
        lines = [*lines, str(out)]
    print(json.dumps(answer, allow_nan=False) if args.json else "\n".join(lines))
    return 0
