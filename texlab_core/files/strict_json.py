"""JSON from outside: bounded in size and depth, no NaN, no repeated keys, one clear sentence when refused."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from texlab_core.errors import InputError
from texlab_core.files.regular import TooLongError, megabytes, read_regular, reason
from texlab_core.files.wording import sentence_case

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence

MAX_BYTES = 2**20
MAX_DEPTH = 32
# Any whole number of as many fits into a float.
_MAX_DIGITS = 308
# A string, or a bracket outside of one; an unclosed string swallows the rest and is left to the parser.
_TOKENS = re.compile(r'"(?:[^"\\]|\\.)*+\\?"?|[\[{]|[\]}]', re.DOTALL)


def loads(
    source: str | bytes,
    *,
    what: str = "the text",
    max_bytes: int = MAX_BYTES,
    max_depth: int = MAX_DEPTH,
    error: type[InputError] = InputError,
) -> Any:
    """Return the data of one JSON document.

    Parameters
    ----------
    source
        The document; bytes are UTF-8, with or without a byte order mark.
    what
        How to name it in the message ("the preset foam.json").
    max_bytes
        Longest document that is read, as UTF-8.
    max_depth
        Deepest nesting of lists and objects.
    error
        Class of the error that is raised.

    Raises
    ------
    InputError
        (or ``error``) when it is too long, nested too deeply, not JSON, or holds a number that is not finite, a
        repeated key, or half of a surrogate pair. ``str(error)`` is one sentence.
    """

    def refuse(why: str) -> NoReturn:
        raise error(f"{sentence_case(what)} {why}.") from None

    size = len(source) if isinstance(source, bytes) else len(source.encode("utf-8", "surrogatepass"))
    if size > max_bytes:
        refuse(f"is {megabytes(size)} long, and at most {megabytes(max_bytes)} is read")
    try:
        text = source.decode("utf-8-sig") if isinstance(source, bytes) else source.removeprefix("\ufeff")
    except UnicodeDecodeError:
        refuse("is not UTF-8 text")
    if _depth(text) > max_depth:
        refuse(f"is nested more than {max_depth} levels deep")
    try:
        data = json.loads(
            text,
            object_pairs_hook=_unique,
            parse_constant=_no_constant,
            parse_float=_finite,
            parse_int=_whole,
        )
        json.dumps(data, ensure_ascii=False).encode()
    except json.JSONDecodeError as bad:
        refuse(f"is not valid JSON (line {bad.lineno}, column {bad.colno}: {bad.msg[:1].lower()}{bad.msg[1:]})")
    except _Refused as bad:
        refuse(str(bad))
    except UnicodeEncodeError:
        refuse("holds half of a surrogate pair, which is no character")
    return data


def load(
    path: str | os.PathLike[str],
    *,
    what: str | None = None,
    max_bytes: int = MAX_BYTES,
    max_depth: int = MAX_DEPTH,
    error: type[InputError] = InputError,
) -> Any:
    """Return the data of a JSON file; see :func:`loads`.

    Only regular files are read, and never more than ``max_bytes`` + 1 bytes of them: pipes, devices and endless
    files do no harm.

    Raises
    ------
    InputError
        (or ``error``) when it cannot be read or is refused.
    """
    name = f"{path}" if what is None else what
    try:
        source = read_regular(path, max_bytes)
    except TooLongError:
        raise error(
            f"{sentence_case(name)} is longer than {megabytes(max_bytes)}, the most that is read."
        ) from None
    except (OSError, ValueError) as bad:
        raise error(f"{sentence_case(name)} cannot be read ({reason(bad)}).") from bad
    return loads(source, what=name, max_bytes=max_bytes, max_depth=max_depth, error=error)


def read(
    source: Path | str | bytes, kind: str, *, what: str | None = None, error: type[InputError] = InputError
) -> tuple[Any, str]:
    """Return the data of a document, and what messages call it.

    Parameters
    ----------
    source
        A file (a ``Path``), or the text itself.
    kind
        What it is, as in "the preset".
    what
        What messages call it; None makes that of the kind and the file's name.
    error
        The class of what is raised when it cannot be read or is refused.
    """
    if isinstance(source, Path):
        name = f"{kind} {source.name or source}" if what is None else what
        return load(source, what=name, error=error), name
    name = kind if what is None else what
    return loads(source, what=name, error=error), name


def dumps(data: object) -> str:
    """Return JSON text for people: indented, in the given order, one line feed at the end.

    Raises
    ------
    ValueError
        When a number is not finite.
    """
    return json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def packed(data: object) -> str:
    """Return JSON text for programs: on one line, otherwise as :func:`dumps`."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False)


class _Refused(ValueError):
    """Found while parsing; the message continues a sentence that starts with the document's name."""


def _depth(text: str) -> int:
    depth = deepest = 0
    for token in _TOKENS.finditer(text):
        first = text[token.start()]
        if first in "[{":
            depth += 1
            deepest = max(deepest, depth)
        elif first in "]}":
            depth -= 1
    return deepest


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        repeated = Counter(key for key, _ in pairs).most_common(1)[0][0]
        raise _Refused(f"has the key {shorten(repeated)} twice in one object")
    return found


def _no_constant(name: str) -> NoReturn:
    raise _Refused(f"holds {name}, and every number must be finite")


def _finite(digits: str) -> float:
    value = float(digits) if len(digits) <= _MAX_DIGITS else math.inf
    if not math.isfinite(value):
        raise _Refused(f"holds the number {shorten(digits)}, which is too large or too long")
    return value


def _whole(digits: str) -> int:
    if len(digits) > _MAX_DIGITS:
        raise _Refused(f"holds the number {shorten(digits)}, which is too large or too long")
    return int(digits)


def check_document(
    data: object, noun: str, *, form: str, version: int, error: type[InputError] = InputError
) -> dict[str, Any]:
    """Return a document that names its format and a known version.

    Parameters
    ----------
    data
        What was read.
    noun
        What it should be ("preset").
    form, version
        Its ``format``, and the newest version that is known.
    error
        Raised with one clause when it is something else or newer.
    """
    if not isinstance(data, dict) or data.get("format") != form:
        raise error(f'it is no {noun} (a JSON object with "format": "{form}" was expected).')
    given = data.get("version")
    if type(given) is not int or given < 1:
        raise error(f"version: must be a whole number from 1, got {shorten(given)}.")
    if given > version:
        raise error(f"it has version {given}, made by a newer TexLab, and only version {version} is known.")
    return data


def check_keys(data: Mapping[str, object], known: Sequence[str], error: type[InputError] = InputError) -> None:
    """Refuse keys that are not known."""
    for key in data:
        if key not in known:
            raise error(f"key: must be one of {', '.join(known)}, got {shorten(key)}.")


def shorten(given: object) -> str:
    """Return a value as a message shows it, at most 40 characters."""
    shown = repr(given)
    return shown if len(shown) <= 40 else shown[:37] + "..."
