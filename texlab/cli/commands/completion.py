"""``texlab completion``: a script that lets the shell complete commands, options and values."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab.cli.commands._completion import SHELLS

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser

HELP = "Print a script with which bash or zsh complete what you type."
ORDER = 80
EXAMPLES = """
bash:  texlab completion bash > ~/.local/share/bash-completion/completions/texlab
zsh:   texlab completion zsh > ~/.texlab-completion; add "source ~/.texlab-completion" to ~/.zshrc, after compinit
"""


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.epilog = EXAMPLES
    parser.add_argument("shell", choices=SHELLS, help="for which shell")


def execute(args: argparse.Namespace) -> int:
    """Print the script."""
    from texlab.cli.commands._completion import completion

    print(completion(args.whole_parser(), args.shell), end="")
    return 0
