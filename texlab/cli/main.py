"""The command line: finds the commands, parses, and turns every outcome into an exit code.

0 is success, 1 an unexpected error (the log has it), 2 something the user can mend, 130 an interruption.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
from typing import TYPE_CHECKING

from texlab.cli.catalogue import command_names, find_commands
from texlab.cli.defaults import with_defaults
from texlab.cli.facts import DEFAULTS, EXIT_CODES
from texlab.cli.parser import Parser
from texlab.cli.piping import standard_streams
from texlab.cli.terminal import INTERRUPTED, complain, orderly_interrupts, quietly
from texlab_core.errors import Cancelled, InputError
from texlab_core.version import __version__

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

DESCRIPTION = "Explore example-based texture synthesis; without a command, the window opens."


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
        parser = build_parser(given)
        given = with_defaults(parser, given)
        args = parser.parse_args(given)
    except SystemExit as end:  # argparse has printed help, version or an error
        return end.code if isinstance(end.code, int) else 0
    keep = getattr(args, "json", False)
    with quietly(getattr(args, "quiet", False), keep_output=keep), standard_streams(args, args.command):
        return int(args.command.execute(args))


def _or_window(given: Sequence[str]) -> list[str]:
    """Return the arguments of a command: nothing, a file or a texture alone are for the window."""
    alone = len(given) == 1 and given[0] not in command_names()
    opens = not given or (alone and (given[0].startswith("gallery:") or os.path.isfile(given[0])))
    return ["gui", *given] if opens else list(given)


def main_gui() -> int:
    """Open the window: entry point without a console, so that a file can be dropped on the program's icon."""
    return main(["gui", *sys.argv[1:]])


def build_parser(given: Sequence[str] = ()) -> Parser:
    """Return the parser of the command that is named first, or of all of them where none is.

    Parameters
    ----------
    given
        The command line.
    """
    parser = Parser(prog="texlab", description=DESCRIPTION, allow_abbrev=False, epilog=_codes())
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--version", action="version", version=f"texlab {__version__}")
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, command in find_commands(_wanted(given)).items():
        each = subparsers.add_parser(
            name,
            help=command.HELP,
            description=command.HELP,
            allow_abbrev=False,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        each.given = given
        each.set_defaults(command=command, whole_parser=build_parser)
        command.configure(each)
        if any("--out" in action.option_strings for action in each._actions):
            each.add_argument(
                "--quiet", action="store_true", help="no progress, and no output but errors and --json"
            )
        parser.commands[name] = each
    return parser


def _wanted(given: Sequence[str]) -> Collection[str]:
    """Return the commands whose parsers are needed: one, none for the version, else all."""
    names = command_names()
    if given and given[0] in names:
        return (given[0],)
    return () if given[:1] == ["--version"] else names


def _codes() -> str:
    lines = "\n".join(f"  {code:<4} {meaning}" for code, meaning in EXIT_CODES.items())
    return f"exit codes:\n{lines}\n\nDefaults of options are read from {DEFAULTS}; see texlab manpage."


def _refuse(sentence: str) -> int:
    complain(sentence)
    return 2


def _report(error: Exception) -> int:
    """Log an unexpected error; say so in one sentence."""
    import traceback

    from texlab.storage.log import append_to_log
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
