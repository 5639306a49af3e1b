"""``texlab popout``: can the original be found in what a method made? Pictures, key, scores."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import (
    output_file,
    output_folder,
    parse_number,
    parse_size,
    refuse_overwriting,
)
from texlab.cli.commands._progress import share_bar
from texlab.cli.commands._sources import add_scale_options, parse_reading
from texlab.cli.terminal import interrupted

if TYPE_CHECKING:
    from texlab.cli.parser import Parser
    from texlab_core.popout.design import Design
    from texlab_core.popout.record import Record
    from texlab_core.popout.scoring import Score

HELP = "Test whether a piece of the original stands out in what methods make of it."
ORDER = 33
METHODS = "heeger-bergen,de-bonet,msg,efros-leung"
EXAMPLES = """
pictures and a key:        texlab popout make wall.jpg --methods tiling,de-bonet --out test
Figs. 2 to 5 of De Bonet:  texlab popout figures --out test
score what was answered:   texlab popout score test/answers.csv --key test/key.json
what the machine found:    texlab popout observe test/key.json
tests made in the window:  texlab popout kept --out all.csv

answers.csv has a line for each picture: row and column of the click, counted from 0 at the upper left, and the
seconds that it took; both empty, with seconds, when nothing was seen. key.json says where the pieces are: it is
not for who looks.
"""


def configure(parser: Parser) -> None:
    """Add the arguments: one parser for each action."""
    parser.epilog = EXAMPLES
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    actions = parser.add_subparsers(title="actions", metavar="ACTION", required=True)

    def action(name: str, act: Any, about: str) -> argparse.ArgumentParser:
        each = actions.add_parser(name, help=about, description=about, allow_abbrev=False)
        each.set_defaults(act=act)
        each.add_argument("--json", action="store_true", help="print one JSON document")
        return each

    def drawn(each: argparse.ArgumentParser, repeats: str) -> None:
        each.add_argument("--out", required=True, metavar="FOLDER", help="a new or empty folder for the pictures")
        each.add_argument(
            "--repeats", default=repeats, metavar="N", help=f"pictures of each method (default {repeats})"
        )
        each.add_argument("--seed", default="0", metavar="N", help="decides seeds, places and order (default 0)")
        each.add_argument("--feather", default="0", metavar="PX", help="width of a soft edge (default 0: hard)")

    make = action("make", _make, "Make the pictures, with a key and an empty table for the answers.")
    make.add_argument("image", metavar="IMAGE|gallery:NAME", help="the exemplar")
    make.add_argument("--methods", default=METHODS, metavar="A,B", help=f"ids of methods (default {METHODS})")
    make.add_argument(
        "--set", action="append", default=[], metavar="METHOD.NAME=VALUE", help="set one parameter of one method"
    )
    make.add_argument(
        "--size",
        metavar="WxH",
        help="of the pictures; one number for a square (default: three times the piece, from 256)",
    )
    make.add_argument(
        "--share", default="0.5", metavar="S", help="sides of the piece over the exemplar's (default 0.5)"
    )
    drawn(make, "5")
    add_scale_options(make)  # type: ignore[arg-type]  # a parser of argparse's own does as well
    drawn(action("figures", _figures, "Make Figs. 2 to 5 of De Bonet's paper, one picture each."), "1")
    score = action("score", _score, "Score a table of answers.")
    score.add_argument("answers", metavar="ANSWERS.csv")
    score.add_argument("--key", required=True, metavar="KEY.json", help="the key that came with the pictures")
    score.add_argument("--out", metavar="TABLE.csv", help="write every picture with its answer")
    observe = action("observe", _observe, "Score the machine observer: it clicks where local D is largest.")
    observe.add_argument("key", metavar="KEY.json")
    kept = action("kept", _kept, "List the tests that were made in the window.")
    kept.add_argument("--out", metavar="TABLE.csv", help="write all of their pictures with the answers")


def execute(args: argparse.Namespace) -> int:
    """Do what was asked and print what came of it."""
    answer, text = args.act(args)
    print(json.dumps(answer, allow_nan=False, ensure_ascii=False) if args.json else text)
    return 0


def _make(args: argparse.Namespace) -> tuple[Any, str]:
    from texlab.cli.commands.compare import parse_params
    from texlab_core.popout.design import Design, settings_of, usual_size

    names = [each.strip() for each in args.methods.split(",")]
    settings = settings_of(names, parse_params(args.set, names))
    share = parse_number("share", args.share, float)
    size = None if args.size is None else parse_size(args.size)
    drawn = _drawn(args)
    exemplar = parse_reading(args).read(args.image)
    return _write(
        args,
        Design(
            exemplar=exemplar, settings=settings, share=share, size=size or usual_size(exemplar, share), **drawn
        ),
    )


def _figures(args: argparse.Namespace) -> tuple[Any, str]:
    from dataclasses import replace

    from texlab_core.popout.design import figures

    drawn = _drawn(args)
    return _write(args, replace(figures(), **drawn))


def _drawn(args: argparse.Namespace) -> dict[str, Any]:
    from texlab_core.popout.making import check_folder

    check_folder(output_folder(args.out))
    return {name: parse_number(name, getattr(args, name), int) for name in ("repeats", "seed", "feather")}


def _write(args: argparse.Namespace, design: Design) -> tuple[Any, str]:
    from texlab_core.popout.making import make, write_test

    with share_bar(f"{design.repeats * len(design.settings)} pictures") as show:
        made = make(design, on_progress=show, should_stop=interrupted)
    names = write_test(made, args.out)
    pictures = len(made.pictures)
    answer = {"out": args.out, "pictures": pictures, "files": list(names), "chance": design.chance}
    (height, width), (rows, columns) = design.size, design.piece
    count = "1 picture" if pictures == 1 else f"{pictures} pictures"
    text = (
        f"{args.out}: {count} of {width} x {height} pixels with a piece of {columns} x {rows}; a click"
        f" in the middle is right in {design.chance:.0%}.\nScore the answers: texlab popout score"
        f" {Path(args.out) / 'answers.csv'} --key {Path(args.out) / 'key.json'}"
    )
    return answer, text


def _score(args: argparse.Namespace) -> tuple[Any, str]:
    from texlab_core.popout.record import read_answers, read_record, table_of

    out = None if args.out is None else output_file(args.out)
    if out is not None:
        for source in (args.answers, args.key):
            refuse_overwriting(out, source)
    record = read_record(args.key).with_answers(read_answers(args.answers))
    if out is not None:
        from texlab_core.files.whole import write_whole

        write_whole(out, table_of([(Path(args.answers).stem, record)]).encode())
    return _scored(record)


def _observe(args: argparse.Namespace) -> tuple[Any, str]:
    from texlab_core.errors import InputError
    from texlab_core.popout.record import read_record

    record = read_record(args.key)
    if not record.machine:
        raise InputError(f"{args.key}: the machine did not look at these pictures: the piece is under 40 pixels.")
    return _scored(record.with_answers(record.machine))


def _kept(args: argparse.Namespace) -> tuple[Any, str]:
    from texlab.cli.terminal import complain
    from texlab.storage.paths import config_dir
    from texlab_core.popout.record import table_of
    from texlab_core.popout.store import FOLDER, PopoutStore

    out = None if args.out is None else output_file(args.out)
    kept = PopoutStore(config_dir() / FOLDER).all()
    for problem in kept.problems:
        complain(problem)
    if out is not None:
        from texlab_core.files.whole import write_whole

        write_whole(out, table_of(kept.records).encode())
    listed = [
        {"test": name, "exemplar": each.design["exemplar"]["name"]} | _scored(each)[0]
        for name, each in kept.records
    ]
    lines = [
        f"{name}  {len(each.answers)} of {len(each.trials)} pictures answered, {each.design['exemplar']['name']}"
        for name, each in kept.records
    ]
    return listed, "\n".join(lines) or "There are no tests yet."


def _scored(record: Record) -> tuple[dict[str, Any], str]:
    found = record.scores()
    answer = {
        "answers": len(record.answers),
        "pictures": len(record.trials),
        "chance": record.chance,
        "scores": [_as_json(each) for each in found],
    }
    width = max(len(each.name) for each in found)
    lines = [_line(each, width) for each in found]
    lines.append(f"{len(record.answers)} of {len(record.trials)} pictures answered; guessing: {record.chance:.0%}")
    return answer, "\n".join(lines)


def _as_json(found: Score) -> dict[str, Any]:
    return {
        "method": found.name,
        "hits": found.hits,
        "misses": found.misses,
        "could_not_tell": found.untold,
        "share": found.share if found.answers else None,
        "interval": [found.low, found.high],
        "chance": found.chance,
        "luck": found.luck,
        "seconds": found.seconds,
        "machine_hits": found.machine,
        "verdict": found.verdict,
    }


def _line(found: Score, width: int) -> str:
    if not found.answers:
        return f"{found.name:{width}}  no answers"
    time = "" if found.seconds is None else f", {found.seconds:.1f} s"
    machine = "" if found.machine is None else f", machine {found.machine}"
    return (
        f"{found.name:{width}}  {found.hits} of {found.answers} found, {found.share:.0%}"
        f" ({found.low:.0%} to {found.high:.0%}){time}{machine}: {found.verdict}"
    )
