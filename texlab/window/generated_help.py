"""A help page for methods that come without one, made from what they declare."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.engine.params import describe

if TYPE_CHECKING:
    from texlab_core.engine.params import Field
    from texlab_core.engine.registry import Method

# What Markdown would take for its own; methods of other packages write what they like.
_MARKUP = "\\`*_{}[]<>#+-!|&"


def method_page(method: Method) -> str:
    """Return the page of a method as Markdown: what it does, its inputs, every knob, what it fails on."""
    lines = [f"# {_plain(method.title)}", "", _plain(method.summary), "", f"Reference: {_plain(method.reference)}"]
    lines += ["", "## Parameters", ""]
    fields = describe(method.params)
    lines += [_knob(method.id, field) for field in fields] or ["This method has no parameters."]
    if len(method.inputs) > 1:
        lines += ["", "## Inputs", ""]
        lines += [f"- **{_plain(each.name)}**: {_plain(each.help)}" for each in method.inputs]
    if method.fails_on:
        lines += ["", "## Where it fails", ""]
        lines += [f"- {_plain(phrase)}" for phrase in method.fails_on]
    lines += ["", "This page was made from what the method declares."]
    return "\n".join(lines) + "\n"


def _knob(method: str, field: Field) -> str:
    about = f"- [**{_plain(field.label)}**](knob:{method}/{field.name}): {_plain(field.knob.help)}"
    if field.kind != "value":
        about += f" {_plain(field.allowed.capitalize())}; {_plain(str(field.default))} by default."
    if field.knob.source:
        about += f" ({_plain(field.knob.source)})"
    return about


def _plain(text: str) -> str:
    return "".join(f"\\{each}" if each in _MARKUP else each for each in " ".join(text.split()))
