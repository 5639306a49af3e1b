"""Defaults of options from a file: ``defaults.toml`` in the folder of settings, a table for each command.

    [synth]
    method = "de-bonet"
    size = "256x256"

    [batch]
    processes = 4

What is said on the command line comes first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.cli.catalogue import command_names
from texlab.cli.facts import DEFAULTS
from texlab_core.errors import InputError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence
    from pathlib import Path

    from texlab.cli.parser import Parser

MAX_BYTES = 2**20


def defaults_file() -> Path:
    """Return where the defaults are (the file may not exist)."""
    from texlab.storage.paths import config_dir

    return config_dir() / DEFAULTS


def with_defaults(parser: Parser, given: Sequence[str]) -> list[str]:
    """Return the command line with the defaults of its command put before what was given.

    Raises
    ------
    InputError
        When the file cannot be read, or names a command or an option that does not exist.
    """
    words = list(given)
    if not words or words[0] not in parser.commands:
        return words
    tables = _tables(defaults_file())
    table = tables.get(words[0], {})
    command = parser.commands[words[0]]
    chosen: list[str] = []
    for key, value in table.items():
        action = _action(command, words[0], key)
        if not _excluded(command, action, words[1:]):
            chosen += _words(action, key, value)
    # The help of a command may depend on what was chosen.
    command.given = [words[0], *chosen, *words[1:]]
    return list(command.given)


def _tables(path: Path) -> dict[str, dict[str, Any]]:
    import tomllib

    from texlab_core.files.regular import TooLongError, read_regular, reason

    try:
        text = read_regular(path, MAX_BYTES)
    except (FileNotFoundError, NotADirectoryError):
        if path.is_symlink():
            raise InputError(f"The defaults in {path} cannot be read (the link leads nowhere).") from None
        return {}
    except TooLongError as error:
        raise InputError(
            f"The defaults in {path} are longer than {MAX_BYTES} bytes, the most that is read."
        ) from error
    except OSError as error:
        raise InputError(f"The defaults in {path} cannot be read ({reason(error)}).") from error
    try:
        found = tomllib.loads(text.decode("utf-8-sig"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"The defaults in {path} are not valid TOML ({str(error).rstrip('.')}).") from error
    for name, table in found.items():
        if name not in command_names() or not isinstance(table, dict):
            raise InputError(f"{path}: a table must be one of {', '.join(command_names())}, got {name!r:.40}.")
    return found


def _action(command: Parser, name: str, key: str) -> argparse.Action:
    options = command._option_string_actions
    option = f"--{key.replace('_', '-')}"
    if option not in options or option == "--help":
        known = sorted(each[2:] for each in options if each.startswith("--") and each != "--help")
        raise InputError(
            f"{DEFAULTS}: a default of texlab {name} must be one of {', '.join(known)}, got {key!r:.40}."
        )
    return options[option]


def _excluded(command: Parser, action: argparse.Action, words: Sequence[str]) -> bool:
    """Return whether the command line holds another option of a group of which only one is allowed."""
    typed = {word.partition("=")[0] for word in words}
    for group in command._mutually_exclusive_groups:
        if action in group._group_actions:
            return any(typed & set(each.option_strings) for each in group._group_actions)
    return False


def _words(action: argparse.Action, key: str, value: Any) -> list[str]:
    option = action.option_strings[-1]
    if action.nargs == 0:
        if not isinstance(value, bool):
            raise InputError(f"{DEFAULTS}: {key} must be true or false, got {value!r:.40}.")
        return [option] if value else []
    values = value if isinstance(value, list) else [value]
    for each in values:
        if isinstance(each, bool) or not isinstance(each, str | int | float):
            raise InputError(f"{DEFAULTS}: {key} must be a text or a number, got {each!r:.40}.")
    return [f"{option}={each}" for each in values]
