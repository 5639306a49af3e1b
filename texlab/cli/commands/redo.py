"""``texlab redo``: make a saved result again, from its file alone."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from texlab.cli.commands._options import refuse_overwriting
from texlab.cli.commands._outputs import (
    Outputs,
    add_output_options,
    check_outputs,
    chosen_bits,
    described,
    make,
    summary_of,
)
from texlab.cli.commands._sources import by_name
from texlab.cli.terminal import complain, interrupted
from texlab_core.errors import RecipeError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Mapping

    from texlab.cli.parser import Parser
    from texlab_core.documents.recipe import Recipe
    from texlab_core.images.formats.decoded import Decoded
    from texlab_core.images.formats.writing import Bits

HELP = "Make a saved result again, from the recipe inside it."
ORDER = 15
READS = ("result", "exemplar")
WRITES = ".png"


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("result", metavar="RESULT", help="a result that TexLab saved")
    parser.add_argument("--exemplar", metavar="IMAGE", help="the exemplar, where the file does not hold it")
    parser.add_argument(
        "--input",
        action="append",
        default=[],
        metavar="NAME=IMAGE",
        help="another image that the file does not hold, as in start=wall.jpg",
    )
    add_output_options(parser)


def execute(args: argparse.Namespace) -> int:
    """Read the recipe, follow it, compare."""
    from texlab_core.documents.record import read_recipe

    recipe = read_recipe(args.result)
    dimensions = len(recipe.size)
    before = _pixels(args.result, dimensions)
    outputs = check_outputs(args, _bits(args, before, dimensions), dimensions)
    given = _given(args)
    for image in given.values():
        refuse_overwriting(outputs.image, image)
    _check_missing(args.result, recipe, given)
    made = make(recipe.job(given=given), outputs, keep=tuple(given.values()), measured=args.json)
    same = _same_bits(before, outputs, dimensions)
    if args.json:
        print(json.dumps(summary_of(made, outputs) | {"same_bits": same, "measures_then": dict(recipe.measures)}))
    else:
        print(described(made, outputs))
        if then := _measured_then(recipe):
            print(f"  {args.result} was saved with {then}.")
        if same:
            print(f"  The same bits as in {args.result}.")
    if same is False:
        complain(_difference(args.result, recipe))
    return 0


def _measured_then(recipe: Recipe) -> str:
    """Return the numbers that the file holds, as they are written everywhere."""
    from texlab_core.measures.registry import measures, written

    return ", ".join(written(recipe.measures, measures()))


def _given(args: argparse.Namespace) -> dict[str, str]:
    """Return the images that were named, by the role they have in the recipe."""
    given = {} if args.exemplar is None else {"exemplar": args.exemplar}
    return by_name(args.input, "input", "a name and an image as in start=wall.jpg", given)


def _check_missing(name: str, recipe: Recipe, given: Mapping[str, str]) -> None:
    """Raise ``RecipeError`` when the file lacks an input that was not given either."""
    held = {recipe.inputs[role].sha256 for role in given if role in recipe.inputs}
    for each in recipe.missing:
        if each.role in given or each.sha256 in held:
            continue
        option = "--exemplar" if each.role == "exemplar" else f"--input {each.role}=IMAGE"
        remedy = f"; give it with {option}." if each.kind == "image" else ", and cannot be made again without it."
        raise RecipeError(f"{name} does not hold {each.described}{remedy}")


def _pixels(path: str, dimensions: int) -> Decoded | None:
    """Return the saved image or volume; None where the format loses bits, or for a recipe or a picture alone."""
    if dimensions == 3:
        from texlab_core.images.formats.volumes import VOLUME_SUFFIXES, read_volume

        return read_volume(path) if Path(path).suffix.lower() in VOLUME_SUFFIXES else None
    from texlab_core.images.formats.reading import read_image

    if Path(path).suffix.lower() not in (".png", ".tif", ".tiff"):
        return None
    return read_image(Path(path), path, should_stop=interrupted)


def _bits(args: argparse.Namespace, before: Decoded | None, dimensions: int) -> Bits | None:
    """Return the depth that was asked for, else that of the result when the new file can hold it."""
    from texlab_core.documents.record import check_result_format

    if args.bits is not None or before is None:
        return chosen_bits(args)
    depth: Bits = {255: 8, 65535: 16}.get(before.peak, "float")  # type: ignore[assignment, arg-type]
    try:
        check_result_format(args.out, depth, dimensions)
    except ValueError:
        return None
    return depth


def _same_bits(before: Decoded | None, outputs: Outputs, dimensions: int) -> bool | None:
    """Return whether old and new file hold the same pixels; None when their formats cannot be compared."""
    import numpy as np

    after = _pixels(str(outputs.image), dimensions)
    if before is None or after is None or before.peak != after.peak:
        return None
    return bool(np.array_equal(before.values, after.values))


def _difference(name: str, recipe: Recipe) -> str:
    changed = [f"{library} {then} then, {today} here" for library, (then, today) in recipe.other_versions.items()]
    why = f"the versions differ ({'; '.join(changed)})" if changed else "the image was changed after it was saved"
    return f"The result is not bit for bit that of {name}: {why}."
