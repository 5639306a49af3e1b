"""Completion of the command line in bash and zsh, made from the parser."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator, Mapping, Sequence

    from texlab.cli.parser import Parser

SHELLS = ("bash", "zsh")

# Only texts, no arrays: bash and zsh count them differently. What is typed is taken from the line, since bash cuts
# its words at colons.
_SCRIPT = """\
# Completion of texlab for {shell}, made by: texlab completion {shell}
{start}
_texlab() {{
    local line="${{COMP_LINE:0:$COMP_POINT}}"
    local current="${{line##* }}" before="${{line% *}}" values="" command=""
    local rest="${{line#* }}"
    while [[ "$rest" == " "* ]]; do rest="${{rest# }}"; done
    [[ "$rest" == *" "* ]] && command="${{rest%% *}}"
    local previous="${{before##* }}"
    if [[ "$current" == --*=* ]]; then
        previous="${{current%%=*}}"
        current="${{current#*=}}"
    fi
    case "$command:$previous" in
{values}
        *)
            case "$command" in
{options}
            esac
            ;;
    esac
    COMPREPLY=( $(compgen -W "$values" -- "$current") )
    if [[ "$current" == *:* && "${{COMP_WORDBREAKS-}}" == *:* ]]; then
        local typed="${{current%"${{current##*:}}"}}"
        COMPREPLY=( "${{COMPREPLY[@]#"$typed"}}" )
    fi
}}
complete -o default -F _texlab texlab
"""
_START = {"bash": "", "zsh": "autoload -U +X bashcompinit && bashcompinit\n"}


def completion(parser: Parser, shell: str) -> str:
    """Return the script for a shell: commands, options, choices, methods, presets and textures.

    Parameters
    ----------
    parser
        With every command.
    shell
        ``bash`` or ``zsh``.
    """
    words = _words()
    options = [_case('""', [*parser.commands, "--help", "--version"], 16)]
    values = []
    for name, command in parser.commands.items():
        for action in command._actions:
            found = list(_values(action, words))
            if found and action.option_strings:
                pattern = "|".join(f"{name}:{option}" for option in action.option_strings)
                values.append(_case(pattern, found, 8))
        options.append(_case(name, [*_inner(command), *_positional(command, words), *_options(command)], 16))
    return _SCRIPT.format(
        shell=shell, start=_START[shell], values="\n".join(values), options="\n".join(options)
    ).replace("\n\n_texlab", "\n_texlab")


def _case(pattern: str, values: Sequence[str], indent: int) -> str:
    space = " " * indent
    return f"{space}{pattern}) values={shlex.quote(' '.join(values))} ;;"


def _options(parser: Parser) -> Iterator[str]:
    for action in parser._actions:
        yield from (option for option in action.option_strings if option.startswith("--"))


def _inner(parser: Parser) -> list[str]:
    """Return the commands of a command."""
    return [name for action in parser._actions if action.nargs == "A..." for name in action.choices or ()]


def _positional(parser: Parser, words: Mapping[str, Sequence[str]]) -> Iterator[str]:
    for action in parser._actions:
        if not action.option_strings and action.nargs != "A...":
            yield from _values(action, words)


def _values(action: argparse.Action, words: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """Return what a value may be: its choices, or what its name in the help stands for."""
    if action.choices is not None:
        yield from (str(choice) for choice in action.choices)
        return
    named = next((words[option] for option in action.option_strings if option in words), None)
    yield from words.get(str(action.metavar), ()) if named is None else named


def _words() -> Mapping[str, Sequence[str]]:
    """Return the values for each name that the help gives to one, or for an option."""
    from texlab.cli.commands._options import own_presets
    from texlab_core.batch.plan import BUNDLED, bundled_plans
    from texlab_core.documents.preset_store import bundled_presets
    from texlab_core.engine.registry import methods
    from texlab_core.images.gallery import gallery
    from texlab_core.sheets.sweep_sources import bundled_sweeps

    textures = [entry.uri for entry in gallery()]
    presets = [f"{each.method}/{each.name}" for each in (*own_presets().presets(), *bundled_presets())]
    presets = [name for name in presets if " " not in name]
    return {
        "ID": list(methods()),
        "A,B,C": list(methods()),
        "IMAGE|gallery:NAME": textures,
        "NAME|FILE": presets,
        "--sweep": [each.name for each in bundled_sweeps()],
        "PLAN|gallery:NAME": [BUNDLED + name for name in bundled_plans()],
    }
