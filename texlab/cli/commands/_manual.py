"""The manual page in the macros of man(7), made from the parser."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.cli.facts import DEFAULTS, EXIT_CODES
from texlab_core.version import __version__

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from texlab.cli.parser import Parser

_ON_DEFAULTS = (
    f"The file {DEFAULTS} in the folder of settings holds defaults for options in TOML: a table for each command, "
    "in it the options without their hyphens. What is said on the command line comes first; what may be given "
    "several times is added to. A switch is true or false."
)
_ENVIRONMENT = {
    "TEXLAB_HOME": "A folder that takes the place of those for settings, presets and logs.",
    "NO_COLOR": "When it is set and not empty, progress is shown without colours.",
    "QT_QPA_PLATFORM": "How Qt draws; offscreen needs no display.",
}


def manual(parser: Parser) -> str:
    """Return the page.

    Parameters
    ----------
    parser
        With every command.
    """
    return "\n".join(_lines(parser)) + "\n"


def _lines(parser: Parser) -> Iterator[str]:
    yield f'.TH TEXLAB 1 "" "TexLab {_text(__version__)}" "User Commands"'
    yield from (".SH NAME", "texlab \\- explore example-based texture synthesis")
    yield from (".SH SYNOPSIS", ".B texlab", "[\\fIFILE\\fR | gallery:\\fINAME\\fR]", ".br", ".B texlab")
    yield "\\fICOMMAND\\fR [\\fIOPTION\\fR]..."
    yield from (".SH DESCRIPTION", _text(parser.description or ""))
    yield from ("A file or a texture of the gallery alone opens the window with it.", ".SH COMMANDS")
    for name, command in parser.commands.items():
        yield from _command(f"texlab {name}", command)
    yield from (".SH DEFAULTS", _text(_ON_DEFAULTS), ".PP", ".nf", "[synth]", 'method = "de\\-bonet"', ".fi")
    yield ".SH EXIT STATUS"
    for code, meaning in EXIT_CODES.items():
        yield from (".TP", f".B {code}", f"{_text(meaning)}.")
    yield ".SH ENVIRONMENT"
    for name, meaning in _ENVIRONMENT.items():
        yield from (".TP", f".B {name}", _text(meaning))


def _command(title: str, parser: Parser) -> Iterator[str]:
    yield from (f".SS {_text(title)}", _text(parser.description or ""))
    inner = [action for action in parser._actions if action.nargs == "A..."]
    for action in parser._actions:
        if action in inner or "--help" in action.option_strings:
            continue
        yield from (".TP", _heading(action), _text(_help(parser, action)))
    if parser.epilog:
        # As it is laid out in the help.
        yield from (".PP", ".nf", *(_text(line) for line in parser.epilog.strip("\n").splitlines()), ".fi")
    for action in inner:
        commands: Any = action.choices or {}
        for name, each in commands.items():
            yield from _command(f"{title} {name}", each)


def _heading(action: argparse.Action) -> str:
    value = "" if action.nargs == 0 else f"\\fI{_text(_value(action))}\\fR"
    if not action.option_strings:
        return value
    names = ", ".join(f"\\fB{_text(option)}\\fR" for option in action.option_strings)
    return f"{names} {value}".strip()


def _value(action: argparse.Action) -> str:
    if isinstance(action.metavar, str):
        return action.metavar
    if action.choices is not None:
        return "|".join(map(str, action.choices))
    return action.dest.upper()


def _help(parser: Parser, action: argparse.Action) -> str:
    text = (action.help or "").replace("%%", "%")
    sentence = f"{text[:1].upper()}{text[1:]}".rstrip(".")
    required = " (required)" if action.required and action.option_strings else ""
    return f"{sentence or 'See above'}{required}."


def _text(text: str) -> str:
    """Return a text in which nothing is taken for a request or an escape."""
    safe = text.replace("\\", "\\e").replace("-", "\\-").replace("^", "\\(ha").replace("~", "\\(ti")
    return "\n".join(f"\\&{line}" if line[:1] in (".", "'") else line for line in safe.splitlines())
