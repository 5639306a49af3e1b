"""The commands: what each one offers, and how they are found."""

from __future__ import annotations

import importlib
import pkgutil
from typing import TYPE_CHECKING, Protocol, cast

import texlab.cli.commands

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection

    from texlab.cli.parser import Parser


class Command(Protocol):
    """What a module of ``texlab.cli.commands`` offers.

    It may also have ``READS``, the names of arguments that take ``-`` for an image on standard input, and
    ``WRITES``, the ending of what ``--out -`` writes to standard output.
    """

    HELP: str
    ORDER: int

    def configure(self, parser: Parser, /) -> None:
        """Add the arguments."""

    def execute(self, args: argparse.Namespace, /) -> int:
        """Do it; return the exit code."""


def command_names() -> tuple[str, ...]:
    """Return the names of all commands; imports none of them."""
    found = pkgutil.iter_modules(texlab.cli.commands.__path__)
    return tuple(each.name.replace("_", "-") for each in found if not each.name.startswith("_"))


def find_commands(names: Collection[str] | None = None) -> dict[str, Command]:
    """Return commands (all of them) by name, in their order."""
    package = texlab.cli.commands.__name__
    modules = {
        name: cast("Command", importlib.import_module(f"{package}.{name.replace('-', '_')}"))
        for name in (command_names() if names is None else names)
    }
    return dict(sorted(modules.items(), key=lambda item: (item[1].ORDER, item[0])))
