"""``texlab export``: files, figures and animations of any selection of results, seeds and sizes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._figures import add_figure_options, parse_figure, refuse_figure_options
from texlab.cli.commands._options import (
    add_json_option,
    add_parameter_options,
    named_preset,
    output_file,
    output_folder,
    parse_number,
    parse_settings,
    refuse_overwriting,
)
from texlab.cli.commands._outputs import BITS, chosen_bits
from texlab.cli.commands._progress import share_bar
from texlab.cli.commands._sources import (
    add_input_options,
    add_scale_options,
    load_inputs,
    parse_inputs,
    parse_reading,
)
from texlab.cli.terminal import interrupted, logged_quietly
from texlab_core.errors import InputError, ParamError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from texlab.cli.parser import Parser
    from texlab_core.engine.job import Job
    from texlab_core.sheets.export import Export, Item

PROJECT_SUFFIX = ".texlab"
HELP = "Write results of any seeds and sizes as files, a figure or an animation."
ORDER = 14
NOTES = """
four seeds at two sizes:           texlab export wall.png --out made/ --seeds 1..4 --sizes 512x512,1024x1024
as deep as the exemplar, as TIFF:  texlab export wall.png --out made/ --format tif
from an image:                     texlab export wall.jpg --method de-bonet --out made/ --seeds 1..9
names, shown and not written:      texlab export wall.png --out made/ --name "{name}-{seed}" --seeds 1..4 --preview
all columns of a project:          texlab export work.texlab --out made/
a figure for print:                texlab export wall.png --out wall.pdf --seeds 1..6 --columns 3 --width-cm 8.5
a growth, a drag of a knob:        texlab export wall.png --out grow.webp --animate growth
                                   texlab export wall.png --out drag.gif --animate alpha=0.05:0.3:24
fields of --name:                  {name} {method} {title} {seed} {size} {width} {height} {index}
"""


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = NOTES
    parser.add_argument(
        "sources", nargs="+", metavar="RESULT|PROJECT|IMAGE", help="what TexLab saved; with --method one exemplar"
    )
    parser.add_argument("--out", required=True, metavar="DIR|FILE", help="folder to write to, or one file")
    parser.add_argument("--seeds", metavar="N..M,K", help="seeds to make (default: each result's own)")
    parser.add_argument(
        "--sizes", metavar="WxH,WxH", help="sizes to make; one number for all sides (default: each result's own)"
    )
    parser.add_argument("--format", metavar="ENDING", help="png, tif, exr, webp, jpg, avif or jxl (default png)")
    parser.add_argument("--bits", choices=BITS, help="for each sample (default: as the exemplar has)")
    parser.add_argument("--quality", metavar="N", help="1 to 100, of a format that may lose something")
    parser.add_argument("--name", metavar="PATTERN", help='names of the files, as in "{name}-{method}-{seed}"')
    parser.add_argument(
        "--recipe",
        choices=("inside", "beside", "none"),
        default="inside",
        help="where they go (default inside)",
    )
    parser.add_argument("--method", metavar="ID", help="make results of an image by this method")
    add_parameter_options(parser)
    add_scale_options(parser)
    add_input_options(parser)
    parser.add_argument("--animate", metavar="WHAT", help="growth, iterations, or a knob as in alpha=0.05:0.3:24")
    parser.add_argument("--frames", default="60", metavar="N", help="of a growth, 2 to 720 (default 60)")
    parser.add_argument("--rate", default="12", metavar="N", help="frames a second, 0.2 to 50 (default 12)")
    parser.add_argument("--back", action="store_true", help="a dragged knob goes back as well")
    add_figure_options(parser)
    parser.add_argument("--columns", metavar="N", help="of a figure: pictures in a row")
    parser.add_argument("--preview", action="store_true", help="say what would be written, and write nothing")
    add_json_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Check everything, run what is needed, write, report."""
    from texlab_core.sheets.export import selection
    from texlab_core.sheets.export_names import parse_seeds, parse_sizes
    from texlab_core.sheets.figure import is_figure

    seeds = () if args.seeds is None else parse_seeds(args.seeds)
    base = _base(args)
    sizes = () if args.sizes is None else parse_sizes(args.sizes, len(base[0].job.size))
    items = selection(base, seeds, sizes)
    if args.animate is not None:
        written, share = _animate(args, items)
    elif is_figure(args.out):
        written, share = _figure(args, items)
    else:
        written, share = _files(args, items)
    if args.json:
        print(json.dumps({"written": [str(path) for path in written], "preview": args.preview, **share}))
        return 0
    for path in written:
        print(path)
    verb = "would be written" if args.preview else "written"
    print(f"{len(written)} {'file' if len(written) == 1 else 'files'} {verb}.")
    return 0


def _base(args: argparse.Namespace) -> list[Item]:
    """Return the results that are named, or the one of an image and a method; none of them is made yet."""
    from texlab_core.documents.record import read_recipe
    from texlab_core.errors import NoRecipeError
    from texlab_core.sheets.export import Item

    if args.method is not None or args.preset is not None:
        if len(args.sources) > 1:
            raise InputError(f"With --method or --preset one exemplar is wanted, got {len(args.sources)}.")
        return [Item(_job(args))]
    wrong = [
        f"--{name.replace('_', '-')}"
        for name in ("set", "scale", "crop", "input", "input_scale", "input_crop")
        if getattr(args, name)
    ]
    if wrong:
        raise InputError(f"{wrong[0]} needs --method ID; a result is made again as it was.")
    found = []
    for source in args.sources:
        if source.lower().endswith(PROJECT_SUFFIX):
            found += _columns(source)
            continue
        try:
            found.append(Item(read_recipe(source).job()))
        except NoRecipeError as error:
            raise NoRecipeError(f"{str(error).rstrip('.')}; for an image say --method ID.") from error
    if len({len(item.job.size) for item in found}) > 1:
        raise InputError("Pictures and solids are exported one kind at a time.")
    return found


def _columns(source: str) -> list[Item]:
    """Return the columns of a project."""
    from texlab_core.documents.project_reading import read_project
    from texlab_core.sheets.export import Item

    project = read_project(source)
    if not project.columns:
        raise InputError(f"The project {source} has no columns.")
    return [Item(project.job(place), column.title) for place, column in enumerate(project.columns)]


def _job(args: argparse.Namespace) -> Job:
    from texlab_core.engine.job import Job
    from texlab_core.engine.registry import find_method

    preset = named_preset(args, args.method)
    method = find_method(args.method or (preset.method if preset is not None else ""))
    params = method.params.parse(parse_settings(args.set), None if preset is None else preset.params())
    inputs = load_inputs(args.sources[0], method, parse_reading(args), parse_inputs(args))
    return Job(method=method.id, inputs=inputs, params=params)


def _quality(args: argparse.Namespace) -> int | None:
    return None if args.quality is None else parse_number("quality", args.quality, int)


def _export(args: argparse.Namespace, folder: Path, suffix: str) -> Export:
    from texlab_core.sheets.export import Export
    from texlab_core.sheets.export_names import PATTERN

    pattern = PATTERN if args.name is None else args.name
    return Export(folder, pattern, suffix, chosen_bits(args), _quality(args), args.recipe)


def _files(args: argparse.Namespace, items: Sequence[Item]) -> tuple[Sequence[Path], dict[str, Any]]:
    from texlab_core.sheets.export import check_one, planned, run_export

    _refuse(args, "files", ("frames", "rate"), back=args.back)
    refuse_figure_options(args, ("columns",))
    out = Path(args.out)
    if _is_file(args.out):
        if len(items) > 1:
            raise ParamError("out", f"a folder for {len(items)} files", args.out)
        if args.name is not None:
            raise ParamError("name", "left out when --out is one file", args.name)
        if args.format is not None and f".{args.format.lower().lstrip('.')}" != out.suffix.lower():
            raise ParamError("format", f"left out, or that of {out.name}", args.format)
        export = _export(args, out.parent, out.suffix)
        paths = [out if args.preview else output_file(args.out)]
        check_one(export, items[0], paths[0])
    else:
        export = _export(args, out, f".{(args.format or 'png').lower().lstrip('.')}")
        output_folder(args.out)
        paths = list(planned(export, items))
    for path in paths:
        for source in args.sources:
            refuse_overwriting(path, source)
    if args.preview:
        return paths, {}
    with share_bar(f"{len(items)} files") as show, logged_quietly():
        return run_export(export, items, paths, on_progress=show, should_stop=interrupted), {}


def _is_file(text: str) -> bool:
    """Return whether a name asks for one file: it has an ending, and is no folder with a dot in its name."""
    from texlab_core.images.formats.writing import WRITABLE_SUFFIXES

    path = Path(text)
    if text.endswith(("/", "\\")) or not path.suffix:
        return False
    return path.suffix.lower() in WRITABLE_SUFFIXES or not path.is_dir()


def _refuse(args: argparse.Namespace, kind: str, names: Sequence[str], **given: object) -> None:
    defaults = {"frames": "60", "rate": "12", "recipe": "inside"}
    wrong = [name for name in names if getattr(args, name) != defaults.get(name)]
    wrong += [name for name, value in given.items() if value]
    if wrong:
        raise ParamError(wrong[0], f"left out for {kind}", getattr(args, wrong[0]))


def _figure(args: argparse.Namespace, items: Sequence[Item]) -> tuple[Sequence[Path], dict[str, Any]]:
    from texlab_core.files.whole import write_whole
    from texlab_core.sheets.export import export_tiles, run_items
    from texlab_core.sheets.figure import encode_figure, figure_page

    _refuse(args, "a figure", ("format", "bits", "quality", "name", "frames", "rate", "recipe"), back=args.back)
    columns = None if args.columns is None else parse_number("columns", args.columns, int)
    look = parse_figure(args, columns)
    assert look is not None
    out = output_file(args.out)
    if args.preview:
        return [out], {"panels": len(items)}
    with share_bar(f"{len(items)} panels") as show, logged_quietly():
        results = run_items(items, on_progress=show, should_stop=interrupted)
    page = figure_page(export_tiles(zip(items, results, strict=True)), look)
    write_whole(out, encode_figure(out, page))
    return [out], {"panels": len(items)}


def _animate(args: argparse.Namespace, items: Sequence[Item]) -> tuple[Sequence[Path], dict[str, Any]]:
    from texlab_core.sheets.export_animation import (
        animation_of,
        check_animation_target,
        draw_frames,
        write_animation,
    )

    _refuse(args, "an animation", ("format", "bits", "quality", "name"))
    if args.recipe == "beside":
        raise ParamError("recipe", "inside or none for an animation, which keeps it where it can", args.recipe)
    refuse_figure_options(args, ("columns",))
    if len(items) > 1:
        raise InputError(f"An animation is of one result, and {len(items)} are selected.")
    job = items[0].job
    frames, rate = parse_number("frames", args.frames, int), parse_number("rate", args.rate, float)
    animation = animation_of(args.animate, job, frames=frames, rate=rate, back=args.back)
    out = check_animation_target(args.out, animation)
    for source in args.sources:
        refuse_overwriting(out, source)
    if args.preview:
        return [out], {}
    with share_bar(args.animate) as show, logged_quietly():
        drawn, result = draw_frames(job, animation, on_progress=show, should_stop=interrupted)
        kept = None if args.recipe == "none" else result
        written = write_animation(out, drawn, kept, rate=rate, should_stop=interrupted)
    return written, {"frames": len(drawn)}
