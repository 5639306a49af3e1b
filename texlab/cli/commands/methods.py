"""``texlab methods``: what methods there are, and what each can be told."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.cli.commands._knobs import _default, _wrap, knobs
from texlab.cli.terminal import complain

if TYPE_CHECKING:
    import argparse

    from texlab.cli.parser import Parser
    from texlab_core.engine.params import Field
    from texlab_core.engine.registry import Method

HELP = "List the synthesis methods, or the inputs and parameters of one."
ORDER = 20


def configure(parser: Parser) -> None:
    """Add the arguments."""
    parser.add_argument("method", nargs="?", metavar="ID", help="show this method and its parameters")
    parser.add_argument("--json", action="store_true", help="print one JSON document")


def execute(args: argparse.Namespace) -> int:
    """Print the list, or one method."""
    from texlab_core.engine.registry import failures, find_method, methods

    for failure in failures():
        complain(failure.sentence)
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
    return "\n".join(parts) + "\n\n" + inputs(method) + "\n\n" + knobs(method)


def inputs(method: Method) -> str:
    """Return every named input with its kind and help as text, for ``--input NAME=FILE``."""
    sizes = {2: "width x height", 3: "width x height x depth"}[method.dimensions]
    lines = [f"makes {sizes} from these inputs, for --input NAME=FILE|gallery:NAME (exemplar: IMAGE):"]
    files = {"image": "image", "data": "JSON file", "arrays": ".npz file"}
    for spec in method.inputs:
        need = "" if spec.required else ", not needed"
        lines.append(f"  {spec.name} ({files[spec.kind]}{need})")
        lines.append(_wrap(spec.help, indent=6))
    return "\n".join(lines)


def as_json(method: Method) -> dict[str, Any]:
    """Return what is known of a method as JSON data."""
    from texlab_core.engine.params import describe

    return {
        "id": method.id,
        "title": method.title,
        "package": method.package,
        "summary": method.summary,
        "reference": method.reference,
        "fails_on": list(method.fails_on),
        "inputs": [
            {"name": spec.name, "kind": spec.kind, "required": spec.required, "help": spec.help}
            for spec in method.inputs
        ],
        "dimensions": method.dimensions,
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
