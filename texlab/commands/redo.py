"""``texlab redo``: make a saved result again, from its file alone."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from texlab.commands._options import refuse_overwriting
from texlab.commands.synth import Outputs, add_output_options, check_outputs, described, make, summary_of

if TYPE_CHECKING:
    import argparse

    from texlab.cli import Parser
    from texlab_core.image_files import Decoded
    from texlab_core.image_writing import Bits
    from texlab_core.recipes import Recipe

HELP = "Make a saved result again, from the recipe inside it."
ORDER = 15


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("result", metavar="RESULT.png", help="a result that TexLab saved")
    parser.add_argument("--exemplar", metavar="IMAGE", help="the exemplar, where the file does not hold it")
    add_output_options(parser)


def execute(args: argparse.Namespace) -> int:
    """Read the recipe, follow it, compare."""
    from texlab_core.record import read_recipe

    recipe = read_recipe(args.result)
    before = _pixels(args.result)
    outputs = check_outputs(args, _bits(args, before))
    if args.exemplar is not None:
        refuse_overwriting(outputs.image, args.exemplar)
    elif recipe.missing:
        from texlab_core.errors import RecipeError

        raise RecipeError(f"{args.result} does not hold {recipe.missing[0].described}; give it with --exemplar.")
    result = make(recipe.job(args.exemplar), outputs)
    same = _same_bits(before, outputs)
    if args.json:
        print(json.dumps(summary_of(result, outputs) | {"same_bits": same}))
    else:
        print(described(result, outputs))
        if same:
            print(f"  The same bits as in {args.result}.")
    if same is False:
        print(f"texlab: {_difference(args.result, recipe)}", file=sys.stderr)
    return 0


def _pixels(path: str) -> Decoded | None:
    """Return the saved image; None for one whose format loses bits, or a recipe without an image."""
    from texlab_core.image_files import read_image

    if Path(path).suffix.lower() not in (".png", ".tif", ".tiff"):
        return None
    return read_image(Path(path), path)


def _bits(args: argparse.Namespace, before: Decoded | None) -> Bits:
    """Return the depth that was asked for, else that of the result when the new file can hold it."""
    from texlab_core.image_writing import check_format

    bits: dict[str, Bits] = {"8": 8, "16": 16, "float": "float"}
    if args.bits is not None:
        return bits[args.bits]
    if before is None:
        return 8
    depth: Bits = {255: 8, 65535: 16}.get(before.peak, "float")  # type: ignore[assignment, arg-type]
    try:
        check_format(args.out, depth)
    except ValueError:
        return 8
    return depth


def _same_bits(before: Decoded | None, outputs: Outputs) -> bool | None:
    """Return whether old and new file hold the same pixels; None when their formats cannot be compared."""
    import numpy as np

    after = _pixels(str(outputs.image))
    if before is None or after is None or before.peak != after.peak:
        return None
    return bool(np.array_equal(before.values, after.values))


def _difference(name: str, recipe: Recipe) -> str:
    changed = [f"{library} {then} then, {today} here" for library, (then, today) in recipe.other_versions.items()]
    why = f"the versions differ ({'; '.join(changed)})" if changed else "the image was changed after it was saved"
    return f"The result is not bit for bit that of {name}: {why}."
