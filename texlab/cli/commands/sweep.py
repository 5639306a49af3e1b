"""``texlab sweep``: one or two knobs over ranges, as a contact sheet."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._figures import SHEET, add_figure_options, parse_figure
from texlab.cli.commands._options import (
    add_json_option,
    named_preset,
    output_file,
    parse_number,
    parse_result_size,
    parse_settings,
    refuse_overwriting,
)
from texlab.cli.commands._places import add_place_options, elsewhere, parse_place
from texlab.cli.commands._progress import share_bar
from texlab.cli.commands._sources import (
    add_input_options,
    add_scale_options,
    load_others,
    parse_inputs,
    parse_reading,
)
from texlab.cli.terminal import complain, interrupted, logged_quietly

if TYPE_CHECKING:
    from texlab.cli.parser import Parser
    from texlab_core.engine.inputs import ImageInput, Input
    from texlab_core.sheets.sweep import Cell, Sweep
    from texlab_core.sheets.sweep_recipes import SweepRecipe

HELP = "Vary one or two parameters and save a contact sheet."
ORDER = 15
READS = ("image",)
WRITES = ".png"
EXAMPLES = """
a range of six values, evenly:        --vary alpha=0.05:0.3:6
a range of five in even ratios:       --vary alpha=0.01:1:5:log
a list:                               --vary border=reflect,periodic
variations:                           --vary seed=1:12:12
two parameters, across and down:      --vary alpha=0.1,0.2 --vary beta=0,1
from one texture to another:          --method mixture --vary weight=0:1:5 --input second=wall.jpg
one preset over many textures:        --preset NAME --textures gallery:structured
a folder, three variations of each:   --textures photos --vary seed=1:3:3
a ready-made sweep, or an old sheet:  --sweep de-bonet-fig-11, --sweep SHEET.png
"""


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = EXAMPLES
    parser.add_argument("image", nargs="?", metavar="IMAGE|gallery:NAME", help="the exemplar")
    parser.add_argument(
        "--textures",
        action="append",
        default=[],
        metavar="FOLDER|GLOB|gallery:CLASS",
        help="these textures across, in cells of one size, instead of one exemplar; --vary stands down",
    )
    parser.add_argument("--method", metavar="ID", help="one of texlab methods")
    parser.add_argument(
        "--vary", action="append", default=[], metavar="NAME=FROM:TO:COUNT[:log]", help="see below"
    )
    parser.add_argument("--out", required=True, metavar=SHEET, help="file to write; carries the sweep")
    parser.add_argument("--sweep", metavar="NAME|FILE", help="start from a ready-made sweep, a file or a sheet")
    # As it was called in the first versions.
    parser.add_argument("--recipe", dest="sweep", metavar="NAME|FILE", help=argparse.SUPPRESS)
    parser.add_argument("--preset", metavar="NAME|FILE", help="start from the parameters of a preset")
    parser.add_argument(
        "--size", metavar="WxH|WxHxD", help="of each result; one number for all sides (default: the exemplar's)"
    )
    parser.add_argument("--seed", metavar="N", help="the same seed gives the same bits (default 0)")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set one parameter")
    add_scale_options(parser)
    add_input_options(parser)
    add_figure_options(parser)
    parser.add_argument("--columns", metavar="N", help="pictures in a row of a series")
    add_place_options(parser, "run the cells in so many processes (default: in threads of this one)")
    parser.add_argument("--cell", default="512", metavar="N", help="longest side shown, 64 to 512 (default 512)")
    add_json_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Check everything, run the cells, save the sheet, report."""
    from texlab_core.engine.registry import find_method
    from texlab_core.errors import ParamError
    from texlab_core.sheets.contact_sheet import check_sheet
    from texlab_core.sheets.sweep_running import run_sweep, run_sweep_elsewhere
    from texlab_core.sheets.sweep_sheet import sheet_columns, write_sheet

    out = output_file(args.out)
    look = parse_figure(args)
    columns = None if args.columns is None else parse_number("columns", args.columns, int)
    if columns is not None and columns < 1:
        raise ParamError("columns", "a whole number from 1", columns)
    largest = parse_number("cell", args.cell, int)
    if not 64 <= largest <= 512:
        raise ParamError("cell", "a whole number from 64 to 512", largest)
    place, others = parse_place(args), parse_inputs(args)
    recipe, exemplar, textures = plan(args)
    sources = [args.image or (recipe.exemplar.name if recipe.exemplar else ""), *textures]
    sources += [each.place for each in others.values()]
    sources += [each.name for each in (*recipe.inputs.values(), *recipe.textures)]
    for source in sources:
        refuse_overwriting(out, source)
    further, left_out = load_others(others, find_method(recipe.method)), ""
    if textures:
        sweep, left_out = _grid(args, recipe, textures, further)
    else:
        sweep = recipe.sweep(exemplar, further)
    across = sheet_columns(sweep, columns)
    if look is None:
        check_sheet(len(sweep.jobs), across, sweep.base.picture_size, largest)
    with (
        share_bar(f"{len(sweep.jobs)} x {sweep.base.method}") as show,
        logged_quietly(),
        elsewhere(place) as there,
    ):
        if there is None:
            cells = run_sweep(sweep, on_progress=show, should_stop=interrupted)
        else:
            cells = run_sweep_elsewhere(sweep, on_progress=show, should_stop=interrupted, elsewhere=there)
    write_sheet(out, sweep, cells, name=recipe.name, note=recipe.note, columns=across, largest=largest, look=look)
    report(sweep, cells, str(out), as_json=args.json)
    if left_out:
        complain(left_out)
    return 0


def _grid(
    args: argparse.Namespace, recipe: SweepRecipe, textures: list[str], further: dict[str, Input]
) -> tuple[Sweep, str]:
    """Return the grid over the textures that were named, and what is said of those that have no place in it."""
    from texlab_core.errors import InputError
    from texlab_core.sheets.texture_grid import left_out_words, read_textures

    reading = parse_reading(args)
    scale = None if args.scale is None else reading.scale
    found, unread = read_textures(textures, scale=scale, crop=reading.crop, should_stop=interrupted)
    if not found:
        raise InputError(unread[0][1])
    grid, unfit = recipe.grid(found, further)
    return grid, left_out_words((*unread, *unfit))


def _textures(args: argparse.Namespace) -> list[str]:
    """Return the textures that ``--textures`` names, each once; raises ``InputError``."""
    from texlab_core.images.sources import sources_of

    found = (source for text in args.textures for source, _ in sources_of(text, Path(), "textures"))
    return list(dict.fromkeys(found))


def plan(args: argparse.Namespace) -> tuple[SweepRecipe, ImageInput | None, list[str]]:
    """Return what is to be done, with which exemplar, or over which textures.

    What is named on the command line comes first.
    """
    import dataclasses

    from texlab_core.engine.registry import find_method
    from texlab_core.errors import InputError
    from texlab_core.sheets.sweep import Vary
    from texlab_core.sheets.sweep_recipes import SweepRecipe
    from texlab_core.sheets.sweep_sources import find_sweep

    recipe = None if args.sweep is None else find_sweep(args.sweep)
    preset = named_preset(args, args.method)
    chosen = args.method or (preset and preset.method) or (recipe and recipe.method)
    if not chosen:
        raise InputError("A sweep needs a method: say --method ID, --preset NAME or --sweep NAME.")
    method = find_method(chosen)
    if recipe is not None and recipe.method != method.id:
        raise InputError(f"The sweep {recipe.name} is for the method {recipe.method}, not for {method.id}.")
    params = method.params() if recipe is None else recipe.params
    params = params if preset is None else preset.params(params)
    params = method.params.parse(parse_settings(args.set), params)
    axes = tuple(Vary.parse(text, method.params) for text in args.vary) or (recipe.axes if recipe else ())
    textures = _textures(args)
    if textures and args.image is not None:
        raise InputError("A sweep has one exemplar or --textures, not both.")
    if not axes and not textures and not (recipe is not None and recipe.textures):
        raise InputError("A sweep varies one or two knobs: say --vary NAME=FROM:TO:COUNT or --sweep NAME.")
    base = SweepRecipe(name="sweep", method=method.id, axes=axes) if recipe is None else recipe
    changes: dict[str, Any] = {"axes": axes, "parameters": params.to_json()}
    if args.size is not None:
        changes["size"] = parse_result_size(args.size, method.dimensions)
    if args.seed is not None:
        changes["seed"] = parse_number("seed", args.seed, int)
    reading = parse_reading(args)
    if args.image is not None:
        return dataclasses.replace(base, **changes, textures=()), reading.read(args.image), []
    if textures or base.textures:
        return dataclasses.replace(base, **changes), None, textures
    if base.exemplar is None:
        raise InputError("A sweep needs an exemplar: name an image or gallery:NAME, or --textures FOLDER.")
    choice = dataclasses.replace(
        base.exemplar,
        sha256=base.exemplar.sha256 if args.scale is None and args.crop is None else "",
        scale=base.exemplar.scale if args.scale is None else reading.scale,
        crop=base.exemplar.crop if args.crop is None else reading.crop,
    )
    return dataclasses.replace(base, **changes), choice.load(), []


def report(sweep: Sweep, cells: tuple[Cell, ...], out: str, *, as_json: bool) -> None:
    """Print what was made: one JSON object, or a line for each cell."""
    if not as_json:
        for cell in cells:
            print(f"{cell.label}{f': {cell.error}' if cell.error else ''}")
        failed = sum(bool(cell.error) for cell in cells)
        print(f"{out}: {len(cells)} cells{f', {failed} failed' if failed else ''}")
        return
    from texlab_core.engine.sizes import size_to_json

    base = sweep.base
    exemplar: Any = base.inputs["exemplar"]
    textures = getattr(sweep, "textures", ())
    answer = {
        "method": base.method,
        "parameters": base.params.to_json(),
        "size": size_to_json(base.size),
        "seed": base.seed,
        "vary": [{"name": axis.name, "values": list(axis.values)} for axis in sweep.axes],
        "out": out,
        "exemplar": None if textures else {"name": exemplar.name, "sha256": exemplar.sha256},
        "textures": [{"name": each.name, "sha256": each.sha256} for each in textures],
        "cells": [
            {
                "values": dict(cell.values),
                "copied": cell.measures.get("copied-share"),
                "candidates": cell.measures.get("median-candidates"),
                "measures": dict(cell.measures),
                "elapsed_s": None if cell.result is None else cell.result.elapsed_s,
                "error": cell.error or None,
            }
            for cell in cells
        ],
    }
    print(json.dumps(answer, default=lambda value: value.to_json(), allow_nan=False))
