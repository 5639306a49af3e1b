"""``texlab manpage``: the manual page, made from the parser."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "Print the manual page, for man."
ORDER = 81
EXAMPLES = """
read it:     texlab manpage | man -l -
install it:  texlab manpage > ~/.local/share/man/man1/texlab.1
"""


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = EXAMPLES


def execute(args: argparse.Namespace) -> int:
    """Print the page."""
    from texlab.cli.commands._manual import manual

    print(manual(args.whole_parser()), end="")
    return 0
