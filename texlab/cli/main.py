"""The command line: finds the commands, parses, and turns every outcome into an exit code.

0 is success, 1 an unexpected error (the log has it), 2 something the user can mend, 130 an interruption.
"""

from __future__ import annotations

import argparse
import importlib
import io
import os
import pkgutil
import sys
from typing import TYPE_CHECKING, Protocol, cast

import texlab.cli.commands
from texlab.cli.parser import Parser
from texlab.cli.terminal import INTERRUPTED, append_to_log, complain, orderly_interrupts
from texlab_core.errors import Cancelled, InputError
from texlab_core.version import __version__

if TYPE_CHECKING:
    from collections.abc import Sequence

DESCRIPTION = "Explore example-based texture synthesis; without a command, the window opens."


class Command(Protocol):
    """What a module of ``texlab.cli.commands`` offers."""

    HELP: str
    ORDER: int

    def configure(self, parser: Parser, /) -> None:
        """Add the arguments."""

    def execute(self, args: argparse.Namespace, /) -> int:
        """Do it; return the exit code."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    argv
        Arguments after the program's name; None takes those of the process.

    Returns
    -------
    int
        The exit code.
    """
    _never_fail_on_unprintable()
    try:
        with orderly_interrupts():
            code = _run(list(sys.argv[1:] if argv is None else argv))
            _flush()
        return code
    except (KeyboardInterrupt, Cancelled):
        return INTERRUPTED
    except BrokenPipeError:  # the reader of the output went away ("texlab gallery | head")
        _discard_output()
        return 0
    except InputError as error:
        return _refuse(str(error))
    except OSError as error:
        _discard_output()
        if error.errno is None:  # raised by a library, not by the system
            return _report(error)
        # Whatever else is opened has a name.
        where = f"{error.filename}: " if error.filename else "Standard output cannot be written: "
        return _refuse(f"{where}{error.strerror}.")
    except MemoryError:
        return _refuse("There is not enough memory for this; try a smaller size.")
    except Exception as error:
        return _report(error)


def _run(given: Sequence[str]) -> int:
    given = _or_window(given)
    try:
        args = build_parser(given).parse_args(given)
    except SystemExit as end:  # argparse has printed help, version or an error
        return end.code if isinstance(end.code, int) else 0
    return int(args.execute(args))


def _or_window(given: Sequence[str]) -> list[str]:
    """Return the arguments of a command: nothing, a file or a texture alone are for the window."""
    alone = len(given) == 1 and given[0] not in find_commands()
    opens = not given or (alone and (given[0].startswith("gallery:") or os.path.isfile(given[0])))
    return ["gui", *given] if opens else list(given)


def main_gui() -> int:
    """Open the window: entry point without a console, so that a file can be dropped on the program's icon."""
    return main(["gui", *sys.argv[1:]])


def build_parser(given: Sequence[str] = ()) -> Parser:
    """Return the parser with every command of ``texlab.cli.commands``."""
    parser = Parser(prog="texlab", description=DESCRIPTION, allow_abbrev=False)
    parser.add_argument("--version", action="version", version=f"texlab {__version__}")
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, command in find_commands().items():
        each = subparsers.add_parser(
            name,
            help=command.HELP,
            description=command.HELP,
            allow_abbrev=False,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        each.given = given
        each.set_defaults(execute=command.execute)
        command.configure(each)
    return parser


def find_commands() -> dict[str, Command]:
    """Return the commands by name, in their order."""
    package = texlab.cli.commands
    names = [each.name for each in pkgutil.iter_modules(package.__path__) if not each.name.startswith("_")]
    modules = {
        name.replace("_", "-"): cast("Command", importlib.import_module(f"{package.__name__}.{name}"))
        for name in names
    }
    return dict(sorted(modules.items(), key=lambda item: (item[1].ORDER, item[0])))


def _refuse(sentence: str) -> int:
    complain(sentence)
    return 2


def _report(error: Exception) -> int:
    """Log an unexpected error; say so in one sentence."""
    import traceback

    from texlab.storage.paths import log_file

    what = f"Something unexpected happened ({type(error).__name__}: {' '.join(str(error).split())})"
    try:
        append_to_log("".join(traceback.format_exception(error)))
        where = f"the details are in {log_file()}"
    except OSError as trouble:
        where = f"the log {log_file()} could not be written ({trouble.strerror})"
    complain(f"{what}; {where}.")
    return 1


def _never_fail_on_unprintable() -> None:
    """Print what a terminal's encoding lacks as an escape, instead of failing."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _flush() -> None:
    """Let a broken pipe or a full disk show here rather than when Python ends."""
    if sys.stdout is not None:
        sys.stdout.flush()


def _discard_output() -> None:
    """Send what cannot be printed nowhere, so that Python does not fail on it once more when it ends."""
    try:
        _flush()
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
