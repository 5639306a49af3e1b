"""``texlab fill``: fill the holes of an image, or grow it outward, with the texture around."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from texlab.cli.commands._options import (
    add_parameter_options,
    parse_number,
    parse_parameters,
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
from texlab.cli.commands._sources import add_alpha_options, parse_reading
from texlab.cli.terminal import interrupted
from texlab_core.errors import InputError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from texlab.cli.commands._sources import Reading
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
    parser.add_argument("--size", metavar="WxH", help="grow the image outward to this size")
    parser.add_argument(
        "--exemplar", metavar="IMAGE|gallery:NAME", help="copy from this image, not from IMAGE itself"
    )
    parser.add_argument("--region", metavar="MASK", help="as large as the exemplar: copy only what is bright")
    add_alpha_options(parser, keeps=True)
    add_output_options(parser)
    parser.add_argument("--seed", default="0", metavar="N", help="the same seed gives the same bits (default 0)")
    add_parameter_options(parser)
    parser.more_help = _knobs


def execute(args: argparse.Namespace) -> int:
    """Check everything, fill, save, report."""
    from texlab_core.engine.registry import find_method

    if args.mask is not None and args.transparent:
        raise InputError("Give either --mask or --transparent.")
    if args.mask is None and not args.transparent and args.size is None:
        raise InputError("There is nothing to fill: give --mask, --transparent or a larger --size.")
    params = parse_parameters(args, find_method(METHOD))
    size = None if args.size is None else parse_size(args.size)
    seed = parse_number("seed", args.seed, int)
    reading = parse_reading(args)
    threshold = 0.5 if args.threshold is None else parse_number("threshold", args.threshold, float)
    outputs = check_outputs(args, chosen_bits(args))
    sources = [each for each in (args.image, args.mask, args.exemplar, args.region) if each is not None]
    for each in sources:
        refuse_overwriting(outputs.image, each)

    from texlab_core.engine.job import Job

    inputs, image = _inputs(args, reading, threshold)
    job = Job(method=METHOD, inputs=inputs, params=params, size=size or image.size, seed=seed)
    result = make(job, outputs, keep=sources)
    print(json.dumps(summary_of(result, outputs)) if args.json else described(result, outputs))
    return 0


def _inputs(args: argparse.Namespace, reading: Reading, threshold: float) -> tuple[dict[str, Input], ImageInput]:
    """Return the inputs of the job, and the image to fill."""
    from texlab_core.images.masks import as_mask

    image = reading.read(args.image)
    inputs: dict[str, Input] = {"exemplar": image if args.exemplar is None else reading.read(args.exemplar)}
    if args.exemplar is not None or (args.mask is None and not args.transparent):
        inputs["start"] = image
    if args.mask is not None:
        inputs["mask"] = as_mask(args.mask, threshold=threshold, should_stop=interrupted)
    elif args.transparent:
        inputs["mask"] = transparent_part(args.image)
    if args.region is not None:
        inputs["region"] = as_mask(args.region, threshold=threshold, should_stop=interrupted)
    return inputs, image


def transparent_part(source: str) -> ImageInput:
    """Return a mask of what is not opaque in an image; raises ``InputError`` when it has no transparency."""
    import numpy as np

    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.images.formats.reading import read_image

    if source.startswith("gallery:"):
        raise InputError(f"{source} has no transparency; give --mask.")
    decoded = read_image(Path(source), source, should_stop=interrupted)
    if decoded.values.shape[2] not in (2, 4):
        raise InputError(f"{source} has no transparency; give --mask.")
    opaque = 1.0 if decoded.peak is None else decoded.peak
    marked = decoded.values[..., -1] < opaque
    return as_exemplar(marked.astype(np.uint8) * np.uint8(255), name=f"what is transparent in {Path(source).name}")


def _knobs(_: Sequence[str]) -> str:
    """Return the parameters of the method, for the help."""
    from texlab.cli.commands._knobs import knobs
    from texlab_core.engine.registry import find_method

    return knobs(find_method(METHOD)) + "\n"
