"""``texlab diagnose``: what is wrong with a result, why, and what to try."""

from __future__ import annotations

import json
import textwrap
from typing import TYPE_CHECKING

from texlab.cli.commands._options import add_json_option
from texlab.cli.terminal import interrupted

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.findings.diagnosis import Diagnosis
    from texlab_core.findings.finding import Finding

HELP = "Say what is wrong with a result, from TexLab or another program, and what to try."
ORDER = 16
READS = ("image", "result")
WIDTH = 96


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument(
        "image",
        metavar="IMAGE|gallery:NAME",
        help="the exemplar; or a result of TexLab that carries its exemplar, and nothing else",
    )
    parser.add_argument(
        "result",
        nargs="?",
        metavar="RESULT",
        help="any picture; with a recipe inside, method and parameters are known",
    )
    add_json_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Read, measure, report."""
    from texlab_core.findings.diagnosis import diagnose

    picture, exemplar = (args.image, None) if args.result is None else (args.result, args.image)
    found = diagnose(picture, exemplar, interrupted)
    if args.json:
        print(json.dumps({"result": picture} | found.to_json(), allow_nan=False))
    else:
        print("\n".join(described(picture, found)))
    return 0


def described(picture: str, found: Diagnosis) -> list[str]:
    """Return a diagnosis for people, line by line."""
    from texlab_core.findings.finding import FINDING, counted
    from texlab_core.measures.registry import measures, written

    sure, hints = counted(found.findings)
    by = f", made by {found.method}" if found.method else ""
    lines = [f"{picture} against {found.exemplar.name}{by}: {amount(sure, hints)}."]
    shown = [each.id for each in measures().values() if each.live and not each.part_of]
    lines.append("  " + ", ".join(written(found.measures, shown)))
    if found.unexamined:
        lines += textwrap.wrap(found.unexamined, WIDTH, initial_indent="  ", subsequent_indent="  ")
    for certainty, title in ((FINDING, "Findings"), ("look at", "Look at")):
        chosen = [each for each in found.findings if each.certainty == certainty]
        if chosen:
            lines += ["", f"{title}:"]
        for each in chosen:
            lines += _one(each)
    return lines


def amount(sure: int, hints: int) -> str:
    """Return how many findings and hints there are, in words."""
    first = {0: "no findings", 1: "1 finding"}.get(sure, f"{sure} findings")
    return first if not hints else f"{first}, {hints} to look at"


def _one(found: Finding) -> list[str]:
    setting = ", ".join(f"{name} = {value}" for name, value in found.remedy.params.items())
    todo = f"{found.remedy.words} ({setting})" if setting else found.remedy.words
    lines = [f"  {found.title}"]
    for name, text in (
        ("", found.what),
        ("where: ", found.where.words),
        ("why: ", found.why),
        ("try: ", todo),
    ):
        lines += textwrap.wrap(name + text, WIDTH, initial_indent="    ", subsequent_indent="      ")
    return lines
