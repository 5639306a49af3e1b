"""``texlab synth``: make more of a texture and save it with its recipe."""

from __future__ import annotations

import itertools
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import (
    output_file,
    output_folder,
    parse_crop,
    parse_number,
    parse_settings,
    parse_size,
    refuse_overwriting,
)
from texlab.cli.commands._progress import progress
from texlab.cli.terminal import interrupted

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence
    from pathlib import Path

    from texlab.cli.main import Parser
    from texlab_core.engine.params import Params
    from texlab_core.engine.run import Job
    from texlab_core.engine.steps import Result
    from texlab_core.images.formats.writing import Bits

HELP = "Make more of a texture and save it with its recipe."
ORDER = 10
BITS: dict[str, Bits] = {"8": 8, "16": 16, "float": "float"}


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("image", metavar="IMAGE|gallery:NAME", help="the exemplar, or a code X.msg.json")
    parser.add_argument("--method", required=True, metavar="ID", help="one of texlab methods")
    add_output_options(parser)
    parser.add_argument("--size", metavar="WxH", help="size of the result (default: the exemplar's)")
    parser.add_argument("--seed", default="0", metavar="N", help="the same seed gives the same bits (default 0)")
    parser.add_argument("--preset", metavar="NAME|FILE", help="start from these parameters")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set one parameter")
    parser.add_argument("--scale", default="1", metavar="S", help="reduce the image first, 0 < S <= 1")
    parser.add_argument("--crop", metavar="WxH+X+Y", help="use this part of the (reduced) image")
    parser.more_help = _knobs_of_the_method


def add_output_options(parser: Parser) -> None:
    """Add what ``synth`` and ``redo`` share."""
    parser.add_argument("--out", required=True, metavar="OUT.png", help="file to write: .png, .tif or .jpg")
    parser.add_argument("--bits", choices=BITS, help="for each sample: 8 (default), 16, or float in a TIFF")
    parser.add_argument("--maps", metavar="DIR", help="also save the maps and curves in this folder")
    parser.add_argument("--json", action="store_true", help="print one JSON object on standard output")


def execute(args: argparse.Namespace) -> int:
    """Check everything, synthesize, save, report."""
    from texlab_core.engine.registry import find_method

    method = find_method(args.method)
    params = method.params.parse(parse_settings(args.set), _base(args))
    size = None if args.size is None else parse_size(args.size)
    seed = parse_number("seed", args.seed, int)
    scale = parse_number("scale", args.scale, float)
    crop = None if args.crop is None else parse_crop(args.crop)
    outputs = check_outputs(args, BITS[args.bits or "8"])
    refuse_overwriting(outputs.image, args.image)

    from texlab.cli.commands._sources import load_inputs
    from texlab_core.engine.run import Job

    job = Job(
        method=args.method,
        inputs=load_inputs(args.image, method, scale=scale, crop=crop),
        params=params,
        size=size,  # type: ignore[arg-type]  # None takes the exemplar's
        seed=seed,
    )
    result = make(job, outputs, keep=(args.image,))
    print(json.dumps(summary_of(result, outputs)) if args.json else described(result, outputs))
    return 0


def _base(args: argparse.Namespace) -> Params | None:
    """Return the parameters of the preset, if one was named."""
    if args.preset is None:
        return None
    from texlab.cli.commands.presets import own_presets
    from texlab_core.documents.preset_store import find_preset

    return find_preset(args.preset, own_presets(), args.method).params()


@dataclass(frozen=True)
class Outputs:
    """Where to write, and how."""

    image: Path
    maps: Path | None
    bits: Bits


def check_outputs(args: argparse.Namespace, bits: Bits) -> Outputs:
    """Return where to write; raises ``InputError`` when that will not be possible."""
    from texlab_core.images.formats.writing import check_format

    check_format(args.out, bits)
    image = output_file(args.out)
    return Outputs(image, None if args.maps is None else output_folder(args.maps), bits)


def make(job: Job, outputs: Outputs, keep: Sequence[str] = ()) -> Result:
    """Run a job and save what it makes; the sources to ``keep`` are not overwritten by maps."""
    from texlab_core.documents.record import save_maps, save_result
    from texlab_core.engine.run import run

    with progress(job.method) as show:
        result = run(job, show, interrupted)
    save_result(result, outputs.image, bits=outputs.bits)
    if outputs.maps is not None:
        save_maps(result, outputs.maps, spare=[outputs.image, *keep])
    return result


def summary_of(result: Result, outputs: Outputs) -> dict[str, Any]:
    """Return what was made as JSON data."""
    from texlab_core.documents.record import summary

    return summary(result, outputs.image)


def described(result: Result, outputs: Outputs) -> str:
    """Return what was made in a few lines for people."""
    height, width = result.job.size
    exemplar = result.job.inputs.get("exemplar")
    made = f"{width} x {height} by {result.job.method}, seed {result.job.seed}, in {result.elapsed_s:.2f} s"
    return "\n  ".join([f"{outputs.image}: {made}.", *getattr(exemplar, "notes", ()), *result.notes])


def _knobs_of_the_method(given: Sequence[str]) -> str:
    """Return the parameters of the method that the command line names, for its help."""
    from texlab.cli.commands.methods import knobs
    from texlab_core.engine.registry import methods

    named = [after for before, after in itertools.pairwise(given) if before == "--method"]
    named += [each.removeprefix("--method=") for each in given if each.startswith("--method=")]
    known = methods()
    if named and named[-1] in known:
        return knobs(known[named[-1]]) + "\n"
    return f"methods: {', '.join(known)}; add --method ID to see the parameters of one.\n"
