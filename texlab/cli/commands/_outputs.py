"""Where a result goes, checked before the work starts, and what is said of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import output_file, output_folder
from texlab.cli.commands._progress import progress
from texlab.cli.terminal import interrupted

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence
    from pathlib import Path

    from texlab.cli.parser import Parser
    from texlab_core.engine.job import Job
    from texlab_core.engine.result import Result
    from texlab_core.images.formats.writing import Bits

BITS: dict[str, Bits] = {"8": 8, "16": 16, "float": "float"}


def add_output_options(parser: Parser) -> None:
    """Add what ``synth`` and ``redo`` share."""
    parser.add_argument("--out", required=True, metavar="OUT.png", help="file to write: .png, .tif or .jpg")
    parser.add_argument("--bits", choices=BITS, help="for each sample: 8 (default), 16, or float in a TIFF")
    parser.add_argument("--maps", metavar="DIR", help="also save the maps and curves in this folder")
    parser.add_argument("--json", action="store_true", help="print one JSON object on standard output")


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
    from texlab_core.measures.registry import measure_all
    from texlab_core.measures.subject import Subject

    return summary(result, outputs.image, measure_all(Subject.of_result(result, should_stop=interrupted)))


def described(result: Result, outputs: Outputs) -> str:
    """Return what was made in a few lines for people."""
    height, width = result.job.size
    exemplar = result.job.inputs.get("exemplar")
    made = f"{width} x {height} by {result.job.method}, seed {result.job.seed}, in {result.elapsed_s:.2f} s"
    return "\n  ".join([f"{outputs.image}: {made}.", *getattr(exemplar, "notes", ()), *result.notes])
