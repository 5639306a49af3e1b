"""Parameters as text for the terminal."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from texlab_core.engine.params import Field
    from texlab_core.engine.registry import Method

WIDTH = 100


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
