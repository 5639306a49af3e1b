"""``texlab solid``: pictures of a saved solid, and animations of a turn or of a walk through its slices."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from texlab.cli.commands._options import add_json_option, output_file, parse_number, refuse_overwriting
from texlab.cli.terminal import interrupted
from texlab_core.errors import Cancelled, ParamError

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.engine.steps import FloatImage
    from texlab_core.solids.pictures import Place
    from texlab_core.solids.shots import Shot

HELP = "Draw a saved solid, or an animation of it."
ORDER = 13
NOTES = """
a picture:                    texlab solid block.tif --out block.png --shape torus
three slices and the object:  texlab solid block.tif --out cuts.png --show slices --at 20,30,40
a turn:                       texlab solid block.tif --out turn.webp --motion turn
a walk through the slices:    texlab solid block.tif --out walk.gif --motion yz --rate 12
"""


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = NOTES
    parser.add_argument("solid", metavar="SOLID", help="a solid that TexLab saved, .tif or .npy")
    parser.add_argument(
        "--out", required=True, metavar="OUT", help="file to write: .png; for a motion .apng, .png, .gif or .webp"
    )
    parser.add_argument(
        "--show",
        choices=("object", "both", "slices"),
        default="object",
        help="the object, also with the exemplar wrapped around it, or three slices and the object",
    )
    parser.add_argument("--shape", choices=("block", "sphere", "cylinder", "torus"), default="block")
    parser.add_argument(
        "--yaw", default="-30", metavar="DEGREES", help="turn about the upright axis (default -30)"
    )
    parser.add_argument("--pitch", default="24", metavar="A", help="degrees towards the viewer (default 24)")
    parser.add_argument("--zoom", default="1", metavar="Z", help="1 (default) fills the picture at any turn")
    parser.add_argument("--at", metavar="X,Y,Z", help="where the slices cross (default: the middle)")
    parser.add_argument(
        "--motion", choices=("turn", "xy", "xz", "yz"), help="turn the object, or walk through its slices"
    )
    parser.add_argument("--frames", default="60", metavar="N", help="of a turn, 2 to 720 (default 60)")
    parser.add_argument("--rate", default="25", metavar="N", help="frames a second, 0.2 to 50 (default 25)")
    parser.add_argument(
        "--side", default="400", metavar="N", help="of the object's picture, in pixels (default 400)"
    )
    add_json_option(parser)


def execute(args: argparse.Namespace) -> int:
    """Read the solid, draw, save, report."""
    from texlab_core.documents.reading import recipe_text
    from texlab_core.images.formats.volumes import read_volume, volume_of
    from texlab_core.solids.shots import check_shot, save_shot

    shot = _shot(args)
    check_shot(args.out, shot)
    out = output_file(args.out)
    refuse_overwriting(out, args.solid)
    volume = volume_of(read_volume(args.solid))

    def look() -> None:
        if interrupted():
            raise Cancelled

    exemplar = _exemplar(args.solid) if shot.show == "both" else None
    save_shot(out, volume, shot, recipe=recipe_text(args.solid), exemplar=exemplar, look=look)
    if args.json:
        depth, height, width, _ = volume.shape
        size = {"width": width, "height": height, "depth": depth}
        print(json.dumps({"out": str(out), "size": size, "show": args.show, "motion": args.motion}))
    else:
        print(f"{out}: {args.show if args.motion is None else args.motion} of {args.solid}.")
    return 0


def _shot(args: argparse.Namespace) -> Shot:
    from texlab_core.solids.pictures import Turn, Walk
    from texlab_core.solids.rendering import View
    from texlab_core.solids.shots import Shot

    yaw, pitch, zoom = (parse_number(name, getattr(args, name), float) for name in ("yaw", "pitch", "zoom"))
    turn = Turn(parse_number("frames", args.frames, int))
    return Shot(
        show=args.show,
        view=View(args.shape, yaw, pitch, zoom),
        motion=None if args.motion is None else turn if args.motion == "turn" else Walk(args.motion),
        place=None if args.at is None else _place(args.at),
        side=parse_number("side", args.side, int),
        rate=parse_number("rate", args.rate, float),
    )


def _place(text: str) -> Place:
    parts = [part.strip() for part in text.split(",")]
    if len(parts) != 3 or not all(part.isascii() and part.isdigit() and len(part) < 9 for part in parts):
        raise ParamError("at", "three whole numbers as in 20,30,40", text)
    x, y, z = map(int, parts)
    return z, y, x


def _exemplar(path: str) -> FloatImage:
    """Return the exemplar that the solid was made from; raises ``RecipeError`` when the file does not hold it."""
    from texlab_core.documents.reading import read_recipe
    from texlab_core.engine.inputs import ImageInput

    found = read_recipe(path).inputs["exemplar"].restore()
    assert isinstance(found, ImageInput)
    return found.pixels
