"""``texlab failures``: what the papers say fails, as examples that are ready to be made."""

from __future__ import annotations

import json
import textwrap
from typing import TYPE_CHECKING

from texlab.cli.commands._options import parse_result_size
from texlab_core.errors import InputError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.findings.failures import Failure

HELP = "List failures that the papers name, or make one of them."
ORDER = 32
WRITES = ".png"
WIDTH = 96


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "name", nargs="?", metavar="NAME", help="the failure to make, with --out; without it, a list"
    )
    parser.add_argument("--out", metavar="FILE", help="file to write: .png, .tif, .webp or .jpg, with its recipe")
    parser.add_argument(
        "--size", metavar="WxH", help="of the result; one number for a square (default: the example's)"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON document on standard output")


def execute(args: argparse.Namespace) -> int:
    """List or make."""
    if args.name is None:
        for option in ("out", "size"):
            if getattr(args, option) is not None:
                raise InputError(f"--{option} needs the NAME of a failure; texlab failures lists them.")
        return _list(args)
    from texlab_core.findings.failures import find_example

    example = find_example(args.name)
    if args.out is None:
        if args.size is not None:
            raise InputError("--size needs --out FILE.")
        print(json.dumps(example.to_json(), indent=2) if args.json else "\n".join(_described(example)))
        return 0
    from texlab.cli.commands._options import output_file
    from texlab.cli.commands._outputs import Outputs, described, make, summary_of
    from texlab_core.documents.record import check_result_format

    size = None if args.size is None else parse_result_size(args.size, 2)
    check_result_format(args.out)
    outputs = Outputs(output_file(args.out), None, None)
    made = make(example.job(size), outputs, measured=args.json)
    if args.json:
        print(json.dumps(summary_of(made, outputs) | {"failure": example.to_json()}))
    else:
        print("\n".join([described(made, outputs), *_described(example)]))
    return 0


def _list(args: argparse.Namespace) -> int:
    from texlab_core.engine.registry import find_method
    from texlab_core.findings.failures import examples

    found = examples().values()
    if args.json:
        print(json.dumps([each.to_json() for each in found], indent=2))
        return 0
    width = max(len(each.name) for each in found)
    for method in dict.fromkeys(each.method for each in found):
        print(find_method(method).title)
        for each in found:
            if each.method == method:
                print(f"  {each.name:{width}}  {each.title}, {each.source}")
    print("\ntexlab failures NAME explains one, and makes it with --out FILE.")
    return 0


def _described(example: Failure) -> list[str]:
    lines = []
    for name, text in (("look at: ", example.look), ("why: ", example.why), ("finding: ", example.finding)):
        lines += textwrap.wrap(name + text, WIDTH, initial_indent="  ", subsequent_indent="    ")
    return lines
