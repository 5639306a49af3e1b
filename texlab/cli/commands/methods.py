"""``texlab methods``: what methods there are, and what each can be told."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import argparse

    from texlab.cli.main import Parser
    from texlab_core.engine.params import Field
    from texlab_core.engine.registry import Method

HELP = "List the synthesis methods, or the parameters of one."
ORDER = 20
WIDTH = 100


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("method", nargs="?", metavar="ID", help="show this method and its parameters")
    parser.add_argument("--json", action="store_true", help="print one JSON document")


def execute(args: argparse.Namespace) -> int:
    """Print the list, or one method."""
    from texlab_core.engine.registry import find_method, methods

    chosen = [find_method(args.method)] if args.method else list(methods().values())
    if args.json:
        import json

        found = [as_json(method) for method in chosen]
        print(json.dumps(found[0] if args.method else found, indent=2))
    elif args.method:
        print(about(chosen[0]))
    else:
        width = max((len(method.id) for method in chosen), default=0)
        for method in chosen:
            print(f"{method.id:{width}}  {method.title}: {method.summary}")
    return 0


def about(method: Method) -> str:
    """Return title, summary, reference, known failures and parameters as text."""
    parts = [f"{method.title} ({method.id})", _wrap(method.summary), _wrap(method.reference)]
    if method.fails_on:
        parts.append(_wrap("Known to fail on " + "; ".join(method.fails_on).rstrip(".") + "."))
    return "\n".join(parts) + "\n\n" + knobs(method)


def knobs(method: Method) -> str:
    """Return every parameter with default, range and help as text, for ``--set name=value``."""
    from texlab_core.engine.params import describe

    fields = describe(method.params)
    if not fields:
        return f"{method.title} has no parameters."
    lines = [f"parameters of {method.title}, for --set NAME=VALUE:"]
    for field in fields:
        lines.append(f"  {field.name}={_show(field)}")
        lines.append(_wrap(f"{field.knob.help.rstrip('.')}; {_allowed(field)}.", indent=6))
        width = max(map(len, field.choices), default=0)
        lines += [f"      {choice:{width}}  {field.knob.choices.get(choice, '')}" for choice in field.choices]
    return "\n".join(lines)


def as_json(method: Method) -> dict[str, Any]:
    """Return what is known of a method as JSON data."""
    from texlab_core.engine.params import describe

    return {
        "id": method.id,
        "title": method.title,
        "summary": method.summary,
        "reference": method.reference,
        "fails_on": list(method.fails_on),
        "inputs": [
            {"name": spec.name, "kind": spec.kind, "required": spec.required, "help": spec.help}
            for spec in method.inputs
        ],
        "parameters": [_field_json(field) for field in describe(method.params)],
    }


def _field_json(field: Field) -> dict[str, Any]:
    knob = field.knob
    return {
        "name": field.name,
        "label": field.label,
        "kind": field.kind,
        "default": _default(field),
        "low": knob.low,
        "high": knob.high,
        "unit": knob.unit,
        "choices": {choice: knob.choices.get(choice, "") for choice in field.choices},
        "stage": knob.stage,
        "help": knob.help,
        "source": knob.source,
    }


def _default(field: Field) -> Any:
    return field.default.to_json() if field.kind == "value" else field.default


def _show(field: Field) -> str:
    """Return the default as ``--set`` would take it."""
    if field.kind == "bool":
        return "true" if field.default else "false"
    if field.kind == "value":
        import json

        return textwrap.shorten(json.dumps(_default(field), separators=(",", ":")), 60, placeholder="...")
    return str(field.default)


def _allowed(field: Field) -> str:
    unit = f" {field.knob.unit}" if field.knob.unit else ""
    return field.allowed + unit


def _wrap(text: str, indent: int = 0) -> str:
    space = " " * indent
    return textwrap.fill(text, WIDTH, initial_indent=space, subsequent_indent=space, break_on_hyphens=False)
