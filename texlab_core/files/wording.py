"""Words of messages and recipes: names on one line, sentences that start as sentences do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

LONGEST_NAME = 255


def printable(text: str, longest: int = LONGEST_NAME) -> str:
    """Return a text on one line, of characters that can be seen.

    White space becomes single spaces; what else cannot be printed (control characters, marks that turn the
    direction of writing, bytes of a file name that are no UTF-8) becomes U+FFFD.

    Parameters
    ----------
    text
        The name of a file, say.
    longest
        Longer ones end in three dots.
    """
    seen = "".join(each if each.isprintable() else "\ufffd" for each in " ".join(text.split()))
    return seen if len(seen) <= longest else f"{seen[: longest - 3]}..."


def sentence_case(name: str) -> str:
    """Return the start of a sentence: only the article gets a capital, names of files stay as they are."""
    return f"T{name[1:]}" if name.startswith("the ") else name


def did_you_mean(name: object, known: Iterable[str]) -> str:
    """Return ``"did you mean ...?"`` with the known name that is most like this one, empty when none is."""
    import difflib

    close = difflib.get_close_matches(str(name), known, n=1)
    return f"did you mean {close[0]}?" if close else ""


def harmless(cell: Any) -> Any:
    """Return a cell of a table; a spreadsheet would take a text that starts like a formula for one."""
    return f"'{cell}" if isinstance(cell, str) and cell[:1] in ("=", "+", "@", "\t") else cell
