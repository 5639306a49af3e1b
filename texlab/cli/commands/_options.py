"""Options that several commands share, checked before any work starts."""

from __future__ import annotations

import os
import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from texlab_core.errors import InputError, ParamError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from texlab.cli.parser import Parser
    from texlab_core.documents.preset_store import PresetStore
    from texlab_core.documents.presets import Preset
    from texlab_core.engine.inputs import Crop
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method

NumberT = TypeVar("NumberT", int, float)


def parse_size(text: str) -> tuple[int, int]:
    """Return (height, width) from ``WxH``, or one number for both; raises ``ParamError``."""
    from texlab_core.engine.sizes import size_from_text

    height, width = size_from_text(text)
    return height, width


def parse_result_size(text: str, dimensions: int) -> tuple[int, ...]:
    """Return the same, or (depth, height, width) from ``WxHxD``; raises ``ParamError``."""
    from texlab_core.engine.sizes import size_from_text

    return size_from_text(text, dimensions)


def parse_crop(text: str, name: str = "crop") -> Crop:
    """Return the rectangle from ``WxH+X+Y``; raises ``ParamError``."""
    found = re.fullmatch(r"([0-9]{1,9})[xX×]([0-9]{1,9})\+([0-9]{1,9})\+([0-9]{1,9})", text.strip())
    width, height, left, top = (0, 0, 0, 0) if found is None else map(int, found.groups())
    if not width or not height:
        raise ParamError(name, "width, height, left and top as in 256x192+10+20", text)
    from texlab_core.engine.inputs import Crop

    return Crop(top=top, left=left, height=height, width=width)


def parse_settings(texts: Sequence[str]) -> dict[str, str]:
    """Return the names and values of ``--set name=value``; raises ``InputError``."""
    settings: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        name = name.strip().replace("-", "_")
        if not equals or not name:
            raise ParamError("set", "a name and a value as in iterations=5", text)
        if name in settings:
            raise InputError(f"{name} is set twice.")
        settings[name] = value
    return settings


def parse_number(name: str, text: str, kind: type[NumberT]) -> NumberT:
    """Return the number that a text stands for; raises ``ParamError``. Whoever takes it checks its range."""
    try:
        return kind(text)
    except ValueError:
        raise ParamError(name, "a whole number" if kind is int else "a number", text) from None


def output_file(text: str) -> Path:
    """Return the path of a file that can be written.

    Raises
    ------
    InputError
        When the name is empty, it is no file that can be replaced (a folder, a pipe, a link that leads nowhere,
        something write-protected), or its folder is missing or cannot be written to.
    """
    from texlab_core.files.whole import check_target

    path = check_target(text)
    _check_writable(Path(os.path.realpath(path)).parent)
    return path


def output_folder(text: str) -> Path:
    """Return the path of a folder that can be written to, or made in one that is there; raises ``InputError``."""
    path = Path(text)
    if not text:
        raise InputError("The name of the folder is empty.")
    if path.exists() and not path.is_dir():
        raise InputError(f"{text} is a file, and a folder is wanted.")
    if path.is_symlink() and not path.exists():
        raise InputError(f"{text} is a link to a folder that does not exist.")
    _check_writable(path if path.exists() else path.parent)
    return path


def refuse_overwriting(out: Path, source: str) -> None:
    """Raise ``InputError`` when writing ``out`` would destroy the image that the result is made from."""
    if out.exists() and os.path.exists(source) and os.path.samefile(out, source):
        raise InputError(f"{out} is what the result is made from; choose another file for --out.")


def _check_writable(folder: Path) -> None:
    if not folder.is_dir():
        raise InputError(f"The folder {folder} does not exist.")
    try:
        # The only question that every system answers truthfully.
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(f"The folder {folder} cannot be written to ({error.strerror}).") from error


def add_json_option(parser: Parser) -> None:
    """Add ``--json``."""
    parser.add_argument("--json", action="store_true", help="print one JSON object on standard output")


def add_parameter_options(parser: Parser, words: str = "start from these parameters") -> None:
    """Add ``--preset``, with its help in ``words``, and ``--set``; :func:`parse_parameters` reads both."""
    parser.add_argument("--preset", metavar="NAME|FILE", help=words)
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set one parameter")


def parse_parameters(args: argparse.Namespace, method: Method) -> Params:
    """Return the parameters of a method: its defaults, over them the preset's, over them what is set."""
    settings = parse_settings(args.set)
    preset = named_preset(args, method.id)
    return method.params.parse(settings, None if preset is None else preset.params())


def named_preset(args: argparse.Namespace, method: str | None) -> Preset | None:
    """Return the preset that ``--preset`` names (of one method), if any; raises ``InputError``."""
    if args.preset is None:
        return None
    from texlab_core.documents.preset_store import find_preset

    return find_preset(args.preset, own_presets(), method)


def own_presets() -> PresetStore:
    """Return the user's presets."""
    from texlab.storage.paths import config_dir
    from texlab_core.documents.preset_store import PresetStore

    return PresetStore(config_dir() / "presets")
