"""``texlab fill``: fill the holes of an image, or grow it outward, with the texture around."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from texlab.cli.commands._options import (
    add_parameter_options,
    parse_crop,
    parse_number,
    parse_parameters,
    parse_settings,
    parse_size,
    refuse_overwriting,
)
from texlab.cli.commands._outputs import (
    add_output_options,
    check_outputs,
    chosen_bits,
    described,
    make,
    summary_of,
)
from texlab.cli.commands._sources import Reading, add_alpha_options, parse_reading
from texlab.cli.terminal import interrupted
from texlab_core.errors import InputError, ParamError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from texlab.cli.parser import Parser
    from texlab_core.engine.inputs import ImageInput, Input

HELP = "Fill the holes of an image, or grow it outward, with the texture around."
ORDER = 12
READS = ("image", "mask")
WRITES = ".png"
METHOD = "efros-leung"


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("image", metavar="IMAGE|gallery:NAME", help="the image to fill")
    parser.add_argument("--mask", metavar="MASK", help="image of the same size: what is bright is filled")
    parser.add_argument(
        "--threshold", metavar="T", help="of masks: what is brighter is marked, 0 <= T < 1 (default 0.5)"
    )
    parser.add_argument("--transparent", action="store_true", help="fill what is transparent in IMAGE")
    parser.add_argument(
        "--soft",
        action="store_true",
        help="a gray m of the mask mixes m of the fill with 1 - m of what was there; what is not black is filled",
    )
    parser.add_argument(
        "--feather", metavar="PX", help="soften the edge of the mask outward: 1 - d/(PX + 1) at d pixels from it"
    )
    parser.add_argument(
        "--size", metavar="WxH", help="grow the image outward to this size; one number for a square"
    )
    parser.add_argument(
        "--margins", metavar="N|L,T,R,B", help="grow the image outward by pixels left, top, right and bottom"
    )
    parser.add_argument(
        "--exemplar", metavar="IMAGE|gallery:NAME", help="copy from this image, not from IMAGE itself"
    )
    parser.add_argument("--exemplar-scale", metavar="S", help="reduce that image first, 0 < S <= 1")
    parser.add_argument("--exemplar-crop", metavar="WxH+X+Y", help="copy only from this part of that image")
    parser.add_argument("--region", metavar="MASK", help="as large as the exemplar: copy only what is bright")
    add_alpha_options(parser, keeps=True)
    add_output_options(parser)
    parser.add_argument("--seed", default="0", metavar="N", help="the same seed gives the same bits (default 0)")
    add_parameter_options(parser)
    parser.more_help = _knobs


def execute(args: argparse.Namespace) -> int:
    """Check everything, fill, save, report."""
    from texlab_core.engine.registry import find_method

    _check(args)
    params = parse_parameters(args, find_method(METHOD))
    size = None if args.size is None else parse_size(args.size)
    margins = None if args.margins is None else parse_margins(args.margins)
    seed = parse_number("seed", args.seed, int)
    reading = parse_reading(args)
    threshold = 0.5 if args.threshold is None else parse_number("threshold", args.threshold, float)
    feather = None if args.feather is None else parse_number("feather", args.feather, int)
    other = Reading(
        1.0 if args.exemplar_scale is None else parse_number("exemplar-scale", args.exemplar_scale, float),
        None if args.exemplar_crop is None else parse_crop(args.exemplar_crop, "exemplar-crop"),
        reading.alpha,
        reading.background,
    )
    outputs = check_outputs(args, chosen_bits(args))
    sources = [each for each in (args.image, args.mask, args.exemplar, args.region) if each is not None]
    for each in sources:
        refuse_overwriting(outputs.image, each)

    from texlab_core.engine.job import Job
    from texlab_core.methods.efros_leung.filling import grown_by, with_reach

    inputs, image = _inputs(args, reading, other, threshold, feather)
    if margins is not None:
        params, size = grown_by(params, image.size, margins)
    size = size or image.size
    said: tuple[str, ...] = ()
    if "reach" not in parse_settings(args.set):
        params, said = with_reach(params, size)
    job = Job(method=METHOD, inputs=inputs, params=params, size=size, seed=seed)
    made = make(job, outputs, keep=sources, measured=args.json)
    made = replace(made, result=replace(made.result, notes=(*made.result.notes, *said, *_kept(outputs.image))))
    print(json.dumps(summary_of(made, outputs)) if args.json else described(made, outputs))
    return 0


def _check(args: argparse.Namespace) -> None:
    if args.mask is not None and args.transparent:
        raise InputError("Give either --mask or --transparent.")
    if args.size is not None and args.margins is not None:
        raise InputError("Give either --size or --margins.")
    marks = args.mask is not None or args.transparent
    if not marks and args.size is None and args.margins is None:
        raise InputError("There is nothing to fill: give --mask, --transparent, --margins or a larger --size.")
    soft = {"--soft": args.soft, "--feather": args.feather is not None}
    if all(soft.values()):
        raise InputError("Give either --soft or --feather.")
    if any(soft.values()) and not marks:
        raise InputError(f"{next(each for each, given in soft.items() if given)} needs --mask or --transparent.")
    if args.soft and args.threshold is not None and args.region is None:
        raise InputError("Give either --soft or --threshold.")
    for option in ("scale", "crop"):
        if getattr(args, f"exemplar_{option}") is not None and args.exemplar is None:
            raise InputError(f"--exemplar-{option} needs --exemplar.")


def parse_margins(text: str) -> tuple[int, int, int, int]:
    """Return (left, top, right, bottom) from ``N`` or ``L,T,R,B``; raises ``ParamError``."""
    parts = [part.strip() for part in text.split(",")]
    if len(parts) not in (1, 4) or not all(re.fullmatch("[0-9]{1,5}", part) for part in parts):
        raise ParamError("margins", "a number of pixels, or four for left, top, right and bottom", text)
    left, top, right, bottom = (int(part) for part in (parts * 4 if len(parts) == 1 else parts))
    if left + top + right + bottom == 0:
        raise ParamError("margins", "at least one margin above 0", text)
    return left, top, right, bottom


def _inputs(
    args: argparse.Namespace, reading: Reading, other: Reading, threshold: float, feather: int | None
) -> tuple[dict[str, Input], ImageInput]:
    """Return the inputs of the job, and the image to fill."""
    from texlab_core.images.masks import as_blend, as_mask, feathered

    image = reading.read(args.image)
    inputs: dict[str, Input] = {"exemplar": image if args.exemplar is None else other.read(args.exemplar)}
    marks = args.mask is not None or args.transparent
    if args.exemplar is not None or not marks:
        inputs["start"] = image
    if args.transparent:
        part = transparent_part(args.image, soft=args.soft)
        inputs["blend" if args.soft else "mask"] = part if feather is None else feathered(part, feather)
    elif args.soft:
        inputs["blend"] = as_blend(args.mask, should_stop=interrupted)
    elif args.mask is not None:
        mask = as_mask(args.mask, threshold=threshold, should_stop=interrupted)
        inputs["mask"] = mask if feather is None else feathered(mask, feather)
    if feather is not None:
        inputs["blend"] = inputs.pop("mask")
    if args.region is not None:
        inputs["region"] = as_mask(args.region, threshold=threshold, should_stop=interrupted)
    return inputs, image


def _kept(out: Path) -> tuple[str, ...]:
    """Return what there is to say when a format changes the pixels that were not filled."""
    if out.suffix.lower() not in (".jpg", ".jpeg"):
        return ()
    return (
        "A JPEG is compressed as a whole, so that pixels outside of the hole change too; PNG and TIFF keep them.",
    )


def transparent_part(source: str, *, soft: bool = False) -> ImageInput:
    """Return a mask of what is not opaque in an image, or softly of how transparent it is.

    Raises
    ------
    InputError
        When it has no transparency.
    """
    import numpy as np

    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.images.formats.reading import read_image
    from texlab_core.images.masks import as_blend

    if source.startswith("gallery:"):
        raise InputError(f"{source} has no transparency; give --mask.")
    decoded = read_image(Path(source), source, should_stop=interrupted)
    if decoded.values.shape[2] not in (2, 4):
        raise InputError(f"{source} has no transparency; give --mask.")
    opaque = 1.0 if decoded.peak is None else decoded.peak
    name = f"what is transparent in {Path(source).name}"
    if soft:
        shares = 1 - (decoded.values[..., -1].astype(np.float64) / opaque).clip(0, 1)
        return as_blend(shares.astype(np.float32), name=name)
    marked = decoded.values[..., -1] < opaque
    return as_exemplar(marked.astype(np.uint8) * np.uint8(255), name=name)


def _knobs(_: Sequence[str]) -> str:
    """Return the parameters of the method, for the help."""
    from texlab.cli.commands._knobs import knobs
    from texlab_core.engine.registry import find_method

    return knobs(find_method(METHOD)) + "\n"
