"""``texlab presets``: the user's presets and the bundled ones."""

from __future__ import annotations

import argparse
import contextlib
import json
from typing import TYPE_CHECKING, Any

from texlab.cli.commands._options import own_presets

if TYPE_CHECKING:
    from texlab.cli.parser import Parser
    from texlab_core.documents.preset_store import PresetStore
    from texlab_core.documents.presets import Preset

HELP = "List, show, save, import, export, rename or delete presets."
ORDER = 40


def configure(parser: Parser) -> None:
    """Add the arguments: one parser for each action; none of them lists."""
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    parser.set_defaults(act=_list, method=None)
    actions = parser.add_subparsers(title="actions", metavar="ACTION")

    def action(name: str, act: Any, about: str) -> argparse.ArgumentParser:
        each = actions.add_parser(name, help=about, description=about, allow_abbrev=False)
        each.set_defaults(act=act)
        # Absent means: what stood before the action's name counts.
        each.add_argument("--json", action="store_true", default=argparse.SUPPRESS, help="print one JSON document")
        each.add_argument("--method", metavar="ID", help="the method, when several have a preset of that name")
        return each

    action("list", _list, "List the presets (of one method).")
    action("show", _show, "Show one preset.").add_argument("preset", metavar="NAME|FILE")
    save = action("save", _save, "Save parameters under a name.")
    save.add_argument("name", metavar="NAME")
    save.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set one parameter")
    save.add_argument("--note", default="", help="what it is good for")
    load = action("import", _import, "Keep a copy of a preset file among your own.")
    load.add_argument("file", metavar="FILE")
    load.add_argument("--name", help="keep it under this name")
    export = action("export", _export, "Write a preset to a file, or into a folder.")
    export.add_argument("preset", metavar="NAME")
    export.add_argument("out", metavar="FILE|FOLDER")
    rename = action("rename", _rename, "Give one of your own presets another name.")
    rename.add_argument("preset", metavar="NAME")
    rename.add_argument("new_name", metavar="NEW_NAME")
    action("delete", _delete, "Delete one of your own presets.").add_argument("preset", metavar="NAME")
    for each in (save, load, export):
        each.add_argument("--replace", action="store_true", help="replace what is there")


def execute(args: argparse.Namespace) -> int:
    """Do what was asked and say what was done."""
    from texlab_core.engine.registry import find_method

    if args.method is not None:
        find_method(args.method)
    answer, text = args.act(args, own_presets())
    print(json.dumps(answer, indent=2, ensure_ascii=False) if args.json else text)
    return 0


def _list(args: argparse.Namespace, store: PresetStore) -> tuple[Any, str]:
    from texlab_core.documents.preset_store import bundled_presets
    from texlab_core.files.wording import printable

    listed = [(each, "own") for each in store.presets(args.method)]
    listed += [(each, "bundled") for each in bundled_presets(args.method)]
    answer = [{"source": source} | each.to_json() for each, source in listed]
    width = max((len(f"{each.method}/{each.name}") for each, _ in listed), default=0)
    lines = [f"{f'{each.method}/{each.name}':{width}}  {source:7}  {_first_line(each)}" for each, source in listed]
    lines += [f"not usable: {printable(problem, 1000)}" for problem in store.problems()]
    return answer, "\n".join(line.rstrip() for line in lines) or "There are no presets yet."


def _show(args: argparse.Namespace, store: PresetStore) -> tuple[Any, str]:
    from texlab_core.documents.preset_store import find_preset

    preset = find_preset(args.preset, store, args.method)
    lines = [f"{preset.method}/{preset.name}"]
    lines += [preset.note] if preset.note else []
    lines += [f"made for {preset.exemplar.name}"] if preset.exemplar else []
    lines += [f"  {name}={json.dumps(value)}" for name, value in preset.parameters.items()]
    return preset.to_json(), "\n".join(lines)


def _save(args: argparse.Namespace, store: PresetStore) -> tuple[Any, str]:
    from texlab.cli.commands._options import parse_settings
    from texlab_core.documents.presets import Preset
    from texlab_core.engine.registry import find_method
    from texlab_core.errors import InputError

    if args.method is None:
        raise InputError("A preset belongs to a method: say --method ID.")
    settings = parse_settings(args.set)
    values = find_method(args.method).params.parse(settings).to_json()
    parameters = {name: values[name] for name in settings}
    preset = Preset(name=args.name, method=args.method, parameters=parameters, note=args.note)
    path = store.save(preset, replace=args.replace)
    return preset.to_json() | {"file": str(path)}, f"Saved {preset.method}/{preset.name} as {path}."


def _import(args: argparse.Namespace, store: PresetStore) -> tuple[Any, str]:
    preset = store.import_file(args.file, name=args.name, replace=args.replace)
    return preset.to_json(), f"Imported {preset.method}/{preset.name}."


def _export(args: argparse.Namespace, store: PresetStore) -> tuple[Any, str]:
    from texlab_core.documents.preset_store import export_preset, find_preset
    from texlab_core.errors import InputError

    preset = find_preset(args.preset, store, args.method)
    if not args.out:
        raise InputError("The name of the file or folder to write is empty.")
    path = export_preset(preset, args.out, replace=args.replace)
    return preset.to_json() | {"file": str(path)}, f"Exported {preset.method}/{preset.name} to {path}."


def _rename(args: argparse.Namespace, store: PresetStore) -> tuple[Any, str]:
    _refuse_bundled(args, store)
    preset = store.rename(args.preset, args.new_name, args.method)
    return preset.to_json(), f"Renamed to {preset.method}/{preset.name}."


def _delete(args: argparse.Namespace, store: PresetStore) -> tuple[Any, str]:
    _refuse_bundled(args, store)
    preset = store.delete(args.preset, args.method)
    return preset.to_json(), f"Deleted {preset.method}/{preset.name}."


def _refuse_bundled(args: argparse.Namespace, store: PresetStore) -> None:
    """Raise ``InputError`` when only a bundled preset has the name."""
    from texlab_core.documents.preset_store import bundled_presets
    from texlab_core.documents.presets import PresetError, pick
    from texlab_core.errors import InputError

    name = args.preset.rpartition("/")[2].casefold()
    if any(each.name.casefold() == name for each in store.presets(args.method)):
        return
    with contextlib.suppress(PresetError):
        found = pick(bundled_presets(args.method), args.preset, args.method)
        raise InputError(
            f"The preset {found.method}/{found.name} comes with TexLab and stays as it is; only your own can be "
            "renamed or deleted."
        )


def _first_line(preset: Preset) -> str:
    return preset.note.partition("\n")[0]
