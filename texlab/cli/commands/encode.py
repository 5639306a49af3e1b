"""``texlab encode``: a texture as a code of 69 numbers, from which ``texlab synth`` makes any amount of it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from texlab.cli.commands._options import add_json_option, output_file, refuse_overwriting
from texlab.cli.commands._sources import CODE_SUFFIX, add_scale_options, is_code, parse_reading
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "Save a texture as a code of 69 numbers, 113 in colour (MSG)."
ORDER = 17
READS = ("image",)
WRITES = ".msg.json"


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("image", metavar="IMAGE|gallery:NAME", help="the texture")
    parser.add_argument("--out", required=True, metavar="X.msg.json", help="file to write")
    parser.add_argument(
        "--bandwidths",
        choices=("participation", "paper"),
        default="participation",
        help="how bandwidths are measured (default participation)",
    )
    parser.add_argument(
        "--axes",
        choices=("uv", "radial"),
        default="uv",
        help="along which axes: of the frequency plane (default uv), or along and across the waves",
    )
    parser.add_argument("--gray", action="store_true", help="the luma alone: 69 numbers also of a colour texture")
    add_scale_options(parser)
    add_json_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Measure and save."""
    if not is_code(args.out):
        raise ParamError("out", f"a file name that ends in {CODE_SUFFIX}", args.out)
    reading = parse_reading(args)
    out = output_file(args.out)
    refuse_overwriting(out, args.image)

    from texlab_core.methods.spectral.codefile import code_to_json, write_code
    from texlab_core.methods.spectral.encoding import encode, gray_of
    from texlab_core.work.tasks import finish

    exemplar = reading.read(args.image)
    pixels = gray_of(exemplar.pixels) if args.gray else exemplar.pixels
    code, _ = finish(encode(pixels, args.bandwidths, args.axes))
    write_code(code, out, exemplar.name)
    if args.json:
        answer = {"out": str(out), "numbers": code.parameters, "code": code_to_json(code, exemplar.name)}
        print(json.dumps(answer, allow_nan=False))
    else:
        colours = ", 69 for gray and 44 for the colours (mean 3, axes 9, two curves of 16)"
        beyond = "" if code.tone.colours is None else colours
        print(f"{out}: {exemplar.name} in {code.parameters} numbers{beyond}.")
    return 0
