"""A parser whose errors are one sentence."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any, NoReturn

from texlab.cli.terminal import complain

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one sentence, and whose help may depend on what was typed.

    Parameters
    ----------
    given
        The whole command line.
    more_help
        Makes text to put below the help from ``given``.
    commands
        The parsers of its commands, by name.
    """

    given: Sequence[str] = ()
    more_help: Callable[[Sequence[str]], str] | None = None

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.commands: dict[str, Parser] = {}

    def error(self, message: str) -> NoReturn:
        """Print one sentence and leave with 2."""
        complain(f"{message.rstrip('.')}; see {self.prog} --help.", self.prog)
        self.exit(2)

    def format_help(self) -> str:
        """Return the help, followed by what ``more_help`` adds."""
        text = super().format_help()
        return text if self.more_help is None else f"{text}\n{self.more_help(self.given)}"
