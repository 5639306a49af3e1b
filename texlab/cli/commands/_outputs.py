"""Where a result goes, checked before the work starts, and what is said of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import add_json_option, output_file, output_folder
from texlab.cli.commands._progress import progress
from texlab.cli.terminal import interrupted

if TYPE_CHECKING:
    import argparse
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from texlab.cli.parser import Parser
    from texlab_core.engine.job import Job
    from texlab_core.engine.result import Result
    from texlab_core.images.formats.writing import Bits

BITS: dict[str, Bits] = {"8": 8, "16": 16, "float": "float"}
WRITTEN = "file to write: .png, .tif, .webp or .jpg; for a solid .tif or .npy"


def add_output_options(parser: Parser) -> None:
    """Add what ``synth`` and ``redo`` share."""
    parser.add_argument("--out", required=True, metavar="OUT", help=WRITTEN)
    parser.add_argument(
        "--bits", choices=BITS, help="for each sample: 8, 16, or float in a TIFF (default: as the exemplar has)"
    )
    parser.add_argument("--maps", metavar="DIR", help="also save the maps and curves in this folder")
    add_json_option(parser)


@dataclass(frozen=True)
class Outputs:
    """Where to write, and how."""

    image: Path
    maps: Path | None
    bits: Bits | None
    """None for the exemplar's own."""


def chosen_bits(args: argparse.Namespace) -> Bits | None:
    """Return the depth that was asked for, if any."""
    return None if args.bits is None else BITS[args.bits]


def check_outputs(args: argparse.Namespace, bits: Bits | None, dimensions: int = 2) -> Outputs:
    """Return where to write; raises ``InputError`` when that will not be possible."""
    from texlab_core.documents.record import check_result_format

    check_result_format(args.out, bits, dimensions)
    image = output_file(args.out)
    return Outputs(image, None if args.maps is None else output_folder(args.maps), bits)


@dataclass(frozen=True, eq=False)
class Made:
    """A result, its numbers by id, and what is wrong with it as JSON data, where that was asked for."""

    result: Result
    measures: Mapping[str, float]
    findings: Sequence[dict[str, Any]]


def make(job: Job, outputs: Outputs, keep: Sequence[str] = (), *, measured: bool = False) -> Made:
    """Run a job, measure what it makes if that is wanted, and save it with the numbers that are known.

    The sources to ``keep`` are not overwritten by maps.
    """
    from texlab_core.documents.record import carried_alpha, save_result
    from texlab_core.engine.run import run
    from texlab_core.images.formats.writing import can_hold_alpha

    with progress(_foretold(job)) as show:
        result = run(job, show, interrupted)
    flat = result.volume is None and can_hold_alpha(outputs.image)
    alpha = carried_alpha(result) if flat else None
    made = _measured(result) if measured else Made(result, result.measures, ())
    kept = save_result(
        result,
        outputs.image,
        bits=outputs.bits,
        alpha=alpha,
        maps=outputs.maps,
        spare=keep,
        measures=made.measures,
    )
    return replace(made, result=replace(result, notes=(*result.notes, *kept)))


def _measured(result: Result) -> Made:
    from texlab_core.findings.diagnosis import findings_of
    from texlab_core.measures.registry import measure_all
    from texlab_core.measures.subject import Subject

    subject = Subject.of_result(result, should_stop=interrupted)
    measures = measure_all(subject)
    return Made(result, measures, [each.to_json() for each in findings_of(result, subject)])


def _foretold(job: Job) -> str:
    """Return the method, with what a run is expected to take where that is known or much."""
    from texlab_core.engine.estimate import estimate_of, in_words, is_large
    from texlab_core.engine.registry import find_method

    expected = estimate_of(find_method(job.method), job.inputs, job.params, job.size)
    if expected.seconds is None and not is_large(expected, job.size):
        return job.method
    return f"{job.method}, {in_words(expected)}"


def summary_of(made: Made, outputs: Outputs) -> dict[str, Any]:
    """Return what was made as JSON data."""
    from texlab_core.documents.record import summary

    return summary(made.result, outputs.image, made.measures) | {"findings": made.findings}


def described(made: Made, outputs: Outputs) -> str:
    """Return what was made in a few lines for people."""
    from texlab_core.engine.sizes import size_text

    result = made.result
    job = result.job
    first = f"{size_text(job.size)} by {job.method}, seed {job.seed}, in {result.elapsed_s:.2f} s"
    read = dict.fromkeys(note for each in result.job.inputs.values() for note in getattr(each, "notes", ()))
    return "\n  ".join([f"{outputs.image}: {first}.", *read, *result.notes, *_saved(result, outputs)])


def _saved(result: Result, outputs: Outputs) -> list[str]:
    """Return what there is to say of depth and transparency."""
    from texlab_core.documents.record import carried_alpha, result_bits
    from texlab_core.images.formats.writing import can_hold_alpha

    exemplar = result.job.inputs.get("exemplar")
    said = []
    if outputs.bits is None and outputs.image.suffix.lower() != ".npy":
        bits = result_bits(result, outputs.image)
        own = getattr(exemplar, "depth", 8)
        shown = {8: "8 bits", 16: "16 bits", "float": "floats"}
        if own == bits and bits != 8:
            said.append(f"Saved in {shown[bits]}, as the exemplar has them.")
        elif own != bits:
            said.append(f"Saved in {shown[bits]}, the most that the format holds; the exemplar has {shown[own]}.")
    if getattr(exemplar, "alpha", None) is not None:
        if not can_hold_alpha(outputs.image):
            said.append("The format holds no transparency; choose PNG, TIFF or WebP to keep it.")
        elif carried_alpha(result) is None:
            said.append("The method keeps no places, so that the exemplar's transparency cannot come along.")
        else:
            said.append("The exemplar's transparency was carried along by the source map.")
    return said
